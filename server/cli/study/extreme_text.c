// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/extreme_text.h"

#include "session/extreme/extreme_verdict.h"
#include "terminal/width.h"

#include <stdio.h>
#include <string.h>

// [columns] of the table without a limit; with one, the first three share what the verdict leaves
enum { WHAT = 58, PREDICTED = 32, OBSERVED = 40, VERDICT = 20, BETWEEN = 2 };

/// Returns how many bytes of text fit into the columns, broken at a blank where there is one.
static size_t fit(const char *text, int columns) {
    size_t n = 0, blank = 0;
    for (int used = 0; text[n] && used < columns; used++) {
        blank = text[n] == ' ' ? n : blank;
        n++;
        while ((text[n] & 0xC0) == 0x80) {
            n++;
        }
    }
    return !text[n] || blank == 0 ? n : blank;
}

static int columns_of(const char *text, size_t n) {
    int columns = 0;
    for (size_t i = 0; i < n; i++) {
        columns += (text[i] & 0xC0) != 0x80;
    }
    return columns;
}

/// Writes the part of *text that fits, padded, and advances *text past it.
static void put_part(hn_strbuf *b, const char **text, int columns) {
    const size_t n = fit(*text, columns);
    hn_strbuf_printf(b, "%.*s%*s", (int)n, *text, columns - columns_of(*text, n) + 2, "");
    *text += n;
    *text += strspn(*text, " ");
}

/// The share of a column in a line of the terminal.
static int width_of(int columns) {
    const int limit = hn_terminal_limit(), whole = WHAT + PREDICTED + OBSERVED;
    const int room = limit - VERDICT - 4 * BETWEEN;
    return limit > 0 && room < whole ? columns * room / whole : columns;
}

static void put_row(hn_strbuf *b, const char *what, const char *predicted, const char *observed,
                    const char *verdict) {
    do {
        hn_strbuf_add(b, "  ");
        put_part(b, &what, width_of(WHAT));
        put_part(b, &predicted, width_of(PREDICTED));
        put_part(b, &observed, width_of(OBSERVED));
        hn_strbuf_add(b, verdict);
        verdict = "";
        while (b->n > 0 && b->text[b->n - 1] == ' ') {
            b->text[--b->n] = 0;
        }
        hn_strbuf_add(b, "\n");
    } while (*what || *predicted || *observed);
}

static void put_case(hn_strbuf *b, const hn_extreme_case *c) {
    hn_strbuf_printf(b, "%-4s %s (%s)\n", c->id, c->title, hn_extreme_verdict_name(c->verdict));
    for (int k = 0; k < c->n_trials; k++) {
        const hn_extreme_trial *t = &c->trials[k];
        put_row(b, t->what, t->expect.text, t->observed, hn_extreme_verdict_name(t->verdict));
        if (t->expect.was) {
            hn_strbuf_printf(b, "    corrected; before: %s\n", t->expect.was);
        }
        for (int i = 0; i < t->n_seen && t->verdict != HN_EXTREME_PASS && t->n_seen > 1; i++) {
            const hn_extreme_seen *s = &t->seen[i];
            hn_strbuf_printf(b, "    %s on %s: ", s->method, s->scene);
            if (t->expect.word) {
                hn_strbuf_printf(b, "%s %s\n", s->word, s->reason);
            } else {
                hn_strbuf_printf(b, "%.6g %s\n", s->value, s->reason);
            }
        }
    }
    hn_strbuf_add(b, "\n");
}

void hn_extreme_text(hn_strbuf *b, const hn_extreme *x) {
    put_row(b, "what", "predicted", "observed", "verdict");
    hn_strbuf_add(b, "\n");
    for (int i = 0; i < x->n_cases; i++) {
        put_case(b, &x->cases[i]);
    }
    if (hn_extreme_count(x, HN_EXTREME_WARN) > 0) {
        hn_strbuf_add(b, "warn: the figure is a little beyond what was predicted\n");
    }
    if (hn_extreme_count(x, HN_EXTREME_LONG) > 0) {
        hn_strbuf_add(b, "needs --long: not run, because it takes minutes; --long runs it too\n");
    }
    for (int v = 0, first = 1; v < HN_EXTREME_VERDICTS; v++) {
        const hn_extreme_verdict verdict = (hn_extreme_verdict)v;
        const int n = hn_extreme_count(x, verdict);
        if (n > 0) {
            hn_strbuf_printf(b, "%s%d %s", first ? "" : ", ", n, hn_extreme_verdict_name(verdict));
            first = 0;
        }
    }
    hn_strbuf_printf(b, "; %d case%s\n", x->n_cases, x->n_cases == 1 ? "" : "s");
}
