// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/chart_dependent.h"

#include "formulations/ground/flops.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// The dependent columns at one configuration: factor of J_d, basis, volume. Square J_d sparse,
// others by dense QR.

#define PIVOT_TOL 1e-13 // of the largest pivot: J_d is singular to rounding

static bool is_square(const hn_chart *chart) {
    return chart->nc == chart->rank;
}

static double smallest_of_qr(const hn_qr *qr, int rank) {
    double smallest = HUGE_VAL;
    for (int k = 0; k < rank; k++) {
        smallest = fmin(smallest, fabs(qr->a[k * qr->m + k]));
    }
    return smallest;
}

double hn_chart_smallest_pivot(const hn_chart *chart, const hn_chart_point *p) {
    return is_square(chart) ? hn_sparse_lu_smallest_pivot(p->lu)
                            : smallest_of_qr(&p->jd, chart->rank);
}

double hn_chart_log_volume(const hn_chart *chart, const hn_chart_point *p) {
    double sum = 0;
    if (is_square(chart)) {
        return hn_sparse_lu_log_volume(p->lu);
    }
    for (int k = 0; k < chart->rank; k++) {
        sum += log(fabs(p->jd.a[k * p->jd.m + k]));
    }
    return sum;
}

double hn_chart_volume(const hn_chart *chart) {
    if (chart->here.is_bare) {
        return chart->here.volume * chart->volume_unit;
    }
    return exp(hn_chart_log_volume(chart, &chart->here) - chart->volume_start);
}

void hn_chart_set_columns(hn_chart *chart) {
    // number the dependent columns
    for (int j = 0; j < chart->nv; j++) {
        chart->dep_at[j] = -1;
    }
    for (int k = 0; k < chart->rank; k++) {
        chart->dep_at[chart->dep[k]] = k;
    }

    // collect the entries of J in them
    int n = 0;
    for (int e = 0; e < chart->n_J; e++) {
        const int k = chart->dep_at[chart->J_col[e]];
        if (k >= 0) {
            chart->jd_entry[n] = e;
            chart->jd_row[n] = chart->J_row[e];
            chart->jd_col[n++] = k;
        }
    }
    chart->n_jd = n;

    if (is_square(chart)) {
        hn_sparse_lu_set_pattern(chart->here.lu, chart->rank, n, chart->jd_row, chart->jd_col);
        hn_sparse_lu_set_pattern(chart->probe.lu, chart->rank, n, chart->jd_row, chart->jd_col);
    }
}

static bool factor_sparse(hn_chart *chart, hn_chart_point *p) {
    for (int i = 0; i < chart->n_jd; i++) {
        const int e = chart->jd_entry[i];
        p->jd_values[i] = p->J[e] * chart->scale[chart->J_col[e]];
    }
    const hn_status status = hn_sparse_lu_factor(p->lu, p->jd_values);
    chart->cost.ops += hn_sparse_lu_factor_ops(p->lu) + chart->n_jd;
    p->sign = status == HN_OK ? hn_sparse_lu_sign(p->lu) : 0;
    return status == HN_OK;
}

static bool factor_dense(hn_chart *chart, hn_chart_point *p) {
    const int nc = chart->nc, rank = chart->rank;
    memset(p->jd.a, 0, (size_t)nc * (size_t)rank * sizeof *p->jd.a);
    for (int i = 0; i < chart->n_jd; i++) {
        const int e = chart->jd_entry[i];
        p->jd.a[chart->jd_col[i] * nc + chart->jd_row[i]] = p->J[e] * chart->scale[chart->J_col[e]];
    }
    hn_qr_factor(&p->jd, nc, rank, PIVOT_TOL);
    chart->cost.ops += hn_flops_qr(nc, rank);
    p->sign = 0;
    return p->jd.rank == rank;
}

static bool is_near_fold(const hn_chart *chart, const hn_chart_point *p) {
    return chart->rank > 0 &&
           !(hn_chart_smallest_pivot(chart, p) > HN_CHART_FOLD * chart->pivot_start);
}

// A pivot of the sparse factor may vanish because its order was chosen far away, where another
// entry was large: the chart has ended only where a pivot stays small in the order that suits this
// configuration.
static bool has_regular_order(hn_chart *chart, hn_chart_point *p) {
    if (!is_square(chart)) {
        return false;
    }
    hn_sparse_lu_set_pattern(p->lu, chart->rank, chart->n_jd, chart->jd_row, chart->jd_col);
    chart->cost.factorisations++;
    return factor_sparse(chart, p) && !is_near_fold(chart, p);
}

bool hn_chart_factor(hn_chart *chart, hn_chart_point *p) {
    memcpy(p->J, hn_eval_list(chart->loop, HN_TERM_J), (size_t)chart->n_J * sizeof *p->J);
    chart->cost.factorisations++;
    p->is_bare = false;
    if (!(is_square(chart) ? factor_sparse(chart, p) : factor_dense(chart, p))) {
        return false;
    }
    return !is_near_fold(chart, p) || has_regular_order(chart, p);
}

void hn_chart_solve_dependent(hn_chart *chart, const hn_chart_point *p, double *b, double *x) {
    chart->cost.solves++;
    if (is_square(chart)) {
        hn_sparse_lu_solve(p->lu, b, x);
        chart->cost.ops += hn_sparse_lu_solve_ops(p->lu);
        return;
    }
    hn_qr_apply_qt(&p->jd, b);
    hn_qr_solve_r(&p->jd, b);
    for (int k = 0; k < chart->rank; k++) {
        x[p->jd.perm[k]] = b[k];
    }
    chart->cost.ops += hn_flops_qr_solve(chart->nc, chart->rank);
}

void hn_chart_make_basis(hn_chart *chart, hn_chart_point *p) {
    const int nv = chart->nv, nc = chart->nc, rank = chart->rank, r = chart->r;
    double *b = chart->z, *x = chart->dq;

    // N: ones on the independent columns, -J_d^-1 J_i on the dependent ones
    memset(p->N, 0, (size_t)nv * (size_t)r * sizeof(double));
    for (int j = 0; j < r; j++) {
        p->N[chart->ind[j] * r + j] = 1;
        memset(b, 0, (size_t)nc * sizeof *b);
        for (int e = 0; e < chart->n_J; e++) {
            b[chart->J_row[e]] -= chart->J_col[e] == chart->ind[j] ? p->J[e] : 0;
        }
        hn_chart_solve_dependent(chart, p, b, x);
        for (int k = 0; k < rank; k++) {
            p->N[chart->dep[k] * r + j] = x[k] * chart->scale[chart->dep[k]];
        }
    }

    // s: the velocity that closures moving with time demand
    memset(p->s, 0, (size_t)nv * sizeof(double));
    const double *phi_t = hn_eval_get(chart->loop, HN_TERM_PHI_T);
    if (hn_norm_max(nc, phi_t) > 0) {
        for (int i = 0; i < nc; i++) {
            b[i] = -phi_t[i];
        }
        hn_chart_solve_dependent(chart, p, b, x);
        for (int k = 0; k < rank; k++) {
            p->s[chart->dep[k]] = x[k] * chart->scale[chart->dep[k]];
        }
    }
}

// by Cramer's rule the ratio of the two determinants is an entry of J_d^-1 J_i, and that is an
// entry of N
double hn_chart_exchange(const hn_chart *chart, const hn_chart_point *p, int k, int j) {
    const int dep = chart->dep[k], ind = chart->ind[j];
    return fabs(p->N[dep * chart->r + j]) * chart->scale[ind] / chart->scale[dep];
}
