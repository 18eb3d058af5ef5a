// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/motion_curve.h"

#include "base/suggest.h"
#include "integrators/method/method_spec.h"
#include "study/run/run.h"

#include <math.h>
#include <string.h>

enum { MAX_STEPS = 200000, N_CURVES = 3 };

// ---- the curve ----

static double gap_of(const hn_sample *s) {
    return s->gap;
}

static double velocity_gap_of(const hn_sample *s) {
    return s->velocity_gap;
}

static double energy_of(const hn_sample *s) {
    return s->energy;
}

static const struct {
    const char *name, *unit;
    double (*value)(const hn_sample *s);
} CURVES[N_CURVES] = {
    {"gap", "m", gap_of}, {"velocity gap", "m/s", velocity_gap_of}, {"energy", "J", energy_of}};

/// Curve that a part names: a row of CURVES, or a coordinate, or the rate of one.
typedef struct chosen {
    int row, coordinate; ///< -1: not this
    bool rate;
} chosen;

static hn_status choose(const hn_part *p, const hn_model *model, chosen *out, const char **unit,
                        hn_diag *diag) {
    const char *name = hn_part_text(p->node, "curve");
    *out = (chosen){.row = -1, .coordinate = -1};
    for (int i = 0; i < N_CURVES; i++) {
        if (strcmp(CURVES[i].name, name) == 0) {
            out->row = i;
            *unit = CURVES[i].unit;
            return HN_OK;
        }
    }

    // a coordinate by its name, or by that of its rate
    const int n = hn_system_get_info(hn_model_system(model)).n_user;
    for (int i = 0; i < n; i++) {
        const hn_coordinate *c = hn_part_coordinate(model, i);
        const bool rate = strcmp(c->rate, name) == 0;
        if (rate || strcmp(c->name, name) == 0) {
            *out = (chosen){.row = -1, .coordinate = i, .rate = rate};
            *unit = c->kind == HN_LENGTH ? (rate ? "m/s" : "m") : rate ? "rad/s" : "rad";
            return HN_OK;
        }
    }
    return hn_diag_set(diag, HN_ERR_INPUT, "/parts/curve",
                       "gap, velocity gap, energy, a coordinate or a rate",
                       "part %s: there is no curve '%.40s'", p->id, name);
}

static hn_status sample(hn_motion_curve *c, const hn_part *p, hn_run *run, const chosen *what) {
    hn_sample s;
    c->n = HN_CURVE_POINTS;
    c->dt = c->t_end / (HN_CURVE_POINTS - 1);
    c->low = HUGE_VAL;
    c->high = -HUGE_VAL;
    for (int k = 0; k < c->n; k++) {
        const double t = k + 1 < c->n ? k * c->dt : c->t_end;
        HN_TRY(hn_part_advance(p, run, t));
        HN_TRY(hn_run_sample(run, t, &s));
        c->y[k] = what->row >= 0 ? CURVES[what->row].value(&s)
                                 : (what->rate ? s.v : s.q)[what->coordinate];
        c->low = fmin(c->low, c->y[k]);
        c->high = fmax(c->high, c->y[k]);
    }
    return HN_OK;
}

static hn_status run_curve(hn_motion_curve *c, const hn_part *p, const hn_model *model,
                           const char *method, hn_diag *diag) {
    hn_method_spec spec;
    chosen what;
    hn_run *run = NULL;
    hn_run_opts opts = hn_run_opts_default();
    c->t_end = opts.t_end = hn_part_number(p->node, "time", 1);
    opts.max_steps = MAX_STEPS;
    HN_TRY(choose(p, model, &what, &c->unit, diag));
    HN_TRY(hn_method_parse(method, &spec, diag));
    hn_status status = hn_run_create(hn_model_system(model), &spec, hn_model_q(model),
                                     hn_model_v(model), &opts, &run, diag);
    HN_THEN(status, sample(c, p, run, &what));

    // a run that ends early leaves nothing to read
    if (status != HN_OK && status != HN_ERR_MEMORY && run) {
        status = hn_diag_set(diag, HN_ERR_INPUT, "/parts/method", NULL,
                             "part %s: the run of %.60s ends early: %.200s", p->id, method,
                             hn_run_get_summary(run).reason);
    }
    hn_run_free(run);
    return status == HN_OK || status == HN_ERR_MEMORY ? status : HN_ERR_INPUT;
}

hn_status hn_motion_curve_make(hn_motion_curve *c, const hn_part *p, const char *method,
                               hn_diag *diag) {
    hn_model *model = NULL;
    HN_TRY(hn_part_load_model(p, &model, diag));
    const hn_status status = run_curve(c, p, model, method, diag);
    hn_model_free(model);
    return status;
}

// ---- readings ----

static int index_of(const hn_motion_curve *c, double value) {
    for (int k = 0; k < c->n; k++) {
        if (c->y[k] == value) {
            return k;
        }
    }
    return 0;
}

static double read_largest(const hn_motion_curve *c, double number) {
    (void)number;
    return c->high;
}

static double read_smallest(const hn_motion_curve *c, double number) {
    (void)number;
    return c->low;
}

static double read_time_of_largest(const hn_motion_curve *c, double number) {
    (void)number;
    return index_of(c, c->high) * c->dt;
}

static double read_time_of_smallest(const hn_motion_curve *c, double number) {
    (void)number;
    return index_of(c, c->low) * c->dt;
}

static double read_at(const hn_motion_curve *c, double t) {
    const double place = t / c->dt;
    const int k = (int)fmin(fmax(floor(place), 0), c->n - 2);
    return t >= 0 && t <= c->t_end ? c->y[k] + (place - k) * (c->y[k + 1] - c->y[k]) : (double)NAN;
}

static double read_start(const hn_motion_curve *c, double number) {
    (void)number;
    return c->y[0];
}

static double read_end(const hn_motion_curve *c, double number) {
    (void)number;
    return c->y[c->n - 1];
}

/// Time at which the curve passes a level for the first time from sample `from` on, in the sense
/// asked for: 1 upwards, -1 downwards, 0 either. NaN: never; *at is then c->n.
static double find_crossing(const hn_motion_curve *c, double level, int from, int sense, int *at) {
    for (int k = from; k + 1 < c->n; k++) {
        const double a = c->y[k] - level, b = c->y[k + 1] - level;
        const bool crosses = (sense >= 0 && a < 0 && b >= 0) || (sense <= 0 && a > 0 && b <= 0);
        if (crosses) {
            *at = k + 1;
            return (k + a / (a - b)) * c->dt;
        }
    }
    *at = c->n;
    return (double)NAN;
}

static double read_first_crossing(const hn_motion_curve *c, double level) {
    int at;
    return find_crossing(c, level, 0, 0, &at);
}

/// The mean time between upward passages of the middle.
static double read_period(const hn_motion_curve *c, double number) {
    const double middle = (c->low + c->high) / 2;
    int at = 0, n = 0;
    double first = (double)NAN, last = (double)NAN;
    (void)number;
    for (double t = find_crossing(c, middle, 0, 1, &at); isfinite(t);
         t = find_crossing(c, middle, at, 1, &at)) {
        first = n++ ? first : t;
        last = t;
    }
    return n > 1 ? (last - first) / (n - 1) : (double)NAN;
}

static const hn_curve_reading READINGS[] = {
    {"largest", "the largest value", false, false, read_largest},
    {"smallest", "the smallest value", false, false, read_smallest},
    {"time-of-largest", "the time of the largest value", true, false, read_time_of_largest},
    {"time-of-smallest", "the time of the smallest value", true, false, read_time_of_smallest},
    {"at", "the value at the given time", false, true, read_at},
    {"start", "the value at the start", false, false, read_start},
    {"end", "the value at the end", false, false, read_end},
    {"first-crossing", "the time at which the level is passed first", true, true,
     read_first_crossing},
    {"period", "the period", true, false, read_period},
};
enum { N_READINGS = sizeof READINGS / sizeof *READINGS };

const hn_curve_reading *hn_curve_reading_at(int i) {
    return i >= 0 && i < N_READINGS ? &READINGS[i] : NULL;
}

const hn_curve_reading *hn_curve_reading_find(const char *name, hn_diag *diag) {
    const char *names[N_READINGS];
    for (int i = 0; i < N_READINGS; i++) {
        names[i] = READINGS[i].name;
        if (strcmp(names[i], name) == 0) {
            return &READINGS[i];
        }
    }
    char hint[HN_DIAG_HINT];
    hn_suggest_or_list(hint, name, names, N_READINGS, "readings: ");
    hn_diag_set(diag, HN_ERR_INPUT, "/parts/read", hint, "there is no reading '%.40s'", name);
    return NULL;
}
