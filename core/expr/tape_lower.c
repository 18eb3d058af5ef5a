// SPDX-License-Identifier: GPL-3.0-or-later
// Graph to IR: places coefficients, takes common factors out of sums, turns reciprocals into
// divisions.

#include "expr/tape_lower.h"

#include "expr/graph_internal.h"
#include "expr/tape_ir.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_ATOMS = 16,          ///< factors of one term looked at when common factors are sought
    MAX_FACTORED_TERMS = 64, ///< longer sums keep their terms
    MAX_DEMANDS = 4          ///< coefficients remembered per node when the scale of a sum is chosen
};

/// n = k * (IR node)
typedef struct value {
    double k;
    int32_t ir;
} value;

/// Uses of a graph node: their number, and their coefficients where they matter.
typedef struct usage {
    int32_t uses;
    int32_t n_demands;
    double demand[MAX_DEMANDS];
} usage;

typedef struct lowering {
    hn_ir *ir;
    hn_graph *g;
    usage *usage; ///< by position in the sweep
    value *value;
    int32_t *input_of_symbol;
} lowering;

/// One term of a sum: a signed product of atoms, or `whole` where it is to stay as it is.
typedef struct item {
    int32_t sign;
    int32_t n;
    int32_t atom[MAX_ATOMS];
    int32_t whole; ///< -1: build the product of the atoms
} item;

static double snap_unit(double k) {
    const double tolerance = 8 * 2.220446049250313e-16;
    return fabs(fabs(k) - 1) <= tolerance ? copysign(1, k) : k;
}

// ---- products ----

static void mark_single(lowering *l, int32_t ir, int fresh, int single) {
    l->ir->nodes[ir].single = (uint8_t)(fresh && single);
}

static bool is_one(const hn_ir *ir, int32_t id) {
    return ir->nodes[id].kind == HN_IR_CONST && ir->nodes[id].value == 1;
}

static bool is_single_recip(const hn_ir *ir, int32_t id) {
    const hn_ir_node *node = &ir->nodes[id];
    return node->kind == HN_IR_DIV && node->single && is_one(ir, ir->args[node->first].node);
}

/// a b; a division where one of them is a reciprocal that nothing else uses.
static int32_t multiply(lowering *l, int32_t a, int32_t b, int single) {
    hn_ir *ir = l->ir;
    int fresh;
    int32_t result;
    if (is_one(ir, a) || is_one(ir, b)) {
        return is_one(ir, a) ? b : a;
    }
    if (is_single_recip(ir, b)) {
        result = hn_ir_div(ir, a, ir->args[ir->nodes[b].first + 1].node, &fresh);
    } else if (is_single_recip(ir, a)) {
        result = hn_ir_div(ir, b, ir->args[ir->nodes[a].first + 1].node, &fresh);
    } else {
        result = hn_ir_mul(ir, a, b, &fresh);
    }
    mark_single(l, result, fresh, single);
    return result;
}

/// |k| times a node; k goes into the numerator of a lone quotient of numbers, or meets a product it
/// was already multiplied with.
static int32_t scale_node(lowering *l, double k, int32_t id) {
    hn_ir *ir = l->ir;
    k = fabs(k);
    if (k == 1) {
        return id;
    }
    const hn_ir_node node = ir->nodes[id];
    if (node.kind == HN_IR_CONST) {
        return hn_ir_const(ir, k * node.value);
    }

    const int32_t first = node.n_args ? ir->args[node.first].node : 0;
    const int32_t constant = hn_ir_const(ir, k);
    int fresh;

    // k (c / x) = (k c) / x
    if (node.kind == HN_IR_DIV && node.single && ir->nodes[first].kind == HN_IR_CONST) {
        const int32_t numerator = hn_ir_const(ir, k * ir->nodes[first].value);
        const int32_t q = hn_ir_div(ir, numerator, ir->args[node.first + 1].node, &fresh);
        mark_single(l, q, fresh, 1);
        return q;
    }

    // k (a b) = (k a) b where k a is there already
    if (node.kind == HN_IR_MUL && node.single) {
        for (int i = 0; i < 2; i++) {
            const int32_t a = ir->args[node.first + i].node, b = ir->args[node.first + 1 - i].node;
            const int32_t known = hn_ir_find_mul(ir, constant, a);
            if (known >= 0) {
                ir->nodes[known].single = 0;
                return multiply(l, known, b, 1);
            }
        }
    }
    return multiply(l, constant, id, 1);
}

/// c times a graph node as a node of its own, exactly (functions and outputs need it so).
static int32_t exact(lowering *l, double c, value v) {
    const double q = snap_unit(c * v.k);
    const int32_t scaled = scale_node(l, q, v.ir);
    if (q > 0 || q != q) {
        return scaled;
    }
    const hn_ir_node *node = &l->ir->nodes[scaled];
    return node->kind == HN_IR_CONST ? hn_ir_const(l->ir, -node->value) : hn_ir_neg(l->ir, scaled);
}

// ---- common factors ----

/// The atoms of a product that may be taken apart; stops (whole as one atom) where there are too
/// many.
static void collect_atoms(const hn_ir *ir, int32_t id, item *out) {
    const hn_ir_node *node = &ir->nodes[id];
    int32_t stack[MAX_ATOMS];
    int depth = 0;
    out->n = 0;
    stack[depth++] = id;

    // products made for one use are taken apart; too many atoms: the node is one
    while (depth > 0) {
        const int32_t at = stack[--depth];
        node = &ir->nodes[at];
        if (node->kind == HN_IR_MUL && node->single) {
            if (depth + 2 + out->n > MAX_ATOMS) {
                out->n = 1;
                out->atom[0] = id;
                return;
            }
            stack[depth++] = ir->args[node->first].node;
            stack[depth++] = ir->args[node->first + 1].node;
        } else {
            out->atom[out->n++] = at;
        }
    }
}

static bool has_atom(const item *t, int32_t atom) {
    for (int i = 0; i < t->n; i++) {
        if (t->atom[i] == atom) {
            return true;
        }
    }
    return false;
}

static void remove_atom(item *t, int32_t atom) {
    for (int i = 0; i < t->n; i++) {
        if (t->atom[i] == atom) {
            t->atom[i] = t->atom[--t->n];
            break;
        }
    }
    t->whole = -1;
}

/// The product of an item's atoms; pairs that exist already come first.
static int32_t build_product(lowering *l, item *t) {
    while (t->n > 1) {
        int a = 0, b = 1;
        for (int i = 0; i < t->n; i++) {
            for (int k = i + 1; k < t->n; k++) {
                if (hn_ir_find_mul(l->ir, t->atom[i], t->atom[k]) >= 0) {
                    a = i;
                    b = k;
                }
            }
        }
        const int32_t product = multiply(l, t->atom[a], t->atom[b], 1);
        t->atom[a] = product;
        t->atom[b] = t->atom[--t->n];
    }
    return t->atom[0];
}

/// The atom that occurs in most products of the list, the one computed last among equals; -1 if
/// none is shared.
static int32_t commonest_atom(const item *t, int n) {
    int32_t best = -1;
    int best_count = 1;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < t[i].n && t[i].n > 1; k++) {
            int count = 0;
            for (int j = 0; j < n; j++) {
                count += t[j].n > 1 && has_atom(&t[j], t[i].atom[k]);
            }
            if (count > best_count || (count == best_count && count > 1 && t[i].atom[k] > best)) {
                best = t[i].atom[k];
                best_count = count;
            }
        }
    }
    return best;
}

static hn_ir_arg sum_of_items(lowering *l, item *t, int n);

/// a b + a c + rest = a (b + c) + rest: moves the terms with `atom` into one; returns the new
/// length.
static int take_out(lowering *l, item *t, int n, int32_t atom) {
    item inner[MAX_FACTORED_TERMS];
    int n_inner = 0, rest = 0;
    for (int i = 0; i < n; i++) {
        if (t[i].n > 1 && has_atom(&t[i], atom)) {
            inner[n_inner] = t[i];
            remove_atom(&inner[n_inner++], atom);
        } else {
            t[rest++] = t[i];
        }
    }
    const hn_ir_arg sum = sum_of_items(l, inner, n_inner);
    t[rest] = (item){.sign = sum.sign, .n = 2, .atom = {atom, sum.node}, .whole = -1};
    return rest + 1;
}

static int compare_args(const void *a, const void *b) {
    const hn_ir_arg *x = a, *y = b;
    return x->node != y->node ? (x->node > y->node) - (x->node < y->node)
                              : (x->sign < y->sign) - (x->sign > y->sign);
}

/// The sum of signed IR nodes in the order they become available; all negative: the sign goes
/// outside.
static hn_ir_arg signed_sum(lowering *l, hn_ir_arg *t, int n) {
    qsort(t, (size_t)n, sizeof *t, compare_args);
    int positive = 0;
    for (int i = 0; i < n; i++) {
        positive += t[i].sign > 0;
    }
    if (n == 1) {
        return t[0];
    }
    for (int i = 0; i < n && !positive; i++) {
        t[i].sign = 1;
    }
    int fresh;
    const int32_t id = hn_ir_sum(l->ir, t, n, &fresh);
    mark_single(l, id, fresh, 0);
    return (hn_ir_arg){id, positive ? 1 : -1};
}

static hn_ir_arg sum_of_items(lowering *l, item *t, int n) {
    int32_t atom;
    while (n > 1 && (atom = commonest_atom(t, n)) >= 0) {
        n = take_out(l, t, n, atom);
    }
    hn_ir_arg list[MAX_FACTORED_TERMS];
    for (int i = 0; i < n; i++) {
        list[i] = (hn_ir_arg){t[i].whole >= 0 ? t[i].whole : build_product(l, &t[i]), t[i].sign};
    }
    return signed_sum(l, list, n);
}

// ---- sums ----

/// Multiplications by constants if the sum is held divided by `lead`.
static int scale_cost(const value *t, int n, const usage *u, double lead) {
    int cost = 0;
    for (int i = 0; i < n; i++) {
        cost += t[i].ir >= 0 && fabs(snap_unit(t[i].k / lead)) != 1;
    }
    for (int i = 0; i < u->n_demands; i++) {
        cost += fabs(snap_unit(u->demand[i] * lead)) != 1;
    }
    return cost;
}

/// The scale of a sum: that of a term, or of a use, whichever leaves the fewest multiplications;
/// its sign makes a demanded coefficient positive where a term stays positive with it.
static double choose_lead(const value *t, int n, const usage *u) {
    double best = 1;
    int best_cost = scale_cost(t, n, u, 1);

    // every coefficient that occurs is a candidate
    for (int i = 0; i < n + u->n_demands && i < 32; i++) {
        const double lead = i < u->n_demands ? 1 / fabs(u->demand[i]) : fabs(t[i - u->n_demands].k);
        const int ok = i < u->n_demands || t[i - u->n_demands].ir >= 0;
        const int cost = ok && isnormal(lead) ? scale_cost(t, n, u, lead) : best_cost;
        if (cost < best_cost) {
            best = lead;
            best_cost = cost;
        }
    }

    // the sign
    int positive = 0, negative = 0, wanted = 0;
    for (int i = 0; i < n; i++) {
        positive += t[i].k > 0;
        negative += t[i].k < 0;
    }
    for (int i = 0; i < u->n_demands; i++) {
        wanted += u->demand[i] < 0 ? -1 : 1;
    }
    return positive == 0 || (negative > 0 && wanted < 0) ? -best : best;
}

/// Fills the terms of a sum as items; a constant becomes an atom of its own.
static item make_item(lowering *l, value t, double lead) {
    const double q = snap_unit(t.k / lead);
    item result = {.sign = q < 0 ? -1 : 1};
    if (t.ir < 0) {
        result.whole = hn_ir_const(l->ir, fabs(q));
        result.n = 1;
        result.atom[0] = result.whole;
        return result;
    }
    result.whole = scale_node(l, q, t.ir);
    collect_atoms(l->ir, result.whole, &result);
    return result;
}

static value lower_sum(lowering *l, const hn_node *node, const usage *u) {
    const int n = node->n_args;
    value *t = calloc((size_t)n + 1, sizeof *t);
    hn_ir_arg *list = calloc((size_t)n + 1, sizeof *list);
    value result = {1, 0};
    if (t && list) {
        // terms as factor and node; -1: a constant
        for (int i = 0; i < n; i++) {
            const value v = l->value[hn_sweep_find(l->g, node->args[i].n)];
            const int one = node->args[i].n == HN_NODE_ONE;
            t[i] = (value){node->args[i].c * (one ? 1 : v.k), one ? -1 : v.ir};
        }

        // few terms share factors, many are added as they are
        const double lead = choose_lead(t, n, u);
        hn_ir_arg sum;
        if (n <= MAX_FACTORED_TERMS) {
            item items[MAX_FACTORED_TERMS];
            for (int i = 0; i < n; i++) {
                items[i] = make_item(l, t[i], lead);
            }
            sum = sum_of_items(l, items, n);
        } else {
            for (int i = 0; i < n; i++) {
                const double q = snap_unit(t[i].k / lead);
                list[i] = (hn_ir_arg){t[i].ir < 0 ? hn_ir_const(l->ir, fabs(q))
                                                  : scale_node(l, q, t[i].ir),
                                      q < 0 ? -1 : 1};
            }
            sum = signed_sum(l, list, n);
        }

        result = (value){lead * sum.sign, sum.node};
    }
    l->ir->failed |= !t || !list;
    free(t);
    free(list);
    return result;
}

// ---- functions and the sweep ----

static value lower_call(lowering *l, const hn_node *node, int single) {
    const hn_op_info *info = hn_op_get_info((hn_op)node->op);
    int32_t args[2] = {0, 0};
    double outside = 1;
    for (int i = 0; i < node->n_args; i++) {
        const value v = l->value[hn_sweep_find(l->g, node->args[i].n)];
        double c = node->args[i].c;
        if (info->parity != HN_PARITY_NONE && c * v.k < 0) {
            c = -c;
            outside = info->parity == HN_PARITY_ODD ? -1 : 1;
        }
        args[i] = exact(l, c, v);
    }
    int fresh;
    const int32_t id = hn_ir_call(l->ir, (hn_op)node->op, args, node->n_args, &fresh);
    mark_single(l, id, fresh, single);
    return (value){outside, id};
}

static value lower_recip(lowering *l, const hn_node *node, int single) {
    const value v = l->value[hn_sweep_find(l->g, node->args[0].n)];
    if (node->args[0].c == 0) {
        return (value){1, hn_ir_const(l->ir, (double)INFINITY)};
    }
    int fresh;
    const int32_t id = hn_ir_div(l->ir, hn_ir_const(l->ir, 1), v.ir, &fresh);
    mark_single(l, id, fresh, single);
    return (value){1 / v.k, id};
}

static value lower_node(lowering *l, const hn_node *node, const usage *u) {
    const int single = u->uses == 1;

    // one rule for each kind of node
    switch (node->op) {
    case HN_OP_ONE:
        return (value){1, hn_ir_const(l->ir, 1)};
    case HN_OP_SYMBOL:
        HN_ASSERT(l->input_of_symbol[node->symbol] >= 0 &&
                  "symbol used but not listed as an input");
        return (value){1, hn_ir_input(l->ir, l->input_of_symbol[node->symbol])};
    case HN_OP_SUM:
        return lower_sum(l, node, u);
    case HN_OP_MUL: {
        const value a = l->value[hn_sweep_find(l->g, node->args[0].n)];
        const value b = l->value[hn_sweep_find(l->g, node->args[1].n)];
        return (value){a.k * b.k, multiply(l, a.ir, b.ir, single)};
    }
    case HN_OP_RECIP:
        return lower_recip(l, node, single);
    default:
        return lower_call(l, node, single);
    }
}

static void note_use(lowering *l, hn_ex e, int demanding) {
    usage *u = &l->usage[hn_sweep_find(l->g, e.n)];
    u->uses++;
    if (!demanding) {
        return;
    }
    for (int i = 0; i < u->n_demands; i++) {
        if (fabs(u->demand[i]) == fabs(e.c)) {
            return;
        }
    }
    if (u->n_demands < MAX_DEMANDS && e.c != 0) {
        u->demand[u->n_demands++] = e.c;
    }
}

static void note_uses(lowering *l, const hn_ex *outputs, int n_out) {
    for (int i = 0; i < n_out; i++) {
        note_use(l, outputs[i], 1);
    }
    for (int32_t i = 0; i < l->g->sweep->n; i++) {
        const hn_node *node = &l->g->nodes[l->g->sweep->order[i]];
        for (int k = 0; k < node->n_args; k++) {
            note_use(l, node->args[k], node->op != HN_OP_MUL && node->op != HN_OP_RECIP);
        }
    }
}

static void lower_all(lowering *l, const hn_ex *outputs, int n_out) {
    note_uses(l, outputs, n_out);
    for (int32_t i = 0; i < l->g->sweep->n && !l->ir->failed; i++) {
        if (i % HN_NODES_BETWEEN_QUESTIONS == 0 && hn_graph_is_interrupted(l->g)) {
            l->ir->failed = 1;
            return;
        }
        l->value[i] = lower_node(l, &l->g->nodes[l->g->sweep->order[i]], &l->usage[i]);
    }
    for (int i = 0; i < n_out && !l->ir->failed; i++) {
        l->ir->outputs[i] = exact(l, outputs[i].c, l->value[hn_sweep_find(l->g, outputs[i].n)]);
    }
}

hn_status hn_ir_lower(hn_ir *ir, hn_graph *g, const hn_ex *outputs, int n_out, const int *symbols,
                      int n_sym) {
    *ir = (hn_ir){0};
    if (g->failed || !hn_sweep_collect(g, outputs, n_out, ~0ull)) {
        return g->interrupted ? HN_ERR_STOPPED : HN_ERR_MEMORY;
    }

    // scratch by position in the sweep
    const size_t n = (size_t)g->sweep->n;
    lowering l = {.ir = ir,
                  .g = g,
                  .usage = calloc(n + 1, sizeof *l.usage),
                  .value = calloc(n + 1, sizeof *l.value),
                  .input_of_symbol = malloc(((size_t)g->n_symbols + 1) * sizeof(int32_t))};
    ir->outputs = calloc((size_t)n_out + 1, sizeof *ir->outputs);
    ir->n_outputs = n_out;
    ir->failed = !l.usage || !l.value || !l.input_of_symbol || !ir->outputs;

    if (!ir->failed) {
        memset(l.input_of_symbol, 0xff, (size_t)g->n_symbols * sizeof(int32_t));
        for (int i = 0; i < n_sym; i++) {
            l.input_of_symbol[symbols[i]] = i;
        }
        lower_all(&l, outputs, n_out);
    }

    free(l.usage);
    free(l.value);
    free(l.input_of_symbol);
    return g->interrupted ? HN_ERR_STOPPED : ir->failed ? HN_ERR_MEMORY : HN_OK;
}
