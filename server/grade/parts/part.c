// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/part.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *hn_part_text(const cJSON *node, const char *key) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(node, key));
    return text ? text : "";
}

double hn_part_number(const cJSON *node, const char *key, double otherwise) {
    const cJSON *m = cJSON_GetObjectItemCaseSensitive(node, key);
    return cJSON_IsNumber(m) ? m->valuedouble : otherwise;
}

void hn_part_wrong(hn_part_result *r, const char *mistake, double share, const char *format, ...) {
    va_list list;
    r->right = 0;
    r->share = share;
    r->mistake = mistake;
    va_start(list, format);
    vsnprintf(r->explanation, sizeof r->explanation, format, list);
    va_end(list);
}

void hn_part_unreadable(hn_part_result *r, const char *format, ...) {
    va_list list;
    r->right = 0;
    r->share = 0;
    r->unreadable = 1;
    r->mistake = "unreadable";
    va_start(list, format);
    vsnprintf(r->explanation, sizeof r->explanation, format, list);
    va_end(list);
}

void hn_part_right(hn_part_result *r) {
    r->right = 1;
    r->share = 1;
    r->mistake = "";
}

const cJSON *hn_part_fault_at(const hn_part *p, int i) {
    return cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(p->node, "faults"), i);
}

void hn_part_keep_given(hn_part_result *r, const cJSON *given) {
    const char *text = cJSON_GetStringValue(given);
    char *printed = text || !given ? NULL : cJSON_PrintUnformatted(given);
    snprintf(r->given, sizeof r->given, "%s", text ? text : printed ? printed : "");
    free(printed);
}
