#include "dynamics/ldl.h"

#include <string.h>

/// A growing list of terms that are added up when the entry is needed.
typedef struct terms {
    hn_ex *t;
    int n, cap;
} terms;

/// One unknown: its neighbours in the elimination graph and the entries of K between.
typedef struct unknown {
    int *neighbour, *entry;
    int n, cap;
    int eliminated;
    terms own;       ///< diagonal: as given, and what speeds left there
    terms from_rows; ///< what multipliers left there
    int has_pivot;   ///< the diagonal is structurally not zero
} unknown;

typedef struct work {
    hn_graph *g;
    hn_arena *arena;
    const hn_ldl_input *in;
    hn_ldl *out;
    int n;
    unknown *u;
    terms *entries;
    int n_entries, entries_cap;
    int L_cap, n_L, n_done;
} work;

/// A longer copy in the arena; the old one stays there unused (doubling keeps that below what is used).
static void *grow(hn_arena *arena, void *old, size_t used, size_t size) {
    void *p = hn_arena_get(arena, size);
    if (p && used > 0) {
        memcpy(p, old, used);
    }
    return p;
}

static int add_term(hn_arena *arena, terms *list, hn_ex e) {
    if (hn_is_zero(e)) {
        return 1;
    }
    if (list->n == list->cap) {
        const int cap = list->cap ? 2 * list->cap : 4;
        hn_ex *t = grow(arena, list->t, (size_t)list->n * sizeof *t, (size_t)cap * sizeof *t);
        if (!t) {
            return 0;
        }
        list->t = t;
        list->cap = cap;
    }
    list->t[list->n++] = e;
    return 1;
}

static int add_neighbour(work *w, int i, int j, int entry) {
    unknown *u = &w->u[i];
    if (u->n == u->cap) {
        const int cap = u->cap ? 2 * u->cap : 4;
        int *nb = grow(w->arena, u->neighbour, (size_t)u->n * sizeof *nb, (size_t)cap * sizeof *nb);
        int *en = grow(w->arena, u->entry, (size_t)u->n * sizeof *en, (size_t)cap * sizeof *en);
        if (!nb || !en) {
            return 0;
        }
        u->neighbour = nb;
        u->entry = en;
        u->cap = cap;
    }
    u->neighbour[u->n] = j;
    u->entry[u->n++] = entry;
    return 1;
}

/// The entry between i and j; made when there is none yet. -1 when memory is out.
static int find_entry(work *w, int i, int j) {
    const unknown *u = &w->u[i];
    for (int k = 0; k < u->n; k++) {
        if (u->neighbour[k] == j) {
            return u->entry[k];
        }
    }
    if (w->n_entries == w->entries_cap) {
        const int cap = w->entries_cap ? 2 * w->entries_cap : 64;
        terms *t =
            grow(w->arena, w->entries, (size_t)w->n_entries * sizeof *t, (size_t)cap * sizeof *t);
        if (!t) {
            return -1;
        }
        w->entries = t;
        w->entries_cap = cap;
    }
    const int e = w->n_entries++;
    return add_neighbour(w, i, j, e) && add_neighbour(w, j, i, e) ? e : -1;
}

static int put_entry(work *w, int i, int j, hn_ex e) {
    if (hn_is_zero(e)) {
        return 1;
    }
    const int at = find_entry(w, i, j);
    return at >= 0 && add_term(w->arena, &w->entries[at], e);
}

static hn_ex sum_terms(hn_graph *g, const terms *list) {
    return list->n ? hn_sum(g, list->t, list->n) : hn_num(0);
}

/// Fills the graph of K from its structurally nonzero entries.
static int load_pattern(work *w) {
    const hn_ldl_input *in = w->in;
    const int nv = in->nv;
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < i; j++) {
            if (!put_entry(w, i, j, in->A[i * nv + j])) {
                return 0;
            }
        }
        if (!add_term(w->arena, &w->u[i].own, in->A[i * nv + i])) {
            return 0;
        }
        w->u[i].has_pivot = w->u[i].own.n > 0;
    }
    for (int i = 0; i < in->nc; i++) {
        for (int j = 0; j < nv; j++) {
            if (!put_entry(w, nv + i, j, in->J[i * nv + j])) {
                return 0;
            }
        }
    }
    return 1;
}

static int degree(const work *w, int i) {
    int n = 0;
    for (int k = 0; k < w->u[i].n; k++) {
        n += !w->u[w->u[i].neighbour[k]].eliminated;
    }
    return n;
}

/// 1 if i may be the next pivot: its diagonal is there, and a multiplier waits for the speeds it touches.
static int is_ready(const work *w, int i) {
    const unknown *u = &w->u[i];
    if (u->eliminated || !u->has_pivot) {
        return 0;
    }
    for (int k = 0; k < u->n && i >= w->in->nv; k++) {
        const int j = u->neighbour[k];
        if (j < w->in->nv && !w->u[j].eliminated && w->u[j].has_pivot) {
            return 0;
        }
    }
    return 1;
}

/// The ready unknown of least degree, or -1.
static int choose_pivot(const work *w) {
    int best = -1, best_degree = 0;
    for (int i = 0; i < w->n; i++) {
        if (is_ready(w, i)) {
            const int d = degree(w, i);
            if (best < 0 || d < best_degree) {
                best = i;
                best_degree = d;
            }
        }
    }
    return best;
}

/// Another multiplier of the same loop that is ready too and linked to this one, or -1.
static int choose_partner(const work *w, int i) {
    const int nv = w->in->nv;
    if (i < nv || !w->in->row_loop) {
        return -1;
    }
    for (int k = 0; k < w->u[i].n; k++) {
        const int j = w->u[i].neighbour[k];
        if (j >= nv && w->in->row_loop[j - nv] == w->in->row_loop[i - nv] && is_ready(w, j)) {
            return j;
        }
    }
    return -1;
}

static hn_ex pivot_of(const work *w, int i) {
    terms all = {0};
    all.n = w->u[i].own.n + w->u[i].from_rows.n;
    all.t = hn_arena_get(w->arena, (size_t)(all.n + 1) * sizeof *all.t);
    if (!all.t) {
        return hn_num(0);
    }
    if (w->u[i].own.n) {
        memcpy(all.t, w->u[i].own.t, (size_t)w->u[i].own.n * sizeof *all.t);
    }
    if (w->u[i].from_rows.n) {
        memcpy(all.t + w->u[i].own.n, w->u[i].from_rows.t,
               (size_t)w->u[i].from_rows.n * sizeof *all.t);
    }
    return sum_terms(w->g, &all);
}

static void add_guard(work *w, hn_ex pivot, hn_ex reference) {
    if (!hn_ex_same(pivot, reference) && !hn_is_zero(reference)) {
        w->out->guards[w->out->n_guards++] = (hn_ldl_guard){pivot, reference};
    }
}

/// A speed is measured by its own inertia, a multiplier by what the speeds alone gave it: -J A^-1 J' without the other rows.
static void guard_pivot(work *w, int i, hn_ex pivot) {
    const unknown *u = &w->u[i];
    add_guard(w, pivot, i < w->in->nv ? w->in->A[i * w->in->nv + i] : sum_terms(w->g, &u->own));
}

static hn_ex recip(hn_graph *g, hn_ex e) {
    return hn_div(g, hn_num(1), e);
}

/// Writes the inverse of the pivot block and its guards.
static void invert_block(work *w, const int *p, int size, hn_ex inverse[3]) {
    hn_graph *g = w->g;
    const hn_ex a = pivot_of(w, p[0]);
    guard_pivot(w, p[0], a);
    if (size == 1) {
        inverse[0] = recip(g, a);
        inverse[1] = inverse[2] = hn_num(0);
        return;
    }
    const hn_ex c = pivot_of(w, p[1]);
    guard_pivot(w, p[1], c);
    const hn_ex b = sum_terms(g, &w->entries[find_entry(w, p[0], p[1])]);
    const hn_ex ac = hn_mul(g, a, c);
    const hn_ex det = hn_sub(g, ac, hn_mul(g, b, b));
    add_guard(w, det, ac);
    const hn_ex r = recip(g, det);
    inverse[0] = hn_mul(g, c, r);
    inverse[1] = hn_neg(hn_mul(g, b, r));
    inverse[2] = hn_mul(g, a, r);
}

/// Unknowns that are still there and touch the block, once each; returns how many.
static int gather_rows(const work *w, const int *p, int size, int *rows) {
    int n = 0;
    for (int k = 0; k < size; k++) {
        const unknown *u = &w->u[p[k]];
        for (int e = 0; e < u->n; e++) {
            const int j = u->neighbour[e];
            int known = w->u[j].eliminated || j == p[0] || j == p[size - 1];
            for (int i = 0; i < n && !known; i++) {
                known = rows[i] == j;
            }
            if (!known) {
                rows[n++] = j;
            }
        }
    }
    return n;
}

/// The entry between i and j as it stands, or zero.
static hn_ex entry_value(const work *w, int i, int j) {
    const unknown *u = &w->u[i];
    for (int k = 0; k < u->n; k++) {
        if (u->neighbour[k] == j) {
            return sum_terms(w->g, &w->entries[u->entry[k]]);
        }
    }
    return hn_num(0);
}

static int reserve_L(work *w, int n) {
    if (w->n_L + n <= w->L_cap) {
        return 1;
    }
    const int cap = 2 * (w->n_L + n) + 64;
    hn_ldl *out = w->out;
    int *row = grow(w->arena, out->row, (size_t)w->n_L * sizeof *row, (size_t)cap * sizeof *row);
    hn_ex *L = grow(w->arena, out->L, (size_t)w->n_L * sizeof *L, (size_t)cap * sizeof *L);
    if (!row || !L) {
        return 0;
    }
    out->row = row;
    out->L = L;
    w->L_cap = cap;
    return 1;
}

/// A_ij -= l_i . a_j for every pair of rows; l: rows x 2, a: rows x 2.
static int update_rest(work *w, const int *rows, int n, const hn_ex *l, const hn_ex *a, int size,
                       int is_row) {
    hn_graph *g = w->g;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            for (int k = 0; k < size; k++) {
                const hn_ex term = hn_neg(hn_mul(g, l[2 * i + k], a[2 * j + k]));
                if (hn_is_zero(term)) {
                    continue;
                }
                unknown *u = &w->u[rows[i]];
                const int ok = i == j ? add_term(w->arena, is_row ? &u->from_rows : &u->own, term)
                                      : put_entry(w, rows[i], rows[j], term);
                if (!ok) {
                    return 0;
                }
                w->u[rows[i]].has_pivot |= i == j;
            }
        }
    }
    return 1;
}

/// Eliminates one block: its inverse, its columns of L, and what it leaves to the rest.
static int eliminate(work *w, const int *p, int size, int *rows, hn_ex *l, hn_ex *a) {
    hn_graph *g = w->g;
    hn_ldl *out = w->out;
    hn_ex *inv = out->inverse + 3 * out->n_blocks;
    invert_block(w, p, size, inv);
    const int n = gather_rows(w, p, size, rows);
    for (int i = 0; i < n; i++) {
        a[2 * i] = entry_value(w, rows[i], p[0]);
        a[2 * i + 1] = size == 2 ? entry_value(w, rows[i], p[1]) : hn_num(0);
        l[2 * i] = hn_add(g, hn_mul(g, a[2 * i], inv[0]), hn_mul(g, a[2 * i + 1], inv[1]));
        l[2 * i + 1] = hn_add(g, hn_mul(g, a[2 * i], inv[1]), hn_mul(g, a[2 * i + 1], inv[2]));
    }
    for (int k = 0; k < size; k++) {
        if (!reserve_L(w, n)) {
            return 0;
        }
        w->u[p[k]].eliminated = 1;
        out->order[w->n_done++] = p[k];
        for (int i = 0; i < n; i++) {
            if (!hn_is_zero(l[2 * i + k])) {
                out->row[w->n_L] = rows[i];
                out->L[w->n_L++] = l[2 * i + k];
            }
        }
        out->start[w->n_done] = w->n_L;
    }
    out->block[++out->n_blocks] = w->n_done;
    return update_rest(w, rows, n, l, a, size, p[0] >= w->in->nv);
}

/// Arrays whose size is known from the start.
static int reserve(work *w) {
    const size_t n = (size_t)w->n;
    hn_ldl *out = w->out;
    w->u = hn_arena_get(w->arena, (n + 1) * sizeof *w->u);
    out->block = hn_arena_ints(w->arena, n + 2);
    out->order = hn_arena_ints(w->arena, n + 1);
    out->start = hn_arena_ints(w->arena, n + 2);
    out->inverse = hn_arena_get(w->arena, (3 * n + 1) * sizeof *out->inverse);
    out->guards = hn_arena_get(w->arena, (3 * n + 1) * sizeof *out->guards);
    return !hn_arena_failed(w->arena);
}

hn_status hn_ldl_factor(hn_graph *g, const hn_ldl_input *in, hn_arena *arena, hn_ldl *out) {
    *out = (hn_ldl){.n = in->nv + in->nc, .nv = in->nv, .nc = in->nc};
    work w = {.g = g, .arena = arena, .in = in, .out = out, .n = out->n};
    int ok = reserve(&w) && load_pattern(&w);
    int *rows = hn_arena_ints(arena, (size_t)out->n + 1);
    hn_ex *l = hn_arena_get(arena, (2 * (size_t)out->n + 2) * sizeof *l);
    hn_ex *a = hn_arena_get(arena, (2 * (size_t)out->n + 2) * sizeof *a);
    ok = ok && rows && l && a;
    while (ok && w.n_done < w.n) {
        int p[2] = {choose_pivot(&w), -1};
        if (p[0] < 0) {
            return HN_OK; // no static order: available stays 0
        }
        p[1] = choose_partner(&w, p[0]);
        ok = eliminate(&w, p, p[1] < 0 ? 1 : 2, rows, l, a);
    }
    out->available = ok;
    return ok && !hn_graph_failed(g) ? HN_OK : HN_ERR_MEMORY;
}

void hn_ldl_solve(hn_graph *g, const hn_ldl *f, const hn_ex *r1, const hn_ex *r2, hn_ex *x,
                  hn_ex *y, hn_ex *b) {
    for (int i = 0; i < f->n; i++) {
        b[i] = i < f->nv ? r1[i] : r2[i - f->nv];
    }
    for (int k = 0; k < f->n; k++) {
        for (int e = f->start[k]; e < f->start[k + 1]; e++) {
            b[f->row[e]] = hn_sub(g, b[f->row[e]], hn_mul(g, f->L[e], b[f->order[k]]));
        }
    }
    for (int m = f->n_blocks - 1; m >= 0; m--) {
        const int first = f->block[m], two = f->block[m + 1] - first == 2;
        const hn_ex *inv = f->inverse + 3 * m;
        const int p = f->order[first], q = f->order[first + two];
        const hn_ex bp = b[p], bq = b[q];
        b[p] = hn_mul(g, inv[0], bp);
        if (two) {
            b[p] = hn_add(g, b[p], hn_mul(g, inv[1], bq));
            b[q] = hn_add(g, hn_mul(g, inv[1], bp), hn_mul(g, inv[2], bq));
        }
        for (int k = first; k < f->block[m + 1]; k++) {
            for (int e = f->start[k]; e < f->start[k + 1]; e++) {
                b[f->order[k]] = hn_sub(g, b[f->order[k]], hn_mul(g, f->L[e], b[f->row[e]]));
            }
        }
    }
    memcpy(x, b, (size_t)f->nv * sizeof *x);
    for (int i = 0; i < f->nc && y; i++) {
        y[i] = hn_neg(b[f->nv + i]);
    }
}

void hn_ldl_solve_numbers(const hn_ldl *f, const double *L, const double *inverse, const double *r1,
                          const double *r2, double *x, double *y, double *b) {
    for (int i = 0; i < f->n; i++) {
        b[i] = i < f->nv ? (r1 ? r1[i] : 0) : (r2 ? r2[i - f->nv] : 0);
    }
    for (int k = 0; k < f->n; k++) {
        for (int e = f->start[k]; e < f->start[k + 1]; e++) {
            b[f->row[e]] -= L[e] * b[f->order[k]];
        }
    }
    for (int m = f->n_blocks - 1; m >= 0; m--) {
        const int first = f->block[m], two = f->block[m + 1] - first == 2;
        const double *inv = inverse + 3 * m;
        const int p = f->order[first], q = f->order[first + two];
        const double bp = b[p], bq = b[q];
        b[p] = inv[0] * bp;
        if (two) {
            b[p] += inv[1] * bq;
            b[q] = inv[1] * bp + inv[2] * bq;
        }
        for (int k = first; k < f->block[m + 1]; k++) {
            for (int e = f->start[k]; e < f->start[k + 1]; e++) {
                b[f->order[k]] -= L[e] * b[f->row[e]];
            }
        }
    }
    memcpy(x, b, (size_t)f->nv * sizeof *x);
    for (int i = 0; i < f->nc && y; i++) {
        y[i] = -b[f->nv + i];
    }
}
