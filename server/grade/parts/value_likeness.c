// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_likeness.h"

#include "base/hash.h"
#include "expr/diff.h"
#include "grade/parts/spelling.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PLACES = 3, DIGITS = 4 };

/// The name of the variant whose number is `x`; NULL: none. A whole number is no one's own.
static const char *find_owner(const hn_draw *d, double x) {
    for (int i = 0; i < d->n_outer && x != floor(x); i++) {
        if (d->origin[i] != HN_DRAW_FIXED && fabs(x - d->value[0][i]) <= 1e-12 * fabs(x)) {
            return d->name[i];
        }
    }
    return NULL;
}

/// Copies a formula with the numbers of the variant replaced by their names, small and without
/// blanks; returns how many were replaced.
static int replace_numbers(const hn_draw *d, const char *at, hn_strbuf *out) {
    int replaced = 0;
    bool in_name = false;
    while (*at) {
        char *end = NULL;
        const bool is_number = !in_name && (isdigit((unsigned char)*at) || *at == '.');
        const double x = is_number ? strtod(at, &end) : 0;
        const char *owner = is_number ? find_owner(d, x) : NULL;
        in_name = isalnum((unsigned char)*at) || *at == '_' || (*at == '.' && in_name);
        if (owner) {
            hn_strbuf_add(out, owner);
            replaced++;
        } else if (is_number && end > at) {
            hn_strbuf_printf(out, "%.*s", (int)(end - at), at);
        } else if (!isspace((unsigned char)*at)) {
            hn_strbuf_printf(out, "%c", tolower((unsigned char)*at));
        }
        at = is_number && end > at ? end : at + 1;
        in_name = in_name && !is_number;
    }
    return replaced;
}

/// The hash of the values at numbers that are the same for everybody; 0 where it has none.
static uint64_t hash_values(hn_value_sheet *s, const char *formula) {
    hn_ex e;
    uint64_t hash = HN_HASH_START;
    if (hn_draw_parse_answer(s->draw, formula, &e, NULL) != HN_OK) {
        return 0;
    }
    for (uint64_t k = 0; k < PLACES; k++) {
        double x[HN_DRAW_NAMES];
        char digits[32];
        for (int i = 0; i < s->draw->n_names; i++) {
            x[i] = 0.6 + 0.8 * hn_draw_random(k, (uint64_t)i);
        }
        const double value = hn_graph_eval(s->draw->graph, e, x);
        if (!isfinite(value)) {
            return 0;
        }
        snprintf(digits, sizeof digits, "%.6e", value);
        hash = hn_hash_text(hash, digits);
    }
    return hash;
}

static int count_digits(const char *text) {
    int n = 0;
    for (; *text && tolower((unsigned char)*text) != 'e'; text++) {
        n += isdigit((unsigned char)*text) && (n > 0 || *text != '0');
    }
    return n;
}

/// A number is compared within its variant, and only when it has digits enough.
static uint64_t hash_number(const hn_value_sheet *s, const char *text) {
    const uint64_t hash = hn_hash_bytes(HN_HASH_START, &s->p->seed, sizeof s->p->seed);
    return count_digits(text) < DIGITS ? 0 : hn_hash_text(hash, text);
}

static uint64_t hash_text(hn_value_sheet *s, const char *text, bool by_values) {
    hn_strbuf plain, named;
    uint64_t hash = 0;
    hn_strbuf_init(&plain);
    hn_strbuf_init(&named);
    if (hn_spelling_normalise(&plain, text, NULL) == HN_OK) {
        const int replaced = replace_numbers(s->draw, hn_strbuf_text(&plain), &named);
        const char *words = hn_strbuf_text(&named);
        hash = !s->symbolic && replaced == 0 ? hash_number(s, words)
               : by_values                   ? hash_values(s, words)
                                             : hn_hash_text(HN_HASH_START, words);
    }
    hn_strbuf_reset(&plain);
    hn_strbuf_reset(&named);
    return hash;
}

uint64_t hn_value_likeness(hn_value_sheet *s, const cJSON *node, bool by_values) {
    char number[40];
    const char *text = cJSON_GetStringValue(node);
    if (cJSON_IsNumber(node)) {
        snprintf(number, sizeof number, "%.15g", node->valuedouble);
        text = number;
    }
    return text ? hash_text(s, text, by_values) : 0;
}
