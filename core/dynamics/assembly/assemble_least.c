// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/assemble_least.h"

#include "dynamics/assembly/assemble_rows.h"
#include "dynamics/compile/coordinates.h"
#include "linalg/newton_matrix.h"
#include "linalg/sparse_spd.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

// a pivot of the mass, scaled to a unit diagonal, counts as zero at or below this times n
static const double MASS_TOL = 16 * DBL_EPSILON;

struct hn_assemble_least {
    const hn_assembler *s;
    int n_held, *held; ///< user rates that are pinned
    int *moves;        ///< n: the rate may change
    double *x;         ///< unknowns of (1), one after the other
    hn_newton_matrix *matrix;
};

/// Returns whether M is definite as it stands: then it is so on whatever J and P leave free.
static bool mass_is_definite(const hn_assembler *s, hn_arena *arena) {
    const int *row, *col, n = hn_eval_pattern(s->eval, HN_TERM_M, &row, &col);
    const double *M = hn_eval_list(s->eval, HN_TERM_M);
    double *value = hn_arena_doubles(arena, (size_t)n);
    double *own = hn_arena_doubles(arena, (size_t)s->n); // diagonal
    hn_sparse_spd *spd = value && own ? hn_sparse_spd_create(arena, s->n, n, row, col) : NULL;
    for (int k = 0; spd && k < n; k++) {
        own[row[k]] = row[k] == col[k] ? M[k] : own[row[k]];
    }
    for (int k = 0; spd && k < n; k++) {
        const double a = own[row[k]], b = own[col[k]];
        value[k] = a > 0 && b > 0 ? M[k] / sqrt(a * b) : 0;
    }
    return spd && hn_sparse_spd_factor(spd, value, MASS_TOL * s->n) == HN_OK;
}

static hn_status rows_stand_apart(const hn_assembler *s, int n_free, const int *free, bool *yes) {
    hn_assemble_rows *rows;
    *yes = false;
    HN_TRY(hn_assemble_rows_create(s, n_free, free, &rows));
    if (rows) {
        hn_assemble_rows_fill(rows, NULL);
        *yes = hn_assemble_rows_stand_apart(rows);
    }
    return HN_OK;
}

static void put_pair(hn_newton_matrix *m, int row, int col, double value) {
    hn_newton_matrix_put(m, row, col, value, 0);
    if (row != col) {
        hn_newton_matrix_put(m, col, row, value, 0);
    }
}

static void fill(hn_assemble_least *l) {
    const hn_assembler *s = l->s;
    const double *M = hn_eval_list(s->eval, HN_TERM_M), *J = hn_eval_list(s->eval, HN_TERM_J);
    const int *row, *col;
    hn_newton_matrix_begin(l->matrix, s->n + s->nc + l->n_held);
    for (int k = 0, n = hn_eval_pattern(s->eval, HN_TERM_M, &row, &col); k < n; k++) {
        put_pair(l->matrix, row[k], col[k], M[k]);
    }
    for (int k = 0, n = hn_eval_pattern(s->eval, HN_TERM_J, &row, &col); k < n; k++) {
        put_pair(l->matrix, s->n + row[k], col[k], J[k]);
    }
    for (int k = 0; k < l->n_held; k++) {
        const int i = l->held[k], base = s->rates.base[i], at = s->n + s->nc + k;
        put_pair(l->matrix, at, i, 1);
        if (base >= 0) {
            put_pair(l->matrix, at, base, -1);
        }
    }
}

static hn_status create(const hn_assembler *s, int n_free, const int *free, hn_assemble_least *l) {
    *l = (hn_assemble_least){.s = s,
                             .held = hn_arena_ints(s->arena, (size_t)s->n),
                             .moves = hn_arena_ints(s->arena, (size_t)s->n),
                             .x = hn_arena_doubles(s->arena, 2 * (size_t)s->n + (size_t)s->nc)};
    if (hn_arena_failed(s->arena)) {
        return HN_ERR_MEMORY;
    }
    for (int k = 0; k < n_free; k++) {
        l->moves[free[k]] = 1;
    }
    for (int i = 0; i < s->n; i++) {
        if (!l->moves[i]) {
            l->held[l->n_held++] = i;
        }
    }

    const int *row, *col;
    const int n_M = hn_eval_pattern(s->eval, HN_TERM_M, &row, &col);
    const int n_J = hn_eval_pattern(s->eval, HN_TERM_J, &row, &col);
    l->matrix = hn_newton_matrix_create(s->arena, HN_REAL, true, s->n + s->nc + l->n_held,
                                        2 * (n_M + n_J) + 4 * l->n_held);
    return l->matrix ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_assemble_least_create(const hn_assembler *s, int n_free, const int *free,
                                   hn_assemble_least **out) {
    // where this serves
    bool serves;
    *out = NULL;
    HN_TRY(rows_stand_apart(s, n_free, free, &serves));
    if (!serves || !mass_is_definite(s, s->arena)) {
        return HN_OK;
    }

    // the factor; one that is refused leaves it to the dense way
    hn_assemble_least *l = hn_arena_get(s->arena, sizeof *l);
    if (!l) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(create(s, n_free, free, l));
    fill(l);
    const hn_status status = hn_newton_matrix_factor(l->matrix);
    if (status != HN_OK) {
        hn_assemble_least_free(l);
        return status == HN_ERR_MEMORY ? status : HN_OK;
    }
    *out = l;
    return HN_OK;
}

void hn_assemble_least_free(hn_assemble_least *l) {
    if (l) {
        hn_newton_matrix_free(l->matrix);
    }
}

void hn_assemble_least_change(hn_assemble_least *l, const double *gap, double *change) {
    const hn_assembler *s = l->s;
    memset(l->x, 0, ((size_t)s->n + (size_t)s->nc + (size_t)l->n_held) * sizeof *l->x);
    for (int i = 0; i < s->nc; i++) {
        l->x[s->n + i] = -gap[i];
    }
    hn_newton_matrix_solve(l->matrix, l->x);
    hn_system_rates_to_user(s->sys, l->x, change);
    for (int k = 0; k < l->n_held; k++) {
        change[l->held[k]] = 0; // but for rounding it is
    }
}
