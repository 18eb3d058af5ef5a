// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/step_trial.h"

#include "tui/recording.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TRIALS = 4 };
static const double STEP_FACTOR = 0.5, TOLERANCE_FACTOR = 0.1;

struct hn_step_trial {
    char spelling[HN_SPEC_MAX];
    const char *key;      ///< "h" or "rtol"; static
    double own;           ///< the method's own step or tolerance
    double value[TRIALS]; ///< from the longest step to the shortest
    char methods[TRIALS][HN_SPEC_MAX];
    hn_model *model;         ///< owned: the recording that is shown has its own
    hn_recording *recording; ///< owned
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

hn_status hn_step_trial_start(const hn_library *library, const hn_model_source *source,
                              const char *spelling, hn_step_trial **out, hn_diags *diags) {
    hn_step_trial *s = calloc(1, sizeof *s);
    if (!s) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    snprintf(s->spelling, sizeof s->spelling, "%s", spelling);
    hn_status status = spell(s) ? HN_OK
                                : hn_diags_add(diags, HN_ERR_UNSUPPORTED, NULL, NULL,
                                               "the method has no step that could be shorter");
    if (status == HN_OK) {
        status = hn_model_load(library, source, &s->model, diags);
    }
    if (status == HN_OK) {
        const char *methods[TRIALS];
        for (int i = 0; i < TRIALS; i++) {
            methods[i] = s->methods[i];
        }
        status = hn_recording_create(s->model, methods, TRIALS, 0, &s->recording, diags);
    }
    if (status != HN_OK) {
        hn_step_trial_free(s);
        return status;
    }
    hn_recording_want(s->recording, hn_recording_last(s->recording));
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

/// Whether an error is known at the end of any of the motions.
static bool is_compared(const hn_step_trial *s) {
    const int last = hn_recording_last(s->recording);
    for (int i = 0; i < TRIALS; i++) {
        if (isfinite(hn_recording_track(s->recording, i)->error[last])) {
            return true;
        }
    }
    return false;
}

static void report_long(const hn_step_trial *s, int i, const char *verdict, hn_step_report *out) {
    const bool is_step = strcmp(s->key, "h") == 0;
    out->finding = HN_STEP_LONG;
    snprintf(out->cause, sizeof out->cause, "Cause: the %s %s = %g%s is too %s.",
             is_step ? "step" : "tolerance", s->key, s->own, is_step ? " s" : "",
             is_step ? "long" : "coarse");
    snprintf(out->remedy, sizeof out->remedy, "%s=%g", s->key, s->value[i]);
    snprintf(out->tried, sizeof out->tried, "tried until t = %.4g s: %s",
             hn_recording_duration(s->recording), verdict);
}

static void judge(hn_step_trial *s, hn_step_report *out) {
    const int last = hn_recording_last(s->recording), frames = hn_recording_frames(s->recording);
    *out = (hn_step_report){.finding = HN_STEP_RUNNING};
    if (frames <= last || hn_recording_is_asking(s->recording)) {
        snprintf(out->cause, sizeof out->cause,
                 "Whether %s is the cause is being tried, with %s = %g to %g: %d %% done", s->key,
                 s->key, s->value[0], s->value[TRIALS - 1], 100 * frames / (last + 1));
        return;
    }
    hn_recording_update(s->recording);
    if (!is_compared(s)) {
        out->finding = HN_STEP_UNKNOWN;
        return;
    }

    // the longest step that is right to the end
    hn_motion_verdict v;
    for (int i = 0; i < TRIALS; i++) {
        v = hn_recording_verdict(s->recording, i, last);
        if (v.tone != HN_TONE_BAD) {
            report_long(s, i, v.text, out);
            return;
        }
    }
    out->finding = HN_STEP_NO_HELP;
    snprintf(out->cause, sizeof out->cause,
             "%s alone is not the cause: %s = %g was tried until t = %.4g s, and is %s", s->key,
             s->key, s->value[TRIALS - 1], hn_recording_duration(s->recording), v.text);
}

// judged once: a card that is drawn asks many times
void hn_step_trial_judge(hn_step_trial *s, hn_step_report *out) {
    if (s->report.finding == HN_STEP_RUNNING) {
        judge(s, &s->report);
    }
    *out = s->report;
}
