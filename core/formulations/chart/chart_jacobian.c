// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/chart_jacobian.h"

#include "linalg/dense.h"

#include <stdio.h>
#include <string.h>

hn_status hn_chart_jacobian_prepare(hn_chart_jacobian *c, const hn_chart *chart, hn_arena *arena) {
    const hn_accel_law carrying = {1, 1, 0}; // V of (1) is among its terms
    const size_t nv = (size_t)chart->nv;
    if (c->slopes) {
        return HN_OK;
    }
    c->dx = hn_arena_doubles(arena, nv);
    c->dv = hn_arena_doubles(arena, nv);
    c->da = hn_arena_doubles(arena, nv);
    c->du = hn_arena_doubles(arena, nv);
    c->du_dot = hn_arena_doubles(arena, nv);
    c->rows = hn_arena_doubles(arena, (size_t)chart->nc);
    const hn_status status = hn_accel_jacobian_create(chart->sys, &carrying, arena, &c->slopes);
    return status == HN_OK && hn_arena_failed(arena) ? HN_ERR_MEMORY : status;
}

hn_status hn_chart_jacobian_at(hn_chart_jacobian *c, hn_chart *chart, hn_arena *arena,
                               const double *v) {
    const hn_accel_law law = {0};
    const hn_chart_point *p = &chart->here;
    hn_status status = hn_chart_jacobian_prepare(c, chart, arena);
    HN_THEN(status, hn_accel_jacobian_at(c->slopes, p->t, p->q, v, &law));
    HN_THEN(status, hn_accel_jacobian_prepare(c->slopes));
    if (status != HN_OK) {
        snprintf(chart->why, sizeof chart->why,
                 "derivatives of the accelerations at t = %.6g s: %s", p->t,
                 hn_status_text(status));
    }
    return status;
}

void hn_chart_jacobian_free(hn_chart_jacobian *c) {
    hn_accel_jacobian_free(c->slopes);
    c->slopes = NULL;
}

/// (1) for dx (nv, NULL: zero) and du (r, NULL: zero): c->dv, and du_dot (r).
static void move_along(hn_chart_jacobian *c, hn_chart *chart, const double *dx, const double *du,
                       double *du_dot) {
    const int nv = chart->nv, r = chart->r;
    const hn_chart_point *p = &chart->here;

    // the change of v along dx at fixed u
    memset(c->dv, 0, (size_t)nv * sizeof *c->dv);
    if (dx) {
        hn_accel_jacobian_carry(c->slopes, dx, c->rows);
        for (int i = 0; i < chart->nc; i++) {
            c->rows[i] = -c->rows[i];
        }
        hn_chart_solve_dependent(chart, p, c->rows, chart->dq);
        for (int k = 0; k < chart->rank; k++) {
            c->dv[chart->dep[k]] = chart->dq[k] * chart->scale[chart->dep[k]];
        }
    }

    // plus N du
    for (int i = 0; i < nv && du; i++) {
        c->dv[i] += hn_dot(r, p->N + (size_t)i * (size_t)r, du);
    }

    // the change of the accelerations, read off the independent coordinates
    hn_accel_jacobian_along(c->slopes, dx, c->dv, c->da);
    for (int i = 0; i < r; i++) {
        du_dot[i] = c->da[chart->ind[i]];
    }
}

static void put_column(double *jac, int n, int first, int rows, int col, const double *x) {
    for (int i = 0; i < rows; i++) {
        jac[(size_t)(first + i) * (size_t)n + (size_t)col] = x[i];
    }
}

void hn_chart_jacobian_minimal(hn_chart_jacobian *c, hn_chart *chart, double *jac) {
    const int r = chart->r, n = 2 * r;
    double *du = c->du, *du_dot = c->du_dot;
    memset(jac, 0, (size_t)n * (size_t)n * sizeof *jac);
    for (int j = 0; j < r; j++) {
        jac[j * n + r + j] = 1;
        for (int i = 0; i < chart->nv; i++) {
            c->dx[i] = chart->here.N[i * r + j];
        }
        move_along(c, chart, c->dx, NULL, du_dot);
        put_column(jac, n, r, r, j, du_dot);
        memset(du, 0, (size_t)r * sizeof *du);
        du[j] = 1;
        move_along(c, chart, NULL, du, du_dot);
        put_column(jac, n, r, r, r + j, du_dot);
    }
}

void hn_chart_jacobian_speeds(hn_chart_jacobian *c, hn_chart *chart, double *jac) {
    const int nv = chart->nv, r = chart->r, n = nv + r;
    double *du = c->du, *du_dot = c->du_dot;
    HN_ASSERT(chart->nq == nv);
    memset(jac, 0, (size_t)n * (size_t)n * sizeof *jac);
    for (int j = 0; j < n; j++) {
        memset(c->dx, 0, (size_t)nv * sizeof *c->dx);
        memset(du, 0, (size_t)r * sizeof *du);
        *(j < nv ? &c->dx[j] : &du[j - nv]) = 1;
        move_along(c, chart, j < nv ? c->dx : NULL, j < nv ? NULL : du, du_dot);
        put_column(jac, n, 0, nv, j, c->dv);
        put_column(jac, n, nv, r, j, du_dot);
    }
}

void hn_chart_jacobian_add_cost(const hn_chart_jacobian *c, hn_cost *cost) {
    if (c->slopes) {
        cost->evals += hn_accel_jacobian_evals(c->slopes);
        cost->ops += hn_accel_jacobian_ops(c->slopes);
    }
}
