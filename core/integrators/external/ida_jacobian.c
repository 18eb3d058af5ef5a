// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/external/ida_jacobian.h"

#include "dynamics/compile/coordinates.h"
#include "linalg/dense.h"
#include "linalg/newton_matrix.h"

#include <stdbool.h>
#include <string.h>

static unsigned terms_of(hn_dae_form form) {
    const unsigned always = HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_J;
    const unsigned gamma = HN_LINEAR_GAMMA_Q | HN_LINEAR_GAMMA_V;
    static const unsigned speeds[HN_FORM_COUNT] = {
        [HN_FORM_INDEX2] = HN_LINEAR_V,
        [HN_FORM_GGL] = HN_LINEAR_V,
        [HN_FORM_STABILISED] = HN_LINEAR_V,
    };
    const int index1 = form == HN_FORM_INDEX1 || form == HN_FORM_STABILISED;
    return always | speeds[form] | (index1 ? gamma : 0);
}

static bool is_index1(const hn_ida_problem *p) {
    return p->form == HN_FORM_INDEX1 || p->form == HN_FORM_STABILISED;
}

// puts of fill(), at most
static int count_puts(const hn_ida_jacobian *j) {
    const hn_ida_problem *p = j->problem;
    const int M = hn_linear_entries(j->terms, HN_LINEAR_M),
              J = hn_linear_entries(j->terms, HN_LINEAR_J);
    int n = p->nq + p->nv + M + hn_linear_entries(j->terms, HN_LINEAR_K) +
            hn_linear_entries(j->terms, HN_LINEAR_C) + 2 * J;
    if (is_index1(p)) {
        n += hn_linear_entries(j->terms, HN_LINEAR_GAMMA_Q) +
             hn_linear_entries(j->terms, HN_LINEAR_GAMMA_V) +
             2 * hn_linear_entries(j->turn, HN_LINEAR_V);
    }
    if (terms_of(p->form) & HN_LINEAR_V) {
        n += hn_linear_entries(j->terms, HN_LINEAR_V) + 2 * J;
    }
    return p->form == HN_FORM_GGL ? n + 2 * M + 2 * J : n;
}

// those that stand where others do
static int count_doubled(const hn_ida_jacobian *j) {
    const int J = hn_linear_entries(j->terms, HN_LINEAR_J);
    if (!is_index1(j->problem)) {
        return 0;
    }
    return 2 * hn_linear_entries(j->turn, HN_LINEAR_V) +
           (j->problem->form == HN_FORM_STABILISED
                ? 2 * J + hn_linear_entries(j->terms, HN_LINEAR_V)
                : 0);
}

// Large matrices are given to the library entry by entry. With balls, whose columns are mixed by G,
// they stay full.
static hn_status create_sparse(hn_ida_jacobian *j, hn_arena *arena) {
    const int room = hn_ida_problem_room(j->problem), puts = count_puts(j);
    if (j->G || !hn_newton_matrix_wants_sparse(room, puts - count_doubled(j))) {
        return HN_OK;
    }
    j->sparse = hn_arena_get(arena, sizeof *j->sparse);
    if (!j->sparse || !hn_compressed_init(&j->sparse->places, arena, room, puts)) {
        return HN_ERR_MEMORY;
    }
    j->sparse->values = hn_arena_doubles(arena, (size_t)puts);
    return j->sparse->values ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_ida_jacobian_init(hn_ida_jacobian *j, const hn_ida_problem *problem, hn_arena *arena) {
    const hn_ida_problem *p = problem;
    const size_t nq = (size_t)p->nq, nv = (size_t)p->nv, nc = (size_t)p->nc;
    *j = (hn_ida_jacobian){.problem = p};

    // scratch; G and its rate exist for balls only
    j->unit = hn_arena_doubles(arena, nq + nv);
    j->rate = hn_arena_doubles(arena, nq + nv);
    j->still = hn_arena_doubles(arena, nq + nv);
    j->lambda = hn_arena_doubles(arena, nc);
    if (nq != nv) {
        j->G = hn_arena_doubles(arena, nq * nv);
        j->Gp = hn_arena_doubles(arena, nq * nv);
    }
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // linearised terms, and for index 1 those that turn J
    j->offset = hn_system_get_info(p->sys).has_time;
    HN_TRY(hn_linear_create(p->sys, terms_of(p->form), arena, &j->terms));
    if (is_index1(p)) {
        HN_TRY(hn_linear_create(p->sys, HN_LINEAR_V, arena, &j->turn));
    }
    return create_sparse(j, arena);
}

void hn_ida_jacobian_free(hn_ida_jacobian *j) {
    hn_linear_free(j->terms);
    hn_linear_free(j->turn);
}

// ---- entries ----

static void add(const hn_ida_jacobian *j, int row, int col, double x) {
    if (j->sparse) {
        hn_compressed_put(&j->sparse->places, row, col, x, 0);
    } else {
        j->A[(size_t)col * (size_t)j->problem->n + (size_t)row] += x;
    }
}

// x in a column that goes along speed `speed`; those of the matrix go along q: X G^+
static void add_along_speed(const hn_ida_jacobian *j, int row, int speed, double x) {
    if (!j->Gp) {
        add(j, row, speed, x);
        return;
    }
    for (int k = 0; k < j->problem->nq; k++) {
        add(j, row, k, x * j->Gp[speed * j->problem->nq + k]);
    }
}

/// Describes where a term goes: its first row and column, and what its rows and columns are.
typedef struct target {
    int row, col;
    int by_row;     ///< 1: rows are constraints, those that are kept count
    int along;      ///< 1: columns go along the speeds (col is then that of q)
    int transposed; ///< 1: rows and columns change places, by_row is about columns
} target;

static void add_term(const hn_ida_jacobian *j, const hn_linear *l, hn_linear_term term,
                     const target *at, double s) {
    const double *values = hn_linear_get(l, term);
    const int *rows, *cols, n = hn_linear_pattern(l, term, &rows, &cols);
    for (int e = 0; e < n; e++) {
        const int row = at->by_row ? j->problem->place[rows[e]] : rows[e], col = cols[e];
        const double x = s * values[(size_t)rows[e] * (size_t)j->problem->nv + (size_t)cols[e]];
        if (row < 0) {
            continue;
        }
        if (at->transposed) {
            add(j, at->row + col, at->col + row, x);
        } else if (at->along) {
            add_along_speed(j, at->row + row, col, x);
        } else {
            add(j, at->row + row, at->col + col, x);
        }
    }
}

// -J' over the kept rows
static void subtract_transpose(const hn_ida_jacobian *j, int row, int col) {
    add_term(j, j->terms, HN_LINEAR_J, &(target){row, col, 1, 0, 1}, -1);
}

// ---- eq. (1) ----

// G, whose columns stand at right angles to each other, and its pseudo-inverse
static void find_G(hn_ida_jacobian *j, const double *q) {
    const int nq = j->problem->nq, nv = j->problem->nv;
    memset(j->unit, 0, (size_t)nv * sizeof *j->unit);
    for (int s = 0; s < nv; s++) {
        j->unit[s] = 1;
        hn_system_kinematics(j->problem->sys, q, j->unit, j->rate);
        j->unit[s] = 0;
        const double square = hn_dot(nq, j->rate, j->rate);
        for (int k = 0; k < nq; k++) {
            j->G[k * nv + s] = j->rate[k];
            j->Gp[s * nq + k] = j->rate[k] / square;
        }
    }
}

// -(G v)_q: G v is a linear function of a quaternion's entries, so unit steps give its derivative
// exactly
static void subtract_turning(hn_ida_jacobian *j, const double *v) {
    const int nq = j->problem->nq;
    memset(j->unit, 0, (size_t)nq * sizeof *j->unit);
    hn_system_kinematics(j->problem->sys, j->unit, v, j->still);
    for (int k = 0; k < nq; k++) {
        j->unit[k] = 1;
        hn_system_kinematics(j->problem->sys, j->unit, v, j->rate);
        j->unit[k] = 0;
        for (int i = 0; i < nq; i++) {
            add(j, i, k, j->still[i] - j->rate[i]);
        }
    }
}

static void put_kinematics(hn_ida_jacobian *j, double c, const double *y) {
    const hn_ida_problem *p = j->problem;

    // ggl has M (q' - v) + J' mu = 0
    if (p->form == HN_FORM_GGL) {
        add_term(j, j->terms, HN_LINEAR_M, &(target){0}, c);
        add_term(j, j->terms, HN_LINEAR_M, &(target){.col = p->nq}, -1);
        subtract_transpose(j, 0, p->nq + p->nv + p->n_kept);
        return;
    }

    // the others q' - G v = 0; without balls G is the identity
    for (int i = 0; i < p->nq; i++) {
        add(j, i, i, c);
    }
    if (!j->G) {
        for (int i = 0; i < p->nv; i++) {
            add(j, i, p->nq + i, -1);
        }
        return;
    }

    find_G(j, y);
    for (int i = 0; i < p->nq * p->nv; i++) {
        add(j, i / p->nv, p->nq + i % p->nv, -j->G[i]);
    }
    subtract_turning(j, y + p->nq);
}

// ---- eq. (2), (3) ----

static void put_dynamics(const hn_ida_jacobian *j, double c) {
    const int nq = j->problem->nq, nv = j->problem->nv;
    const target by_v = {.row = nq, .col = nq};
    add_term(j, j->terms, HN_LINEAR_K, &(target){.row = nq, .along = 1}, 1);
    add_term(j, j->terms, HN_LINEAR_C, &by_v, 1);
    add_term(j, j->terms, HN_LINEAR_M, &by_v, c);
    subtract_transpose(j, nq, nq + nv);
}

static void put_index1_rows(hn_ida_jacobian *j, double t, double c, const double *q,
                            const double *a) {
    const hn_ida_problem *p = j->problem;
    const target by_q = {.row = p->nq + p->nv, .by_row = 1, .along = 1};
    const target by_v = {.row = p->nq + p->nv, .col = p->nq, .by_row = 1};
    add_term(j, j->terms, HN_LINEAR_GAMMA_Q, &by_q, 1);
    add_term(j, j->terms, HN_LINEAR_GAMMA_V, &by_v, 1);
    add_term(j, j->terms, HN_LINEAR_J, &by_v, c);
    hn_linear_run(j->turn, t, q, a, NULL, NULL);
    add_term(j, j->turn, HN_LINEAR_V, &by_q, 1);
    if (j->offset) {
        hn_linear_run(j->turn, t, q, NULL, NULL, NULL);
        add_term(j, j->turn, HN_LINEAR_V, &by_q, -1);
    }
    if (p->form == HN_FORM_STABILISED) {
        add_term(j, j->terms, HN_LINEAR_V, &by_q, 2 * p->alpha);
        add_term(j, j->terms, HN_LINEAR_J, &by_q, p->beta * p->beta);
        add_term(j, j->terms, HN_LINEAR_J, &by_v, 2 * p->alpha);
    }
}

static void put_constraints(hn_ida_jacobian *j, double t, double c, const double *y,
                            const double *ydot) {
    const hn_ida_problem *p = j->problem;
    const int first = p->nq + p->nv;
    if (is_index1(p)) {
        put_index1_rows(j, t, c, y, ydot + p->nq);
        return;
    }
    const target by_q = {.row = first, .by_row = 1, .along = 1};
    if (p->form == HN_FORM_INDEX3) {
        add_term(j, j->terms, HN_LINEAR_J, &by_q, 1);
        return;
    }
    add_term(j, j->terms, HN_LINEAR_V, &by_q, 1);
    add_term(j, j->terms, HN_LINEAR_J, &(target){.row = first, .col = p->nq, .by_row = 1}, 1);
    if (p->form == HN_FORM_GGL) {
        add_term(j, j->terms, HN_LINEAR_J,
                 &(target){.row = first + p->n_kept, .by_row = 1, .along = 1}, 1);
    }
}

static void fill(hn_ida_jacobian *j, double t, double c, const double *y, const double *ydot) {
    hn_ida_problem_lambda(j->problem, y, j->lambda);
    hn_linear_run(j->terms, t, y, y + j->problem->nq, ydot + j->problem->nq, j->lambda);
    put_kinematics(j, c, y);
    put_dynamics(j, c);
    put_constraints(j, t, c, y, ydot);
    j->count++;
}

void hn_ida_jacobian_fill(hn_ida_jacobian *j, double t, double c, const double *y,
                          const double *ydot, double *A) {
    const size_t n = (size_t)j->problem->n;
    hn_ida_sparse *const sparse = j->sparse;
    j->sparse = NULL;
    j->A = A;
    memset(A, 0, n * n * sizeof *A);
    fill(j, t, c, y, ydot);
    j->sparse = sparse;
}

const hn_compressed *hn_ida_jacobian_fill_sparse(hn_ida_jacobian *j, double t, double c,
                                                 const double *y, const double *ydot,
                                                 const double **values) {
    hn_compressed_begin(&j->sparse->places, j->problem->n);
    fill(j, t, c, y, ydot);
    (void)hn_compressed_end(&j->sparse->places, 1, j->sparse->values);
    *values = j->sparse->values;
    return &j->sparse->places;
}

bool hn_ida_jacobian_is_sparse(const hn_ida_jacobian *j) {
    return j->sparse != NULL;
}

int hn_ida_jacobian_puts(const hn_ida_jacobian *j) {
    return j->sparse ? j->sparse->places.entries_max : 0;
}

double hn_ida_jacobian_ops(const hn_ida_jacobian *j) {
    return hn_linear_ops(j->terms) + (j->turn ? (1 + j->offset) * hn_linear_ops(j->turn) : 0);
}
