// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/why_view.h"

#include "study/incidents/kinds.h"
#include "study/incidents/log.h"
#include "tui/methods.h"

#include <stdio.h>
#include <string.h>

enum { MOST_INCIDENTS = 512 };

/// How the result of a trial begins that was not made, or not to its end.
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
    for (int i = 0; i < n; i++) {
        if (whose[i] == w->selected && list[i].remedy[0][0]) {
            return true;
        }
    }
    return false;
}

/// Whether incident i is one more of the cause of the one before it.
static bool is_again(const hn_incident *list, const int *whose, int i) {
    return i > 0 && whose[i - 1] == whose[i] && list[i - 1].code == list[i].code;
}

/// Says how many of the incidents listed are not shown.
static void draw_same(hn_cells *c, hn_area in, int y, int same) {
    char line[96];
    snprintf(line, sizeof line, "and %d more of the same causes", same);
    hn_cells_fold(c, in, y, HN_CELL_MUTED, line);
}

/// What an incident is to its method, in the order of the card.
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

/// Whether remedy k of an entry stands below one of the entries from `first` on, and gave the same
/// there.
static bool is_said(const hn_incident *list, const int *entry, int first, int e, int k) {
    const hn_incident *own = &list[entry[e]];
    for (int j = first; j < e; j++) {
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

/// Whether entry e is the first of its kind, and not all of that kind are listed.
static bool tells_count(const hn_incident *list, const int *entry, int e) {
    bool is_first = true;
    for (int k = 0; k < e; k++) {
        is_first = is_first && list[entry[k]].code != list[entry[e]].code;
    }
    return is_first && list[entry[e]].times > HN_INCIDENT_MOST_OF_ONE_KIND;
}

/// Entry e with what to try that is not said from `first` on; returns the row below.
static int draw_entry(hn_cells *c, hn_area in, int y, const hn_workbench *w,
                      const hn_incident *list, const int *entry, int first, int e) {
    const hn_incident *incident = &list[entry[e]];
    char line[512], words[HN_WHY_WORDS];
    const int n = snprintf(line, sizeof line, "%.4g s: %s", incident->t, incident->message);
    if (tells_count(list, entry, e) && n < (int)sizeof line) {
        snprintf(line + n, sizeof line - (size_t)n, "; one of %d, the first %d are listed",
                 incident->times, HN_INCIDENT_MOST_OF_ONE_KIND);
    }
    y = hn_cells_fold(c, in, y, HN_CELL_ALARM, line);
    for (int k = 0; k < HN_REMEDIES && incident->remedy[k][0]; k++) {
        const hn_area inset = {in.x + 2, in.y, in.columns - 2, in.rows};
        if (!is_said(list, entry, first, e, k)) {
            put_remedy(w, incident, k, words);
            y = hn_cells_fold(c, inset, y, HN_CELL_INK, words);
        }
    }
    return y;
}

/// The rule of the method, then why it ended where no entry says so (`ending`: the first one does),
/// or what became of it; returns the row below.
static int draw_head(hn_cells *c, hn_area in, const hn_workbench *w, bool ending) {
    const hn_track *track = hn_recording_track(w->recording, w->selected);
    const hn_track_end end = hn_recording_end(w->recording, w->selected);
    const hn_motion_verdict v =
        hn_recording_verdict(w->recording, w->selected, hn_workbench_frame(w));
    const int y = hn_cells_fold(c, in, 0, HN_CELL_INK, track->rule ? track->rule : "");
    char line[HN_MOTION_VERDICT_TEXT + 32];
    if (end.failed) {
        return ending ? y : hn_cells_fold(c, in, y, HN_CELL_ALARM, end.reason);
    }
    if (v.tone == HN_TONE_CALM) {
        return y;
    }
    snprintf(line, sizeof line, "worst so far: %s", v.text);
    return hn_cells_fold(c, in, y, HN_CELL_ALARM, line);
}

/// Draws the card from entry `first` on; returns how many entries are left below it.
static int draw_card(hn_cells *c, hn_area area, const hn_workbench *w, int first) {
    static hn_incident list[MOST_INCIDENTS];
    static int whose[MOST_INCIDENTS], entry[MOST_INCIDENTS];
    char title[96];
    const int n = hn_recording_incidents(w->recording, list, whose, MOST_INCIDENTS);
    const int entries = list_entries(w, list, whose, n, entry);
    snprintf(title, sizeof title, "why: %s (%si closes)",
             hn_recording_track(w->recording, w->selected)->name,
             hn_why_has_remedy(w) ? "Enter tries, " : "");
    const hn_area in = hn_cells_frame(c, area, title);
    const bool ending = entries > 0 && standing_of(w, &list[entry[0]]) == ENDING;
    int y = draw_head(c, in, w, ending && first == 0), same = 0, e = first;
    for (int i = 0; i < n; i++) {
        same += whose[i] == w->selected && is_again(list, whose, i);
    }

    // the last row is kept for those that follow
    const hn_area above = {in.x, in.y, in.columns, in.rows - 1};
    for (; e < entries && y + 1 < above.rows; e++) {
        y = draw_entry(c, above, y + 1, w, list, entry, first, e);
    }
    if (e < entries) {
        hn_cells_printf(c, in, 0, in.rows - 1, HN_CELL_MUTED, 0, "PageDown: %d more", entries - e);
    } else if (same > 0 && y + 1 < in.rows) {
        draw_same(c, in, y + 1, same);
    }
    return entries - e;
}

/// The entry after those that the card shows from `first` on; `first` itself where it shows the
/// last.
static int next_page(hn_cells *scratch, hn_area area, const hn_workbench *w, int first) {
    static hn_incident list[MOST_INCIDENTS];
    static int whose[MOST_INCIDENTS], entry[MOST_INCIDENTS];
    const int n = hn_recording_incidents(w->recording, list, whose, MOST_INCIDENTS);
    const int entries = list_entries(w, list, whose, n, entry);
    const int left = draw_card(scratch, area, w, first), next = entries - left;
    return left == 0 ? first : next > first ? next : first + 1;
}

bool hn_why_has_more(hn_area area, const hn_workbench *w) {
    hn_cells scratch = {0};
    bool more = false;
    if (hn_cells_resize(&scratch, w->columns, w->rows)) {
        more = next_page(&scratch, area, w, first_shown(w)) != first_shown(w);
    }
    hn_cells_free(&scratch);
    return more || first_shown(w) > 0;
}

void hn_why_scroll(hn_workbench *w, hn_area area, int by) {
    const int now = first_shown(w);
    hn_cells scratch = {0};
    if (!hn_cells_resize(&scratch, w->columns, w->rows)) {
        return;
    }

    // pages begin where the one before ends, so going back counts them from the first on
    int page = by > 0 ? next_page(&scratch, area, w, now) : 0;
    while (by < 0 && next_page(&scratch, area, w, page) < now &&
           next_page(&scratch, area, w, page) > page) {
        page = next_page(&scratch, area, w, page);
    }
    w->why_first = page;
    w->why_of = w->selected;
    hn_cells_free(&scratch);
}

void hn_why_draw(hn_cells *c, hn_area area, const hn_workbench *w) {
    draw_card(c, area, w, first_shown(w));
}
