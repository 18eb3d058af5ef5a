// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/ldl.h"

#include "dynamics/compile/symmat.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "expr/construct.h"
#include "linalg/least_heap.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

typedef struct work {
    hn_graph *g;
    hn_symmat *K;
    hn_ldl *out;
    hn_arena *arena;
    char *gone;        ///< per unknown
    char *massive;     ///< coordinates whose own entry of W is not zero
    char *shared;      ///< coordinates that touch the rows of several loops: see SHARED_ROWS
    bool shared_began; ///< one of them has been eliminated
    int *partner;      ///< per unknown: the other half of its pair, -1: alone
    /// eligible unknowns by live neighbours; shared coordinates only when nothing else is left
    hn_least_heap eligible;
    hn_ex *ref; ///< per unknown: reference of its pivot
    int *live;  ///< scratch: live neighbours of a block
    char *marked;
    int cap_rows;
    long long updates; ///< entries changed by the eliminations so far
} work;

/// Beyond this the matrix is dense rather than sparse (a full one of 66 unknowns): unrolled it
/// would take longer to compile than to solve, without bound, so it is left to the dense solve.
enum { MAX_UPDATES = 50000 };

/// A coordinate that touches as many rows as a spatial loop has at most, where there are loops to
/// spare, is shared by legs (a platform's). Rows need not wait for it: what each leg has of its own
/// gives them pivots, and the platform comes last. Otherwise every leg's rows would be coupled with
/// every other's (a hexapod: 3 times the entries of L). If a leg loses a direction, the guard
/// sees it. A row to which its leg gives no pivot at all, as one along a leg of given length, waits
/// for the whole platform: what one of its coordinates gives serves one such row, and not the next.
enum { SHARED_ROWS = 6 };

// ---- setting up ----

static void fill(work *w, const hn_ldl_input *in) {
    for (int i = 0; i < in->nv && !in->W; i++) {
        hn_symmat_set(w->K, i, i, hn_num(1));
    }
    for (int k = 0; in->W && k < in->W->n; k++) {
        hn_symmat_set(w->K, in->W->at[k].row, in->W->at[k].col, in->W->at[k].e);
    }
    for (int k = 0; k < in->J->n; k++) {
        hn_symmat_set(w->K, in->nv + in->J->at[k].row, in->J->at[k].col, in->J->at[k].e);
    }
    for (int k = 0; k < in->J->n; k++) { // counted in `live` before its proper use
        w->shared[in->J->at[k].col] =
            ++w->live[in->J->at[k].col] >= SHARED_ROWS && in->nc >= 2 * SHARED_ROWS;
    }
    for (int i = 0; i < in->nv; i++) {
        w->ref[i] = hn_symmat_get(w->K, i, i);
        w->massive[i] = !hn_is_zero(w->ref[i]);
    }
}

static bool same_pattern(const hn_entries *J, int first, int second, int n) {
    for (int k = 0; k < n; k++) {
        if (J->at[first + k].col != J->at[second + k].col) {
            return false;
        }
    }
    return true;
}

/// Multipliers next to each other that touch the same coordinates.
static void pair_rows(work *w, const hn_ldl_input *in) {
    const hn_entries *J = in->J;
    int start = 0, free_row = -1, free_start = 0, free_n = 0;
    for (int row = 0; row < in->nc; row++) {
        int n = 0;
        while (start + n < J->n && J->at[start + n].row == row) {
            n++;
        }
        if (free_row >= 0 && free_n == n && same_pattern(J, free_start, start, n)) {
            w->partner[in->nv + row] = in->nv + free_row;
            w->partner[in->nv + free_row] = in->nv + row;
            free_row = -1;
        } else {
            free_row = row;
            free_start = start;
            free_n = n;
        }
        start += n;
    }
}

// ---- order ----

/// Live neighbours of an unknown and its partner, into w->live; returns how many. *blocked: a
/// massive coordinate is among them.
static int list_live(work *w, int i, int *blocked) {
    int n = 0, pair[2] = {i, w->partner[i]};
    *blocked = 0;

    // neighbours of either, each once
    for (int p = 0; p < 2 && pair[p] >= 0; p++) {
        const int *list;
        int n_list = hn_symmat_neighbours(w->K, pair[p], &list);

        // the marks are for the next call
        for (int k = 0; k < n_list; k++) {
            int j = list[k];
            if (w->gone[j] || w->marked[j] || j == pair[0] || j == pair[1] ||
                hn_is_zero(hn_symmat_get(w->K, pair[p], j))) {
                continue;
            }
            w->marked[j] = 1;
            w->live[n++] = j;
            *blocked |= j < w->out->nv && w->massive[j] && (!w->shared[j] || w->shared_began);
        }
    }
    for (int k = 0; k < n; k++) {
        w->marked[w->live[k]] = 0;
    }
    return n;
}

static void update_degree(work *w, int i) {
    int blocked, partner = w->partner[i];
    int n = list_live(w, i, &blocked);
    int has_pivot = !hn_is_zero(hn_symmat_get(w->K, i, i)) &&
                    (partner < 0 || !hn_is_zero(hn_symmat_get(w->K, partner, partner)));
    int eligible = has_pivot && (i < w->out->nv || !blocked);

    // a pair goes by its first half
    const int first = partner >= 0 && partner < i ? partner : i;
    if (eligible) {
        hn_least_heap_set(&w->eligible, first, n + (w->shared[first] ? w->out->n : 0));
    } else {
        hn_least_heap_remove(&w->eligible, first);
    }
}

// ---- elimination ----

/// Keeps a pivot and its reference for the run, or checks them at once when both are numbers.
/// Returns 0 if the pivot is lost.
static bool guard(work *w, hn_ex pivot, hn_ex ref) {
    double p, r;
    if (hn_is_number(pivot, &p)) {
        return p != 0 && (!hn_is_number(ref, &r) || fabs(p) >= HN_PIVOT_GUARD * fabs(r));
    }
    if (pivot.n == ref.n && ref.c != 0 && fabs(pivot.c) >= HN_PIVOT_GUARD * fabs(ref.c)) {
        return true; // the same value: nothing was subtracted from it
    }
    w->out->guard[w->out->n_guards][0] = pivot;
    w->out->guard[w->out->n_guards][1] = ref;
    w->out->n_guards++;
    return true;
}

static hn_ex reciprocal(work *w, hn_ex e) {
    return hn_div(w->g, hn_num(1), e);
}

/// Inverse of the pivot block. Returns 0 if it is singular by structure.
static bool invert(work *w, const int pair[2], hn_ex inverse[3]) {
    hn_graph *g = w->g;

    // 1 x 1
    hn_ex a = hn_symmat_get(w->K, pair[0], pair[0]);
    inverse[1] = inverse[2] = hn_num(0);
    if (pair[1] < 0) {
        if (!guard(w, a, w->ref[pair[0]])) {
            return false;
        }
        inverse[0] = reciprocal(w, a);
        return true;
    }

    // 2 x 2
    hn_ex b = hn_symmat_get(w->K, pair[0], pair[1]), c = hn_symmat_get(w->K, pair[1], pair[1]);
    hn_ex det = hn_sub(g, hn_mul(g, a, c), hn_mul(g, b, b));
    if (hn_is_zero(det) || !guard(w, det, hn_mul(g, w->ref[pair[0]], w->ref[pair[1]]))) {
        return false;
    }

    hn_ex t = reciprocal(w, det);
    inverse[0] = hn_mul(g, c, t);
    inverse[1] = hn_neg(hn_mul(g, b, t));
    inverse[2] = hn_mul(g, a, t);
    return true;
}

static bool reserve_rows(work *w, int more) {
    hn_ldl *out = w->out;
    if (out->nnz + more <= w->cap_rows) {
        return true;
    }
    int cap = 2 * (out->nnz + more) + 64;
    int *row = hn_arena_ints(w->arena, (size_t)cap);
    hn_ex(*L)[2] = hn_arena_get(w->arena, (size_t)cap * sizeof *L);
    if (!row || !L) {
        return false;
    }
    if (out->nnz) {
        memcpy(row, out->row, (size_t)out->nnz * sizeof *row);
        memcpy(L, out->L, (size_t)out->nnz * sizeof *L);
    }
    out->row = row;
    out->L = L;
    w->cap_rows = cap;
    return true;
}

static hn_ex two_products(hn_graph *g, hn_ex a, hn_ex b, hn_ex c, hn_ex d) {
    hn_ex first = hn_mul(g, a, b);
    return hn_is_zero(c) || hn_is_zero(d) ? first : hn_add(g, first, hn_mul(g, c, d));
}

/// Subtracts the block's part from what is left of the matrix.
static void reduce(work *w, const int pair[2], int first_row, int n, int counts) {
    hn_ldl *out = w->out;
    for (int a = 0; a < n; a++) {
        int i = out->row[first_row + a];
        const hn_ex *L = out->L[first_row + a];
        for (int b = a; b < n; b++) {
            int j = out->row[first_row + b];
            hn_ex k1 = hn_symmat_get(w->K, j, pair[0]);
            hn_ex k2 = pair[1] >= 0 ? hn_symmat_get(w->K, j, pair[1]) : hn_num(0);
            hn_ex part = two_products(w->g, L[0], k1, L[1], k2);
            if (hn_is_zero(part)) {
                continue;
            }
            hn_symmat_set(w->K, i, j, hn_sub(w->g, hn_symmat_get(w->K, i, j), part));
            if (i == j && i >= out->nv && counts) {
                w->ref[i] = hn_sub(w->g, w->ref[i], part);
            }
        }
    }
}

/// Adds what the shared coordinates that are still to come would have given to a multiplier's
/// sum: a pivot is small or not against all of it.
static void add_shared(work *w, int i, int n) {
    for (int k = 0; k < n && i >= w->out->nv; k++) {
        const int j = w->live[k];
        if (j < w->out->nv && w->massive[j]) {
            const hn_ex J = hn_symmat_get(w->K, i, j);
            const hn_ex part = hn_div(w->g, hn_mul(w->g, J, J), w->ref[j]);
            w->ref[i] = hn_sub(w->g, w->ref[i], part);
        }
    }
}

/// Takes the unknowns of a pivot block out of what is left.
static void remove_unknowns(work *w, const int pair[2]) {
    hn_ldl *out = w->out;
    int at = out->block[out->n_blocks];
    for (int p = 0; p < 2 && pair[p] >= 0; p++) {
        out->unknown[at++] = pair[p];
        w->gone[pair[p]] = 1;
        hn_least_heap_remove(&w->eligible, pair[p]);
        if (pair[p] >= out->nv) {
            out->row_ref[pair[p] - out->nv] = w->ref[pair[p]];
        }
    }
    out->block[out->n_blocks + 1] = at;
}

/// The column of L of a pivot block: against its n live neighbours, in w->live.
static void fill_column(work *w, const int pair[2], int n) {
    hn_ldl *out = w->out;
    const hn_ex *inverse = out->Dinv[out->n_blocks];
    for (int k = 0; k < n; k++) {
        int row = w->live[k];
        hn_ex k1 = hn_symmat_get(w->K, row, pair[0]);
        hn_ex k2 = pair[1] >= 0 ? hn_symmat_get(w->K, row, pair[1]) : hn_num(0);
        out->row[out->nnz] = row;
        out->L[out->nnz][0] = two_products(w->g, k1, inverse[0], k2, inverse[1]);
        out->L[out->nnz][1] =
            pair[1] >= 0 ? two_products(w->g, k1, inverse[1], k2, inverse[2]) : hn_num(0);
        out->nnz++;
    }
}

static hn_status eliminate(work *w, int i) {
    hn_ldl *out = w->out;
    int pair[2] = {i, w->partner[i]}, blocked;
    int n = list_live(w, i, &blocked);
    hn_ex *inverse = out->Dinv[out->n_blocks];
    if (!reserve_rows(w, n)) {
        return HN_ERR_MEMORY;
    }

    // the pivot block, guarded
    add_shared(w, pair[0], n);
    if (pair[1] >= 0) {
        add_shared(w, pair[1], n);
    }
    if (!invert(w, pair, inverse)) {
        out->available = 0;
        return HN_OK;
    }

    // a matrix that is dense rather than sparse is left to the dense solve
    w->updates += (long long)n * (n + 1) / 2;
    if (w->updates > MAX_UPDATES) {
        out->available = 0;
        return HN_OK;
    }

    const int first_row = out->nnz;
    w->shared_began |= w->shared[pair[0]];
    remove_unknowns(w, pair);
    fill_column(w, pair, n);

    // what is left of the matrix, and the degrees of the neighbours
    reduce(w, pair, first_row, n, i < out->nv && w->massive[i]);
    out->n_blocks++;
    out->column[out->n_blocks] = out->nnz;
    for (int k = 0; k < n; k++) {
        update_degree(w, out->row[first_row + k]);
    }
    HN_TRY(hn_graph_status(w->g));
    return hn_symmat_failed(w->K) ? HN_ERR_MEMORY : HN_OK;
}

static hn_status allocate(work *w, hn_ldl *out, int nv, int nc) {
    size_t n = (size_t)(nv + nc);
    memset(out, 0, sizeof *out);
    out->n = nv + nc;
    out->nv = nv;
    out->nc = nc;

    // the result
    out->unknown = hn_arena_ints(w->arena, n);
    out->block = hn_arena_ints(w->arena, n + 1);
    out->column = hn_arena_ints(w->arena, n + 1);
    out->Dinv = hn_arena_get(w->arena, n * sizeof *out->Dinv);
    out->guard = hn_arena_get(w->arena, n * sizeof *out->guard);
    out->row_ref = hn_arena_get(w->arena, ((size_t)nc + 1) * sizeof *out->row_ref);

    // scratch
    w->gone = hn_arena_get(w->arena, n);
    w->massive = hn_arena_get(w->arena, n);
    w->shared = hn_arena_get(w->arena, n);
    w->marked = hn_arena_get(w->arena, n);
    w->partner = hn_arena_ints(w->arena, n);
    const bool has_heap = hn_least_heap_init(&w->eligible, w->arena, nv + nc);
    w->live = hn_arena_ints(w->arena, n);
    w->ref = hn_arena_get(w->arena, n * sizeof *w->ref);

    // no unknown has a partner yet
    if (!has_heap || hn_arena_failed(w->arena)) {
        return HN_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        w->partner[i] = -1;
    }
    return HN_OK;
}

hn_status hn_ldl_build(hn_graph *g, const hn_ldl_input *in, hn_arena *arena, hn_ldl *out) {
    work w = {.g = g, .out = out, .arena = arena};
    hn_status status = allocate(&w, out, in->nv, in->nc);
    if (status != HN_OK) {
        return status;
    }

    // the matrix, and the degree of every unknown
    w.K = hn_symmat_create(out->n);
    if (!w.K) {
        return HN_ERR_MEMORY;
    }
    fill(&w, in);
    if (in->pairs) {
        pair_rows(&w, in);
    }
    for (int i = 0; i < out->n; i++) {
        update_degree(&w, i);
    }

    // the next of least degree until all are gone, or none is eligible
    out->available = 1;
    while (status == HN_OK && out->available && out->block[out->n_blocks] < out->n) {
        int next = hn_least_heap_top(&w.eligible);
        if (next < 0) {
            out->available = 0;
        } else {
            status = eliminate(&w, next);
        }
    }

    hn_symmat_free(w.K);
    return status;
}

hn_status hn_ldl_solve(hn_graph *g, const hn_ldl *ldl, const hn_ex *rhs, hn_ex *x) {
    // forward
    memmove(x, rhs, (size_t)ldl->n * sizeof *x);
    for (int b = 0; b < ldl->n_blocks; b++) {
        const int *at = &ldl->unknown[ldl->block[b]];
        int two = ldl->block[b + 1] - ldl->block[b] == 2;
        for (int k = ldl->column[b]; k < ldl->column[b + 1]; k++) {
            hn_ex part =
                two_products(g, ldl->L[k][0], x[at[0]], ldl->L[k][1], two ? x[at[1]] : hn_num(0));
            x[ldl->row[k]] = hn_sub(g, x[ldl->row[k]], part);
        }
    }

    // back
    for (int b = ldl->n_blocks - 1; b >= 0; b--) {
        const int *at = &ldl->unknown[ldl->block[b]];
        const hn_ex *D = ldl->Dinv[b];
        int two = ldl->block[b + 1] - ldl->block[b] == 2;
        hn_ex y1 = x[at[0]], y2 = two ? x[at[1]] : hn_num(0);

        hn_ex z[2] = {two_products(g, D[0], y1, D[1], y2), two_products(g, D[1], y1, D[2], y2)};
        for (int k = ldl->column[b]; k < ldl->column[b + 1]; k++) {
            hn_ex known = x[ldl->row[k]];
            z[0] = hn_sub(g, z[0], hn_mul(g, ldl->L[k][0], known));
            z[1] = hn_sub(g, z[1], hn_mul(g, ldl->L[k][1], known));
        }
        x[at[0]] = z[0];
        if (two) {
            x[at[1]] = z[1];
        }
    }
    return hn_graph_status(g);
}
