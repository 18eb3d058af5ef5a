// SPDX-License-Identifier: GPL-3.0-or-later
// The worth of a tolerance: the error of the motion over rtol, by every integrator that chooses
// its own steps, of every scene that has a reference solution.

#include "session/model/model.h"
#include "session/references/reference_store.h"
#include "study/truth/errors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Medians beyond so many times that of the first method are a fault. A factor of ten is what a
/// tolerance promises; how far a motion multiplies the errors of its steps is its own, and the
/// first method, whose error estimate is the plainest, shows it.
static const double KEPT = 10;

/// One that is kept to KEPT, or that is told with its figure only.
typedef struct method {
    const char *text;
    bool is_kept;
} method;

static const method methods[] = {{"projection@dopri5", true},      {"projection@dop853", true},
                                 {"nullspace@dopri5", true},       {"ggl@radau5", true},
                                 {"index3@radau5", true},          {"ggl@ida", true},
                                 {"index2@hem4-adaptive", false},  {"projection@gsl-rk8pd", true},
                                 {"baumgarte@gsl-msadams", false}, {"baumgarte@gsl-msbdf", false},
                                 {"baumgarte@gsl-bsimp", false}};
static const char *const tolerances[] = {"1e-4", "1e-6", "1e-8"};
enum {
    N_METHODS = sizeof methods / sizeof *methods,
    N_TOLERANCES = sizeof tolerances / sizeof *tolerances,
    MOST_SCENES = 64,
    MOST_STEPS = 200000 // several hundred times what the slowest scene needs by the best of them
};

/// Errors over rtol; NaN where a run did not come to the end or is refused.
static double found[MOST_SCENES][N_METHODS][N_TOLERANCES];
static const char *names[MOST_SCENES];
static int n_scenes;

/// Largest error of the coordinates at the times of the reference.
static double error_along(hn_run *run, hn_errors *errors, const hn_ref *ref) {
    double largest = 0;
    for (int k = 1; k <= ref->n; k++) {
        const hn_state_seen exact = hn_ref_at(ref, k);
        hn_sample s;
        if (hn_run_advance(run, exact.t) != HN_OK || hn_run_sample(run, exact.t, &s) != HN_OK) {
            return nan("");
        }
        const hn_state_seen at = {s.t, s.q, s.v, s.lambda, s.energy, s.gap, s.velocity_gap};
        double error[HN_ERROR_COUNT];
        hn_errors_calc(errors, &at, &exact, &ref->scales, error);
        largest = fmax(largest, error[HN_ERROR_Q]);
    }
    return largest;
}

static double measure(const hn_model *model, const hn_ref *ref, const char *text,
                      const char *rtol) {
    char spelled[HN_SPEC_MAX];
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run *run = NULL;
    hn_errors *errors = NULL;
    hn_run_opts opts = hn_run_opts_default();
    hn_arena *arena = hn_arena_create(0);
    double error = nan("");
    opts.max_steps = MOST_STEPS;
    (void)snprintf(spelled, sizeof spelled, "%s:rtol=%s", text, rtol);
    if (hn_method_parse(spelled, &spec, &diag) == HN_OK &&
        hn_run_create(hn_model_system(model), &spec, hn_model_q(model), hn_model_v(model), &opts,
                      &run, &diag) == HN_OK &&
        hn_errors_create(hn_model_system(model), arena, &errors) == HN_OK) {
        error = error_along(run, errors, ref);
    }
    hn_run_free(run);
    hn_errors_free(errors);
    hn_arena_free(arena);
    return error / atof(rtol);
}

static void do_scene(hn_library *lib, int scene) {
    const hn_model_source source = {.name = hn_library_scene_id(lib, scene)};
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_ref *ref = NULL;
    hn_ref_request request = hn_ref_request_default();
    request.only_stored = 1;
    if (n_scenes < MOST_SCENES && hn_model_load(lib, &source, &model, &diags) == HN_OK &&
        hn_reference_get(model, &request, &ref, NULL, &diags) == HN_OK) {
        names[n_scenes] = source.name;
        for (int m = 0; m < N_METHODS; m++) {
            for (int r = 0; r < N_TOLERANCES; r++) {
                found[n_scenes][m][r] = measure(model, ref, methods[m].text, tolerances[r]);
            }
        }
        n_scenes++;
    }
    hn_ref_free(ref);
    hn_model_free(model);
}

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Sorts the errors of a method, or their ratios to the first method's, into `out`; how many there
/// are.
static int sorted(int m, int r, bool beside_first, double out[MOST_SCENES]) {
    int n = 0;
    for (int s = 0; s < n_scenes; s++) {
        const double x = found[s][m][r] / (beside_first ? found[s][0][r] : 1);
        if (isfinite(x)) {
            out[n++] = x;
        }
    }
    qsort(out, (size_t)n, sizeof *out, compare_doubles);
    return n;
}

/// A row of the summary; whether its median is within KEPT of the first method's.
static bool put_row(int m, int r) {
    double error[MOST_SCENES], ratio[MOST_SCENES], first[MOST_SCENES];
    const int n = sorted(m, r, false, error), k = sorted(m, r, true, ratio);
    const int n_first = sorted(0, r, false, first);
    if (n == 0 || k == 0 || n_first == 0) {
        printf("%-22s  %s       0\n", methods[m].text, tolerances[r]);
        return false;
    }
    const bool good = error[n / 2] <= KEPT * first[n_first / 2];
    printf("%-22s  %s  %6d  %8.2g  %11.2g  %15.2g  %11.2g%s\n", methods[m].text, tolerances[r], n,
           error[n / 2], error[9 * n / 10], ratio[k / 2], ratio[9 * k / 10],
           !good && methods[m].is_kept ? "  NOT KEPT" : "");
    return good || !methods[m].is_kept;
}

static void put_scenes(void) {
    printf("\nThe same scene by scene, rtol = 1e-6; - where a run ended early or is refused\n%-22s",
           "scene");
    for (int m = 0; m < N_METHODS; m++) {
        printf("  %s", methods[m].text);
    }
    printf("\n");
    for (int s = 0; s < n_scenes; s++) {
        printf("%-22s", names[s]);
        for (int m = 0; m < N_METHODS; m++) {
            const int width = (int)strlen(methods[m].text) + 2;
            const double x = found[s][m][1];
            if (isfinite(x)) {
                printf("%*.2g", width, x);
            } else {
                printf("%*s", width, "-");
            }
        }
        printf("\n");
    }
}

int main(void) {
    hn_library *lib = NULL;
    hn_diag diag = {0};
    bool kept = true;
    if (hn_library_open(".", &lib, &diag) != HN_OK) {
        fprintf(stderr, "%s\n", diag.message);
        return 1;
    }
    for (int i = 0; i < hn_library_n_scenes(lib); i++) {
        do_scene(lib, i);
    }
    printf("What a tolerance is worth: the largest error of the coordinates over rtol, of every "
           "scene with a reference solution.\nA motion multiplies the errors of its steps, some "
           "by 10, some by 10,000: the last two columns are errors over those of %s.\n\n"
           "method                  rtol  scenes    median  nine in ten  median / dopri5  nine in "
           "ten\n",
           methods[0].text);
    for (int m = 0; m < N_METHODS; m++) {
        for (int r = 0; r < N_TOLERANCES; r++) {
            kept = put_row(m, r) && kept;
        }
    }
    put_scenes();
    hn_library_free(lib);
    return !kept;
}
