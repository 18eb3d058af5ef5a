// Measures with a loop of their own: the largest step that does not grow, and how fast neighbours part.
#include "session/extreme_internal.h"

#include "dynamics/project.h"
#include "linalg/dense.h"
#include "study/spectrum.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define GROWN \
    1.01 // between the second and the last quarter of the steps: grows. A neutral motion stays below
#define DECAYED \
    1e-6 // of the first quarter's rates: what is left is rounding, and may go up and down
#define BRACKET 1.6       // times the predicted limit, both ways, is searched
#define SMALL_STEP 1e-9   // [s], for a method that is only looked at
#define SAME_LIMIT 2.5e-4 // relative width at which the search ends

static int fail(hn_extreme_seen *out, hn_status status, const char *reason) {
    out->value = (double)NAN;
    snprintf(out->reason, sizeof out->reason, "%s%s%.150s", hn_extreme_outcome(status),
             reason[0] ? ": " : "", reason);
    return 0;
}

/// A trial that is the same but for its swept name: the step, searched for.
static hn_extreme_trial with_step(const hn_extreme_trial *trial) {
    hn_extreme_trial t = *trial;
    t.sweep = "h";
    return t;
}

// the largest stable step ------------------------------------------------------------------------------------------

/// Largest rates over each quarter of the steps; 0 when the run ended early or was stopped.
static int walk_quarters(hn_extreme_bench *bench, hn_run *run, int n, long long steps,
                         double most[4]) {
    for (long long k = 1; k <= steps; k++) {
        hn_sample s;
        if (hn_run_step(run) != HN_OK || (k % 256 == 0 && hn_extreme_is_stopped(bench))) {
            return 0;
        }
        const int quarter = (int)(4 * (k - 1) / steps);
        if (hn_run_sample(run, hn_run_time(run), &s) != HN_OK) {
            return 0;
        }
        most[quarter] = fmax(most[quarter], hn_norm_max(n, s.v));
    }
    return 1;
}

/// 1: does not grow at h, 0: it does, -1: cannot be told (reason in out).
static int is_stable(hn_extreme_bench *bench, hn_extreme_point *point, double h,
                     hn_extreme_seen *out) {
    hn_extreme_look look;
    double most[4] = {0, 0, 0, 0};
    point->value = h;
    hn_extreme_look_begin(bench, point, 0, &look); // to its time 0: stands at its start
    if (!look.run) {
        fail(out, look.status, look.reason);
        hn_extreme_look_end(&look);
        return -1;
    }
    const int n = hn_system_get_info(hn_model_system(look.model)).n_user;
    const int whole = walk_quarters(bench, look.run, n, (long long)point->trial->steps, most);
    // an adaptive step that was to be held, and was shortened, had grown beyond all that was allowed
    const double steps = floor(point->trial->steps);
    const int held = hn_run_time(look.run) > steps * h * (1 - 1e-6);
    hn_extreme_look_end(&look);
    if (hn_extreme_is_stopped(bench)) {
        fail(out, HN_ERR_BUDGET, "stopped");
        return -1;
    }
    return whole && held && (most[3] <= GROWN * most[1] || most[3] <= DECAYED * most[0]);
}

/// Narrows [low, high], stable and not, to the limit.
static int search(hn_extreme_bench *bench, hn_extreme_point *point, double low, double high,
                  hn_extreme_seen *out) {
    const int at_low = is_stable(bench, point, low, out);
    const int at_high = at_low == 1 ? is_stable(bench, point, high, out) : 0;
    if (at_low < 0 || at_high < 0) {
        return 0;
    }
    if (at_low == 0 || at_high == 1) {
        snprintf(out->reason, sizeof out->reason, "%s at h = %g s already",
                 at_low == 0 ? "grows" : "does not grow", at_low == 0 ? low : high);
        return 0;
    }
    while (high > low * (1 + SAME_LIMIT)) {
        const double middle = sqrt(low * high);
        const int stable = is_stable(bench, point, middle, out);
        if (stable < 0) {
            return 0;
        }
        *(stable ? &low : &high) = middle;
    }
    out->value = sqrt(low * high);
    return 1;
}

/// What the spectrum on the loops says at the start of a trial's run [s]; NaN with a reason in out.
static double predict(hn_extreme_bench *bench, const hn_extreme_point *point,
                      hn_extreme_seen *out) {
    hn_extreme_look look;
    hn_spectrum *spectrum = NULL;
    const hn_eigenvalue *s = NULL;
    int n = 0;
    double limit = (double)NAN;
    hn_extreme_look_begin(bench, point, 0, &look);
    hn_status status = look.status;
    if (status == HN_OK) {
        status = hn_spectrum_create(hn_model_system(look.model), look.arena, &spectrum);
    }
    if (status == HN_OK) {
        status = hn_spectrum_calc(spectrum, 0, look.q, look.v, &s, &n);
    }
    if (status == HN_OK) {
        const hn_stepper *stepper = hn_run_spec(look.run)->stepper;
        const char *why_not = hn_stability_why_not(stepper);
        limit = hn_stability_limit(stepper, s, n);
        snprintf(out->reason, sizeof out->reason, "%.199s", why_not ? why_not : "");
    } else {
        fail(out, status, look.reason);
    }
    hn_spectrum_free(spectrum);
    hn_extreme_look_end(&look);
    if (!isnan(limit) && !(limit > 0 && limit < HUGE_VAL)) {
        snprintf(out->reason, sizeof out->reason, "the spectrum gives the limit %g s", limit);
        return (double)NAN;
    }
    return limit;
}

void hn_extreme_see_stable_step(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                                const hn_extreme_scene *scene, const char *method,
                                hn_extreme_seen *out) {
    hn_extreme_trial t = with_step(trial);
    hn_extreme_point point = {&t, scene, method, 0};
    double low = t.limit[0], high = t.limit[1];
    double unit = t.scale;
    out->value = (double)NAN;
    if (t.expect.from_spectrum) {
        point.value = SMALL_STEP;
        unit = predict(bench, &point, out);
        low = unit / BRACKET;
        high = unit * BRACKET;
        if (isnan(unit)) {
            return;
        }
    }
    if (search(bench, &point, low, high, out)) {
        out->value /= unit;
    }
}

// chaos --------------------------------------------------------------------------------------------------------------

#define TWIN_APART 1e-7  // how far the twin begins, of the coordinates' unit
#define TWIN_TIME 0.5    // between renormalisations [s]
#define TWIN_LEFT_OUT 10 // of them, until the twin lies in the direction that grows

typedef struct twins {
    const hn_system *sys;
    const hn_method_spec *spec;
    hn_projector *projector;
    hn_system_info info;
    double *q, *v, *twin_q, *twin_v, *delta;
} twins;

static double apart(twins *w) {
    hn_system_difference(w->sys, w->q, w->twin_q, w->delta);
    double sum = hn_dot(w->info.nv, w->delta, w->delta);
    for (int i = 0; i < w->info.nv; i++) {
        sum += (w->twin_v[i] - w->v[i]) * (w->twin_v[i] - w->v[i]);
    }
    return sqrt(sum);
}

/// The twin at TWIN_APART of the way it has gone, on the loops.
static hn_status renormalise(twins *w, double distance) {
    const double share = TWIN_APART / distance;
    hn_system_difference(w->sys, w->q, w->twin_q, w->delta);
    memcpy(w->twin_q, w->q, (size_t)w->info.nq * sizeof(double));
    for (int i = 0; i < w->info.nv; i++) {
        w->delta[i] *= share;
        w->twin_v[i] = w->v[i] + share * (w->twin_v[i] - w->v[i]);
    }
    hn_system_move(w->sys, w->twin_q, w->delta);
    const hn_status status = hn_project_position(w->projector, 0, w->twin_q, 1e-15, NULL);
    return status == HN_OK ? hn_project_velocity(w->projector, 0, w->twin_q, w->twin_v, NULL)
                           : status;
}

static hn_status advance(const twins *w, double *q, double *v) {
    hn_run *run = NULL;
    hn_diag diag;
    hn_sample s;
    hn_status status = hn_run_create(w->sys, w->spec, q, v, NULL, &run, &diag);
    if (status == HN_OK) {
        hn_run_watch(run, 0);
        status = hn_run_advance(run, TWIN_TIME);
    }
    if (status == HN_OK) {
        status = hn_run_sample(run, TWIN_TIME, &s);
    }
    if (status == HN_OK) {
        hn_system_from_user(w->sys, s.q, q);
        hn_system_rates_from_user(w->sys, s.v, v);
    }
    hn_run_free(run);
    return status;
}

static hn_status make_twins(twins *w, const hn_extreme_look *look, const hn_method_spec *spec) {
    w->sys = hn_model_system(look->model);
    w->spec = spec;
    w->info = hn_system_get_info(w->sys);
    const size_t nq = (size_t)w->info.nq, nv = (size_t)w->info.nv;
    w->q = hn_arena_doubles(look->arena, nq);
    w->v = hn_arena_doubles(look->arena, nv);
    w->twin_q = hn_arena_doubles(look->arena, nq);
    w->twin_v = hn_arena_doubles(look->arena, nv);
    w->delta = hn_arena_doubles(look->arena, nv);
    if (hn_arena_failed(look->arena)) {
        return HN_ERR_MEMORY;
    }
    memcpy(w->q, look->q, nq * sizeof(double));
    memcpy(w->v, look->v, nv * sizeof(double));
    memcpy(w->twin_q, look->q, nq * sizeof(double));
    memcpy(w->twin_v, look->v, nv * sizeof(double));
    for (int i = 0; i < w->info.nv; i++) {
        w->twin_v[i] += TWIN_APART * (i + 1); // in no direction of symmetry
    }
    const hn_status status =
        hn_projector_create(w->sys, HN_WEIGHT_MASS, look->arena, &w->projector);
    return status == HN_OK ? renormalise(w, TWIN_APART) : status;
}

/// Mean rate at which the twin parts, over the trial's time.
static double part_rate(hn_extreme_bench *bench, twins *w, double T, hn_status *status) {
    const int n = (int)fmin(floor(T / TWIN_TIME), 1e5);
    double sum = 0;
    for (int k = 0; k < n && *status == HN_OK; k++) {
        *status = advance(w, w->q, w->v);
        if (*status == HN_OK) {
            *status = advance(w, w->twin_q, w->twin_v);
        }
        if (*status == HN_OK) {
            const double distance = apart(w);
            sum += k < TWIN_LEFT_OUT ? 0 : log(distance / TWIN_APART);
            *status = renormalise(w, distance);
        }
        if (hn_extreme_is_stopped(bench)) {
            *status = HN_ERR_BUDGET;
        }
    }
    return sum / (TWIN_TIME * (n - TWIN_LEFT_OUT));
}

void hn_extreme_see_lyapunov(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                             const hn_extreme_scene *scene, const char *method,
                             hn_extreme_seen *out) {
    hn_extreme_trial still = *trial;
    still.time = (hn_extreme_number){0}; // the look stands at its start
    const hn_extreme_point point = {&still, scene, method, 0};
    hn_extreme_look look;
    twins w = {0};
    out->value = (double)NAN;
    hn_extreme_look_begin(bench, &point, 0, &look);
    hn_status status = look.status;
    if (status == HN_OK && !(trial->time.value > 2 * TWIN_LEFT_OUT * TWIN_TIME)) {
        fail(out, HN_ERR_INPUT, "the time is too short for an estimate");
    } else if (status == HN_OK) {
        const hn_method_spec spec = *hn_run_spec(look.run);
        status = make_twins(&w, &look, &spec);
        const double rate = status == HN_OK ? part_rate(bench, &w, trial->time.value, &status) : 0;
        if (status == HN_OK) {
            out->value = rate / trial->scale;
        }
    }
    if (status != HN_OK) {
        fail(out, status, look.reason);
    }
    hn_projector_free(w.projector);
    hn_extreme_look_end(&look);
}
