// SPDX-License-Identifier: GPL-3.0-or-later
// Every derivative is a directional one, forward over the expressions of R, f, J v + phi_t and
// gamma, a sweep per velocity: what does not depend on a coordinate is never visited. a and lambda
// are symbols of the tape's own; their names hold a blank, which no formula can spell.
#include "dynamics/evaluate/linearise.h"

#include "dynamics/compile/direction.h"
#include "expr/construct.h"
#include "expr/diff.h"
#include "expr/tape.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// One term: its entries that are not identically zero. A vector's values are all its entries; a
/// matrix's are those of the list, or all of them row by row.
typedef struct term_values {
    double *values;
    bool listed;
    int n_entries;
    int *rows, *cols;
    int first, end; ///< of the tape's outputs, those of this term
} term_values;

struct hn_linear {
    int nq, nv, nc, n_params;
    const hn_pull_log *pulls; ///< NULL: none
    hn_tape *tape;
    double *x; ///< the tape's workspace: q, v, t, a, lambda, parameters, pulls first
    double **target;
    int *source, *entry; ///< where in the workspace, and which entry of its term, each comes from
    int n_scatter;
    term_values terms[HN_LINEAR_COUNT];
    long long count;
};

/// While it is built.
typedef struct builder {
    hn_linear *l;
    const hn_system *sys;
    hn_graph *g;
    hn_arena *arena; ///< of what outlives the building
    hn_ex *a, *lambda;
    hn_ex *residual, *speed_gap;
    hn_ex *column; ///< max(nv, nc): one directional derivative
    hn_entries terms[HN_LINEAR_COUNT];
} builder;

// ---- expressions ----

static hn_ex make_symbol(hn_graph *g, const char *kind, int i) {
    char name[32];
    snprintf(name, sizeof name, "%s %d", kind, i + 1);
    return hn_symbol(g, name, NULL);
}

static hn_status make_symbols(builder *b) {
    const hn_system *sys = b->sys;
    const size_t nv = (size_t)sys->nv, nc = (size_t)sys->nc;
    b->a = calloc(nv + 1, sizeof *b->a);
    b->lambda = calloc(nc + 1, sizeof *b->lambda);
    b->residual = calloc(nv + 1, sizeof *b->residual);
    b->speed_gap = calloc(nc + 1, sizeof *b->speed_gap);
    b->column = calloc(nv + nc + 1, sizeof *b->column);
    if (!b->a || !b->lambda || !b->residual || !b->speed_gap || !b->column) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < sys->nv; i++) {
        b->a[i] = make_symbol(b->g, "a of speed", i);
    }
    for (int i = 0; i < sys->nc; i++) {
        b->lambda[i] = make_symbol(b->g, "lambda of row", i);
    }
    return HN_OK;
}

/// R of (1) and J v + phi_t: sums are gathered row by row.
static hn_status make_sums(builder *b) {
    const hn_system *sys = b->sys;
    hn_graph *g = b->g;

    // M a - f
    for (int i = 0; i < sys->nv; i++) {
        b->residual[i] = hn_neg(sys->f[i]);
    }
    for (int k = 0; k < sys->M.n; k++) {
        const hn_entry *e = &sys->M.at[k];
        b->residual[e->row] = hn_add(g, b->residual[e->row], hn_mul(g, e->e, b->a[e->col]));
        if (e->row != e->col) {
            b->residual[e->col] = hn_add(g, b->residual[e->col], hn_mul(g, e->e, b->a[e->row]));
        }
    }

    // phi_t, then J v and -J' lambda along the entries of J
    for (int i = 0; i < sys->nc; i++) {
        b->speed_gap[i] = sys->phi_t[i];
    }
    for (int k = 0; k < sys->J.n; k++) {
        const hn_entry *e = &sys->J.at[k];
        b->residual[e->col] = hn_sub(g, b->residual[e->col], hn_mul(g, e->e, b->lambda[e->row]));
        b->speed_gap[e->row] = hn_add(g, b->speed_gap[e->row], hn_mul(g, e->e, sys->v[e->col]));
    }
    return hn_graph_status(g);
}

static int index_of(hn_linear_term term) {
    const int k = __builtin_ctz((unsigned)term);
    HN_ASSERT(k < HN_LINEAR_COUNT && (1u << k) == (unsigned)term);
    return k;
}

static void put_list(builder *b, hn_linear_term term, const hn_ex *list, int n) {
    for (int i = 0; i < n; i++) {
        hn_entries_add(&b->terms[index_of(term)], i, 0, list[i]);
    }
}

static void put_column(builder *b, hn_linear_term term, int j, int n, double sign) {
    for (int i = 0; i < n; i++) {
        hn_entries_add(&b->terms[index_of(term)], i, j, hn_scale(sign, b->column[i]));
    }
}

static void differentiate_by_position(builder *b, unsigned terms, int j) {
    const hn_system *sys = b->sys;
    int symbols[HN_DIRECTION_MOST];
    hn_ex seed[HN_DIRECTION_MOST];
    const int n = hn_direction_of_speed(sys, j, symbols, seed);
    if (terms & HN_LINEAR_K) {
        hn_diff_forward(b->g, b->residual, sys->nv, symbols, seed, n, b->column);
        put_column(b, HN_LINEAR_K, j, sys->nv, 1);
    }
    if (terms & HN_LINEAR_V) {
        hn_diff_forward(b->g, b->speed_gap, sys->nc, symbols, seed, n, b->column);
        put_column(b, HN_LINEAR_V, j, sys->nc, 1);
    }
    if (terms & HN_LINEAR_GAMMA_Q) {
        hn_diff_forward(b->g, sys->gamma, sys->nc, symbols, seed, n, b->column);
        put_column(b, HN_LINEAR_GAMMA_Q, j, sys->nc, 1);
    }
}

static void differentiate_by_speed(builder *b, unsigned terms, int j) {
    const hn_system *sys = b->sys;
    const int symbol = sys->v_symbols[j];
    const hn_ex one = hn_num(1);
    if (terms & HN_LINEAR_C) {
        hn_diff_forward(b->g, sys->f, sys->nv, &symbol, &one, 1, b->column);
        put_column(b, HN_LINEAR_C, j, sys->nv, -1);
    }
    if (terms & HN_LINEAR_GAMMA_V) {
        hn_diff_forward(b->g, sys->gamma, sys->nc, &symbol, &one, 1, b->column);
        put_column(b, HN_LINEAR_GAMMA_V, j, sys->nc, 1);
    }
}

static void put_mass(builder *b) {
    hn_entries *out = &b->terms[index_of(HN_LINEAR_M)];
    for (int k = 0; k < b->sys->M.n; k++) {
        const hn_entry *e = &b->sys->M.at[k];
        hn_entries_add(out, e->row, e->col, e->e);
        if (e->row != e->col) {
            hn_entries_add(out, e->col, e->row, e->e);
        }
    }
}

static void put_jacobian(builder *b) {
    for (int k = 0; k < b->sys->J.n; k++) {
        const hn_entry *e = &b->sys->J.at[k];
        hn_entries_add(&b->terms[index_of(HN_LINEAR_J)], e->row, e->col, e->e);
    }
}

static hn_status make_terms(builder *b, unsigned terms) {
    const hn_system *sys = b->sys;
    const struct {
        hn_linear_term term;
        const hn_ex *list;
        int n;
    } vectors[] = {{HN_LINEAR_RESIDUAL, b->residual, sys->nv},
                   {HN_LINEAR_PHI, sys->phi, sys->nc},
                   {HN_LINEAR_SPEED_GAP, b->speed_gap, sys->nc},
                   {HN_LINEAR_F, sys->f, sys->nv},
                   {HN_LINEAR_GAMMA, sys->gamma, sys->nc}};

    // vectors
    for (size_t k = 0; k < sizeof vectors / sizeof vectors[0]; k++) {
        if (terms & vectors[k].term) {
            put_list(b, vectors[k].term, vectors[k].list, vectors[k].n);
        }
    }

    // matrices that the system has anyway
    if (terms & HN_LINEAR_M) {
        put_mass(b);
    }
    if (terms & HN_LINEAR_J) {
        put_jacobian(b);
    }

    // derivatives, a column for each velocity
    for (int j = 0; j < sys->nv; j++) {
        differentiate_by_position(b, terms, j);
        differentiate_by_speed(b, terms, j);
    }

    HN_TRY(hn_graph_status(b->g));
    int failed = 0;
    for (int k = 0; k < HN_LINEAR_COUNT; k++) {
        failed |= b->terms[k].failed;
    }
    return failed ? HN_ERR_MEMORY : HN_OK;
}

// ---- the tape ----

static int count_params(const hn_system *sys) {
    return sys->opts.symbolic_params ? sys->scene->n_params : 0;
}

static int count_inputs(const hn_linear *l, const hn_system *sys) {
    return l->nq + l->nv + 1 + l->nv + l->nc + count_params(sys) + HN_PULL_INPUTS * sys->n_pulls;
}

static void list_symbols(const builder *b, int *symbols) {
    const hn_system *sys = b->sys;
    for (int i = 0; i < b->l->nq; i++) {
        *symbols++ = sys->q_symbols[i];
    }
    for (int i = 0; i < sys->nv; i++) {
        *symbols++ = sys->v_symbols[i];
    }
    *symbols++ = sys->t_symbol;
    for (int i = 0; i < sys->nv; i++) {
        *symbols++ = hn_ex_symbol(b->g, b->a[i]);
    }
    for (int i = 0; i < sys->nc; i++) {
        *symbols++ = hn_ex_symbol(b->g, b->lambda[i]);
    }
    for (int i = 0; i < count_params(sys); i++) {
        *symbols++ = hn_ex_symbol(b->g, sys->params[i]);
    }
    for (int i = 0; i < HN_PULL_INPUTS * sys->n_pulls; i++) {
        *symbols++ = hn_ex_symbol(b->g, sys->pull_inputs[i]);
    }
}

static bool is_matrix(int term) {
    const unsigned matrices = HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_J | HN_LINEAR_V |
                              HN_LINEAR_GAMMA_Q | HN_LINEAR_GAMMA_V;
    return (1u << term & matrices) != 0;
}

static int count_cols(const hn_linear *l, int term) {
    return is_matrix(term) ? l->nv : 1;
}

static int count_rows(const hn_linear *l, int term) {
    const unsigned of_speeds =
        HN_LINEAR_RESIDUAL | HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_F;
    return 1u << term & of_speeds ? l->nv : l->nc;
}

static hn_status allocate(builder *b, unsigned terms, int *n_entries) {
    hn_linear *l = b->l;
    *n_entries = 0;
    for (int k = 0; k < HN_LINEAR_COUNT; k++) {
        if (terms & 1u << k) {
            const size_t n = (size_t)b->terms[k].n;
            l->terms[k].listed = is_matrix(k);
            l->terms[k].values =
                hn_arena_doubles(b->arena, is_matrix(k) ? n : (size_t)count_rows(l, k));
            l->terms[k].rows = hn_arena_ints(b->arena, n);
            l->terms[k].cols = hn_arena_ints(b->arena, n);
            *n_entries += (int)n;
        }
    }
    l->target = hn_arena_get(b->arena, ((size_t)*n_entries + 1) * sizeof *l->target);
    l->source = hn_arena_ints(b->arena, (size_t)*n_entries + 1);
    l->entry = hn_arena_ints(b->arena, (size_t)*n_entries + 1);
    return hn_arena_failed(b->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// Returns where entry i of a term is kept.
static double *place_of(const hn_linear *l, int term, int i) {
    const term_values *of = &l->terms[term];
    return of->listed ? &of->values[i]
                      : &of->values[(size_t)of->rows[i] * (size_t)count_cols(l, term) +
                                    (size_t)of->cols[i]];
}

/// Each entry has its place; numbers are written once, the others are outputs of the tape.
static int scatter(builder *b, hn_ex *outputs) {
    hn_linear *l = b->l;
    for (int k = 0; k < HN_LINEAR_COUNT; k++) {
        term_values *term = &l->terms[k];
        term->first = l->n_scatter;
        for (int i = 0; i < b->terms[k].n; i++) {
            const hn_entry *e = &b->terms[k].at[i];
            double value;
            term->rows[i] = e->row;
            term->cols[i] = e->col;
            if (hn_is_number(e->e, &value)) {
                *place_of(l, k, i) = value;
            } else {
                l->target[l->n_scatter] = place_of(l, k, i);
                l->entry[l->n_scatter] = i;
                outputs[l->n_scatter++] = e->e;
            }
        }
        term->n_entries = b->terms[k].n;
        term->end = l->n_scatter;
    }
    return l->n_scatter;
}

static hn_status compile(builder *b, unsigned terms) {
    hn_linear *l = b->l;
    int n_entries;
    hn_status status = allocate(b, terms, &n_entries);
    if (status != HN_OK) {
        return status;
    }

    // a tape of q, v, t, a, lambda
    hn_ex *outputs = malloc(((size_t)n_entries + 1) * sizeof *outputs);
    int *symbols = malloc((size_t)count_inputs(l, b->sys) * sizeof *symbols);
    status = HN_ERR_MEMORY;
    if (outputs && symbols) {
        const int n = scatter(b, outputs);
        list_symbols(b, symbols);
        status = hn_tape_compile(b->g, outputs, n, symbols, count_inputs(l, b->sys), &l->tape);
    }

    free(outputs);
    free(symbols);
    if (status != HN_OK) {
        return status;
    }

    // its workspace starts with the inputs
    l->x = hn_arena_doubles(b->arena, hn_tape_work_size(l->tape));
    if (!l->x) {
        return HN_ERR_MEMORY;
    }
    hn_tape_prepare(l->tape, l->x);
    for (int i = 0; i < count_params(b->sys); i++) {
        l->x[l->nq + 2 * l->nv + 1 + l->nc + i] = b->sys->scene->params[i].value;
    }
    for (int k = 0; k < l->n_scatter; k++) {
        l->source[k] = hn_tape_output_slots(l->tape)[k];
    }
    return HN_OK;
}

hn_status hn_linear_create_listed(const hn_system *sys, unsigned terms, hn_arena *arena,
                                  hn_linear **out) {
    HN_ASSERT(sys && arena && out);
    hn_linear *l = hn_arena_get(arena, sizeof *l);
    *out = NULL;
    if (!l) {
        return HN_ERR_MEMORY;
    }
    *l = (hn_linear){.nq = sys->info.nq,
                     .nv = sys->nv,
                     .nc = sys->nc,
                     .n_params = count_params(sys),
                     .pulls = sys->pulls};
    // the graph may gain nodes; system.h says that this is the one thing that changes a system
    // the derivatives, and their tape
    builder b = {.l = l, .sys = sys, .g = sys->g, .arena = arena};
    hn_status status = make_symbols(&b);
    HN_THEN(status, make_sums(&b));
    HN_THEN(status, make_terms(&b, terms));
    HN_THEN(status, compile(&b, terms));

    // scratch
    free(b.a);
    free(b.lambda);
    free(b.residual);
    free(b.speed_gap);
    free(b.column);
    for (int k = 0; k < HN_LINEAR_COUNT; k++) {
        hn_entries_reset(&b.terms[k]);
    }

    if (status != HN_OK) {
        hn_linear_free(l);
        return status;
    }
    *out = l;
    return HN_OK;
}

/// A matrix from its list to all of its entries; the tape's outputs go there from now on.
static void spread(hn_linear *l, int term, double *dense) {
    term_values *of = &l->terms[term];
    const double *const list = of->values;
    of->values = dense;
    of->listed = false;
    for (int i = 0; i < of->n_entries; i++) {
        *place_of(l, term, i) = list[i];
    }
    for (int k = of->first; k < of->end; k++) {
        l->target[k] = place_of(l, term, l->entry[k]);
    }
}

hn_status hn_linear_spread(hn_linear *l, hn_arena *arena) {
    for (int k = 0; k < HN_LINEAR_COUNT; k++) {
        if (l->terms[k].values && l->terms[k].listed) {
            const size_t size = (size_t)count_rows(l, k) * (size_t)count_cols(l, k);
            double *dense = hn_arena_doubles(arena, size);
            if (!dense) {
                return HN_ERR_MEMORY;
            }
            spread(l, k, dense);
        }
    }
    return HN_OK;
}

hn_status hn_linear_create(const hn_system *sys, unsigned terms, hn_arena *arena, hn_linear **out) {
    HN_TRY(hn_linear_create_listed(sys, terms, arena, out));
    const hn_status status = hn_linear_spread(*out, arena);
    if (status != HN_OK) {
        hn_linear_free(*out);
        *out = NULL;
    }
    return status;
}

void hn_linear_free(hn_linear *l) {
    if (l) {
        hn_tape_free(l->tape);
        l->tape = NULL;
    }
}

static double *set_part(double *x, const double *from, int n) {
    for (int i = 0; i < n; i++) {
        x[i] = from ? from[i] : 0;
    }
    return x + n;
}

void hn_linear_run(hn_linear *l, double t, const double *q, const double *v, const double *a,
                   const double *lambda) {
    double *x = set_part(l->x, q, l->nq);
    x = set_part(x, v, l->nv);
    x = set_part(x, &t, 1);
    x = set_part(x, a, l->nv);
    x = set_part(x, lambda, l->nc);
    if (l->pulls) {
        hn_pull_log_put(l->pulls, t, x + l->n_params);
    }
    hn_tape_run(l->tape, l->x);
    for (int k = 0; k < l->n_scatter; k++) {
        *l->target[k] = l->x[l->source[k]];
    }
    l->count++;
}

const double *hn_linear_get(const hn_linear *l, hn_linear_term term) {
    const term_values *of = &l->terms[index_of(term)];
    HN_ASSERT(of->values != NULL && !of->listed);
    return of->values;
}

double hn_linear_entry(const hn_linear *l, hn_linear_term term, int k) {
    return *place_of(l, index_of(term), k);
}

void hn_linear_copy_whole(const hn_linear *l, hn_linear_term term, double *whole) {
    const int at = index_of(term);
    const term_values *of = &l->terms[at];
    HN_ASSERT(of->values != NULL && is_matrix(at));
    for (int k = 0; k < of->n_entries; k++) {
        whole[(size_t)of->rows[k] * (size_t)l->nv + (size_t)of->cols[k]] = *place_of(l, at, k);
    }
}

const double *hn_linear_list(const hn_linear *l, hn_linear_term term) {
    const term_values *of = &l->terms[index_of(term)];
    HN_ASSERT(of->values != NULL && of->listed);
    return of->values;
}

int hn_linear_pattern(const hn_linear *l, hn_linear_term term, const int **rows, const int **cols) {
    const term_values *of = &l->terms[index_of(term)];
    HN_ASSERT(of->values != NULL);
    *rows = of->rows;
    *cols = of->cols;
    return of->n_entries;
}

int hn_linear_entries(const hn_linear *l, hn_linear_term term) {
    const int *rows, *cols;
    return hn_linear_pattern(l, term, &rows, &cols);
}

/// out += X x, or X' x.
static void add_product(const hn_linear *l, hn_linear_term term, bool transposed, const double *x,
                        double *out) {
    const int at = index_of(term);
    const term_values *of = &l->terms[at];
    HN_ASSERT(of->values != NULL);
    for (int k = 0; k < of->n_entries; k++) {
        const int i = of->rows[k], j = of->cols[k];
        const double e = *place_of(l, at, k);
        out[transposed ? j : i] += e * x[transposed ? i : j];
    }
}

void hn_linear_apply(const hn_linear *l, hn_linear_term term, const double *x, double *out) {
    memset(out, 0, (size_t)count_rows(l, index_of(term)) * sizeof *out);
    add_product(l, term, 0, x, out);
}

void hn_linear_apply_transposed(const hn_linear *l, hn_linear_term term, const double *x,
                                double *out) {
    memset(out, 0, (size_t)count_cols(l, index_of(term)) * sizeof *out);
    add_product(l, term, 1, x, out);
}

bool hn_linear_is_finite(const hn_linear *l, hn_linear_term term) {
    const int at = index_of(term);
    for (int k = 0; k < l->terms[at].n_entries; k++) {
        if (!isfinite(*place_of(l, at, k))) {
            return false;
        }
    }
    return true;
}

double hn_linear_ops(const hn_linear *l) {
    return hn_tape_get_info(l->tape).ops;
}

long long hn_linear_count(const hn_linear *l) {
    return l->count;
}
