// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/workprecision.h"

#include "base/clock.h"
#include "expr/native.h"
#include "study/cost/shards.h"
#include "study/run/timing.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { DEFAULT_LEVELS = 7, RESERVED_SAMPLES = 5, RETRIES = 1 };
static const double FIRST_RTOL = 3, LAST_RTOL = 12; // powers of ten
static const double COARSER = 4;                    // first step over the scene's
static const double GROWTH = 3; // of the cost from a tolerance to the next, before it is known
static const double POINT_SHARE = 0.2; // of the time that one run may take

static const char *const state_names[] = {"pending", "done", "failed", "skipped"};

const char *hn_wp_state_name(hn_wp_state state) {
    HN_ASSERT((int)state >= 0 && state < HN_WP_STATES);
    return state_names[state];
}

static const char *size_key(const hn_wp_method *m) {
    return m->adaptive ? "rtol" : "h";
}

/// "index1@rk4:h=0.1,x=2" -> "index1@rk4:x=2": the ladder sets the step sizes.
static void strip_size(char *spelling, const char *key) {
    char token[16];
    char *at = strchr(spelling, '@');
    snprintf(token, sizeof token, "%s=", key);
    for (char *p = at; p && *p; p++) {
        if ((*p == ':' || *p == ',') && strncmp(p + 1, token, strlen(token)) == 0) {
            char *end = p + 1 + strcspn(p + 1, ",");
            if (*end) { // the next one takes its separator
                p++;
                end++;
            }
            memmove(p, end, strlen(end) + 1);
            return;
        }
    }
}

hn_method_spec hn_wp_spec(const hn_wp *wp, int m, double size) {
    hn_method_spec spec = wp->methods[m].spec;
    *hn_method_find_option(&spec, size_key(&wp->methods[m]), NULL) = size;
    return spec;
}

void hn_wp_spelling(const hn_wp *wp, int m, int k, char out[HN_SPEC_MAX]) {
    const hn_method_spec spec = hn_wp_spec(wp, m, wp->methods[m].point[k].size);
    hn_method_format(&spec, out);
}

bool hn_wp_is_resolved(const hn_wp *wp, hn_error_kind kind, double error) {
    return isfinite(error) && error > HN_WP_ABOVE_REFERENCE * wp->ref->error[kind];
}

bool hn_wp_is_beyond_horizon(const hn_wp *wp) {
    return wp->horizon > 0 && wp->horizon < wp->ref->T;
}

/// Size number k: steps divide the reference's intervals and halve, tolerances fall evenly.
static double size_at(const hn_wp *wp, const hn_wp_method *m, int k) {
    if (m->adaptive) {
        return pow(10, -(FIRST_RTOL + (LAST_RTOL - FIRST_RTOL) * k / (wp->n_levels - 1)));
    }
    const double between = wp->ref->T / wp->ref->n;
    const double parts = ceil(between / wp->opts.step * (1 - 1e-12));
    return wp->ref->T / (wp->ref->n * fmax(1, parts) * ldexp(1, k));
}

static hn_status set_up_method(hn_wp *wp, const hn_method_spec *spec, int i, hn_diag *diag) {
    hn_wp_method *m = &wp->methods[i];
    m->spec = *spec;
    m->adaptive = hn_method_is_adaptive(spec);
    hn_method_format(spec, m->spelling);
    if (!hn_method_find_option(&m->spec, size_key(m), NULL)) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, NULL,
                           "%s has neither a step nor a tolerance to vary", m->spelling);
    }
    strip_size(m->spelling, size_key(m));
    for (int k = 0; k < wp->n_levels; k++) {
        m->point[k].size = size_at(wp, m, k);
        m->point[k].own = (double)NAN;
        m->point[k].median = m->point[k].spread = (double)NAN;
        m->point[k].low = m->point[k].high = (double)NAN;
        m->point[k].half[0] = m->point[k].half[1] = (double)NAN;
        m->point[k].end_q = hn_arena_doubles(wp->arena, (size_t)wp->ref->n_user);
    }
    return HN_OK;
}

static hn_status check_opts(hn_wp_opts *o, int n, const hn_system *sys, hn_diag *diag) {
    o->n_levels = o->n_levels == 0 ? DEFAULT_LEVELS : o->n_levels;
    o->n_samples = o->n_samples == 0 ? HN_WP_SAMPLES : o->n_samples;
    o->step = o->step == 0 ? COARSER * hn_system_scene(sys)->step : o->step;

    // numbers of methods, sizes and samples
    if (n < 1 || n > HN_WP_METHODS) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/methods", NULL,
                           "%d methods were given; a study takes 1 to %d", n, HN_WP_METHODS);
    }
    if (o->n_levels < 2 || o->n_levels > HN_WP_LEVELS) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/levels", NULL,
                           "%d sizes were asked for; a study takes 2 to %d", o->n_levels,
                           HN_WP_LEVELS);
    }
    if (o->n_samples > HN_WP_SAMPLES) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/samples", NULL,
                           "more samples of time were asked for than the %d that a study takes",
                           HN_WP_SAMPLES);
    }

    // step and time limit
    if (!(o->step > 0) || !(o->time_limit >= 0)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "a study takes a step above 0 and a time limit that is not negative");
    }

    // part of a divided study
    if (o->n_shards < 0 || o->n_shards > HN_WP_SHARDS || o->shard > o->n_shards ||
        o->shard < (o->n_shards > 0)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/shard", "as 2/4: the second of four",
                           "part %d of %d was asked for; a study has 1 to %d parts", o->shard,
                           o->n_shards, HN_WP_SHARDS);
    }
    return HN_OK;
}

hn_status hn_wp_create(const hn_system *sys, const double *q, const double *v, const hn_ref *ref,
                       const hn_method_spec *specs, int n, const hn_wp_opts *opts, hn_wp **out,
                       hn_diag *diag) {
    hn_wp_opts o = opts ? *opts : (hn_wp_opts){0};
    HN_TRY(check_opts(&o, n, sys, diag));
    hn_arena *arena = hn_arena_create(0);
    hn_wp *wp = arena ? hn_arena_get(arena, sizeof *wp) : NULL;
    if (!wp) {
        hn_arena_free(arena);
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *wp = (hn_wp){.arena = arena,
                  .sys = sys,
                  .q = q,
                  .v = v,
                  .ref = ref,
                  .opts = o,
                  .n_methods = n,
                  .n_levels = o.n_levels,
                  .clocks_apart = 1};
    wp->methods = hn_arena_get(arena, (size_t)n * sizeof *wp->methods);
    wp->runs = hn_arena_get(arena, (size_t)(n * o.n_levels) * sizeof *wp->runs);
    wp->shard = hn_arena_ints(arena, (size_t)(n * o.n_levels));
    hn_status status =
        hn_arena_failed(arena) ? HN_ERR_MEMORY : hn_errors_create(sys, arena, &wp->errors);
    for (int i = 0; i < n && status == HN_OK; i++) {
        status = set_up_method(wp, &specs[i], i, diag);
    }
    if (status == HN_OK && hn_arena_failed(arena)) {
        status = hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    if (status != HN_OK) {
        hn_wp_free(wp);
        return status;
    }
    hn_wp_split(wp, o.n_shards > 0 ? o.n_shards : 1, wp->shard);
    *out = wp;
    return HN_OK;
}

bool hn_wp_is_mine(const hn_wp *wp, int m, int k) {
    return wp->opts.n_shards == 0 || wp->shard[m * wp->n_levels + k] == wp->opts.shard;
}

static void drop_run(hn_wp *wp, int m, int k) {
    hn_run_free(wp->runs[m * wp->n_levels + k]);
    wp->runs[m * wp->n_levels + k] = NULL;
}

static void drop_runs(hn_wp *wp) {
    for (int i = 0; wp->methods && wp->runs && i < wp->n_methods * wp->n_levels; i++) {
        drop_run(wp, i / wp->n_levels, i % wp->n_levels);
    }
    hn_run_free(wp->yardstick_run);
    wp->yardstick_run = NULL;
}

void hn_wp_free(hn_wp *wp) {
    if (wp) {
        drop_runs(wp);
        hn_errors_free(wp->errors);
        hn_arena_free(wp->arena);
    }
}

// ---- one point ----

static hn_run *make_run(hn_wp *wp, int m, int k, hn_run **run, hn_diag *diag) {
    if (!*run) {
        const hn_method_spec spec = hn_wp_spec(wp, m, wp->methods[m].point[k].size);
        const hn_status status = hn_run_create(wp->sys, &spec, wp->q, wp->v, NULL, run, diag);
        if (status != HN_OK) {
            *run = NULL;
            diag->status = status;
            return NULL;
        }
        hn_run_watch(*run, 0); // the study looks itself
    }
    return *run;
}

static hn_run *run_of(hn_wp *wp, int m, int k, hn_diag *diag) {
    return make_run(wp, m, k, &wp->runs[m * wp->n_levels + k], diag);
}

typedef struct looker {
    hn_wp *wp;
    hn_wp_point *point;
} looker;

static int look(void *user, int k, const hn_sample *s) {
    looker *l = user;
    hn_wp_point *p = l->point;
    const hn_state_seen at = {s->t, s->q, s->v, s->lambda, s->energy, s->gap, s->velocity_gap};
    const hn_state_seen reference = hn_ref_at(l->wp->ref, k);
    hn_errors_calc(l->wp->errors, &at, &reference, &l->wp->ref->scales, p->end);
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        p->worst[i] = isnan(p->end[i]) || p->end[i] > p->worst[i] ? p->end[i] : p->worst[i];
    }
    memcpy(p->end_q, s->q, (size_t)l->wp->ref->n_user * sizeof(double));
    return isfinite(p->end[HN_ERROR_Q]) && isfinite(p->end[HN_ERROR_V]);
}

static void set_reason(hn_wp_point *p, hn_wp_state state, hn_status status, const char *reason) {
    p->state = state;
    p->status = status;
    p->ending = hn_ending_named(state == HN_WP_FAILED ? hn_status_name(status) : "");
    snprintf(p->reason, sizeof p->reason, "%s", reason);
}

/// Records in the point why its run did not reach the end.
static void set_failure(const hn_wp *wp, hn_wp_point *p, const hn_run *run, hn_walk_end end) {
    const hn_run_summary s = hn_run_get_summary(run);
    char text[256];
    p->t_reached = fmin(s.t, wp->ref->T);
    if (end == HN_WALK_OVER) {
        snprintf(text, sizeof text, "one run takes more than %.3g s of the time limit of %.3g s",
                 POINT_SHARE * wp->opts.time_limit, wp->opts.time_limit);
        set_reason(p, HN_WP_SKIPPED, HN_ERR_STOPPED, text);
    } else {
        set_reason(p, HN_WP_FAILED, s.status == HN_OK ? HN_ERR_DIVERGED : s.status,
                   s.reason[0] ? s.reason : "the state is not finite any more");
        p->ending = hn_ending_of(run, p->status, p->reason, s.t);
    }
}

static void keep_counts(hn_wp_point *p, const hn_run *run) {
    const hn_run_summary s = hn_run_get_summary(run);
    p->steps = s.steps;
    p->rejected = s.rejected;
    p->cost = s.cost;
    p->first_cpu = s.cpu_seconds;
}

void hn_wp_compare_ends(hn_wp *wp) {
    for (int m = 0; m < wp->n_methods; m++) {
        const hn_wp_point *coarser = NULL;
        for (int k = 0; k < wp->n_levels; k++) {
            hn_wp_point *p = &wp->methods[m].point[k];
            if (p->state == HN_WP_DONE) {
                p->own =
                    coarser ? hn_errors_between(wp->errors, p->end_q, coarser->end_q) : (double)NAN;
                coarser = p;
            }
        }
    }
}

/// Runs a point twice: once with checks against the reference, once without them for the counts
/// and as a warm-up. Returns 0 if stopped on request.
static bool measure_point(hn_wp *wp, int m, int k, const hn_wp_hooks *hooks) {
    hn_wp_point *p = &wp->methods[m].point[k];
    hn_diag diag = {0};
    hn_run *run = run_of(wp, m, k, &diag);
    if (!run && diag.status == HN_ERR_STOPPED) {
        return false; // its equations were not made to the end: it is still to be run
    }
    if (!run) {
        set_reason(p, HN_WP_FAILED, diag.status, diag.message);
        return true;
    }

    // errors at the times of the reference, then the counts of an undisturbed run
    looker l = {wp, p};
    const hn_walk_limits limits = {POINT_SHARE * wp->opts.time_limit, hooks->stop, hooks->user};
    memset(p->worst, 0, sizeof p->worst);
    hn_walk_end end = hn_walk(run, wp->ref->T, wp->ref->n, &limits, look, &l);
    if (end == HN_WALK_DONE) {
        end = hn_run_reset(run) == HN_OK ? hn_walk(run, wp->ref->T, wp->ref->n, &limits, NULL, NULL)
                                         : HN_WALK_FAILED;
    }

    // the result: stopped, failed or done
    if (end == HN_WALK_STOPPED) {
        drop_run(wp, m, k);
        return false;
    }
    keep_counts(p, run);
    if (end != HN_WALK_DONE) {
        set_failure(wp, p, run, end);
        drop_run(wp, m, k);
        return true;
    }
    p->state = HN_WP_DONE;
    p->t_reached = wp->ref->T;
    return true;
}

// ---- the time limit ----

/// Returns the next coarser point of this part of the study, or -1.
static int coarser_mine(const hn_wp *wp, int m, int k) {
    do {
        k--;
    } while (k >= 0 && !hn_wp_is_mine(wp, m, k));
    return k;
}

/// Returns the CPU time that a point is expected to take, from the coarser ones [s]; 0: not known.
static double expected_cpu(const hn_wp *wp, int m, int k) {
    const hn_wp_method *method = &wp->methods[m];
    const int j = coarser_mine(wp, m, k);
    if (j < 0 || method->point[j].state != HN_WP_DONE) {
        return 0;
    }
    const double last = method->point[j].first_cpu;
    const int i = coarser_mine(wp, m, j);
    double growth = method->adaptive ? GROWTH : 2;
    if (method->adaptive && i >= 0 && method->point[i].state == HN_WP_DONE) {
        growth = fmax(1, pow(last / method->point[i].first_cpu, 1.0 / (j - i)));
    }
    return last * pow(growth, k - j);
}

static double sample_cost(double cpu) {
    return fmax(HN_TIMING_BATCH, cpu);
}

/// Returns the time reserved for samples of the points that are done [s].
static double reserved(const hn_wp *wp) {
    double sum = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            const hn_wp_point *p = &wp->methods[m].point[k];
            const int due =
                wp->opts.n_samples < RESERVED_SAMPLES ? wp->opts.n_samples : RESERVED_SAMPLES;
            sum += p->state == HN_WP_DONE && p->n_samples < due
                       ? (due - p->n_samples) * sample_cost(p->first_cpu)
                       : 0;
        }
    }
    return sum;
}

/// Returns 1 if the rest of the time is enough for a point; otherwise marks it as left out.
static bool fits(hn_wp *wp, int m, int k, double started) {
    if (!(wp->opts.time_limit > 0)) {
        return true;
    }
    const int coarser = coarser_mine(wp, m, k);
    if (coarser >= 0 && wp->methods[m].point[coarser].state == HN_WP_SKIPPED) {
        set_reason(&wp->methods[m].point[k], HN_WP_SKIPPED, HN_ERR_STOPPED,
                   "left out, as the coarser size before it, to keep the time limit");
        return false;
    }

    // time that the point needs, and what is left
    const double cpu = expected_cpu(wp, m, k);
    const double sampling = wp->opts.n_samples > 0 ? RESERVED_SAMPLES * sample_cost(cpu) : 0;
    const double needed = 2 * cpu + sampling;
    const double left = wp->opts.time_limit - (hn_clock_wall() - started) - reserved(wp);
    char text[256];

    if (needed <= left && cpu <= POINT_SHARE * wp->opts.time_limit) {
        return true;
    }

    snprintf(text, sizeof text,
             "left out: about %.2g s of computing, and %.2g s are left of the time limit of %.3g s",
             needed, fmax(0, left), wp->opts.time_limit);
    set_reason(&wp->methods[m].point[k], HN_WP_SKIPPED, HN_ERR_STOPPED, text);
    return false;
}

// ---- time ----

/// Sorts the list in ascending order and returns its median.
static double sort_and_halve(double *list, int n) {
    hn_timing_sort(list, n);
    return hn_timing_quantile(list, n, 0.5);
}

void hn_wp_point_statistics(hn_wp_point *p) {
    double sorted[HN_WP_SAMPLES];
    const int n = p->n_samples, half = (n + 1) / 2;
    p->half[0] = p->half[1] = (double)NAN;
    if (n < 1) {
        return;
    }
    if (n >= HN_WP_ENOUGH) {
        memcpy(sorted, p->sample, (size_t)n * sizeof *sorted);
        p->half[0] = sort_and_halve(sorted, half);
        p->half[1] = sort_and_halve(sorted + half, n - half);
    }
    memcpy(sorted, p->sample, (size_t)n * sizeof *sorted);
    p->median = sort_and_halve(sorted, n);
    p->low = hn_timing_quantile(sorted, n, 0.25);
    p->high = hn_timing_quantile(sorted, n, 0.75);
    p->spread = p->median > 0 ? (p->high - p->low) / p->median : 0;
}

double hn_wp_point_halves_apart(const hn_wp_point *p) {
    return fmax(p->half[0], p->half[1]) / fmin(p->half[0], p->half[1]);
}

static bool is_stopped(const hn_wp_hooks *hooks) {
    return hooks->stop && hooks->stop(hooks->user);
}

/// Takes a sample of a run that is known to reach its end and reports it as one of point (m, k).
/// Returns 0 if stopped or failed.
static bool take_sample(hn_wp *wp, hn_wp_point *p, hn_run *run, int m, int k,
                        const hn_wp_hooks *hooks) {
    const hn_walk_limits limits = {0, hooks->stop, hooks->user};
    double seconds = 0, load = 0;
    for (int i = 0; i <= RETRIES; i++) {
        if (!hn_timing_batch(run, wp->ref->T, p->first_cpu, &limits, &seconds, &load)) {
            return false;
        }
        if (load <= HN_WP_BUSY) {
            break;
        }
    }
    p->busy += load > HN_WP_BUSY;
    p->sample[p->n_samples++] = seconds;
    hn_wp_point_statistics(p);
    if (hooks->sample) {
        hooks->sample(hooks->user, m, k);
    }
    return true;
}

static bool sample_point(hn_wp *wp, int m, int k, const hn_wp_hooks *hooks) {
    hn_diag diag = {0};
    hn_run *run = run_of(wp, m, k, &diag);
    return run && take_sample(wp, &wp->methods[m].point[k], run, m, k, hooks);
}

/// The coarsest run of the first method that comes to the end of the study: the same one in every
/// part. 0: none does.
static bool find_yardstick(hn_wp *wp, const hn_wp_hooks *hooks) {
    const hn_walk_limits limits = {POINT_SHARE * wp->opts.time_limit, hooks->stop, hooks->user};
    for (int m = 0; m < wp->n_methods && !is_stopped(hooks); m++) {
        hn_diag diag = {0};
        hn_run *run = make_run(wp, m, 0, &wp->yardstick_run, &diag);
        if (run && hn_walk(run, wp->ref->T, wp->ref->n, &limits, NULL, NULL) == HN_WALK_DONE) {
            wp->yardstick.first_cpu = hn_run_get_summary(run).cpu_seconds;
            wp->yardstick_method = m;
            return true;
        }
        hn_run_free(wp->yardstick_run);
        wp->yardstick_run = NULL;
    }
    return false;
}

static int sample_yardstick(hn_wp *wp, int round, const hn_wp_hooks *hooks) {
    if (wp->opts.n_shards == 0 || wp->yardstick.n_samples > round ||
        (!wp->yardstick_run && !find_yardstick(wp, hooks))) {
        return 1;
    }
    return take_sample(wp, &wp->yardstick, wp->yardstick_run, -1, 0, hooks);
}

// ---- the whole ----

/// Reports the share that is done, by computing time: two runs of each point, then its samples.
static void tell_progress(const hn_wp *wp, const hn_wp_hooks *hooks, double started) {
    double all = 0, done = 0;

    // expected time of all points, and of those that are done
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            const hn_wp_point *p = &wp->methods[m].point[k];
            if (!hn_wp_is_mine(wp, m, k)) {
                continue;
            }
            const double cpu = p->state == HN_WP_DONE ? p->first_cpu : expected_cpu(wp, m, k);
            const double timing = p->state == HN_WP_PENDING || p->state == HN_WP_DONE
                                      ? sample_cost(cpu) * fmax(0, wp->opts.n_samples)
                                      : 0;
            all += 2 * cpu + timing;
            done += p->state == HN_WP_DONE ? 2 * cpu + sample_cost(cpu) * p->n_samples : 0;
        }
    }

    double share = all > 0 ? done / all : 0;
    if (wp->opts.time_limit > 0) { // the study ends at whichever comes first
        share = fmax(share, (hn_clock_wall() - started) / wp->opts.time_limit);
    }

    if (hooks->progress) {
        hooks->progress(hooks->user, fmin(1, share));
    }
}

/// Runs every size of every method, coarse ones first. Returns 0 if stopped.
static bool run_points(hn_wp *wp, const hn_wp_hooks *hooks, double started) {
    for (int k = 0; k < wp->n_levels; k++) {
        for (int m = 0; m < wp->n_methods; m++) {
            hn_wp_point *p = &wp->methods[m].point[k];
            if (p->state == HN_WP_SKIPPED) {
                p->state = HN_WP_PENDING; // another try, with a time limit of its own
                p->reason[0] = 0;
            }

            if (is_stopped(hooks)) {
                return false;
            }
            if (p->state != HN_WP_PENDING || !hn_wp_is_mine(wp, m, k)) {
                continue;
            }

            // run the point if the time limit allows, then report it
            if (fits(wp, m, k, started) && !measure_point(wp, m, k, hooks)) {
                return false;
            }
            wp->out_of_time |= p->state == HN_WP_SKIPPED;
            if (hooks->point && p->state != HN_WP_SKIPPED) {
                hooks->point(hooks->user, m, k);
            }
            tell_progress(wp, hooks, started);
        }
    }
    return true;
}

/// Takes sample number `round` of every point that has fewer. Returns 0 if stopped or out of time.
static bool run_round(hn_wp *wp, int round, const hn_wp_hooks *hooks, double started) {
    if (!sample_yardstick(wp, round, hooks)) {
        return false;
    }

    for (int k = 0; k < wp->n_levels; k++) {
        for (int m = 0; m < wp->n_methods; m++) {
            hn_wp_point *p = &wp->methods[m].point[k];
            if (p->state != HN_WP_DONE || p->n_samples > round || !hn_wp_is_mine(wp, m, k)) {
                continue;
            }

            // no sample that the time limit would cut off
            const double left = wp->opts.time_limit - (hn_clock_wall() - started);
            if (wp->opts.time_limit > 0 && left < sample_cost(p->first_cpu)) {
                wp->out_of_time = 1;
                return false;
            }
            if (!sample_point(wp, m, k, hooks)) {
                return false;
            }
            tell_progress(wp, hooks, started);
        }
    }
    return true;
}

int hn_wp_run(hn_wp *wp, const hn_wp_hooks *hooks) {
    static const hn_wp_hooks nobody = {0};
    const hn_wp_hooks *h = hooks ? hooks : &nobody;
    const double started = hn_clock_wall();

    // times of methods are compared: all run by the interpreter, from the first step to the last
    hn_native_suspend();
    wp->out_of_time = 0;
    int going = run_points(wp, h, started);
    for (int round = 0; going && round < wp->opts.n_samples; round++) {
        if (round == (wp->opts.n_samples + 1) / 2) {
            drop_runs(
                wp); // the second half finds other memory, as a second start of the program does
        }
        going = run_round(wp, round, h, started);
    }
    hn_native_resume();
    hn_wp_compare_ends(wp);
    wp->stopped = is_stopped(h) || hn_graph_was_interrupted(hn_system_graph(wp->sys));
    wp->elapsed += hn_clock_wall() - started;
    return going && !wp->out_of_time;
}
