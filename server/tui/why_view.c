// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/why_view.h"

#include "base/units.h"
#include "cli/shell/plain.h"
#include "study/incidents/kinds.h"
#include "study/incidents/log.h"
#include "study/incidents/wording.h"
#include "tui/method_name.h"
#include "tui/methods.h"
#include "tui/remedy_words.h"

#include <stdio.h>
#include <string.h>

enum { LONGEST_NAME = 22 }; // columns of a name in the title

/// Writes a remedy: "try h=0.005 (tried until t = 3.6 s: largest gap 0.3 mm, ...)" where a trial
/// removed the incident, "not tried yet: ..." while the recording is under way, else "not tried:
/// ...". A setting is one of the method that runs: "try this method with h=0.005".
static void put_remedy(const hn_workbench *w, const hn_incident_list *list, const char *remedy,
                       char out[HN_WHY_WORDS]) {
    const bool recorded = hn_recording_frames(w->recording) > hn_recording_last(w->recording);
    const char *of = strchr(remedy, '@') ? "" : "this method with ";
    char tried[sizeof(hn_remedy) + HN_SI_TEXT];
    hn_short_units(hn_remedy_tried(w, list, remedy), tried, sizeof tried);
    switch (hn_remedy_rank_of(w, list, remedy)) {
    case HN_REMEDY_RUNS:
        snprintf(out, HN_WHY_WORDS, "%s runs already: method %d", remedy,
                 hn_methods_find(w, remedy) + 1);
        break;
    case HN_REMEDY_DELAYS:
        snprintf(out, HN_WHY_WORDS, "%s%s %s (%s)", of, remedy, HN_REMEDY_PUTS_OFF, tried);
        break;
    case HN_REMEDY_CURES:
        snprintf(out, HN_WHY_WORDS, "try %s%s (%s)", of, remedy, tried);
        break;
    default:
        if (tried[0]) {
            snprintf(out, HN_WHY_WORDS, "%s%s: %s", of, remedy, tried);
        } else {
            snprintf(out, HN_WHY_WORDS, "%s: %s%s", recorded ? "not tried" : "not tried yet", of,
                     remedy);
        }
    }
}

bool hn_why_has_remedy(const hn_workbench *w) {
    const hn_incident_list *list = hn_incident_list_get(w);
    hn_step_report step;
    if (hn_workbench_step_report(w, &step) && step.remedy[0]) {
        return true;
    }
    for (int i = 0; i < list->n; i++) {
        if (list->whose[i] == w->selected && list->at[i].remedy[0][0]) {
            return true;
        }
    }
    return false;
}

/// Returns whether incident i is one more of the cause of the one before it.
static bool is_again(const hn_incident_list *list, int i) {
    return i > 0 && list->whose[i - 1] == list->whose[i] &&
           list->at[i - 1].code == list->at[i].code;
}

/// Weight of an incident for its method, in the order of the card: the end of the method; the place
/// where branches of the motion meet or change, which decides what comes after; other errors;
/// warnings.
typedef enum standing { ENDING, BRANCHES, ERROR, WARNING, STANDINGS } standing;

/// Returns whether incident i is the first flat position of its method, or goes to another branch.
static bool is_about_branches(const hn_incident_list *list, int i) {
    const hn_incident_code code = list->at[i].code;
    bool first = true;
    for (int k = 0; k < i; k++) {
        first = first && !(list->whose[k] == list->whose[i] && list->at[k].code == code);
    }
    return code == HN_INCIDENT_BRANCH_FLIP ||
           (first && (code == HN_INCIDENT_NEAR_SINGULAR || code == HN_INCIDENT_RANK_LOSS));
}

static standing standing_of(const hn_workbench *w, const hn_incident_list *list, int i) {
    const hn_incident *incident = &list->at[i];
    const hn_track_end end = hn_recording_end(w->recording, w->selected);
    const size_t n = strlen(end.reason);
    if (end.failed && n > 0 && strncmp(incident->message, end.reason, n) == 0) {
        return ENDING;
    }
    if (is_about_branches(list, i)) {
        return BRANCHES;
    }
    return hn_incident_kinds()[incident->code]->is_wrong ? ERROR : WARNING;
}

/// The entries of the card of the selected method.
typedef struct entries {
    const hn_incident_list *list;
    int n, first;              ///< first: the one whose remedies stand above all; -1: none
    int at[HN_MOST_INCIDENTS]; ///< places in the list
} entries;

static const hn_incident *entry_at(const entries *all, int e) {
    return &all->list->at[all->at[e]];
}

/// Lists the entries: incidents of one cause are one, those of one standing are in the order of
/// time.
static void list_entries(const hn_workbench *w, entries *all) {
    all->n = 0;
    for (int s = ENDING; s < STANDINGS; s++) {
        for (int i = 0; i < all->list->n; i++) {
            const bool own = all->list->whose[i] == w->selected && !is_again(all->list, i);
            if (own && (int)standing_of(w, all->list, i) == s) {
                all->at[all->n++] = i;
            }
        }
    }

    // the first of those with the best remedy
    int best = HN_REMEDY_RANKS;
    all->first = -1;
    for (int e = 0; e < all->n; e++) {
        const hn_incident *one = entry_at(all, e);
        for (int k = 0; k < HN_REMEDIES && one->remedy[k][0]; k++) {
            const int rank = hn_remedy_rank_of(w, all->list, one->remedy[k]);
            all->first = rank < best ? e : all->first;
            best = rank < best ? rank : best;
        }
    }
}

static int first_shown(const hn_workbench *w) {
    return w->why_of == w->selected ? w->why_first : 0;
}

/// The card while it is written, line by line; its last row is kept for what follows below.
typedef struct page {
    hn_cells *c; ///< NULL: lines are counted alone
    hn_area in;
    int first; ///< line in the uppermost row
    int line;  ///< written so far
} page;

static void put(page *p, int indent, int colour, const char *text) {
    const hn_area in = {p->in.x + indent, p->in.y, p->in.columns - indent, p->in.rows - 1};
    if (p->c) {
        hn_cells_fold(p->c, in, p->line - p->first, colour, text);
    }
    p->line += hn_text_rows(text, in.columns);
}

static bool has_remedy(const hn_incident *incident, const char *remedy) {
    for (int k = 0; k < HN_REMEDIES && incident->remedy[k][0]; k++) {
        if (strcmp(incident->remedy[k], remedy) == 0) {
            return true;
        }
    }
    return false;
}

/// Returns whether a remedy of entry e stands above it: below the step that was tried, below the
/// verdict or below an entry before.
static bool is_said(const hn_workbench *w, const entries *all, int e, const char *remedy) {
    hn_step_report step;
    if (hn_workbench_step_report(w, &step) && strcmp(step.remedy, remedy) == 0) {
        return true;
    }
    bool said = e != all->first && has_remedy(entry_at(all, all->first), remedy);
    for (int j = 0; j < e && e != all->first; j++) {
        said = said || has_remedy(entry_at(all, j), remedy);
    }
    return said;
}

/// Returns whether an entry before e, which does not end the method, is of its kind.
static bool is_repeated(const hn_workbench *w, const entries *all, int e) {
    bool repeated = false;
    for (int k = 0; k < e; k++) {
        repeated = repeated || entry_at(all, k)->code == entry_at(all, e)->code;
    }
    return repeated && standing_of(w, all->list, all->at[e]) != ENDING;
}

/// Writes when the incident of entry e came again, and how often in all.
static void put_again(page *p, const hn_workbench *w, const entries *all, int e) {
    const hn_incident *incident = entry_at(all, e);
    char line[240] = "again at";
    int n = (int)strlen(line), found = 0;
    for (int i = 0; i < all->list->n; i++) {
        const hn_incident *other = &all->list->at[i];
        const bool same = all->list->whose[i] == w->selected && other->code == incident->code;
        if (same && i != all->at[e] && n < (int)sizeof line) {
            n += snprintf(line + n, sizeof line - (size_t)n, "%s %.4g", found > 0 ? "," : "",
                          other->t);
            found++;
        }
    }
    if (found > 0 && n < (int)sizeof line) {
        const int times = incident->times > found ? incident->times : found + 1;
        snprintf(line + n, sizeof line - (size_t)n, " s: %d times in all", times);
        put(p, 2, HN_CELL_MUTED, line);
    }
}

/// Writes what entry e says of its incident.
static void put_message(page *p, const entries *all, int e) {
    const hn_incident *incident = entry_at(all, e);
    char line[640], message[480], units[480];
    hn_wording_behind_time(incident->t, incident->message, message, sizeof message);
    hn_short_units(message, units, sizeof units);
    snprintf(line, sizeof line, "%.4g s: %s", incident->t, units);
    put(p, 0, HN_CELL_ALARM, line);
}

/// Writes what to try against entry e that is not said above, the best first.
static void put_remedies(page *p, const hn_workbench *w, const entries *all, int e) {
    const hn_incident *incident = entry_at(all, e);
    char words[HN_WHY_WORDS];
    for (int rank = 0; rank < HN_REMEDY_RANKS; rank++) {
        for (int k = 0; k < HN_REMEDIES && incident->remedy[k][0]; k++) {
            const char *remedy = incident->remedy[k];
            if ((int)hn_remedy_rank_of(w, all->list, remedy) == rank &&
                !is_said(w, all, e, remedy)) {
                put_remedy(w, all->list, remedy, words);
                put(p, 2, HN_CELL_INK, words);
            }
        }
    }
}

/// Whether the step is the cause, and the step that would do.
static void put_step(page *p, const hn_workbench *w) {
    hn_step_report step;
    char words[HN_WHY_WORDS];
    if (!hn_workbench_step_report(w, &step)) {
        return;
    }
    put(p, 0, step.finding == HN_STEP_LONG ? HN_CELL_ALARM : HN_CELL_MUTED, step.cause);
    if (step.remedy[0]) {
        snprintf(words, sizeof words, "try %s (%s)", step.remedy, step.tried);
        put(p, 2, HN_CELL_INK, words);
    }
}

/// Writes what became of the method: the entry that ended it (`ending`: it is the first one), why
/// it ended where no entry says so, or the worst of it and whether its step is the cause.
static void put_head(page *p, const hn_workbench *w, const entries *all, bool ending) {
    const hn_track_end end = hn_recording_end(w->recording, w->selected);
    const hn_motion_verdict v =
        hn_recording_verdict(w->recording, w->selected, hn_workbench_frame(w));
    char line[HN_MOTION_VERDICT_TEXT + 32];
    if (ending) {
        put_message(p, all, 0);
    } else if (end.failed) {
        char reason[sizeof end.reason + 48];
        hn_wording_behind_time(end.t, end.reason, reason, sizeof reason);
        put(p, 0, HN_CELL_ALARM, reason);
    } else if (v.tone != HN_TONE_CALM) {
        snprintf(line, sizeof line, "worst so far: %s", v.text);
        if (w->form == HN_DOTS_ASCII) {
            hn_plain_powers(line);
        }
        put(p, 0, HN_CELL_ALARM, line);
        put_step(p, w);
    }
}

/// Writes the card: what became of the method, what to try, the rule, then each incident. p->line
/// is then the number of its lines.
static void put_card(page *p, const hn_workbench *w) {
    static entries all;
    const hn_track *track = hn_recording_track(w->recording, w->selected);
    all.list = hn_incident_list_get(w);
    list_entries(w, &all);
    const bool ending = all.n > 0 && standing_of(w, all.list, all.at[0]) == ENDING;
    put_head(p, w, &all, ending);
    if (all.first >= 0) {
        put_remedies(p, w, &all, all.first);
    }
    put(p, 0, HN_CELL_INK, track->rule ? track->rule : "");
    for (int e = ending; e < all.n; e++) {
        if (is_repeated(w, &all, e)) {
            continue;
        }
        p->line++;
        put_message(p, &all, e);
        put_again(p, w, &all, e);
        for (int k = e; k < all.n; k++) {
            if (k != all.first &&
                (k == e ||
                 (is_repeated(w, &all, k) && entry_at(&all, k)->code == entry_at(&all, e)->code))) {
                put_remedies(p, w, &all, k);
            }
        }
    }
}

/// The uppermost line of the last page, in a frame of this area.
static int last_page(hn_area area, const hn_workbench *w) {
    const hn_area in = {area.x + 1, area.y + 1, area.columns - 2, area.rows - 2};
    page p = {.in = in};
    put_card(&p, w);
    return p.line > in.rows - 1 ? p.line - (in.rows - 1) : 0;
}

bool hn_why_has_more(hn_area area, const hn_workbench *w) {
    return last_page(area, w) > 0;
}

void hn_why_scroll(hn_workbench *w, hn_area area, int by) {
    enum { KEPT = 4 }; // rows of the frame, of what follows, and one line of the page before
    const int step = area.rows > KEPT ? area.rows - KEPT : 1, last = last_page(area, w);
    const int line = first_shown(w) + (by > 0 ? step : -step);
    w->why_first = line < 0 ? 0 : line > last ? last : line;
    w->why_of = w->selected;
}

void hn_why_follow(hn_workbench *w) {
    w->why_first = first_shown(w);
    w->why_of = w->selected;
}

void hn_why_draw(hn_cells *c, hn_area area, const hn_workbench *w) {
    char title[128], name[HN_METHOD_NAME];
    hn_method_name(w, w->selected, LONGEST_NAME, name);
    snprintf(title, sizeof title, "why: %s (%si closes)", name,
             hn_why_has_remedy(w) ? "Enter tries, " : "");
    const hn_area in = hn_cells_frame(c, area, title);
    page p = {.c = c, .in = in, .first = first_shown(w)};
    put_card(&p, w);
    const int below = p.line - p.first - (in.rows - 1);
    if (below > 0) {
        hn_cells_printf(c, in, 0, in.rows - 1, HN_CELL_MUTED, 0, "PageDown: %d more line%s", below,
                        below == 1 ? "" : "s");
    } else if (p.first > 0) {
        hn_cells_put(c, in, 0, in.rows - 1, HN_CELL_MUTED, 0, "PageUp: back");
    }
}
