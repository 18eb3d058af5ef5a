// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/column_unit.h"

#include "base/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DIGITS = 3 };
static const double SPREAD = 1e4;     // largest size over smallest that one prefix can show
static const double WHOLE_MOST = 1e7; // counts above it are written with a power of ten
static const char *const PREFIXES[] = {"n", "µ", "m", "", "k", "M", "G"};
enum { N_PREFIXES = sizeof PREFIXES / sizeof *PREFIXES, NO_PREFIX = 3 };

typedef struct sizes {
    double least, most; ///< of the finite values that are not 0; 0: there is none
    const char *unit;   ///< NULL: there is no quantity
    bool mixed;         ///< the cells differ in their unit
} sizes;

static sizes measure(const hn_table_item *cells, int first, int stride, int n) {
    sizes s = {0};
    for (int i = first; i < n; i += stride) {
        const double size = fabs(cells[i].value);
        if (!cells[i].is_quantity || !isfinite(size)) {
            continue;
        }
        s.mixed |= s.unit && strcmp(s.unit, cells[i].unit) != 0;
        s.unit = cells[i].unit;
        if (size > 0) {
            s.least = s.least == 0 || size < s.least ? size : s.least;
            s.most = size > s.most ? size : s.most;
        }
    }
    return s;
}

/// The prefix for which the largest value has one to three digits before the point; -1: none of
/// them.
static int choose_prefix(const sizes *s) {
    if (s->most == 0) {
        return NO_PREFIX;
    }
    // the unit's own rule says whether it takes one
    char text[HN_SI_TEXT];
    hn_si_format(1e-3, s->unit, 1, text);
    const bool takes = s->unit[0] && strncmp(text, "1 m", 3) == 0;
    const double rounded = s->most * (1 + 0.5 * pow(10, -DIGITS));
    const int prefix = NO_PREFIX + (takes ? (int)floor(log10(rounded) / 3) : 0);
    const bool narrow = s->most <= SPREAD * s->least;
    const bool plain = takes || (s->most < 1e6 && s->least >= 1e-3);
    return narrow && plain && prefix >= 0 && prefix < N_PREFIXES ? prefix : -1;
}

/// Three digits, at least the whole part.
static void put_digits(char out[HN_TABLE_CELL], double value) {
    const double size = fabs(value);
    const int before = size > 0 ? (int)floor(log10(size * (1 + 0.5 * pow(10, -DIGITS)))) + 1 : 1;
    const int decimals = DIGITS - before;
    snprintf(out, HN_TABLE_CELL, "%.*f", decimals > 0 ? decimals : 0, value);
}

static void put_count(char out[HN_TABLE_CELL], double value, double most) {
    snprintf(out, HN_TABLE_CELL, most < WHOLE_MOST ? "%.0f" : "%.2e", value);
}

void hn_column_unit(hn_table_item *cells, int first, int stride, int n, char head[HN_TABLE_UNIT]) {
    const sizes s = measure(cells, first, stride, n);
    const bool counts = s.unit && strcmp(s.unit, "op") == 0;
    const int prefix = s.unit && !s.mixed ? choose_prefix(&s) : -1;

    // the head says the unit once
    head[0] = '\0';
    if (s.unit && s.unit[0] && !s.mixed && !counts) {
        snprintf(head, HN_TABLE_UNIT, " [%s%.16s]", prefix >= 0 ? PREFIXES[prefix] : "", s.unit);
    }

    // each cell: its digits, and its own unit where there is no common one
    for (int i = first; i < n; i += stride) {
        hn_table_item *c = &cells[i];
        if (!c->is_quantity) {
            continue;
        }
        if (!isfinite(c->value)) {
            snprintf(c->text, sizeof c->text, "-");
        } else if (s.mixed) {
            char text[HN_SI_TEXT];
            hn_si_format(c->value, c->unit, DIGITS, text);
            snprintf(c->text, sizeof c->text, "%s", text);
        } else if (c->value == 0) {
            snprintf(c->text, sizeof c->text, "0");
        } else if (counts) {
            put_count(c->text, c->value, s.most);
        } else if (prefix >= 0) {
            put_digits(c->text, c->value / pow(10, 3 * (prefix - NO_PREFIX)));
        } else {
            snprintf(c->text, sizeof c->text, "%.*e", DIGITS - 1, c->value);
        }
    }
}
