// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/class_copies.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAMED = 5, MOST_PAIRS = 30 };
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

/// Two programs and what they share.
typedef struct pair {
    int first, second;
    double share;
} pair;

/// Takes a pair into a list that falls with the share; of equal ones the earlier stays in front.
/// If `most` are there the last one goes.
static void take_pair(pair *list, int *n, int most, pair new) {
    if (*n == most && list[most - 1].share >= new.share) {
        return;
    }
    int i = *n < most ? (*n)++ : most - 1;
    for (; i > 0 && list[i - 1].share < new.share; i--) {
        list[i] = list[i - 1];
    }
    list[i] = new;
}

/// Adds whom program i shares most of its statements with, the most alike first, and how many at
/// least.
static void put_shares(hn_strbuf *b, const hn_class_copies *c, int i) {
    pair list[MOST_NAMED];
    double least = 1;
    int n = 0, shown = 0;
    for (int k = 0; k < c->n; k++) {
        const double share = share_of(&c->item[i], &c->item[k]);
        if (share > 0) {
            n++;
            least = fmin(least, share);
            take_pair(list, &shown, MOST_NAMED, (pair){i, k, share});
        }
    }
    if (n == 0) {
        return;
    }
    hn_strbuf_printf(b, "%sshares %s%.0f %% of its statements with ", b->n == 0 ? "" : "; ",
                     n > 1 ? "at least " : "", floor(100 * least));
    for (int k = 0; k < shown; k++) {
        hn_strbuf_printf(b, "%s%s", k > 0 ? ", " : "", c->item[list[k].second].student);
    }
    if (n > MOST_NAMED) {
        hn_strbuf_printf(b, " and %d more", n - MOST_NAMED);
    }
}

void hn_class_copies_put_alike(hn_strbuf *b, const hn_class_copies *c) {
    pair list[MOST_PAIRS];
    int shown = 0, n = 0;
    for (int i = 0; c->item && i < c->n; i++) {
        for (int k = i + 1; k < c->n; k++) {
            const double share = share_of(&c->item[i], &c->item[k]);
            if (share > 0) {
                n++;
                take_pair(list, &shown, MOST_PAIRS, (pair){i, k, share});
            }
        }
    }
    if (n == 0) {
        return;
    }

    // the threshold, then the pairs
    hn_strbuf_printf(b,
                     "pairs of programs that share %.0f %% or more of their statements, the most "
                     "alike first (names, comments\nand order aside, without the statements that "
                     "everyone is given): compare them yourself, short ones are alike by chance\n",
                     100 * ALIKE);
    for (int k = 0; k < shown; k++) {
        hn_strbuf_printf(b, "  %3.0f %%  %s, %s\n", floor(100 * list[k].share),
                         c->item[list[k].first].student, c->item[list[k].second].student);
    }
    if (n > shown) {
        hn_strbuf_printf(b, "  and %d more pairs of %.0f %% or more\n", n - shown, 100 * ALIKE);
    }
}

void hn_class_copies_put(hn_strbuf *b, const hn_class_copies *c, int i) {
    if (c->item && c->item[i].texts[0]) {
        put_group(b, c, i, true);
        put_group(b, c, i, false);
        put_shares(b, c, i);
    }
}
