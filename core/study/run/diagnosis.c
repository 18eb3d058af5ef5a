// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/diagnosis.h"

#include "integrators/method/guest.h"
#include "study/incidents/energy.h"
#include "study/run/instability.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A pilot run may take this many steps: 2000 of a four-bar cost about 10 ms. A remedy that fails
/// from a state on the way gets twice as many for a second trial, from the start of the run.
/// A remedy makes about FINER steps for one of the run.
/// Its samples are about as dense as those of a run's output.
enum { PILOT_STEPS = 2000, START_STEPS = 4000, PILOT_SIZE = 20, PILOT_LOOKS = 100, FINER = 4 };

/// First words of the results of remedies.
#define TRIED "tried "
#define IN_VAIN "; tried in vain"

/// A pilot run goes past the event by this share of the time to it: a remedy that only postpones
/// the event is found out.
static const double BEYOND = 0.5;
/// The least share that tells.
static const double LEAST_PAST = 0.05;
enum { BEYOND_STEPS = 10 }; // of the run, that it goes past the event in any case

// ---- the cause ----

static void name_cause(hn_run *run) {
    hn_watch *w = hn_run_watching(run);
    char cause[360], message[400];
    double limit;
    const bool ended = w->failure == HN_ERR_DIVERGED || w->failure == HN_ERR_NO_CONVERGENCE ||
                       w->failure == HN_ERR_INCONSISTENT || w->failure == HN_ERR_SINGULAR;
    if (!ended || w->log.n == 0 || !hn_instability_explain(w->run, &limit, cause, sizeof cause)) {
        return;
    }
    hn_incident *last = &w->log.list[w->log.n - 1];
    memcpy(message, last->message, sizeof message);
    last->message[0] = '\0';
    last->quantity = "h";
    last->value = hn_method_option(&w->run->spec, "h", 0);
    last->limit = limit;
    hn_incident_append(&w->log, last, "%s; %s", cause, message);
    hn_run_set_reason(run, last->message);
}

/// Says of a run that could not go on in its configuration that its motion had been wrong before:
/// the true motion may never come there.
static void tell_wrong_before(hn_run *run) {
    hn_watch *w = hn_run_watching(run);
    const bool stuck = w->failure == HN_ERR_CHART || w->failure == HN_ERR_UNSUPPORTED ||
                       w->failure == HN_ERR_NO_CONVERGENCE || w->failure == HN_ERR_SINGULAR ||
                       w->failure == HN_ERR_INCONSISTENT;
    if (!stuck || w->log.n == 0) {
        return;
    }
    hn_incident *last = &w->log.list[w->log.n - 1];
    if (strstr(last->message, HN_ENERGY_ANOTHER)) {
        return; // said already
    }
    for (int k = 0; k < w->log.n - 1; k++) {
        const hn_incident *i = &w->log.list[k];
        if (hn_incident_kinds()[i->code]->is_wrong && i->t < last->t - w->run->h) {
            hn_incident_append(&w->log, last, "; the motion was wrong from t = %.3g s on (%s)",
                               i->t, hn_incident_kinds()[i->code]->name);
            hn_run_set_reason(run, last->message);
            return;
        }
    }
}

// ---- remedies ----

/// The method that a remedy means: a spelling, or the present one with another step or tolerance.
static bool read_remedy(const hn_stepping *s, const char *text, hn_method_spec *spec) {
    hn_diag diag = {0};
    if (strchr(text, '@')) {
        return hn_method_parse(text, spec, &diag) == HN_OK;
    }
    char key[16];
    double value = 0;
    *spec = s->spec;
    if (sscanf(text, "%15[a-z]=%lf", key, &value) != 2) {
        return false;
    }
    double *option = hn_method_find_option(spec, key, NULL);
    if (!option) {
        return false;
    }
    *option = value;
    return true;
}

/// Says whether a pilot run came to its end without an incident that makes a result wrong.
static bool is_right(const hn_run *pilot, hn_status status) {
    const hn_incident *list = NULL;
    const int n = hn_run_incidents(pilot, &list);
    for (int i = 0; i < n && status == HN_OK; i++) {
        if (hn_incident_kinds()[list[i].code]->is_wrong) {
            return false;
        }
    }
    return status == HN_OK;
}

typedef enum outcome { REMOVES, FAILS, UNKNOWN } outcome;

/// The trial of a remedy.
typedef struct trial {
    outcome is;
    bool whole; ///< tried from the start of the run
    hn_remedy said;
} trial;

/// Returns where the pilot runs of report k begin. A state shortly before the event may hold its
/// error already, so the start of the run is taken where it is not many steps away, and in any case
/// where the equations of the run are wrong: a state on its way belongs to another motion.
static const hn_state_at *pilot_start(const hn_watch *w, int k) {
    const bool near = w->before_at[k] <= PILOT_STEPS / FINER;
    const bool wrong = w->run->spec.formulation->traits & HN_TRAIT_COUNTER_EXAMPLE;
    return near || wrong || !(w->before[k].t < w->log.list[k].t) ? &w->run->start : &w->before[k];
}

/// Returns how long a pilot run is: past the event, as far as *most steps reach where they are
/// fixed. Large mechanisms get fewer steps. Not beyond the end of the run, unless the event is so
/// near it that what comes after tells whether the remedy removes it.
static double pilot_end(const hn_watch *w, const hn_method_spec *spec, double from, double event,
                        long long *most) {
    const hn_stepping *s = w->run;
    const int size = s->info.nv > PILOT_SIZE ? s->info.nv : PILOT_SIZE;
    const double own = fmax(s->h, hn_method_option(&s->spec, "h", 0));
    const double whole = event + BEYOND * (event - from) + BEYOND_STEPS * own;
    const double least = event + 2 * LEAST_PAST * (event - from) + own;
    const double wanted = w->t_end > 0 ? fmin(whole, fmax(w->t_end, least)) : whole;
    const double h = hn_method_is_adaptive(spec) ? 0 : hn_method_option(spec, "h", 0);
    *most = *most * PILOT_SIZE / size;
    const double reached = from + h * (double)(*most - 1);
    return reached > event + h && reached < wanted ? reached : wanted;
}

/// Runs a pilot to `end`. If it chooses its steps, samples are taken on the way, as the output
/// of a run has them: what lies inside long steps counts in its largest gap and energy too.
static hn_status run_pilot(hn_run *pilot, double from, double end) {
    const int looks = hn_method_is_adaptive(hn_run_spec(pilot)) ? PILOT_LOOKS : 0;
    for (int k = 1; k <= looks; k++) {
        const double t = from + (end - from) * k / (looks + 1);
        hn_sample sample;
        HN_TRY(hn_run_advance(pilot, t));
        HN_TRY(hn_run_sample(pilot, t, &sample));
    }
    return hn_run_advance(pilot, end);
}

/// Result of a pilot run.
typedef struct shown {
    hn_status status;   ///< HN_ERR_STOPPED: its steps did not suffice
    hn_run_summary sum; ///< of the pilot run
    double last_gap;    ///< at its end [m]
    bool past;          ///< it ran far enough past the event
    bool right;         ///< it is past the event and does not show the fault
} shown;

/// Runs the pilot to `end` and judges it by its result.
static shown run_and_judge(hn_run *pilot, double t0, double event, double end) {
    shown out = {.status = run_pilot(pilot, t0, end), .sum = hn_run_get_summary(pilot)};
    hn_sample last;
    out.last_gap = hn_run_sample(pilot, out.sum.t, &last) == HN_OK ? last.gap : out.sum.worst_gap;
    out.past = out.sum.t > event + LEAST_PAST * (event - t0);

    // an error that grows, slowly as yet, is a fault too
    double limit;
    char cause[sizeof(hn_remedy)];
    out.right = out.past && is_right(pilot, out.status == HN_ERR_STOPPED ? HN_OK : out.status) &&
                !hn_instability_explain(hn_run_watching(pilot)->run, &limit, cause, sizeof cause);
    return out;
}

/// Says how far the trial came and what it showed there.
static void say_result(const hn_watch *w, const shown *r, const hn_state_at *from, double end,
                       hn_remedy said) {
    // an adaptive method steps past the end that was asked for; past that of the run is said
    const double reached = r->status == HN_OK ? fmin(r->sum.t, end) : r->sum.t;
    const bool beyond = w->t_end > 0 && reached > w->t_end + w->run->h;

    // a loop that is open where the trial begins is no fault of the remedy
    char begun[40] = "", past[48] = "";
    if (beyond) {
        snprintf(past, sizeof past, ", past the end of the run at %.4g s", w->t_end);
    }
    if (from != &w->run->start) {
        snprintf(begun, sizeof begun, "from t = %.4g s ", from->t);
    }
    snprintf(said, sizeof(hn_remedy),
             TRIED "%suntil t = %.*g s%s: %s gap %.2g m, energy changed by %.2g J", begun,
             begun[0] ? 4 : 3, reached, past, begun[0] ? "last" : "largest",
             begun[0] ? r->last_gap : r->sum.worst_gap, r->sum.worst_energy_change);
}

/// Runs a remedy of report k from a state before its event to a time past it and writes the result
/// to `said`.
static outcome try_from(const hn_watch *w, int k, const char *text, const hn_state_at *from,
                        hn_remedy said) {
    const hn_stepping *s = w->run;
    const double event = w->log.list[k].t;
    hn_run_opts opts = hn_run_opts_default();
    hn_method_spec spec;
    hn_run *pilot = NULL;
    hn_diag diag = {0};

    if (!read_remedy(s, text, &spec)) {
        return UNKNOWN;
    }
    if (hn_guest_is_named(spec.formulation->name)) {
        // every step crosses a pipe: a trial would take longer than the run, and others wait for it
        snprintf(said, sizeof(hn_remedy), "not tried: a trial would ask your program too often");
        return UNKNOWN;
    }
    opts.max_steps = pilot_start(w, k) == from ? PILOT_STEPS : START_STEPS;
    const double end = pilot_end(w, &spec, from->t, event, &opts.max_steps);
    opts.t0 = from->t;
    if (hn_run_create(s->sys, &spec, from->q, from->v, &opts, &pilot, &diag) != HN_OK) {
        return FAILS;
    }

    const shown r = run_and_judge(pilot, from->t, event, end);
    hn_run_free(pilot);
    if (r.status == HN_ERR_STOPPED && r.sum.steps == 0) {
        snprintf(said, sizeof(hn_remedy), "not tried: too many steps to t = %.3g s", end);
        return UNKNOWN;
    }
    if (r.status == HN_ERR_STOPPED && !r.past) {
        snprintf(said, sizeof(hn_remedy), "not tried to the end: %lld steps to t = %.3g s",
                 r.sum.steps, r.sum.t);
        return UNKNOWN;
    }
    say_result(w, &r, from, end, said);
    return r.right ? REMOVES : FAILS;
}

/// Tries a remedy of report k. A state on the way may hold the error that the report is about:
/// what fails from there is tried from the start of the run too.
static trial try_remedy(const hn_watch *w, int k, const char *text) {
    const hn_state_at *from = pilot_start(w, k), *start = &w->run->start;
    trial out = {.whole = from == start};
    out.is = try_from(w, k, text, from, out.said);
    if (out.is != FAILS || from == start) {
        return out;
    }

    trial second = {.whole = true};
    second.is = try_from(w, k, text, start, second.said);
    out.whole = second.is == FAILS;
    return second.is == REMOVES ? second : out;
}

/// Says what was tried in vain, from when on, and why not from the start.
static void tell_in_vain(hn_watch *w, hn_incident *i, hn_remedy texts[], const trial trials[],
                         int n) {
    const hn_state_at *from = pilot_start(w, (int)(i - w->log.list));
    char begun[128] = "";
    bool whole = true;
    for (int k = 0; k < n; k++) {
        whole &= trials[k].whole;
    }
    if (from != &w->run->start) {
        snprintf(begun, sizeof begun, " from t = %.4g s on%s", from->t,
                 whole ? " and from the start"
                       : " (where the state already holds the errors so far; a trial from the "
                         "start would take too many steps)");
    }

    // a setting alone is one of this method
    hn_incident_append(&w->log, i, IN_VAIN "%s:", begun);
    for (int k = 0; k < n; k++) {
        hn_incident_append(&w->log, i, "%s%s%s", k > 0 ? ", " : " ",
                           strchr(texts[k], '@') ? "" : "this method with ", texts[k]);
    }
}

/// Keeps the remedies of a report that remove it, the tried ones first.
static void try_remedies(hn_run *run, hn_incident *i) {
    hn_watch *w = hn_run_watching(run);
    hn_remedy texts[HN_REMEDIES];
    trial trials[HN_REMEDIES];
    int n = 0, kept = 0;

    // try every remedy
    for (; n < HN_REMEDIES && i->remedy[n][0]; n++) {
        memcpy(texts[n], i->remedy[n], sizeof texts[n]);
        trials[n] = try_remedy(w, (int)(i - w->log.list), texts[n]);
    }

    // keep those that work, then those that could not be tried; drop those that fail
    for (int pass = REMOVES; pass <= UNKNOWN; pass += UNKNOWN - REMOVES) {
        for (int k = 0; k < n; k++) {
            if ((int)trials[k].is == pass) {
                memcpy(i->remedy[kept], texts[k], sizeof texts[k]);
                memcpy(i->tried[kept++], trials[k].said, sizeof trials[k].said);
            }
        }
    }

    if (kept < HN_REMEDIES) {
        i->remedy[kept][0] = i->tried[kept][0] = '\0';
    }
    if (n > 0 && kept == 0) {
        tell_in_vain(w, i, texts, trials, n);
    }
}

/// Returns whether a report tells of an error: its kind does, or it is the reason why the run
/// ended.
static bool tells_error(const hn_watch *w, const hn_incident *i) {
    const bool ended = w->failure != HN_OK && w->failure != HN_ERR_STOPPED;
    return hn_incident_kinds()[i->code]->is_wrong || (ended && i == &w->log.list[w->log.n - 1]);
}

/// Why the remedies of a warning are offered without a trial: while the run is well, and once it
/// has gone wrong.
static const char WELL[] =
    "not tried, as nothing is wrong so far; use it if the run goes wrong later";
static const char WRONG[] = "not tried; it may help, as the run went wrong";

static bool went_wrong(const hn_watch *w) {
    bool wrong = false;
    for (int k = 0; k < w->log.n; k++) {
        wrong |= tells_error(w, &w->log.list[k]);
    }
    return wrong;
}

/// Says why remedies of a report have no trial: when it came it was about no error. The words
/// follow the run, which was well then and may have gone wrong since.
static void leave_untried(hn_watch *w, hn_incident *i, bool wrong) {
    for (int k = 0; k < HN_REMEDIES && i->remedy[k][0]; k++) {
        const bool fresh = !i->tried[k][0];
        if (fresh || (wrong && strcmp(i->tried[k], WELL) == 0)) {
            snprintf(i->tried[k], sizeof i->tried[k], "%s", wrong ? WRONG : WELL);
            i->revision = ++w->log.revision;
        }
    }
}

/// The reports of the run that a remedy removes.
static int count_removed(const hn_watch *w, const char *text) {
    int n = 0;
    for (int k = 0; k < w->log.n; k++) {
        const hn_incident *i = &w->log.list[k];
        for (int j = 0; j < HN_REMEDIES && i->remedy[j][0]; j++) {
            n += strcmp(i->remedy[j], text) == 0 && strncmp(i->tried[j], TRIED, strlen(TRIED)) == 0;
        }
    }
    return n;
}

/// The remedy that removes most reports of the run, NULL where none removes any.
static const char *find_best(const hn_watch *w) {
    const char *best = NULL;
    int most = 0;
    for (int k = 0; k < w->log.n; k++) {
        const hn_incident *i = &w->log.list[k];
        for (int j = 0; j < HN_REMEDIES && i->remedy[j][0]; j++) {
            const int n = count_removed(w, i->remedy[j]);
            best = n > most ? i->remedy[j] : best;
            most = n > most ? n : most;
        }
    }
    return best;
}

/// Offers a report whose own remedies were all in vain the one that removes most others of this
/// run, where it removes this one too: so that a run is not told that nothing helps and what helps.
static void share_remedies(const hn_watch *w, hn_incident *i) {
    const char *best = find_best(w);
    if (i->remedy[0][0] || !best) {
        return;
    }
    const trial t = try_remedy(w, (int)(i - w->log.list), best);
    if (t.is == REMOVES) {
        memcpy(i->remedy[0], best, sizeof i->remedy[0]);
        memcpy(i->tried[0], t.said, sizeof i->tried[0]);
        i->remedy[1][0] = i->tried[1][0] = '\0';
    }
}

static void swap(hn_remedy a, hn_remedy b) {
    hn_remedy kept;
    memcpy(kept, a, sizeof kept);
    memcpy(a, b, sizeof kept);
    memcpy(b, kept, sizeof kept);
}

/// The remedy that removes most reports of the run comes first in each: one that helps against the
/// first report alone is not what to try for the whole run.
static void put_best_first(const hn_watch *w, hn_incident *i) {
    for (int j = 1; j < HN_REMEDIES && i->remedy[j][0]; j++) {
        for (int k = j;
             k > 0 && count_removed(w, i->remedy[k]) > count_removed(w, i->remedy[k - 1]); k--) {
            swap(i->remedy[k], i->remedy[k - 1]);
            swap(i->tried[k], i->tried[k - 1]);
        }
    }
}

void hn_run_diagnose(hn_run *run) {
    hn_watch *w = hn_run_watching(run);
    if (w->diagnosed < w->log.n) {
        name_cause(run);
        tell_wrong_before(run);
    }
    for (; w->diagnosed < w->log.n; w->diagnosed++) {
        hn_incident *i = &w->log.list[w->diagnosed];
        if (i->remedy[0][0] && tells_error(w, i)) {
            try_remedies(run, i);
        }
    }
    const bool wrong = went_wrong(w);
    for (int k = 0; k < w->log.n; k++) {
        leave_untried(w, &w->log.list[k], wrong);
    }
    for (int k = 0; k < w->log.n; k++) {
        hn_incident *i = &w->log.list[k];
        if (tells_error(w, i) && strstr(i->message, IN_VAIN)) {
            share_remedies(w, i);
        }
    }
    for (int k = 0; k < w->log.n; k++) {
        put_best_first(w, &w->log.list[k]);
    }
}
