// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/reduced_tape.h"
#include "linalg/dense.h"

#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MAX = 64 };
static const double CLOSED = 1e-15;

/// A scene, J at its start, and the tape for a split.
typedef struct fixture {
    hn_model m;
    hn_eval *terms;
    hn_reduced_tape *tape;
    int dep[MAX], ind[MAX];
    hn_reduced_split split;
} fixture;

/// Opens a scene and makes its tape with the r independent velocities `ind`.
static void begin(fixture *f, const char *name, const int *ind, int r) {
    const unsigned terms = HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J | HN_TERM_GAMMA;
    memset(f, 0, sizeof *f);
    hn_model_open_closed(&f->m, name, NULL);
    assert_int_equal(hn_eval_create_listed(f->m.sys, terms, f->m.arena, &f->terms), HN_OK);
    hn_eval_run(f->terms, 0, f->m.q, f->m.v);
    for (int i = 0; i < f->m.info.nv; i++) {
        bool is_free = false;
        for (int j = 0; j < r; j++) {
            is_free |= ind[j] == i;
        }
        if (!is_free) {
            f->dep[f->split.rank++] = i;
        }
    }
    memcpy(f->ind, ind, (size_t)r * sizeof *ind);
    f->split.r = r;
    f->split.dep = f->dep;
    f->split.ind = f->ind;
    f->split.closed = CLOSED;
    f->split.J = hn_eval_list(f->terms, HN_TERM_J);
    assert_int_equal(hn_reduced_tape_create(f->m.sys, &f->split, f->m.arena, &f->tape), HN_OK);
}

static void end(fixture *f) {
    hn_reduced_tape_free(f->tape);
    hn_eval_free(f->terms);
    hn_model_close(&f->m);
}

static double gap_at(fixture *f, const double *q) {
    hn_eval_run(f->terms, 0, q, f->m.v);
    return hn_norm2(f->m.info.nc, hn_eval_get(f->terms, HN_TERM_PHI));
}

/// J x + phi_t or J x at q.
static void times_J(fixture *f, const double *q, const double *x, bool with_rate, double *out) {
    const int *row, *col, n = hn_eval_pattern(f->terms, HN_TERM_J, &row, &col);
    hn_eval_run(f->terms, 0, q, f->m.v);
    for (int i = 0; i < f->m.info.nc; i++) {
        out[i] = with_rate ? hn_eval_get(f->terms, HN_TERM_PHI_T)[i] : 0;
    }
    for (int k = 0; k < n; k++) {
        out[row[k]] += hn_eval_list(f->terms, HN_TERM_J)[k] * x[col[k]];
    }
}

static const struct {
    const char *name;
    int r, ind[2];
} scenes[] = {{"four-bar", 1, {0}},           {"fb0", 1, {0}},          {"slider-crank", 1, {0}},
              {"five-bar", 2, {0, 2}},        {"watt-six-bar", 1, {0}}, {"quick-return", 1, {0}},
              {"seven-body-squeezer", 1, {0}}};
enum { N_SCENES = sizeof scenes / sizeof *scenes };

static void the_reduced_accelerations_are_those_of_the_whole_system(void **state) {
    (void)state;
    for (int k = 0; k < N_SCENES; k++) {
        fixture f;
        begin(&f, scenes[k].name, scenes[k].ind, scenes[k].r);
        assert_non_null(f.tape);
        hn_accel *accel;
        const hn_accel_opts opts = {0};
        double a[MAX], u[2], u_dot[2], q[MAX], N[MAX * 2], s[MAX], v[MAX];
        for (int j = 0; j < f.split.r; j++) {
            u[j] = f.m.v[f.ind[j]];
        }
        hn_reduced_tape_run(f.tape, 0, f.m.q, u);
        hn_poison_fill(u_dot, 2);
        assert_true(hn_reduced_tape_get_accelerations(f.tape, u_dot));

        // velocities of the basis, and accelerations at them
        memcpy(q, f.m.q, (size_t)f.m.info.nq * sizeof *q);
        hn_reduced_tape_get_position(f.tape, q);
        hn_reduced_tape_get_basis(f.tape, N, s);
        for (int i = 0; i < f.m.info.nv; i++) {
            v[i] = s[i] + hn_dot(f.split.r, N + i * f.split.r, u);
        }
        assert_int_equal(hn_accel_create(f.m.sys, &opts, f.m.arena, &accel), HN_OK);
        assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, NULL, NULL), HN_OK);
        for (int j = 0; j < f.split.r; j++) {
            // the two ways round differently; the squeezer's drive makes accelerations of 1e4
            assert_near(u_dot[j], a[f.ind[j]], 1e-10 * (1 + fabs(a[f.ind[j]])));
        }
        hn_accel_free(accel);
        end(&f);
    }
}

static void one_run_is_one_step_of_newtons_method(void **state) {
    (void)state;
    for (int k = 0; k < N_SCENES; k++) {
        fixture f;
        begin(&f, scenes[k].name, scenes[k].ind, scenes[k].r);
        double q[MAX];
        const double away = 1e-4;
        memcpy(q, f.m.q, (size_t)f.m.info.nq * sizeof *q);
        for (int i = 0; i < f.split.rank; i++) {
            q[f.dep[i]] += away * (i % 2 ? -1 : 1);
        }
        const double before = gap_at(&f, q);
        hn_reduced_tape_run(f.tape, 0, q, f.m.v);
        hn_reduced_tape_get_position(f.tape, q);

        // quadratic: what is left is of the order of the square
        assert_true(gap_at(&f, q) < 1e3 * away * before);
        assert_near(hn_reduced_tape_gap(f.tape), gap_at(&f, q), 1e-14);
        hn_reduced_tape_run(f.tape, 0, q, f.m.v);
        hn_reduced_tape_run(f.tape, 0, q, f.m.v);
        hn_reduced_tape_get_position(f.tape, q);
        assert_true(gap_at(&f, q) < 1e-13);
        end(&f);
    }
}

/// Near a singular configuration a correction of rounding would not be small.
static void a_closed_configuration_stays_as_it_is(void **state) {
    (void)state;
    for (int k = 0; k < N_SCENES; k++) {
        fixture f;
        begin(&f, scenes[k].name, scenes[k].ind, scenes[k].r);
        double q[MAX], again[MAX];
        int runs = 0;
        memcpy(q, f.m.q, (size_t)f.m.info.nq * sizeof *q);
        do {
            hn_reduced_tape_run(f.tape, 0, q, f.m.v);
            hn_reduced_tape_get_position(f.tape, q);
        } while (!(hn_reduced_tape_gap(f.tape) < CLOSED) && ++runs < 20);
        assert_true(runs < 20);
        memcpy(again, q, sizeof q);
        hn_reduced_tape_run(f.tape, 0, again, f.m.v);
        hn_reduced_tape_get_position(f.tape, again);
        assert_memory_equal(q, again, (size_t)f.m.info.nq * sizeof *q);
        end(&f);
    }
}

static void the_basis_moves_along_the_closed_loops(void **state) {
    (void)state;
    for (int k = 0; k < N_SCENES; k++) {
        fixture f;
        begin(&f, scenes[k].name, scenes[k].ind, scenes[k].r);
        double N[MAX * 2], s[MAX], column[MAX], rate[MAX];
        hn_poison_fill(N, MAX * 2);
        hn_poison_fill(s, MAX);
        hn_reduced_tape_run(f.tape, 0, f.m.q, f.m.v);
        hn_reduced_tape_get_basis(f.tape, N, s);
        times_J(&f, f.m.q, s, true, rate);
        assert_near(hn_norm_max(f.m.info.nc, rate), 0, 1e-13);
        for (int j = 0; j < f.split.r; j++) {
            for (int i = 0; i < f.m.info.nv; i++) {
                column[i] = N[i * f.split.r + j];
            }
            assert_near(column[f.ind[j]], 1, 0);
            times_J(&f, f.m.q, column, false, rate);
            assert_near(hn_norm_max(f.m.info.nc, rate), 0, 1e-12);
        }
        end(&f);
    }
}

/// The rocker of a crank-rocker cannot go on where crank and coupler lie on one line: on the way
/// there the determinant falls to zero, and the tape says so while the loops still close.
static void pivots_are_in_doubt_near_a_dead_point_alone(void **state) {
    (void)state;
    enum { MOST_STEPS = 4000 };
    fixture f;
    const int ind[] = {2};
    double q[MAX], last = 0, gap = 0;
    int steps = 0;
    begin(&f, "four-bar", ind, 1);
    hn_reduced_tape_run(f.tape, 0, f.m.q, f.m.v);
    hn_reduced_tape_take_measure(f.tape);
    const double start = fabs(hn_reduced_tape_determinant(f.tape));
    memcpy(q, f.m.q, (size_t)f.m.info.nq * sizeof *q);
    for (; steps < MOST_STEPS && hn_reduced_tape_is_sure(f.tape); steps++) {
        last = fabs(hn_reduced_tape_determinant(f.tape));
        gap = hn_reduced_tape_gap(f.tape);
        q[ind[0]] += 1e-3;
        for (int run = 0; run < 4; run++) { // near the dead point convergence is slower
            hn_reduced_tape_run(f.tape, 0, q, f.m.v);
            hn_reduced_tape_get_position(f.tape, q);
        }
    }

    // in doubt at about a hundredth of the measure: a step of 1e-3 rad is up to two tenths of it
    assert_in_range(steps, 100, MOST_STEPS - 1);
    assert_true(last < 0.2 * start);
    assert_near(gap, 0, 1e-12);
    end(&f);
}

static void what_it_cannot_serve_has_no_tape(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int r, ind[3];
    } others[] = {{"rssr", 1, {0}}, {"pendulum", 1, {0}}, {"fb0-redundant", 1, {0}}};
    for (int k = 0; k < 3; k++) {
        fixture f;
        begin(&f, others[k].name, others[k].ind, others[k].r);
        assert_null(f.tape);
        end(&f);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_reduced_accelerations_are_those_of_the_whole_system),
        cmocka_unit_test(one_run_is_one_step_of_newtons_method),
        cmocka_unit_test(a_closed_configuration_stays_as_it_is),
        cmocka_unit_test(the_basis_moves_along_the_closed_loops),
        cmocka_unit_test(pivots_are_in_doubt_near_a_dead_point_alone),
        cmocka_unit_test(what_it_cannot_serve_has_no_tape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
