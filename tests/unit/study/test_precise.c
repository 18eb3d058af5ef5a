// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"
#include "support/trial.h"

#include "study/truth/precise.h"

#include <math.h>
#include <string.h>

enum { N = 8, MOST = 64 };

typedef struct seen {
    int n_user, nc, n;
    double t[N + 1], q[N + 1][MOST], v[N + 1][MOST], lambda[N + 1][MOST], energy[N + 1];
} seen;

static int keep(void *user, int k, const hn_sample *s) {
    seen *r = user;
    r->t[k] = s->t;
    memcpy(r->q[k], s->q, (size_t)r->n_user * sizeof(double));
    memcpy(r->v[k], s->v, (size_t)r->n_user * sizeof(double));
    memcpy(r->lambda[k], s->lambda, (size_t)r->nc * sizeof(double));
    r->energy[k] = s->energy;
    r->n = k + 1; // it may begin again
    return 1;
}

static const hn_precise_kind kinds[] = {HN_PRECISE_SADDLE, HN_PRECISE_NULLSPACE};

static void follow(const hn_trial *trial, hn_precise_kind kind, double T, seen *r) {
    hn_diag diag = {0};
    hn_walk_end end;
    *r = (seen){.n_user = trial->info.n_user, .nc = trial->info.nc};
    if (hn_precise_walk(kind, trial->sys, trial->q, trial->v, T, N, NULL, keep, r, &end, &diag) !=
        HN_OK) {
        fail_msg("%s: %s", hn_precise_name(kind), diag.message);
    }
    assert_int_equal(end, HN_WALK_DONE);
    assert_int_equal(r->n, N + 1);
}

static double apart(const seen *a, const seen *b) {
    double most = 0;
    for (int k = 0; k <= N; k++) {
        for (int i = 0; i < a->n_user; i++) {
            most = fmax(most, fabs(a->q[k][i] - b->q[k][i]));
        }
    }
    return most;
}

// th1, th2, th3, w1 of FB0 at t = 2: one-coordinate equation by extrapolation in 30-digit
// arithmetic
static void the_reference_four_bar_has_every_digit_of_a_double(void **state) {
    (void)state;
    const double known[3] = {7.41136679869211579, 0.464690378889553311, 1.56178258771354034};
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json");
    for (int m = 0; m < 2; m++) {
        seen r;
        follow(&trial, kinds[m], 2, &r);
        for (int i = 0; i < 3; i++) {
            // coefficients of the model are rounded to doubles: a few units in the last place of
            // 7.4
            assert_near(r.q[N][i], known[i], 3e-15);
        }
        assert_near(r.v[N][0], 1.57149060850687302, 2e-14);
        assert_near(r.lambda[N][0], -0.4306137880871, 1e-12); // as far as it is known
        assert_near(r.energy[N], r.energy[0], 1e-14);
    }
    hn_trial_close(&trial);
}

// x = sin t^2, y = cos t^2, lambda = -4 t^2 (Arevalo), a load that depends on time
static void a_driven_particle_on_a_circle_follows_its_closed_form(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, "tests/reference/circle-particle.json");
    for (int m = 0; m < 2; m++) {
        seen r;
        follow(&trial, kinds[m], 2, &r);
        for (int k = 0; k <= N; k++) {
            const double t = r.t[k];
            assert_near(r.q[k][0], sin(t * t), 1e-15);
            assert_near(r.q[k][1], cos(t * t), 1e-15);
            assert_near(r.v[k][0], 2 * t * cos(t * t), 5e-15);
        }
    }
    hn_trial_close(&trial);
}

// free rigid body: kinetic energy stays; quaternions turn with it
static void a_spinning_block_keeps_its_energy_to_the_last_digit(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, "lessons/09-space-and-drives/scenes/spinning-block.json");
    seen r[2];
    for (int m = 0; m < 2; m++) {
        follow(&trial, kinds[m], 5, &r[m]);
        for (int k = 0; k <= N; k++) {
            assert_rel(r[m].energy[k], r[m].energy[0], 4e-16);
        }
    }
    assert_near(apart(&r[0], &r[1]), 0, 1e-12); // it tumbles: its middle axis is unstable
    hn_trial_close(&trial);
}

// a load given as a table has corners; steps end there
static void both_computations_agree_over_the_corners_of_a_table(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, "lessons/09-space-and-drives/scenes/planetary-gear.json");
    seen r[2];
    for (int m = 0; m < 2; m++) {
        follow(&trial, kinds[m], 4, &r[m]);
    }
    assert_true(fabs(r[0].q[N][0]) > 1);
    assert_near(apart(&r[0], &r[1]), 0, 1e-13); // angles of tens of radians
    hn_trial_close(&trial);
}

// three rows of five depend on the others, and agree with them only as far as doubles do
static void dependent_rows_are_left_out(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, "lessons/11-cabinet/scenes/bennett.json");
    seen r[2];
    for (int m = 0; m < 2; m++) {
        follow(&trial, kinds[m], 1, &r[m]);
    }
    assert_near(apart(&r[0], &r[1]), 0, 1e-12);
    hn_trial_close(&trial);
}

// the angles of a parallelogram stay equal; it passes its flat pose, where J loses a row
static void a_parallelogram_passes_its_flat_pose_on_its_branch(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, "lessons/11-cabinet/scenes/parallelogram.json");
    for (int m = 0; m < 2; m++) {
        seen r;
        follow(&trial, kinds[m], 5, &r);
        assert_true(fabs(r.q[N][0]) > 10); // many turns
        for (int k = 0; k <= N; k++) {
            assert_near(r.q[k][0] + r.q[k][1], r.q[0][0] + r.q[0][1], 1e-9);
        }
    }
    hn_trial_close(&trial);
}

static int at_once(void *user) {
    (void)user;
    return 1;
}

static void it_stops_on_request_and_out_of_time(void **state) {
    (void)state;
    hn_trial trial;
    hn_trial_open(&trial, HN_TRIAL_LESSON "fb0-lagrangian.json");
    seen r = {.n_user = 3, .nc = 2};
    hn_diag diag = {0};
    hn_walk_end end;
    hn_walk_limits limits = {.stop = at_once};
    assert_int_equal(hn_precise_walk(HN_PRECISE_SADDLE, trial.sys, trial.q, trial.v, 50, N, &limits,
                                     keep, &r, &end, &diag),
                     HN_ERR_STOPPED);
    assert_int_equal(end, HN_WALK_STOPPED);
    limits = (hn_walk_limits){.seconds = 1e-9};
    assert_int_equal(hn_precise_walk(HN_PRECISE_NULLSPACE, trial.sys, trial.q, trial.v, 50, N,
                                     &limits, keep, &r, &end, &diag),
                     HN_ERR_STOPPED);
    assert_int_equal(end, HN_WALK_OVER);
    hn_trial_close(&trial);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_reference_four_bar_has_every_digit_of_a_double),
        cmocka_unit_test(a_driven_particle_on_a_circle_follows_its_closed_form),
        cmocka_unit_test(a_spinning_block_keeps_its_energy_to_the_last_digit),
        cmocka_unit_test(both_computations_agree_over_the_corners_of_a_table),
        cmocka_unit_test(dependent_rows_are_left_out),
        cmocka_unit_test(a_parallelogram_passes_its_flat_pose_on_its_branch),
        cmocka_unit_test(it_stops_on_request_and_out_of_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
