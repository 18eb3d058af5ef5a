#include "session/references/references.h"
#include "session/precision/study_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double DEFAULT_BUDGET = 60; // [s]
static const double REFERENCE_SHARE =
    0.5;                                // of the budget, for one of the computations of a reference
static const double CHAOS_SHARE = 0.05; // of the budget

// from the naive to the specialised: fixed steps, chosen steps, differential-algebraic integrators
static const char *const STANDARD[] = {
    "index1@rk4",        "baumgarte@rk4",     "projection@rk4",      "nullspace@rk4",
    "projection@dopri5", "projection@dop853", "partitioning@dop853", "ggl@radau5",
    "index2@hem4",       "index3@rattle",     "index3@genalpha",     "index2@ida",
};

hn_study_request hn_study_request_default(void) {
    return (hn_study_request){.time = (double)NAN, .budget = (double)NAN};
}

const char *const *hn_study_standard(int *n) {
    *n = (int)(sizeof STANDARD / sizeof *STANDARD);
    return STANDARD;
}

static hn_status parse_methods(const hn_study_request *r, hn_method_spec *specs, hn_diags *diags) {
    if (r->n_methods > HN_WP_METHODS) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/methods", NULL,
                            "%d methods were given; a study takes 1 to %d", r->n_methods,
                            HN_WP_METHODS);
    }
    for (int i = 0; i < r->n_methods; i++) {
        char pointer[32];
        hn_diag diag = {0};
        snprintf(pointer, sizeof pointer, "/methods/%d", i);
        const hn_status status = hn_method_parse(r->methods[i], &specs[i], &diag);
        if (status != HN_OK) {
            return hn_diags_add(diags, status, pointer, diag.hint, "%s", diag.message);
        }
    }
    return HN_OK;
}

static hn_status check_times(const hn_study_request *r, hn_diags *diags) {
    if (!(r->time > 0) || !(r->time <= 1e7)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/time", NULL,
                            "the end time is %g s; it must be above 0 and at most 1e7 s", r->time);
    }
    if (!(r->budget >= 0) || !isfinite(r->budget)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/budget", NULL,
                            "the budget is %g s; it must be above 0, or 0 for none", r->budget);
    }
    return HN_OK;
}

/// While the reference is computed there is something to see: nothing of the study is done.
static int ask_and_tell(void *user) {
    const hn_wp_hooks *hooks = user;
    if (hooks->progress) {
        hooks->progress(hooks->user, 0);
    }
    return hooks->stop && hooks->stop(hooks->user);
}

static hn_status find_reference(hn_study *s, hn_diags *diags) {
    hn_study_request *r = &s->request;
    hn_ref_request request = hn_ref_request_default();
    hn_ref_source source;
    request.time = r->time;
    request.folder = r->folder;
    request.opts.limits = (hn_walk_limits){REFERENCE_SHARE * r->budget, ask_and_tell, &r->hooks};
    const hn_status status = hn_reference_get(s->model, &request, &s->ref, &source, diags);
    s->kept_reference = status == HN_OK && source != HN_REF_COMPUTED;
    return status;
}

void hn_study_find_chaos(hn_study *s, const hn_walk_limits *limits) {
    hn_diag diag = {0};
    const hn_status status =
        hn_chaos_estimate(hn_model_system(s->model), hn_model_q(s->model), hn_model_v(s->model),
                          s->ref->T, limits, &s->chaos, &diag);
    if (status != HN_OK) {
        s->chaos = (hn_chaos){.T = s->ref->T};
        snprintf(s->chaos.why, sizeof s->chaos.why,
                 "whether neighbouring motions part is not known: %.120s",
                 status == HN_ERR_BUDGET ? "it would take too long" : diag.message);
        return;
    }
    const double horizon = hn_chaos_horizon(&s->chaos, HN_STUDY_TINY, HN_STUDY_LARGE);
    s->wp->horizon = isfinite(horizon) ? horizon : 0;
}

static hn_status set_up(hn_study *s, hn_diags *diags) {
    hn_method_spec specs[HN_WP_METHODS];
    hn_diag diag = {0};
    const hn_study_request *r = &s->request;
    hn_status status = check_times(r, diags);
    if (status == HN_OK) {
        status = parse_methods(r, specs, diags);
    }
    if (status == HN_OK) {
        status = find_reference(s, diags);
    }
    if (status != HN_OK) {
        return status;
    }
    const hn_wp_opts opts = {.n_levels = r->levels,
                             .n_samples = r->samples,
                             .budget = r->budget,
                             .shard = r->shard,
                             .n_shards = r->n_shards};
    status = hn_wp_create(hn_model_system(s->model), hn_model_q(s->model), hn_model_v(s->model),
                          s->ref, specs, r->n_methods, &opts, &s->wp, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, diag.pointer, diag.hint, "%s", diag.message);
    }
    if (r->n_shards == 0) {
        const hn_walk_limits limits = {CHAOS_SHARE * r->budget, r->hooks.stop, r->hooks.user};
        hn_study_find_chaos(s, &limits);
    }
    return r->folder ? hn_store_open(s, diags) : HN_OK;
}

hn_status hn_study_open(const hn_model *model, const hn_study_request *request, hn_study **out,
                        hn_diags *diags) {
    hn_study *s = calloc(1, sizeof *s);
    if (!s) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    s->model = model;
    s->request = *request;
    if (s->request.n_methods == 0) {
        s->request.methods = hn_study_standard(&s->request.n_methods);
    }
    s->request.time = isnan(request->time) ? hn_model_scene(model)->duration : request->time;
    s->request.budget = isnan(request->budget) ? DEFAULT_BUDGET : request->budget;
    const hn_status status = set_up(s, diags);
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
    const hn_study *s = user;
    return s->request.hooks.stop && s->request.hooks.stop(s->request.hooks.user);
}

static void pass_progress(void *user, double share) {
    const hn_study *s = user;
    if (s->request.hooks.progress) {
        s->request.hooks.progress(s->request.hooks.user, share);
    }
}

static void keep_point(void *user, int m, int k) {
    hn_store_keep_point(user, m, k);
}

static void keep_sample(void *user, int m, int k) {
    hn_store_keep_sample(user, m, k);
}

int hn_study_run(hn_study *s) {
    const hn_wp_hooks hooks = {s, ask_to_stop, pass_progress, keep_point, keep_sample};
    const int finished = hn_wp_run(s->wp, &hooks);
    for (int m = 0; m < s->wp->n_methods; m++) {
        hn_wp_classify(s->wp, m, &s->classes[m]);
    }
    hn_journal_end(&s->journal, finished && !s->request.keep);
    return finished;
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

int hn_study_resumed(const hn_study *s) {
    return s->resumed;
}

int hn_study_kept_reference(const hn_study *s) {
    return s->kept_reference;
}
