// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/precision/study_internal.h"
#include "session/precision/study_store.h"
#include "session/references/reference_store.h"
#include "session/references/references.h"
#include "study/cost/measure.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double DEFAULT_LIMIT = 60; // [s]
// shares of the time limit: each of the two computations of a reference, and the estimate of chaos
static const double REFERENCE_SHARE = 0.5, CHAOS_SHARE = 0.05;

// from the naive to the specialised: fixed steps, chosen steps, differential-algebraic integrators
static const char *const STANDARD[] = {
    "index1@rk4",        "baumgarte@rk4",     "projection@rk4",      "nullspace@rk4",
    "projection@dopri5", "projection@dop853", "partitioning@dop853", "ggl@radau5",
    "index2@hem4",       "index3@rattle",     "index3@genalpha",     "index2@ida",
};

const char *const *hn_study_standard(int *n) {
    *n = (int)(sizeof STANDARD / sizeof *STANDARD);
    return STANDARD;
}

/// Reports progress 0 while the reference is computed, and asks whether to stop.
static int ask_and_report(void *user) {
    const hn_job_limits *limits = user;
    hn_job_progress(limits, "", 0);
    return hn_job_must_stop(limits);
}

static hn_status find_reference(hn_study *s, hn_diags *diags) {
    hn_job_request *r = &s->request;
    hn_ref_request request = hn_ref_request_default();
    hn_ref_source source;
    request.time = r->time;
    request.folder = r->limits.folder;
    request.opts.limits =
        (hn_walk_limits){REFERENCE_SHARE * r->limits.time_limit, ask_and_report, &r->limits};
    HN_TRY(hn_reference_get(s->model, &request, &s->ref, &source, diags));
    s->kept_reference = source != HN_REF_COMPUTED;
    return HN_OK;
}

void hn_study_find_chaos(hn_study *s, const hn_walk_limits *limits) {
    hn_diag diag = {0};
    const hn_status status =
        hn_chaos_estimate(hn_model_system(s->model), hn_model_q(s->model), hn_model_v(s->model),
                          s->ref->T, limits, &s->chaos, &diag);
    if (status != HN_OK) {
        s->chaos = (hn_chaos){.T = s->ref->T};
        snprintf(s->chaos.why, sizeof s->chaos.why,
                 "it is not known whether the motion is chaotic: %.120s",
                 status == HN_ERR_STOPPED ? "it would take too long" : diag.message);
        return;
    }
    const double horizon = hn_chaos_horizon(&s->chaos, HN_STUDY_TINY, HN_STUDY_LARGE);
    s->wp->horizon = isfinite(horizon) ? horizon : 0;
}

/// Reads "2/4": the second of four parts. Returns false when it is not that.
static bool read_shard(const char *text, int *shard, int *n) {
    char end;
    const size_t digits = strspn(text, "0123456789");
    return digits > 0 && digits <= 4 && text[digits] == '/' && strlen(text + digits) <= 5 &&
           strspn(text + digits + 1, "0123456789") == strlen(text + digits + 1) &&
           sscanf(text, "%d/%d%c", shard, n, &end) == 2 && *shard > 0 && *n > 0;
}

static hn_status read_opts(const hn_job_request *r, hn_wp_opts *opts, hn_diags *diags) {
    const double samples = hn_job_number(r, "samples", HN_WP_SAMPLES);
    const char *shard = hn_job_text(r, "shard");
    *opts = (hn_wp_opts){.n_levels = (int)hn_job_number(r, "levels", 0),
                         .n_samples = samples > 0 ? (int)samples : -1,
                         .time_limit = r->limits.time_limit};
    if (shard && !read_shard(shard, &opts->shard, &opts->n_shards)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/shard", "as 2/4: the second of four",
                            "'%.40s' is no part of a study", shard);
    }
    return HN_OK;
}

static hn_status set_up(hn_study *s, hn_diags *diags) {
    hn_method_spec specs[HN_WP_METHODS];
    hn_wp_opts opts;
    hn_diag diag = {0};
    hn_job_request *r = &s->request;
    HN_TRY(hn_job_complete(r, DEFAULT_LIMIT, HN_WP_METHODS, specs, diags));
    HN_TRY(read_opts(r, &opts, diags));
    HN_TRY(find_reference(s, diags));

    // the ladders
    const hn_status status =
        hn_wp_create(hn_model_system(s->model), hn_model_q(s->model), hn_model_v(s->model), s->ref,
                     specs, r->n_methods, &opts, &s->wp, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, diag.pointer, diag.hint, "%s", diag.message);
    }

    // only a whole study estimates chaos
    if (opts.n_shards == 0) {
        const hn_walk_limits limits = {CHAOS_SHARE * r->limits.time_limit, r->limits.stop,
                                       r->limits.user};
        hn_study_find_chaos(s, &limits);
        if (hn_job_must_stop(&r->limits) || hn_system_was_stopped(hn_model_system(s->model))) {
            return hn_diags_add(diags, HN_ERR_STOPPED, NULL, NULL, "stopped on request");
        }
    }
    return r->limits.folder ? hn_store_open(s, diags) : HN_OK;
}

hn_status hn_study_open(const hn_job_request *request, hn_study **out, hn_diags *diags) {
    hn_study *s = calloc(1, sizeof *s);
    hn_status status = HN_OK;
    if (!s) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }

    // no methods named: the standard list
    s->model = request->models[0];
    s->request = *request;
    if (s->request.n_methods == 0) {
        int n;
        const char *const *standard = hn_study_standard(&n);
        status = hn_job_request_set_methods(&s->request, standard, n, diags);
    }

    // reference, ladders, journal
    HN_THEN(status, set_up(s, diags));
    if (status != HN_OK) {
        hn_study_free(s);
        return status;
    }
    *out = s;
    return HN_OK;
}

void hn_study_free(hn_study *s) {
    if (s) {
        hn_journal_end(&s->journal, 0);
        hn_wp_free(s->wp);
        hn_ref_free(s->ref);
        hn_model_free(s->own_model);
        free(s);
    }
}

static int ask_to_stop(void *user) {
    return hn_job_must_stop(&((const hn_study *)user)->request.limits);
}

static void pass_progress(void *user, double share) {
    hn_job_progress(&((const hn_study *)user)->request.limits, "", share);
}

static void keep_point(void *user, int m, int k) {
    hn_store_keep_point(user, m, k);
}

static void keep_sample(void *user, int m, int k) {
    hn_store_keep_sample(user, m, k);
}

bool hn_study_run(hn_study *s) {
    const hn_wp_hooks hooks = {s, ask_to_stop, pass_progress, keep_point, keep_sample};
    const int finished = hn_wp_run(s->wp, &hooks);
    for (int m = 0; m < s->wp->n_methods; m++) {
        hn_wp_classify(s->wp, m, &s->classes[m]);
    }
    hn_journal_end(&s->journal, finished && !s->request.keep);
    return finished;
}

void hn_study_set_time_limit(hn_study *s, double time_limit) {
    s->request.limits.time_limit = time_limit;
    s->wp->opts.time_limit = time_limit;
}

void hn_study_forget(hn_study *s) {
    hn_journal_end(&s->journal, 1);
}

const hn_chaos *hn_study_chaos(const hn_study *s) {
    return &s->chaos;
}

const hn_wp *hn_study_wp(const hn_study *s) {
    return s->wp;
}

const hn_class *hn_study_classes(const hn_study *s) {
    return s->classes;
}

const hn_model *hn_study_model(const hn_study *s) {
    return s->model;
}

/// The point whose errors were taken at the fewest times; NULL: no run came to its end.
static const hn_wp_point *point_with_fewest_times(const hn_study *s) {
    const hn_wp_point *least = NULL;
    for (int m = 0; m < s->wp->n_methods; m++) {
        for (int k = 0; k < s->wp->n_levels; k++) {
            const hn_wp_point *p = &s->wp->methods[m].point[k];
            if (p->state == HN_WP_DONE && (!least || p->times < least->times)) {
                least = p;
            }
        }
    }
    return least;
}

int hn_study_times(const hn_study *s) {
    const hn_wp_point *p = point_with_fewest_times(s);
    return p ? p->times : 0;
}

void hn_study_put_times(hn_strbuf *b, const hn_study *s) {
    const hn_wp_point *p = point_with_fewest_times(s);
    if (!p) {
        hn_strbuf_add(b, "no run came to its end, so that there are no errors");
        return;
    }
    hn_strbuf_printf(b, "errors are the largest at %d times", p->times);
    hn_strbuf_add(b, p->too_long
                         ? "; in parts of the run at few times, as the true motion between these "
                           "takes too long to compute"
                     : p->times % s->ref->n == 0
                         ? ", evenly over the run"
                         : "; in parts of the run at few times, as no method finds the true "
                           "motion between these");
}

bool hn_study_lost(const hn_study *s) {
    return s->journal.failed;
}

int hn_study_resumed(const hn_study *s) {
    return s->resumed;
}

bool hn_study_kept_reference(const hn_study *s) {
    return s->kept_reference;
}
