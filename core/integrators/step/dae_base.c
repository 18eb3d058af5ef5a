// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/step/dae_base.h"

#include "dynamics/evaluate/accel.h"
#include "formulations/ground/flops.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// pivots of J' with unit rows below this belong to rows that follow from the others; at a closed
// pose those are at rounding
static const double DEPENDENT_ROW = 1e-8;
// where positions have drifted dependent rows part; then a rank above the one seen at closed poses
// takes stronger rows
static const double CLOSED = 1e-12; // of the mechanism's length
static const double STRONG_ROW = 1e-3;

static hn_status find_patterns(hn_dae_base *b, hn_arena *arena) {
    b->n_M = hn_eval_pattern(b->dyn, HN_TERM_M, &b->M_row, &b->M_col);
    b->n_J = hn_eval_pattern(b->loop, HN_TERM_J, &b->J_row, &b->J_col);
    long long entries = 2LL * b->n_J;
    for (int k = 0; k < b->n_M; k++) {
        entries += b->M_row[k] == b->M_col[k] ? 1 : 2;
    }
    b->sparse = hn_newton_matrix_wants_sparse(b->nv + b->nc, entries);
    return hn_row_check_create(arena, b->nc, b->nv, b->n_J, b->J_row, b->J_col, &b->check);
}

hn_status hn_dae_base_init(hn_dae_base *b, const hn_system *sys, hn_arena *arena, hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    const hn_accel_opts opts = {.baumgarte = 0, .want_lambda = 1};
    *b = (hn_dae_base){
        .sys = sys, .nq = info.nq, .nv = info.nv, .nc = info.nc, .length = hn_system_length(sys)};

    // evaluators
    hn_status status = hn_accel_create(sys, &opts, arena, &b->accel);
    HN_THEN(status, hn_eval_create(sys, HN_TERM_M | HN_TERM_F, arena, &b->dyn));
    HN_THEN(status, hn_eval_create(sys, HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J, arena, &b->loop));

    // scratch and patterns
    b->rows = hn_arena_ints(arena, (size_t)b->nc);
    b->place = hn_arena_ints(arena, (size_t)b->nc);
    b->arm = hn_arena_doubles(arena, (size_t)b->nv);
    b->gap = hn_arena_doubles(arena, (size_t)b->nc);
    b->column_unit = hn_arena_doubles(arena, (size_t)b->nv);
    HN_THEN(status, find_patterns(b, arena));
    if (status == HN_OK && (!hn_qr_init(&b->qr, arena, b->nv, b->nc) || hn_arena_failed(arena))) {
        status = HN_ERR_MEMORY;
    }

    if (status != HN_OK) {
        hn_dae_base_destroy(b);
        return hn_diag_set(diag, status, NULL, NULL, "the equations cannot be compiled: %s",
                           hn_status_text(status));
    }

    for (int i = 0; i < b->nv; i++) {
        b->column_unit[i] = hn_system_velocity_unit(sys, i);
    }

    // the terms live in the evaluators
    b->M = hn_eval_get(b->dyn, HN_TERM_M);
    b->f = hn_eval_get(b->dyn, HN_TERM_F);
    b->phi = hn_eval_get(b->loop, HN_TERM_PHI);
    b->phi_t = hn_eval_get(b->loop, HN_TERM_PHI_T);
    b->J = hn_eval_get(b->loop, HN_TERM_J);
    return HN_OK;
}

void hn_dae_base_destroy(hn_dae_base *b) {
    hn_accel_free(b->accel);
    hn_eval_free(b->dyn);
    hn_eval_free(b->loop);
    b->accel = NULL;
    b->dyn = b->loop = NULL;
}

void hn_dae_base_add_cost(const hn_dae_base *b, hn_cost *cost) {
    const long long solves = hn_accel_count(b->accel), dense = hn_accel_fallbacks(b->accel);
    hn_cost_add(cost, &b->cost);
    cost->factorisations += solves;
    cost->solves += solves;
    cost->fallbacks += dense;
    cost->ops += (double)solves * hn_accel_tape_info(b->accel).ops +
                 (double)dense * hn_flops_saddle(b->nv, b->nc) +
                 (double)hn_eval_count(b->dyn) * hn_eval_info(b->dyn).ops +
                 (double)hn_eval_count(b->loop) * hn_eval_info(b->loop).ops +
                 (b->check ? hn_row_check_ops(b->check) : 0);
}

const char *hn_dae_base_why(const hn_dae_base *b) {
    return b->why[0] ? b->why : NULL;
}

void hn_dae_dynamics(hn_dae_base *b, double t, const double *q, const double *v) {
    b->cost.evals++;
    hn_eval_run(b->dyn, t, q, v);
}

void hn_dae_loops(hn_dae_base *b, double t, const double *q) {
    hn_eval_run(b->loop, t, q, NULL);
}

static void sort_rows(int n, int *rows) {
    for (int i = 1; i < n; i++) {
        const int row = rows[i];
        int j = i;
        for (; j > 0 && rows[j - 1] > row; j--) {
            rows[j] = rows[j - 1];
        }
        rows[j] = row;
    }
}

// rows to keep of those in the factor
static int count_rows(hn_dae_base *b) {
    const hn_qr *qr = &b->qr;
    int rank = qr->rank;
    if (hn_norm_max(b->nc, b->phi) <= CLOSED * b->length) {
        b->rank_seen = rank > b->rank_seen ? rank : b->rank_seen;
        return rank;
    }
    while (rank > b->rank_seen &&
           fabs(qr->a[(size_t)(rank - 1) * qr->m + rank - 1]) < STRONG_ROW * fabs(qr->a[0])) {
        rank--;
    }
    return rank;
}

static void note_places(hn_dae_base *b) {
    for (int i = 0; i < b->nc; i++) {
        b->place[i] = -1;
    }
    for (int k = 0; k < b->nr; k++) {
        b->place[b->rows[k]] = k;
    }
}

static void keep_all_rows(hn_dae_base *b) {
    b->nr = b->nc;
    for (int i = 0; i < b->nc; i++) {
        b->rows[i] = b->place[i] = i;
    }
    if (hn_norm_max(b->nc, b->phi) <= CLOSED * b->length) {
        b->rank_seen = b->nc;
    }
}

void hn_dae_choose_rows(hn_dae_base *b) {
    const int nv = b->nv, nc = b->nc;

    // all rows stay where the quick check finds them far from each other
    if (b->check && hn_row_check_run(b->check, b->J, b->column_unit)) {
        keep_all_rows(b);
        return;
    }

    // rows of equal size, columns in like units: one threshold then fits all
    for (int i = 0; i < nc; i++) {
        double *row = b->qr.a + (size_t)i * nv;
        for (int j = 0; j < nv; j++) {
            row[j] = b->J[(size_t)i * nv + j] * b->column_unit[j];
        }
        const double size = hn_norm2(nv, row);
        for (int j = 0; j < nv; j++) {
            row[j] = size > 0 ? row[j] / size : 0;
        }
    }

    // the independent rows, in the order of the system
    hn_qr_factor(&b->qr, nv, nc, DEPENDENT_ROW);
    b->nr = count_rows(b);
    memcpy(b->rows, b->qr.perm, (size_t)b->nr * sizeof *b->rows);
    sort_rows(b->nr, b->rows);
    note_places(b);
    b->cost.ops += hn_flops_qr(nv, nc);
}

// ---- Newton matrices ----

hn_newton_matrix *hn_dae_matrix_create(const hn_dae_base *b, hn_arena *arena, int n_max,
                                       int fillings, int borders, int more) {
    return hn_newton_matrix_create(arena, HN_REAL, b->sparse, n_max,
                                   2 * fillings * b->n_M + borders * b->n_J + more);
}

void hn_dae_put_mass(const hn_dae_base *b, hn_newton_matrix *to, double s, int row, int col) {
    for (int k = 0; k < b->n_M; k++) {
        const int i = b->M_row[k], j = b->M_col[k];
        const double e = s * b->M[(size_t)i * b->nv + j];
        hn_newton_matrix_put(to, row + i, col + j, e, 0);
        if (i != j) {
            hn_newton_matrix_put(to, row + j, col + i, e, 0);
        }
    }
}

static void put_border(const hn_dae_base *b, hn_newton_matrix *to, const double *J, bool transposed,
                       double s, int row, int col) {
    for (int k = 0; k < b->n_J; k++) {
        const int at = b->place[b->J_row[k]], j = b->J_col[k];
        if (at >= 0) {
            hn_newton_matrix_put(to, row + (transposed ? j : at), col + (transposed ? at : j),
                                 s * J[(size_t)b->J_row[k] * b->nv + j], 0);
        }
    }
}

void hn_dae_put_rows(const hn_dae_base *b, hn_newton_matrix *to, const double *J, double s, int row,
                     int col) {
    put_border(b, to, J, 0, s, row, col);
}

void hn_dae_put_columns(const hn_dae_base *b, hn_newton_matrix *to, const double *J, double s,
                        int row, int col) {
    put_border(b, to, J, 1, s, row, col);
}

void hn_dae_copy_rows(const hn_dae_base *b, double *to) {
    for (int k = 0; k < b->n_J; k++) {
        const size_t at = (size_t)b->J_row[k] * b->nv + b->J_col[k];
        to[at] = b->J[at];
    }
}

void hn_dae_mass_times(const hn_dae_base *b, const double *x, double *out) {
    memset(out, 0, (size_t)b->nv * sizeof *out);
    for (int k = 0; k < b->n_M; k++) {
        const int i = b->M_row[k], j = b->M_col[k];
        const double e = b->M[(size_t)i * b->nv + j];
        out[i] += e * x[j];
        if (i != j) {
            out[j] += e * x[i];
        }
    }
}

void hn_dae_speed_gap(hn_dae_base *b, const double *v, double *out) {
    memset(b->gap, 0, (size_t)b->nc * sizeof *b->gap);
    for (int k = 0; k < b->n_J; k++) {
        const int i = b->J_row[k], j = b->J_col[k];
        b->gap[i] += b->J[(size_t)i * b->nv + j] * v[j];
    }
    for (int k = 0; k < b->nr; k++) {
        out[k] = b->gap[b->rows[k]] + b->phi_t[b->rows[k]];
    }
}

void hn_dae_add_rows(const hn_dae_base *b, const double *J, double s, const double *x,
                     double *out) {
    for (int k = 0; k < b->n_J; k++) {
        const int at = b->place[b->J_row[k]], j = b->J_col[k];
        if (at >= 0) {
            out[j] += s * x[at] * J[(size_t)b->J_row[k] * b->nv + j];
        }
    }
}

void hn_dae_spread_rows(const hn_dae_base *b, const double *x, double *out) {
    memset(out, 0, (size_t)b->nc * sizeof *out);
    for (int k = 0; k < b->nr; k++) {
        out[b->rows[k]] = x[k];
    }
}

hn_status hn_dae_accelerate(hn_dae_base *b, double t, const double *q, const double *v, double *a,
                            double *lambda) {
    const hn_status status = hn_accel_eval(b->accel, t, q, v, 0, 0, a, lambda, NULL);
    b->cost.evals++;
    return status == HN_OK ? HN_OK : hn_dae_fail(b, status, t, "the accelerations");
}

// x' M x
static double mass_norm(const hn_dae_base *b, const double *x) {
    double sum = 0;
    for (int k = 0; k < b->n_M; k++) {
        const int i = b->M_row[k], j = b->M_col[k];
        const double e = b->M[(size_t)i * b->nv + j] * x[i] * x[j];
        sum += i == j ? e : 2 * e;
    }
    return sum;
}

// squared mass norm of the displacement that opens one loop by the mechanism's length
static double loop_opening(hn_dae_base *b) {
    double most = 0;
    memset(b->arm, 0, (size_t)b->nv * sizeof *b->arm);
    for (int k = 0; k < b->n_J; k++) {
        const int j = b->J_col[k];
        b->arm[j] = fmax(b->arm[j], fabs(b->J[(size_t)b->J_row[k] * b->nv + j]));
    }
    for (int j = 0; j < b->nv; j++) {
        const double d = b->arm[j] > 0 ? b->length / b->arm[j] : 0;
        most = fmax(most, b->M[(size_t)j * b->nv + j] * d * d);
    }
    return most;
}

double hn_dae_newton_size(hn_dae_base *b, const double *delta, const double *moved,
                          const double *q) {
    double scale = fmax(loop_opening(b), mass_norm(b, moved));
    if (b->nq == b->nv) {
        scale = fmax(scale, mass_norm(b, q));
    }
    const double size = mass_norm(b, delta);
    return size > 0 || !isfinite(size) ? sqrt(size / scale) : 0;
}

hn_status hn_dae_fail(hn_dae_base *b, hn_status status, double t, const char *what) {
    const char *reason = hn_status_text(status);
    if (status == HN_ERR_SINGULAR) {
        reason = "its equations have no unique solution; the loop is at, or has been thrown to, a "
                 "configuration where its constraint equations depend on each other";
    } else if (status == HN_ERR_NO_CONVERGENCE) {
        reason = "Newton's iteration does not converge; the step is too long for it, or the "
                 "configuration is close to one where the loop loses rank";
    }
    snprintf(b->why, sizeof b->why, "%s at t = %.6g s failed: %s", what, t, reason);
    return status;
}

void hn_dae_tell_massless(const hn_system *sys, const double *mass, int apart, double t, char *why,
                          size_t size) {
    const double massless = 1e-14; // of the largest mass, as in the dense solves
    const hn_system_info info = hn_system_get_info(sys);
    double heaviest = 0;
    int found = -1;
    for (int i = 0; i < info.nv; i++) {
        heaviest = fmax(heaviest, mass[(size_t)i * (size_t)apart]);
    }
    for (int i = info.nv - 1; i >= 0; i--) {
        found = mass[(size_t)i * (size_t)apart] > massless * heaviest ? found : i;
    }
    const int named = found >= 0 && found < info.n_user;
    const char *name =
        named ? hn_system_scene(sys)->coordinates[hn_system_user_coordinate(sys, found)].name
              : "a combination of the coordinates";
    snprintf(why, size,
             "ggl needs the inverse of the mass matrix, which does not exist at t = %.6g s: %s "
             "moves no mass; index2 and index3 can be used",
             t, name);
}

int hn_dae_close_option(hn_dae_form form, const double *form_options) {
    return form == HN_FORM_INDEX2 ? (int)form_options[HN_INDEX2_CLOSE] : HN_CLOSE_NEVER;
}

int hn_dae_projects_speeds(hn_dae_form form, const double *form_options) {
    return form == HN_FORM_INDEX3 && form_options[HN_INDEX3_PROJECT] > 0;
}

hn_status hn_dae_refuse_projecting(hn_dae_form form, const double *form_options,
                                   const char *integrator, hn_diag *diag) {
    if (!hn_dae_projects_speeds(form, form_options)) {
        return HN_OK;
    }
    return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "take radau5, radau3 or implicit-euler",
                       "%s cannot be used with index3:project=yes: its scheme computes its own "
                       "velocities, and a projection after each step would disturb them",
                       integrator);
}

hn_status hn_dae_instance(hn_dae_form form, const double *form_options, const char *integrator,
                          size_t size, hn_arena *arena, void **self, hn_diag *diag) {
    HN_TRY(hn_dae_refuse_projecting(form, form_options, integrator, diag));
    *self = hn_arena_get(arena, size);
    return *self ? HN_OK : hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
}

int hn_dae_closes(int close, long long n, int dependent) {
    return close == HN_CLOSE_DEPENDENT ? dependent : close > 0 && n % close == 0;
}

hn_newton_verdict hn_newton_look(hn_newton *n, double size) {
    n->iterations++;
    if (!isfinite(size)) {
        return HN_NEWTON_DIVERGES;
    }
    n->contraction = n->iterations > 1 && n->last > 0 ? size / n->last : 1;
    const double left =
        n->contraction < 1 ? size * fmin(1, n->contraction / (1 - n->contraction)) : size;
    const int at_rounding = size <= HN_NEWTON_ROUNDING && n->iterations > 1 && n->contraction > 0.5;
    n->last = size;
    if (size <= HN_NEWTON_TOL || left <= HN_NEWTON_TOL || at_rounding) {
        return HN_NEWTON_DONE;
    }
    if (n->iterations >= HN_NEWTON_MAX || (n->iterations > 3 && n->contraction > 2)) {
        return HN_NEWTON_DIVERGES;
    }
    return HN_NEWTON_GO_ON;
}
