// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/alloc.h"
#include "support/model.h"
#include "support/near.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "integrators/external/ida_jacobian.h"
#include "integrators/external/ida_words.h"
#include "integrators/list/stepper_list.h"

#include <math.h>
#include <string.h>

static const hn_dae_form forms[] = {HN_FORM_INDEX1, HN_FORM_STABILISED, HN_FORM_INDEX2,
                                    HN_FORM_INDEX3, HN_FORM_GGL};
enum { N_FORMS = sizeof forms / sizeof *forms, ROOM = 96 };
static const double stabilisation[3] = {7, 5, 0};

// ---- the matrix of Newton's method ----

static double column_error(hn_ida_problem *p, double t, double c, const double *y,
                           const double *ydot, const double *A, int col) {
    const double d = 1e-6 * (1 + fabs(y[col]));
    double at[ROOM], rate[ROOM], above[ROOM], below[ROOM], worst = 0, size = 1;
    for (int side = 0; side < 2; side++) {
        memcpy(at, y, (size_t)p->n * sizeof *at);
        memcpy(rate, ydot, (size_t)p->n * sizeof *rate);
        at[col] += side ? -d : d;
        rate[col] += c * (side ? -d : d);
        hn_ida_problem_residual(p, t, at, rate, side ? below : above);
    }
    for (int i = 0; i < p->n; i++) {
        const double exact = A[col * p->n + i];
        size = fmax(size, fabs(exact));
        worst = fmax(worst, fabs((above[i] - below[i]) / (2 * d) - exact));
    }
    return worst / size;
}

// the same matrix entry by entry; returns 0 where it is full
static int check_sparse(hn_ida_jacobian *j, double t, double c, const double *y, const double *ydot,
                        const double *A) {
    if (!hn_ida_jacobian_is_sparse(j)) {
        return 0;
    }
    const double *values;
    const int n = j->problem->n;
    double full[ROOM * ROOM] = {0};
    for (int again = 0; again < 2; again++) {
        const hn_compressed *at = hn_ida_jacobian_fill_sparse(j, t, c, y, ydot, &values);
        memset(full, 0, sizeof full);
        for (int col = 0; col < n; col++) {
            for (int e = at->start[col]; e < at->start[col + 1]; e++) {
                full[col * n + at->row[e]] = values[e];
            }
        }
    }
    assert_all_near(full, A, n * n, 1e-12);
    return 1;
}

// away from the loop's manifold, so that nothing vanishes by accident; mu and q' - v are small, as
// the matrix takes for granted
static int check_matrix(const hn_model *m, hn_dae_form form) {
    hn_arena *arena = hn_arena_create(0);
    hn_ida_problem p;
    hn_ida_jacobian j;
    hn_diag diag = {0};
    double state[ROOM], y[ROOM], ydot[ROOM], A[ROOM * ROOM];
    const double t = 0.3, c = 40;
    assert_int_equal(hn_ida_problem_init(&p, m->sys, form, stabilisation, arena, &diag), HN_OK);
    assert_int_equal(hn_ida_jacobian_init(&j, &p, arena), HN_OK);
    assert_true(hn_ida_problem_room(&p) <= ROOM);
    memcpy(state, m->q, (size_t)m->info.nq * sizeof *state);
    for (int i = 0; i < m->info.nv; i++) {
        state[m->info.nq + i] = m->v[i] + 0.3 * sin(i + 1);
    }
    assert_int_equal(hn_ida_problem_start(&p, t, state, y, ydot), HN_OK);
    for (int i = 0; i < p.nv; i++) {
        ydot[p.nq + i] += cos(3 * i); // accelerations that do not balance
    }
    hn_ida_jacobian_fill(&j, t, c, y, ydot, A);
    for (int col = 0; col < p.n; col++) {
        // central differences: 1e-12 of truncation, 1e-10 of rounding, times the curvature of the
        // formulas
        const double err = column_error(&p, t, c, y, ydot, A, col);
        if (!(err < 1e-6)) {
            fail_msg("%s: column %d of %d is off by %g", hn_form_name(form), col, p.n, err);
        }
    }
    const int sparse = check_sparse(&j, t, c, y, ydot, A);
    hn_ida_jacobian_free(&j);
    hn_ida_problem_free(&p);
    hn_arena_free(arena);
    return sparse;
}

static void the_matrix_is_the_derivative_of_the_residual(void **state) {
    (void)state;
    static const char *const scenes[] = {"fb0",     "fb0-lagrangian", "caraxis",
                                         "andrews", "fb0-tilted",     "n-four-bar"};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        hn_model m;
        hn_model_open_closed(&m, scenes[i], NULL);
        for (int k = 0; k < N_FORMS; k++) {
            (void)check_matrix(&m, forms[k]);
        }
        hn_model_close(&m);
    }
}

static void a_large_matrix_is_filled_entry_by_entry(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=10");
    for (int k = 0; k < N_FORMS; k++) {
        assert_true(check_matrix(&m, forms[k]));
    }
    hn_model_close(&m);
}

// ---- the stepper ----

typedef struct trial {
    hn_model m;
    hn_arena *arena;
    void *self;
    double y[ROOM], next[ROOM], t;
} trial;

static const double never[HN_MAX_OPTIONS] = {-1}; // index 2: positions are not projected
static const double none[HN_MAX_OPTIONS] = {0};   // index 3: nor are speeds

static const hn_dae_stepper *ida(void) {
    return hn_stepper_ida.dae;
}

static void open(trial *x, const char *scene, hn_dae_form form, double rtol) {
    double options[HN_MAX_OPTIONS];
    hn_diag diag = {0};
    hn_model_open_closed(&x->m, scene, NULL);
    for (int i = 0; i < hn_stepper_ida.n_options; i++) {
        options[i] = hn_stepper_ida.options[i].initial;
    }
    options[0] = rtol;
    x->arena = hn_arena_create(0);
    x->t = 0;
    memcpy(x->y, x->m.q, (size_t)x->m.info.nq * sizeof *x->y);
    memcpy(x->y + x->m.info.nq, x->m.v, (size_t)x->m.info.nv * sizeof *x->y);
    assert_int_equal(ida()->create(x->m.sys, form, options,
                                   form == HN_FORM_INDEX2   ? never
                                   : form == HN_FORM_INDEX3 ? none
                                                            : stabilisation,
                                   x->arena, &x->self, &diag),
                     HN_OK);
    assert_int_equal(ida()->start(x->self, 0, x->y), HN_OK);
}

static void step(trial *x, double t_stop, int changed) {
    double t_new = nan("");
    if (ida()->advance(x->self, x->t, t_stop, x->y, &t_new, x->next) != HN_OK) {
        fail_msg("%s", ida()->why(x->self));
    }
    ida()->on_accepted(x->self, changed);
    memcpy(x->y, x->next, sizeof x->y);
    x->t = t_new;
}

static void close_trial(trial *x) {
    ida()->destroy(x->self);
    hn_arena_free(x->arena);
    hn_model_close(&x->m);
}

static void it_lands_where_it_is_stopped(void **state) {
    (void)state;
    for (int k = 0; k < N_FORMS; k++) {
        trial x;
        open(&x, "fb0", forms[k], forms[k] == HN_FORM_INDEX3 ? 1e-3 : 1e-7);
        while (x.t < 0.5) {
            step(&x, 0.5, 0);
        }
        assert_near(x.t, 0.5, 0);
        close_trial(&x);
    }
}

static void between_steps_the_history_answers(void **state) {
    (void)state;
    trial x, fine;
    double inner[ROOM], start[ROOM];
    open(&x, "fb0", HN_FORM_INDEX2, 1e-8);
    open(&fine, "fb0", HN_FORM_INDEX1, 1e-11);
    for (int i = 0; i < 60; i++) {
        step(&x, HUGE_VAL, 0);
    }
    memcpy(start, x.y, sizeof start);
    const double before = x.t;
    step(&x, HUGE_VAL, 0);
    const double middle = 0.5 * (before + x.t);
    while (fine.t < middle) {
        step(&fine, middle, 0);
    }
    const int n = x.m.info.nq + x.m.info.nv;
    ida()->dense(x.self, 0.5, inner);
    assert_all_near(inner, fine.y, n, 1e-6); // the tolerance, summed over 60 steps
    ida()->dense(x.self, 1, inner);
    assert_all_near(inner, x.y, n, 1e-14);
    ida()->dense(x.self, 0, inner);
    assert_all_near(inner, start, n,
                    1e-7); // the polynomial of the step meets the last one to the tolerance
    close_trial(&fine);
    close_trial(&x);
}

static void a_state_changed_beyond_the_tolerance_is_gone_on_from(void **state) {
    (void)state;
    trial x;
    open(&x, "pendulum", HN_FORM_INDEX2, 1e-8);
    for (int i = 0; i < 20; i++) {
        step(&x, HUGE_VAL, 0);
    }
    ida()->on_accepted(x.self, 1);
    x.y[0] += 0.5;
    const double there = x.y[0];
    step(&x, HUGE_VAL, 0);
    assert_near(x.y[0], there, 0.05); // one step on, not half a radian back
    close_trial(&x);
}

static void its_own_multipliers_are_near_those_of_the_saddle_system(void **state) {
    (void)state;
    trial x;
    open(&x, "fb0", HN_FORM_INDEX1, 1e-9);
    while (x.t < 0.4) {
        step(&x, 0.4, 0);
    }
    hn_accel *accel;
    hn_accel_info info;
    double a[ROOM], lambda[ROOM];
    const hn_accel_opts opts = {.want_lambda = 1};
    assert_int_equal(hn_accel_create(x.m.sys, &opts, x.arena, &accel), HN_OK);
    assert_int_equal(hn_accel_eval(accel, x.t, x.y, x.y + x.m.info.nq, 0, 0, a, lambda, &info),
                     HN_OK);
    assert_all_near(ida()->raw_lambda(x.self), lambda, x.m.info.nc, 1e-5);
    hn_accel_free(accel);
    close_trial(&x);
}

static void rows_that_depend_on_others_are_left_out(void **state) {
    (void)state;
    static const char *const scenes[] = {"fb0-redundant", "fb0-tilted"};
    trial plain;
    open(&plain, "fb0", HN_FORM_GGL, 1e-9);
    while (plain.t < 0.5) {
        step(&plain, 0.5, 0);
    }
    for (int i = 0; i < 2; i++) {
        trial x;
        open(&x, scenes[i], HN_FORM_GGL, 1e-9);
        while (x.t < 0.5) {
            step(&x, 0.5, 0);
        }
        hn_system_to_user(x.m.sys, x.y, x.m.user_q);
        hn_system_to_user(plain.m.sys, plain.y, plain.m.user_q);
        assert_near(x.m.user_q[0], plain.m.user_q[0], 1e-6);
        close_trial(&x);
    }
    close_trial(&plain);
}

static void our_own_code_allocates_nothing_in_a_step(void **state) {
    (void)state;
    for (int k = 0; k < N_FORMS; k++) {
        trial x;
        open(&x, "fb0", forms[k], 1e-4);
        const long before = hn_alloc_count();
        for (int i = 0; i < 10; i++) {
            step(&x, HUGE_VAL, 0);
        }
        assert_int_equal(hn_alloc_count(), before);
        close_trial(&x);
    }
}

static void a_flag_is_told_in_words(void **state) {
    (void)state;
    char why[200] = "";
    assert_int_equal(hn_ida_status(0, 0, why, sizeof why), HN_OK);
    assert_string_equal(why, "");
    assert_int_equal(hn_ida_status(-4, 0, why, sizeof why), HN_ERR_NO_CONVERGENCE);
    assert_string_equal(why, "IDA: the corrector did not converge at t = 0 s (flag -4)");
    assert_int_equal(hn_ida_status(-3, 1.5, why, sizeof why), HN_ERR_STEP_UNDERFLOW);
    assert_non_null(strstr(why, "t = 1.5 s (flag -3)"));
    assert_int_equal(hn_ida_status(-99, 1, why, sizeof why), HN_ERR_INTERNAL);
}

static void a_rule_that_follows_the_steps_is_refused(void **state) {
    (void)state;
    hn_model m;
    hn_ida_problem p;
    hn_diag diag = {0};
    hn_arena *arena = hn_arena_create(0);
    const double automatic[3] = {5, 5, 1};
    hn_model_open_closed(&m, "fb0", NULL);
    assert_int_equal(hn_ida_problem_init(&p, m.sys, HN_FORM_STABILISED, automatic, arena, &diag),
                     HN_ERR_UNSUPPORTED);
    assert_non_null(strstr(diag.message, "rule=auto"));
    hn_model_close(&m);
    hn_arena_free(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_matrix_is_the_derivative_of_the_residual),
        cmocka_unit_test(a_large_matrix_is_filled_entry_by_entry),
        cmocka_unit_test(it_lands_where_it_is_stopped),
        cmocka_unit_test(between_steps_the_history_answers),
        cmocka_unit_test(a_state_changed_beyond_the_tolerance_is_gone_on_from),
        cmocka_unit_test(its_own_multipliers_are_near_those_of_the_saddle_system),
        cmocka_unit_test(rows_that_depend_on_others_are_left_out),
        cmocka_unit_test(our_own_code_allocates_nothing_in_a_step),
        cmocka_unit_test(a_flag_is_told_in_words),
        cmocka_unit_test(a_rule_that_follows_the_steps_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
