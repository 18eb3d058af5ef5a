// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/table.h"

#include "cli/shell/column_unit.h"
#include "cli/shell/fold.h"
#include "terminal/width.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// [columns] between two; of a folded column of words; of one that is PROSE wide or more
enum { BETWEEN = 2, LEAST_WORDS = 12, PROSE = 60, LEAST_PROSE = 28 };

void hn_table_init(hn_table *t) {
    *t = (hn_table){.width = hn_terminal_limit(), .colours = hn_terminal_colours()};
}

void hn_table_reset(hn_table *t) {
    free(t->cells);
    *t = (hn_table){0};
}

void hn_table_column(hn_table *t, const char *head, int to_right) {
    HN_ASSERT(t->n_columns < HN_TABLE_COLUMNS && t->n_cells == 0);
    t->heads[t->n_columns] = head;
    t->to_right[t->n_columns] = to_right;
    t->spare[t->n_columns] =
        t->n_columns > 1 ? (to_right ? 1 : 2) * HN_TABLE_COLUMNS - t->n_columns : 0;
    t->n_columns++;
}

void hn_table_spare(hn_table *t, int order) {
    t->spare[t->n_columns - 1] = order;
}

/// An ellipsis at the end of what did not fit, between two characters.
static void mark_cut(char cell[HN_TABLE_CELL]) {
    static const char ELLIPSIS[] = "\xe2\x80\xa6";
    size_t n = HN_TABLE_CELL - sizeof ELLIPSIS;
    while (n > 0 && ((unsigned char)cell[n] & 0xc0) == 0x80) {
        n--;
    }
    memcpy(cell + n, ELLIPSIS, sizeof ELLIPSIS);
}

/// Returns the next cell, empty; NULL: no memory.
static hn_table_item *add_item(hn_table *t) {
    if (t->n_cells == t->cap) {
        const int cap = t->cap ? 2 * t->cap : 64;
        hn_table_item *larger = realloc(t->cells, (size_t)cap * sizeof *larger);
        if (!larger) {
            t->failed = 1;
            return NULL;
        }
        t->cells = larger;
        t->cap = cap;
    }
    hn_table_item *item = &t->cells[t->n_cells++];
    item->text[0] = item->unit[0] = '\0';
    item->value = 0;
    item->is_quantity = item->is_bad = false;
    return item;
}

void hn_table_cell(hn_table *t, const char *format, ...) {
    hn_table_item *item = add_item(t);
    if (!item) {
        return;
    }
    va_list args;
    va_start(args, format);
    if (vsnprintf(item->text, HN_TABLE_CELL, format, args) >= HN_TABLE_CELL) {
        mark_cut(item->text);
    }
    va_end(args);
}

void hn_table_quantity(hn_table *t, double value, const char *unit) {
    hn_table_item *item = add_item(t);
    if (item) {
        item->value = value;
        item->is_quantity = true;
        snprintf(item->unit, sizeof item->unit, "%s", unit);
    }
}

void hn_table_bad(hn_table *t) {
    if (t->n_cells > 0) {
        t->cells[t->n_cells - 1].is_bad = true;
    }
}

// ---- the layout ----

typedef struct layout {
    char heads[HN_TABLE_COLUMNS][HN_TABLE_CELL];
    int width[HN_TABLE_COLUMNS];  ///< 0: the column is left out
    int before[HN_TABLE_COLUMNS]; ///< widest part before the decimal point, of numbers
} layout;

static int width_of(const char *text) {
    return hn_fold_width(text, strlen(text));
}

/// Columns before the decimal point; those of a number without one, or of a text, are all of it.
static int before_point(const char *text) {
    size_t n = text[0] == '-' || text[0] == '<' ? 1 : 0;
    n += strspn(text + n, " ");
    const size_t digits = strspn(text + n, "0123456789");
    return digits > 0 ? (int)(n + digits) : width_of(text);
}

static int longest_word(const char *text) {
    int longest = 0;
    while (*text) {
        const size_t n = strcspn(text, " ");
        const int width = hn_fold_width(text, n);
        longest = width > longest ? width : longest;
        text += n + (text[n] == ' ');
    }
    return longest;
}

static int larger(int a, int b) {
    return a > b ? a : b;
}

static void measure_column(const hn_table *t, layout *l, int c) {
    int before = 0, after = 0, whole = width_of(l->heads[c]);
    for (int i = c; i < t->n_cells; i += t->n_columns) {
        const char *text = t->cells[i].text;
        before = larger(before, before_point(text));
        after = larger(after, width_of(text) - before_point(text));
        whole = larger(whole, width_of(text));
    }
    l->before[c] = before;
    l->width[c] = t->to_right[c] ? larger(whole, before + after) : whole;
}

static int total_width(const hn_table *t, const layout *l) {
    int total = -BETWEEN;
    for (int c = 0; c < t->n_columns; c++) {
        total += l->width[c] > 0 ? l->width[c] + BETWEEN : 0;
    }
    return total;
}

/// The narrowest that a column of words can be folded to.
static int least_width(const hn_table *t, const layout *l, int c) {
    int least = larger(LEAST_WORDS, longest_word(l->heads[c])), whole = 0;
    for (int i = c; i < t->n_cells; i += t->n_columns) {
        least = larger(least, longest_word(t->cells[i].text));
        whole = larger(whole, width_of(t->cells[i].text));
    }
    return whole >= PROSE ? larger(least, LEAST_PROSE) : least;
}

/// Narrows the widest columns of words until the table fits. Returns how much is missing still.
static int fold_words(const hn_table *t, layout *l) {
    int missing = total_width(t, l) - t->width;
    while (missing > 0) {
        int widest = -1;
        for (int c = 0; c < t->n_columns; c++) {
            if (!t->to_right[c] && l->width[c] > least_width(t, l, c) &&
                (widest < 0 || l->width[c] > l->width[widest])) {
                widest = c;
            }
        }
        if (widest < 0) {
            break;
        }
        l->width[widest]--;
        missing--;
    }
    return missing;
}

/// Lays the table out within its width: words are folded, then columns left out.
static void fit(const hn_table *t, layout *l) {
    for (;;) {
        layout folded = *l;
        if (t->width == 0 || fold_words(t, &folded) <= 0) {
            *l = t->width == 0 ? *l : folded;
            return;
        }
        int first = -1;
        for (int c = 0; c < t->n_columns; c++) {
            if (t->spare[c] > 0 && l->width[c] > 0 &&
                (first < 0 || t->spare[c] < t->spare[first])) {
                first = c;
            }
        }
        if (first < 0) {
            *l = folded;
            return;
        }
        l->width[first] = 0;
    }
}

// ---- the text ----

static void write_part(hn_strbuf *b, const char *text, size_t n, int before, int width) {
    const int room = width - hn_fold_width(text, n);
    const int left = before > room ? room : before;
    hn_strbuf_printf(b, "%*s%.*s", left > 0 ? left : 0, "", (int)n, text);
    if (room - left > 0) {
        hn_strbuf_printf(b, "%*s", room - left, "");
    }
}

/// Blanks at the end of a line are nobody's.
static void end_line(hn_strbuf *b) {
    while (b->n > 0 && b->text[b->n - 1] == ' ') {
        b->text[--b->n] = '\0';
    }
    hn_strbuf_add(b, "\n");
}

/// Columns of blanks before a cell: numbers stand at the point, words at the left.
static int indent_of(const hn_table *t, const layout *l, int c, const char *text, bool head) {
    if (!t->to_right[c]) {
        return 0;
    }
    const int right = l->width[c] - width_of(text);
    if (head) {
        return right;
    }
    // numbers lie against the right edge as a block
    int block = 0;
    for (int i = c; i < t->n_cells; i += t->n_columns) {
        const char *cell = t->cells[i].text;
        block = larger(block, width_of(cell) - before_point(cell));
    }
    const int indent = l->width[c] - block - before_point(text);
    return indent < 0 || indent > right ? right : indent;
}

/// One row: as many lines as its highest cell has.
static void write_row(hn_strbuf *b, const hn_table *t, const layout *l, const char *const *text,
                      const bool *bad, bool head) {
    const char *rest[HN_TABLE_COLUMNS];
    bool more = true;
    memcpy(rest, text, sizeof rest);

    // a line at a time, until no cell has text left
    while (more) {
        more = false;
        bool first = true;
        for (int c = 0; c < t->n_columns; c++) {
            if (l->width[c] == 0) {
                continue;
            }

            // as much of the cell as fits its column
            const size_t n = t->to_right[c] ? strlen(rest[c]) : hn_fold_line(rest[c], l->width[c]);
            const bool coloured = t->colours && n > 0 && (head || bad[c]);
            hn_strbuf_printf(b, "%s", first ? "" : "  ");
            hn_strbuf_add(b, !coloured ? "" : head ? "\033[1m" : "\033[31m");
            write_part(b, rest[c], n, indent_of(t, l, c, rest[c], head), l->width[c]);
            hn_strbuf_add(b, coloured ? "\033[0m" : "");
            rest[c] += n;
            rest[c] += strspn(rest[c], " \n");
            more |= rest[c][0] != '\0';
            first = false;
        }
        end_line(b);
    }
}

/// "left out at 80 columns: evals, ops (--wide shows them)"
static void name_left_out(hn_strbuf *b, hn_table *t, const layout *l) {
    hn_strbuf line;
    int n = 0;
    hn_strbuf_init(&line);
    for (int c = 0; c < t->n_columns; c++) {
        if (l->width[c] == 0 && t->heads[c][0]) {
            hn_strbuf_printf(&line, n++ ? ", %s" : "%s", t->heads[c]);
        }
    }
    t->n_left_out = n;
    if (n > 0) {
        hn_strbuf whole;
        hn_strbuf_init(&whole);
        hn_strbuf_printf(&whole, "not shown in %d columns: %s (--wide shows %s)\n", t->width,
                         hn_strbuf_text(&line), n > 1 ? "them" : "it");
        hn_fold_add(b, hn_strbuf_text(&whole), t->width);
        hn_strbuf_reset(&whole);
    }
    hn_strbuf_reset(&line);
}

void hn_table_write(hn_strbuf *b, hn_table *t) {
    static const bool nothing_bad[HN_TABLE_COLUMNS] = {false};
    const char *text[HN_TABLE_COLUMNS] = {NULL};
    layout l = {0};

    // numbers become texts, heads take their units
    for (int c = 0; c < t->n_columns; c++) {
        char unit[HN_TABLE_UNIT];
        hn_column_unit(t->cells, c, t->n_columns, t->n_cells, unit);
        snprintf(l.heads[c], sizeof l.heads[c], "%.300s%s", t->heads[c], unit);
        text[c] = l.heads[c];
        measure_column(t, &l, c);
    }
    fit(t, &l);

    // the head, then row by row
    write_row(b, t, &l, text, nothing_bad, true);
    for (int i = 0; i + t->n_columns <= t->n_cells; i += t->n_columns) {
        bool bad[HN_TABLE_COLUMNS];
        for (int c = 0; c < t->n_columns; c++) {
            text[c] = t->cells[i + c].text;
            bad[c] = t->cells[i + c].is_bad;
        }
        write_row(b, t, &l, text, bad, false);
    }
    name_left_out(b, t, &l);
    b->failed |= t->failed;
}
