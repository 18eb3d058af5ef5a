// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/remedies.h"

#include "tui/list.h"
#include "tui/methods.h"
#include "tui/remedy_words.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/// What is said beside a remedy: whether it runs already, what it gave in a trial, or what it is a
/// remedy of.
static void write_words(const hn_workbench *w, const hn_incident_list *list,
                        const hn_incident *incident, const char *remedy, char *out, size_t size) {
    const hn_remedy_rank rank = hn_remedy_rank_of(w, list, remedy);
    const char *tried = hn_remedy_tried(w, list, remedy);
    char first[80] = "", units[HN_TUI_LINE];
    if (rank == HN_REMEDY_RUNS) {
        snprintf(first, sizeof first, "runs already as method %d; ",
                 hn_methods_find(w, remedy) + 1);
    } else if (rank == HN_REMEDY_DELAYS) {
        snprintf(first, sizeof first, "%s; ", HN_REMEDY_PUTS_OFF);
    }
    hn_short_units(tried[0] ? tried : incident->message, units, sizeof units);
    if (tried[0]) {
        snprintf(out, size, "%s%s", first, units);
    } else {
        snprintf(out, size, "%s%s, against: %s", first,
                 is_recorded(w) ? "not tried" : "not tried yet", units);
    }
}

/// Each remedy of this rank once.
static void list_remedies(hn_workbench *w, const hn_incident_list *list,
                          const hn_incident *incident, hn_remedy_rank rank) {
    for (int k = 0; k < HN_REMEDIES && incident->remedy[k][0]; k++) {
        const char *remedy = incident->remedy[k];
        char words[2 * HN_TUI_LINE];
        if (hn_remedy_rank_of(w, list, remedy) == rank && !is_listed(w, remedy)) {
            write_words(w, list, incident, remedy, words, sizeof words);
            hn_list_add(w, remedy, words);
        }
    }
}

void hn_remedies_open(hn_workbench *w) {
    const char *name = hn_recording_track(w->recording, w->selected)->name;
    const hn_incident_list *list = hn_incident_list_get(w);
    char title[HN_TUI_LINE];
    snprintf(title, sizeof title, "what %.60s can try: Enter tries it, Esc goes back", name);
    hn_list_begin(w, HN_LIST_REMEDIES, title);
    hn_step_report step;
    if (hn_workbench_step_report(w, &step) && step.remedy[0]) {
        hn_list_add(w, step.remedy, step.tried);
    }
    for (int rank = 0; rank < HN_REMEDY_RANKS; rank++) {
        for (int i = 0; i < list->n; i++) {
            if (list->whose[i] == w->selected) {
                list_remedies(w, list, &list->at[i], (hn_remedy_rank)rank);
            }
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
        hn_methods_add_beside(w, remedy);
        if (runs >= 0) {
            hn_workbench_say(w, "%s runs already: it is method %d, now selected", remedy, runs + 1);
        }
    } else {
        hn_workbench_say(w, "%s", remedy);
    }
}
