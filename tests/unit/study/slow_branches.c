// SPDX-License-Identifier: GPL-3.0-or-later
// No run ends on another branch of the motion without a word: many methods over many steps and
// tolerances, on mechanisms whose branches cross or come close. Where the run stands is judged by
// closed forms.

#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

static const char *const fixed_step[] = {"index1@rk4",
                                         "baumgarte:alpha=10,beta=10@rk4",
                                         "projection@rk4",
                                         "nullspace@rk4",
                                         "projection:what=velocity@rk4",
                                         "projection@gauss2",
                                         "projection@midpoint",
                                         "penalty@rk4",
                                         "augmented-lagrangian@rk4",
                                         "ggl@genalpha",
                                         "udwadia-kalaba@rk4",
                                         "index3@genalpha",
                                         "index2@midpoint",
                                         "index2@hem4",
                                         "index2@half-explicit-rk4",
                                         "ali3p@trapezoidal"};
static const char *const adaptive[] = {"projection@dopri5", "index1@dopri5",
                                       "baumgarte:alpha=10,beta=10@dopri5", "index2@radau5",
                                       "index2@ida"};

/// Returns how far a state is from the branch of the motion that the mechanism was started on [rad
/// or m].
typedef double (*distance)(const hn_model *m, const hn_sample *s);

static double angle(const hn_model *m, const hn_sample *s, const char *name) {
    return s->q[hn_model_user(m, name)];
}

/// Both cranks turn alike.
static double off_parallelogram(const hn_model *m, const hn_sample *s) {
    return fabs(remainder(angle(m, s, "th1") - angle(m, s, "th3"), 2 * PI));
}

/// tan(th1/2) tan(th2/2) is constant, and th2 = th4 but for whole turns.
static double off_bennett(const hn_model *m, const hn_sample *s) {
    const double a = 0.5 * angle(m, s, "th1"), b = 0.5 * angle(m, s, "th2");
    const double c = 0.5 * m->user_q[hn_model_user(m, "th1")],
                 d = 0.5 * m->user_q[hn_model_user(m, "th2")];
    const double k = tan(c) * tan(d);
    const double same = remainder(angle(m, s, "th2") - angle(m, s, "th4"), 2 * PI);
    return fmax(fabs(same), fabs(sin(a) * sin(b) - k * cos(a) * cos(b)));
}

/// Turned by its legs about the vertical at 1 rad/s, from no angle on, 1 m above the base.
static double off_platform(const hn_model *m, const hn_sample *s) {
    return fmax(fabs(angle(m, s, "ry") - s->t), fabs(angle(m, s, "Y") - 1));
}

static int has_told(const hn_run *run) {
    const hn_incident *incidents = NULL;
    const unsigned serious = 1u << HN_INCIDENT_BRANCH_FLIP | 1u << HN_INCIDENT_GAP_OPEN |
                             1u << HN_INCIDENT_ENERGY_JUMP | 1u << HN_INCIDENT_ENERGY_DRIFT;
    for (int i = 0, n = hn_run_incidents(run, &incidents); i < n; i++) {
        if (serious >> incidents[i].code & 1) {
            return 1;
        }
    }
    return 0;
}

typedef struct tally {
    int on, told, stopped;
} tally;

static void try(const hn_model *m, const char *method, double t, distance off, tally *count) {
    hn_sample s;
    hn_run *run = hn_motion_start(m, method);
    if (hn_run_advance(run, t) != HN_OK) {
        const hn_run_summary summary = hn_run_get_summary(run);
        assert_true(strlen(summary.reason) > 0);
        count->stopped++;
    } else {
        assert_int_equal(hn_run_sample(run, hn_run_time(run), &s), HN_OK);
        const double away = off(m, &s);
        if (away > 1e-2 && !has_told(run)) {
            fail_msg("%s ends %g from its branch without a word", method, away);
        }
        count->told += away > 1e-2;
        count->on += away <= 1e-2;
    }
    hn_run_free(run);
}

/// Every `stride`-th method at `sizes` steps or tolerances.
static tally sweep(const char *scene, double t, distance off, int sizes, size_t stride) {
    hn_model m;
    tally count = {0};
    char method[HN_SPEC_MAX];
    hn_model_open_closed(&m, scene, NULL);
    for (int k = 0; k < sizes; k++) {
        const double share = (double)k / (sizes - 1);
        for (size_t i = 0; i < sizeof fixed_step / sizeof *fixed_step; i += stride) {
            snprintf(method, sizeof method, "%s:h=%.5g", fixed_step[i], 0.0023 * pow(8, share));
            try(&m, method, t, off, &count);
        }
        for (size_t i = 0; i < sizeof adaptive / sizeof *adaptive; i += stride) {
            snprintf(method, sizeof method, "%s:rtol=%.3g", adaptive[i], pow(10, -3 - 6 * share));
            try(&m, method, t, off, &count);
        }
    }
    hn_model_close(&m);
    return count;
}

static void no_run_of_a_parallelogram_changes_its_branch_in_silence(void **state) {
    (void)state;
    const tally n = sweep("parallelogram", 2, off_parallelogram, 5, 1);
    assert_true(n.on > 0 && n.told > 0); // of either kind, or nothing was tried
}

static void no_run_of_a_platform_comes_out_of_its_singular_yaw_in_silence(void **state) {
    (void)state;
    const tally n = sweep("stewart-turning", 2.2, off_platform, 3, 4);
    assert_true(n.on > 0 && n.told > 0);
}

static void no_run_of_a_bennett_linkage_leaves_it_in_silence(void **state) {
    (void)state;
    const tally n = sweep("bennett", 2, off_bennett, 3, 1);
    assert_true(n.on > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_run_of_a_parallelogram_changes_its_branch_in_silence),
        cmocka_unit_test(no_run_of_a_platform_comes_out_of_its_singular_yaw_in_silence),
        cmocka_unit_test(no_run_of_a_bennett_linkage_leaves_it_in_silence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
