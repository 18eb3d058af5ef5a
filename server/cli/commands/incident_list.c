// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands/incident_list.h"

#include "cli/shell/document.h"
#include "study/incidents/kinds.h"
#include "study/incidents/log.h"
#include "study/incidents/wording.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static bool is_wrong(const cJSON *incident) {
    const hn_incident_kind *const *kinds = hn_incident_kinds();
    const char *code = hn_document_text(incident, "code");
    for (int i = 0; i < HN_INCIDENT_COUNT; i++) {
        if (strcmp(kinds[i]->spelling, code) == 0) {
            return kinds[i]->is_wrong;
        }
    }
    return false;
}

/// Returns whether an incident stands behind another: what is wrong comes before a warning, then
/// the earlier before the later.
static bool is_behind(const cJSON *one, const cJSON *other) {
    const bool wrong = is_wrong(one);
    return wrong == is_wrong(other) ? hn_document_number(one, "t") > hn_document_number(other, "t")
                                    : !wrong;
}

static void sort(hn_incident_list *list) {
    for (int i = 1; i < list->n; i++) {
        const cJSON *moved = list->item[i];
        int j = i;
        for (; j > 0 && is_behind(list->item[j - 1], moved); j--) {
            list->item[j] = list->item[j - 1];
        }
        list->item[j] = moved;
    }
}

void hn_incident_list_take(hn_incident_list *list, const cJSON *incidents, int method,
                           const char *reason) {
    const size_t length = strlen(reason);
    const cJSON *incident;
    *list = (hn_incident_list){0};
    cJSON_ArrayForEach(incident, incidents) {
        if (method >= 0 && (int)hn_document_number(incident, "method") != method) {
            continue;
        }
        // the message of the last is the reason, and goes on with what was tried in vain
        if (length > 0 && strncmp(hn_document_text(incident, "message"), reason, length) == 0) {
            list->end = incident;
        } else if (list->n < HN_RUN_MAX_INCIDENTS) {
            list->item[list->n++] = incident;
        }
    }
    sort(list);
}

/// Returns whether item k is the last of its kind that a run lists.
static bool is_last_listed(const hn_incident_list *list, int k) {
    const char *code = hn_document_text(list->item[k], "code");
    int n = 0;
    for (int i = 0; i <= k; i++) {
        n += strcmp(hn_document_text(list->item[i], "code"), code) == 0;
    }
    return n == HN_INCIDENT_MOST_OF_ONE_KIND;
}

void hn_incident_more(hn_strbuf *b, const hn_incident_list *list, int told) {
    const int more = list->n - told;
    int full = 0;
    hn_strbuf_printf(b, "and %d more incident%s (--json lists ", more, more > 1 ? "s" : "");
    for (int k = 0; k < list->n; k++) {
        const int times = (int)hn_document_number(list->item[k], "times");
        if (!is_last_listed(list, k) || times <= HN_INCIDENT_MOST_OF_ONE_KIND) {
            continue;
        }
        if (full++ == 0) {
            hn_strbuf_printf(b, "the first %d of each kind: ", HN_INCIDENT_MOST_OF_ONE_KIND);
        }
        hn_strbuf_printf(b, "%s%s came %d times", full > 1 ? ", " : "",
                         hn_document_text(list->item[k], "code"), times);
    }
    hn_strbuf_add(b, full ? ")" : "them all)");
}

static bool begins_with_time(const char *sentence) {
    return strncmp(sentence, "at t = ", 7) == 0 || strncmp(sentence, "after t = ", 10) == 0;
}

/// Returns whether a sentence says "t = 0.9 s" with the digits of this time.
static bool says_time(const char *sentence, double t) {
    char word[48];
    snprintf(word, sizeof word, "t = %.6g s", t);
    return strstr(sentence, word) != NULL;
}

void hn_incident_line(const cJSON *incident, char *out, size_t size) {
    const char *message = hn_document_text(incident, "message");
    if (begins_with_time(message)) {
        snprintf(out, size, "%s", message);
    } else {
        snprintf(out, size, "t = %.4g s: %s", hn_document_number(incident, "t"), message);
    }
}

void hn_incident_ending(const hn_incident_list *list, double t, const char *reason, char *out,
                        size_t size) {
    const char *said = list->end ? hn_document_text(list->end, "message") : reason;
    char step[HN_INCIDENT_LINE];
    if (hn_wording_of_step(t, said, step, sizeof step)) {
        snprintf(out, size, " at t = %.6g s, %s", t, step);
        return;
    }
    if (begins_with_time(said) || says_time(said, t)) {
        snprintf(out, size, ": %s", said);
    } else {
        snprintf(out, size, " at t = %.6g s: %s", t, said);
    }
}

const char *hn_incident_remedy(const cJSON *incident) {
    const cJSON *remedy = incident ? hn_document_get(incident, "remedies")->child : NULL;
    const cJSON *tried = incident ? hn_document_get(incident, "tried")->child : NULL;
    return remedy && tried && strncmp(tried->valuestring, "tried ", 6) == 0 ? remedy->valuestring
                                                                            : NULL;
}
