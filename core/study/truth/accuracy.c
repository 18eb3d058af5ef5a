// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/truth/accuracy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PILOT, ROUGH, RUNS };
static const char *const methods[RUNS] = {HN_ACCURACY_METHOD, HN_ACCURACY_ROUGH};

struct hn_accuracy {
    hn_arena *arena;
    hn_run *run[RUNS]; ///< the first NULL: the scene has no such run
    hn_errors *errors;
    double t_end;                ///< end of the runs [s]
    int looks;                   ///< comparisons so far: the next one is at looks * t_end / LOOKS
    hn_scales scales;            ///< largest rate and reaction of the pilot so far
    hn_sample sample;            ///< of the pilot, at the time reached last
    double own[HN_ERROR_COUNT];  ///< what it may be off itself, the largest so far, without scales
    const hn_coordinate *own_at; ///< the one behind own[HN_ERROR_Q]
    double t_out;     ///< where its operations were used up, or it ended [s]; HUGE_VAL: nowhere
    bool lost;        ///< the pilot may be off too much itself
    char reason[200]; ///< why it is not there or ended
};

static const hn_scales unity = {.length = 1, .rate = 1, .reaction = 1, .energy = 1};

/// Forgets what was compared. The states of the runs are set back by the caller.
static void begin(hn_accuracy *a) {
    a->looks = 0;
    a->t_out = HUGE_VAL;
    a->lost = false;
    a->scales = (hn_scales){0};
    memset(a->own, 0, sizeof a->own);
    a->own_at = NULL;
}

static hn_status create_parts(hn_accuracy *a, const hn_system *sys, const double *q,
                              const double *v) {
    hn_diag diag = {0};

    // a large mechanism gets no estimate: it would delay the start
    if (hn_system_get_info(sys).nodes > HN_ACCURACY_NODES) {
        snprintf(a->reason, sizeof a->reason,
                 "the mechanism is so large that starting a second, tighter run (the pilot run) "
                 "would take longer than the estimate is worth");
        return HN_OK;
    }

    // the runs; where one cannot start, its reason stands in for the estimate
    HN_TRY(hn_errors_create(sys, a->arena, &a->errors));
    for (int i = 0; i < RUNS; i++) {
        hn_method_spec spec;
        HN_TRY(hn_method_parse(methods[i], &spec, &diag));
        const hn_status status = hn_run_create(sys, &spec, q, v, NULL, &a->run[i], &diag);
        if (status == HN_ERR_MEMORY || status == HN_ERR_LIMIT) {
            return status;
        }
        if (status != HN_OK) {
            snprintf(a->reason, sizeof a->reason, "%.190s", diag.message);
            return HN_OK;
        }
        hn_run_watch(a->run[i], 0);
    }
    return HN_OK;
}

hn_status hn_accuracy_create(const hn_system *sys, const double *q, const double *v, double t_end,
                             hn_accuracy **out) {
    HN_ASSERT(sys && q && v && out);
    hn_accuracy *a = calloc(1, sizeof *a);
    *out = NULL;
    if (!a) {
        return HN_ERR_MEMORY;
    }
    a->arena = hn_arena_create(0);
    a->t_end = t_end;
    begin(a);
    const hn_status status = a->arena ? create_parts(a, sys, q, v) : HN_ERR_MEMORY;
    if (status != HN_OK) {
        hn_accuracy_free(a);
        return status;
    }
    *out = a;
    return HN_OK;
}

void hn_accuracy_free(hn_accuracy *a) {
    if (a) {
        for (int i = 0; i < RUNS; i++) {
            hn_run_free(a->run[i]);
        }
        hn_errors_free(a->errors);
        hn_arena_free(a->arena);
        free(a);
    }
}

static bool is_there(const hn_accuracy *a) {
    return a->run[PILOT] && a->run[ROUGH];
}

void hn_accuracy_reset(hn_accuracy *a) {
    begin(a);
    for (int i = 0; i < RUNS && is_there(a); i++) {
        a->reason[0] = '\0';
        (void)hn_run_reset(a->run[i]); // a run that cannot start says so at its first step
    }
}

double hn_accuracy_time(const hn_accuracy *a) {
    double t = 0;
    for (int i = 0; i < RUNS && is_there(a); i++) {
        t = fmax(t, hn_run_time(a->run[i]));
    }
    return t;
}

void hn_accuracy_loads_changed(hn_accuracy *a, double t) {
    for (int i = 0; i < RUNS && is_there(a); i++) {
        hn_run_loads_changed(a->run[i], t);
    }
}

double hn_accuracy_ops(const hn_accuracy *a) {
    return is_there(a) ? hn_run_ops(a->run[PILOT]) + hn_run_ops(a->run[ROUGH]) : 0;
}

// ---- pilot and rough run ----

static hn_state_seen seen_of(const hn_sample *s) {
    return (hn_state_seen){s->t, s->q, s->v, s->lambda, s->energy, s->gap, s->velocity_gap};
}

/// Raises the scales that divide errors in the end: largest rate and reaction of the motion so far.
static void raise_scales(hn_accuracy *a, const hn_sample *s) {
    const hn_state_seen at = seen_of(s);
    a->scales.rate = fmax(a->scales.rate, hn_errors_rate(a->errors, at.v));
    // a state without multipliers has no reaction
    a->scales.reaction = fmax(a->scales.reaction, hn_errors_reaction(a->errors, &at, at.lambda));
}

/// Steps one of the two to t within the operations allowed.
static bool step_to(hn_accuracy *a, hn_run *run, double t, double ops) {
    const double allowed = HN_ACCURACY_FREE + HN_ACCURACY_SHARE * ops;
    while (hn_run_time(run) < t) {
        const bool used_up = hn_accuracy_ops(a) > allowed;
        if (used_up) {
            snprintf(a->reason, sizeof a->reason,
                     "the estimate would take more than a tenth of the run's own operations");
        } else if (hn_run_step_towards(run, t) != HN_OK) {
            snprintf(a->reason, sizeof a->reason, HN_ACCURACY_METHOD " ended: %.150s",
                     hn_run_get_summary(run).reason);
        } else {
            hn_sample sample;
            const bool within = hn_run_time(run) <= a->t_end; // its last step may end beyond
            if (run == a->run[PILOT] && within &&
                hn_run_sample(run, hn_run_time(run), &sample) == HN_OK) {
                raise_scales(a, &sample);
            }
            continue;
        }
        a->t_out = fmin(a->t_out, hn_run_time(run));
        return false;
    }
    return true;
}

/// Returns the possible error of the pilot at the time reached: a share of its difference from the
/// rough run.
/// Returns false where that is too much for an estimate.
static bool measure_own(hn_accuracy *a, const hn_state_seen *pilot) {
    hn_sample rough;
    double error[HN_ERROR_COUNT];

    // how far the two runs are apart
    if (hn_run_sample(a->run[ROUGH], pilot->t, &rough) != HN_OK) {
        return false;
    }
    const hn_state_seen other = seen_of(&rough);
    hn_errors_calc(a->errors, &other, pilot, &unity, error);

    // too far: the estimate ends here
    if (!(error[HN_ERROR_Q] / HN_ACCURACY_OWN < HN_ACCURACY_LOST)) {
        a->t_out = fmin(a->t_out, pilot->t);
        a->lost = true;
        snprintf(a->reason, sizeof a->reason,
                 "neighbouring motions part too fast: from t = %.4g s on the tighter run beside it "
                 "(the pilot run) may be off by %.0g itself",
                 pilot->t, HN_ACCURACY_LOST);
        return false;
    }

    if (!a->own_at || error[HN_ERROR_Q] / HN_ACCURACY_OWN > a->own[HN_ERROR_Q]) {
        a->own_at = hn_errors_worst_coordinate(a->errors);
    }
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        a->own[i] = fmax(a->own[i], error[i] / HN_ACCURACY_OWN);
    }
    return true;
}

/// Returns whether the pilot cannot serve any more; one that is only late can catch up.
static bool has_ended(const hn_accuracy *a) {
    return a->lost || hn_run_get_state(a->run[PILOT]) == HN_RUN_FAILED ||
           hn_run_get_state(a->run[ROUGH]) == HN_RUN_FAILED;
}

double hn_accuracy_next(const hn_accuracy *a) {
    const bool none = !is_there(a) || has_ended(a) || a->looks > HN_ACCURACY_LOOKS;
    return none ? HUGE_VAL : a->looks * a->t_end / HN_ACCURACY_LOOKS;
}

bool hn_accuracy_is_due(const hn_accuracy *a, double t) {
    return t >= hn_accuracy_next(a) * (1 - 1e-9); // rounding of t
}

/// Brings both to t and takes the pilot's sample there. Returns false where that cannot be had.
static bool bring_to(hn_accuracy *a, double t, double ops) {
    return is_there(a) && !has_ended(a) && step_to(a, a->run[ROUGH], t, ops) &&
           step_to(a, a->run[PILOT], t, ops) &&
           hn_run_sample(a->run[PILOT], t, &a->sample) == HN_OK;
}

/// Takes the pilot's sample as the truth. Returns false where it may be off too much itself.
static bool take_truth(hn_accuracy *a) {
    raise_scales(a, &a->sample);
    const hn_state_seen at = seen_of(&a->sample);
    return measure_own(a, &at);
}

bool hn_accuracy_reach(hn_accuracy *a, double t, double ops) {
    if (!bring_to(a, t, ops)) {
        return false;
    }
    while (hn_accuracy_is_due(a, t)) {
        a->looks++;
    }
    return take_truth(a);
}

// ---- what is seen of the runs ----

void hn_accuracy_see(hn_accuracy *a, const hn_sample *s, hn_accuracy_track *track) {
    double error[HN_ERROR_COUNT];
    if (!s->q) {
        return;
    }
    const hn_state_seen at = seen_of(s), truth = seen_of(&a->sample);
    hn_errors_calc(a->errors, &at, &truth, &unity, error);
    if (!track->at || error[HN_ERROR_Q] > track->worst[HN_ERROR_Q]) {
        track->at = hn_errors_worst_coordinate(a->errors);
    }
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        track->worst[i] =
            fmax(track->worst[i], error[i]); // a state without multipliers is left out
    }
    track->t = s->t;
    track->n++;
}

void hn_accuracy_see_end(hn_accuracy *a, hn_run *run, double ops, hn_accuracy_track *track) {
    const double t = hn_run_time(run);
    hn_sample last;
    if (t <= a->t_end && bring_to(a, t, ops) && take_truth(a) &&
        hn_run_sample(run, t, &last) == HN_OK) {
        hn_accuracy_see(a, &last, track);
    }
}

/// The largest difference seen, no less than what the pilot may be off, over the scale.
static double relative(const hn_accuracy *a, const double *worst, hn_error_kind kind,
                       double scale) {
    const double error = fmax(worst[kind], a->own[kind]);
    return fmax(scale > 0 ? error / scale : 0, HN_ACCURACY_FLOOR);
}

hn_estimate hn_accuracy_estimate(const hn_accuracy *a, const hn_accuracy_track *track,
                                 double t_run) {
    hn_estimate e = {.known = track->n > 0, .t = track->t};
    if (!e.known) {
        memcpy(e.reason, a->reason, sizeof e.reason);
        return e;
    }
    e.q = relative(a, track->worst, HN_ERROR_Q, 1);
    e.at = a->own[HN_ERROR_Q] > track->worst[HN_ERROR_Q] ? a->own_at : track->at;
    e.off = e.at ? hn_errors_in_unit(a->errors, e.at, e.q) : 0;
    e.v = relative(a, track->worst, HN_ERROR_V, a->scales.rate);
    const double least = hn_errors_least_reaction(a->errors, a->scales.rate);
    e.unloaded = a->scales.reaction < least;
    e.reaction =
        relative(a, track->worst, HN_ERROR_REACTION, e.unloaded ? least : a->scales.reaction);
    e.reaction = hn_errors_has_reactions(a->errors) ? e.reaction : nan("");
    e.own = fmax(a->own[HN_ERROR_Q], HN_ACCURACY_FLOOR);
    if (a->t_out < t_run) {
        memcpy(e.reason, a->reason, sizeof e.reason);
    }
    return e;
}
