// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/diag.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { NAME_MAX_COMPARED = 64 };

/// Ends a text that did not fit in "...", never inside a UTF-8 sequence.
static void mark_cut(char *text, size_t cap) {
    size_t end = cap - sizeof "...";
    while (end > 0 && ((unsigned char)text[end] & 0xc0) == 0x80) {
        end--;
    }
    memcpy(text + end, "...", sizeof "...");
}

static void copy_text(char *out, size_t cap, const char *text) {
    const int n = snprintf(out, cap, "%s", text != NULL ? text : "");
    if (n >= 0 && (size_t)n >= cap) {
        mark_cut(out, cap);
    }
}

static void fill(hn_diag *d, hn_status status, const char *pointer, const char *hint,
                 const char *format, va_list args) {
    memset(d, 0, sizeof *d);
    d->status = status;
    copy_text(d->pointer, sizeof d->pointer, pointer);
    copy_text(d->hint, sizeof d->hint, hint);
    const int n = vsnprintf(d->message, sizeof d->message, format, args);
    if (n >= 0 && (size_t)n >= sizeof d->message) {
        mark_cut(d->message, sizeof d->message);
    }
}

hn_status hn_diags_add(hn_diags *d, hn_status status, const char *pointer, const char *hint,
                       const char *format, ...) {
    if (d == NULL) {
        return status;
    }
    d->found++;
    if (d->n < HN_DIAG_MAX) {
        va_list args;
        va_start(args, format);
        fill(&d->item[d->n], status, pointer, hint, format, args);
        va_end(args);
        d->n++;
    }
    return status;
}

hn_status hn_diag_set(hn_diag *d, hn_status status, const char *pointer, const char *hint,
                      const char *format, ...) {
    if (d != NULL) {
        va_list args;
        va_start(args, format);
        fill(d, status, pointer, hint, format, args);
        va_end(args);
    }
    return status;
}

void hn_diags_name_file(hn_diags *d, int from, const char *file) {
    for (int i = from; d != NULL && i < d->n; i++) {
        hn_diag *item = &d->item[i];
        const hn_diag old = *item;
        if (strstr(old.message, file) == NULL) {
            hn_diag_set(item, old.status, old.pointer, old.hint, "%.200s: %s", file, old.message);
            item->column = old.column;
        }
    }
}

static int lower(char c) {
    return tolower((unsigned char)c);
}

static int min_int(int a, int b) {
    return a < b ? a : b;
}

/// Optimal string alignment distance (Damerau-Levenshtein without overlapping transpositions), case
/// ignored; three rows suffice. Both lengths are at most NAME_MAX_COMPARED.
static int edit_distance(const char *a, int na, const char *b, int nb) {
    int rows[3][NAME_MAX_COMPARED + 1];
    int *before = rows[0], *last = rows[1], *now = rows[2];
    for (int j = 0; j <= nb; j++) {
        last[j] = j;
    }

    // row by row: substitute, insert, delete, transpose
    for (int i = 1; i <= na; i++) {
        now[0] = i;
        for (int j = 1; j <= nb; j++) {
            const int differs = lower(a[i - 1]) != lower(b[j - 1]);
            now[j] = min_int(last[j - 1] + differs, 1 + min_int(last[j], now[j - 1]));
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                lower(a[i - 2]) == lower(b[j - 1])) {
                now[j] = min_int(now[j], before[j - 2] + 1);
            }
        }

        // rotate the three rows
        int *spare = before;
        before = last;
        last = now;
        now = spare;
    }
    return last[nb];
}

/// The first name that the word is a part of, where it is long enough to mean something: 'stewart'
/// is 'stewart-6-3'.
static const char *first_that_holds(const char *word, size_t length, const char *const *names,
                                    int n) {
    for (int i = 0; length >= 4 && i < n; i++) {
        if (strstr(names[i], word)) {
            return names[i];
        }
    }
    return NULL;
}

const char *hn_nearest_name(const char *word, const char *const *names, int n) {
    HN_ASSERT(word != NULL && (names != NULL || n == 0));
    const size_t length = strlen(word);
    if (length == 0 || length > NAME_MAX_COMPARED) {
        return NULL;
    }

    // a short word may have one wrong letter, a long one a third of them; a letter alone is none's
    const int allowed = length < 2 ? 0 : length < 6 ? 1 : (int)length / 3;
    const char *best = NULL;
    int best_distance = allowed + 1;

    // the nearest; the first of several
    for (int i = 0; i < n; i++) {
        const size_t m = strlen(names[i]);
        if (m > NAME_MAX_COMPARED) {
            continue;
        }
        const int distance = edit_distance(word, (int)length, names[i], (int)m);
        if (distance < best_distance) {
            best_distance = distance;
            best = names[i];
        }
    }

    return best ? best : first_that_holds(word, length, names, n);
}
