// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/implicit_linear.h"

#include "formulations/ground/flops.h"
#include "formulations/ground/unit_scales.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define ROW_FLOOR \
    1e-3 // of the longest row: a shorter one is dying away and stays as short against the others
#define OWN_FLOOR 0.1  // of the longest a row has been: one that is dying away turns within a step
#define RANK_TOL 1e-10 // of the largest row, all brought to length 1

// puts into matrix (2) or (3)
static int count_puts(const hn_implicit_linear *l) {
    const int motion =
        hn_linear_entries(l->terms, HN_LINEAR_M) + hn_linear_entries(l->terms, HN_LINEAR_C) +
        hn_linear_entries(l->terms, HN_LINEAR_K) + 2 * hn_linear_entries(l->terms, HN_LINEAR_J) +
        hn_linear_entries(l->terms, HN_LINEAR_V);
    const int stabiliser = hn_linear_entries(l->terms, HN_LINEAR_M) +
                           hn_linear_entries(l->terms, HN_LINEAR_C) +
                           2 * hn_linear_entries(l->terms, HN_LINEAR_J);
    return motion + (l->stabilised ? stabiliser : 0);
}

static int wants_sparse(const hn_implicit_linear *l) {
    const int mass = hn_linear_entries(l->terms, HN_LINEAR_M),
              stiffness = hn_linear_entries(l->terms, HN_LINEAR_K),
              damping = hn_linear_entries(l->terms, HN_LINEAR_C);
    int most = mass > stiffness ? mass : stiffness;
    most = damping > most ? damping : most;
    return hn_newton_matrix_wants_sparse(l->nv + l->nc,
                                         most + 2LL * hn_linear_entries(l->terms, HN_LINEAR_J));
}

static bool create_matrices(hn_implicit_linear *l, hn_arena *arena) {
    const int puts = count_puts(l), n = l->nv + l->nc, extended = l->sparse && l->stabilised;
    for (int which = 0; which < 2; which++) {
        l->matrix[which] = hn_newton_matrix_create(arena, which ? HN_COMPLEX : HN_REAL, l->sparse,
                                                   extended ? 2 * n : n, puts);
        if (!l->matrix[which]) {
            return false;
        }
    }
    l->packed = hn_arena_doubles(arena, 4 * (size_t)n);
    l->packed_rows = hn_arena_doubles(arena, (size_t)n);
    return true;
}

// M's lower triangle as its own sparse matrix
static bool create_mass_factor(hn_implicit_linear *l, hn_arena *arena) {
    const int *rows, *cols, n = hn_linear_pattern(l->terms, HN_LINEAR_M, &rows, &cols);
    int *row = hn_arena_ints(arena, (size_t)n), *col = hn_arena_ints(arena, (size_t)n);
    l->lower = hn_arena_ints(arena, (size_t)n);
    l->lower_values = hn_arena_doubles(arena, (size_t)n);
    if (hn_arena_failed(arena)) {
        return false;
    }
    for (int k = 0; k < n; k++) {
        if (rows[k] >= cols[k]) {
            row[l->n_lower] = rows[k];
            col[l->n_lower] = cols[k];
            l->lower[l->n_lower++] = k;
        }
    }
    l->mass_factor = hn_sparse_spd_create(arena, l->nv, l->n_lower, row, col);
    return l->mass_factor != NULL;
}

static hn_status allocate(hn_implicit_linear *l, hn_arena *arena) {
    const size_t nv = (size_t)l->nv, nc = (size_t)l->nc, n = nv + nc;
    l->kept = hn_arena_ints(arena, nc);
    l->place = hn_arena_ints(arena, nc);
    l->unit = hn_arena_doubles(arena, nc);
    l->mass_unit = hn_arena_doubles(arena, nv);
    l->diagonal = hn_arena_doubles(arena, nv);
    l->seen = hn_arena_doubles(arena, nc);
    l->column_unit = hn_arena_doubles(arena, nv);

    for (int i = 0; i < l->nv && l->column_unit; i++) {
        l->column_unit[i] = hn_system_velocity_unit(l->sys, i);
    }

    // the projection M^-1 J' of the ggl form
    if (l->stabilised && !l->sparse) {
        l->Y = hn_arena_doubles(arena, nv * nc);
        l->S = hn_arena_doubles(arena, nc * nc);
        l->damped = hn_arena_doubles(arena, nv * nv);
        l->mass = hn_arena_doubles(arena, nv * nv);
    }

    // right sides and products, two parts for complex systems
    for (int part = 0; part < 2; part++) {
        for (int k = 0; k < 5; k++) {
            l->work[part][k] = hn_arena_doubles(arena, n);
        }
    }
    if (l->stabilised && l->sparse && !create_mass_factor(l, arena)) {
        return HN_ERR_MEMORY;
    }

    // matrices and the choice of rows
    const int good = create_matrices(l, arena) && hn_qr_init(&l->qr, arena, l->nv, l->nc);
    return good && !hn_arena_failed(arena) ? HN_OK : HN_ERR_MEMORY;
}

/// Small or full ones are read row by row.
static hn_status take_whole_matrices(hn_implicit_linear *l, hn_arena *arena) {
    HN_TRY(hn_linear_spread(l->terms, arena));
    l->M = hn_linear_get(l->terms, HN_LINEAR_M);
    l->K = hn_linear_get(l->terms, HN_LINEAR_K);
    l->C = hn_linear_get(l->terms, HN_LINEAR_C);
    l->J = hn_linear_get(l->terms, HN_LINEAR_J);
    l->V = hn_linear_get(l->terms, HN_LINEAR_V);
    return HN_OK;
}

hn_status hn_implicit_linear_init(hn_implicit_linear *l, const hn_system *sys, hn_dae_form form,
                                  hn_arena *arena) {
    const hn_system_info info = hn_system_get_info(sys);
    const unsigned terms =
        HN_LINEAR_RESIDUAL | HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_J | HN_LINEAR_V;
    *l = (hn_implicit_linear){
        .form = form, .stabilised = form == HN_FORM_GGL, .nv = info.nv, .nc = info.nc};
    l->sys = sys;
    HN_TRY(hn_linear_create_listed(sys, terms, arena, &l->terms));
    l->has_damping = hn_linear_entries(l->terms, HN_LINEAR_C) > 0;
    l->sparse = wants_sparse(l);
    hn_status status = l->sparse ? HN_OK : take_whole_matrices(l, arena);
    HN_THEN(status, allocate(l, arena));
    const int *rows, *cols, n = hn_linear_pattern(l->terms, HN_LINEAR_J, &rows, &cols);
    return status == HN_OK ? hn_row_check_create(arena, l->nc, l->nv, n, rows, cols, &l->check)
                           : status;
}

void hn_implicit_linear_free(hn_implicit_linear *l) {
    hn_linear_free(l->terms);
    hn_newton_matrix_free(l->matrix[0]);
    hn_newton_matrix_free(l->matrix[1]);
    l->terms = NULL;
    l->matrix[0] = l->matrix[1] = NULL;
}

static void note_places(hn_implicit_linear *l) {
    for (int i = 0; i < l->nc; i++) {
        l->place[i] = -1;
    }
    for (int k = 0; k < l->n_kept; k++) {
        l->place[l->kept[k]] = k;
    }
}

static void keep_all(hn_implicit_linear *l) {
    l->n_kept = l->nc;
    for (int i = 0; i < l->nc; i++) {
        l->kept[i] = i;
    }
    note_places(l);
}

/// J row by row, in units in which its rows can be compared, to where the QR takes it from.
static void fill_rows(hn_implicit_linear *l) {
    const int *rows, *cols, n = hn_linear_pattern(l->terms, HN_LINEAR_J, &rows, &cols);
    memset(l->qr.a, 0, (size_t)l->nc * (size_t)l->nv * sizeof *l->qr.a);
    for (int k = 0; k < n; k++) {
        l->qr.a[(size_t)rows[k] * (size_t)l->nv + (size_t)cols[k]] =
            hn_linear_entry(l->terms, HN_LINEAR_J, k) * l->column_unit[cols[k]] /
            hn_system_row_unit(l->sys, rows[k]);
    }
}

/// Returns whether the quick check finds that all rows count.
static bool all_count(hn_implicit_linear *l) {
    if (!l->check) {
        return false;
    }
    return l->sparse ? hn_row_check_run_list(l->check, hn_linear_list(l->terms, HN_LINEAR_J),
                                             l->column_unit)
                     : hn_row_check_run(l->check, l->J, l->column_unit);
}

// by pivoted QR of J' with rows of length 1
double hn_implicit_linear_choose(hn_implicit_linear *l, double t, const double *q,
                                 const double *v) {
    const int nv = l->nv, nc = l->nc;
    hn_linear_run(l->terms, t, q, v, NULL, NULL);

    // the quick check: all rows count
    if (all_count(l)) {
        keep_all(l);
        return 1;
    }

    // lengths of the rows, not below those of earlier poses and of the longest
    double longest = 0;
    fill_rows(l);
    for (int i = 0; i < nc; i++) {
        l->unit[i] = hn_norm2(nv, l->qr.a + (size_t)i * (size_t)nv);
        longest = fmax(longest, l->unit[i]);
    }
    for (int i = 0; i < nc; i++) {
        l->seen[i] = fmax(l->seen[i], l->unit[i]);
        const double size = fmax(fmax(l->unit[i], OWN_FLOOR * l->seen[i]), ROW_FLOOR * longest);
        l->unit[i] = size > 0 ? 1 / size : 0;
        for (int j = 0; j < nv; j++) {
            l->qr.a[(size_t)i * (size_t)nv + (size_t)j] *= l->unit[i];
        }
    }

    // independent rows by pivoted QR
    hn_qr_factor(&l->qr, nv, nc, RANK_TOL);
    l->n_kept = l->qr.rank;
    for (int k = 0; k < l->n_kept; k++) {
        l->kept[k] = l->qr.perm[k];
    }
    note_places(l);
    l->ops += hn_flops_qr(nv, nc);
    return hn_qr_pivot_ratio(&l->qr);
}

// Powers of two that bring the masses of angles and lengths to one unit: a length is measured in
// lengths of the mechanism. Whether a coordinate moves no mass is then the same question at any
// size; scaling by powers of two is exact.
static void find_units(hn_implicit_linear *l) {
    hn_unit_scales(l->sys, l->diagonal, 1, l->mass_unit);
    for (int i = 0; i < l->nv; i++) {
        l->mass_unit[i] = exp2(rint(log2(l->mass_unit[i])));
    }
}

static hn_status factor_mass(hn_implicit_linear *l) {
    const double *M = hn_linear_list(l->terms, HN_LINEAR_M);
    const int *rows, *cols;
    double largest = 0;
    hn_linear_pattern(l->terms, HN_LINEAR_M, &rows, &cols);
    find_units(l);
    for (int k = 0; k < l->n_lower; k++) {
        const int at = l->lower[k];
        l->lower_values[k] = M[at] * l->mass_unit[rows[at]] * l->mass_unit[cols[at]];
        largest = fmax(largest, fabs(l->lower_values[k]));
    }
    l->ops += hn_sparse_spd_factor_ops(l->mass_factor);
    return hn_sparse_spd_factor(l->mass_factor, l->lower_values, 1e-14 * largest) == HN_OK
               ? HN_OK
               : HN_ERR_SINGULAR;
}

// Y = M^-1 J', S = J Y of the kept rows
static hn_status prepare_stabiliser(hn_implicit_linear *l) {
    const int nv = l->nv, nk = l->n_kept;
    double *column = l->work[0][0];
    l->ops += hn_flops_cholesky(nv) + nk * hn_flops_cholesky_solve(nv) +
              hn_flops_product(nk, nv, nk) + hn_flops_cholesky(nk);

    // factor of M
    double largest = 0;
    find_units(l);
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < nv; j++) {
            l->mass[i * nv + j] = l->M[i * nv + j] * l->mass_unit[i] * l->mass_unit[j];
        }
        largest = fmax(largest, fabs(l->mass[i * nv + i]));
    }
    if (hn_cholesky(nv, l->mass, nv, 1e-14 * largest) != HN_OK) {
        return HN_ERR_SINGULAR;
    }

    // Y = M^-1 J' and S = J Y of the rows that count
    memset(l->Y, 0, (size_t)(nv * l->nc) * sizeof *l->Y);
    for (int k = 0; k < nk; k++) {
        memcpy(column, l->J + (size_t)l->kept[k] * (size_t)nv, (size_t)nv * sizeof *column);
        for (int i = 0; i < nv; i++) {
            column[i] *= l->mass_unit[i];
        }
        hn_cholesky_solve(nv, l->mass, nv, column);
        for (int i = 0; i < nv; i++) {
            column[i] *= l->mass_unit[i];
            l->Y[i * l->nc + l->kept[k]] = column[i];
        }
        for (int i = 0; i < nk; i++) {
            l->S[i * nk + k] = hn_dot(nv, l->J + (size_t)l->kept[i] * (size_t)nv, column);
        }
    }

    // factor of S
    largest = 0;
    for (int i = 0; i < nk; i++) {
        largest = fmax(largest, l->S[i * nk + i]);
    }
    return hn_cholesky(nk, l->S, nk, 1e-28 * largest) == HN_OK ? HN_OK : HN_ERR_SINGULAR;
}

// C Y S^-1 V
static void find_damped(hn_implicit_linear *l) {
    const int nv = l->nv, nk = l->n_kept;
    double *column = l->work[0][0], *moved = l->work[0][1];
    for (int j = 0; j < nv; j++) {
        for (int i = 0; i < nk; i++) {
            column[i] = l->V[l->kept[i] * nv + j];
        }
        hn_cholesky_solve(nk, l->S, nk, column);
        for (int i = 0; i < nv; i++) {
            moved[i] = 0;
            for (int k = 0; k < nk; k++) {
                moved[i] += l->Y[i * l->nc + l->kept[k]] * column[k];
            }
        }
        for (int i = 0; i < nv; i++) {
            l->damped[i * nv + j] = hn_dot(nv, l->C + (size_t)i * (size_t)nv, moved);
        }
    }
}

/// The masses that move with each velocity alone.
static void take_diagonal(hn_implicit_linear *l) {
    const int *rows, *cols, n = hn_linear_pattern(l->terms, HN_LINEAR_M, &rows, &cols);
    for (int k = 0; k < n; k++) {
        if (rows[k] == cols[k]) {
            l->diagonal[rows[k]] = hn_linear_entry(l->terms, HN_LINEAR_M, k);
        }
    }
}

hn_status hn_implicit_linear_at(hn_implicit_linear *l, double t, const double *q, const double *v,
                                const double *a, const double *lambda) {
    hn_linear_run(l->terms, t, q, v, a, lambda);
    if (!hn_linear_is_finite(l->terms, HN_LINEAR_M) ||
        !hn_linear_is_finite(l->terms, HN_LINEAR_J)) {
        return HN_ERR_DIVERGED;
    }
    if (!l->stabilised) {
        return HN_OK;
    }
    take_diagonal(l);
    if (l->sparse) {
        return factor_mass(l);
    }
    HN_TRY(prepare_stabiliser(l));
    if (l->has_damping) {
        find_damped(l);
    }
    return HN_OK;
}

static hn_complex product(hn_complex a, hn_complex b) {
    return (hn_complex){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

// w times a square term, its first entry at (row, col)
static void put_term(const hn_implicit_linear *l, hn_newton_matrix *to, hn_linear_term term,
                     hn_complex w, int row, int col) {
    const int *rows, *cols, n = hn_linear_pattern(l->terms, term, &rows, &cols);
    for (int k = 0; k < n; k++) {
        const double e = hn_linear_entry(l->terms, term, k);
        hn_newton_matrix_put(to, row + rows[k], col + cols[k], w.re * e, w.im * e);
    }
}

// w times the kept rows of J or V, or of their transpose
static void put_rows(const hn_implicit_linear *l, hn_newton_matrix *to, hn_linear_term term,
                     bool transposed, hn_complex w, int row, int col) {
    const int *rows, *cols, n = hn_linear_pattern(l->terms, term, &rows, &cols);
    for (int k = 0; k < n; k++) {
        const int at = l->place[rows[k]];
        if (at >= 0) {
            const double e = hn_linear_entry(l->terms, term, k);
            hn_newton_matrix_put(to, row + (transposed ? cols[k] : at),
                                 col + (transposed ? at : cols[k]), w.re * e, w.im * e);
        }
    }
}

// the term with S of (2), which is full
static void put_damped(const hn_implicit_linear *l, hn_newton_matrix *to, hn_complex w) {
    for (int i = 0; i < l->nv; i++) {
        for (int j = 0; j < l->nv; j++) {
            const double e = -l->damped[i * l->nv + j];
            hn_newton_matrix_put(to, i, j, w.re * e, w.im * e);
        }
    }
}

// matrix (2), or (3), with 1/s
static void fill(const hn_implicit_linear *l, hn_newton_matrix *to, hn_complex one) {
    const int nv = l->nv, nk = l->n_kept, n = nv + nk;
    const hn_complex two = product(one, one), plus = {1, 0}, minus = {-1, 0};
    const int stabilised = l->stabilised, extended = stabilised && l->sparse;
    hn_newton_matrix_begin(to, extended ? 2 * n : n);

    // equilibrium
    put_term(l, to, HN_LINEAR_M, plus, 0, 0);
    put_term(l, to, HN_LINEAR_C, one, 0, 0);
    put_term(l, to, HN_LINEAR_K, two, 0, 0);
    if (stabilised && l->has_damping && !l->sparse) {
        put_damped(l, to, two);
    }

    // constraint forces and constraints
    put_rows(l, to, HN_LINEAR_J, 1, minus, 0, nv);
    put_rows(l, to, HN_LINEAR_J, 0, plus, nv, 0);
    if (l->form == HN_FORM_INDEX2) {
        put_rows(l, to, HN_LINEAR_V, 0, one, nv, 0);
    }

    // with M^-1 J' mu as an unknown of its own
    if (extended) {
        put_term(l, to, HN_LINEAR_C, (hn_complex){-one.re, -one.im}, 0, n);
        put_term(l, to, HN_LINEAR_M, plus, n, n);
        put_rows(l, to, HN_LINEAR_J, 1, minus, n, n + nv);
        put_rows(l, to, HN_LINEAR_V, 0, one, n + nv, 0);
        put_rows(l, to, HN_LINEAR_J, 0, minus, n + nv, n);
    }
}

void hn_implicit_linear_matrix(hn_implicit_linear *l, double s, double *out) {
    fill(l, l->matrix[0], hn_complex_reciprocal(s, 0));
    hn_newton_matrix_copy(l->matrix[0], out);
}

hn_status hn_implicit_linear_factor(hn_implicit_linear *l, int which, double re, double im) {
    l->s[which][0] = re;
    l->s[which][1] = im;
    fill(l, l->matrix[which], hn_complex_reciprocal(re, which == 0 ? 0 : im));
    return hn_newton_matrix_factor(l->matrix[which]);
}

void hn_implicit_linear_push(hn_implicit_linear *l, const double *m, double *out) {
    if (!l->sparse) {
        hn_mat_vec(l->nv, l->nc, l->Y, m, out);
        l->ops += 2.0 * l->nv * l->nc;
        return;
    }
    hn_linear_apply_transposed(l->terms, HN_LINEAR_J, m, out);
    for (int i = 0; i < l->nv; i++) {
        out[i] *= l->mass_unit[i];
    }
    hn_sparse_spd_solve(l->mass_factor, out);
    for (int i = 0; i < l->nv; i++) {
        out[i] *= l->mass_unit[i];
    }
    l->ops +=
        2.0 * hn_linear_entries(l->terms, HN_LINEAR_J) + hn_sparse_spd_solve_ops(l->mass_factor);
}

double hn_implicit_linear_ops(const hn_implicit_linear *l) {
    return l->ops + (double)hn_linear_count(l->terms) * hn_linear_ops(l->terms) +
           hn_newton_matrix_ops(l->matrix[0]) + hn_newton_matrix_ops(l->matrix[1]) +
           (l->check ? hn_row_check_ops(l->check) : 0);
}
