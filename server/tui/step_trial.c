// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/step_trial.h"

#include "tui/recording.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TRIALS = 4, UNTIL = 96 };
static const double STEP_FACTOR = 0.5, TOLERANCE_FACTOR = 0.1;
/// An error that shrinks by less with a step half as long does not depend on the step: the weakest
/// methods, of order 1, halve it, and less where it is as large as the mechanism from the start.
static const double FALLS = 0.8;

struct hn_step_trial {
    char spelling[HN_SPEC_MAX];
    const char *key;      ///< "h" or "rtol"; static
    double own;           ///< the method's own step or tolerance
    double value[TRIALS]; ///< from the longest step to the shortest
    char methods[TRIALS][HN_SPEC_MAX];
    double wrong_at;         ///< when the method is known to be wrong [s]
    double limit;            ///< of computing, for all of them together [s]
    double used;             ///< by those before [s]
    int at;                  ///< the one that is tried now
    double error[TRIALS];    ///< geometric mean over the motion [m]; NaN: not known
    hn_model *model;         ///< owned: the recording that is shown has its own
    hn_recording *recording; ///< of the one that is tried; owned
    hn_step_report report;   ///< final where it is not HN_STEP_RUNNING, which is its first value
};

/// Writes the spellings that are tried; false: the method has no step and no tolerance.
static bool spell(hn_step_trial *s) {
    hn_method_spec spec;
    hn_diag diag = {0};
    if (hn_method_parse(s->spelling, &spec, &diag) != HN_OK) {
        return false;
    }
    const bool is_adaptive = hn_method_is_adaptive(&spec);
    s->key = is_adaptive ? "rtol" : "h";
    double *at = hn_method_find_option(&spec, s->key, NULL);
    s->own = at ? *at : 0;
    for (int i = 0; at && i < TRIALS; i++) {
        char text[32]; // as it is typed and shown: four digits
        snprintf(text, sizeof text, "%.4g", *at * (is_adaptive ? TOLERANCE_FACTOR : STEP_FACTOR));
        *at = s->value[i] = strtod(text, NULL);
        hn_method_format(&spec, s->methods[i]);
    }
    return at != NULL && s->value[TRIALS - 1] > 0;
}

/// Starts the recording of the one that is to be tried now.
static hn_status record(hn_step_trial *s, hn_diags *diags) {
    const char *method = s->methods[s->at];
    hn_recording_free(s->recording);
    s->recording = NULL;
    HN_TRY(hn_recording_create(s->model, &method, 1, s->limit - s->used, &s->recording, diags));
    hn_recording_want(s->recording, hn_recording_last(s->recording));
    return HN_OK;
}

hn_status hn_step_trial_start(const hn_library *library, const hn_model_source *source,
                              const hn_step_trial_request *request, hn_step_trial **out,
                              hn_diags *diags) {
    hn_step_trial *s = calloc(1, sizeof *s);
    if (!s) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    snprintf(s->spelling, sizeof s->spelling, "%s", request->spelling);
    s->wrong_at = request->wrong_at;
    s->limit = request->limit > 0 ? request->limit : HN_STEP_TRIAL_LIMIT;
    hn_status status = spell(s) ? HN_OK
                                : hn_diags_add(diags, HN_ERR_UNSUPPORTED, NULL, NULL,
                                               "the method has no step that could be shorter");
    HN_THEN(status, hn_model_load(library, source, &s->model, diags));
    HN_THEN(status, record(s, diags));
    if (status != HN_OK) {
        hn_step_trial_free(s);
        return status;
    }
    *out = s;
    return HN_OK;
}

void hn_step_trial_free(hn_step_trial *s) {
    if (s) {
        hn_recording_free(s->recording);
        hn_model_free(s->model);
        free(s);
    }
}

const char *hn_step_trial_spelling(const hn_step_trial *s) {
    return s->spelling;
}

// ---- judging ----

static const char *unit_of(const hn_step_trial *s) {
    return strcmp(s->key, "h") == 0 ? " s" : "";
}

/// "t = 10 s", or how far the computing time reached.
static void write_until(const hn_step_trial *s, char out[UNTIL]) {
    const int last = hn_recording_frames(s->recording) - 1;
    const double t = hn_recording_time(s->recording, last);
    if (hn_recording_is_out_of_time(s->recording)) {
        snprintf(out, UNTIL, "t = %.4g s of %.4g s, in %g s of computing", t,
                 hn_recording_duration(s->recording), s->limit);
    } else {
        snprintf(out, UNTIL, "t = %.4g s", t);
    }
}

/// The geometric mean of the error over the motion [m], where the reference has it; NaN: nowhere,
/// or the method ended.
static double mean_error(const hn_step_trial *s) {
    const double smallest = 1e-16; // [m] stands for none at all
    const double *error = hn_recording_track(s->recording, 0)->error;
    const int last = hn_recording_frames(s->recording) - 1;
    double sum = 0;
    int n = 0;
    for (int i = 1; i <= last; i++) {
        if (isfinite(error[i])) {
            sum += log(fmax(error[i], smallest));
            n++;
        }
    }
    return n > 0 && !hn_recording_end(s->recording, 0).failed ? exp(sum / n) : (double)NAN;
}

static void report_long(const hn_step_trial *s, const char *verdict, hn_step_report *out) {
    const bool is_step = strcmp(s->key, "h") == 0;
    char until[UNTIL];
    write_until(s, until);
    out->finding = HN_STEP_LONG;
    snprintf(out->cause, sizeof out->cause, "Cause: the %s %s = %g%s is too %s.",
             is_step ? "step" : "tolerance", s->key, s->own, unit_of(s),
             is_step ? "long" : "coarse");
    snprintf(out->remedy, sizeof out->remedy, "%s=%g", s->key, s->value[s->at]);
    snprintf(out->tried, sizeof out->tried, "tried until %s: %s", until, verdict);
}

/// None of those tried is right: whether the error falls with the step says if it is the cause.
static void report_no_help(const hn_step_trial *s, const char *verdict, hn_step_report *out) {
    const double now = s->error[s->at], before = s->at > 0 ? s->error[s->at - 1] : (double)NAN;
    const char *unit = unit_of(s);
    char until[UNTIL];
    write_until(s, until);
    out->finding = HN_STEP_NO_HELP;
    int n = snprintf(out->cause, sizeof out->cause, "%s = %g%s was tried until %s: %s.", s->key,
                     s->value[s->at], unit, until, verdict);
    if (n >= (int)sizeof out->cause || !isfinite(now / before)) {
        return;
    }
    if (now > FALLS * before) {
        snprintf(out->cause + n, sizeof out->cause - (size_t)n,
                 " From %s = %g%s on the error does not fall with %s: %s alone is not the cause.",
                 s->key, s->value[s->at - 1], unit, s->key, s->key);
    } else {
        snprintf(out->cause + n, sizeof out->cause - (size_t)n,
                 " The error falls with %s, which is still too %s. A method of higher order may "
                 "do; none was tried.",
                 s->key, unit[0] ? "long" : "coarse");
    }
}

/// The computing time was over before the motion goes wrong.
static void report_untried(const hn_step_trial *s, hn_step_report *out) {
    char until[UNTIL];
    write_until(s, until);
    out->finding = HN_STEP_NO_HELP;
    snprintf(out->cause, sizeof out->cause,
             "Whether %s is the cause is not known: %s = %g%s reached %s, and the motion is known "
             "to be wrong at %.4g s. Nothing smaller was tried.",
             s->key, s->key, s->value[s->at], unit_of(s), until, s->wrong_at);
}

/// Judges what is recorded of the one that is tried. Returns whether the next one is to be tried.
static bool judge(hn_step_trial *s, hn_step_report *out) {
    const hn_recording *r = s->recording;
    const bool out_of_time = hn_recording_is_out_of_time(r);
    const int last = hn_recording_last(r), frames = hn_recording_frames(r);
    *out = (hn_step_report){.finding = HN_STEP_RUNNING};
    if ((frames <= last && !out_of_time) || hn_recording_is_asking(r)) {
        snprintf(out->cause, sizeof out->cause,
                 "Whether %s is the cause is being tried, with %s = %g%s: %d %% done", s->key,
                 s->key, s->value[s->at], unit_of(s), 100 * frames / (last + 1));
        return false;
    }

    // without a reference nothing can be said
    hn_recording_update(s->recording);
    if (hn_recording_reference(r, 0) == NULL) {
        out->finding = HN_STEP_UNKNOWN;
        return false;
    }
    if (out_of_time && hn_recording_time(r, frames - 1) < s->wrong_at) {
        report_untried(s, out);
        return false;
    }
    s->error[s->at] = mean_error(s);
    const hn_motion_verdict v = hn_recording_verdict(r, 0, frames - 1);
    if (v.tone != HN_TONE_BAD) {
        report_long(s, v.text, out);
        return false;
    }
    s->used += hn_recording_computed(r);
    if (s->at + 1 == TRIALS || out_of_time || s->used >= s->limit) {
        report_no_help(s, v.text, out);
        return false;
    }
    return true;
}

// judged once: a card that is drawn asks many times
void hn_step_trial_judge(hn_step_trial *s, hn_step_report *out) {
    if (s->report.finding == HN_STEP_RUNNING && judge(s, &s->report)) {
        hn_diags diags = {0};
        s->at++;
        if (record(s, &diags) != HN_OK) {
            s->report.finding = HN_STEP_UNKNOWN;
        }
    }
    *out = s->report;
}
