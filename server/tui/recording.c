// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/recording.h"

#include "base/clock.h"
#include "study/incidents/kinds.h"
#include "study/run/ending.h"
#include "tui/true_motion.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double LONGEST_REFERENCE = 60; // CPU time of each means [s]

enum { MOST_INCIDENTS = 64 * HN_COMPARISON_MAX_METHODS, MOST_FRAMES = 20000 };

typedef struct track_store {
    double *gap, *velocity_gap, *energy, *error, *points, *step_ops, *q, *v;
} track_store;

typedef struct told_incident {
    hn_incident incident;
    int method;
} told_incident;

struct hn_recording {
    const hn_model *model;
    hn_comparison *comparison;
    int n_tracks, n_points, n_user, last;
    double frame_dt, duration; ///< [s]
    int stride;                ///< frames of the page for each frame here
    hn_track tracks[HN_COMPARISON_MAX_METHODS];
    track_store stores[HN_COMPARISON_MAX_METHODS];
    _Atomic(hn_true_motion *) truth; ///< owned; NULL: none, or not yet
    atomic_int frames, wanted;
    atomic_bool stop, asked; ///< asked: the reference is being fetched or computed
    double limit;            ///< of computing [s]; 0: none; set before the thread starts
    atomic_bool out_of_time; ///< the limit ended the recording
    _Atomic double computed; ///< by the thread up to the last frame [s]
    int n_errors;            ///< frames whose errors are known; of the reader
    hn_model *own_model;     ///< owned, of the thread that computes a reference; NULL: none
    pthread_t truth_thread;
    bool computing; ///< that thread was started
    _Atomic double frame_seconds;
    pthread_t thread;
    bool started;
    pthread_mutex_t lock; ///< guards what follows, and the waiting
    pthread_cond_t more;
    hn_track_end ends[HN_COMPARISON_MAX_METHODS];
    told_incident *incidents;
    int n_incidents;
    char why_unknown[HN_RECORDING_WHY]; ///< why there is no reference
};

// ---- the reference ----

static int must_stop(void *user) {
    return atomic_load(&((hn_recording *)user)->stop);
}

/// Fetches the reference motion for a model, and hands it to the reader.
static hn_status fetch(hn_recording *r, const hn_model *model, bool compute, hn_diags *diags) {
    const hn_true_motion_request request = {
        model, r->frame_dt, r->last, compute, {LONGEST_REFERENCE, must_stop, r}};
    hn_true_motion *found = NULL;
    const hn_status status = hn_true_motion_get(&request, &found, diags);
    atomic_store(&r->truth, found);
    return status;
}

/// The thread that computes a reference, with a model of its own.
static void *compute_truth(void *user) {
    hn_recording *r = user;
    hn_diags diags = {0};
    const hn_status status = fetch(r, r->own_model, true, &diags);
    pthread_mutex_lock(&r->lock);
    if (status != HN_OK) {
        snprintf(r->why_unknown, sizeof r->why_unknown, "%.300s",
                 diags.n > 0 ? diags.item[0].message : hn_status_text(status));
    }
    pthread_mutex_unlock(&r->lock);
    atomic_store(&r->asked, false);
    return NULL;
}

bool hn_recording_needs_reference(const hn_recording *r) {
    return !atomic_load(&r->asked) && !atomic_load(&r->truth) && !r->computing;
}

bool hn_recording_compute_reference(hn_recording *r, hn_model *model) {
    HN_ASSERT(hn_recording_needs_reference(r));
    r->own_model = model;
    atomic_store(&r->asked, true);
    r->computing = pthread_create(&r->truth_thread, NULL, compute_truth, r) == 0;
    if (!r->computing) {
        atomic_store(&r->asked, false);
    }
    return r->computing;
}

bool hn_recording_is_asking(const hn_recording *r) {
    return atomic_load(&r->asked);
}

void hn_recording_why_unknown(const hn_recording *r, char out[HN_RECORDING_WHY]) {
    pthread_mutex_t *lock = (pthread_mutex_t *)&r->lock;
    pthread_mutex_lock(lock);
    snprintf(out, HN_RECORDING_WHY, "%s", r->why_unknown);
    pthread_mutex_unlock(lock);
}

// errors belong to the reader, since the reference may come after the frames
void hn_recording_update(hn_recording *r) {
    const hn_true_motion *truth = atomic_load(&r->truth);
    const int frames = atomic_load(&r->frames);
    for (; truth && r->n_errors < frames; r->n_errors++) {
        for (int m = 0; m < r->n_tracks; m++) {
            const track_store *s = &r->stores[m];
            const double *points = s->points + (size_t)r->n_errors * 3 * (size_t)r->n_points;
            s->error[r->n_errors] = isnan(s->gap[r->n_errors])
                                        ? (double)NAN
                                        : hn_true_motion_error(truth, points, r->n_errors);
        }
    }
}

// ---- frames ----

static void keep_sample(hn_recording *r, int m, int frame, const hn_sample *sample) {
    track_store *to = &r->stores[m];
    double *points = to->points + (size_t)frame * 3 * (size_t)r->n_points;
    memcpy(points, sample->points, 3 * (size_t)r->n_points * sizeof *points);
    const size_t n = (size_t)r->n_user;
    memcpy(to->q + (size_t)frame * n, sample->q, n * sizeof *to->q);
    memcpy(to->v + (size_t)frame * n, sample->v, n * sizeof *to->v);
    to->gap[frame] = sample->gap;
    to->velocity_gap[frame] = sample->velocity_gap;
    to->energy[frame] = sample->energy_change;
}

/// A method that ended keeps its last configuration on the screen, but has no numbers any more.
static void keep_end(hn_recording *r, int m, int frame) {
    track_store *to = &r->stores[m];
    const size_t n = 3 * (size_t)r->n_points;
    to->gap[frame] = to->velocity_gap[frame] = to->energy[frame] = (double)NAN;
    for (size_t k = 0; k < n; k++) {
        to->points[(size_t)frame * n + k] =
            frame > 0 ? to->points[(size_t)(frame - 1) * n + k] : (double)NAN;
    }
    for (size_t k = (size_t)frame * (size_t)r->n_user; k < ((size_t)frame + 1) * (size_t)r->n_user;
         k++) {
        to->q[k] = to->v[k] = (double)NAN;
    }
}

static void keep_words(hn_recording *r) {
    pthread_mutex_lock(&r->lock);
    r->n_incidents = 0;
    for (int m = 0; m < r->n_tracks; m++) {
        const hn_run *run = hn_comparison_run(r->comparison, m);
        const hn_run_summary summary = hn_run_get_summary(run);
        const hn_incident *list;
        const int n = hn_run_incidents(run, &list);
        r->ends[m].failed = summary.state == HN_RUN_FAILED;
        r->ends[m].t = summary.t;
        r->ends[m].worst_gap = summary.worst_gap;
        r->ends[m].worst_energy = summary.worst_energy_change;
        const hn_incident *cause = hn_ending_cause(run, summary.status, summary.reason, summary.t);
        r->ends[m].cause = cause ? hn_incident_kinds()[cause->code]->name : NULL;
        memcpy(r->ends[m].reason, summary.reason, sizeof r->ends[m].reason);
        for (int i = 0; i < n && r->n_incidents < MOST_INCIDENTS; i++) {
            r->incidents[r->n_incidents++] = (told_incident){list[i], m};
        }
    }
    pthread_mutex_unlock(&r->lock);
}

static void keep_frame(hn_recording *r, int frame) {
    for (int m = 0; m < r->n_tracks; m++) {
        hn_sample sample = {0};
        const int good = hn_comparison_sample(r->comparison, m, &sample);
        const hn_run_summary summary = hn_run_get_summary(hn_comparison_run(r->comparison, m));
        r->stores[m].step_ops[frame] =
            summary.steps > 0 ? hn_cost_known_ops(&summary.cost) / (double)summary.steps
                              : (double)NAN;
        if (good && sample.points) {
            keep_sample(r, m, frame, &sample);
        } else {
            keep_end(r, m, frame);
        }
    }
    keep_words(r);
    atomic_store(&r->frames, frame + 1);
}

/// Waits until a frame beyond the recorded ones is wanted; false: stop.
static bool wait_for_work(hn_recording *r) {
    pthread_mutex_lock(&r->lock);
    while (!atomic_load(&r->stop) && atomic_load(&r->wanted) < atomic_load(&r->frames)) {
        pthread_cond_wait(&r->more, &r->lock);
    }
    pthread_mutex_unlock(&r->lock);
    return !atomic_load(&r->stop);
}

/// Returns whether a frame is to be left unfinished: the thread ends, or its computing time is used
/// up.
static int must_break(void *user) {
    hn_recording *r = user;
    return atomic_load(&r->stop) || (r->limit > 0 && hn_clock_thread() >= r->limit);
}

static void *record(void *user) {
    hn_recording *r = user;
    hn_diags diags = {0};
    const hn_status stored = fetch(r, r->model, false, &diags);
    (void)stored; // without one there is no error to show, until one is computed
    atomic_store(&r->asked, false);
    while (atomic_load(&r->frames) <= r->last && wait_for_work(r)) {
        const double start = hn_clock_wall();
        if (must_break(r) || !hn_comparison_work(r->comparison, must_break, r)) {
            break;
        }
        keep_frame(r, atomic_load(&r->frames));
        atomic_store(&r->frame_seconds, hn_clock_wall() - start);
        atomic_store(&r->computed, hn_clock_thread());
    }
    const bool is_whole = atomic_load(&r->frames) > r->last;
    atomic_store(&r->out_of_time, !is_whole && !atomic_load(&r->stop));
    return NULL;
}

// ---- making ----

static bool allocate_track(hn_recording *r, int m) {
    track_store *to = &r->stores[m];
    const size_t frames = (size_t)r->last + 1;
    double **const columns[] = {&to->gap, &to->velocity_gap, &to->energy, &to->error,
                                &to->step_ops};
    bool good = true;
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        *columns[i] = calloc(frames, sizeof(double));
        good = good && *columns[i];
    }
    for (size_t k = 0; to->error && k < frames; k++) {
        to->error[k] = (double)NAN;
    }
    to->points = calloc(frames * 3 * (size_t)r->n_points + 1, sizeof(double));
    to->q = calloc(frames * (size_t)r->n_user + 1, sizeof(double));
    to->v = calloc(frames * (size_t)r->n_user + 1, sizeof(double));
    r->tracks[m].gap = to->gap;
    r->tracks[m].velocity_gap = to->velocity_gap;
    r->tracks[m].energy = to->energy;
    r->tracks[m].error = to->error;
    r->tracks[m].points = to->points;
    r->tracks[m].q = to->q;
    r->tracks[m].v = to->v;
    r->tracks[m].step_ops = to->step_ops;
    return good && to->points && to->q && to->v;
}

static void describe_track(hn_recording *r, int m) {
    const hn_method_spec *spec = hn_run_spec(hn_comparison_run(r->comparison, m));
    hn_track *track = &r->tracks[m];
    hn_method_format(spec, track->spelling);
    track->name = spec->formulation->short_name;
    track->rule = spec->formulation->rule;
    track->model_error = spec->formulation->model_error;
    track->slot = hn_comparison_slot(r->comparison, m);
}

static bool allocate(hn_recording *r) {
    r->incidents = calloc(MOST_INCIDENTS, sizeof *r->incidents);
    bool good = r->incidents != NULL;
    for (int m = 0; m < r->n_tracks; m++) {
        describe_track(r, m);
        good = allocate_track(r, m) && good;
    }
    return good;
}

static hn_status open_comparison(hn_recording *r, const char *const *methods, int n_methods,
                                 hn_diags *diags) {
    hn_comparison_opts opts = hn_comparison_opts_default();
    const double end = hn_model_scene(r->model)->duration;
    opts.duration = end;
    HN_TRY(hn_comparison_create(r->model, methods, n_methods, &opts, &r->comparison, diags));

    // frames as the page has them, or every so many of them where there are too many to keep
    const double chosen = hn_comparison_frame_dt(r->comparison);
    r->stride = (int)ceil(end / chosen / MOST_FRAMES);
    r->frame_dt = r->stride * chosen;
    r->duration = end;
    r->last = (int)ceil(end / r->frame_dt - 1e-9);
    if (r->stride > 1) {
        hn_comparison_free(r->comparison);
        r->comparison = NULL;
        opts.frame_dt = r->frame_dt;
        HN_TRY(hn_comparison_create(r->model, methods, n_methods, &opts, &r->comparison, diags));
    }
    r->n_tracks = hn_comparison_n_methods(r->comparison);
    r->n_points = hn_system_get_info(hn_model_system(r->model)).n_points;
    r->n_user = hn_system_get_info(hn_model_system(r->model)).n_user;
    return HN_OK;
}

hn_status hn_recording_create(const hn_model *model, const char *const *methods, int n_methods,
                              double limit, hn_recording **out, hn_diags *diags) {
    hn_recording *r = calloc(1, sizeof *r);
    if (!r) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    r->model = model;
    r->limit = limit;
    r->n_errors = 1; // all methods start where the reference does
    pthread_mutex_init(&r->lock, NULL);
    pthread_cond_init(&r->more, NULL);

    atomic_store(&r->asked, true);

    // nothing runs before all memory is there
    hn_status status = open_comparison(r, methods, n_methods, diags);
    if (status == HN_OK && !allocate(r)) {
        status = hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    if (status == HN_OK) {
        keep_frame(r, 0);
        r->started = pthread_create(&r->thread, NULL, record, r) == 0;
        status = r->started ? HN_OK
                            : hn_diags_add(diags, HN_ERR_LIMIT, NULL, NULL,
                                           "the system gives no thread for the recording");
    }
    if (status != HN_OK) {
        hn_recording_free(r);
        return status;
    }
    *out = r;
    return HN_OK;
}

void hn_recording_free(hn_recording *r) {
    if (!r) {
        return;
    }

    // the threads end: after the frame, and within the step of the reference that they are at
    atomic_store(&r->stop, true);
    if (r->computing) {
        pthread_join(r->truth_thread, NULL);
    }
    if (r->started) {
        pthread_mutex_lock(&r->lock);
        pthread_cond_signal(&r->more);
        pthread_mutex_unlock(&r->lock);
        pthread_join(r->thread, NULL);
    }
    for (int m = 0; m < HN_COMPARISON_MAX_METHODS; m++) {
        track_store *s = &r->stores[m];
        free(s->gap);
        free(s->velocity_gap);
        free(s->energy);
        free(s->error);
        free(s->step_ops);
        free(s->points);
        free(s->q);
        free(s->v);
    }

    // nobody reads any more
    hn_comparison_free(r->comparison);
    hn_true_motion_free(atomic_load(&r->truth));
    hn_model_free(r->own_model);
    free(r->incidents);
    pthread_cond_destroy(&r->more);
    pthread_mutex_destroy(&r->lock);
    free(r);
}

// ---- reading ----

void hn_recording_want(hn_recording *r, int frame) {
    pthread_mutex_lock(&r->lock);
    if (frame > atomic_load(&r->wanted)) {
        atomic_store(&r->wanted, frame < r->last ? frame : r->last);
        pthread_cond_signal(&r->more);
    }
    pthread_mutex_unlock(&r->lock);
}

int hn_recording_frames(const hn_recording *r) {
    return atomic_load(&r->frames);
}

bool hn_recording_is_out_of_time(const hn_recording *r) {
    return atomic_load(&r->out_of_time);
}

double hn_recording_computed(const hn_recording *r) {
    return atomic_load(&r->computed);
}

int hn_recording_last(const hn_recording *r) {
    return r->last;
}

double hn_recording_frame_dt(const hn_recording *r) {
    return r->frame_dt;
}

double hn_recording_time(const hn_recording *r, int frame) {
    return fmin(frame * r->frame_dt, r->duration);
}

int hn_recording_page_frame(const hn_recording *r, int frame) {
    return frame * r->stride;
}

double hn_recording_duration(const hn_recording *r) {
    return r->duration;
}

const hn_track *hn_recording_track(const hn_recording *r, int i) {
    return &r->tracks[i];
}

hn_track_end hn_recording_end(const hn_recording *r, int i) {
    pthread_mutex_t *lock = (pthread_mutex_t *)&r->lock;
    pthread_mutex_lock(lock);
    const hn_track_end end = r->ends[i];
    pthread_mutex_unlock(lock);
    return end;
}

const double *hn_recording_reference(const hn_recording *r, int frame) {
    return hn_true_motion_at(atomic_load(&r->truth), frame);
}

int hn_recording_incidents(const hn_recording *r, hn_incident *out, int *method, int most) {
    pthread_mutex_t *lock = (pthread_mutex_t *)&r->lock;
    pthread_mutex_lock(lock);
    const int n = r->n_incidents < most ? r->n_incidents : most;
    for (int i = 0; i < n; i++) {
        out[i] = r->incidents[i].incident;
        method[i] = r->incidents[i].method;
    }
    pthread_mutex_unlock(lock);
    return n;
}

hn_motion_verdict hn_recording_verdict(const hn_recording *r, int track, int frame) {
    const hn_system *sys = hn_model_system(r->model);
    const hn_track *t = &r->tracks[track];
    const hn_track_end end = hn_recording_end(r, track);
    const hn_true_motion *truth = atomic_load(&r->truth);
    const hn_motion_history history = {.gap = t->gap,
                                       .off = t->error,
                                       .energy = t->energy,
                                       .shown = frame,
                                       .t = hn_recording_time(r, frame),
                                       .ended = end.failed ? end.t : (double)NAN,
                                       .cause = end.cause,
                                       .length = hn_system_length(sys),
                                       .energy_scale = truth ? truth->energy_scale : 0,
                                       .digits = truth ? truth->digits : 0,
                                       .loops = hn_system_get_info(sys).nc > 0,
                                       .asked = atomic_load(&r->asked)};
    return hn_motion_judge(&history);
}

double hn_recording_frame_seconds(const hn_recording *r) {
    return atomic_load(&r->frame_seconds);
}
