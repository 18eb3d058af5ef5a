// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/methods.h"

#include "base/units.h"
#include "tui/seconds.h"
#include "tui/versions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct kept {
    char methods[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    int n;
} kept;

static void keep(kept *before, const hn_workbench *w) {
    memcpy(before->methods, w->methods, sizeof before->methods);
    before->n = w->n_methods;
}

/// Returns whether a method can come to the end of the motion in as many fixed steps as a run may
/// take; a spelling that is none is refused elsewhere.
static hn_status check_steps(const hn_workbench *w, int m, hn_diags *diags) {
    const double end = hn_model_scene(w->model)->duration;
    const double allowed = (double)hn_run_opts_default().max_steps;
    hn_method_spec spec;
    hn_diag diag = {0};
    if (hn_method_parse(w->methods[m], &spec, &diag) != HN_OK || hn_method_is_adaptive(&spec)) {
        return HN_OK;
    }
    const double h = hn_method_option(&spec, "h", 0);
    if (h > end) {
        return hn_diags_add(diags, HN_ERR_LIMIT, NULL, NULL,
                            "dt = %.3g s is longer than the motion of %.4g s; try 0.01 or 20 ms", h,
                            end);
    }
    if (!(h > 0) || end / h <= allowed) {
        return HN_OK;
    }
    return hn_diags_add(diags, HN_ERR_LIMIT, NULL, NULL,
                        "dt = %.3g s needs %.3g steps to t = %.4g s, and %.3g are allowed; the "
                        "shortest dt here is %.2g s",
                        h, end / h, end, allowed, end / allowed);
}

/// Returns whether the methods could be taken; else they are as before and the fault is said.
static bool record_again(hn_workbench *w, const kept *before) {
    hn_diags diags = {0};
    hn_status status = HN_OK;
    for (int m = 0; m < w->n_methods && status == HN_OK; m++) {
        status = check_steps(w, m, &diags);
    }
    if (status == HN_OK) {
        status = hn_workbench_record(w, &diags);
    }
    if (status == HN_OK) {
        w->panel = HN_PANEL_MAIN;
        hn_versions_keep(w);
        return true;
    }
    memcpy(w->methods, before->methods, sizeof before->methods);
    w->n_methods = before->n;
    hn_workbench_say_fault(w, &diags);
    return false;
}

/// Sets an option of a spelling that has it; returns whether it has.
static bool set_option(char spelling[HN_SPEC_MAX], const char *key, double value) {
    hn_method_spec spec;
    hn_diag diag = {0};
    double *at = hn_method_parse(spelling, &spec, &diag) == HN_OK
                     ? hn_method_find_option(&spec, key, NULL)
                     : NULL;
    if (at) {
        *at = value;
        hn_method_format(&spec, spelling);
    }
    return at != NULL;
}

static bool is_adaptive(const char *spelling) {
    hn_method_spec spec;
    hn_diag diag = {0};
    return hn_method_parse(spelling, &spec, &diag) == HN_OK && hn_method_is_adaptive(&spec);
}

double hn_methods_step(const hn_workbench *w) {
    double common = (double)NAN;
    for (int i = 0; i < w->n_methods; i++) {
        hn_method_spec spec;
        hn_diag diag = {0};
        if (hn_method_parse(w->methods[i], &spec, &diag) != HN_OK || hn_method_is_adaptive(&spec)) {
            continue;
        }
        const double h = hn_method_option(&spec, "h", (double)NAN);
        if (isfinite(common) && h != common) {
            return (double)NAN;
        }
        common = h;
    }
    return common;
}

bool hn_methods_set_step(hn_workbench *w, const char *text) {
    kept before;
    double h;
    if (!hn_seconds_read(text, &h)) {
        hn_workbench_say(w,
                         isnan(h)            ? "dt: '%.40s' is not a number of seconds. "
                                               "Try 0.01 or 20 ms"
                         : isinf(h) && h > 0 ? "dt must be a finite time; '%.40s' is beyond the "
                                               "largest number. Try 0.01 or 20 ms"
                                             : "dt must be above 0 s; '%.40s' is not. "
                                               "Try 0.01 or 20 ms",
                         text);
        return false;
    }
    keep(&before, w);
    int n = 0;
    for (int i = 0; i < w->n_methods; i++) {
        n += !is_adaptive(w->methods[i]) && set_option(w->methods[i], "h", h);
    }
    if (n == 0) {
        hn_workbench_say(w, "no method here has a fixed step: all choose it by a tolerance (m)");
        return true; // no other step would be taken
    }
    const bool taken = record_again(w, &before);
    if (taken) {
        hn_workbench_say(w, "dt = %g s for %s%s", h,
                         n == w->n_methods ? "every method" : "the methods of fixed step",
                         n == w->n_methods ? "" : "; the others choose it by a tolerance");
    } else if (strncmp(w->message, "h = ", 4) == 0) { // the name of what was typed
        char rest[HN_TUI_MESSAGE];
        snprintf(rest, sizeof rest, "%s", w->message + 1);
        hn_workbench_say(w, "dt%s", rest);
    }
    return taken;
}

// ---- numbers before and after a change ----

enum { UNTIL_TEXT = 48 };

/// A method that ended early has no frames from then on, and its steps say how bad it was.
static hn_tui_worst find_worst(const hn_workbench *w, int m, int frame) {
    const hn_track *t = hn_recording_track(w->recording, m);
    const hn_track_end end = hn_recording_end(w->recording, m);
    hn_tui_worst worst = {.stopped = (double)NAN};
    for (int k = 0; k <= frame; k++) {
        worst.gap = fmax(worst.gap, fabs(t->gap[k]));
        worst.energy = fmax(worst.energy, fabs(t->energy[k]));
    }
    if (end.failed && end.t <= hn_recording_time(w->recording, frame)) {
        worst.stopped = end.t;
        worst.gap = fmax(worst.gap, end.worst_gap);
        worst.energy = fmax(worst.energy, end.worst_energy);
    }
    return worst;
}

/// "until 10.00 s", "until it stopped at 2.26 s".
static void name_until(const hn_tui_worst *worst, double t, char *out, size_t size) {
    const bool stopped = isfinite(worst->stopped);
    snprintf(out, size, "until %s%.2f s", stopped ? "it stopped at " : "",
             stopped ? worst->stopped : t);
}

static void begin_change(const hn_workbench *w, int m, hn_tui_change *out) {
    const int frame = hn_workbench_frame(w);
    *out = (hn_tui_change){.method = m, .t = hn_recording_time(w->recording, frame)};
    out->open = out->t > 0; // at the start there is nothing to compare
    out->before = find_worst(w, m, frame);
}

/// Says what was changed and the numbers before; those after it follow (hn_methods_update).
static void say_change(hn_workbench *w, const hn_tui_change *change) {
    char gap[HN_SI_TEXT], energy[HN_SI_TEXT], until[UNTIL_TEXT];
    w->change = *change;
    if (!change->open) {
        hn_workbench_say(w, "%s", change->what);
        return;
    }
    hn_si_format(change->before.gap, "m", 2, gap);
    hn_si_format(change->before.energy, "J", 2, energy);
    name_until(&change->before, change->t, until, sizeof until);
    hn_workbench_say(w, "%s; before, %s: worst gap %s, energy change %s", change->what, until, gap,
                     energy);
    snprintf(w->change.said, sizeof w->change.said, "%s", w->message);
}

/// Says the numbers after a change, and those before it.
static void say_both(hn_workbench *w, const hn_tui_change *change, const hn_tui_worst *now) {
    char gap[2][HN_SI_TEXT], energy[2][HN_SI_TEXT], until[2][UNTIL_TEXT];
    const hn_tui_worst *const both[] = {&change->before, now};
    for (int i = 0; i < 2; i++) {
        hn_si_format(both[i]->gap, "m", 2, gap[i]);
        hn_si_format(both[i]->energy, "J", 2, energy[i]);
        name_until(both[i], change->t, until[i], sizeof until[i]);
    }
    if (strcmp(until[0], until[1]) == 0) {
        hn_workbench_say(w, "%s; %s: worst gap %s, before %s; energy change %s, before %s",
                         change->what, until[1], gap[1], gap[0], energy[1], energy[0]);
    } else {
        hn_workbench_say(
            w, "%s; %s: worst gap %s, energy change %s; before, %s: worst gap %s, energy change %s",
            change->what, until[1], gap[1], energy[1], until[0], gap[0], energy[0]);
    }
}

void hn_methods_update(hn_workbench *w) {
    hn_tui_change *change = &w->change;
    const int frame = (int)round(change->t / hn_recording_frame_dt(w->recording));
    const int last = hn_recording_last(w->recording);
    const int until = frame < last ? frame : last; // the last one may begin before the end
    if (!change->open || hn_recording_frames(w->recording) <= until) {
        return;
    }
    change->open = false;
    if (strcmp(w->message, change->said) != 0 || change->method >= w->n_methods) {
        return; // something else was said since
    }
    const hn_tui_worst now = find_worst(w, change->method, until);
    say_both(w, change, &now);
}

/// "method 2: baumgarte@rk4:h=0.02", and the warning of a value that is allowed all the same.
static void name_change(int at, const char *spelling, char *out, size_t size) {
    hn_method_spec spec;
    hn_diag diag = {0};
    const bool warned = hn_method_parse(spelling, &spec, &diag) == HN_OK && diag.message[0];
    snprintf(out, size, "method %d: %.80s%s%.140s", at + 1, spelling, warned ? "; " : "",
             warned ? diag.message : "");
}

bool hn_methods_put(hn_workbench *w, int at, const char *spelling) {
    kept before;
    hn_tui_change change = {0};
    keep(&before, w);
    if (at >= HN_COMPARISON_MAX_METHODS) {
        hn_workbench_say(w, "%d methods are compared at most; remove one first (m, then x)",
                         HN_COMPARISON_MAX_METHODS);
        return false;
    }
    if (at < w->n_methods) {
        begin_change(w, at, &change);
    }
    snprintf(w->methods[at], HN_SPEC_MAX, "%.250s", spelling);
    w->n_methods = at == w->n_methods ? at + 1 : w->n_methods;
    const bool taken = record_again(w, &before);
    if (taken) {
        name_change(at, spelling, change.what, sizeof change.what);
        say_change(w, &change);
    }
    return taken;
}

/// The one way to spell a method; false: it is no spelling of any.
static bool canonical(const char *spelling, char out[HN_SPEC_MAX]) {
    hn_method_spec spec;
    hn_diag diag = {0};
    if (hn_method_parse(spelling, &spec, &diag) != HN_OK) {
        return false;
    }
    hn_method_format(&spec, out);
    return true;
}

int hn_methods_find(const hn_workbench *w, const char *spelling) {
    char wanted[HN_SPEC_MAX], there[HN_SPEC_MAX];
    if (!canonical(spelling, wanted)) {
        return -1;
    }
    for (int m = 0; m < w->n_methods; m++) {
        if (canonical(w->methods[m], there) && strcmp(there, wanted) == 0) {
            return m;
        }
    }
    return -1;
}

void hn_methods_add(hn_workbench *w, const char *spelling) {
    int at = hn_methods_find(w, spelling);
    if (at < 0) {
        at = w->n_methods;
        hn_methods_put(w, at, spelling);
    }
    if (at < w->n_methods) {
        w->selected = at;
        w->hidden[at] = false;
    }
}

void hn_methods_add_beside(hn_workbench *w, const char *spelling) {
    const int from = w->selected, at = w->n_methods;
    hn_tui_change change;
    begin_change(w, from, &change);
    hn_methods_add(w, spelling);
    if (w->n_methods == at + 1) {
        name_change(at, spelling, change.what, sizeof change.what);
        const size_t n = strlen(change.what);
        snprintf(change.what + n, sizeof change.what - n, " (before: method %d)", from + 1);
        change.method = at;
        say_change(w, &change);
    }
}

void hn_methods_remove(hn_workbench *w, int at) {
    kept before;
    keep(&before, w);
    if (at >= w->n_methods || w->n_methods < 2) {
        hn_workbench_say(w, at < w->n_methods ? "one method stays"
                                              : "x removes a method of the list; none is chosen");
        return;
    }
    memmove(w->methods[at], w->methods[at + 1],
            (size_t)(w->n_methods - at - 1) * sizeof *w->methods);
    w->n_methods--;
    record_again(w, &before);
}

void hn_methods_set_one(hn_workbench *w, const char *key, double value) {
    kept before;
    hn_tui_change change;
    keep(&before, w);
    begin_change(w, w->selected, &change);
    if (!set_option(w->methods[w->selected], key, value)) {
        hn_workbench_say(w, "%s has no option %s",
                         hn_recording_track(w->recording, w->selected)->name, key);
    } else if (record_again(w, &before)) {
        snprintf(change.what, sizeof change.what, "%s = %.4g", key, value);
        say_change(w, &change);
    }
}

void hn_methods_set_baumgarte(hn_workbench *w, const char *spelling, double alpha, double beta) {
    kept before;
    hn_tui_change change = {0};
    int at = 0;
    keep(&before, w);
    while (at < w->n_methods && strcmp(w->methods[at], spelling) != 0) {
        at++;
    }
    if (at == HN_COMPARISON_MAX_METHODS) {
        hn_workbench_say(w, "%d methods are compared at most; remove one first (m, then x)", at);
        return;
    }

    // what it was before, so that the change can be seen
    if (at < w->n_methods) {
        begin_change(w, at, &change);
    } else {
        snprintf(w->methods[w->n_methods++], HN_SPEC_MAX, "%.250s", spelling);
    }
    set_option(w->methods[at], "alpha", alpha);
    set_option(w->methods[at], "beta", beta);
    if (record_again(w, &before)) {
        w->selected = at;
        snprintf(change.what, sizeof change.what, "alpha = %.4g, beta = %.4g", alpha, beta);
        say_change(w, &change);
    }
}
