// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/class_copies.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAMED = 5 };
/// Share of common statements from which on two programs are listed. Honest programs of the tests
/// have at most 0.4 in common, a copy with a statement or two added or taken apart at least 0.8.
static const double ALIKE = 0.6;

static void keep(char *out, size_t size, const cJSON *o, const char *key) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(o, key));
    snprintf(out, size, "%s", text ? text : "");
}

/// The share of two programs that differ in more than near-copies do, 0: they are not alike.
static double share_of(const hn_class_copy *a, const hn_class_copy *b) {
    const bool compared = a->texts[0] && b->texts[0] && a->own.n > 0 && b->own.n > 0;
    if (!compared || strcmp(a->shape, b->shape) == 0) {
        return 0;
    }
    const double share = hn_fingerprint_share(&a->own, &b->own);
    return share >= ALIKE ? share : 0;
}

/// Programs that are alike come into one group, whose number is that of its first.
static void group_alike(hn_class_copies *c) {
    for (int i = 0; i < c->n; i++) {
        c->item[i].group = i;
        for (int k = 0; k < i; k++) {
            const int from = c->item[i].group, to = c->item[k].group;
            if (from == to || share_of(&c->item[i], &c->item[k]) == 0) {
                continue;
            }
            const int first = from < to ? from : to, last = from < to ? to : from;
            for (int m = 0; m <= i; m++) {
                c->item[m].group = c->item[m].group == last ? first : c->item[m].group;
            }
        }
    }
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
            const char *own = cJSON_GetStringValue(cJSON_GetObjectItem(o, "statements"));
            hn_fingerprint_parse(&c->item[i].own, own ? own : "");
        }
        cJSON_Delete(o);
    }
    if (c->item && programs) {
        group_alike(c);
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

/// Adds whom program i shares most of its statements with, and how many at least.
static void put_shares(hn_strbuf *b, const hn_class_copies *c, int i) {
    double least = 1;
    int n = 0;
    for (int k = 0; k < c->n; k++) {
        const double share = share_of(&c->item[i], &c->item[k]);
        n += share > 0;
        least = share > 0 && share < least ? share : least;
    }
    if (n == 0) {
        return;
    }
    hn_strbuf_printf(b, "%sshares %s%.0f %% of its statements with ", b->n == 0 ? "" : "; ",
                     n > 1 ? "at least " : "", floor(100 * least));
    int named = 0;
    for (int k = 0; k < c->n && named < MOST_NAMED; k++) {
        if (share_of(&c->item[i], &c->item[k]) > 0) {
            hn_strbuf_printf(b, "%s%s", named++ > 0 ? ", " : "", c->item[k].student);
        }
    }
    if (n > MOST_NAMED) {
        hn_strbuf_printf(b, " and %d more", n - MOST_NAMED);
    }
}

/// The least and the largest share within the group of item i; how many are in it.
static int measure_group(const hn_class_copies *c, int i, double *least, double *most) {
    int n = 0;
    *least = 1;
    *most = 0;
    for (int k = i; k < c->n; k++) {
        if (c->item[k].group != i) {
            continue;
        }
        n++;
        for (int m = i; m < k; m++) {
            const double share = c->item[m].group == i ? share_of(&c->item[m], &c->item[k]) : 0;
            *least = share > 0 && share < *least ? share : *least;
            *most = share > *most ? share : *most;
        }
    }
    return n;
}

void hn_class_copies_put_alike(hn_strbuf *b, const hn_class_copies *c) {
    int shown = 0;
    for (int i = 0; c->item && i < c->n; i++) {
        double least, most;
        if (c->item[i].group != i || measure_group(c, i, &least, &most) < 2) {
            continue;
        }
        if (shown++ == 0) {
            hn_strbuf_printf(b,
                             "programs that share %.0f %% or more of their statements (without "
                             "those that everyone is given;\nnames, comments and order aside): "
                             "compare them yourself, short ones are alike by chance\n",
                             100 * ALIKE);
        }
        const char *between = "  ";
        for (int k = i; k < c->n; k++) {
            if (c->item[k].group == i) {
                hn_strbuf_printf(b, "%s%s", between, c->item[k].student);
                between = ", ";
            }
        }
        hn_strbuf_printf(b, ": %.0f", floor(100 * least));
        if (floor(100 * most) > floor(100 * least)) {
            hn_strbuf_printf(b, " to %.0f", floor(100 * most));
        }
        hn_strbuf_add(b, " %\n");
    }
}

void hn_class_copies_put(hn_strbuf *b, const hn_class_copies *c, int i) {
    if (c->item && c->item[i].texts[0]) {
        put_group(b, c, i, true);
        put_group(b, c, i, false);
        put_shares(b, c, i);
    }
}
