// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/why_view.h"

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

/// Whether a run recorded a kind of incident as often as any may be: later ones are missing.
static bool is_cut(const hn_incident *list, const int *whose, int n, int run) {
    int count[HN_INCIDENT_COUNT] = {0};
    bool cut = false;
    for (int i = 0; i < n; i++) {
        cut |= whose[i] == run && ++count[list[i].code] == HN_INCIDENT_MOST_OF_ONE_KIND;
    }
    return cut;
}

/// Says how many incidents are not shown of those that are recorded, and that some are not.
static void draw_same(hn_cells *c, hn_area in, int y, int same, bool cut) {
    char line[96];
    snprintf(line, sizeof line, "and %d more of the same causes", same);
    y = hn_cells_fold(c, in, y, HN_CELL_MUTED, line);
    if (cut) {
        snprintf(line, sizeof line, "After %d of a kind none is recorded.",
                 HN_INCIDENT_MOST_OF_ONE_KIND);
        hn_cells_fold(c, in, y, HN_CELL_MUTED, line);
    }
}

static int first_shown(const hn_workbench *w) {
    return w->why_of == w->selected ? w->why_first : 0;
}

void hn_why_scroll(hn_workbench *w, int by) {
    static hn_incident list[MOST_INCIDENTS];
    static int whose[MOST_INCIDENTS];
    const int n = hn_recording_incidents(w->recording, list, whose, MOST_INCIDENTS);
    int entries = 0;
    for (int i = 0; i < n; i++) {
        entries += whose[i] == w->selected && !is_again(list, whose, i);
    }
    const int last = entries > 0 ? entries - 1 : 0, to = first_shown(w) + by;
    w->why_first = to < 0 ? 0 : to > last ? last : to;
    w->why_of = w->selected;
}

/// Whether remedy k of incident i stands below one of the incidents from `first` on, and gave the
/// same there.
static bool is_said(const hn_incident *list, const int *whose, int first, int i, int k) {
    for (int j = first; j < i; j++) {
        const bool shown = whose[j] == whose[i] && !is_again(list, whose, j);
        for (int l = 0; shown && l < HN_REMEDIES && list[j].remedy[l][0]; l++) {
            if (strcmp(list[j].remedy[l], list[i].remedy[k]) == 0 &&
                strcmp(list[j].tried[l], list[i].tried[k]) == 0) {
                return true;
            }
        }
    }
    return false;
}

/// Incident i with what to try that is not said from `first` on; returns the row below.
static int draw_incident(hn_cells *c, hn_area in, int y, const hn_workbench *w,
                         const hn_incident *list, const int *whose, int first, int i) {
    const hn_incident *incident = &list[i];
    char line[512], words[HN_WHY_WORDS];
    snprintf(line, sizeof line, "%.4g s: %s", incident->t, incident->message);
    y = hn_cells_fold(c, in, y, HN_CELL_ALARM, line);
    for (int k = 0; k < HN_REMEDIES && incident->remedy[k][0]; k++) {
        const hn_area inset = {in.x + 2, in.y, in.columns - 2, in.rows};
        if (!is_said(list, whose, first, i, k)) {
            put_remedy(w, incident, k, words);
            y = hn_cells_fold(c, inset, y, HN_CELL_INK, words);
        }
    }
    return y;
}

void hn_why_draw(hn_cells *c, hn_area area, const hn_workbench *w) {
    static hn_incident list[MOST_INCIDENTS];
    static int whose[MOST_INCIDENTS];
    const hn_track *track = hn_recording_track(w->recording, w->selected);
    const hn_track_end end = hn_recording_end(w->recording, w->selected);
    char title[96];
    const int n = hn_recording_incidents(w->recording, list, whose, MOST_INCIDENTS);
    snprintf(title, sizeof title, "why: %s (%si closes)", track->name,
             hn_why_has_remedy(w) ? "Enter tries, " : "");
    const hn_area in = hn_cells_frame(c, area, title);
    int y = hn_cells_fold(c, in, 0, HN_CELL_INK, track->rule ? track->rule : "");
    if (end.failed) {
        y = hn_cells_fold(c, in, y, HN_CELL_ALARM, end.reason);
    }

    // incidents of one cause are one entry with a count; the last row is kept for those that follow
    const int before = first_shown(w);
    const hn_area above = {in.x, in.y, in.columns, in.rows - 1};
    int same = 0, entry = 0, below = 0, first = n;
    for (int i = 0; i < n; i++) {
        const bool own = whose[i] == w->selected, again = is_again(list, whose, i);
        same += own && again;
        if (!own || again || entry++ < before) {
            continue;
        }
        first = i < first ? i : first;
        below += y + 1 >= above.rows;
        y = below ? y : draw_incident(c, above, y + 1, w, list, whose, first, i);
    }
    if (below > 0) {
        hn_cells_printf(c, in, 0, in.rows - 1, HN_CELL_MUTED, 0, "PageDown: %d more", below);
    } else if (same > 0 && y + 1 < in.rows) {
        draw_same(c, in, y + 1, same, is_cut(list, whose, n, w->selected));
    }
}
