// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the forces against the whole, which comes from the bodies one by one and not from
// the energies.
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/force_parts.h"

#include "dynamics/evaluate/eval.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

typedef struct probe {
    hn_model model;
    hn_eval *eval;
    hn_force_parts *parts;
    double *q, *v, *dq;
    unsigned seed;
} probe;

static double noise(probe *p) {
    p->seed = p->seed * 1664525u + 1013904223u;
    return 2 * (double)(p->seed >> 8) / 16777216.0 - 1;
}

static void open_probe(probe *p, const char *name) {
    memset(p, 0, sizeof *p);
    p->seed = 3;
    hn_model_begin(&p->model, name, NULL);
    hn_arena *arena = p->model.arena;
    assert_int_equal(hn_eval_create(p->model.sys, HN_TERM_F | HN_TERM_ENERGY, arena, &p->eval),
                     HN_OK);
    assert_int_equal(hn_force_parts_create(p->model.sys, arena, &p->parts), HN_OK);
    double **const vectors[] = {&p->q, &p->v, &p->dq};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++) {
        *vectors[k] = hn_arena_doubles(arena, (size_t)p->model.info.nq + 1);
        assert_non_null(*vectors[k]);
    }
}

static void close_probe(probe *p) {
    hn_force_parts_free(p->parts);
    hn_eval_free(p->eval);
    hn_model_close(&p->model);
}

/// Anywhere: these forces do not ask whether loops are closed.
static void next_state(probe *p) {
    memcpy(p->q, p->model.q, (size_t)p->model.info.nq * sizeof *p->q);
    for (int i = 0; i < p->model.info.nv; i++) {
        p->dq[i] = noise(p);
        p->v[i] = 3 * noise(p);
    }
    hn_system_move(p->model.sys, p->q, p->dq);
    hn_eval_run(p->eval, 0, p->q, p->v);
    hn_force_parts_run(p->parts, 0, p->q, p->v);
}

static void forces_without_loads_are_velocity_part_and_potential(void **state) {
    (void)state;
    static const char *const names[] = {
        "heavy-top",    "spinning-block",  "rssr",
        "watt-six-bar", "bennett",         "oblique-four-bar",
        "fb0",          "double-pendulum", "formulas-beside-bodies"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        probe p;
        open_probe(&p, names[k]);
        for (int n = 0; n < 20; n++) {
            next_state(&p);
            const double *f = hn_eval_get(p.eval, HN_TERM_F), *h = hn_force_parts_h(p.parts),
                         *g = hn_force_parts_g(p.parts);
            double size = 0;
            for (int i = 0; i < p.model.info.nv; i++) {
                size = fmax(size, fabs(f[i]) + fabs(h[i]) + fabs(g[i]));
            }
            for (int i = 0; i < p.model.info.nv; i++) {
                // rounding of sums of some dozen products
                assert_near(f[i] + h[i] + g[i], 0, 1e-13 * size);
            }
        }
        close_probe(&p);
    }
}

/// With v held, T changes by M alone: v' M' v / 2 per second, which is v' h because M' - 2 C is
/// skew. T by differences.
static void the_velocity_part_does_the_work_of_the_changing_mass(void **state) {
    (void)state;
    static const char *const names[] = {"heavy-top", "rssr", "stewart-6-6"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        probe p;
        open_probe(&p, names[k]);
        for (int n = 0; n < 5; n++) {
            next_state(&p);
            const double step = 1e-5;
            double power = 0, T[2];
            for (int i = 0; i < p.model.info.nv; i++) {
                power += p.v[i] * hn_force_parts_h(p.parts)[i];
            }
            for (int side = 0; side < 2; side++) {
                double q[64];
                memcpy(q, p.q, (size_t)p.model.info.nq * sizeof *q);
                for (int i = 0; i < p.model.info.nv; i++) {
                    p.dq[i] = (side ? step : -step) * p.v[i];
                }
                hn_system_move(p.model.sys, q, p.dq);
                hn_eval_run(p.eval, 0, q, p.v);
                T[side] = hn_eval_get(p.eval, HN_TERM_ENERGY)[0];
            }
            // of the differences: step^2 times the third rate, and rounding over the step
            assert_near((T[1] - T[0]) / (2 * step), power, 1e-8 * (1 + fabs(T[0])));
        }
        close_probe(&p);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_without_loads_are_velocity_part_and_potential),
        cmocka_unit_test(the_velocity_part_does_the_work_of_the_changing_mass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
