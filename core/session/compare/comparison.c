// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/comparison.h"

#include "formulations/list/formulation_list.h"
#include "session/model/run_time.h"
#include "study/run/diagnosis.h"

#include "render/look.h"
#include "study/run/pace.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double FRAME = 1.0 / 60; // [s]
enum { LEAST_FRAMES = 240 };          // least number of frames of a short run
// frames whose cost is kept, and frames at the start that are not measured: their caches are cold
enum { COST_FRAMES = 63, COLD_FRAMES = 3 };

/// One method of the comparison.
typedef struct entry {
    hn_run *run;
    double h;                      ///< fixed step [s], 0 for an adaptive method
    int slot;                      ///< colour and dash, see render/look.h
    char warning[HN_DIAG_MESSAGE]; ///< warning about the spelling, "" if none
    int over_limit;                ///< stopped by the comparison because one frame cost too much
    double slowness;               ///< computing time per simulated time in that frame [-]
    double frame_cpu, frame_t;     ///< computing time and own time when the frame was begun [s]
    double frame_own_cpu;          ///< computing time of this process then [s]
    long long frame_steps;         ///< steps when the frame was begun
    double step_cpu[COST_FRAMES];  ///< computing time a step, of the last frames [s]
    int n_costs;                   ///< frames that were measured
    hn_accuracy_track track;       ///< what the accuracy watch has seen of it
} entry;

struct hn_comparison {
    const hn_model *model;
    int n;
    entry entries[HN_COMPARISON_MAX_METHODS];
    double frame_dt, duration, cpu_limit;
    double next_inside; ///< when methods are compared that have no step end at a frame [s]
    long long frame;
    hn_accuracy *accuracy; ///< one for all methods
    int in_frame;          ///< the frame after the present one was begun, and interrupted
    hn_hand hand;          ///< pulls while it runs
};

hn_comparison_opts hn_comparison_opts_default(void) {
    return (hn_comparison_opts){.cpu_limit = 5};
}

/// Returns the colour slot of a formulation: its place in the catalogue, or the next free slot when
/// two methods share it.
static int choose_slot(const hn_comparison *c, const hn_formulation *formulation) {
    int wanted = 0;
    while (wanted < hn_formulation_count() && hn_formulation_at(wanted) != formulation) {
        wanted++;
    }
    for (int shift = 0; shift < HN_LOOK_METHODS; shift++) {
        // the last slot is for the one that finds all others taken
        const int last = HN_LOOK_METHODS - 1;
        int slot = shift < last ? (wanted + shift) % last : last, taken = 0;
        for (int i = 0; i < c->n; i++) {
            taken |= c->entries[i].slot == slot;
        }
        if (!taken) {
            return slot;
        }
    }
    return wanted % HN_LOOK_METHODS; // more methods than a comparison takes
}

static hn_status add_method(hn_comparison *c, const char *text, const hn_comparison_opts *opts,
                            hn_diags *diags) {
    char pointer[32];
    snprintf(pointer, sizeof pointer, "/methods/%d", c->n);
    hn_diag diag = {0};
    hn_method_spec spec;
    hn_status status = hn_method_parse(text, &spec, &diag);
    if (status == HN_OK) {
        // a valid spelling may carry a warning, such as one about a negative alpha
        snprintf(c->entries[c->n].warning, sizeof c->entries[c->n].warning, "%s", diag.message);
        hn_run_opts run_opts = hn_run_opts_default();
        run_opts.t_end = opts->duration > 0 ? opts->duration : hn_model_scene(c->model)->duration;
        if (opts->max_steps > 0) {
            run_opts.max_steps = opts->max_steps;
        }
        status = hn_run_create(hn_model_system(c->model), &spec, hn_model_q(c->model),
                               hn_model_v(c->model), &run_opts, &c->entries[c->n].run, &diag);
    }
    if (status != HN_OK) {
        const char *place = diag.pointer[0] ? diag.pointer : pointer;
        return hn_diags_add(diags, status, place, diag.hint, "%s", diag.message);
    }

    // step and colour; the entry counts only from here on
    entry *e = &c->entries[c->n];
    e->h = hn_method_is_adaptive(&spec) ? 0 : hn_method_option(&spec, "h", 0);
    e->slot = choose_slot(c, spec.formulation);
    c->n++;
    return HN_OK;
}

/// Returns the least multiple of `step`, from `least` to twice as many (MOST_TRIALS at most), of
/// which whole frames make up the duration, so that the last frame is at the end; `least` where
/// there is none.
static double fit_frames(double step, double least, double duration) {
    enum { MOST_TRIALS = 1000 };
    const double steps = round(duration / step);
    const bool is_whole = fabs(steps * step - duration) <= 1e-9 * duration;
    for (double k = least; is_whole && k <= fmin(2 * least, least + MOST_TRIALS); k++) {
        if (fmod(steps, k) == 0) {
            return step * k;
        }
    }
    return step * least;
}

/// Returns a multiple of the largest fixed step, at least 1/60 s, or 1/240 of a short run.
static double choose_frame_dt(const hn_comparison *c) {
    const double shortest = fmin(FRAME, c->duration / LEAST_FRAMES);
    double h = 0;
    for (int i = 0; i < c->n; i++) {
        h = fmax(h, c->entries[i].h);
    }
    return h > 0 ? fit_frames(h, fmax(1, ceil(shortest / h - 1e-9)), c->duration) : shortest;
}

static hn_status check_opts(const hn_comparison_opts *opts, int n_methods, hn_diags *diags) {
    if (n_methods < 1 || n_methods > HN_COMPARISON_MAX_METHODS) {
        return hn_diags_add(
            diags, HN_ERR_INPUT, "/methods", "name one method, such as projection@rk4:h=1e-3",
            "%d methods were given; 1 to %d are allowed", n_methods, HN_COMPARISON_MAX_METHODS);
    }
    if (!(opts->frame_dt >= 0) || !isfinite(opts->frame_dt) ||
        (opts->frame_dt > 0 && opts->frame_dt < 1e-6)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/frame_dt",
                            "leave frame_dt out: the program chooses it",
                            "frame_dt is %g s; it must be at least 1e-6 s", opts->frame_dt);
    }
    return hn_run_time_check(opts->duration, true, "duration", "/duration", diags);
}

hn_status hn_comparison_create(const hn_model *model, const char *const *methods, int n_methods,
                               const hn_comparison_opts *opts, hn_comparison **out,
                               hn_diags *diags) {
    hn_comparison_opts chosen = opts ? *opts : hn_comparison_opts_default();
    HN_TRY(check_opts(&chosen, n_methods, diags));

    // one run per method
    hn_status status = HN_OK;
    hn_comparison *c = calloc(1, sizeof *c);
    if (!c) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    c->model = model;
    for (int i = 0; i < n_methods && status == HN_OK; i++) {
        status = add_method(c, methods[i], &chosen, diags);
    }
    if (status != HN_OK) {
        hn_comparison_free(c);
        return status;
    }

    // defaults from the scene and the methods
    c->duration = chosen.duration > 0 ? chosen.duration : hn_model_scene(model)->duration;
    c->frame_dt = chosen.frame_dt > 0 ? chosen.frame_dt : choose_frame_dt(c);
    c->cpu_limit = chosen.cpu_limit > 0 ? chosen.cpu_limit : hn_comparison_opts_default().cpu_limit;
    status = hn_accuracy_create(hn_model_system(model), hn_model_q(model), hn_model_v(model),
                                c->duration, &c->accuracy);
    HN_THEN(status, hn_hand_create(hn_model_system(model), &c->hand));
    if (status != HN_OK) {
        hn_comparison_free(c);
        return hn_diags_add(diags, status, NULL, NULL, "%s", hn_status_text(status));
    }
    *out = c;
    return HN_OK;
}

void hn_comparison_free(hn_comparison *c) {
    if (c) {
        for (int i = 0; i < c->n; i++) {
            hn_run_free(c->entries[i].run);
        }
        hn_accuracy_free(c->accuracy);
        hn_hand_free(&c->hand);
        free(c);
    }
}

int hn_comparison_n_methods(const hn_comparison *c) {
    return c->n;
}

double hn_comparison_frame_dt(const hn_comparison *c) {
    return c->frame_dt;
}

double hn_comparison_duration(const hn_comparison *c) {
    return c->duration;
}

long long hn_comparison_frame(const hn_comparison *c) {
    return c->frame;
}

const hn_run *hn_comparison_run(const hn_comparison *c, int method) {
    return c->entries[method].run;
}

int hn_comparison_slot(const hn_comparison *c, int method) {
    return c->entries[method].slot;
}

const char *hn_comparison_warning(const hn_comparison *c, int method) {
    return c->entries[method].warning;
}

double hn_comparison_cpu_limit(const hn_comparison *c) {
    return c->cpu_limit;
}

double hn_comparison_slowness(const hn_comparison *c, int method) {
    return c->entries[method].over_limit ? c->entries[method].slowness : 0;
}

const hn_model *hn_comparison_model(const hn_comparison *c) {
    return c->model;
}

const hn_hand *hn_comparison_hand(const hn_comparison *c) {
    return &c->hand;
}

const hn_accuracy *hn_comparison_accuracy(const hn_comparison *c, const hn_accuracy_track **track,
                                          int method) {
    *track = &c->entries[method].track;
    return c->accuracy;
}

static bool is_live(const entry *e) {
    return !e->over_limit && hn_run_get_summary(e->run).state != HN_RUN_FAILED;
}

bool hn_comparison_is_live(const hn_comparison *c, int method) {
    return is_live(&c->entries[method]);
}

bool hn_comparison_finished(const hn_comparison *c) {
    if ((double)c->frame * c->frame_dt >= c->duration * (1 - 1e-12)) {
        return true;
    }
    for (int i = 0; i < c->n; i++) {
        if (is_live(&c->entries[i])) {
            return false;
        }
    }
    return true;
}

/// Computing time of this process [s]: a program that is asked has a limit of its own.
static double own_cpu(const entry *e) {
    const hn_run_summary s = hn_run_get_summary(e->run);
    return s.cpu_seconds - s.cost.elsewhere;
}

int hn_comparison_slowest(const hn_comparison *c, double *slowness) {
    int slowest = -1;
    double most = 0;
    for (int i = 0; i < c->n && c->in_frame; i++) {
        const entry *e = &c->entries[i];
        const double cpu = own_cpu(e) - e->frame_own_cpu;
        if (is_live(e) && cpu > most) {
            const double moved = hn_run_time(e->run) - e->frame_t;
            most = cpu;
            slowest = i;
            *slowness = cpu / (moved > 0 ? moved : c->frame_dt); // a first step: at least so slow
        }
    }
    return slowest;
}

/// Stops a method whose frame has cost too much; 1 when it did.
static bool check_cpu_limit(const hn_comparison *c, entry *e) {
    const double cpu = own_cpu(e) - e->frame_own_cpu;
    if (cpu <= c->cpu_limit) {
        return false;
    }
    e->over_limit = 1;
    e->slowness = cpu / fmax(hn_run_time(e->run) - e->frame_t, 1e-300);
    return true;
}

/// Steps one method to the last point of its own grid at or before t (fixed step), or past t
/// (adaptive). Returns 0 when `stop` asked for it.
static bool advance_entry(hn_comparison *c, entry *e, double t, int (*stop)(void *user),
                          void *user) {
    double target = e->h > 0 ? floor(t / e->h + 1e-9) * e->h : t;
    hn_pace pace = hn_pace_begin();
    while (hn_run_time(e->run) < target * (1 - 1e-14)) {
        if (hn_run_step_towards(e->run, target) != HN_OK) {
            return true;
        }
        if (hn_pace_is_due(&pace)) {
            if (check_cpu_limit(c, e)) {
                return true;
            }
            if (stop && stop(user)) {
                return false;
            }
        }
    }
    return true;
}

/// Records the mean computing time of a step in this frame.
static void measure_frame(hn_comparison *c, entry *e) {
    const hn_run_summary s = hn_run_get_summary(e->run);
    if (c->frame >= COLD_FRAMES && s.steps > e->frame_steps) {
        e->step_cpu[e->n_costs++ % COST_FRAMES] =
            (s.cpu_seconds - e->frame_cpu) / (double)(s.steps - e->frame_steps);
    }
}

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

hn_step_cost hn_comparison_step_cost(const hn_comparison *c, int method) {
    const entry *e = &c->entries[method];
    const int n = e->n_costs < COST_FRAMES ? e->n_costs : COST_FRAMES;
    hn_step_cost cost = {n, (double)NAN, (double)NAN, (double)NAN};
    double sorted[COST_FRAMES];
    if (n >= HN_STEP_COST_FRAMES) {
        memcpy(sorted, e->step_cpu, (size_t)n * sizeof *sorted);
        qsort(sorted, (size_t)n, sizeof *sorted, compare_doubles);
        cost.low = sorted[n / 4];
        cost.median = sorted[n / 2];
        cost.high = sorted[(3 * n) / 4];
    }
    return cost;
}

/// Returns whether t is at the end of a step of a method with fixed steps.
static bool is_on_grid(const entry *e, double t) {
    return e->h > 0 && fabs(t - round(t / e->h) * e->h) <= 1e-9 * e->h;
}

/// Operations of all methods so far.
static double total_ops(const hn_comparison *c) {
    double ops = 0;
    for (int i = 0; i < c->n; i++) {
        ops += hn_run_ops(c->entries[i].run);
    }
    return ops;
}

/// Compares the methods at t with the run of the accuracy watch, where that is due and within its
/// share. Methods that have no step end there are compared at some frames alone.
static void watch_accuracy(hn_comparison *c, double t, bool at_frame) {
    const bool inside =
        at_frame && (t >= c->next_inside || t >= c->duration * (1 - 1e-9)); // a frame of these
    if ((!inside && !hn_accuracy_is_due(c->accuracy, t)) ||
        !hn_accuracy_reach(c->accuracy, t, total_ops(c))) {
        return;
    }
    for (int i = 0; i < c->n; i++) {
        entry *e = &c->entries[i];
        hn_sample sample;
        if (is_live(e) && (inside || is_on_grid(e, t)) &&
            hn_run_sample(e->run, t, &sample) == HN_OK) {
            hn_accuracy_see(c->accuracy, &sample, &e->track);
        }
    }
    c->next_inside = inside ? t + c->duration / HN_ACCURACY_LOOKS_INSIDE : c->next_inside;
}

/// The next time before t at which methods with fixed steps are compared, the end of one of the
/// longest of these steps; t where there is none.
static double next_look(const hn_comparison *c, double t, double after) {
    double h = 0;
    for (int i = 0; i < c->n; i++) {
        h = fmax(h, c->entries[i].h);
    }
    const double look = h > 0 ? ceil(hn_accuracy_next(c->accuracy) / h - 1e-9) * h : HUGE_VAL;
    // one that the watch could not make is not asked for twice
    return look > after && look < t * (1 - 1e-9) ? look : t;
}

// ---- the hand ----

hn_status hn_comparison_pull(hn_comparison *c, hn_pull *pull, hn_diag *diag) {
    return hn_hand_add(&c->hand, c->frame + c->in_frame, pull, diag);
}

hn_status hn_comparison_set_pulls(hn_comparison *c, const hn_pull_event *events, int n,
                                  hn_diag *diag) {
    HN_ASSERT(c->frame == 0 && !c->in_frame);
    for (int i = 0; i < n; i++) {
        hn_pull pull = events[i].pull;
        c->hand.done = i; // those before it are to be kept
        HN_TRY(hn_hand_add(&c->hand, events[i].frame, &pull, diag));
    }
    hn_hand_rewind(&c->hand);
    return HN_OK;
}

int hn_comparison_pulls(const hn_comparison *c, const hn_pull_event **out) {
    *out = c->hand.events;
    return c->hand.n;
}

static void tell_loads_changed(hn_comparison *c, double t) {
    for (int i = 0; i < c->n; i++) {
        hn_run_loads_changed(c->entries[i].run, t);
    }
    hn_accuracy_loads_changed(c->accuracy, t);
}

/// Applies what the hand does at the present frame. While it holds on, all stop at the next one, so
/// that no method runs far ahead of it.
static void do_pulls(hn_comparison *c) {
    hn_pull_log *log = hn_system_pulls(hn_model_system(c->model));
    if (!log) {
        return;
    }
    if (hn_hand_is_due(&c->hand, c->frame)) {
        double t = fmax((double)c->frame * c->frame_dt, hn_accuracy_time(c->accuracy));
        for (int i = 0; i < c->n; i++) {
            t = is_live(&c->entries[i]) ? fmax(t, hn_run_time(c->entries[i].run)) : t;
        }
        hn_hand_do(&c->hand, c->frame, t);
        tell_loads_changed(c, t);
    }
    const double next = (double)(c->frame + 1) * c->frame_dt;
    hn_pull_log_set_stop(log, hn_pull_log_at(log, next) ? next : HUGE_VAL);
    tell_loads_changed(c, HUGE_VAL);
}

/// Brings all methods to t; those with fixed steps are compared with the accuracy watch on the way.
/// Returns false when `stop` asked for it.
static bool advance_all(hn_comparison *c, double t, int (*stop)(void *user), void *user) {
    double to = -1;
    do {
        to = next_look(c, t, to);
        for (int k = 0; k < c->n; k++) {
            // the order rotates, so that no method always starts with cold caches
            entry *e = &c->entries[(k + c->frame) % c->n];
            if (!is_live(e) || (to < t && !(e->h > 0))) {
                continue;
            }
            if (!advance_entry(c, e, to, stop, user)) {
                return false;
            }
            if (!is_live(e)) {
                hn_accuracy_see_end(c->accuracy, e->run, total_ops(c), &e->track);
            }
        }
        watch_accuracy(c, to, to == t);
    } while (to < t);
    return true;
}

bool hn_comparison_work(hn_comparison *c, int (*stop)(void *user), void *user) {
    for (int i = 0; i < c->n && !c->in_frame; i++) {
        const hn_run_summary s = hn_run_get_summary(c->entries[i].run);
        c->entries[i].frame_cpu = s.cpu_seconds;
        c->entries[i].frame_own_cpu = s.cpu_seconds - s.cost.elsewhere;
        c->entries[i].frame_steps = s.steps;
        c->entries[i].frame_t = hn_run_time(c->entries[i].run);
    }

    // a method that has already reached t does nothing
    if (!c->in_frame) {
        do_pulls(c);
    }
    c->in_frame = 1;
    const double t = (double)(c->frame + 1) * c->frame_dt;
    if (!advance_all(c, t, stop, user)) {
        return false;
    }
    for (int i = 0; i < c->n; i++) {
        measure_frame(c, &c->entries[i]);
    }
    c->in_frame = 0;
    c->frame++;
    for (int i = 0; i < c->n && hn_comparison_finished(c); i++) {
        hn_run_diagnose(c->entries[i].run);
    }
    return true;
}

void hn_comparison_next(hn_comparison *c) {
    hn_comparison_work(c, NULL, NULL);
}

void hn_comparison_reset(hn_comparison *c) {
    c->frame = 0;
    c->in_frame = 0;
    c->next_inside = 0;
    hn_hand_rewind(&c->hand);
    hn_accuracy_reset(c->accuracy);
    for (int i = 0; i < c->n; i++) {
        c->entries[i].over_limit = 0;
        c->entries[i].track = (hn_accuracy_track){0};
        c->entries[i].n_costs = 0;
        hn_run_reset(
            c->entries[i]
                .run); // a run that cannot be set back stays failed, and its summary says why
    }
}

/// 1 if the formulation of this method has the setting.
static bool has_setting(const hn_run *run, const char *key) {
    const hn_formulation *f = hn_run_spec(run)->formulation;
    for (int i = 0; i < f->n_options; i++) {
        if (strcmp(f->options[i].key, key) == 0) {
            return true;
        }
    }
    return false;
}

hn_status hn_comparison_set(hn_comparison *c, int method, const char *key, double value,
                            hn_diag *diag) {
    if (method < -1 || method >= c->n) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/set/method", NULL,
                           "there is no method %d; -1 (all methods) and 0 to %d are allowed",
                           method, c->n - 1);
    }

    // one method, or all that have the option
    int served = 0;
    for (int i = 0; i < c->n; i++) {
        if ((method == -1 && has_setting(c->entries[i].run, key)) || method == i) {
            HN_TRY(hn_run_set(c->entries[i].run, key, value, diag));
            served++;
        }
    }

    if (!served) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/set/key",
                           "name an option that a method of the comparison has, such as h",
                           "no method of this comparison has an option '%.40s'", key);
    }
    return HN_OK;
}

bool hn_comparison_sample(const hn_comparison *c, int method, hn_sample *out) {
    const entry *e = &c->entries[method];
    double t = (double)c->frame * c->frame_dt;
    if (is_live(e) && hn_run_sample(e->run, t, out) == HN_OK) {
        return true;
    }
    // the last good state: a failed run keeps it as its present one
    if (hn_run_sample(e->run, hn_run_time(e->run), out) != HN_OK) {
        *out = (hn_sample){0};
    }
    return false;
}
