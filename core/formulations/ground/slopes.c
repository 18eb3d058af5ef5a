// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/slopes.h"

// ---- products with the terms ----

void hn_slopes_add_term(const hn_accel_jacobian *j, hn_linear_term term, double k, const double *x,
                        double *out) {
    const double *list = hn_linear_list(j->terms, term);
    const int *rows, *cols, n = hn_linear_pattern(j->terms, term, &rows, &cols);
    for (int e = 0; e < n; e++) {
        out[rows[e]] += k * list[e] * x[cols[e]];
    }
}

// out (nc) -= B_q x
void hn_slopes_subtract_by_position(const hn_accel_jacobian *j, const double *x, double *out) {
    const int *rows, *cols, n = hn_linear_pattern(j->twist, HN_LINEAR_V, &rows, &cols);
    for (int e = 0; e < n; e++) {
        out[rows[e]] -= j->twisted[e] * x[cols[e]];
    }
    hn_slopes_add_term(j, HN_LINEAR_GAMMA_Q, -1, x, out);
    if (j->stabilised) {
        hn_slopes_add_term(j, HN_LINEAR_V, -2 * j->law.alpha, x, out);
        hn_slopes_add_term(j, HN_LINEAR_J, -j->law.beta * j->law.beta, x, out);
    }
}

void hn_slopes_pack(hn_accel_jacobian *j, int parts, int part, const double *top,
                    const double *rows) {
    for (int i = 0; i < j->nv; i++) {
        j->packed[parts * i + part] = top[i];
    }
    for (int k = 0; k < j->n_kept; k++) {
        double value = 0;
        for (int i = 0; i < j->nc && j->combined; i++) {
            value += j->W[i * j->n_kept + k] * rows[i];
        }
        j->packed[parts * (j->nv + k) + part] = j->combined ? value : rows[j->kept[k]];
    }
}

// ---- entries of the matrices ----

void hn_slopes_put_entry(const hn_accel_jacobian *j, const hn_slopes_target *at, int row, int col,
                         hn_complex e) {
    if (!at->by_row) {
        hn_newton_matrix_put(at->to, row, col, e.re, e.im);
        return;
    }
    for (int k = 0; k < j->n_kept && j->combined; k++) {
        const double w = j->W[row * j->n_kept + k];
        hn_newton_matrix_put(at->to, at->rows_from + k, col, w * e.re, w * e.im);
    }
    if (!j->combined && j->place[row] >= 0) {
        hn_newton_matrix_put(at->to, at->rows_from + j->place[row], col, e.re, e.im);
    }
}

// k X, the columns of X along the speeds
void hn_slopes_put_term(const hn_accel_jacobian *j, const hn_slopes_target *at, hn_linear_term term,
                        hn_complex k) {
    const double *list = hn_linear_list(j->terms, term);
    const int *rows, *cols, n = hn_linear_pattern(j->terms, term, &rows, &cols);
    for (int e = 0; e < n; e++) {
        const double x = list[e];
        hn_slopes_put_entry(j, at, rows[e], cols[e], (hn_complex){x * k.re, x * k.im});
    }
}

// what (2) and (3) have in common
void hn_slopes_put_saddle(const hn_accel_jacobian *j, hn_newton_matrix *to) {
    const hn_complex one = {1, 0};
    const double *J = hn_linear_list(j->terms, HN_LINEAR_J);
    const int *rows, *cols, n = hn_linear_pattern(j->terms, HN_LINEAR_J, &rows, &cols);
    hn_newton_matrix_begin(to, j->nv + j->n_kept);
    hn_slopes_put_term(j, &(hn_slopes_target){to, 0, 0}, HN_LINEAR_M, one);
    hn_slopes_put_term(j, &(hn_slopes_target){to, j->nv, 1}, HN_LINEAR_J, one);
    for (int e = 0; e < n; e++) {
        const int place = j->place[rows[e]];
        const double x = J[e];
        for (int k = 0; k < j->n_kept && j->combined; k++) {
            hn_newton_matrix_put(to, cols[e], j->nv + k, -x * j->W[rows[e] * j->n_kept + k], 0);
        }
        if (!j->combined && place >= 0) {
            hn_newton_matrix_put(to, cols[e], j->nv + place, -x, 0);
        }
    }
    for (int k = 0; k < j->n_kept && j->gives; k++) {
        hn_newton_matrix_put(to, j->nv + k, j->nv + k, j->law.give, 0);
    }
}
