// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/chart.h"

#include "dynamics/compile/coordinates.h"
#include "formulations/ground/flops.h"
#include "formulations/ground/reduced_mass.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NEWTON = 25 };
static const double STRAIGHT = 0.5; // a basis that changes by less of its size has gone on smoothly
static const double FLOOR = 1e-11;  // ||phi|| / length: what rounding can leave open, generously

static bool init_point(const hn_chart *chart, hn_chart_point *p, int with_factor, hn_arena *arena) {
    const size_t nv = (size_t)chart->nv;
    p->q = hn_arena_doubles(arena, (size_t)chart->nq);
    p->N = hn_arena_doubles(arena, nv * nv);
    p->s = hn_arena_doubles(arena, nv);
    if (!with_factor) {
        return true;
    }
    p->J = hn_arena_doubles(arena, (size_t)chart->n_J);
    p->jd_values = hn_arena_doubles(arena, (size_t)chart->n_J);
    p->lu = hn_sparse_lu_create(arena, chart->nc, chart->n_J);
    return p->lu && hn_qr_init(&p->jd, arena, chart->nc, chart->nv);
}

static bool init_memory(hn_chart *chart, hn_arena *arena) {
    const size_t nv = (size_t)chart->nv, nc = (size_t)chart->nc;

    // points of the chart
    int ok = hn_qr_init(&chart->all, arena, chart->nc, chart->nv);
    ok = init_point(chart, &chart->here, 1, arena) && ok;
    ok = init_point(chart, &chart->probe, 1, arena) && ok;
    ok = init_point(chart, &chart->base, 0, arena) && ok;

    // columns of J: which are dependent, and where they stand
    chart->jd_entry = hn_arena_ints(arena, (size_t)chart->n_J);
    chart->jd_row = hn_arena_ints(arena, (size_t)chart->n_J);
    chart->jd_col = hn_arena_ints(arena, (size_t)chart->n_J);
    chart->dep_at = hn_arena_ints(arena, nv);
    chart->at = hn_arena_ints(arena, nv);
    chart->delta = hn_arena_doubles(arena, nv);
    chart->dep = hn_arena_ints(arena, nv);
    chart->ind = hn_arena_ints(arena, nv);
    chart->order = hn_arena_ints(arena, nv);
    chart->new_dep = hn_arena_ints(arena, nv);
    chart->first_dep = hn_arena_ints(arena, nv);

    // scratch
    chart->scale = hn_arena_doubles(arena, nv);
    chart->c = hn_arena_doubles(arena, nv);
    chart->Mx = hn_arena_doubles(arena, nv * nv);
    chart->A = hn_arena_doubles(arena, nv * nv);
    chart->z = hn_arena_doubles(arena, nv + nc);
    chart->dq = hn_arena_doubles(arena, nv + nc);
    chart->follow_q = hn_arena_doubles(arena, (size_t)chart->nq);
    chart->follow_ind = hn_arena_doubles(arena, nv);
    chart->basis = hn_arena_doubles(arena, nc * nv);
    chart->columns = hn_arena_doubles(arena, nc * nv);
    return ok && !hn_arena_failed(arena);
}

/// The choice of columns of a large mechanism, where a dense one would be cubic in its loops.
static hn_status init_sparse_choice(hn_chart *chart, hn_arena *arena) {
    const int nv = chart->nv, nc = chart->nc, n = chart->n_J;
    chart->entry = hn_arena_doubles(arena, (size_t)n);
    if (!chart->entry) {
        return HN_ERR_MEMORY;
    }
    if (nv < HN_CHART_LARGE) {
        return HN_OK;
    }
    HN_TRY(hn_row_check_create(arena, nc, nv, n, chart->J_row, chart->J_col, &chart->check));
    if (!chart->check) {
        return HN_OK;
    }
    chart->choice = hn_column_choice_create(arena, nc, nv, n, chart->J_row, chart->J_col);
    return chart->choice ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_chart_init(hn_chart *chart, const hn_system *sys, bool with_rate, hn_arena *arena,
                        hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    memset(chart, 0, sizeof *chart);
    chart->sys = sys;
    chart->nq = info.nq;
    chart->nv = info.nv;
    chart->nc = info.nc;
    chart->rank = chart->r = -1;
    chart->with_rate = with_rate;
    chart->length = hn_system_length(sys);

    // evaluators
    hn_status status =
        hn_eval_create_listed(sys, HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J, arena, &chart->loop);
    HN_THEN(status, hn_eval_create(sys, HN_TERM_M | HN_TERM_F | (with_rate ? HN_TERM_GAMMA : 0),
                                   arena, &chart->full));

    // patterns and memory
    if (status == HN_OK) {
        chart->n_J = hn_eval_pattern(chart->loop, HN_TERM_J, &chart->J_row, &chart->J_col);
        chart->n_M = hn_eval_pattern(chart->full, HN_TERM_M, &chart->M_row, &chart->M_col);
        status = init_memory(chart, arena) ? init_sparse_choice(chart, arena) : HN_ERR_MEMORY;
    }

    for (int i = 0; status == HN_OK && i < chart->nv; i++) {
        chart->at[i] = hn_system_position_of(sys, i);
    }
    return status == HN_OK ? HN_OK
                           : hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
}

void hn_chart_destroy(hn_chart *chart) {
    hn_eval_free(chart->loop);
    hn_eval_free(chart->full);
    chart->loop = chart->full = NULL;
}

// ---- one configuration ----

static void eval_loop(hn_chart *chart, hn_chart_point *p, double t) {
    hn_eval_run(chart->loop, t, p->q, p->s);
    p->gap = hn_norm2(chart->nc, hn_eval_get(chart->loop, HN_TERM_PHI));
    p->t = t;
}

static const char FOLD[] = "a dead point of this coordinate, from which the others do not follow";
static const char SINGULAR[] = "a singular configuration; closure equations depend on each other "
                               "here, so no choice of coordinates is regular";

/// J_d was singular at (t, q): of this chart, or of all of them.
static hn_status fail_singular(hn_chart *chart, double t, const double *q) {
    const int fold = hn_chart_has_full_rank(chart, t, q);
    return fold ? hn_chart_fail_end(chart, t, q, FOLD)
                : hn_chart_fail(chart, HN_ERR_CHART, t, q, SINGULAR);
}

hn_status hn_chart_locate(hn_chart *chart, hn_chart_point *p, double t, const double *q) {
    p->valid = 0;
    memmove(p->q, q, (size_t)chart->nq * sizeof *q);
    if (!hn_all_finite(chart->nq, p->q)) {
        return hn_chart_fail(chart, HN_ERR_DIVERGED, t, q, "the state is not finite");
    }
    eval_loop(chart, p, t);
    if (!hn_chart_factor(chart, p)) {
        return fail_singular(chart, t, p->q);
    }
    hn_chart_make_basis(chart, p);
    p->tol = HUGE_VAL;
    p->valid = 1;
    return HN_OK;
}

bool hn_chart_is_at(const hn_chart *chart, const hn_chart_point *p, double t, const double *q) {
    return p->valid && p->t == t && memcmp(p->q, q, (size_t)chart->nq * sizeof *q) == 0;
}

// A basis that goes on smoothly while det J_d changes its sign: by Cramer's rule the determinants
// of all other choices changed theirs too. Then it was J that lost rank on the way, and the motion
// went straight on; where J_d alone did, the basis passed through infinity.
static bool went_straight_on(const hn_chart *chart) {
    double change = 0, size = 0;
    for (int i = 0; i < chart->nv; i++) {
        for (int j = 0; j < chart->r; j++) {
            const double old = chart->base.N[i * chart->r + j] / chart->scale[i];
            change = hypot(change, chart->here.N[i * chart->r + j] / chart->scale[i] - old);
            size = hypot(size, old);
        }
    }
    return change < STRAIGHT * size;
}

hn_status hn_chart_check_mode(hn_chart *chart) {
    const bool turned = chart->base.valid && chart->base.sign * chart->here.sign < 0;
    if (turned && !went_straight_on(chart)) {
        chart->here.valid = 0;
        return hn_chart_fail_end(chart, chart->here.t, chart->here.q,
                                 "the loop went over to its other assembly mode, past a dead point "
                                 "or because the step is too long");
    }
    return HN_OK;
}

hn_status hn_chart_settle(hn_chart *chart) {
    const size_t nv = (size_t)chart->nv, r = (size_t)chart->r;
    const hn_chart_point *from = &chart->here;
    hn_chart_point *to = &chart->base;
    const double h = from->t - to->t;
    const bool follows = to->valid && chart->is_measured && h != 0;
    HN_TRY(hn_chart_check_mode(chart));
    memcpy(to->q, from->q, (size_t)chart->nq * sizeof(double));
    memcpy(to->s, from->s, nv * sizeof(double));
    memcpy(to->N, from->N, nv * r * sizeof(double));
    to->t = from->t;
    to->sign = from->sign;
    to->valid = 1;
    if (!chart->is_measured) {
        // a chart chosen near a singular pose must not take that pose for its measure
        chart->pivot_start = fmax(chart->pivot_start, hn_chart_smallest_pivot(chart, from));
        chart->volume_start = hn_chart_log_volume(chart, from);
        chart->volume_unit = exp(-chart->volume_start);
        chart->is_measured = 1;
    }

    // how fast the volume of J_d changes
    const double volume = hn_chart_volume(chart);
    chart->volume_rate = follows ? (volume - chart->volume) / h : 0;
    chart->has_rate = follows;
    chart->volume = volume;
    return HN_OK;
}

// one Newton step of the dependent coordinates from the factor at the point
static void newton_step(hn_chart *chart, hn_chart_point *p) {
    double *b = chart->z, *x = chart->dq;
    memcpy(b, hn_eval_get(chart->loop, HN_TERM_PHI), (size_t)chart->nc * sizeof *b);
    hn_chart_solve_dependent(chart, p, b, x);
    memset(chart->delta, 0, (size_t)chart->nv * sizeof(double));
    for (int k = 0; k < chart->rank; k++) {
        chart->delta[chart->dep[k]] = -x[k] * chart->scale[chart->dep[k]];
    }
    hn_system_move(chart->sys, p->q, chart->delta);
    chart->cost.newton++;
}

/// "RRR of B: x and B: y, a circle and a circle": a step of the position analysis in words.
static void name_dyad(const hn_chart *chart, int step, char text[HN_CHART_TEXT]) {
    const hn_dyad d = hn_dyads_at(chart->dyads, step);
    snprintf(text, HN_CHART_TEXT, "%s of %.40s%s%.40s (%s)", hn_dyad_kind_name(d.kind),
             hn_system_row_name(chart->sys, d.row[0]), d.n == 2 ? " and " : "",
             d.n == 2 ? hn_system_row_name(chart->sys, d.row[1]) : "", hn_dyad_kind_about(d.kind));
}

// the given independent values have torn a dyad apart
static hn_status fail_torn(hn_chart *chart, double t, const double *q, int step) {
    char name[HN_CHART_TEXT], text[HN_CHART_TEXT];
    name_dyad(chart, step, name);
    snprintf(text, sizeof text,
             "%.120s cannot be closed with this value, which is beyond the end of its range, past "
             "a dead point",
             name);
    return hn_chart_fail_end(chart, t, q, text);
}

hn_status hn_chart_fail_dyad(hn_chart *chart, int step) {
    char name[HN_CHART_TEXT], text[HN_CHART_TEXT];
    name_dyad(chart, step, name);
    snprintf(text, sizeof text,
             "%.120s went over to its other assembly mode, past a dead point or because the step "
             "is too long",
             name);
    chart->here.valid = 0;
    return hn_chart_fail_end(chart, chart->here.t, chart->here.q, text);
}

// the factor is wanted for the basis alone, and for telling how near the end of the chart is
static hn_status close_by_dyads(hn_chart *chart, hn_chart_point *p, double t, double *q) {
    if (!hn_all_finite(chart->nq, p->q)) {
        return hn_chart_fail(chart, HN_ERR_DIVERGED, t, q, "the state is not finite");
    }

    // dyads one after the other, then check the gap that they leave
    const int failed = hn_dyads_solve(chart->dyads, t, p->q);
    if (failed >= 0) {
        return fail_torn(chart, t, p->q, failed);
    }
    eval_loop(chart, p, t);
    if (!(p->gap <= FLOOR * chart->length)) {
        return hn_chart_fail(chart, HN_ERR_CHART, t, p->q,
                             "the closed form leaves a gap: coordinates too large for its digits");
    }

    // the factor of J_d is needed for the basis
    if (!hn_chart_factor(chart, p)) {
        return fail_singular(chart, t, p->q);
    }
    hn_chart_make_basis(chart, p);
    memmove(q, p->q, (size_t)chart->nq * sizeof *q);
    p->tol = 0; // closer it does not get
    p->valid = 1;
    return HN_OK;
}

// a gap that stopped falling at rounding level is as closed as it gets
bool hn_chart_is_closed(const hn_chart *chart, double gap, double last, double tol) {
    return gap <= tol * chart->length || (gap <= FLOOR * chart->length && gap >= 0.5 * last);
}

hn_status hn_chart_close(hn_chart *chart, hn_chart_point *p, double t, double *q, double tol) {
    double last = HUGE_VAL;
    p->valid = 0;
    memmove(p->q, q, (size_t)chart->nq * sizeof *q);
    if (chart->dyads) {
        return close_by_dyads(chart, p, t, q);
    }

    // Newton's method on the dependent coordinates
    for (int i = 0; i < MAX_NEWTON; i++) {
        eval_loop(chart, p, t);
        if (!isfinite(p->gap)) {
            return hn_chart_fail(chart, HN_ERR_DIVERGED, t, q, "the loop gap is not finite");
        }
        if (!hn_chart_factor(chart, p)) {
            return fail_singular(chart, t, p->q);
        }
        if (hn_chart_is_closed(chart, p->gap, last, tol)) {
            hn_chart_make_basis(chart, p);
            memmove(q, p->q, (size_t)chart->nq * sizeof *q);
            p->tol = tol;
            p->valid = 1;
            return HN_OK;
        }

        last = p->gap;
        newton_step(chart, p);
    }
    return hn_chart_fail_end(
        chart, t, q,
        "no configuration closes the loops with this value, which is beyond the end of "
        "its range, past a dead point");
}

void hn_chart_predict(hn_chart *chart, double t, const double *q_ind, double *q) {
    hn_chart_predict_from(chart, &chart->base, t, q_ind, q);
}

void hn_chart_predict_from(const hn_chart *chart, const hn_chart_point *from, double t,
                           const double *q_ind, double *q) {
    const int r = chart->r;
    for (int i = 0; i < chart->nv; i++) {
        double step = from->s[i] * (t - from->t);
        for (int j = 0; j < r; j++) {
            step += from->N[i * r + j] * (q_ind[j] - from->q[chart->at[chart->ind[j]]]);
        }
        chart->delta[i] = step;
    }
    memcpy(q, from->q, (size_t)chart->nq * sizeof *q);
    hn_system_move(chart->sys, q, chart->delta);
    for (int j = 0; j < r; j++) {
        q[chart->at[chart->ind[j]]] = q_ind[j];
    }
}

void hn_chart_speeds(const hn_chart *chart, const hn_chart_point *p, const double *u, double *v) {
    const int r = chart->r;
    for (int i = 0; i < chart->nv; i++) {
        double sum = p->s[i];
        for (int j = 0; j < r; j++) {
            sum += p->N[i * r + j] * u[j];
        }
        v[i] = sum;
    }
}

hn_status hn_chart_accel(hn_chart *chart, const double *v, double *u_dot) {
    const int nv = chart->nv, nc = chart->nc, r = chart->r;
    const hn_chart_point *p = &chart->here;
    HN_ASSERT(p->valid);

    // c of (2), from gamma
    hn_eval_run(chart->full, p->t, p->q, v);
    const double *M = hn_eval_get(chart->full, HN_TERM_M), *f = hn_eval_get(chart->full, HN_TERM_F);
    memset(chart->c, 0, (size_t)nv * sizeof(double));
    if (nc > 0 && chart->with_rate) {
        memcpy(chart->z, hn_eval_get(chart->full, HN_TERM_GAMMA), (size_t)nc * sizeof(double));
        hn_chart_solve_dependent(chart, p, chart->z, chart->dq);
        for (int k = 0; k < chart->rank; k++) {
            chart->c[chart->dep[k]] = -chart->dq[k] * chart->scale[chart->dep[k]];
        }
    }

    // N' (f - M c)
    double *force = chart->dq;
    const hn_mass_entries at = {nv, chart->n_M, chart->M_row, chart->M_col};
    hn_mass_multiply(&at, M, chart->c, 1, force);
    for (int i = 0; i < nv; i++) {
        force[i] = f[i] - force[i];
    }

    // N' M N
    hn_mass_multiply(&at, M, p->N, r, chart->Mx);
    hn_mass_project(nv, r, p->N, chart->Mx, chart->A);
    hn_mat_t_vec(nv, r, p->N, force, u_dot);
    chart->cost.ops += hn_mass_project_ops(&at, r) + 4.0 * chart->n_M + hn_flops_product(r, nv, 1);
    return hn_chart_solve_reduced(chart, p->t, u_dot);
}

hn_status hn_chart_solve_reduced(hn_chart *chart, double t, double *x) {
    const int r = chart->r;
    double largest = 0;
    for (int i = 0; i < r; i++) {
        largest = fmax(largest, fabs(chart->A[i * r + i]));
    }
    chart->cost.factorisations++;
    chart->cost.ops += hn_flops_cholesky(r) + hn_flops_cholesky_solve(r);
    const hn_status status = hn_cholesky(r, chart->A, r, 1e-14 * largest);
    if (status != HN_OK || !isfinite(largest)) {
        const hn_status told = isfinite(largest) ? status : HN_ERR_DIVERGED;
        return hn_chart_fail(chart, told, t, chart->here.q,
                             "the reduced mass matrix is not positive definite");
    }
    hn_cholesky_solve(r, chart->A, r, x);
    return hn_all_finite(r, x) ? HN_OK
                               : hn_chart_fail(chart, HN_ERR_DIVERGED, t, chart->here.q,
                                               "the acceleration is not finite");
}

void hn_chart_add_cost(const hn_chart *chart, hn_cost *cost) {
    hn_cost_add(cost, &chart->cost);
    cost->ops += (double)hn_eval_count(chart->loop) * hn_eval_info(chart->loop).ops +
                 (double)hn_eval_count(chart->full) * hn_eval_info(chart->full).ops;
}
