// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/part.h"

#include "grade/parts/spelling.h"

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
    r->share = r->alone = share;
    r->mistake = mistake;
    va_start(list, format);
    vsnprintf(r->explanation, sizeof r->explanation, format, list);
    va_end(list);
}

void hn_part_unreadable(hn_part_result *r, const char *format, ...) {
    va_list list;
    r->right = 0;
    r->share = r->alone = 0;
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

void hn_part_qualify(hn_part_result *results, int n) {
    for (int k = 0; k < n; k++) {
        hn_part_result *r = &results[k];
        int shown = 0;
        for (int j = 0; j < n; j++) {
            shown += strcmp(results[j].mistake, r->mistake) == 0;
        }
        static const char says[] = "this looks like";
        if (r->likely && shown < 2 && strncmp(r->explanation, says, strlen(says)) != 0) {
            char text[HN_PART_TEXT];
            memcpy(text, r->explanation, sizeof text);
            snprintf(r->explanation, sizeof r->explanation, "probably this mistake: %.350s", text);
        }
    }
}

/// Returns whether a member's name is another spelling of `name`.
static bool is_spelt(const char *spelt, const char *name) {
    char joined[64], other[64];
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    bool is = hn_spelling_normalise(&plain, spelt, NULL) == HN_OK;
    if (is) {
        const char *word = hn_strbuf_text(&plain);
        word = hn_spelling_join(word, joined, sizeof joined) ? joined : word;
        is = strcmp(word, name) == 0;
        for (int i = 0; !is && hn_spelling_alias(word, i, other, sizeof other); i++) {
            is = strcmp(other, name) == 0;
        }
    }
    hn_strbuf_reset(&plain);
    return is;
}

const cJSON *hn_part_member(const cJSON *answer, const char *name) {
    const cJSON *m = cJSON_GetObjectItemCaseSensitive(answer, name);
    for (const cJSON *other = cJSON_IsObject(answer) ? answer->child : NULL; other && !m;
         other = other->next) {
        m = is_spelt(other->string, name) ? other : NULL;
    }
    return m;
}

int hn_part_numbers_asked(const hn_part *p) {
    static const struct {
        const char *kind, *list;
    } ROWS[] = {{"vector", "answer"}, {"configuration", "asked"}};
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
        if (strcmp(hn_part_text(p->node, "kind"), ROWS[i].kind) == 0) {
            return cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(p->node, ROWS[i].list));
        }
    }
    return 0;
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

bool hn_part_begin(hn_part_result *r, int *n, const cJSON *given, const char *expected) {
    const char *text = cJSON_GetStringValue(given);
    *n = 1;
    *r = (hn_part_result){.mistake = ""};
    snprintf(r->expected, sizeof r->expected, "%s", expected);
    hn_part_keep_given(r, given);
    if (!given || cJSON_IsNull(given) || (text && !text[strspn(text, " \t\r\n")])) {
        hn_part_wrong(r, "blank", 0, "nothing was handed in here");
        return false;
    }
    return true;
}

cJSON *hn_part_right_answer(const hn_part *p, hn_diag *diag) {
    const cJSON *answer = cJSON_GetObjectItemCaseSensitive(p->node, "answer");
    if (!answer) {
        hn_diag_set(diag, HN_ERR_INPUT, "/parts/answer", NULL, "part %s has no answer", p->id);
    }
    return cJSON_Duplicate(answer, 1);
}

cJSON *hn_part_fault_answer(const hn_part *p, int i, const char **id, hn_diag *diag) {
    const cJSON *node = hn_part_fault_at(p, i);
    (void)diag;
    *id = hn_part_text(node, "id");
    return node ? cJSON_Duplicate(cJSON_GetObjectItemCaseSensitive(node, "answer"), 1) : NULL;
}

const char *hn_part_without_name(const char *id, const char *message) {
    char head[48];
    const int n = snprintf(head, sizeof head, "part %.40s: ", id);
    return strncmp(message, head, (size_t)n) == 0 ? message + n : message;
}
