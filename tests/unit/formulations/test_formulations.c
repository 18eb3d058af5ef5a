// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/alloc.h"
#include "support/near.h"
#include "support/trial.h"

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "formulations/ground/formulation.h"
#include "formulations/list/formulation_list.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Every formulation at one state, through its table alone: the acceleration it implies, against the
// saddle-point solve.

enum { MAX = 64 };

static const char *const scenes[] = {
    HN_TRIAL_LESSON "fb0.json",
    HN_TRIAL_LESSON "fb0-lagrangian.json",
    HN_TRIAL_LESSON "four-bar.json",
    HN_TRIAL_LESSON "slider-crank.json",
    HN_TRIAL_LESSON "five-bar.json",
    HN_TRIAL_LESSON "four-angles-as-printed.json",
    HN_TRIAL_LESSON "double-pendulum.json",
    HN_TRIAL_LESSON "pendulum.json",
    HN_TRIAL_LESSON "n-four-bar.json",
    "tests/scenes/fb0-redundant.json",
    "tests/scenes/fb0-tilted.json",
};
enum { N_SCENES = sizeof scenes / sizeof scenes[0] };

typedef struct instance {
    const hn_formulation *f;
    hn_arena *arena;
    void *self;
    hn_ode ode;
    double y[2 * MAX];
} instance;

static void open_instance(instance *in, const hn_formulation *f, const hn_trial *trial) {
    double options[HN_MAX_OPTIONS] = {0};
    hn_diag diag = {0};
    for (int i = 0; i < f->n_options; i++) {
        options[i] = f->options[i].initial;
    }
    *in = (instance){.f = f, .arena = hn_arena_create(0)};
    assert_int_equal(f->create(trial->sys, options, in->arena, &in->self, &diag), HN_OK);
    assert_int_equal(f->set_state(in->self, 0, trial->q, trial->v, in->y), HN_OK);
    f->ode(in->self, &in->ode);
}

static void close_instance(instance *in) {
    in->f->destroy(in->self);
    hn_arena_free(in->arena);
}

static void reference_acceleration(const hn_trial *trial, const double *q, const double *v,
                                   double *a) {
    hn_arena *arena = hn_arena_create(0);
    const hn_accel_opts opts = {.want_lambda = 1};
    hn_accel *accel = NULL;
    double lambda[MAX];
    assert_int_equal(hn_accel_create(trial->sys, &opts, arena, &accel), HN_OK);
    assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, lambda, NULL), HN_OK);
    hn_accel_free(accel);
    hn_arena_free(arena);
}

// speeds after a short step along y', by the formulation's own map: v(t + e) and v(t - e) give its
// acceleration
static void implied_acceleration(instance *in, const hn_trial *trial, double *a) {
    const int n = in->ode.n_pos + in->ode.n_vel;
    const double e = 1e-5;
    double ydot[2 * MAX], y[2 * MAX], q[MAX], forward[MAX], back[MAX];
    assert_int_equal(in->ode.rhs(in->ode.self, 0, in->y, ydot), HN_OK);
    for (int i = 0; i < n; i++) {
        y[i] = in->y[i] + e * ydot[i];
    }
    assert_int_equal(in->f->get_state(in->self, e, y, q, forward), HN_OK);
    for (int i = 0; i < n; i++) {
        y[i] = in->y[i] - e * ydot[i];
    }
    assert_int_equal(in->f->get_state(in->self, -e, y, q, back), HN_OK);
    for (int i = 0; i < trial->info.nv; i++) {
        a[i] = (forward[i] - back[i]) / (2 * e);
    }
}

static void every_sound_formulation_implies_the_same_acceleration(void **state) {
    (void)state;
    for (int s = 0; s < N_SCENES; s++) {
        hn_trial trial;
        double a[MAX];
        hn_trial_open(&trial, scenes[s]);
        reference_acceleration(&trial, trial.q, trial.v, a);
        for (int i = 0; i < hn_formulation_count(); i++) {
            instance in;
            double implied[MAX], size = 1;
            if (hn_formulation_at(i)->model_error || hn_formulation_at(i)->form != HN_FORM_ODE) {
                continue;
            }
            open_instance(&in, hn_formulation_at(i), &trial);
            implied_acceleration(&in, &trial, implied);
            for (int k = 0; k < trial.info.nv; k++) {
                size = fmax(size, fabs(a[k]));
            }
            // central difference: e^2 times third derivatives, and rounding over e
            assert_all_near(implied, a, (size_t)trial.info.nv, 2e-7 * size);
            close_instance(&in);
        }
        hn_trial_close(&trial);
    }
}

static void the_printed_null_space_form_implies_another_acceleration(void **state) {
    (void)state;
    hn_trial trial;
    instance in;
    double a[MAX], implied[MAX];
    hn_trial_open(&trial, scenes[0]);
    reference_acceleration(&trial, trial.q, trial.v, a);
    open_instance(&in, hn_formulation_find("nullspace-as-printed"), &trial);
    implied_acceleration(&in, &trial, implied);
    assert_true(fabs(implied[0] - a[0]) > 0.1);
    close_instance(&in);
    hn_trial_close(&trial);
}

static void state_goes_in_and_comes_out_unchanged(void **state) {
    (void)state;
    for (int s = 0; s < N_SCENES; s++) {
        hn_trial trial;
        hn_trial_open(&trial, scenes[s]);
        for (int i = 0; i < hn_formulation_count(); i++) {
            instance in;
            double q[MAX], v[MAX];
            if (hn_formulation_at(i)->form != HN_FORM_ODE) {
                continue;
            }
            open_instance(&in, hn_formulation_at(i), &trial);
            hn_poison_fill(q, MAX);
            hn_poison_fill(v, MAX);
            assert_int_equal(in.f->get_state(in.self, 0, in.y, q, v), HN_OK);
            assert_all_near(q, trial.q, (size_t)trial.info.nq, 1e-12);
            assert_all_near(v, trial.v, (size_t)trial.info.nv, 1e-11);
            close_instance(&in);
        }
        hn_trial_close(&trial);
    }
}

static void reading_a_state_elsewhere_leaves_the_right_hand_side_as_it_was(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, scenes[0]);
    for (int i = 0; i < hn_formulation_count(); i++) {
        instance in;
        double first[2 * MAX], again[2 * MAX], y[2 * MAX], q[MAX], v[MAX];
        if (hn_formulation_at(i)->form != HN_FORM_ODE) {
            continue;
        }
        open_instance(&in, hn_formulation_at(i), &trial);
        const int n = in.ode.n_pos + in.ode.n_vel;
        assert_int_equal(in.ode.rhs(in.ode.self, 0, in.y, first), HN_OK);
        memcpy(y, in.y, sizeof y);
        y[0] += 0.01;
        assert_int_equal(in.f->get_state(in.self, 0.01, y, q, v), HN_OK);
        assert_int_equal(in.ode.rhs(in.ode.self, 0, in.y, again), HN_OK);
        assert_memory_equal(first, again, (size_t)n * sizeof *first);
        close_instance(&in);
    }
    hn_trial_close(&trial);
}

static void right_hand_sides_and_mending_do_not_allocate(void **state) {
    (void)state;
    for (int s = 0; s < N_SCENES; s++) {
        hn_trial trial;
        hn_trial_open(&trial, scenes[s]);
        for (int i = 0; i < hn_formulation_count(); i++) {
            instance in;
            double ydot[2 * MAX];
            int changed = 0;
            if (hn_formulation_at(i)->form != HN_FORM_ODE) {
                continue;
            }
            open_instance(&in, hn_formulation_at(i), &trial);
            const long before = hn_alloc_count();
            for (int k = 0; k < 5; k++) {
                assert_int_equal(in.ode.rhs(in.ode.self, 0, in.y, ydot), HN_OK);
                for (int j = 0; j < in.ode.n_pos + in.ode.n_vel; j++) {
                    in.y[j] += 1e-3 * ydot[j];
                }
                if (in.f->after_step) {
                    assert_int_equal(in.f->after_step(in.self, 0, in.y, &changed), HN_OK);
                }
            }
            assert_int_equal(hn_alloc_count(), before);
            close_instance(&in);
        }
        hn_trial_close(&trial);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_sound_formulation_implies_the_same_acceleration),
        cmocka_unit_test(the_printed_null_space_form_implies_another_acceleration),
        cmocka_unit_test(state_goes_in_and_comes_out_unchanged),
        cmocka_unit_test(reading_a_state_elsewhere_leaves_the_right_hand_side_as_it_was),
        cmocka_unit_test(right_hand_sides_and_mending_do_not_allocate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
