// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/class_copies.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAMED = 5 };

static void keep(char *out, size_t size, const cJSON *o, const char *key) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(o, key));
    snprintf(out, size, "%s", text ? text : "");
}

void hn_class_copies_find(hn_class_copies *c, const hn_class_result *r, bool programs) {
    *c = (hn_class_copies){
        .n = r->n, .programs = programs, .item = calloc((size_t)r->n + 1, sizeof *c->item)};
    for (int i = 0; c->item && i < r->n; i++) {
        cJSON *o = r->line[i] ? cJSON_Parse(r->line[i]) : NULL;
        const double score = cJSON_GetNumberValue(cJSON_GetObjectItem(o, "score"));
        const double most = cJSON_GetNumberValue(cJSON_GetObjectItem(o, "max_score"));
        if (programs || score < most) {
            keep(c->item[i].student, sizeof c->item[i].student, o, "student");
            keep(c->item[i].texts, sizeof c->item[i].texts, o, "texts");
            keep(c->item[i].shape, sizeof c->item[i].shape, o, "shape");
        }
        cJSON_Delete(o);
    }
}

void hn_class_copies_reset(hn_class_copies *c) {
    free(c->item);
    *c = (hn_class_copies){0};
}

const char *hn_class_copies_near(bool programs) {
    return programs ? "the same but for names, comments and the order of statements"
                    : "the same but for the names";
}

/// Adds those that are like submission i: in their texts, or in their shape alone.
static void put_group(hn_strbuf *b, const hn_class_copies *c, int i, bool by_texts) {
    const hn_class_copy *own = &c->item[i];
    int n = 0;
    for (int k = 0; k < c->n; k++) {
        const hn_class_copy *other = &c->item[k];
        const bool same = strcmp(other->texts, own->texts) == 0;
        const bool like = by_texts ? same : !same && strcmp(other->shape, own->shape) == 0;
        if (k == i || !other->texts[0] || !like) {
            continue;
        }
        if (n++ < MOST_NAMED) {
            if (n == 1) {
                hn_strbuf_printf(b, "%s%s as ", b->n == 0 ? "" : "; ",
                                 by_texts ? "the same" : hn_class_copies_near(c->programs));
            }
            hn_strbuf_printf(b, "%s%s", n > 1 ? ", " : "", other->student);
        }
    }
    if (n > MOST_NAMED) {
        hn_strbuf_printf(b, " and %d more", n - MOST_NAMED);
    }
}

void hn_class_copies_put(hn_strbuf *b, const hn_class_copies *c, int i) {
    if (c->item && c->item[i].texts[0]) {
        put_group(b, c, i, true);
        put_group(b, c, i, false);
    }
}
