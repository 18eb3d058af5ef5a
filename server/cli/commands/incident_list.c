// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands/incident_list.h"

#include "cli/shell/document.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static void sort_by_time(hn_incident_list *list) {
    for (int i = 1; i < list->n; i++) {
        const cJSON *moved = list->item[i];
        const double t = hn_document_number(moved, "t");
        int j = i;
        for (; j > 0 && hn_document_number(list->item[j - 1], "t") > t; j--) {
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
    sort_by_time(list);
}

static bool begins_with_time(const char *sentence) {
    return strncmp(sentence, "at t = ", 7) == 0 || strncmp(sentence, "after t = ", 10) == 0;
}

/// Whether a sentence says "t = 0.9 s" with the digits of this time.
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
