// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/comparison_doc.h"

#include "session/compare/estimate.h"
#include "session/compare/failure.h"
#include "session/compare/incident_json.h"
#include "session/store/cost_json.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

/// Returns the present state of the method: "running", "finished" or "failed".
static const char *state_name(const hn_comparison *c, int method) {
    return !hn_comparison_is_live(c, method) ? "failed"
           : hn_comparison_finished(c)       ? "finished"
                                             : "running";
}

static void put_reason(hn_strbuf *b, const hn_comparison *c, int method, const hn_run_summary *s) {
    const hn_run *run = hn_comparison_run(c, method);
    const double slowness = hn_comparison_slowness(c, method);
    if (slowness > 0) {
        char text[200];
        snprintf(text, sizeof text,
                 "computing one frame, %.3g s of motion, took more than %g s, at least %.3g times "
                 "as long as real time; take a larger step",
                 hn_comparison_frame_dt(c), hn_comparison_cpu_limit(c), slowness);
        hn_json_put_string(b, "status", hn_status_name(HN_ERR_STOPPED));
        hn_json_put_string(b, "reason", text);
        hn_failure_put_json(b, run, HN_ERR_STOPPED, text, s->t);
    } else {
        hn_json_put_string(b, "status", hn_status_name(s->status));
        hn_json_put_string(b, "reason", s->reason);
        hn_failure_put_json(b, run, s->status, s->reason, s->t);
    }
}

static void put_warning(hn_strbuf *b, const hn_comparison *c, int method) {
    const char *warning = hn_comparison_warning(c, method);
    if (warning[0]) {
        hn_json_put_string(b, "warning", warning);
    }
}

/// The time of the present frame [s].
static double clock_of(const hn_comparison *c) {
    return (double)hn_comparison_frame(c) * hn_comparison_frame_dt(c);
}

static void put_step_cost(hn_strbuf *b, const hn_comparison *c, int method) {
    const hn_step_cost cost = hn_comparison_step_cost(c, method);
    hn_json_key(b, "step_cpu");
    hn_json_object(b);
    hn_json_put_number(b, "median", cost.median);
    hn_json_put_number(b, "low", cost.low);
    hn_json_put_number(b, "high", cost.high);
    hn_json_put_int(b, "frames", cost.frames);
    hn_json_end_object(b);
}

static void put_cost(hn_strbuf *b, const hn_run_summary *s) {
    hn_json_put_int(b, "steps", s->steps);
    hn_json_put_int(b, "rejected", s->rejected);
    hn_json_put_int(b, "evals", s->cost.evals);
    hn_cost_put_ops_json(b, "ops", &s->cost);
    hn_json_put_number(b, "cpu", s->cpu_seconds);
    hn_json_put_number(b, "worst_gap", s->worst_gap);
    hn_json_put_number(b, "worst_velocity_gap", s->worst_velocity_gap);
    hn_json_put_number(b, "worst_energy_change", s->worst_energy_change);
}

static void put_sample(hn_strbuf *b, const hn_comparison *c, const hn_sample *sample) {
    hn_system_info info = hn_system_get_info(hn_model_system(hn_comparison_model(c)));
    hn_json_put_number(b, "t", sample->t);
    if (!sample->q) {
        return;
    }
    hn_json_put_numbers(b, "q", sample->q, (size_t)info.n_user);
    hn_json_put_numbers(b, "v", sample->v, (size_t)info.n_user);
    hn_json_put_numbers(b, "points", sample->points, 3 * (size_t)info.n_points);
    hn_json_put_number(b, "gap", sample->gap);
    hn_json_put_number(b, "velocity_gap", sample->velocity_gap);
    hn_json_put_number(b, "energy", sample->energy);
    hn_json_put_number(b, "work", sample->work);
    hn_json_put_number(b, "energy_change", sample->energy_change);
    hn_json_put_number(b, "pivot_ratio", sample->pivot_ratio);
    hn_json_put_int(b, "rank", sample->rank);
}

/// The force of the hand on this state [N].
static void put_pull_force(hn_strbuf *b, const hn_comparison *c, const hn_sample *sample) {
    double force[3];
    const hn_hand *hand = hn_comparison_hand(c);
    if (hand->force && sample->q) {
        hn_pull_force_run(hand->force, sample->t, sample->q, sample->v, force);
        hn_json_put_numbers(b, "pull_force", force, 3);
    }
}

/// The estimate of the method's error up to time t [s], and the verdict on it where it is wanted.
static void put_estimate(hn_strbuf *b, const hn_comparison *c, int method, double t,
                         bool with_verdict) {
    const hn_accuracy_track *track;
    const hn_accuracy *accuracy = hn_comparison_accuracy(c, &track, method);
    hn_estimate_put_json(b, accuracy, hn_run_spec(hn_comparison_run(c, method)), track, t);
    if (with_verdict) {
        hn_estimate_put_verdict(b, accuracy, track, t, hn_comparison_run(c, method));
    }
}

static void put_incidents(hn_strbuf *b, const hn_comparison *c) {
    hn_json_key(b, "incidents");
    hn_json_array(b);
    for (int i = 0; i < hn_comparison_n_methods(c); i++) {
        hn_incidents_json(b, i, hn_comparison_run(c, i));
    }
    hn_json_end_array(b);
}

void hn_comparison_frame_json(hn_strbuf *b, const hn_comparison *c) {
    hn_json_object(b);
    hn_json_put_int(b, "frame", hn_comparison_frame(c));
    hn_json_put_number(b, "t", clock_of(c));
    hn_json_put_bool(b, "finished", hn_comparison_finished(c));
    if (hn_comparison_hand(c)->force) {
        hn_hand_put_json(b, hn_comparison_hand(c), clock_of(c));
    }

    // state, sample and cost of every method at this frame
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int i = 0; i < hn_comparison_n_methods(c); i++) {
        hn_sample sample = {0};
        hn_comparison_sample(c, i, &sample);
        hn_run_summary s = hn_run_get_summary(hn_comparison_run(c, i));
        hn_json_object(b);
        hn_json_put_string(b, "state", state_name(c, i));
        put_reason(b, c, i, &s);
        put_sample(b, c, &sample);
        put_pull_force(b, c, &sample);
        put_cost(b, &s);
        put_step_cost(b, c, i);
        put_estimate(b, c, i, s.t, false);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

const char *hn_frame_extra_name(hn_frame_extra extra) {
    static const char *const names[HN_FRAME_EXTRAS] = {[HN_FRAME_SIGMA_MIN] = "sigma_min",
                                                       [HN_FRAME_LAMBDA] = "lambda",
                                                       [HN_FRAME_CONDITION] = "condition"};
    return names[extra];
}

void hn_comparison_extra_json(hn_strbuf *b, const hn_comparison *c, hn_frame_extra extra) {
    const hn_system_info info = hn_system_get_info(hn_model_system(hn_comparison_model(c)));
    hn_json_array(b);
    for (int i = 0; i < hn_comparison_n_methods(c); i++) {
        if (extra == HN_FRAME_SIGMA_MIN) {
            hn_json_number(b, hn_run_sigma_min(hn_comparison_run(c, i)));
            continue;
        }
        if (extra == HN_FRAME_CONDITION) {
            hn_json_number(b, hn_run_condition(hn_comparison_run(c, i)));
            continue;
        }

        // none where the last good state could not be sampled
        hn_sample sample = {0};
        hn_comparison_sample(c, i, &sample);
        hn_json_array(b);
        for (int k = 0; sample.lambda && k < info.nc; k++) {
            hn_json_number(b, sample.lambda[k]);
        }
        hn_json_end_array(b);
    }
    hn_json_end_array(b);
}

void hn_comparison_json(hn_strbuf *b, const hn_comparison *c) {
    hn_json_object(b);
    hn_json_put_number(b, "frame_dt", hn_comparison_frame_dt(c));
    hn_json_put_number(b, "duration", hn_comparison_duration(c));

    // properties of the methods that no frame changes
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int i = 0; i < hn_comparison_n_methods(c); i++) {
        // legend: colour, names, one-sentence rule
        const hn_method_spec *spec = hn_run_spec(hn_comparison_run(c, i));
        hn_json_object(b);
        hn_json_put_int(b, "slot", hn_comparison_slot(c, i));
        hn_json_put_string(b, "short", spec->formulation->short_name);
        hn_json_put_string(b, "rule", spec->formulation->rule);
        hn_json_put_string(b, "drift", spec->formulation->drift);

        // theory: errors of the model, drift, order
        hn_json_put_bool(b, "model_error", spec->formulation->model_error);
        hn_json_put_bool(b, "keeps_gap",
                         (spec->formulation->traits & HN_TRAIT_CLOSES_POSITION) != 0);
        hn_json_put_number(b, "order", spec->stepper->order > 0 ? spec->stepper->order : nan(""));
        put_warning(b, c, i);
        hn_json_key(b, "method");
        hn_method_json(b, spec);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

/// One method's row of the final table.
static void put_summary(hn_strbuf *b, const hn_comparison *c, int method) {
    const hn_run *run = hn_comparison_run(c, method);
    const hn_run_summary s = hn_run_get_summary(run);
    char spelling[HN_SPEC_MAX];
    hn_method_format(hn_run_spec(run), spelling);

    // name and state
    hn_json_object(b);
    hn_json_put_string(b, "method", spelling);
    hn_json_put_string(b, "short", hn_run_spec(run)->formulation->short_name);
    hn_json_put_int(b, "slot", hn_comparison_slot(c, method));
    hn_json_put_string(b, "state", state_name(c, method));
    put_warning(b, c, method);
    put_reason(b, c, method, &s);
    // a step may end beyond the clock or short of it; its sample is that of the clock's time
    const double clock = clock_of(c);
    const double reached = hn_comparison_is_live(c, method) ? clock : fmin(s.t, clock);
    hn_json_put_number(b, "t_reached", reached);

    // cost and error totals
    put_cost(b, &s);
    put_step_cost(b, c, method);
    hn_cost_put_reason_json(b, "ops_reason", &s.cost);
    put_estimate(b, c, method, reached, true);
    hn_json_put_number(b, "energy_removed", s.cost.energy_removed);
    hn_json_put_int(b, "fallbacks", s.cost.fallbacks);
    hn_json_put_int(b, "chart_changes", s.cost.chart_changes);
    hn_json_end_object(b);
}

void hn_comparison_summary_json(hn_strbuf *b, const hn_comparison *c) {
    hn_json_object(b);
    hn_json_put_string(b, "scene", hn_model_scene(hn_comparison_model(c))->id);
    hn_json_put_number(b, "t", clock_of(c));
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int i = 0; i < hn_comparison_n_methods(c); i++) {
        put_summary(b, c, i);
    }
    hn_json_end_array(b);
    put_incidents(b, c);
    hn_json_end_object(b);
}
