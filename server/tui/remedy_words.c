// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/remedy_words.h"

#include "base/units.h"
#include "tui/methods.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char HN_REMEDY_PUTS_OFF[] = "only puts it off, as nothing closes the loop";

const hn_incident_list *hn_incident_list_get(const hn_workbench *w) {
    static hn_incident_list list;
    list.n = hn_recording_incidents(w->recording, list.at, list.whose, HN_MOST_INCIDENTS);
    return &list;
}

/// The time that a trial reached [s]; below 0: there was no trial.
static double reached(const char *tried) {
    const char *until = strncmp(tried, "tried ", 6) == 0 ? strstr(tried, "until t = ") : NULL;
    return until ? strtod(until + strlen("until t = "), NULL) : -1;
}

const char *hn_remedy_tried(const hn_workbench *w, const hn_incident_list *list,
                            const char *remedy) {
    const char *best = "";
    for (int i = 0; i < list->n; i++) {
        const hn_incident *one = &list->at[i];
        for (int k = 0; k < HN_REMEDIES && one->remedy[k][0]; k++) {
            const bool own = list->whose[i] == w->selected && strcmp(one->remedy[k], remedy) == 0;
            if (own && (!best[0] || reached(one->tried[k]) > reached(best))) {
                best = one->tried[k];
            }
        }
    }
    return best;
}

hn_remedy_rank hn_remedy_rank_of(const hn_workbench *w, const hn_incident_list *list,
                                 const char *remedy) {
    if (hn_methods_find(w, remedy) >= 0) {
        return HN_REMEDY_RUNS;
    }
    if (reached(hn_remedy_tried(w, list, remedy)) < 0) {
        return HN_REMEDY_UNTRIED;
    }
    const bool is_setting = strchr(remedy, '@') == NULL;
    return is_setting && hn_workbench_only_drifts(w, w->methods[w->selected]) ? HN_REMEDY_DELAYS
                                                                              : HN_REMEDY_CURES;
}

// ---- units ----

/// Significant digits of a number as it is written.
static int count_digits(const char *from, const char *to) {
    int n = 0;
    for (; from < to && *from != 'e'; from++) {
        n += isdigit((unsigned char)*from) && (n > 0 || *from != '0');
    }
    return n < 1 ? 1 : n > 9 ? 9 : n;
}

/// The unit behind a number, " m" or " J" and no more letters; 0: another one, or none.
static char unit_behind(const char *text) {
    const bool is_unit = text[0] == ' ' && (text[1] == 'm' || text[1] == 'J');
    const bool goes_on =
        is_unit && text[2] && (isalnum((unsigned char)text[2]) || strchr("^/*", text[2]));
    return is_unit && !goes_on ? text[1] : '\0';
}

void hn_short_units(const char *text, char *out, size_t size) {
    size_t n = 0;
    bool inside = false; // a word, in which digits begin no number
    while (*text && n + 1 < size) {
        char *end = NULL, unit[2] = "", short_one[HN_SI_TEXT];
        const bool starts = !inside && (isdigit((unsigned char)*text) ||
                                        (*text == '-' && isdigit((unsigned char)text[1])));
        const double value = starts ? strtod(text, &end) : 0;
        unit[0] = starts ? unit_behind(end) : '\0';
        if (unit[0] && isfinite(value)) {
            hn_si_format(value, unit, count_digits(text, end), short_one);
            n += (size_t)snprintf(out + n, size - n, "%s", short_one);
            n = n < size ? n : size - 1;
            text = end + 2;
            inside = true;
            continue;
        }
        inside = isalnum((unsigned char)*text) || strchr("._=^", *text);
        out[n++] = *text++;
    }
    out[n] = '\0';
}
