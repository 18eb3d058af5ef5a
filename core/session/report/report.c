// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/report/report_internal.h"
#include "session/report/report_words.h"

#include "base/clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double DEFAULT_LIMIT = 240; // [s]
static const double STUDY_SHARE = 0.75;  // of a scene's time; budgets and survival take the rest
static const double BUDGET_SHARE = 0.1;
static const double SURVIVAL_SHARE = 0.15;
static const double BUDGET_STEP = 4;               // times the scene's
static const double NO_LIMIT = 1e9;                // [s]
static const double FIRST_RTOL = 3, LAST_RTOL = 9; // powers of ten, where survival is counted

// in order: one loop; two motors; singular poses; a benchmark with several loops; stiff springs on
// moving ground; a mechanism in space
static const char *const SCENES[] = {
    "fb0", "five-bar", "n-four-bar", "seven-body-squeezer", "car-axis", "stewart-6-6",
};

// a method whose constraints drift, one with stabilised constraints, one with projected ones
static const char *const BUDGETED[HN_REPORT_BUDGETS] = {
    "index1@rk4",
    "baumgarte@rk4",
    "projection@rk4",
};

// sizes are tried with this stride, so that those a time limit leaves out are spread evenly; it
// has no common factor with HN_REPORT_SIZES
enum { STRIDE = 7 };

const char *const *hn_report_standard(int *n) {
    *n = (int)(sizeof SCENES / sizeof *SCENES);
    return SCENES;
}

// progress and limits ----

static double elapsed(const hn_report *r) {
    return hn_clock_wall() - r->started;
}

static void report_progress(hn_report *r, double part) {
    const double limit = r->request.limits.time_limit;
    const double all = limit > 0 ? elapsed(r) / limit : 0;
    const double scenes = (r->at + part) / r->n;
    hn_job_progress(&r->request.limits, hn_report_scene_id(&r->scenes[r->at]),
                    fmin(1, fmax(all, scenes)));
}

static int ask_stop(void *user) {
    hn_report *r = user;
    r->stopped |= hn_job_must_stop(&r->request.limits);
    return r->stopped;
}

/// Returns 1 when asked to stop, or when the time for this part of a scene is over.
static int ask_end(void *user) {
    hn_report *r = user;
    return ask_stop(r) || hn_clock_wall() > r->until;
}

static void study_progress(void *user, const char *part, double share) {
    (void)part;
    report_progress(user, STUDY_SHARE * share);
}

static void budget_progress(void *user, double part) {
    hn_report *r = user;
    const hn_report_scene *s = &r->scenes[r->at];
    report_progress(r, STUDY_SHARE + BUDGET_SHARE * (s->n_budgets + part) / HN_REPORT_BUDGETS);
}

// one scene ----

static hn_status study_scene(hn_report *r, hn_report_scene *s, double seconds) {
    hn_diags diags = {0};

    // the request of one scene, with its share of the time
    hn_job_request q = r->request;
    q.models[0] = s->model;
    q.n_models = 1;
    q.time = (double)NAN;
    q.keep = true;
    q.limits.time_limit = r->request.limits.time_limit > 0 ? STUDY_SHARE * seconds : 0;
    q.limits.user = r;
    q.limits.stop = ask_stop;
    q.limits.progress = study_progress;

    // run the study
    const hn_status status = hn_study_open(&q, &s->study, &diags);
    if (status == HN_OK) {
        hn_study_run(s->study);
        r->no_memory |= hn_study_wp(s->study)->status == HN_ERR_MEMORY;
        return hn_study_wp(s->study)->status;
    }

    // without a study: why
    s->study = NULL;
    snprintf(s->reason, sizeof s->reason, "%s",
             r->stopped    ? "stopped on request before it began"
             : diags.n > 0 ? diags.item[0].message
                           : hn_status_text(status));
    return status;
}

static void budget(hn_report *r, hn_report_scene *s) {
    const hn_ref *ref = hn_study_wp(s->study)->ref;

    // past a singular pose there is no budget; without an exact end it finds that out itself
    const double *end = ref->q + (size_t)ref->n * (size_t)ref->n_user;
    const hn_budget_opts opts = {
        .exact = s->singular ? NULL : end, .stop = ask_end, .progress = budget_progress, .user = r};

    // a budget for each listed method
    for (s->n_budgets = 0; s->n_budgets < HN_REPORT_BUDGETS; s->n_budgets++) {
        hn_budget_row *a = &s->budgets[s->n_budgets];
        a->holds_until = (double)NAN;

        // the method at the budget's step size
        hn_diag diag = {0};
        hn_method_spec spec;
        snprintf(a->spelling, sizeof a->spelling, "%s:h=%.6g", BUDGETED[s->n_budgets],
                 BUDGET_STEP * hn_model_scene(s->model)->step);
        a->status = hn_method_parse(a->spelling, &spec, &diag);

        // compute it while time is left
        if (a->status == HN_OK && ask_end(r)) {
            a->status = HN_ERR_STOPPED;
        } else if (a->status == HN_OK) {
            a->status = hn_budget_make(hn_model_system(s->model), &spec, hn_model_q(s->model),
                                       hn_model_v(s->model), ref->T, &opts, &a->budget, &diag);
        }

        // why there is none, or why its run ended early
        if (a->status == HN_ERR_STOPPED) {
            hn_diag_set(&diag, HN_ERR_STOPPED, NULL, NULL, "left out to keep the time limit");
        }
        snprintf(a->reason, sizeof a->reason, "%s",
                 a->status == HN_OK ? a->budget.reason : diag.message);
    }
}

/// Finds whether the motion passes near singular poses: a run with projection after each step
/// monitors them.
static void find_singular(hn_report *r, hn_report_scene *s) {
    const double T = hn_study_wp(s->study)->ref->T;
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run *run = NULL;
    char spelling[HN_SPEC_MAX];
    snprintf(spelling, sizeof spelling, "projection@rk4:h=%.6g", hn_model_scene(s->model)->step);
    if (hn_method_parse(spelling, &spec, &diag) != HN_OK ||
        hn_run_create(hn_model_system(s->model), &spec, hn_model_q(s->model), hn_model_v(s->model),
                      NULL, &run, &diag) != HN_OK) {
        return;
    }
    // an early end is recorded in the incidents of the run
    while (hn_run_time(run) < T && !ask_end(r) && hn_run_step(run) == HN_OK) {}
    s->singular = hn_run_passed_singular(run, &s->singular_at);
    hn_run_free(run);
}

static double size_of(const hn_wp *wp, int m, double step, int k) {
    return wp->methods[m].adaptive
               ? pow(10, -(FIRST_RTOL + (LAST_RTOL - FIRST_RTOL) * k / (HN_REPORT_SIZES - 1)))
               : hn_survival_step(step, k, HN_REPORT_SIZES);
}

static void try_size(const hn_report_scene *s, const hn_survival_judge *judge, int m, int k) {
    const hn_wp *wp = hn_study_wp(s->study);
    hn_strip *strip = &s->strips[m];
    hn_diag diag = {0};
    hn_run *run = NULL;
    const double size = size_of(wp, m, hn_model_scene(s->model)->step, k);
    const hn_method_spec spec = hn_wp_spec(wp, m, size);
    const hn_status status = hn_run_create(hn_model_system(s->model), &spec, hn_model_q(s->model),
                                           hn_model_v(s->model), NULL, &run, &diag);
    if (status != HN_OK) {
        snprintf(strip->reason, sizeof strip->reason, "%.190s", diag.message);
        return;
    }
    if (hn_survival_try(run, judge, &strip->run[strip->n])) {
        strip->size[strip->n++] = size;
    }
    hn_run_free(run);
}

/// Runs every method with one step size, then with the next, until the time is over.
static void survive(hn_report *r, hn_report_scene *s) {
    const hn_wp *wp = hn_study_wp(s->study);
    const hn_walk_limits limits = {0, ask_end, r};
    hn_survival_judge judge = {0};
    hn_arena *arena = hn_arena_create(1 << 14);

    // judge runs by the reference
    s->strips = arena ? calloc((size_t)wp->n_methods, sizeof *s->strips) : NULL;
    if (s->strips &&
        hn_survival_by_reference(hn_model_system(s->model), wp->ref, arena, &judge) == HN_OK) {
        judge.limits = &limits;

        // try one size with every method, then the next
        for (int i = 0; i < HN_REPORT_SIZES && !ask_end(r); i++) {
            for (int m = 0; m < wp->n_methods && !ask_end(r); m++) {
                try_size(s, &judge, m, i * STRIDE % HN_REPORT_SIZES);
            }
            report_progress(r, STUDY_SHARE + BUDGET_SHARE +
                                   SURVIVAL_SHARE * (i + 1) / HN_REPORT_SIZES);
        }
    } else {
        r->no_memory = 1;
    }

    hn_survival_unjudge(&judge);
    hn_arena_free(arena);
}

static void make_scene(hn_report *r, double seconds) {
    hn_report_scene *s = &r->scenes[r->at];
    if (study_scene(r, s, seconds) != HN_OK || r->stopped) {
        return;
    }
    r->until = hn_clock_wall() + SURVIVAL_SHARE * seconds;
    find_singular(r, s);
    // without singular poses the time for survival goes to the budgets, which are slow in space
    const double share = s->singular ? BUDGET_SHARE : BUDGET_SHARE + SURVIVAL_SHARE;
    r->until = hn_clock_wall() + share * seconds;
    budget(r, s);
    if (s->singular) {
        r->until = hn_clock_wall() + SURVIVAL_SHARE * seconds;
        survive(r, s);
    }
}

// the whole ----

static hn_status complete(hn_job_request *q, hn_diags *diags) {
    hn_method_spec specs[HN_WP_METHODS];
    if (q->n_models < 1) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/scenes", NULL,
                            "no scenes were given; a report takes 1 to %d", HN_JOB_SCENES);
    }
    if (q->n_methods == 0) {
        int n;
        const char *const *standard = hn_study_standard(&n);
        HN_TRY(hn_job_request_set_methods(q, standard, n, diags));
    }
    return hn_job_complete(q, DEFAULT_LIMIT, HN_WP_METHODS, specs, diags);
}

/// Returns the time for the present scene: an even share of the time left.
static double share_of(const hn_report *r) {
    const double limit = r->request.limits.time_limit;
    return limit > 0 ? fmax(1, (limit - elapsed(r)) / (r->n - r->at)) : NO_LIMIT;
}

hn_status hn_report_open(const hn_job_request *request, hn_report **out, hn_diags *diags) {
    hn_job_request q = *request;
    HN_TRY(complete(&q, diags));
    hn_report *r = calloc(1, sizeof *r);
    if (!r) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    r->request = q;
    r->n = q.n_models;
    for (int i = 0; i < r->n; i++) {
        r->scenes[i].model = q.models[i];
        snprintf(r->scenes[i].reason, sizeof r->scenes[i].reason,
                 "not begun: the report was stopped earlier");
    }
    *out = r;
    return HN_OK;
}

hn_status hn_report_run(hn_report *r, hn_diags *diags) {
    r->started = hn_clock_wall();
    for (r->at = 0; r->at < r->n && !ask_stop(r); r->at++) {
        make_scene(r, share_of(r));
    }

    // a complete report no longer needs the kept studies
    for (int i = 0; i < r->n && !r->stopped; i++) {
        if (r->scenes[i].study) {
            hn_study_forget(r->scenes[i].study);
        }
    }
    r->elapsed = elapsed(r);
    return r->no_memory ? hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory") : HN_OK;
}

void hn_report_free(hn_report *r) {
    for (int i = 0; r && i < r->n; i++) {
        hn_study_free(r->scenes[i].study);
        free(r->scenes[i].strips);
    }
    free(r);
}

int hn_report_n_scenes(const hn_report *r) {
    return r->n;
}

const hn_report_scene *hn_report_scene_at(const hn_report *r, int i) {
    return &r->scenes[i];
}

bool hn_report_stopped(const hn_report *r) {
    return r->stopped;
}

int hn_strip_survived(const hn_strip *strip) {
    int n = 0;
    for (int i = 0; i < strip->n; i++) {
        n += strip->run[i].end == HN_SURVIVAL_SURVIVED;
    }
    return n;
}
