// SPDX-License-Identifier: GPL-3.0-or-later
// The saddle system whole: rows of J that depend on others are left out at the start of a step, K
// is equilibrated and eliminated with partial pivoting. Source: Golub & Van Loan 2013, sec. 3.4
// (elimination), 5.2.8 (Gram-Schmidt).
#include "study/truth/precise_solver.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MAX_CLOSING = 12 };
#define DEPENDENT 1e-9L   // what is left of a row beside the chosen ones, relative to its length
#define LOST_PIVOT 1e-17L // of an equilibrated matrix
#define ROUNDING 1e-18L   // of phi, relative to the length of its row of J
#define SETTLED 1e-16L    // a correction that will do where rounding leaves more
#define WEAK 1e-3L // of a row beside the others: a correction would be larger than what it corrects

typedef struct saddle {
    hn_precise_model *m;
    int n_rows, *row, *left; ///< rows of J that are kept; those not yet looked at
    hn_real weakest;         ///< what is left of the last of them beside the others
    int size;                ///< nv + n_rows
    hn_real *K, *x, *basis, *scale;
    int *pivot;
    hn_real *step;
} saddle;

static hn_status create(hn_precise_model *m, hn_arena *arena, void **ws) {
    saddle *s = hn_arena_get(arena, sizeof *s);
    const size_t nv = (size_t)m->nv, nc = (size_t)m->nc, n = nv + nc;
    if (!s) {
        return HN_ERR_MEMORY;
    }
    s->m = m;
    s->row = hn_arena_ints(arena, nc);
    s->left = hn_arena_ints(arena, nc);
    s->pivot = hn_arena_ints(arena, n);
    s->K = hn_arena_reals(arena, n * n);
    s->x = hn_arena_reals(arena, n);
    s->scale = hn_arena_reals(arena, n);
    s->basis = hn_arena_reals(arena, nc * nv);
    s->step = hn_arena_reals(arena, nv);
    *ws = s;
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

// ---- rows ----

static hn_real dot(int n, const hn_real *x, const hn_real *y) {
    hn_real sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

/// Unit rows; a row of zeros stays one.
static void copy_unit_rows(saddle *s) {
    const int nv = s->m->nv;
    for (int i = 0; i < s->m->nc; i++) {
        const hn_real *row = s->m->J + (size_t)i * nv;
        const hn_real length = sqrtl(dot(nv, row, row));
        for (int j = 0; j < nv; j++) {
            s->basis[(size_t)i * nv + j] = length > 0 ? row[j] / length : 0;
        }
        s->left[i] = 1;
    }
}

/// Chooses independent rows of J by Gram-Schmidt: the row with the largest rest is next.
static void choose_rows(void *ws, hn_real t, const hn_real *q) {
    saddle *s = ws;
    const int nv = s->m->nv, nc = s->m->nc;
    hn_precise_model_closure(s->m, t, q);
    copy_unit_rows(s);

    s->weakest = 1;
    for (s->n_rows = 0; s->n_rows < nc; s->n_rows++) {
        // the row with the largest rest
        int best = -1;
        hn_real most = DEPENDENT * DEPENDENT;
        for (int i = 0; i < nc; i++) {
            const hn_real *row = s->basis + (size_t)i * nv;
            const hn_real size = s->left[i] ? dot(nv, row, row) : 0;
            if (size > most) {
                best = i;
                most = size;
            }
        }

        if (best < 0) {
            return;
        }

        // its direction becomes a basis vector
        hn_real *chosen = s->basis + (size_t)best * nv;
        const hn_real length = s->weakest = sqrtl(most);
        for (int j = 0; j < nv; j++) {
            chosen[j] /= length;
        }
        s->row[s->n_rows] = best;
        s->left[best] = 0;

        // and is taken out of the rows that are left
        for (int i = 0; i < nc; i++) {
            hn_real *row = s->basis + (size_t)i * nv;
            const hn_real along = s->left[i] ? dot(nv, row, chosen) : 0;
            for (int j = 0; j < nv; j++) {
                row[j] -= along * chosen[j];
            }
        }
    }
}

// ---- elimination ----

/// K of the rows that are kept, symmetrically scaled by powers of the diagonal's roots so that
/// pivots compare.
static void fill(saddle *s) {
    const int nv = s->m->nv, n = nv + s->n_rows;
    s->size = n;

    // scales of velocities and of rows
    for (int i = 0; i < nv; i++) {
        const hn_real diagonal = s->m->M[(size_t)i * nv + i];
        s->scale[i] = diagonal > 0 ? 1 / sqrtl(diagonal) : 1;
    }
    for (int k = 0; k < s->n_rows; k++) {
        const hn_real *row = s->m->J + (size_t)s->row[k] * nv;
        hn_real most = 0;
        for (int j = 0; j < nv; j++) {
            most = fmaxl(most, fabsl(row[j]) * s->scale[j]);
        }
        s->scale[nv + k] = most > 0 ? 1 / most : 1;
    }

    // the matrix [M J'; J 0], scaled
    memset(s->K, 0, (size_t)n * n * sizeof *s->K);
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < nv; j++) {
            s->K[(size_t)i * n + j] = s->m->M[(size_t)i * nv + j] * s->scale[i] * s->scale[j];
        }
    }
    for (int k = 0; k < s->n_rows; k++) {
        for (int j = 0; j < nv; j++) {
            const hn_real entry =
                s->m->J[(size_t)s->row[k] * nv + j] * s->scale[nv + k] * s->scale[j];
            s->K[(size_t)(nv + k) * n + j] = s->K[(size_t)j * n + nv + k] = entry;
        }
    }
}

static void swap_rows(saddle *s, int a, int b) {
    const int n = s->size;
    for (int j = 0; j < n && a != b; j++) {
        const hn_real keep = s->K[(size_t)a * n + j];
        s->K[(size_t)a * n + j] = s->K[(size_t)b * n + j];
        s->K[(size_t)b * n + j] = keep;
    }
}

static hn_status factor(saddle *s) {
    const int n = s->size;
    hn_real *K = s->K;
    for (int k = 0; k < n; k++) {
        // the largest pivot of the column
        int best = k;
        for (int i = k + 1; i < n; i++) {
            best = fabsl(K[(size_t)i * n + k]) > fabsl(K[(size_t)best * n + k]) ? i : best;
        }

        if (!(fabsl(K[(size_t)best * n + k]) > LOST_PIVOT)) {
            return HN_ERR_SINGULAR;
        }

        s->pivot[k] = best;
        swap_rows(s, k, best);

        // elimination below it
        for (int i = k + 1; i < n; i++) {
            if (K[(size_t)i * n + k] == 0) {
                continue;
            }
            const hn_real l = K[(size_t)i * n + k] /= K[(size_t)k * n + k];
            for (int j = k + 1; j < n; j++) {
                K[(size_t)i * n + j] -= l * K[(size_t)k * n + j];
            }
        }
    }
    return HN_OK;
}

/// s->x in place; then it is [x; y] of K [x; y] = right-hand side, unscaled.
static void substitute(saddle *s) {
    const int n = s->size;
    hn_real *x = s->x;

    // scale the right-hand side, and exchange its entries as the rows were
    for (int i = 0; i < n; i++) {
        x[i] *= s->scale[i];
    }
    for (int k = 0; k < n; k++) { // rows were exchanged whole, so all exchanges come first
        const hn_real keep = x[k];
        x[k] = x[s->pivot[k]];
        x[s->pivot[k]] = keep;
    }

    // forward, backward, then undo the scaling
    for (int i = 0; i < n; i++) {
        x[i] -= dot(i, s->K + (size_t)i * n, x);
    }
    for (int i = n - 1; i >= 0; i--) {
        x[i] -= dot(n - 1 - i, s->K + (size_t)i * n + i + 1, x + i + 1);
        x[i] /= s->K[(size_t)i * n + i];
    }
    for (int i = 0; i < n; i++) {
        x[i] *= s->scale[i];
    }
}

static hn_status accelerate(void *ws, hn_real t, const hn_real *q, const hn_real *v, hn_real *a,
                            hn_real *lambda) {
    saddle *s = ws;
    const int nv = s->m->nv;

    // matrix and right-hand side [f; -gamma]
    hn_precise_model_dynamics(s->m, t, q, v);
    fill(s);
    memcpy(s->x, s->m->f, (size_t)nv * sizeof *s->x);
    for (int k = 0; k < s->n_rows; k++) {
        s->x[nv + k] = -s->m->gamma[s->row[k]];
    }

    HN_TRY(factor(s));

    substitute(s);
    memcpy(a, s->x, (size_t)nv * sizeof *a);

    // rows that were left out carry no force
    if (lambda) {
        memset(lambda, 0, (size_t)s->m->nc * sizeof *lambda);
        for (int k = 0; k < s->n_rows; k++) {
            lambda[s->row[k]] = -s->x[nv + k];
        }
    }
    return HN_OK;
}

// ---- closing ----

/// s->step: the change of least kinetic energy with J step = -gap, gap a row's `value` + J v.
static hn_status solve_gap(saddle *s, const hn_real *value, const hn_real *v) {
    const int nv = s->m->nv;
    memset(s->x, 0, (size_t)nv * sizeof *s->x);
    for (int k = 0; k < s->n_rows; k++) {
        const int i = s->row[k];
        s->x[nv + k] = -value[i] - (v ? dot(nv, s->m->J + (size_t)i * nv, v) : 0);
    }
    fill(s);
    HN_TRY(factor(s));
    substitute(s);
    memcpy(s->step, s->x, (size_t)nv * sizeof *s->step);
    return HN_OK;
}

static hn_real size_of_step(const saddle *s) {
    hn_real size = 0;
    for (int i = 0; i < s->m->nv; i++) {
        size = fmaxl(size, fabsl(s->step[i]) / s->m->floor[i]);
    }
    return size;
}

/// 1: every kept row is as close to 0 as its rounding.
static bool is_closed(const saddle *s, const hn_real *q) {
    const int nv = s->m->nv;
    hn_real most = 1;
    for (int i = 0; i < s->m->nq; i++) {
        most = fmaxl(most, fabsl(q[i]));
    }
    for (int k = 0; k < s->n_rows; k++) {
        const hn_real *row = s->m->J + (size_t)s->row[k] * nv;
        if (fabsl(s->m->phi[s->row[k]]) > ROUNDING * most * sqrtl(dot(nv, row, row))) {
            return false;
        }
    }
    return true;
}

static hn_status close_loops(void *ws, hn_real t, hn_real *q, hn_real *v) {
    saddle *s = ws;

    // rows for this configuration; near a singular one it is left as it is
    choose_rows(ws, t, q);
    if (s->weakest < WEAK) {
        return HN_OK;
    }

    // positions: Newton
    hn_precise_model_closure(s->m, t, q);
    for (int k = 0; !is_closed(s, q); k++) {
        const hn_status status = solve_gap(s, s->m->phi, NULL);
        const hn_real size = status == HN_OK ? size_of_step(s) : 1;
        if (k >= MAX_CLOSING || !(size < 1)) {
            return k >= MAX_CLOSING && size < SETTLED ? HN_OK : HN_ERR_NO_CONVERGENCE;
        }
        hn_precise_model_nudge(s->m, q, s->step);
        hn_precise_model_closure(s->m, t, q);
    }

    // velocities: linear, so one correction
    const hn_status status = solve_gap(s, s->m->phi_t, v);
    for (int i = 0; status == HN_OK && i < s->m->nv; i++) {
        v[i] += s->step[i];
    }
    return status;
}

const hn_precise_solver hn_precise_saddle = {"saddle", create, choose_rows, accelerate,
                                             close_loops};
