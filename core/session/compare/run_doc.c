// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/run_doc.h"

#include "base/units.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "session/store/columns_json.h"
#include "session/store/cost_json.h"
#include "session/compare/comparison.h"
#include "session/compare/estimate.h"
#include "session/compare/failure.h"
#include "session/compare/incident_json.h"
#include "session/model/reactions_json.h"
#include "study/run/pace.h"
#include "study/run/diagnosis.h"
#include "study/truth/accuracy.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DEFAULT_SAMPLES = 200, LARGEST_TABLE = 1 << 25 }; // doubles of one table: 256 MiB

/// Samples gathered row by row before they are written as columns.
typedef struct table {
    hn_arena *arena;
    int n_user, nc;
    long long n, cap;
    hn_pace pace; ///< of the checks of limits between samples
    double *t, *q, *v, *lambda, *gap, *velocity_gap, *energy, *work, *energy_change;
    double *mark;                  ///< hn_multiplier_mark of a sample
    hn_drawing drawing;            ///< its labelled points are columns too
    int n_points;                  ///< number of labelled points
    double *points;                ///< 3 per point, world [m]
    double *raw_lambda;            ///< NULL: not asked for, or the method has none
    hn_reaction_writer *reactions; ///< NULL: not asked for
    double *force, *moment;        ///< 3 per carrier
    double *effort;                ///< one per effort
    double *state;                 ///< q and v of a sample in system coordinates
    const hn_system *sys;
    const hn_model *model;
    double *flat;          ///< one row, for hn_run_request.row
    hn_accuracy *accuracy; ///< estimates the error at the samples
    hn_accuracy_track track;
} table;

/// Returns the largest number of values that the tables may hold.
static double most_numbers(const hn_run_request *r) {
    return r->max_numbers > 0 ? (double)r->max_numbers : LARGEST_TABLE;
}

static hn_status table_create(table *tab, const hn_system *sys, long long cap,
                              const hn_run_request *request, int raw_lambda, hn_diags *diags) {
    hn_system_info info = hn_system_get_info(sys);
    *tab = (table){.n_user = info.n_user, .nc = info.nc, .cap = cap};
    tab->drawing = hn_system_drawing(sys);
    for (int i = 0; i < tab->drawing.n_points; i++) {
        tab->n_points += tab->drawing.labels[i] != NULL;
    }

    // numbers per sample decide whether the table may be built
    double width = 7 + 2.0 * info.n_user + (raw_lambda ? 2.0 : 1.0) * info.nc + 3.0 * tab->n_points;
    if (width * (double)cap > most_numbers(request)) {
        return hn_diags_add(
            diags, HN_ERR_LIMIT, "/every", "ask for fewer output times",
            "%lld samples of %g numbers are more than one answer may hold (%.0f numbers)", cap,
            width, most_numbers(request));
    }

    // columns
    tab->arena = hn_arena_create(0);
    if (!tab->arena) {
        return HN_ERR_MEMORY;
    }
    size_t n = (size_t)cap;
    tab->t = hn_arena_doubles(tab->arena, n);
    tab->q = hn_arena_doubles(tab->arena, n * (size_t)info.n_user);
    tab->v = hn_arena_doubles(tab->arena, n * (size_t)info.n_user);
    tab->lambda = hn_arena_doubles(tab->arena, n * (size_t)info.nc);
    tab->mark = hn_arena_doubles(tab->arena, n);
    tab->points = hn_arena_doubles(tab->arena, 3 * n * (size_t)tab->n_points + 1);
    tab->raw_lambda = raw_lambda ? hn_arena_doubles(tab->arena, n * (size_t)info.nc) : NULL;
    tab->gap = hn_arena_doubles(tab->arena, n);
    tab->velocity_gap = hn_arena_doubles(tab->arena, n);
    tab->energy = hn_arena_doubles(tab->arena, n);
    tab->work = hn_arena_doubles(tab->arena, n);
    tab->energy_change = hn_arena_doubles(tab->arena, n);
    return hn_arena_failed(tab->arena) ? HN_ERR_MEMORY : HN_OK;
}

static hn_status table_want_reactions(table *tab, const hn_model *model,
                                      const hn_run_request *request, hn_diags *diags) {
    const hn_system_info info = hn_system_get_info(hn_model_system(model));
    HN_TRY(hn_reaction_writer_create(model, tab->arena, &tab->reactions, diags));
    const int carriers = hn_reaction_writer_count(tab->reactions),
              efforts = hn_reaction_writer_efforts(tab->reactions);
    if ((double)tab->cap * (6.0 * carriers + efforts) > most_numbers(request)) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/reactions", "ask for fewer output times",
                            "%lld samples of %d reactions are more than one answer may hold",
                            tab->cap, carriers + efforts);
    }
    const size_t n = 3 * (size_t)tab->cap * (size_t)carriers;
    tab->sys = hn_model_system(model);
    tab->force = hn_arena_doubles(tab->arena, n + 1);
    tab->moment = hn_arena_doubles(tab->arena, n + 1);
    tab->effort = hn_arena_doubles(tab->arena, (size_t)tab->cap * (size_t)efforts + 1);
    tab->state = hn_arena_doubles(tab->arena, (size_t)info.nq + (size_t)info.nv + 1);
    return hn_arena_failed(tab->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// Room for one row of all columns.
static hn_status table_want_rows(table *tab, const hn_model *model) {
    size_t width = 8 + 2 * (size_t)tab->n_user + 2 * (size_t)tab->nc + 3 * (size_t)tab->n_points;
    if (tab->reactions) {
        width += 6 * (size_t)hn_reaction_writer_count(tab->reactions) +
                 (size_t)hn_reaction_writer_efforts(tab->reactions);
    }
    tab->model = model;
    tab->flat = hn_arena_doubles(tab->arena, width);
    return tab->flat ? HN_OK : HN_ERR_MEMORY;
}

/// Adds the reactions of a sample; null where the accelerations cannot be computed.
static void add_reactions(table *tab, const hn_sample *s, size_t k) {
    const size_t n = 3 * (size_t)hn_reaction_writer_count(tab->reactions),
                 n_efforts = (size_t)hn_reaction_writer_efforts(tab->reactions);
    double *q = tab->state, *v = tab->state + hn_system_get_info(tab->sys).nq;
    double *effort = tab->effort + k * n_efforts;
    hn_system_from_user(tab->sys, s->q, q);
    hn_system_rates_from_user(tab->sys, s->v, v);
    if (hn_reaction_writer_eval(tab->reactions, s->t, q, v) == HN_OK) {
        hn_reaction_writer_rows(tab->reactions, tab->force + k * n, tab->moment + k * n, effort);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        tab->force[k * n + i] = tab->moment[k * n + i] = nan("");
    }
    for (size_t i = 0; i < n_efforts; i++) {
        effort[i] = nan("");
    }
}

static void add_points(table *tab, const hn_sample *s, size_t k) {
    double *to = tab->points + 3 * k * (size_t)tab->n_points;
    for (int i = 0; i < tab->drawing.n_points; i++) {
        if (tab->drawing.labels[i]) {
            memcpy(to, s->points + 3 * i, 3 * sizeof *to);
            to += 3;
        }
    }
}

/// Shows the accuracy watch a sample, where it wants one.
static void watch_accuracy(table *tab, const hn_sample *s, const hn_run *run) {
    if (hn_accuracy_reach(tab->accuracy, s->t, hn_run_ops(run))) {
        hn_accuracy_see(tab->accuracy, s, &tab->track);
    }
}

static void put_samples(hn_strbuf *b, const table *tab);
static void put_names(hn_strbuf *b, const hn_model *model);

static double *append(double *to, const double *values, size_t k, size_t width) {
    if (values) {
        memcpy(to, values + k * width, width * sizeof *to);
    }
    return values ? to + width : to;
}

/// Row k as one list of numbers, in the order that hn_run_request.row says; returns their number.
static int flatten(const table *tab, size_t k) {
    const size_t nq = (size_t)tab->n_user, nc = (size_t)tab->nc;
    const size_t carriers =
        tab->reactions ? 3 * (size_t)hn_reaction_writer_count(tab->reactions) : 0;
    const size_t efforts = tab->reactions ? (size_t)hn_reaction_writer_efforts(tab->reactions) : 0;

    // the columns in their order; a part without values has no column
    const struct {
        const double *values;
        size_t width;
    } parts[] = {{tab->t, 1},
                 {tab->q, nq},
                 {tab->v, nq},
                 {tab->lambda, nc},
                 {tab->raw_lambda, nc},
                 {nc > 0 ? tab->mark : NULL, 1},
                 {tab->force, carriers},
                 {tab->moment, carriers},
                 {tab->effort, efforts},
                 {tab->points, 3 * (size_t)tab->n_points},
                 {tab->gap, 1},
                 {tab->velocity_gap, 1},
                 {tab->energy, 1},
                 {tab->work, 1},
                 {tab->energy_change, 1}};

    double *to = tab->flat;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        to = append(to, parts[i].values, k, parts[i].width);
    }
    return (int)(to - tab->flat);
}

/// Hands the row that was added last to the caller, the first with the names of its columns.
static void hand_out_row(const table *tab, const hn_run *run, const hn_run_request *request) {
    const int n = flatten(tab, (size_t)tab->n - 1);
    hn_strbuf names;
    hn_strbuf_init(&names);
    if (tab->n == 1) {
        char spelling[HN_SPEC_MAX];
        hn_method_format(hn_run_spec(run), spelling);
        hn_json_object(&names);
        hn_json_put_string(&names, "scene", hn_model_scene(tab->model)->id);
        hn_json_put_string(&names, "method", spelling);
        put_names(&names, tab->model);
        if (tab->reactions) {
            hn_reaction_writer_names(&names, tab->reactions);
        }
        put_samples(&names, tab);
        hn_json_end_object(&names);
    }
    request->row(request->row_user, tab->n == 1 ? &names : NULL, tab->flat, n);
    hn_strbuf_reset(&names);
}

static void table_add(table *tab, const hn_sample *s, hn_run *run, const hn_run_request *request) {
    watch_accuracy(tab, s, run);

    // the state, and the multipliers with the mark of how far they are determined
    size_t k = (size_t)tab->n++, nq = (size_t)tab->n_user, nc = (size_t)tab->nc;
    tab->t[k] = s->t;
    memcpy(tab->q + k * nq, s->q, nq * sizeof(double));
    memcpy(tab->v + k * nq, s->v, nq * sizeof(double));
    if (nc > 0) {
        memcpy(tab->lambda + k * nc, s->lambda, nc * sizeof(double));
        tab->mark[k] = hn_run_sample_mark(run);
    }
    for (size_t i = 0; tab->raw_lambda && i < nc; i++) {
        tab->raw_lambda[k * nc + i] = s->raw_lambda ? s->raw_lambda[i] : nan(""); // written as null
    }

    // what was asked for besides, and the error measures
    if (tab->reactions) {
        add_reactions(tab, s, k);
    }
    add_points(tab, s, k);
    tab->gap[k] = s->gap;
    tab->velocity_gap[k] = s->velocity_gap;
    tab->energy[k] = s->energy;
    tab->work[k] = s->work;
    tab->energy_change[k] = s->energy_change;

    if (request->row) {
        hand_out_row(tab, run, request);
    }
}

/// Output times, one after the other.
typedef struct schedule {
    const hn_run_request *request;
    double every;
    long long n;
} schedule;

static double schedule_time(const schedule *s, long long k) {
    if (s->request->at) {
        return s->request->at[k];
    }
    return k == s->n - 1 ? s->request->time : (double)k * s->every;
}

static hn_status check_at(const hn_run_request *r, hn_diags *diags) {
    for (int i = 0; i < r->n_at; i++) {
        double before = i ? r->at[i - 1] : 0;
        if (!(r->at[i] >= before) || !isfinite(r->at[i])) {
            return hn_diags_add(
                diags, HN_ERR_INPUT, "/at", NULL,
                "output time %d is %.*g; times must be finite, ascending and not before 0", i + 1,
                hn_digits_apart(r->at[i], before, 6), r->at[i]);
        }
        if (r->at[i] > r->time * (1 + 1e-12)) {
            const int digits = hn_digits_apart(r->at[i], r->time, 6);
            return hn_diags_add(diags, HN_ERR_INPUT, "/at", NULL,
                                "output time %.*g s lies after the end, %.*g s", digits, r->at[i],
                                digits, r->time);
        }
    }
    return HN_OK;
}

static hn_status make_schedule(const hn_run_request *r, schedule *s, hn_diags *diags) {
    if (!(r->time > 0) || !(r->time <= 1e7)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/time", NULL,
                            "the end time is %.*g s; it must be above 0 and at most 1e7 s",
                            hn_digits_apart(r->time, 1e7, 6), r->time);
    }
    if (!(r->every >= 0) || !isfinite(r->every)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/every", NULL,
                            "the output interval is %g s; it must be above 0", r->every);
    }

    // number of output times; the end is always one of them
    *s = (schedule){.request = r, .every = r->every > 0 ? r->every : r->time / DEFAULT_SAMPLES};
    double n = r->at ? r->n_at : floor(r->time / s->every * (1 + 1e-12)) + 1;
    if (!r->at && (n - 1) * s->every < r->time * (1 - 1e-9)) {
        n += 1; // the end is always an output time
    }

    // limit of the caller
    long long allowed = r->max_samples > 0 ? r->max_samples : 1000000;
    if (n > (double)allowed) {
        return hn_diags_add(diags, HN_ERR_LIMIT, r->at ? "/at" : "/every",
                            "ask for fewer output times",
                            "%.0f samples were asked for; at most %lld are given", n, allowed);
    }
    s->n = (long long)n;
    return r->at ? check_at(r, diags) : HN_OK;
}

/// Steps until the run reaches t. Returns HN_ERR_STOPPED when `progress` stops it.
static hn_status step_to(hn_run *run, double t, hn_pace *pace, const hn_run_request *r,
                         table *tab) {
    const bool fixed = !hn_method_is_adaptive(hn_run_spec(run));
    while (hn_run_time(run) < t * (1 - 1e-14)) {
        hn_status status = hn_run_step_towards(run, t);
        if (status != HN_OK) {
            return status;
        }
        // between output times too; an adaptive step would need dense output there
        hn_sample sample;
        if (fixed && hn_accuracy_is_due(tab->accuracy, hn_run_time(run)) &&
            hn_run_sample(run, hn_run_time(run), &sample) == HN_OK) {
            watch_accuracy(tab, &sample, run);
        }
        if (r->progress && hn_pace_is_due(pace) &&
            !r->progress(r->user, hn_run_time(run) / r->time)) {
            return HN_ERR_STOPPED;
        }
    }
    return HN_OK;
}

/// Takes the sample at t. A run that has not reached t steps there first, unless that step would go
/// beyond the run's end; the failure of the step is the reason.
static hn_status sample_at(hn_run *run, double t, double t_end, hn_sample *sample) {
    const double h =
        hn_method_is_adaptive(hn_run_spec(run)) ? 0 : hn_method_option(hn_run_spec(run), "h", 0);
    hn_status status = hn_run_sample(run, t, sample);
    if (status != HN_OK && hn_run_time(run) < t && hn_run_time(run) + h <= t_end * (1 + 1e-9)) {
        status = hn_run_step_towards(run, t);
        HN_THEN(status, hn_run_sample(run, t, sample));
    }
    return status;
}

/// Runs to `t` and takes the sample there. A fixed step stops on its own grid first, so that output
/// times do not change the steps.
static hn_status take_sample(hn_run *run, double h, double t, hn_pace *pace,
                             const hn_run_request *r, table *tab) {
    // a sample may cost more than the steps before it
    if (r->progress && hn_pace_is_due(&tab->pace) &&
        !r->progress(r->user, hn_run_time(run) / r->time)) {
        return HN_ERR_STOPPED;
    }
    hn_status status = step_to(run, h > 0 ? floor(t / h + 1e-9) * h : t, pace, r, tab);
    hn_sample sample;
    HN_THEN(status, sample_at(run, t, r->time, &sample));
    if (status == HN_OK) {
        table_add(tab, &sample, run, r);
    }
    return status;
}

static double fixed_step(const hn_method_spec *spec) {
    return hn_method_is_adaptive(spec) ? 0 : hn_method_option(spec, "h", 0);
}

/// Records the whole run. A run that ends early keeps its samples, with its last good state as the
/// last one.
static hn_status record(hn_run *run, const schedule *s, table *tab) {
    double h = fixed_step(hn_run_spec(run));
    hn_pace pace = hn_pace_begin();
    tab->pace = hn_pace_begin();
    hn_status status = HN_OK;
    for (long long k = 0; k < s->n && status == HN_OK; k++) {
        status = take_sample(run, h, schedule_time(s, k), &pace, s->request, tab);
    }
    hn_sample last;
    double t = hn_run_time(run);
    if (status != HN_OK && tab->n < tab->cap && (tab->n == 0 || t > tab->t[tab->n - 1]) &&
        t <= s->request->time && hn_run_sample(run, t, &last) == HN_OK) {
        table_add(tab, &last, run, s->request);
    }
    return status;
}

static void put_samples(hn_strbuf *b, const table *tab) {
    hn_json_key(b, "samples");
    hn_json_object(b);

    // state and multipliers
    hn_json_put_numbers(b, "t", tab->t, (size_t)tab->n);
    hn_columns_put_table(b, "q", tab->q, tab->n, tab->n_user);
    hn_columns_put_table(b, "v", tab->v, tab->n, tab->n_user);
    hn_columns_put_table(b, "lambda", tab->lambda, tab->n, tab->nc);
    if (tab->nc > 0) {
        hn_json_put_numbers(b, "lambda_mark", tab->mark, (size_t)tab->n);
    }
    if (tab->raw_lambda) {
        hn_columns_put_table(b, "raw_lambda", tab->raw_lambda, tab->n, tab->nc);
    }

    // reactions, where they were asked for
    if (tab->reactions) {
        const int width = 3 * hn_reaction_writer_count(tab->reactions);
        hn_columns_put_table(b, "reaction_force", tab->force, tab->n, width);
        hn_columns_put_table(b, "reaction_moment", tab->moment, tab->n, width);
        hn_columns_put_table(b, "effort", tab->effort, tab->n,
                             hn_reaction_writer_efforts(tab->reactions));
    }

    // positions and error measures
    hn_columns_put_table(b, "points", tab->points, tab->n, 3 * tab->n_points);
    hn_json_put_numbers(b, "gap", tab->gap, (size_t)tab->n);
    hn_json_put_numbers(b, "velocity_gap", tab->velocity_gap, (size_t)tab->n);
    hn_json_put_numbers(b, "energy", tab->energy, (size_t)tab->n);
    hn_json_put_numbers(b, "work", tab->work, (size_t)tab->n);
    hn_json_put_numbers(b, "energy_change", tab->energy_change, (size_t)tab->n);
    hn_json_end_object(b);
}

static void put_names(hn_strbuf *b, const hn_model *model) {
    const hn_system *sys = hn_model_system(model);
    hn_columns_put_coordinates(b, sys);
    hn_columns_put_rates(b, sys);
    hn_columns_put_rows(b, sys);
    const hn_drawing drawing = hn_system_drawing(sys);
    hn_json_key(b, "points");
    hn_json_array(b);
    for (int i = 0; i < drawing.n_points; i++) {
        if (drawing.labels[i]) {
            hn_json_string(b, drawing.labels[i]);
        }
    }
    hn_json_end_array(b);
    hn_json_key(b, "lambda_marks");
    hn_json_strings(b, hn_multiplier_marks, HN_N_MULTIPLIER_MARKS);
}

/// Of samples that were handed out one by one, the marks alone: numbers are written once.
static void put_marks(hn_strbuf *b, const table *tab) {
    hn_json_key(b, "samples");
    hn_json_object(b);
    if (tab->nc > 0) {
        hn_json_put_numbers(b, "lambda_mark", tab->mark, (size_t)tab->n);
    }
    hn_json_end_object(b);
}

static void put_run_cost(hn_strbuf *b, const hn_run_summary *s) {
    hn_json_key(b, "cost");
    hn_json_object(b);
    hn_json_put_number(b, "cpu_seconds", s->cpu_seconds);
    hn_json_put_int(b, "evaluations", s->cost.evals);
    hn_cost_put_ops_json(b, "operations", &s->cost);
    hn_cost_put_reason_json(b, "operations_reason", &s->cost);
    hn_json_put_int(b, "steps", s->steps);
    hn_json_put_int(b, "rejected", s->rejected);
    hn_json_put_int(b, "factorisations", s->cost.factorisations);
    hn_json_put_int(b, "solves", s->cost.solves);
    hn_json_put_int(b, "newton", s->cost.newton);
    hn_json_put_int(b, "projections", s->cost.projections);
    hn_json_put_int(b, "fallbacks", s->cost.fallbacks);
    hn_json_put_number(b, "energy_removed", s->cost.energy_removed);
    hn_json_end_object(b);
}

static void put_run_incidents(hn_strbuf *b, const hn_run *run) {
    hn_json_key(b, "incidents");
    hn_json_array(b);
    hn_incidents_json(b, -1, run);
    hn_json_end_array(b);
}

/// Returns the reason of the run, or, if the run itself did not fail, the reason why its output
/// ended.
static const char *reason_of(const hn_run *run, const hn_run_request *request,
                             const hn_run_summary *s, hn_status ended) {
    if (ended == HN_OK || s->status != HN_OK) {
        return s->reason;
    }
    if (ended == HN_ERR_STOPPED) {
        return request->stop_reason ? request->stop_reason : "stopped on request";
    }
    return hn_run_sample_why(run, ended);
}

static void put_run(hn_strbuf *b, const hn_model *model, const hn_run *run,
                    const hn_run_request *request, const char *warning, hn_status ended,
                    const table *tab) {
    hn_run_summary s = hn_run_get_summary(run);
    char spelling[HN_SPEC_MAX];
    hn_method_format(hn_run_spec(run), spelling);
    hn_json_object(b);
    hn_json_put_string(b, "scene", hn_model_scene(model)->id);
    hn_json_put_string(b, "method", spelling);
    if (warning[0]) {
        hn_json_put_string(b, "warning", warning);
    }
    hn_json_put_string(b, "status", hn_status_name(ended));
    hn_json_put_string(b, "reason", reason_of(run, request, &s, ended));
    hn_failure_put_json(b, run, ended, reason_of(run, request, &s, ended),
                        fmin(s.t, request->time));
    // an adaptive step may end beyond the time asked for, a fixed one short of it: the sample at
    // that time is given all the same
    const double last = tab->n > 0 ? tab->t[tab->n - 1] : 0;
    const double reached = fmax(fmin(s.t, request->time), last);
    hn_json_put_number(b, "t_reached", reached);
    put_names(b, model);
    if (tab->reactions) {
        hn_reaction_writer_names(b, tab->reactions);
    }
    if (request->row && tab->n > 0) {
        put_marks(b, tab);
    } else {
        put_samples(b, tab);
    }
    hn_json_put_number(b, "worst_gap", s.worst_gap);
    hn_json_put_number(b, "worst_velocity_gap", s.worst_velocity_gap);
    hn_json_put_number(b, "worst_energy_change", s.worst_energy_change);
    hn_estimate_put_json(b, tab->accuracy, hn_run_spec(run), &tab->track, reached);
    hn_estimate_put_verdict(b, tab->accuracy, &tab->track, reached);
    put_run_incidents(b, run);
    put_run_cost(b, &s);
    hn_json_end_object(b);
}

static hn_status create_run(const hn_model *model, const hn_run_request *request,
                            const hn_method_spec *spec, hn_run **out, hn_diag *diag) {
    hn_run_opts opts = hn_run_opts_default();
    opts.t_end = request->time;
    opts.to_the_end = request->to_the_end;
    if (request->max_steps > 0) {
        opts.max_steps = request->max_steps;
    }
    opts.raw_lambda = request->raw_lambda;
    return hn_run_create(hn_model_system(model), spec, hn_model_q(model), hn_model_v(model), &opts,
                         out, diag);
}

/// The table with all columns that were asked for, and the watch on its accuracy.
static hn_status prepare_table(table *tab, const hn_model *model, const hn_run *run,
                               const hn_run_request *request, const schedule *times,
                               hn_diags *diags) {
    const hn_system *sys = hn_model_system(model);
    const int raw = request->raw_lambda && hn_run_has_raw_lambda(run);
    HN_TRY(table_create(tab, sys, times->n + 1, request, raw, diags));
    if (request->reactions) {
        HN_TRY(table_want_reactions(tab, model, request, diags));
    }
    HN_TRY(table_want_rows(tab, model));
    return hn_accuracy_create(sys, hn_model_q(model), hn_model_v(model),
                              schedule_time(times, times->n - 1), &tab->accuracy);
}

hn_status hn_model_run_json(hn_strbuf *b, const hn_model *model, const hn_run_request *request,
                            hn_status *ended, hn_diags *diags) {
    hn_diag diag = {0};
    hn_method_spec spec;
    schedule times = {0};
    table tab = {0};
    hn_run *run = NULL;
    hn_status status = hn_method_parse(request->method, &spec, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, "/method", diag.hint, "%s", diag.message);
    }

    // a valid spelling may carry a warning, which the document repeats
    char warning[HN_DIAG_MESSAGE];
    snprintf(warning, sizeof warning, "%s", diag.message);
    status = make_schedule(request, &times, diags);

    // the run
    if (status == HN_OK) {
        status = create_run(model, request, &spec, &run, &diag);
        if (status != HN_OK) {
            hn_diags_add(diags, status, "/method", diag.hint, "%s", diag.message);
        }
    }

    // tables for the samples; run, diagnose, write
    HN_THEN(status, prepare_table(&tab, model, run, request, &times, diags));
    if (status == HN_OK) {
        *ended = record(run, &times, &tab);
        hn_run_diagnose(run);
        put_run(b, model, run, request, warning, *ended, &tab);
        status = b->failed ? HN_ERR_MEMORY : HN_OK;
    }
    hn_reaction_writer_free(tab.reactions);
    hn_accuracy_free(tab.accuracy);
    hn_arena_free(tab.arena);
    hn_run_free(run);
    return status;
}
