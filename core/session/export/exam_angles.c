// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/exam_angles.h"

#include "dynamics/compile/compile.h"
#include "expr/diff.h"
#include "session/export/exam_changes.h"

#include <stdlib.h>
#include <string.h>

/// Coordinates of a scene that is tried: with more, the ways to count them are thousands.
enum { MOST_COORDINATES = 8 };

int hn_exam_angles_list(const hn_export_exam *exam, hn_exam_angles *out, int most) {
    int n = 0;
    if (!hn_exam_is_plain(exam) || exam->nq > MOST_COORDINATES) {
        return 0;
    }
    for (int first = 0; first < exam->nq; first++) {
        bool chain = true;
        for (int last = 0; last < exam->nq; last++) {
            const bool are_angles = hn_exam_is_angle(exam, first) && hn_exam_is_angle(exam, last);
            chain = chain && (last < first || hn_exam_is_angle(exam, last));
            for (int included = 0; included < 2 && are_angles && last != first; included++) {
                if (n < most) {
                    out[n++] = (hn_exam_angles){false, included, first, last};
                }
                // two angles are a chain of their own
                if (n < most && chain && last > first + 1) {
                    out[n++] = (hn_exam_angles){true, included, first, last};
                }
            }
        }
    }
    return n;
}

/// Writes the derivatives of the scene's coordinates by those of the other way, n x n row-major.
static void derivatives(const hn_exam_angles *a, int n, double *T) {
    memset(T, 0, (size_t)n * (size_t)n * sizeof *T);
    for (int i = 0; i < n; i++) {
        T[i * n + i] = 1;
        for (int j = a->first; a->chain && i > a->first && i <= a->last && j < i; j++) {
            T[i * n + j] = !a->included ? 1 : j == i - 1 ? -1 : 0;
        }
    }
    if (!a->chain) {
        T[a->last * n + a->first] = a->included ? -1 : 1;
    }
}

/// Replaces the values of symbols by T times them.
static void count_otherwise(const int *symbols, int n, const double *T, double *x) {
    double value[MOST_COORDINATES];
    for (int i = 0; i < n; i++) {
        value[i] = x[symbols[i]];
    }
    for (int i = 0; i < n; i++) {
        double sum = 0;
        for (int j = 0; j < n; j++) {
            sum += T[i * n + j] * value[j];
        }
        x[symbols[i]] = sum;
    }
}

/// Replaces A, rows x n, by A T.
static void times(double *A, int rows, int n, const double *T) {
    for (int r = 0; r < rows; r++) {
        double row[MOST_COORDINATES];
        memcpy(row, A + r * n, (size_t)n * sizeof *row);
        for (int j = 0; j < n; j++) {
            double sum = 0;
            for (int i = 0; i < n; i++) {
                sum += row[i] * T[i * n + j];
            }
            A[r * n + j] = sum;
        }
    }
}

/// Replaces A, n x columns, by T' A.
static void transposed_times(double *A, int n, int columns, const double *T) {
    for (int c = 0; c < columns; c++) {
        double column[MOST_COORDINATES];
        for (int i = 0; i < n; i++) {
            column[i] = A[i * columns + c];
        }
        for (int j = 0; j < n; j++) {
            double sum = 0;
            for (int i = 0; i < n; i++) {
                sum += column[i] * T[i * n + j];
            }
            A[j * columns + c] = sum;
        }
    }
}

hn_status hn_exam_angles_apply(const hn_export_exam *exam, hn_export_part part,
                               const hn_exam_angles *angles, int k, double *out) {
    hn_graph *g = hn_system_graph(exam->e.sys);
    const hn_ex *entry = hn_export_exam_entry(exam, part);
    const int n = exam->nv;
    double T[MOST_COORDINATES * MOST_COORDINATES];
    double *x = calloc((size_t)hn_graph_n_symbols(g) + 1, sizeof *x);
    if (!x) {
        return HN_ERR_MEMORY;
    }

    derivatives(angles, n, T);
    hn_export_exam_symbols(exam, k, x);
    count_otherwise(exam->e.x.q_symbols, n, T, x);
    count_otherwise(exam->e.x.v_symbols, n, T, x);
    for (int i = 0; i < exam->size[part]; i++) {
        out[i] = hn_graph_eval(g, entry[i], x);
    }
    free(x);

    if (part == HN_EXPORT_MASS || part == HN_EXPORT_JACOBIAN) {
        times(out, exam->size[part] / n, n, T);
    }
    if (part == HN_EXPORT_MASS || part == HN_EXPORT_FORCE) {
        transposed_times(out, n, exam->size[part] / n, T);
    }
    return hn_graph_failed(g) ? HN_ERR_MEMORY : HN_OK;
}

const char *hn_exam_coordinate_name(const hn_export_exam *exam, int i) {
    return hn_exam_symbol_name(exam, exam->e.x.q_symbols[i]);
}
