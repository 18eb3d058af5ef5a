// SPDX-License-Identifier: GPL-3.0-or-later
// Minimal coordinates with the tape against the same without it.
#include "dynamics/compile/compile.h"
#include "formulations/chart/minimal_state.h"
#include "linalg/dense.h"

#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MAX = 32 };

typedef struct motion {
    hn_minimal_state s;
    hn_arena *arena;
    hn_ode ode;
    double t, y[2 * MAX];
} motion;

static void begin(motion *w, const hn_model *m, bool with_tape) {
    hn_diag diag = {0};
    memset(w, 0, sizeof *w);
    w->arena = hn_arena_create(0);
    assert_int_equal(hn_minimal_init(&w->s, m->sys, w->arena, &diag), HN_OK);
    assert_int_equal(hn_minimal_start(&w->s, HN_CHART_PREFERRED, 0, m->q, m->v, w->y), HN_OK);
    hn_minimal_ode(&w->s, &w->ode);
    w->s.tape.serves &= with_tape;
}

static void end(motion *w) {
    hn_minimal_destroy(&w->s);
    hn_arena_free(w->arena);
}

/// One model moved in both ways: by the tape, and by the careful way.
typedef struct pair {
    hn_model m;
    motion tape, careful;
} pair;

static void open_pair(pair *p, const char *scene) {
    hn_model_open_closed(&p->m, scene, NULL);
    begin(&p->tape, &p->m, true);
    begin(&p->careful, &p->m, false);
}

static void close_pair(pair *p) {
    end(&p->careful);
    end(&p->tape);
    hn_model_close(&p->m);
}

/// A step of the classical Runge-Kutta method.
static hn_status step(motion *w, double h) {
    static const double c[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    const int n = 2 * w->ode.n_pos;
    double k[4][2 * MAX], at[2 * MAX];
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < n; j++) {
            at[j] = i > 0 ? w->y[j] + h * c[i] * k[i - 1][j] : w->y[j];
        }
        HN_TRY(w->ode.rhs(&w->s, w->t + c[i] * h, at, k[i]));
    }
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < 4; i++) {
            w->y[j] += h / 6 * weight[i] * k[i][j];
        }
    }
    w->t += h;
    return hn_minimal_settle(&w->s, w->t, w->y);
}

static const char *const scenes[] = {"four-bar",     "fb0",          "slider-crank", "five-bar",
                                     "driven-crank", "watt-six-bar", "quick-return"};
enum { N_SCENES = sizeof scenes / sizeof *scenes };

static void the_motion_is_that_of_the_careful_way(void **state) {
    (void)state;
    for (int k = 0; k < N_SCENES; k++) {
        pair p;
        double q[2][MAX], v[2][MAX];
        open_pair(&p, scenes[k]);
        for (int i = 0; i < 200; i++) {
            assert_int_equal(step(&p.tape, 1e-3), HN_OK);
            assert_int_equal(step(&p.careful, 1e-3), HN_OK);
        }
        assert_int_equal(hn_minimal_get_state(&p.tape.s, p.tape.t, p.tape.y, q[0], v[0]), HN_OK);
        assert_int_equal(hn_minimal_get_state(&p.careful.s, p.careful.t, p.careful.y, q[1], v[1]),
                         HN_OK);

        // rounding of 200 steps, and the basis that both have at the end
        assert_all_near(q[0], q[1], (size_t)p.m.info.nq, 1e-11);
        assert_all_near(v[0], v[1], (size_t)p.m.info.nv, 1e-9);
        const size_t n = (size_t)(p.m.info.nv * p.tape.s.chart.r);
        assert_all_near(p.tape.s.chart.base.N, p.careful.s.chart.base.N, n, 1e-9);
        assert_all_near(p.tape.s.chart.base.s, p.careful.s.chart.base.s, (size_t)p.m.info.nv, 1e-9);
        assert_rel(p.tape.s.chart.volume, p.careful.s.chart.volume, 1e-9);
        assert_int_equal(p.tape.s.chart.base.sign, p.careful.s.chart.base.sign);
        close_pair(&p);
    }
}

static void one_run_of_the_tape_serves_an_evaluation_of_a_short_step(void **state) {
    (void)state;
    enum { STEPS = 200 };
    hn_model m;
    motion w;
    hn_model_open_closed(&m, "fb0", NULL);
    begin(&w, &m, true);
    const hn_cost before = w.s.chart.cost;
    for (int i = 0; i < STEPS; i++) {
        assert_int_equal(step(&w, 1e-4), HN_OK);
    }

    // three stages and the end of the step, whose accelerations the next step begins with
    const long long runs = w.s.chart.cost.newton - before.newton;
    assert_int_equal(w.s.chart.cost.evals - before.evals, 4 * STEPS);
    assert_in_range(runs, 4 * STEPS, 4 * STEPS + STEPS / 50);
    assert_true(w.s.chart.here.is_bare);
    end(&w);
    hn_model_close(&m);
}

/// The same positions with other velocities need a run of their own.
static void accelerations_follow_the_velocities(void **state) {
    (void)state;
    pair p;
    double y[2], slope[2][2];
    open_pair(&p, "four-bar");
    for (int i = 0; i < 3; i++) {
        y[0] = p.tape.y[0] + 0.01;
        y[1] = 2.0 * i;
        assert_int_equal(p.tape.ode.rhs(&p.tape.s, 0, y, slope[0]), HN_OK);
        assert_int_equal(p.careful.ode.rhs(&p.careful.s, 0, y, slope[1]), HN_OK);
        assert_all_near(slope[0], slope[1], 2, 1e-11 * (1 + fabs(slope[1][1])));
    }
    close_pair(&p);
}

/// Matrices of Newton's method need the factor that a point made by the tape does not have.
static void the_jacobian_is_that_of_the_careful_way(void **state) {
    (void)state;
    pair p;
    double jac[2][4];
    open_pair(&p, "slider-crank");
    assert_int_equal(step(&p.tape, 1e-3), HN_OK);
    assert_int_equal(step(&p.careful, 1e-3), HN_OK);
    assert_true(p.tape.s.chart.here.is_bare);
    assert_int_equal(p.tape.ode.jacobian(&p.tape.s, p.tape.t, p.tape.y, jac[0]), HN_OK);
    assert_int_equal(p.careful.ode.jacobian(&p.careful.s, p.careful.t, p.careful.y, jac[1]), HN_OK);
    assert_all_near(jac[0], jac[1], 4, 1e-9 * (1 + hn_norm_max(4, jac[1])));
    close_pair(&p);
}

/// A long step, whose prediction is far off, is left to the careful way, which goes in pieces.
static void a_far_prediction_is_followed_in_pieces(void **state) {
    (void)state;
    pair p;
    double y[2], slope[2][2];
    open_pair(&p, "four-bar");
    y[0] = p.tape.y[0] + 2.5;
    y[1] = 1;
    assert_false(hn_minimal_tape_close(&p.tape.s.tape, &p.tape.s.chart, 0, y, HN_CHART_TOL));
    assert_int_equal(p.tape.ode.rhs(&p.tape.s, 0, y, slope[0]), HN_OK);
    assert_int_equal(p.careful.ode.rhs(&p.careful.s, 0, y, slope[1]), HN_OK);
    assert_memory_equal(slope[0], slope[1], sizeof slope[0]); // the same way, the same bits
    close_pair(&p);
}

/// A hand that takes hold at an accepted state is felt there at once.
static void a_hand_that_takes_hold_between_two_steps_is_felt(void **state) {
    (void)state;
    const hn_pull hold = {.point = 1, .to = {3, 2, 0}, .stiffness = 50};
    hn_diags diags = {0};
    hn_model m = {0};
    motion w;
    double before[2], after[2];
    const char path[] = "lessons/01-closed-loops/scenes/four-bar.json";
    assert_int_equal(hn_scene_load_file(path, NULL, 0, &m.scene, &diags), HN_OK);
    assert_int_equal(hn_scene_add_pull(m.scene, hold.point), HN_OK);
    assert_int_equal(hn_system_compile(m.scene, NULL, &m.sys, &diags), HN_OK);
    double q[MAX], v[MAX], a[MAX], lambda[MAX];
    assert_int_equal(hn_assemble(m.sys, 0, q, v, a, lambda, &m.assembly, &diags), HN_OK);
    m.q = q;
    m.v = v;
    begin(&w, &m, true);
    assert_true(w.s.tape.serves);
    assert_int_equal(step(&w, 1e-3), HN_OK);
    assert_int_equal(w.ode.rhs(&w.s, w.t, w.y, before), HN_OK);
    assert_int_equal(hn_pull_log_add(hn_system_pulls(m.sys), w.t, &hold), HN_OK);
    assert_int_equal(w.ode.rhs(&w.s, w.t, w.y, after), HN_OK);
    assert_true(fabs(after[1] - before[1]) > 1); // some 100 N on links of about 1 kg
    end(&w);
    hn_system_free(m.sys);
    hn_scene_free(m.scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_motion_is_that_of_the_careful_way),
        cmocka_unit_test(one_run_of_the_tape_serves_an_evaluation_of_a_short_step),
        cmocka_unit_test(accelerations_follow_the_velocities),
        cmocka_unit_test(the_jacobian_is_that_of_the_careful_way),
        cmocka_unit_test(a_hand_that_takes_hold_between_two_steps_is_felt),
        cmocka_unit_test(a_far_prediction_is_followed_in_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
