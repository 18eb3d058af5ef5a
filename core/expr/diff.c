// SPDX-License-Identifier: GPL-3.0-or-later
// Exact derivatives, substitution and evaluation: sweeps over node ids, no recursion.

#include "expr/diff.h"

#include "expr/construct.h"
#include "expr/graph_internal.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/// The nodes of a sweep with one expression each.
typedef struct sweep_values {
    int32_t n;
    int32_t *id;
    hn_ex *value;
    int *argument_at; ///< positions of arguments, in the order of the sweep
    size_t n_arguments;
} sweep_values;

static void sweep_values_reset(sweep_values *s) {
    free(s->id);
    free(s->value);
    free(s->argument_at);
}

/// Collects the nodes below e and copies the order: constructors called during the sweep start
/// their own.
static bool sweep_values_init(hn_graph *g, sweep_values *s, const hn_ex *e, int n, uint64_t deps) {
    *s = (sweep_values){0};
    if (g->failed || !hn_sweep_collect(g, e, n, deps)) {
        g->failed = 1;
        return false;
    }

    // room for the nodes and their arguments
    s->n = g->sweep->n;
    for (int32_t i = 0; i < s->n; i++) {
        s->n_arguments += (size_t)g->nodes[g->sweep->order[i]].n_args;
    }
    s->id = malloc((size_t)s->n * sizeof *s->id + 1);
    s->value = calloc((size_t)s->n + 1, sizeof *s->value);
    s->argument_at = malloc(s->n_arguments * sizeof *s->argument_at + 1);
    if (!s->id || !s->value || !s->argument_at) {
        g->failed = 1;
        return false;
    }

    // positions of the arguments, looked up once
    size_t k = 0;
    for (int32_t i = 0; i < s->n; i++) {
        const hn_node *node = &g->nodes[g->sweep->order[i]];
        s->id[i] = g->sweep->order[i];
        for (int j = 0; j < node->n_args; j++) {
            s->argument_at[k++] = hn_sweep_find(g, node->args[j].n);
        }
    }
    return true;
}

static uint64_t deps_of_symbols(const hn_graph *g, const int *symbols, int n_sym) {
    uint64_t deps = 0;
    for (int i = 0; i < n_sym; i++) {
        HN_ASSERT(symbols[i] >= 0 && symbols[i] < g->n_symbols);
        deps |= 1ull << (symbols[i] % 64);
    }
    return deps;
}

static void fill_zero(hn_ex *out, int n) {
    for (int i = 0; i < n; i++) {
        out[i] = hn_zero();
    }
}

// ---- forward ----

enum { MAX_ARITY = 2, SMALL_SUM = 64 };

static hn_ex dot_of_sum(hn_graph *g, hn_node node, const int *at, const hn_ex *dot) {
    hn_ex small[SMALL_SUM];
    small[0] = hn_zero();
    hn_ex *t = node.n_args <= SMALL_SUM ? small : malloc((size_t)node.n_args * sizeof *t);
    if (!t) {
        g->failed = 1;
        return hn_zero();
    }
    int n = 0;
    for (int i = 0; i < node.n_args; i++) {
        if (at[i] >= 0 && dot[at[i]].c != 0) {
            t[n++] = hn_scale(node.args[i].c, dot[at[i]]);
        }
    }
    const hn_ex result = hn_sum(g, t, n);
    if (t != small) {
        free(t);
    }
    return result;
}

/// Chain rule over the row of the table; nothing is built where no argument moves.
static hn_ex dot_of_function(hn_graph *g, int32_t id, const int *at, const hn_ex *dot) {
    const hn_node node = g->nodes[id];
    int moves = 0;
    for (int i = 0; i < node.n_args; i++) {
        moves |= at[i] >= 0 && dot[at[i]].c != 0;
    }
    if (!moves) {
        return hn_zero();
    }
    const hn_ex self = {1, id};
    hn_ex partial[MAX_ARITY], t[MAX_ARITY];
    hn_op_get_info((hn_op)node.op)->partials(g, &self, node.args, partial);
    int n = 0;
    for (int i = 0; i < node.n_args; i++) {
        if (at[i] >= 0 && dot[at[i]].c != 0) {
            t[n++] = hn_mul(g, partial[i], hn_scale(node.args[i].c, dot[at[i]]));
        }
    }
    return hn_sum(g, t, n);
}

void hn_diff_forward(hn_graph *g, const hn_ex *e, int n, const int *symbols, const hn_ex *seed,
                     int n_sym, hn_ex *out) {
    sweep_values s;
    const uint64_t deps = deps_of_symbols(g, symbols, n_sym);
    fill_zero(out, n);
    if (sweep_values_init(g, &s, e, n, deps)) {
        // seeds at the symbols
        fill_zero(s.value, s.n);
        for (int i = 0; i < n_sym; i++) {
            const int32_t at = hn_sweep_find(g, g->symbols[symbols[i]].node);
            if (at >= 0) {
                s.value[at] = seed[i];
            }
        }

        // positions of the results: the sweep ends when new nodes are made
        int32_t *end = malloc((size_t)n * sizeof *end + 1);
        g->failed |= end == NULL;
        for (int i = 0; i < n && end; i++) {
            end[i] = hn_sweep_find(g, e[i].n);
        }

        // from arguments to results
        const int *at = s.argument_at;
        for (int32_t i = 0; i < s.n && !g->failed; i++) {
            const hn_node node = g->nodes[s.id[i]];
            if (node.op == HN_OP_SUM) {
                s.value[i] = dot_of_sum(g, node, at, s.value);
            } else if (node.n_args > 0) {
                s.value[i] = dot_of_function(g, s.id[i], at, s.value);
            }
            at += node.n_args;
        }

        for (int i = 0; i < n && !g->failed; i++) {
            out[i] = end[i] >= 0 ? hn_scale(e[i].c, s.value[end[i]]) : hn_zero();
        }
        free(end);
    }
    sweep_values_reset(&s);
}

void hn_diff(hn_graph *g, hn_ex e, const int *symbols, int n_sym, hn_ex *out) {
    const hn_ex one = hn_num(1);
    for (int i = 0; i < n_sym; i++) {
        hn_diff_forward(g, &e, 1, &symbols[i], &one, 1, &out[i]);
    }
}

// ---- reverse ----

/// Contributions to the adjoints: a list per node, so that each adjoint becomes one flat sum.
typedef struct adjoints {
    int32_t *first; ///< by position, -1: none
    int32_t *next;
    hn_ex *term;
    int32_t n, cap;
    hn_ex *gathered;
    int32_t gathered_cap;
} adjoints;

static void add_contribution(adjoints *a, int32_t at, hn_ex term) {
    if (at >= 0 && term.c != 0) {
        a->term[a->n] = term;
        a->next[a->n] = a->first[at];
        a->first[at] = a->n++;
    }
}

static hn_ex gather(hn_graph *g, adjoints *a, int32_t at) {
    int32_t n = 0;
    for (int32_t k = a->first[at]; k >= 0; k = a->next[k]) {
        a->gathered[n++] = a->term[k];
    }
    return hn_sum(g, a->gathered, n);
}

/// Hands the adjoint of a node on to its arguments.
static void push_back(hn_graph *g, adjoints *a, int32_t id, const int *at, hn_ex bar) {
    const hn_node node = g->nodes[id];
    if (node.op == HN_OP_SUM) {
        for (int i = 0; i < node.n_args; i++) {
            add_contribution(a, at[i], hn_scale(node.args[i].c, bar));
        }
        return;
    }
    const hn_ex self = {1, id};
    hn_ex partial[MAX_ARITY];
    hn_op_get_info((hn_op)node.op)->partials(g, &self, node.args, partial);
    for (int i = 0; i < node.n_args; i++) {
        if (at[i] >= 0) {
            add_contribution(a, at[i], hn_scale(node.args[i].c, hn_mul(g, bar, partial[i])));
        }
    }
}

static bool adjoints_init(hn_graph *g, adjoints *a, const sweep_values *s) {
    const size_t terms = s->n_arguments + 1;
    *a = (adjoints){.first = malloc((size_t)s->n * sizeof *a->first + 1),
                    .next = malloc(terms * sizeof *a->next),
                    .term = malloc(terms * sizeof *a->term),
                    .gathered = malloc(terms * sizeof *a->gathered)};
    g->failed |= !a->first || !a->next || !a->term || !a->gathered;
    for (int32_t i = 0; i < s->n && a->first; i++) {
        a->first[i] = -1;
    }
    return !g->failed;
}

static void adjoints_reset(adjoints *a) {
    free(a->first);
    free(a->next);
    free(a->term);
    free(a->gathered);
}

void hn_diff_reverse(hn_graph *g, hn_ex e, const int *symbols, int n_sym, hn_ex *out) {
    sweep_values s;
    adjoints a = {0};
    fill_zero(out, n_sym);
    if (sweep_values_init(g, &s, &e, 1, deps_of_symbols(g, symbols, n_sym)) && s.n > 0 &&
        adjoints_init(g, &a, &s)) {
        add_contribution(&a, s.n - 1, (hn_ex){e.c, HN_NODE_ONE}); // e.n has the highest id

        // from the result back to the symbols
        const int *at = s.argument_at + s.n_arguments;
        for (int32_t i = s.n - 1; i >= 0 && !g->failed; i--) {
            const hn_node node = g->nodes[s.id[i]];
            at -= node.n_args;
            s.value[i] = gather(g, &a, i);
            if (node.n_args > 0 && s.value[i].c != 0) {
                push_back(g, &a, s.id[i], at, s.value[i]);
            }
            for (int k = 0; k < n_sym && node.op == HN_OP_SYMBOL; k++) {
                if (symbols[k] == node.symbol) {
                    out[k] = s.value[i];
                }
            }
        }
    }

    if (g->failed) {
        fill_zero(out, n_sym);
    }
    adjoints_reset(&a);
    sweep_values_reset(&s);
}

// ---- substitution and value ----

static hn_ex rebuilt(hn_graph *g, hn_node node, const int *at, const hn_ex *value) {
    hn_ex small[SMALL_SUM];
    hn_ex *args = node.n_args <= SMALL_SUM ? small : malloc((size_t)node.n_args * sizeof *args);
    if (!args) {
        g->failed = 1;
        return hn_zero();
    }
    for (int i = 0; i < node.n_args; i++) {
        args[i] = at[i] >= 0 ? hn_scale(node.args[i].c, value[at[i]]) : node.args[i];
    }
    const hn_ex result =
        node.op == HN_OP_SUM ? hn_sum(g, args, node.n_args) : hn_apply(g, (hn_op)node.op, args);
    if (args != small) {
        free(args);
    }
    return result;
}

void hn_substitute(hn_graph *g, const hn_ex *e, int n, const int *symbols, const hn_ex *with,
                   int n_sym, hn_ex *out) {
    sweep_values s;
    int32_t *end = malloc((size_t)n * sizeof *end + 1);
    g->failed |= end == NULL;
    if (sweep_values_init(g, &s, e, n, deps_of_symbols(g, symbols, n_sym))) {
        // each node stands for itself, the symbols for what replaces them
        for (int32_t i = 0; i < s.n; i++) {
            s.value[i] = (hn_ex){1, s.id[i]};
        }
        for (int i = 0; i < n_sym; i++) {
            const int32_t at = hn_sweep_find(g, g->symbols[symbols[i]].node);
            if (at >= 0) {
                s.value[at] = with[i];
            }
        }
        for (int i = 0; i < n; i++) {
            end[i] = hn_sweep_find(g, e[i].n);
        }

        // from arguments to results
        const int *at = s.argument_at;
        for (int32_t i = 0; i < s.n && !g->failed; i++) {
            const hn_node node = g->nodes[s.id[i]];
            if (node.n_args > 0) {
                s.value[i] = rebuilt(g, node, at, s.value);
            }
            at += node.n_args;
        }
    }

    for (int i = 0; i < n; i++) {
        const hn_ex whole = e[i];
        out[i] = g->failed ? hn_zero() : end[i] < 0 ? whole : hn_scale(whole.c, s.value[end[i]]);
    }
    free(end);
    sweep_values_reset(&s);
}

static double value_of(hn_node node, const int *at, const double *value, const double *x) {
    if (node.op == HN_OP_ONE) {
        return 1;
    }
    if (node.op == HN_OP_SYMBOL) {
        return x[node.symbol];
    }
    if (node.op == HN_OP_SUM) {
        double sum = 0;
        for (int i = 0; i < node.n_args; i++) {
            sum += node.args[i].c * value[at[i]];
        }
        return sum;
    }
    double arg[MAX_ARITY];
    for (int i = 0; i < node.n_args; i++) {
        arg[i] = node.args[i].c * value[at[i]];
    }
    return hn_op_get_info((hn_op)node.op)->value(arg);
}

/// The value of the last node of a sweep; `value` has a place for each node.
static double eval_at(const hn_graph *g, const sweep_values *s, const double *x, double *value) {
    const int *at = s->argument_at;
    for (int32_t i = 0; i < s->n; i++) {
        const hn_node node = g->nodes[s->id[i]];
        value[i] = value_of(node, at, value, x);
        at += node.n_args;
    }
    return value[s->n - 1];
}

void hn_graph_eval_all(hn_graph *g, hn_ex e, const double *x, int n, int stride, double *out) {
    sweep_values s;
    double *value = NULL;
    if (sweep_values_init(g, &s, &e, 1, ~0ull)) {
        value = malloc((size_t)s.n * sizeof *value + 1);
    }
    for (int i = 0; i < n; i++) {
        out[i] = value ? e.c * eval_at(g, &s, x ? x + (size_t)i * (size_t)stride : NULL, value)
                       : (double)NAN;
    }
    g->failed |= value == NULL;
    free(value);
    sweep_values_reset(&s);
}

double hn_graph_eval(hn_graph *g, hn_ex e, const double *x) {
    double value;
    hn_graph_eval_all(g, e, x, 1, 0, &value);
    return value;
}
