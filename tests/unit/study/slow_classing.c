// SPDX-License-Identifier: GPL-3.0-or-later
// Model error or discretisation error, on eight scenes: the null-space form as the lesson prints it
// is told from the truth by its points alone, and no sound method is accused.
#include "support/near.h"
#include "support/trial.h"

#include "study/cost/classing.h"
#include "study/cost/measure.h"

#include <stdio.h>

#define LESSONS "lessons/"
static const struct {
    const char *path;
    double T;
} SCENES[] = {
    {LESSONS "01-closed-loops/scenes/fb0.json", 1},
    {LESSONS "01-closed-loops/scenes/four-bar.json", 1},
    {LESSONS "01-closed-loops/scenes/slider-crank.json", 1},
    {LESSONS "01-closed-loops/scenes/five-bar.json", 1},
    {LESSONS "11-cabinet/scenes/watt-six-bar.json", 1},
    {LESSONS "11-cabinet/scenes/quick-return.json", 1},
    {LESSONS "11-cabinet/scenes/3-rrr.json", 1},
    {LESSONS "11-cabinet/scenes/scott-russell.json", 1},
};
enum { N_SCENES = sizeof SCENES / sizeof *SCENES };

static const char *const SOUND[] = {
    "index1@rk4",         "baumgarte@rk4", "projection@rk4",    "nullspace@rk4",
    "udwadia-kalaba@rk4", "index1@dopri5", "projection@dop853", "projection@gsl-rk8pd",
    "ggl@radau5:h=1e-3",  "ggl@radau3",    "index2@hem4",       "index3@rattle",
    "index3@genalpha",
};
enum { N_SOUND = sizeof SOUND / sizeof *SOUND, N_ALL = N_SOUND + 1, MOST = 9 };

static hn_wp *ladders_of(const hn_trial *trial, const char *path, double T, hn_ref **ref) {
    hn_method_spec specs[N_ALL];
    hn_diag diag = {0};
    hn_wp *wp = NULL;
    const hn_wp_opts opts = {.n_samples = -1, .n_levels = 6};
    for (int i = 0; i < N_SOUND; i++) {
        specs[i] = hn_trial_spec(SOUND[i]);
    }
    specs[N_SOUND] = hn_trial_spec("nullspace-as-printed@rk4");
    if (hn_ref_create(trial->sys, trial->q, trial->v, T, NULL, ref, &diag) != HN_OK ||
        hn_wp_create(trial->sys, trial->q, trial->v, *ref, specs, N_ALL, &opts, &wp, &diag) !=
            HN_OK) {
        fail_msg("%s: %s", path, diag.message);
    }
    assert_true(hn_wp_run(wp, NULL));
    return wp;
}

/// The finding in words, for whoever reads a failure.
static void print_all(const hn_wp *wp, const char *path) {
    print_message("%s: reference to %.1f digits\n", path, hn_ref_digits(wp->ref));
    for (int m = 0; m < wp->n_methods; m++) {
        hn_class c;
        hn_wp_classify(wp, m, &c);
        print_message("  %-28s %s\n", wp->methods[m].spelling, c.text);
    }
}

/// Sound methods have to be told as sound, most of them with the order of their integrator.
static int judge(const hn_wp *wp) {
    int sound = 0, wrong = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        hn_class c;
        hn_wp_classify(wp, m, &c);
        wrong += (c.kind == HN_CLASS_ELSEWHERE) != (m == N_SOUND);
        sound += c.kind == HN_CLASS_FLOOR || (c.kind == HN_CLASS_CONVERGES && c.as_theory);
        // what a scene cannot be served by is refused, not run to a wrong end
        wrong += c.kind == HN_CLASS_FAILED && wp->methods[m].point[0].status != HN_ERR_UNSUPPORTED;
    }
    return !wrong && sound >= MOST;
}

static void the_printed_form_is_caught_and_no_sound_method_is_accused(void **state) {
    (void)state;
    for (int s = 0; s < N_SCENES; s++) {
        hn_trial trial;
        hn_ref *ref = NULL;
        hn_trial_open(&trial, SCENES[s].path);
        hn_wp *wp = ladders_of(&trial, SCENES[s].path, SCENES[s].T, &ref);
        if (!judge(wp)) {
            print_all(wp, SCENES[s].path);
            fail_msg("%s: a method is in the wrong class", SCENES[s].path);
        }
        hn_wp_free(wp);
        hn_ref_free(ref);
        hn_trial_close(&trial);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_printed_form_is_caught_and_no_sound_method_is_accused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
