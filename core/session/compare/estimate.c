// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/estimate.h"

#include "study/incidents/kinds.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Error of the coordinates over the tolerance that was asked for.
static double over_tolerance(const hn_estimate *e, const hn_method_spec *spec) {
    const double rtol = hn_method_is_adaptive(spec) ? hn_method_option(spec, "rtol", 0) : 0;
    return e->known && rtol > 0 && e->q > e->own ? e->q / rtol : nan("");
}

void hn_estimate_put_json(hn_strbuf *b, const hn_accuracy *accuracy, const hn_method_spec *spec,
                          const hn_accuracy_track *track, double t_run) {
    hn_estimate e = hn_accuracy_estimate(accuracy, track, t_run);
    const double none = nan("");
    e.known = e.known && t_run > 0; // the start is nobody's motion
    hn_json_key(b, "error_estimate");
    hn_json_object(b);
    hn_json_put_number(b, "q", e.known ? e.q : none);
    hn_json_put_number(b, "v", e.known ? e.v : none);
    hn_json_put_number(b, "reaction", e.known ? e.reaction : none);
    hn_json_put_string(b, "coordinate", e.known && e.at ? e.at->name : "");
    hn_json_put_number(b, "off", e.known && e.at ? e.off : none);
    hn_json_put_string(b, "unit", e.known && e.at ? hn_coordinate_unit(e.at, "1") : "");
    hn_json_put_number(b, "own", e.known ? e.own : none);
    hn_json_put_number(b, "t", e.known ? e.t : none);
    hn_json_put_number(b, "over_rtol", over_tolerance(&e, spec));
    hn_json_put_string(b, "reason", t_run > 0 ? e.reason : "nothing was computed beyond the start");
    hn_json_end_object(b);
}

// An estimate that ends this share before the run says nothing of its end.
static const double WHOLE = 0.99;

/// The first incident up to t_run that calls the motion wrong and lets the run go on; NULL: none.
static const hn_incident *find_wrong(const hn_run *run, double t_run) {
    const hn_incident *list = NULL, *first = NULL;
    const int n = hn_run_incidents(run, &list);
    for (int i = 0; i < n; i++) {
        const hn_incident_kind *kind = hn_incident_kinds()[list[i].code];
        const bool goes_on = kind->is_wrong && kind->check;
        if (goes_on && list[i].t <= t_run && (!first || list[i].t < first->t)) {
            first = &list[i];
        }
    }
    return first;
}

/// `wrong`: what find_wrong() returns. If the estimate ends before it, the incident decides.
/// `lost`: the run ended as its motion was no longer the mechanism's.
static const char *verdict_of(const hn_estimate *e, double t_run, const hn_incident *wrong,
                              bool lost) {
    // a run that ended where it began shows no motion to be right
    if (!(t_run > 0) || (!e->known && !wrong && !lost)) {
        return "unknown";
    }
    if (lost || !e->known || e->q >= HN_ACCURACY_WRONG || (wrong && e->t < wrong->t)) {
        return "wrong";
    }
    return wrong || fmax(e->q, e->reaction) > HN_ACCURACY_WARN ? "inaccurate"
           : e->t < WHOLE * t_run                              ? "unknown"
                                                               : "right";
}

void hn_estimate_write_off(double off, const char *unit, char out[HN_SI_TEXT]) {
    if (strcmp(unit, "m") == 0) {
        hn_si_format(off, unit, 2, out);
    } else if (strcmp(unit, "rad") == 0) {
        snprintf(out, HN_SI_TEXT, "%.2g rad", off);
    } else {
        snprintf(out, HN_SI_TEXT, "%.2g", off);
    }
}

/// Writes ", reactions by ..."; nothing for a mechanism that has none.
static void write_reactions(const hn_estimate *e, char *out, size_t size) {
    if (isnan(e->reaction)) {
        snprintf(out, size, "%s", "");
    } else if (e->unloaded && e->reaction <= HN_ACCURACY_WARN) {
        snprintf(out, size,
                 ", reactions by next to nothing, as closing the loops takes next to no force");
    } else if (e->reaction <= 1) {
        snprintf(out, size, ", reactions by %.3g %% of their largest", 100 * e->reaction);
    } else {
        snprintf(out, size, ", reactions by more than their largest value");
    }
}

/// Writes how far the run is off, as far as it was compared. Returns the number of characters.
static int write_known(const hn_estimate *e, char *out, size_t size) {
    char off[HN_SI_TEXT], at[80] = "", reactions[96];
    hn_estimate_write_off(e->at ? e->off : e->q, e->at ? hn_coordinate_unit(e->at, "1") : "1", off);
    if (e->at) {
        snprintf(at, sizeof at, " (%.60s)", e->at->name);
    }
    write_reactions(e, reactions, sizeof reactions);
    return snprintf(out, size,
                    "up to t = %.4g s the coordinates are estimated to be off by up to %s%s%s",
                    e->t, off, at, reactions);
}

void hn_estimate_put_verdict(hn_strbuf *b, const hn_accuracy *accuracy,
                             const hn_accuracy_track *track, double t_run, const hn_run *run) {
    const hn_estimate e = hn_accuracy_estimate(accuracy, track, t_run);
    const hn_incident *wrong = find_wrong(run, t_run);
    const hn_run_summary s = hn_run_get_summary(run);
    const bool lost = s.status == HN_ERR_DIVERGED && s.t <= t_run;
    char text[560];
    int used = e.known ? write_known(&e, text, sizeof text) : 0;
    if (!(t_run > 0)) {
        snprintf(text, sizeof text, "nothing was computed beyond the start");
    } else if (!e.known || e.t < WHOLE * t_run) {
        used += snprintf(text + used, sizeof text - (size_t)used, "%s (%s)",
                         e.known ? "; the error after that was not estimated"
                                 : "the error is not known",
                         e.reason[0] ? e.reason : "nothing was compared");
    }
    const bool said = e.known && e.q >= HN_ACCURACY_WRONG;
    if (lost && !said && used < (int)sizeof text) {
        snprintf(text + used, sizeof text - (size_t)used, "; at t = %.4g s the run diverged", s.t);
    } else if (wrong && !said && used < (int)sizeof text) {
        snprintf(text + used, sizeof text - (size_t)used, "; at t = %.4g s %s", wrong->t,
                 hn_incident_kinds()[wrong->code]->name);
    }
    hn_json_key(b, "verdict");
    hn_json_object(b);
    hn_json_put_string(b, "is", verdict_of(&e, t_run, wrong, lost));
    hn_json_put_string(b, "text", text);
    hn_json_end_object(b);
}
