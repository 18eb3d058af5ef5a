// SPDX-License-Identifier: GPL-3.0-or-later
// The null space of J: J' P = Q [R; 0] by reflections, rows of J at unit length; N is the rest of
// Q. Column pivoting finds which rows count, and in which order, at the start of a step and
// stays for the step: where rows depend on one another they agree only as far as the numbers in the
// scene do, and another choice amid a step would be a kink. Source: Golub & Van Loan 2013, sec.
// 5.4.2.
//
//     c = Q1 R^-T (-gamma),   (N' M N) z = N' (f - M c),   a = N z + c,
//     R lambda = Q1' (M a - f)                                             (1)
#include "study/truth/precise_solver.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MAX_NEWTON = 12 };
#define RANK_TOL 1e-9L
#define ROUNDING 1e-18L
#define SETTLED 1e-16L // a correction that will do where rounding leaves more than ROUNDING
#define WEAK 1e-3L // of a row beside the others: a correction would be larger than what it corrects

typedef struct nullspace {
    hn_precise_model *m;
    int rank, n_rows;        ///< n_rows: how many of `column` were chosen
    int *column;             ///< row of J behind each column of R
    hn_real *A;              ///< nc columns of nv: R above, reflectors below
    hn_real *beta, *length;  ///< of a reflector; of a row of J
    hn_real *N;              ///< columns of nv
    hn_real *S, *z, *c, *Mc; ///< reduced mass; r; nv; nv
    hn_real *y, *gap;        ///< nv, nc
} nullspace;

static hn_status create(hn_precise_model *m, hn_arena *arena, void **ws) {
    nullspace *s = hn_arena_get(arena, sizeof *s);
    const size_t nv = (size_t)m->nv, nc = (size_t)m->nc;
    if (!s) {
        return HN_ERR_MEMORY;
    }
    s->m = m;
    s->column = hn_arena_ints(arena, nc);
    s->A = hn_arena_reals(arena, nc * nv);
    s->beta = hn_arena_reals(arena, nc);
    s->length = hn_arena_reals(arena, nc);
    s->N = hn_arena_reals(arena, nv * nv);
    s->S = hn_arena_reals(arena, nv * nv);
    s->z = hn_arena_reals(arena, nv);
    s->c = hn_arena_reals(arena, nv);
    s->Mc = hn_arena_reals(arena, nv);
    s->y = hn_arena_reals(arena, nv);
    s->gap = hn_arena_reals(arena, nc);
    *ws = s;
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

static hn_real inner(int n, const hn_real *x, const hn_real *y) {
    hn_real sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

// ---- factors ----

static hn_real *column_of(const nullspace *s, int k) {
    return s->A + (size_t)k * s->m->nv;
}

/// The first n of the rows in `column`, at unit length.
static void take_rows(nullspace *s, int n) {
    const int nv = s->m->nv;
    for (int k = 0; k < n; k++) {
        const int i = s->column[k];
        const hn_real *row = s->m->J + (size_t)i * nv;
        s->length[i] = sqrtl(inner(nv, row, row));
        for (int j = 0; j < nv; j++) {
            column_of(s, k)[j] = s->length[i] > 0 ? row[j] / s->length[i] : 0;
        }
    }
}

static void exchange(nullspace *s, int a, int b) {
    const int keep = s->column[a];
    s->column[a] = s->column[b];
    s->column[b] = keep;
    for (int j = 0; j < s->m->nv && a != b; j++) {
        const hn_real x = column_of(s, a)[j];
        column_of(s, a)[j] = column_of(s, b)[j];
        column_of(s, b)[j] = x;
    }
}

/// x <- x - beta w (w' x) below entry k; w stands in column k with w[k] = 1 left out.
static void reflect(const nullspace *s, int k, hn_real *x) {
    const int n = s->m->nv;
    const hn_real *w = column_of(s, k);
    const hn_real sum = x[k] + inner(n - k - 1, w + k + 1, x + k + 1);
    x[k] -= s->beta[k] * sum;
    for (int j = k + 1; j < n; j++) {
        x[j] -= s->beta[k] * sum * w[j];
    }
}

/// Makes column k the reflector that takes it to a multiple of the k-th axis, kept as R_kk.
static void make_reflector(nullspace *s, int k) {
    hn_real *x = column_of(s, k);
    const int n = s->m->nv - k;
    const hn_real norm = sqrtl(inner(n, x + k, x + k));
    const hn_real alpha = x[k] > 0 ? -norm : norm, head = x[k] - alpha;
    s->beta[k] = -head / alpha;
    for (int j = k + 1; j < s->m->nv; j++) {
        x[j] /= head;
    }
    x[k] = alpha;
}

/// Returns the squared length of the part of row k that is perpendicular to the rows before it.
static hn_real rest_of(const nullspace *s, int k) {
    const hn_real *x = column_of(s, k) + s->rank;
    return inner(s->m->nv - s->rank, x, x);
}

/// Reflects one row more; the others follow.
static void eliminate(nullspace *s, int n) {
    make_reflector(s, s->rank);
    for (int i = s->rank + 1; i < n; i++) {
        reflect(s, s->rank, column_of(s, i));
    }
    s->rank++;
}

/// The factors of the chosen rows, at the terms that the model holds.
static void factor(nullspace *s) {
    take_rows(s, s->n_rows);
    for (s->rank = 0; s->rank < s->n_rows && rest_of(s, s->rank) > 0;) {
        eliminate(s, s->n_rows);
    }
}

static void choose_rows(void *ws, hn_real t, const hn_real *q) {
    nullspace *s = ws;
    const int nv = s->m->nv, nc = s->m->nc;
    hn_precise_model_closure(s->m, t, q);

    // all rows in their own order
    for (int i = 0; i < nc; i++) {
        s->column[i] = i;
    }
    take_rows(s, nc);

    // QR with column exchange: the row with the largest rest is next
    s->rank = 0;
    while (s->rank < nc && s->rank < nv) {
        int best = s->rank;
        for (int i = best + 1; i < nc; i++) {
            best = rest_of(s, i) > rest_of(s, best) ? i : best;
        }
        if (!(rest_of(s, best) > RANK_TOL * RANK_TOL)) {
            break;
        }

        exchange(s, s->rank, best);
        eliminate(s, nc);
    }

    s->n_rows = s->rank;
}

/// x <- Q x and Q' x.
static void apply(const nullspace *s, hn_real *x) {
    for (int k = s->rank - 1; k >= 0; k--) {
        reflect(s, k, x);
    }
}

static void apply_transposed(const nullspace *s, hn_real *x) {
    for (int k = 0; k < s->rank; k++) {
        reflect(s, k, x);
    }
}

/// out = the shortest x with J x = -gap (nc, by row of J) in the rows that count.
static void shortest(const nullspace *s, const hn_real *gap, hn_real *out) {
    memset(out, 0, (size_t)s->m->nv * sizeof *out);
    for (int k = 0; k < s->rank; k++) { // R' is lower triangular
        const hn_real *r = column_of(s, k);
        const int i = s->column[k];
        out[k] = (-gap[i] / s->length[i] - inner(k, r, out)) / r[k];
    }
    apply(s, out);
}

static void make_basis(nullspace *s) {
    const int nv = s->m->nv;
    for (int j = s->rank; j < nv; j++) {
        hn_real *x = s->N + (size_t)(j - s->rank) * nv;
        memset(x, 0, (size_t)nv * sizeof *x);
        x[j] = 1;
        apply(s, x);
    }
}

static void times_mass(const hn_precise_model *m, const hn_real *x, hn_real *out) {
    for (int i = 0; i < m->nv; i++) {
        out[i] = inner(m->nv, m->M + (size_t)i * m->nv, x);
    }
}

// ---- accelerations ----

/// Cholesky factor of S (r x r) and the solution in z.
static hn_status solve_reduced(nullspace *s, int r) {
    // factor, and forward substitution in the same sweep
    for (int j = 0; j < r; j++) {
        hn_real *row = s->S + (size_t)j * r;
        for (int i = 0; i < j; i++) {
            const hn_real *above = s->S + (size_t)i * r;
            row[i] = (row[i] - inner(i, row, above)) / above[i];
        }

        const hn_real pivot = row[j] - inner(j, row, row);
        if (!(pivot > 0)) {
            return HN_ERR_SINGULAR;
        }
        row[j] = sqrtl(pivot);
        s->z[j] = (s->z[j] - inner(j, row, s->z)) / row[j];
    }

    // backward substitution
    for (int j = r - 1; j >= 0; j--) {
        for (int i = j + 1; i < r; i++) {
            s->z[j] -= s->S[(size_t)i * r + j] * s->z[i];
        }
        s->z[j] /= s->S[(size_t)j * r + j];
    }
    return HN_OK;
}

static void reduce(nullspace *s, int r) {
    const int nv = s->m->nv;
    times_mass(s->m, s->c, s->Mc);
    for (int j = 0; j < r; j++) {
        const hn_real *x = s->N + (size_t)j * nv;
        s->z[j] = 0;
        for (int i = 0; i < nv; i++) {
            s->z[j] += x[i] * (s->m->f[i] - s->Mc[i]);
        }
    }
    for (int j = 0; j < r; j++) {
        times_mass(s->m, s->N + (size_t)j * nv, s->y);
        for (int i = j; i < r; i++) {
            s->S[(size_t)i * r + j] = inner(nv, s->N + (size_t)i * nv, s->y);
        }
    }
}

static void find_multipliers(nullspace *s, const hn_real *a, hn_real *lambda) {
    times_mass(s->m, a, s->y);
    for (int i = 0; i < s->m->nv; i++) {
        s->y[i] -= s->m->f[i];
    }
    apply_transposed(s, s->y);
    memset(lambda, 0, (size_t)s->m->nc * sizeof *lambda);
    for (int k = s->rank - 1; k >= 0; k--) {
        hn_real x = s->y[k];
        for (int j = k + 1; j < s->rank; j++) {
            x -= column_of(s, j)[k] * lambda[s->column[j]] * s->length[s->column[j]];
        }
        lambda[s->column[k]] = x / column_of(s, k)[k] / s->length[s->column[k]];
    }
}

static hn_status accelerate(void *ws, hn_real t, const hn_real *q, const hn_real *v, hn_real *a,
                            hn_real *lambda) {
    nullspace *s = ws;
    const int nv = s->m->nv;

    // the shortest acceleration that the loops demand
    hn_precise_model_dynamics(s->m, t, q, v);
    factor(s);
    const int r = nv - s->rank;
    shortest(s, s->m->gamma, s->c);

    // motion along the loops: N' M N z = N' (f - M c)
    make_basis(s);
    reduce(s, r);
    HN_TRY(solve_reduced(s, r));

    // a = c + N z
    memcpy(a, s->c, (size_t)nv * sizeof *a);
    for (int j = 0; j < r; j++) {
        for (int i = 0; i < nv; i++) {
            a[i] += s->N[(size_t)j * nv + i] * s->z[j];
        }
    }

    if (lambda) {
        find_multipliers(s, a, lambda);
    }
    return HN_OK;
}

// ---- closing ----

/// 1: some chosen row is all but a combination of the others here, or vanishes.
static bool is_weak(const nullspace *s) {
    for (int k = 0; k < s->rank; k++) {
        if (fabsl(column_of(s, k)[k]) < WEAK) {
            return true;
        }
    }
    return s->rank < s->n_rows;
}

/// 1: every chosen row is as close to 0 as its rounding.
static bool is_closed(const nullspace *s, const hn_real *q) {
    hn_real most = 1;
    for (int i = 0; i < s->m->nq; i++) {
        most = fmaxl(most, fabsl(q[i]));
    }
    for (int k = 0; k < s->rank; k++) {
        const int i = s->column[k];
        if (fabsl(s->m->phi[i]) > ROUNDING * most * s->length[i]) {
            return false;
        }
    }
    return true;
}

static hn_status close_loops(void *ws, hn_real t, hn_real *q, hn_real *v) {
    nullspace *s = ws;
    const int nv = s->m->nv;

    // rows for this configuration; near a singular one it is left as it is
    choose_rows(ws, t, q);
    hn_precise_model_closure(s->m, t, q);
    factor(s);
    if (is_weak(s)) {
        return HN_OK;
    }

    // positions: Newton, with the shortest correction
    for (int k = 0; !is_closed(s, q); k++) {
        hn_real size = 0;
        shortest(s, s->m->phi, s->y);
        for (int i = 0; i < nv; i++) {
            size = fmaxl(size, fabsl(s->y[i]) / s->m->floor[i]);
        }

        if (k >= MAX_NEWTON || !(size < 1)) {
            return k >= MAX_NEWTON && size < SETTLED ? HN_OK : HN_ERR_NO_CONVERGENCE;
        }

        hn_precise_model_nudge(s->m, q, s->y);
        hn_precise_model_closure(s->m, t, q);
        factor(s);
    }

    // velocities: linear, so one correction
    for (int i = 0; i < s->m->nc; i++) {
        s->gap[i] = s->m->phi_t[i] + inner(nv, s->m->J + (size_t)i * nv, v);
    }
    shortest(s, s->gap, s->y);
    for (int i = 0; i < nv; i++) {
        v[i] += s->y[i];
    }
    return HN_OK;
}

const hn_precise_solver hn_precise_nullspace = {"nullspace", create, choose_rows, accelerate,
                                                close_loops};
