// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/measure.h"

#include "base/clock.h"
#include "expr/native.h"
#include "study/run/timing.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { RESERVED_SAMPLES = 5, RETRIES = 1 };
static const double GROWTH = 3; // of the cost from a tolerance to the next, before it is known
static const double POINT_SHARE = 0.2; // of the time limit that one run may take
// Operations that states between those of the reference may take, some seconds. The dearest of the
// built-in scenes takes a ninth of it.
static const double REFINE_OPS = 4e9;

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

/// Takes the errors at a time between two of the reference, as far as they are above what the state
/// there may itself be off; gaps always. A NaN at a state that is not known adds nothing.
static void look_between(looker *l, const hn_state_seen *at, int k, const double *off) {
    hn_wp_point *p = l->point;
    const hn_wp *wp = l->wp;
    const hn_state_seen reference = hn_refined_at(wp->refined, k);
    double e[HN_ERROR_COUNT];
    hn_errors_calc(wp->errors, at, &reference, &wp->ref->scales, e);
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        const bool is_gap = i == HN_ERROR_GAP || i == HN_ERROR_VELOCITY_GAP;
        if (e[i] > p->worst[i] && (is_gap || e[i] > HN_WP_ABOVE_REFERENCE * off[i])) {
            p->worst[i] = e[i];
        }
    }
    p->times++;
}

static int look(void *user, int k, const hn_sample *s) {
    looker *l = user;
    hn_wp_point *p = l->point;
    const hn_refined *refined = l->wp->refined;
    const hn_state_seen at = {s->t, s->q, s->v, s->lambda, s->energy, s->gap, s->velocity_gap};
    const double *off = hn_refined_error(refined, k);
    if (off) {
        if (isfinite(off[HN_ERROR_Q])) {
            look_between(l, &at, k, off);
        }
        return 1;
    }

    const hn_state_seen reference = hn_refined_at(refined, k);
    hn_errors_calc(l->wp->errors, &at, &reference, &l->wp->ref->scales, p->end);
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        p->worst[i] = isnan(p->end[i]) || p->end[i] > p->worst[i] ? p->end[i] : p->worst[i];
    }
    p->times++;
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
    p->times = 0;
    p->too_long = wp->refined->too_long;
    hn_walk_end end = hn_walk(run, wp->ref->T, wp->ref->n * wp->refined->parts, &limits, look, &l);
    if (end == HN_WALK_DONE) {
        end = hn_run_reset(run) == HN_OK ? hn_walk(run, wp->ref->T, wp->ref->n, &limits, NULL, NULL)
                                         : HN_WALK_FAILED;
    }

    // the result: stopped, failed or done
    if (end == HN_WALK_STOPPED) {
        hn_wp_drop_run(wp, m, k);
        return false;
    }
    keep_counts(p, run);
    if (end != HN_WALK_DONE) {
        set_failure(wp, p, run, end);
        hn_wp_drop_run(wp, m, k);
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
                   "left out to keep the time limit, as was the coarser size before it");
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

// ---- samples of time ----

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

static bool sample_yardstick(hn_wp *wp, int round, const hn_wp_hooks *hooks) {
    if (wp->opts.n_shards == 0 || wp->yardstick.n_samples > round ||
        (!wp->yardstick_run && !find_yardstick(wp, hooks))) {
        return true;
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

/// Leaves out every point that is still to be run.
static void leave_out_all(hn_wp *wp) {
    char text[256];
    snprintf(text, sizeof text,
             "left out: the true motion at the times of the errors is not found within the time "
             "limit of %.3g s",
             wp->opts.time_limit);
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            hn_wp_point *p = &wp->methods[m].point[k];
            if (hn_wp_is_mine(wp, m, k) &&
                (p->state == HN_WP_PENDING || p->state == HN_WP_SKIPPED)) {
                set_reason(p, HN_WP_SKIPPED, HN_ERR_STOPPED, text);
                wp->out_of_time = true;
            }
        }
    }
}

/// The states between those of the reference, once: a point is measured at all times or not at all.
/// Returns 0 if stopped, out of time or out of memory.
static bool refine(hn_wp *wp, const hn_wp_hooks *hooks) {
    const hn_walk_limits limits = {wp->opts.time_limit, hooks->stop, hooks->user};
    if (wp->refined) {
        return true;
    }
    const hn_status status = hn_refined_create(wp->sys, wp->ref, wp->errors, REFINE_OPS, &limits,
                                               wp->arena, &wp->refined);
    if (status == HN_ERR_LIMIT) {
        leave_out_all(wp);
    }
    wp->status = status == HN_ERR_MEMORY ? status : HN_OK;
    return status == HN_OK;
}

/// Runs every size of every method, coarse ones first. Returns 0 if stopped.
static bool run_points(hn_wp *wp, const hn_wp_hooks *hooks, double started) {
    if (!refine(wp, hooks)) {
        return false;
    }
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

bool hn_wp_run(hn_wp *wp, const hn_wp_hooks *hooks) {
    static const hn_wp_hooks nobody = {0};
    const hn_wp_hooks *h = hooks ? hooks : &nobody;
    const double started = hn_clock_wall();

    // times of methods are compared: all run by the interpreter, from the first step to the last
    hn_native_suspend();
    wp->out_of_time = 0;
    wp->status = HN_OK;
    bool going = run_points(wp, h, started);
    for (int round = 0; going && round < wp->opts.n_samples; round++) {
        if (round == (wp->opts.n_samples + 1) / 2) {
            // the second half finds other memory, as a second start of the program does
            hn_wp_drop_runs(wp);
        }
        going = run_round(wp, round, h, started);
    }
    hn_native_resume();
    hn_wp_compare_ends(wp);
    wp->stopped = is_stopped(h) || hn_graph_was_interrupted(hn_system_graph(wp->sys));
    wp->elapsed += hn_clock_wall() - started;
    return going && !wp->out_of_time;
}
