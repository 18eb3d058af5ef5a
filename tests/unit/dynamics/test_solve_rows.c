// SPDX-License-Identifier: GPL-3.0-or-later
// Position rows seen from the legs of spatial loops: the same accelerations and multipliers as the
// system's own rows give, at closed and at open loops, with and without Baumgarte's terms, and
// fewer operations. The dense solve takes the system's own rows.
#include "dynamics/evaluate/solve_rows.h"

#include "dynamics/compile/system_impl.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/inputs.h"
#include "expr/construct.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { MOST = 32 };

/// A pendulum of two links about crossing axes, its end held by a rod with ball joints: an end that
/// turns about three groups' axes, a slide before the first turn, and a joint written backwards.
static const char CHAIN[] =
    "{\"holonom\": 1, \"name\": \"chain\", \"title\": \"chain\", \"gravity\": [0, 0, -9.81],"
    " \"bodies\": ["
    "{\"name\": \"cart\", \"mass\": 1, \"inertia\": {\"xx\": 0.1, \"yy\": 0.1, \"zz\": 0.1}},"
    "{\"name\": \"upper\", \"mass\": 1, \"com\": [0.2, 0, 0], \"inertia\": {\"xx\": 0.01, \"yy\": "
    "0.02, \"zz\": 0.03}},"
    "{\"name\": \"lower\", \"mass\": 1, \"com\": [0.2, 0.1, 0], \"inertia\": {\"xx\": 0.01, "
    "\"yy\": 0.02, \"zz\": 0.03}},"
    "{\"name\": \"rod\", \"mass\": 1, \"com\": [0, 0, 0.25], \"inertia\": {\"xx\": 0.02, \"yy\": "
    "0.02, \"zz\": 0.01}}],"
    " \"joints\": ["
    "{\"name\": \"S\", \"type\": \"prismatic\", \"axis\": [1, 0, 0], \"parent\": {\"body\": "
    "\"ground\"}, \"child\": {\"body\": \"cart\"}},"
    "{\"name\": \"A\", \"type\": \"revolute\", \"axis\": [0.6, 0, 0.8], \"parent\": {\"body\": "
    "\"cart\"}, \"child\": {\"body\": \"upper\"}},"
    "{\"name\": \"B\", \"type\": \"revolute\", \"axis\": [0, 1, 0], \"parent\": {\"body\": "
    "\"lower\"}, \"child\": {\"body\": \"upper\", \"at\": [0.4, 0, 0]}},"
    "{\"name\": \"C\", \"type\": \"spherical\", \"parent\": {\"body\": \"rod\"}, \"child\": "
    "{\"body\": \"ground\", \"at\": [0.9, 0.1, -0.5]}},"
    "{\"name\": \"D\", \"type\": \"spherical\", \"cut\": true, \"parent\": {\"body\": \"lower\", "
    "\"at\": [0.4, 0.1, 0]}, \"child\": {\"body\": \"rod\", \"at\": [0, 0, 0.5]}}],"
    " \"duration\": 1, \"step\": 0.01}";

/// A state at which no loop is closed: the assembled one, everything moved by its own amount.
static void disturb(const hn_model *m, double *q, double *v) {
    for (int i = 0; i < m->info.nq; i++) {
        q[i] = m->q[i] + 0.05 * sin(1 + 2.0 * i);
    }
    for (int k = 0; k < m->sys->n_balls; k++) { // unit quaternions again
        double *e = q + m->sys->balls[k].position;
        const double size = sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3]);
        for (int i = 0; i < 4; i++) {
            e[i] /= size;
        }
    }
    for (int i = 0; i < m->info.nv; i++) {
        v[i] = cos(1 + 3.0 * i);
    }
}

static void solve(const hn_model *m, hn_solver solver, bool baumgarte, const double *q,
                  const double *v, double *x) {
    hn_accel *accel;
    hn_accel_info info;
    const hn_accel_opts opts = {.want_lambda = 1, .baumgarte = baumgarte, .solver = solver};
    assert_true(m->info.nv + m->info.nc <= 2 * MOST);
    assert_int_equal(hn_accel_create(m->sys, &opts, m->arena, &accel), HN_OK);
    assert_int_equal(hn_accel_eval(accel, 0.1, q, v, 3, 4, x, x + m->info.nv, &info), HN_OK);
    assert_int_equal(info.fallback, 0);
    hn_accel_free(accel);
}

/// Compares the solution with the legs' rows to the dense one with the system's own. Both round
/// sums of some ten products: 1e-9 of the largest entry is far above that, and far below what a
/// wrong term would change.
static void check_same(const hn_model *m, const double *q, const double *v) {
    const int n = m->info.nv + m->info.nc;
    for (int baumgarte = 0; baumgarte < 2; baumgarte++) {
        double tape[2 * MOST], dense[2 * MOST], largest = 0;
        solve(m, HN_SOLVER_LDL, baumgarte, q, v, tape);
        solve(m, HN_SOLVER_DENSE, baumgarte, q, v, dense);
        for (int i = 0; i < n; i++) {
            largest = fmax(largest, fabs(dense[i]));
        }
        assert_true(largest > 1);
        assert_all_near(tape, dense, n, 1e-9 * largest);
    }
}

static const hn_solve_rows *check_model(const hn_model *m) {
    double q[MOST], v[MOST];
    const hn_solve_rows *rows;
    assert_true(m->info.nq <= MOST);
    assert_int_equal(hn_solve_rows_get(m->sys, &rows), HN_OK);
    check_same(m, m->q, m->v);
    disturb(m, q, v);
    check_same(m, q, v);
    return rows;
}

static void legs_have_the_same_solution_in_fewer_operations(void **state) {
    // operations with the legs' rows, and what is saved at least; seen: 679 of 4315, 706 of 4149,
    // 68 of 443
    static const struct {
        const char *name;
        int saved;
    } scenes[] = {{"stewart-6-6", 600}, {"stewart-6-3", 600}, {"rssr", 50}};
    (void)state;
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        hn_model m;
        hn_model_open_closed(&m, scenes[k].name, NULL);
        const hn_solve_rows *rows = check_model(&m);
        assert_true(rows->of_legs);
        int saved;
        assert_int_equal(hn_solve_rows_saved(m.sys, &saved), HN_OK);
        assert_true(saved > scenes[k].saved);
        hn_model_close(&m);
    }
}

static void the_cheaper_rows_are_taken(void **state) {
    static const char *const names[] = {"spatial-slider-crank", "bennett", "cardan-shaft",
                                        "delta-robot", "four-bar"};
    (void)state;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        hn_model m;
        const hn_solve_rows *rows;
        hn_model_open_closed(&m, names[k], NULL);
        assert_int_equal(hn_solve_rows_get(m.sys, &rows), HN_OK);
        assert_int_equal(rows->of_legs, rows->work_legs > 0 && rows->work_legs < rows->work_own);
        int saved;
        assert_int_equal(hn_solve_rows_saved(m.sys, &saved), HN_OK);
        assert_true(saved >= 0);
        hn_model_close(&m);
    }
}

/// J v, gamma and phi of one row.
static void put_row(hn_graph *g, const hn_entries *J, int row, const hn_ex *v, hn_ex gamma,
                    hn_ex phi, hn_ex *out) {
    out[0] = hn_num(0);
    for (int k = 0; k < J->n; k++) {
        if (J->at[k].row == row) {
            out[0] = hn_add(g, out[0], hn_mul(g, J->at[k].e, v[J->at[k].col]));
        }
    }
    out[1] = gamma;
    out[2] = phi;
}

/// The rows of a leg, turned, against the system's own at an open state: ROUNDING is some ten
/// roundings of numbers of the size of one.
static void check_leg(const hn_model *m, const hn_leg *leg) {
    enum { VALUES = 3, OUT = 9 + 2 * 3 * VALUES };
    const double ROUNDING = 1e-13;
    const hn_system *sys = m->sys;
    hn_ex out[OUT];
    hn_inputs in;
    double q[MOST], v[MOST];
    for (int i = 0; i < 3; i++) {
        memcpy(out + 3 * i, leg->turn.x[i], 3 * sizeof *out);
        put_row(sys->g, &leg->J, leg->row + i, sys->v, leg->gamma[i], leg->phi[i],
                out + 9 + VALUES * i);
        put_row(sys->g, &sys->J, leg->row + i, sys->v, sys->gamma[leg->row + i],
                sys->phi[leg->row + i], out + 9 + VALUES * (3 + i));
    }
    assert_int_equal(hn_inputs_compile(sys, out, OUT, m->arena, &in), HN_OK);
    disturb(m, q, v);
    hn_inputs_set(&in, 0.1, q, v, 0, 0);
    hn_tape_run(in.tape, in.x);
    for (int k = 0; k < VALUES; k++) {
        for (int i = 0; i < 3; i++) {
            double turned = 0;
            for (int j = 0; j < 3; j++) {
                turned += in.x[in.slots[3 * i + j]] * in.x[in.slots[9 + VALUES * j + k]];
            }
            assert_near(turned, in.x[in.slots[9 + VALUES * (3 + i) + k]], ROUNDING);
        }
    }
    hn_inputs_free(&in);
}

static void check_legs(const hn_model *m) {
    assert_true(m->sys->n_legs > 0);
    for (int k = 0; k < m->sys->n_legs; k++) {
        check_leg(m, &m->sys->legs[k]);
    }
}

// every leg has a given length, so that its rows get a pivot from the platform alone: they wait for
// all of it. Before they did, the pivots of all such states were lost and the dense solve answered.
static void a_platform_on_legs_of_given_lengths_keeps_its_pivots(void **state) {
    hn_model m;
    (void)state;
    hn_model_open_closed(&m, "stewart-turning", NULL);
    const hn_solve_rows *rows = check_model(&m); // asserts that nothing fell back
    assert_true(rows->of_legs);
    hn_model_close(&m);
}

static void rows_of_legs_are_the_systems_own_turned(void **state) {
    static const char *const names[] = {"stewart-6-6", "rssr",         "spatial-slider-crank",
                                        "bennett",     "cardan-shaft", "stewart-turning"};
    (void)state;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        hn_model m;
        hn_model_open_closed(&m, names[k], NULL);
        check_legs(&m);
        hn_model_close(&m);
    }
}

static void a_slide_a_reversed_joint_and_three_axes(void **state) {
    hn_model m;
    (void)state;
    hn_model_open_text(&m, CHAIN, NULL);
    assert_int_equal(m.status, HN_OK);
    check_legs(&m);
    check_model(&m);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(legs_have_the_same_solution_in_fewer_operations),
        cmocka_unit_test(a_platform_on_legs_of_given_lengths_keeps_its_pivots),
        cmocka_unit_test(rows_of_legs_are_the_systems_own_turned),
        cmocka_unit_test(the_cheaper_rows_are_taken),
        cmocka_unit_test(a_slide_a_reversed_joint_and_three_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
