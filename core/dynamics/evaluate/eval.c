// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/eval.h"

#include "dynamics/evaluate/inputs.h"
#include "expr/construct.h"

#include <stdbool.h>
#include <string.h>

/// One term: its values, dense or as a list of entries, and where they come from.
typedef struct term_values {
    double *values;
    bool listed;
    int n_cols;
    int n_entries; ///< not identically zero: hn_eval_pattern()
    int *rows, *cols;
} term_values;

struct hn_eval {
    hn_inputs in;
    int n_out;
    double **target; ///< n_scatter places
    int *source;     ///< where in the tape's workspace each comes from
    int n_scatter;
    term_values terms[HN_TERM_COUNT];
    bool lists; ///< M and J as lists
    long long count;
};

/// While it is built: outputs and where each goes.
typedef struct builder {
    hn_eval *e;
    hn_ex *outputs;
    int cap;
    hn_ex *made; ///< expressions that the system does not keep: energies, or rates of the rows
} builder;

static void put(builder *b, double *place, int output, hn_ex ex) {
    double value;
    if (hn_is_number(ex, &value)) {
        *place = value; // once for all
        return;
    }
    b->e->target[b->e->n_scatter] = place;
    b->e->source[b->e->n_scatter++] = output;
}

static double *place_of(const term_values *term, int row, int col) {
    return &term->values[(size_t)row * (size_t)term->n_cols + (size_t)col];
}

static void add_entry(builder *b, term_values *term, int row, int col, hn_ex ex, int symmetric) {
    double value;
    if (hn_is_zero(ex)) {
        return;
    }
    const int entry = term->n_entries++, output = b->e->n_out;
    term->rows[entry] = row;
    term->cols[entry] = col;
    put(b, term->listed ? &term->values[entry] : place_of(term, row, col), output, ex);
    if (symmetric && row != col && !term->listed) {
        put(b, place_of(term, col, row), output, ex);
    }
    if (!hn_is_number(ex, &value)) {
        b->outputs[b->e->n_out++] = ex;
    }
}

/// The content of a term: a list of entries or a plain array.
typedef struct term_source {
    const hn_entries *entries;
    const hn_ex *list;
    int rows, cols, symmetric;
} term_source;

/// Fills `made` (nc, at least 2) with what the term is made of, where the system does not keep it.
static void make_term(const hn_system *sys, int term, hn_ex *made) {
    if (1 << term == HN_TERM_ENERGY) {
        made[0] = sys->kinetic;
        made[1] = sys->potential;
    }
    if (1 << term == HN_TERM_RATES) {
        for (int i = 0; i < sys->nc; i++) {
            made[i] = sys->phi_t[i];
        }
        for (int k = 0; k < sys->J.n; k++) {
            const hn_entry *e = &sys->J.at[k];
            const hn_ex part = hn_mul(sys->g, e->e, sys->v[e->col]);
            made[e->row] = hn_add(sys->g, made[e->row], part);
        }
    }
}

static term_source source_of(const hn_system *sys, int term, const hn_ex *made) {
    // clang-format off
    switch ((hn_term)(1 << term)) {
    case HN_TERM_M:      return (term_source){&sys->M, NULL, sys->nv, sys->nv, 1};
    case HN_TERM_F:      return (term_source){NULL, sys->f, sys->nv, 1, 0};
    case HN_TERM_PHI:    return (term_source){NULL, sys->phi, sys->nc, 1, 0};
    case HN_TERM_PHI_T:  return (term_source){NULL, sys->phi_t, sys->nc, 1, 0};
    case HN_TERM_J:      return (term_source){&sys->J, NULL, sys->nc, sys->nv, 0};
    case HN_TERM_GAMMA:  return (term_source){NULL, sys->gamma, sys->nc, 1, 0};
    case HN_TERM_ENERGY: return (term_source){NULL, made, 2, 1, 0};
    case HN_TERM_POINTS: return (term_source){NULL, sys->points, 3 * sys->info.n_points, 1, 0};
    case HN_TERM_RATES:  return (term_source){NULL, made, sys->nc, 1, 0};
    }
    // clang-format on
    return (term_source){NULL, NULL, 0, 0, 0};
}

static int count_entries(const term_source *s) {
    return s->entries ? s->entries->n : s->rows;
}

static hn_status add_term(builder *b, const hn_system *sys, int k, hn_arena *arena) {
    make_term(sys, k, b->made);
    term_source s = source_of(sys, k, b->made);
    term_values *term = &b->e->terms[k];

    size_t n = (size_t)count_entries(&s);
    term->listed = b->e->lists && s.entries;
    term->n_cols = s.cols;
    term->values = hn_arena_doubles(arena, term->listed ? n : (size_t)s.rows * (size_t)s.cols);
    term->rows = hn_arena_ints(arena, n);
    term->cols = hn_arena_ints(arena, n);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // entries of a sparse matrix, or a plain list
    for (int i = 0; i < (int)n; i++) {
        if (s.entries) {
            const hn_entry *e = &s.entries->at[i];
            add_entry(b, term, e->row, e->col, e->e, s.symmetric);
        } else {
            add_entry(b, term, i, 0, s.list[i], 0);
        }
    }
    return HN_OK;
}

static int count_all(const hn_system *sys, unsigned terms) {
    int n = 0;
    for (int k = 0; k < HN_TERM_COUNT; k++) {
        if (terms & (1u << k)) {
            term_source s = source_of(sys, k, NULL);
            n += count_entries(&s);
        }
    }
    return n;
}

static hn_status build(hn_eval *e, const hn_system *sys, unsigned terms, hn_arena *arena) {
    int n = count_all(sys, terms);
    builder b = {.e = e,
                 .outputs = malloc(((size_t)n + 1) * sizeof(hn_ex)),
                 .cap = n,
                 .made = malloc(((size_t)sys->nc + 2) * sizeof(hn_ex))};
    e->target = hn_arena_get(arena, (2 * (size_t)n + 1) * sizeof *e->target);
    e->source = hn_arena_ints(arena, 2 * (size_t)n + 1);
    hn_status status = b.outputs && b.made && !hn_arena_failed(arena) ? HN_OK : HN_ERR_MEMORY;
    for (int k = 0; k < HN_TERM_COUNT && status == HN_OK; k++) {
        if (terms & (1u << k)) {
            status = add_term(&b, sys, k, arena);
        }
    }
    HN_THEN(status, hn_inputs_compile(sys, b.outputs, e->n_out, arena, &e->in));
    free(b.outputs);
    free(b.made);
    for (int k = 0; status == HN_OK && k < e->n_scatter; k++) {
        e->source[k] = e->in.slots[e->source[k]];
    }
    return status;
}

static hn_status create(const hn_system *sys, unsigned terms, bool lists, hn_arena *arena,
                        hn_eval **out) {
    HN_ASSERT(sys && arena && out);
    hn_eval *e = hn_arena_get(arena, sizeof *e);
    *out = NULL;
    if (!e) {
        return HN_ERR_MEMORY;
    }
    e->lists = lists;
    // the graph may gain nodes; system.h says that this is the one thing that changes a system
    hn_status status = build(e, sys, terms, arena);
    if (status != HN_OK) {
        hn_eval_free(e);
        return status;
    }
    *out = e;
    return HN_OK;
}

hn_status hn_eval_create(const hn_system *sys, unsigned terms, hn_arena *arena, hn_eval **out) {
    return create(sys, terms, false, arena, out);
}

hn_status hn_eval_create_listed(const hn_system *sys, unsigned terms, hn_arena *arena,
                                hn_eval **out) {
    return create(sys, terms, true, arena, out);
}

void hn_eval_free(hn_eval *e) {
    if (e) {
        hn_inputs_free(&e->in);
    }
}

void hn_eval_run(hn_eval *e, double t, const double *q, const double *v) {
    hn_inputs_set(&e->in, t, q, v, 0, 0);
    hn_tape_run(e->in.tape, e->in.x);
    for (int k = 0; k < e->n_scatter; k++) {
        *e->target[k] = e->in.x[e->source[k]];
    }
    e->count++;
}

static int term_index(hn_term term) {
    const int k = __builtin_ctz((unsigned)term);
    HN_ASSERT(k < HN_TERM_COUNT && (1u << k) == (unsigned)term);
    return k;
}

const double *hn_eval_get(const hn_eval *e, hn_term term) {
    const term_values *t = &e->terms[term_index(term)];
    HN_ASSERT(t->values != NULL && !t->listed);
    return t->values;
}

const double *hn_eval_list(const hn_eval *e, hn_term term) {
    const term_values *t = &e->terms[term_index(term)];
    HN_ASSERT(t->values != NULL && t->listed);
    return t->values;
}

void hn_eval_spread(const hn_eval *e, hn_term term, double *dense) {
    const double *list = hn_eval_list(e, term);
    const term_values *t = &e->terms[term_index(term)];
    const size_t n = (size_t)t->n_cols;
    for (int k = 0; k < t->n_entries; k++) {
        const size_t i = (size_t)t->rows[k], j = (size_t)t->cols[k];
        dense[i * n + j] = list[k];
        if (term == HN_TERM_M) {
            dense[j * n + i] = list[k];
        }
    }
}

int hn_eval_pattern(const hn_eval *e, hn_term term, const int **rows, const int **cols) {
    const term_values *t = &e->terms[term_index(term)];
    HN_ASSERT(t->values != NULL);
    *rows = t->rows;
    *cols = t->cols;
    return t->n_entries;
}

hn_tape_info hn_eval_info(const hn_eval *e) {
    return hn_tape_get_info(e->in.tape);
}

long long hn_eval_count(const hn_eval *e) {
    return e->count;
}
