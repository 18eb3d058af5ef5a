// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/remedies.h"

#include "tui/list.h"
#include "tui/methods.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_INCIDENTS = 512 };

static bool is_listed(const hn_workbench *w, const char *remedy) {
    for (int i = 0; i < w->n_items; i++) {
        if (strcmp(w->items[i].name, remedy) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_recorded(const hn_workbench *w) {
    return hn_recording_frames(w->recording) > hn_recording_last(w->recording);
}

/// Each remedy once, with what it gave in a trial, or what it is a remedy of; `running`: those that
/// run already, else the others.
static void list_remedies(hn_workbench *w, const hn_incident *incident, bool running) {
    for (int k = 0; k < HN_REMEDIES && incident->remedy[k][0]; k++) {
        const char *tried = incident->tried[k];
        const int runs = hn_methods_find(w, incident->remedy[k]);
        if ((runs >= 0) != running || is_listed(w, incident->remedy[k])) {
            continue;
        }
        char words[2 * HN_TUI_LINE], already[48] = "";
        if (running) {
            snprintf(already, sizeof already, "runs already as method %d; ", runs + 1);
        }
        if (tried[0]) {
            snprintf(words, sizeof words, "%s%s", already, tried);
        } else {
            snprintf(words, sizeof words, "%s%s, against: %.400s", already,
                     is_recorded(w) ? "not tried" : "not tried yet", incident->message);
        }
        hn_list_add(w, incident->remedy[k], words);
    }
}

void hn_remedies_open(hn_workbench *w) {
    static hn_incident list[MOST_INCIDENTS];
    static int whose[MOST_INCIDENTS];
    const char *name = hn_recording_track(w->recording, w->selected)->name;
    const int n = hn_recording_incidents(w->recording, list, whose, MOST_INCIDENTS);
    char title[HN_TUI_LINE];
    snprintf(title, sizeof title, "what %.60s can try: Enter tries it, Esc goes back", name);
    hn_list_begin(w, HN_LIST_REMEDIES, title);
    hn_step_report step;
    if (hn_workbench_step_report(w, &step) && step.remedy[0]) {
        hn_list_add(w, step.remedy, step.tried);
    }
    for (int i = 0; i < 2 * n; i++) { // what runs already comes last
        if (whose[i % n] == w->selected) {
            list_remedies(w, &list[i % n], i >= n);
        }
    }
    if (w->n_items == 0) {
        w->panel = HN_PANEL_MAIN;
        hn_workbench_say(w, "%s: nothing has happened that asks for a remedy", name);
    }
}

void hn_remedies_take(hn_workbench *w) {
    char remedy[HN_TUI_LINE], key[32];
    double value;
    int end = 0;
    snprintf(remedy, sizeof remedy, "%s", w->items[w->cursor].name);
    w->panel = HN_PANEL_MAIN;
    if (sscanf(remedy, "%31[a-z_A-Z] = %lf%n", key, &value, &end) == 2 && remedy[end] == '\0') {
        hn_methods_set_one(w, key, value);
    } else if (strchr(remedy, '@') && !strchr(remedy, ' ')) {
        const int runs = hn_methods_find(w, remedy);
        hn_methods_add(w, remedy);
        if (runs >= 0) {
            hn_workbench_say(w, "%s runs already: it is method %d, now selected", remedy, runs + 1);
        }
    } else {
        hn_workbench_say(w, "%s", remedy);
    }
}
