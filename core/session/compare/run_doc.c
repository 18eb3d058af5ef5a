// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/run_doc.h"

#include "base/units.h"
#include "session/compare/estimate.h"
#include "session/compare/failure.h"
#include "session/compare/incident_json.h"
#include "session/compare/sample_table.h"
#include "session/model/run_time.h"
#include "session/store/cost_json.h"
#include "study/run/diagnosis.h"
#include "study/run/pace.h"
#include "study/truth/accuracy.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DEFAULT_SAMPLES = 200, LARGEST_TABLE = 1 << 25 }; // doubles of one table: 256 MiB

/// A run as it is recorded.
typedef struct recorder {
    const hn_model *model;
    hn_sample_table *table;
    hn_pace pace;          ///< of the checks of limits between samples
    hn_accuracy *accuracy; ///< estimates the error at the samples
    hn_accuracy_track track;
} recorder;

/// Shows the accuracy watch a sample, where it wants one.
static void watch_accuracy(recorder *rec, const hn_sample *s, const hn_run *run) {
    if (hn_accuracy_is_due(rec->accuracy, s->t) &&
        hn_accuracy_reach(rec->accuracy, s->t, hn_run_ops(run))) {
        hn_accuracy_see(rec->accuracy, s, &rec->track);
    }
}

/// Hands the sample that was added last to the caller, the first with the names of its columns.
static void hand_out_row(const hn_sample_table *table, const hn_model *model, const hn_run *run,
                         const hn_run_request *request) {
    const double *values;
    const int n = hn_sample_table_row(table, &values);
    const bool is_first = hn_sample_table_count(table) == 1;
    hn_strbuf names;
    hn_strbuf_init(&names);
    if (is_first) {
        char spelling[HN_SPEC_MAX];
        hn_method_format(hn_run_spec(run), spelling);
        hn_json_object(&names);
        hn_json_put_string(&names, "scene", hn_model_scene(model)->id);
        hn_json_put_string(&names, "method", spelling);
        hn_sample_table_put_names(&names, table);
        hn_sample_table_put(&names, table);
        hn_json_end_object(&names);
    }
    request->row(request->row_user, is_first ? &names : NULL, values, n);
    hn_strbuf_reset(&names);
}

static void add_sample(recorder *rec, const hn_sample *s, hn_run *run,
                       const hn_run_request *request) {
    watch_accuracy(rec, s, run);
    hn_sample_table_add(rec->table, s, hn_run_sample_mark(run));
    if (request->row) {
        hand_out_row(rec->table, rec->model, run, request);
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
    HN_TRY(hn_run_time_check(r->time, false, "end time", "/time", diags));
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
        return hn_diags_add(
            diags, HN_ERR_LIMIT, r->at ? "/at" : "/every", "ask for fewer output times",
            "%.*g samples were asked for; at most %lld are allowed", n < 1e15 ? 15 : 3, n, allowed);
    }
    s->n = (long long)n;
    return r->at ? check_at(r, diags) : HN_OK;
}

/// Steps until the run reaches t. Returns HN_ERR_STOPPED when `progress` stops it.
static hn_status step_to(hn_run *run, double t, hn_pace *pace, const hn_run_request *r,
                         recorder *rec) {
    const bool fixed = !hn_method_is_adaptive(hn_run_spec(run));
    while (hn_run_time(run) < t * (1 - 1e-14)) {
        hn_status status = hn_run_step_towards(run, t);
        if (status != HN_OK) {
            return status;
        }
        // between output times too; an adaptive step would need dense output there
        hn_sample sample;
        if (fixed && hn_accuracy_is_due(rec->accuracy, hn_run_time(run)) &&
            hn_run_sample(run, hn_run_time(run), &sample) == HN_OK) {
            watch_accuracy(rec, &sample, run);
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
                             const hn_run_request *r, recorder *rec) {
    // a sample may cost more than the steps before it
    if (r->progress && hn_pace_is_due(&rec->pace) &&
        !r->progress(r->user, hn_run_time(run) / r->time)) {
        return HN_ERR_STOPPED;
    }
    hn_status status = step_to(run, h > 0 ? floor(t / h + 1e-9) * h : t, pace, r, rec);
    hn_sample sample;
    HN_THEN(status, sample_at(run, t, r->time, &sample));
    if (status == HN_OK) {
        add_sample(rec, &sample, run, r);
    }
    return status;
}

static double fixed_step(const hn_method_spec *spec) {
    return hn_method_is_adaptive(spec) ? 0 : hn_method_option(spec, "h", 0);
}

/// Records the whole run. A run that ends early keeps its samples, with its last good state as the
/// last one.
static hn_status record(hn_run *run, const schedule *s, recorder *rec) {
    double h = fixed_step(hn_run_spec(run));
    hn_pace pace = hn_pace_begin();
    rec->pace = hn_pace_begin();
    hn_status status = HN_OK;
    for (long long k = 0; k < s->n && status == HN_OK; k++) {
        status = take_sample(run, h, schedule_time(s, k), &pace, s->request, rec);
    }
    hn_sample last;
    double t = hn_run_time(run);
    if (status != HN_OK && hn_sample_table_has_room(rec->table) &&
        (hn_sample_table_count(rec->table) == 0 || t > hn_sample_table_last_time(rec->table)) &&
        t <= s->request->time && hn_run_sample(run, t, &last) == HN_OK) {
        add_sample(rec, &last, run, s->request);
    }
    if (status != HN_OK) {
        hn_accuracy_see_end(rec->accuracy, run, hn_run_ops(run), &rec->track);
    }
    return status;
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

static void put_run(hn_strbuf *b, const hn_run *run, const hn_run_request *request,
                    const char *warning, hn_status ended, const recorder *rec) {
    hn_run_summary s = hn_run_get_summary(run);
    char spelling[HN_SPEC_MAX];
    hn_method_format(hn_run_spec(run), spelling);
    hn_json_object(b);
    hn_json_put_string(b, "scene", hn_model_scene(rec->model)->id);
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
    const double reached = fmax(fmin(s.t, request->time), hn_sample_table_last_time(rec->table));
    hn_json_put_number(b, "t_reached", reached);
    hn_sample_table_put_names(b, rec->table);
    if (request->row && hn_sample_table_count(rec->table) > 0) {
        hn_sample_table_put_marks(b, rec->table);
    } else {
        hn_sample_table_put(b, rec->table);
    }
    hn_json_put_number(b, "worst_gap", s.worst_gap);
    hn_json_put_number(b, "worst_velocity_gap", s.worst_velocity_gap);
    hn_json_put_number(b, "worst_energy_change", s.worst_energy_change);
    hn_estimate_put_json(b, rec->accuracy, hn_run_spec(run), &rec->track, reached);
    hn_estimate_put_verdict(b, rec->accuracy, &rec->track, reached, run);
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

/// Makes the table with all columns that were asked for, and the watch on its accuracy.
static hn_status prepare(recorder *rec, const hn_model *model, const hn_run *run,
                         const hn_run_request *request, const schedule *times, hn_diags *diags) {
    const hn_sample_columns columns = {
        .raw_lambda = request->raw_lambda && hn_run_has_raw_lambda(run),
        .reactions = request->reactions,
        .max_numbers = request->max_numbers > 0 ? request->max_numbers : LARGEST_TABLE};
    rec->model = model;
    HN_TRY(hn_sample_table_create(model, times->n + 1, &columns, &rec->table, diags));
    return hn_accuracy_create(hn_model_system(model), hn_model_q(model), hn_model_v(model),
                              schedule_time(times, times->n - 1), &rec->accuracy);
}

hn_status hn_model_run_json(hn_strbuf *b, const hn_model *model, const hn_run_request *request,
                            hn_status *ended, hn_diags *diags) {
    hn_diag diag = {0};
    hn_method_spec spec;
    schedule times = {0};
    recorder rec = {0};
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
            const char *place = diag.pointer[0] ? diag.pointer : "/method";
            hn_diags_add(diags, status, place, diag.hint, "%s", diag.message);
        }
    }

    // table for the samples; run, diagnose, write
    HN_THEN(status, prepare(&rec, model, run, request, &times, diags));
    if (status == HN_OK) {
        *ended = record(run, &times, &rec);
        hn_run_diagnose(run);
        put_run(b, run, request, warning, *ended, &rec);
        status = b->failed ? HN_ERR_MEMORY : HN_OK;
    }
    hn_sample_table_free(rec.table);
    hn_accuracy_free(rec.accuracy);
    hn_run_free(run);
    return status;
}
