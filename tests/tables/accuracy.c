// SPDX-License-Identifier: GPL-3.0-or-later
// Honesty of the accuracy watch: its estimate against the error, by the reference solution, of
// every scene of the library by the methods that it suggests and some coarser ones.

#include "study/truth/accuracy.h"
#include "session/model/model.h"
#include "session/references/reference_store.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LATE = 2 }; // ratios beyond this factor are counted

/// Ratios of one kind of error.
typedef struct counter {
    int n, within;
    int unsaid; ///< methods of scenes above 1 % that the scene does not call an exhibit
    double lowest, highest;
} counter;

static const char *const coarse[] = {
    "projection@rk4:h=0.01",       "baumgarte@rk4:h=0.005", "ggl@radau5:rtol=1e-4",
    "nullspace@dopri5:rtol=1e-4",  "ggl@radau5:rtol=1e-6",  "projection@dopri5:rtol=1e-6",
    "projection@dop853:rtol=1e-6", "ggl@ida:rtol=1e-6",     "index3@radau5:rtol=1e-6"};
enum { N_COARSE = sizeof coarse / sizeof *coarse };

static void count(counter *c, double ratio) {
    c->lowest = c->n ? fmin(c->lowest, ratio) : ratio;
    c->highest = c->n ? fmax(c->highest, ratio) : ratio;
    c->n++;
    c->within += ratio > 1.0 / LATE && ratio < LATE;
}

/// Runs one method along the times of the reference, the watch beside it; fills the true errors up
/// to the time to which the estimate holds.
static bool run_method(const hn_model *model, const hn_ref *ref, const char *text,
                       hn_estimate *estimate, double truth[HN_ERROR_COUNT]) {
    const hn_system *sys = hn_model_system(model);
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run *run = NULL;
    hn_accuracy *a = NULL;
    hn_errors *errors = NULL;
    hn_accuracy_track track = {0};
    hn_arena *arena = hn_arena_create(0);
    bool good =
        hn_method_parse(text, &spec, &diag) == HN_OK &&
        hn_run_create(sys, &spec, hn_model_q(model), hn_model_v(model), NULL, &run, &diag) ==
            HN_OK &&
        hn_accuracy_create(sys, hn_model_q(model), hn_model_v(model), ref->T, &a) == HN_OK &&
        hn_errors_create(sys, arena, &errors) == HN_OK;
    memset(truth, 0, HN_ERROR_COUNT * sizeof *truth);
    for (int k = 1; good && k <= ref->n; k++) {
        const hn_state_seen exact = hn_ref_at(ref, k);
        hn_sample s;
        if (hn_run_advance(run, exact.t) != HN_OK || hn_run_sample(run, exact.t, &s) != HN_OK) {
            break;
        }
        double error[HN_ERROR_COUNT];
        const hn_state_seen at = {s.t, s.q, s.v, s.lambda, s.energy, s.gap, s.velocity_gap};
        hn_errors_calc(errors, &at, &exact, &ref->scales, error);
        if (!hn_accuracy_reach(a, s.t, hn_run_get_summary(run).cost.ops)) {
            continue; // where the watch is late it claims nothing
        }
        hn_accuracy_see(a, &s, &track);
        for (int i = 0; i < HN_ERROR_COUNT; i++) {
            truth[i] = fmax(truth[i], error[i]);
        }
    }
    if (good) {
        *estimate = hn_accuracy_estimate(a, &track, hn_run_time(run));
    }
    hn_run_free(run);
    hn_accuracy_free(a);
    hn_errors_free(errors);
    hn_arena_free(arena);
    return good && estimate->known;
}

/// A row of the table; ratios only of errors that the watch can tell from its own. `remark`: of an
/// error above 1 %.
static void put_row(const char *scene, const char *method, const hn_estimate *e,
                    const double *truth, const char *remark, counter *q) {
    printf("%-22s %-42s %8.3g  %.1e  %.1e  %.1e", scene, method, e->t, e->own, e->q,
           truth[HN_ERROR_Q]);
    if (truth[HN_ERROR_Q] > 10 * e->own) {
        const double ratio = e->q / truth[HN_ERROR_Q];
        printf("  %5.2f", ratio);
        count(q, ratio);
    } else {
        printf("      -");
    }
    char reaction[16] = "      -"; // a mechanism without constraint rows has none
    if (isfinite(e->reaction)) {
        snprintf(reaction, sizeof reaction, "%.1e", e->reaction);
    }
    printf("  %s%s\n", reaction, fmax(e->q, e->reaction) > HN_ACCURACY_WARN ? remark : "");
}

static void do_scene(hn_library *lib, int scene, counter *q) {
    const hn_model_source source = {.name = hn_library_scene_id(lib, scene)};
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_ref *ref = NULL;
    hn_ref_request request = hn_ref_request_default();
    request.only_stored = 1;
    if (hn_model_load(lib, &source, &model, &diags) != HN_OK ||
        hn_reference_get(model, &request, &ref, NULL, &diags) != HN_OK) {
        printf("%-22s no reference is stored\n", source.name);
        hn_model_free(model);
        return;
    }
    const hn_scene *s = hn_model_scene(model);
    for (int i = 0; i < s->n_methods + N_COARSE; i++) {
        const char *method = i < s->n_methods ? s->methods[i] : coarse[i - s->n_methods];
        hn_estimate e = {0};
        double truth[HN_ERROR_COUNT];
        if (run_method(model, ref, method, &e, truth)) {
            const bool own = i<s->n_methods, large = fmax(e.q, e.reaction)> HN_ACCURACY_WARN;
            put_row(source.name, method, &e, truth,
                    !own            ? "  above 1 %"
                    : s->exhibit[0] ? "  above 1 %, the scene's own: an exhibit"
                                    : "  above 1 %, THE SCENE'S OWN",
                    q);
            q->unsaid += own && large && !s->exhibit[0];
        } else {
            printf("%-22s %-42s %s\n", source.name, method, e.reason);
        }
    }
    hn_ref_free(ref);
    hn_model_free(model);
}

int main(void) {
    hn_library *lib = NULL;
    hn_diag diag = {0};
    counter q = {0};
    if (hn_library_open(".", &lib, &diag) != HN_OK) {
        fprintf(stderr, "%s\n", diag.message);
        return 1;
    }
    printf("The error estimate of runs against their error by the reference solution.\n"
           "t: up to which the estimate holds [s]; own: what the pilot may be off itself; relative "
           "errors as in core/study/truth/errors.h;\n"
           "ratio: estimate over error of the coordinates, where the error is ten times `own`\n\n"
           "scene                  method                                            t  own      "
           "estimate  error    ratio  reactions\n");
    for (int i = 0; i < hn_library_n_scenes(lib); i++) {
        do_scene(lib, i, &q);
    }
    printf("\n%d ratios, %d of them between 1/%d and %d; %.2f to %.2f\n", q.n, q.within, LATE, LATE,
           q.lowest, q.highest);
    hn_library_free(lib);
    // faults: an estimate off by more than the factor, and a method of a scene off by more than 1 %
    // that the scene does not call an exhibit
    return q.within < q.n || q.unsaid > 0;
}
