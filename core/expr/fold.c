// SPDX-License-Identifier: GPL-3.0-or-later
// Constructors of products and functions. Each returns the canonical form described in graph.h.

#include "expr/construct.h"

#include "expr/graph_internal.h"

#include <math.h>
#include <stdbool.h>

// ---- numbers ----

hn_ex hn_num(double value) {
    HN_ASSERT(isfinite(value));
    return (hn_ex){value + 0.0, HN_NODE_ONE}; // -0 becomes 0
}

/// k times a node; zero in its one form.
static hn_ex scaled(double k, int32_t node) {
    return k == 0 || node < 0 ? hn_zero() : (hn_ex){k, node};
}

hn_ex hn_neg(hn_ex a) {
    return scaled(-a.c, a.n);
}

hn_ex hn_scale(double k, hn_ex a) {
    return scaled(k * a.c, a.n);
}

// ---- products ----

typedef struct product {
    hn_factor f[2 * HN_MAX_FACTORS];
    int n;
} product;

/// Merges the sorted factor lists of two nodes; operands with too many factors count as factors
/// themselves.
static void merge_factors(const hn_graph *g, int32_t a, int32_t b, product *out) {
    hn_factor one_a, one_b;
    int na, nb;
    const hn_factor *fa = hn_node_factors(g, a, &one_a, &na);
    const hn_factor *fb = hn_node_factors(g, b, &one_b, &nb);

    // too many factors: the operands count as one factor each
    if (na + nb > HN_MAX_FACTORS) {
        one_a = (hn_factor){a, 1};
        one_b = (hn_factor){b, 1};
        fa = &one_a;
        fb = &one_b;
        na = nb = 1;
    }

    // merge two sorted lists, powers of one node added
    int i = 0, k = 0;
    out->n = 0;
    while (i < na || k < nb) {
        if (k == nb || (i < na && fa[i].node < fb[k].node)) {
            out->f[out->n++] = fa[i++];
        } else if (i == na || fb[k].node < fa[i].node) {
            out->f[out->n++] = fb[k++];
        } else {
            out->f[out->n++] = (hn_factor){fa[i].node, fa[i].power + fb[k].power};
            i++, k++;
        }
    }
}

static int find_factor(const product *p, int32_t node) {
    for (int i = 0; i < p->n; i++) {
        if (p->f[i].node == node) {
            return i;
        }
    }
    return -1;
}

/// Cancels x against 1/x and turns sqrt(x)^2 into x. Returns 1 if anything changed; `extra` then
/// holds what came out of square roots.
static int simplify_factors(hn_graph *g, product *p, hn_ex *extra) {
    int changed = 0;
    for (int i = 0; i < p->n; i++) {
        const hn_node *node = &g->nodes[p->f[i].node];

        // x / x
        if (node->op == HN_OP_RECIP && node->args[0].c == 1) {
            const int k = find_factor(p, node->args[0].n);
            if (k >= 0 && p->f[k].power > 0 && p->f[i].power > 0) {
                const int32_t m = p->f[i].power < p->f[k].power ? p->f[i].power : p->f[k].power;
                p->f[i].power -= m;
                p->f[k].power -= m;
                changed = 1;
            }
        } else if (node->op == HN_OP_SQRT && p->f[i].power >= 2) {
            // two square roots of x are x
            const hn_ex inside = node->args[0];
            const int half = p->f[i].power / 2;
            p->f[i].power -= 2 * half;
            *extra = hn_mul(g, *extra, hn_pow_int(g, inside, half));
            changed = 1;
        }
    }
    return changed;
}

static hn_ex rebuild(hn_graph *g, const product *p, hn_ex start) {
    hn_ex result = start;
    for (int i = 0; i < p->n; i++) {
        if (p->f[i].power > 0) {
            result = hn_mul(g, result, hn_pow_int(g, (hn_ex){1, p->f[i].node}, p->f[i].power));
        }
    }
    return result;
}

/// p * (1/p) for a product p, whose factors alone do not show that it cancels.
static bool is_recip_of(const hn_graph *g, int32_t a, int32_t b) {
    const hn_node *node = &g->nodes[a];
    return node->op == HN_OP_RECIP && node->args[0].n == b && node->args[0].c == 1;
}

/// The node of x^n, split by halves so that x^8 costs three products.
static int32_t intern_power(hn_graph *g, hn_factor f) {
    const int32_t half = f.power / 2;
    const hn_ex low = hn_pow_int(g, (hn_ex){1, f.node}, half);
    const hn_ex high = hn_pow_int(g, (hn_ex){1, f.node}, f.power - half);
    return g->failed ? -1 : hn_graph_intern_product(g, &f, 1, low.n, high.n);
}

hn_ex hn_mul(hn_graph *g, hn_ex a, hn_ex b) {
    const double c = a.c * b.c;
    if (c == 0 || a.n == HN_NODE_ONE || b.n == HN_NODE_ONE) {
        return scaled(c, a.n == HN_NODE_ONE ? b.n : a.n);
    }
    if (is_recip_of(g, a.n, b.n) || is_recip_of(g, b.n, a.n)) {
        return scaled(c, HN_NODE_ONE);
    }
    product p;
    merge_factors(g, a.n, b.n, &p);
    const int32_t known = hn_graph_lookup_product(g, p.f, p.n);
    if (known >= 0) {
        return scaled(c, known);
    }
    hn_ex extra = scaled(c, HN_NODE_ONE);
    if (simplify_factors(g, &p, &extra)) {
        return rebuild(g, &p, extra);
    }
    return scaled(c, p.n == 1 ? intern_power(g, p.f[0])
                              : hn_graph_intern_product(g, p.f, p.n, a.n, b.n));
}

hn_ex hn_pow_int(hn_graph *g, hn_ex a, int power) {
    if (power < 0) {
        const hn_ex inverse = hn_div(g, hn_num(1), a);
        return power == INT32_MIN ? hn_zero() : hn_pow_int(g, inverse, -power);
    }
    hn_ex result = hn_num(1), base = a;
    for (int k = power; k > 0; k >>= 1) {
        if (k & 1) {
            result = hn_mul(g, result, base);
        }
        if (k > 1) {
            base = hn_mul(g, base, base);
        }
    }
    return result;
}

hn_ex hn_div(hn_graph *g, hn_ex a, hn_ex b) {
    double d;
    if (hn_is_number(b, &d) && d != 0) {
        return hn_is_number(a, NULL) ? scaled(a.c / d, HN_NODE_ONE) : scaled(a.c / d, a.n);
    }
    return hn_mul(g, a, hn_apply(g, HN_OP_RECIP, &b));
}

// ---- functions ----

static hn_ex node_of(hn_graph *g, hn_op op, const hn_ex *args) {
    return scaled(1, hn_graph_intern_args(g, op, args, hn_op_get_info(op)->arity));
}

/// A function of numbers alone is a number, where that is finite.
static bool fold_numbers(hn_op op, const hn_ex *args, hn_ex *out) {
    const hn_op_info *info = hn_op_get_info(op);
    double x[2] = {0, 0};
    for (int i = 0; i < info->arity; i++) {
        if (!hn_is_number(args[i], &x[i])) {
            return false;
        }
    }
    const double value = info->value(x);
    if (!isfinite(value)) {
        return false;
    }
    *out = hn_num(value);
    return true;
}

static hn_ex apply_recip(hn_graph *g, hn_ex a) {
    const hn_node *node = &g->nodes[a.n];
    if (a.n == HN_NODE_ONE) { // 1/0: anything else has folded
        return node_of(g, HN_OP_RECIP, &a);
    }
    if (node->op == HN_OP_RECIP) {
        return hn_scale(1 / a.c, node->args[0]);
    }
    return hn_scale(1 / a.c, node_of(g, HN_OP_RECIP, &(hn_ex){1, a.n}));
}

static hn_ex apply_sqrt(hn_graph *g, hn_ex a) {
    const hn_ex inside = {a.c < 0 ? -1 : 1, a.n};
    return hn_scale(sqrt(fabs(a.c)), node_of(g, HN_OP_SQRT, &inside));
}

enum { LARGEST_UNROLLED_POWER = 64 };

/// Whole powers become products, halves square roots; the rest stays a call of pow.
static hn_ex apply_pow(hn_graph *g, const hn_ex *args) {
    double p;
    if (hn_is_number(args[1], &p)) {
        if (p == floor(p) && fabs(p) <= LARGEST_UNROLLED_POWER) {
            return hn_pow_int(g, args[0], (int)p);
        }
        if (fabs(p) == 0.5) {
            const hn_ex root = hn_sqrt(g, args[0]);
            return p > 0 ? root : hn_div(g, hn_num(1), root);
        }
        const hn_node *base = &g->nodes[args[0].n];
        double inner;
        if (base->op == HN_OP_POW && args[0].c == 1 && hn_is_number(base->args[1], &inner) &&
            inner != floor(inner)) { // (x^a)^b: x >= 0 is given where a is not whole
            const hn_ex both[2] = {base->args[0], hn_num(inner * p)};
            return hn_apply(g, HN_OP_POW, both);
        }
    }
    return node_of(g, HN_OP_POW, args);
}

static hn_ex apply_min_max(hn_graph *g, hn_op op, const hn_ex *args) {
    if (hn_ex_same(args[0], args[1])) {
        return args[0];
    }
    const int swap = args[0].n > args[1].n || (args[0].n == args[1].n && args[0].c > args[1].c);
    return node_of(g, op, (hn_ex[2]){args[swap], args[!swap]});
}

hn_ex hn_apply(hn_graph *g, hn_op op, const hn_ex *args) {
    HN_ASSERT(op >= HN_OP_MUL && op < HN_OP_COUNT);
    const hn_op_info *info = hn_op_get_info(op);
    hn_ex folded;
    if (g->failed) {
        return hn_zero();
    }

    // numbers alone give a number
    if (op == HN_OP_MUL) {
        return hn_mul(g, args[0], args[1]);
    }
    if (fold_numbers(op, args, &folded)) {
        return folded;
    }

    // functions with rules of their own
    const double c = args[0].c;
    switch (op) {
    case HN_OP_RECIP:
        return apply_recip(g, args[0]);
    case HN_OP_SQRT:
        return apply_sqrt(g, args[0]);
    case HN_OP_POW:
        return apply_pow(g, args);
    case HN_OP_MIN:
    case HN_OP_MAX:
        return apply_min_max(g, op, args);
    case HN_OP_ABS:
        return hn_scale(fabs(c), node_of(g, op, &(hn_ex){1, args[0].n}));
    case HN_OP_SIGN:
        return hn_scale(c < 0 ? -1 : 1, node_of(g, op, &(hn_ex){1, args[0].n}));
    case HN_OP_STEP:
        return node_of(g, op, &(hn_ex){c < 0 ? -1 : 1, args[0].n});
    default:
        break;
    }

    // odd and even functions take a positive coefficient
    if (info->parity != HN_PARITY_NONE && c < 0) {
        const hn_ex positive = hn_neg(args[0]);
        return hn_scale(info->parity == HN_PARITY_ODD ? -1 : 1, node_of(g, op, &positive));
    }
    return node_of(g, op, args);
}

hn_ex hn_sin(hn_graph *g, hn_ex a) {
    return hn_apply(g, HN_OP_SIN, &a);
}

hn_ex hn_cos(hn_graph *g, hn_ex a) {
    return hn_apply(g, HN_OP_COS, &a);
}

hn_ex hn_sqrt(hn_graph *g, hn_ex a) {
    return hn_apply(g, HN_OP_SQRT, &a);
}
