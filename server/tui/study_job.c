// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/study_job.h"

#include "cli/shell/cache_folder.h"
#include "session/precision/wanted.h"
#include "session/stability/stability_column.h"
#include "terminal/short_spelling.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static const double LONGEST = 2;      // [s] of motion, so that something is seen within seconds
static const double LONGEST_MAP = 3;  // [s]
static const double TIME_LIMIT = 120; // wall time [s]
enum { LEVELS = 6, FOLDER = 400 };

struct hn_tui_study {
    hn_tui_study_kind kind;
    hn_model *model; ///< owned, of this thread alone
    char methods[HN_JOB_METHODS][HN_SPEC_MAX];
    char folder[FOLDER];
    hn_job_request request;
    hn_job *job; ///< owned; of the thread until `done`; NULL while it opens
    pthread_t thread;
    bool started;
    atomic_bool stop, done;
    atomic_bool ranked; ///< its methods can be compared
    atomic_bool whole;  ///< ranked, and nothing was left out
    _Atomic double share;
    pthread_mutex_t lock; ///< guards what follows
    hn_cost_plot cost;
    hn_map_plot map;
    hn_strbuf words;
};

// ---- on the thread ----

static int must_stop(void *user) {
    return atomic_load(&((hn_tui_study *)user)->stop);
}

/// Copies what is done; the work belongs to this thread.
static void take(hn_tui_study *s) {
    pthread_mutex_lock(&s->lock);
    if (s->kind == HN_TUI_COST) {
        // over operations, as the sentences beside it: no times are sampled
        hn_cost_plot_take(&s->cost, hn_study_wp(hn_job_work(s->job)), false);
    } else {
        hn_map_plot_take(&s->map, hn_job_work(s->job), 0);
    }
    pthread_mutex_unlock(&s->lock);
}

static void progress(void *user, const char *part, double share) {
    hn_tui_study *s = user;
    (void)part;
    atomic_store(&s->share, share);
    if (s->job) {
        take(s);
    }
}

static void add_classes(hn_strbuf *b, const hn_study *study) {
    const hn_wp *wp = hn_study_wp(study);
    for (int m = 0; m < wp->n_methods; m++) {
        char shown[HN_SPEC_MAX];
        hn_short_spelling(wp->methods[m].spelling, shown, sizeof shown);
        hn_strbuf_printf(b, "%s: %s\n", shown, hn_study_classes(study)[m].text);
    }
    hn_pareto p;
    hn_wp_pareto(wp, hn_study_classes(study), hn_wp_ranked_error(wp), HN_COST_OPS, &p);
    hn_strbuf_printf(b, "\nCheapest by operations, for errors up to t = %.4g s\n", wp->ref->T);
    hn_pareto_sentences(b, wp, &p);
}

static void tell_end(hn_tui_study *s, const hn_job_end *end) {
    take(s);
    pthread_mutex_lock(&s->lock);
    if (end->stopped) {
        hn_strbuf_add(&s->words, "stopped; what was done is shown\n");
    } else if (end->out_of_time) {
        hn_strbuf_add(&s->words, "the time limit left something out\n");
    }
    if (s->kind == HN_TUI_STABILITY) {
        hn_map_agreement_text(&s->words, hn_job_work(s->job), 0);
    } else if (!end->stopped) {
        add_classes(&s->words, hn_job_work(s->job));
    }
    pthread_mutex_unlock(&s->lock);
}

static void *compute(void *user) {
    hn_tui_study *s = user;
    hn_diags diags = {0};
    hn_job_end end = {0};
    const char *name = s->kind == HN_TUI_COST ? "work-precision" : "stability";
    hn_status status = hn_job_open(hn_job_kind_find(name), &s->request, &s->job, &diags);
    if (status == HN_OK) {
        take(s);
        status = hn_job_run(s->job, &end, &diags);
    }

    // the words of the end, or of the fault
    if (status == HN_OK) {
        tell_end(s, &end);
    } else {
        pthread_mutex_lock(&s->lock);
        hn_strbuf_printf(&s->words, "%s%s%s\n",
                         diags.n > 0 ? diags.item[0].message : hn_status_text(status),
                         diags.n > 0 && diags.item[0].hint[0] ? "; " : "",
                         diags.n > 0 ? diags.item[0].hint : "");
        pthread_mutex_unlock(&s->lock);
    }
    atomic_store(&s->ranked, status == HN_OK && !end.stopped && s->kind == HN_TUI_COST);
    atomic_store(&s->whole, atomic_load(&s->ranked) && !end.out_of_time);
    atomic_store(&s->done, true);
    return NULL;
}

// ---- from outside ----

static hn_status make_request(hn_tui_study *s, const hn_tui_study_request *r, hn_diags *diags) {
    const bool cost = s->kind == HN_TUI_COST;
    const char *methods[HN_JOB_METHODS];
    for (int i = 0; i < r->n_methods && i < HN_JOB_METHODS; i++) {
        memcpy(s->methods[i], r->methods[i], strlen(r->methods[i]) + 1);
        methods[i] = s->methods[i];
    }
    s->request = hn_job_request_default(s->model);
    HN_TRY(hn_job_request_set_methods(&s->request, methods, r->n_methods, diags));
    s->request.lib = r->library;
    const double longest = cost ? LONGEST : LONGEST_MAP;
    s->request.time = r->time > 0 ? r->time : fmin(hn_model_scene(s->model)->duration, longest);

    // a ladder of sizes, or the plane of Baumgarte's two numbers
    if (cost) {
        hn_job_request_set(&s->request, "levels", LEVELS);
        hn_job_request_set(&s->request, "samples", 0); // operation counts alone
    } else {
        hn_job_request_set_text(&s->request, "preset", "baumgarte");
        hn_job_request_set(&s->request, "columns", r->columns);
        hn_job_request_set(&s->request, "rows", r->rows);
    }
    s->request.limits.time_limit = TIME_LIMIT;
    s->request.limits.folder = hn_cache_folder_find(s->folder) ? s->folder : NULL;
    s->request.limits.stop = must_stop;
    s->request.limits.progress = progress;
    s->request.limits.user = s;
    return HN_OK;
}

hn_status hn_tui_study_start(const hn_tui_study_request *r, hn_tui_study **out, hn_diags *diags) {
    hn_tui_study *s = calloc(1, sizeof *s);
    if (!s) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    s->kind = r->kind;
    pthread_mutex_init(&s->lock, NULL);
    hn_strbuf_init(&s->words);

    // everything that can be refused is refused here
    hn_status status = hn_model_load(r->library, r->source, &s->model, diags);
    HN_THEN(status, make_request(s, r, diags));
    if (status == HN_OK) {
        s->started = pthread_create(&s->thread, NULL, compute, s) == 0;
        status = s->started ? HN_OK
                            : hn_diags_add(diags, HN_ERR_LIMIT, NULL, NULL,
                                           "the system gives no thread for the study");
    }
    if (status != HN_OK) {
        hn_tui_study_free(s);
        return status;
    }
    *out = s;
    return HN_OK;
}

void hn_tui_study_stop(hn_tui_study *s) {
    atomic_store(&s->stop, true);
}

bool hn_tui_study_stopping(const hn_tui_study *s) {
    return atomic_load(&s->stop);
}

void hn_tui_study_free(hn_tui_study *s) {
    if (!s) {
        return;
    }
    if (s->started) {
        hn_tui_study_stop(s);
        pthread_join(s->thread, NULL);
    }
    hn_job_free(s->job);
    hn_model_free(s->model);
    hn_strbuf_reset(&s->words);
    pthread_mutex_destroy(&s->lock);
    free(s);
}

bool hn_tui_study_running(const hn_tui_study *s) {
    return !atomic_load(&s->done);
}

bool hn_tui_study_is_whole(const hn_tui_study *s) {
    return atomic_load(&s->done) && atomic_load(&s->whole);
}

double hn_tui_study_share(const hn_tui_study *s) {
    return atomic_load(&s->share);
}

hn_tui_study_kind hn_tui_study_get_kind(const hn_tui_study *s) {
    return s->kind;
}

double hn_tui_study_time(const hn_tui_study *s) {
    return s->request.time;
}

void hn_tui_study_cost(hn_tui_study *s, hn_cost_plot *out) {
    pthread_mutex_lock(&s->lock);
    *out = s->cost;
    pthread_mutex_unlock(&s->lock);
}

void hn_tui_study_map(hn_tui_study *s, hn_map_plot *out) {
    pthread_mutex_lock(&s->lock);
    *out = s->map;
    pthread_mutex_unlock(&s->lock);
}

bool hn_tui_study_wanted(const hn_tui_study *s, const char *wanted, hn_strbuf *b,
                         char spelling[HN_SPEC_MAX]) {
    const double length = hn_system_length(hn_model_system(s->model));
    hn_wanted read;
    spelling[0] = '\0';
    if (!atomic_load(&s->done) || !atomic_load(&s->ranked) ||
        !hn_wanted_read(wanted, length, &read)) {
        return false;
    }
    hn_wanted_text(b, hn_job_work(s->job), &read, spelling);
    return true;
}

void hn_tui_study_words(hn_tui_study *s, hn_strbuf *b) {
    pthread_mutex_lock(&s->lock);
    hn_strbuf_add(b, hn_strbuf_text(&s->words));
    pthread_mutex_unlock(&s->lock);
}
