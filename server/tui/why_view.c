// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/why_view.h"

#include "cli/shell/plain.h"
#include "study/incidents/kinds.h"
#include "study/incidents/log.h"
#include "study/incidents/wording.h"
#include "tui/methods.h"

#include <stdio.h>
#include <string.h>

enum { MOST_INCIDENTS = 512 };

/// First words for a trial that was not made, or not to its end.
static const char NOT_TRIED[] = "not tried";

/// Writes remedy k of an incident: "try h=0.005 (tried until t = 3.6 s: largest gap 0.3 mm, ...)"
/// where a trial removed the incident, "not tried yet: ..." while the recording is under way, else
/// "not tried: ...".
static void put_remedy(const hn_workbench *w, const hn_incident *incident, int k,
                       char out[HN_WHY_WORDS]) {
    const char *remedy = incident->remedy[k], *tried = incident->tried[k];
    const bool recorded = hn_recording_frames(w->recording) > hn_recording_last(w->recording);
    const int runs = hn_methods_find(w, remedy);
    if (runs >= 0) {
        snprintf(out, HN_WHY_WORDS, "%s runs already: method %d", remedy, runs + 1);
    } else if (tried[0] && strncmp(tried, NOT_TRIED, strlen(NOT_TRIED)) != 0) {
        snprintf(out, HN_WHY_WORDS, "try %s (%s)", remedy, tried);
    } else if (tried[0]) {
        snprintf(out, HN_WHY_WORDS, "%s: %s", remedy, tried);
    } else {
        snprintf(out, HN_WHY_WORDS, "%s: %s", recorded ? NOT_TRIED : "not tried yet", remedy);
    }
}

bool hn_why_has_remedy(const hn_workbench *w) {
    static hn_incident list[MOST_INCIDENTS];
    static int whose[MOST_INCIDENTS];
    const int n = hn_recording_incidents(w->recording, list, whose, MOST_INCIDENTS);
    hn_step_report step;
    if (hn_workbench_step_report(w, &step) && step.remedy[0]) {
        return true;
    }
    for (int i = 0; i < n; i++) {
        if (whose[i] == w->selected && list[i].remedy[0][0]) {
            return true;
        }
    }
    return false;
}

/// Returns whether incident i is one more of the cause of the one before it.
static bool is_again(const hn_incident *list, const int *whose, int i) {
    return i > 0 && whose[i - 1] == whose[i] && list[i - 1].code == list[i].code;
}

/// Weight of an incident for its method, in the order of the card.
typedef enum standing { ENDING, ERROR, WARNING, STANDINGS } standing;

static standing standing_of(const hn_workbench *w, const hn_incident *incident) {
    const hn_track_end end = hn_recording_end(w->recording, w->selected);
    const size_t n = strlen(end.reason);
    const bool ending = end.failed && n > 0 && strncmp(incident->message, end.reason, n) == 0;
    return ending ? ENDING : hn_incident_kinds()[incident->code]->is_wrong ? ERROR : WARNING;
}

/// The entries of the selected method: incidents of one cause are one entry. Those of one standing
/// are in the order of time. Returns their number.
static int list_entries(const hn_workbench *w, const hn_incident *list, const int *whose, int n,
                        int entry[MOST_INCIDENTS]) {
    int used = 0;
    for (int s = ENDING; s < STANDINGS; s++) {
        for (int i = 0; i < n; i++) {
            const bool own = whose[i] == w->selected && !is_again(list, whose, i);
            if (own && (int)standing_of(w, &list[i]) == s) {
                entry[used++] = i;
            }
        }
    }
    return used;
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

/// Returns whether remedy k of an entry stands below an entry before, and gave the same there.
static bool is_said(const hn_incident *list, const int *entry, int e, int k) {
    const hn_incident *own = &list[entry[e]];
    for (int j = 0; j < e; j++) {
        const hn_incident *other = &list[entry[j]];
        for (int l = 0; l < HN_REMEDIES && other->remedy[l][0]; l++) {
            if (strcmp(other->remedy[l], own->remedy[k]) == 0 &&
                strcmp(other->tried[l], own->tried[k]) == 0) {
                return true;
            }
        }
    }
    return false;
}

/// Returns whether entry e is the first of its kind, and not all of that kind are listed.
static bool tells_count(const hn_incident *list, const int *entry, int e) {
    bool is_first = true;
    for (int k = 0; k < e; k++) {
        is_first = is_first && list[entry[k]].code != list[entry[e]].code;
    }
    return is_first && list[entry[e]].times > HN_INCIDENT_MOST_OF_ONE_KIND;
}

/// Writes what entry e says of its incident.
static void put_message(page *p, const hn_incident *list, const int *entry, int e) {
    const hn_incident *incident = &list[entry[e]];
    char line[640], message[480];
    hn_wording_behind_time(incident->t, incident->message, message, sizeof message);
    const int n = snprintf(line, sizeof line, "%.4g s: %s", incident->t, message);
    if (tells_count(list, entry, e) && n < (int)sizeof line) {
        snprintf(line + n, sizeof line - (size_t)n, "; one of %d, the first %d are listed",
                 incident->times, HN_INCIDENT_MOST_OF_ONE_KIND);
    }
    put(p, 0, HN_CELL_ALARM, line);
}

/// Writes what to try against entry e that is not said above: what runs already comes last.
static void put_remedies(page *p, const hn_workbench *w, const hn_incident *list, const int *entry,
                         int e) {
    const hn_incident *incident = &list[entry[e]];
    char words[HN_WHY_WORDS];
    for (int runs = 0; runs <= 1; runs++) {
        for (int k = 0; k < HN_REMEDIES && incident->remedy[k][0]; k++) {
            const bool is_running = hn_methods_find(w, incident->remedy[k]) >= 0;
            if (is_running == (runs == 1) && !is_said(list, entry, e, k)) {
                put_remedy(w, incident, k, words);
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
static void put_head(page *p, const hn_workbench *w, const hn_incident *list, const int *entry,
                     bool ending) {
    const hn_track_end end = hn_recording_end(w->recording, w->selected);
    const hn_motion_verdict v =
        hn_recording_verdict(w->recording, w->selected, hn_workbench_frame(w));
    char line[HN_MOTION_VERDICT_TEXT + 32];
    if (ending) {
        put_message(p, list, entry, 0);
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

/// The first entry that has something to try; -1: none has.
static int first_remedied(const hn_incident *list, const int *entry, int entries) {
    for (int e = 0; e < entries; e++) {
        if (list[entry[e]].remedy[0][0]) {
            return e;
        }
    }
    return -1;
}

/// Writes the card: what became of the method, what to try, the rule, then each incident. p->line
/// is then the number of its lines.
static void put_card(page *p, const hn_workbench *w) {
    static hn_incident list[MOST_INCIDENTS];
    static int whose[MOST_INCIDENTS], entry[MOST_INCIDENTS];
    const int n = hn_recording_incidents(w->recording, list, whose, MOST_INCIDENTS);
    const int entries = list_entries(w, list, whose, n, entry);
    const bool ending = entries > 0 && standing_of(w, &list[entry[0]]) == ENDING;
    const hn_track *track = hn_recording_track(w->recording, w->selected);
    const int first = first_remedied(list, entry, entries);
    put_head(p, w, list, entry, ending);
    if (first >= 0) {
        put_remedies(p, w, list, entry, first);
    }
    put(p, 0, HN_CELL_INK, track->rule ? track->rule : "");
    for (int e = ending; e < entries; e++) {
        p->line++;
        put_message(p, list, entry, e);
        if (e != first) {
            put_remedies(p, w, list, entry, e);
        }
    }

    // those of one cause after the first
    int same = 0;
    for (int i = 0; i < n; i++) {
        same += whose[i] == w->selected && is_again(list, whose, i);
    }
    if (same > 0) {
        char line[96];
        snprintf(line, sizeof line, "and %d more of the same causes", same);
        p->line++;
        put(p, 0, HN_CELL_MUTED, line);
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
    char title[96];
    snprintf(title, sizeof title, "why: %s (%si closes)",
             hn_recording_track(w->recording, w->selected)->name,
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
