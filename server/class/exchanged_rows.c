// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/exchanged_rows.h"

#include <math.h>
#include <stdio.h>

/// Returns whether entry (i, j) that was given is the right entry (r, c), at every state.
static bool is_entry(const hn_two_matrices *m, int i, int j, int r, int c) {
    const int size = m->rows * m->columns;
    for (int k = 0; k < m->states; k++) {
        const double given = m->given[k * size + i * m->columns + j];
        const double right = m->right[k * size + r * m->columns + c];
        if (!(fabs(given - right) <= m->allowed)) {
            return false;
        }
    }
    return true;
}

/// Returns whether line i that was given, a row or a column, is the right line k.
static bool is_line(const hn_two_matrices *m, bool rows, int i, int k) {
    const int n = rows ? m->columns : m->rows;
    for (int j = 0; j < n; j++) {
        if (rows ? !is_entry(m, i, j, k, j) : !is_entry(m, j, i, j, k)) {
            return false;
        }
    }
    return true;
}

/// Returns whether another wrong line is the right line i.
static bool is_given_elsewhere(const hn_two_matrices *m, bool rows, int n, int i, int *where) {
    for (int k = 0; k < n; k++) {
        if (k != i && is_line(m, rows, k, i) && !is_line(m, rows, k, k)) {
            *where = k;
            return true;
        }
    }
    return false;
}

static bool find_lines(const hn_two_matrices *m, bool rows, int first, char out[96]) {
    const int n = rows ? m->rows : m->columns;
    const char *lines = m->columns == 1 ? "entries" : rows ? "rows" : "columns";
    int wrong = 0, from = -1, to = -1;
    for (int i = 0; i < n; i++) {
        int where = i;
        if (is_line(m, rows, i, i)) {
            continue;
        }
        if (!is_given_elsewhere(m, rows, n, i, &where)) {
            return false;
        }
        wrong++;
        from = from < 0 ? i : from;
        to = where > to ? where : to;
    }
    if (wrong == 2) {
        snprintf(out, 96, "%s %d and %d are exchanged", lines, from + first, to + first);
    } else {
        snprintf(out, 96, "the %s stand in another order", lines);
    }
    return wrong > 1;
}

/// Returns where i goes when a and b are exchanged.
static int exchange(int i, int a, int b) {
    return i == a ? b : i == b ? a : i;
}

static bool are_exchanged(const hn_two_matrices *m, int a, int b) {
    for (int i = 0; i < m->rows; i++) {
        for (int j = 0; j < m->columns; j++) {
            if (!is_entry(m, i, j, exchange(i, a, b), exchange(j, a, b))) {
                return false;
            }
        }
    }
    return true;
}

/// Two coordinates exchanged in a square matrix.
static bool find_both(const hn_two_matrices *m, int first, char out[96]) {
    for (int a = 0; a < m->rows && m->rows == m->columns; a++) {
        for (int b = a + 1; b < m->rows; b++) {
            if (are_exchanged(m, a, b)) {
                snprintf(out, 96, "rows and columns %d and %d are exchanged", a + first, b + first);
                return true;
            }
        }
    }
    return false;
}

bool hn_exchanged_rows_find(const hn_two_matrices *m, int first, char out[96]) {
    return find_lines(m, true, first, out) ||
           (m->columns > 1 && (find_lines(m, false, first, out) || find_both(m, first, out)));
}
