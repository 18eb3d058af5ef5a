// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/angles.h"

#include "expr/construct.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_TERMS = 48,   ///< of a sum that is multiplied out
    MOST_FACTORS = 24, ///< of one of its products
    LONGEST = 400      ///< symbols and functions of a sum that is tried
};

/// A coefficient times nodes, each as often as it is there, sorted.
typedef struct product {
    double c;
    int n;
    int32_t node[MOST_FACTORS];
} product;

typedef struct products {
    int n;
    bool failed; ///< too many terms or factors
    product item[MOST_TERMS];
} products;

// ---- multiplying out ----

static void multiply(product *p, int32_t node) {
    int at = p->n++;
    for (; at > 0 && p->node[at - 1] > node; at--) {
        p->node[at] = p->node[at - 1];
    }
    p->node[at] = node;
}

static void add_product(products *out, const product *p) {
    if (out->n == MOST_TERMS) {
        out->failed = true;
        return;
    }
    out->item[out->n++] = *p;
}

/// Adds `before` times the node list[0] times those behind it, multiplied out. The list is in the
/// order in which factors were found; a product node adds to its end.
static void expand(const hn_graph *g, const product *before, const int32_t *list, int n,
                   products *out) {
    if (n == 0 || out->failed) {
        add_product(out, before);
        return;
    }
    const hn_node_view view = hn_graph_node(g, list[0]);
    int32_t rest[2 * MOST_FACTORS];
    if (n + 1 >= 2 * MOST_FACTORS || before->n + n >= MOST_FACTORS) {
        out->failed = true;
        return;
    }
    memcpy(rest, list + 1, (size_t)(n - 1) * sizeof *rest);
    product p = *before;
    if (view.op == HN_OP_MUL) {
        p.c *= view.args[0].c * view.args[1].c;
        rest[n - 1] = view.args[0].n;
        rest[n] = view.args[1].n;
        expand(g, &p, rest, n + 1, out);
    } else if (view.op == HN_OP_SUM) {
        for (int i = 0; i < view.n_args && !out->failed; i++) {
            p.c = before->c * view.args[i].c;
            rest[n - 1] = view.args[i].n;
            expand(g, &p, rest, n, out);
        }
    } else {
        if (view.op != HN_OP_ONE) {
            multiply(&p, list[0]);
        }
        expand(g, &p, rest, n - 1, out);
    }
}

// ---- joining ----

/// Takes out of both what they share; what is left of p in *a, of q in *b.
static void take_common(const product *p, const product *q, product *common, product *a,
                        product *b) {
    common->n = a->n = b->n = 0;
    int i = 0, k = 0;
    while (i < p->n || k < q->n) {
        if (i < p->n && k < q->n && p->node[i] == q->node[k]) {
            common->node[common->n++] = p->node[i++];
            k++;
        } else if (k == q->n || (i < p->n && p->node[i] < q->node[k])) {
            a->node[a->n++] = p->node[i++];
        } else {
            b->node[b->n++] = q->node[k++];
        }
    }
}

/// Returns whether two nodes are sine and cosine, or cosine and sine, of one angle.
static bool is_other_of(const hn_graph *g, int32_t x, int32_t y) {
    const hn_node_view a = hn_graph_node(g, x), b = hn_graph_node(g, y);
    const bool other =
        (a.op == HN_OP_SIN && b.op == HN_OP_COS) || (a.op == HN_OP_COS && b.op == HN_OP_SIN);
    return other && hn_ex_same(a.args[0], b.args[0]);
}

/// Joins two products to one in *p; false: they are no such pair.
static bool join_pair(hn_graph *g, product *p, const product *q) {
    product common, a, b;
    if (fabs(fabs(p->c) - fabs(q->c)) > HN_CANCEL_TOL * fabs(p->c)) {
        return false;
    }
    take_common(p, q, &common, &a, &b);
    if (a.n != 2 || b.n != 2) {
        return false;
    }
    const int first = is_other_of(g, a.node[0], b.node[0]) ? 0 : 1;
    if (!is_other_of(g, a.node[0], b.node[first]) ||
        !is_other_of(g, a.node[1], b.node[1 - first])) {
        return false;
    }

    // cos x cos y +- sin x sin y, or sin x cos y +- cos x sin y
    const hn_node_view x = hn_graph_node(g, a.node[0]), y = hn_graph_node(g, a.node[1]);
    const hn_ex one = x.args[0], two = y.args[0];
    const bool alike = (p->c < 0) == (q->c < 0);
    hn_ex joined;
    double c = p->c;
    if (x.op == y.op) {
        c = x.op == HN_OP_COS ? p->c : q->c;
        joined = hn_cos(g, alike ? hn_sub(g, one, two) : hn_add(g, one, two));
    } else {
        const bool is_one = x.op == HN_OP_SIN;
        const hn_ex s = is_one ? one : two, t = is_one ? two : one;
        joined = hn_sin(g, alike ? hn_add(g, s, t) : hn_sub(g, s, t));
    }

    // what they share is put back
    common.c = c * joined.c;
    if (joined.n != HN_NODE_ONE) {
        multiply(&common, joined.n);
    }
    *p = common; // 0 where they cancel
    return true;
}

/// Joins pairs until there are none.
static void join_pairs(hn_graph *g, products *all) {
    for (int i = 0; i < all->n; i++) {
        for (int k = i + 1; k < all->n && !hn_graph_failed(g); k++) {
            if (join_pair(g, &all->item[i], &all->item[k])) {
                all->item[k] = all->item[--all->n];
                i = -1; // what was joined may be joined again
                break;
            }
        }
    }
}

/// Adds up products of the same nodes, and leaves out those that cancel. Whether there were any.
static bool merge_like(products *all) {
    const int before = all->n;
    for (int i = 0; i < all->n; i++) {
        product *p = &all->item[i];
        for (int k = all->n - 1; k > i; k--) {
            const product *q = &all->item[k];
            if (p->n == q->n && memcmp(p->node, q->node, (size_t)p->n * sizeof *p->node) == 0) {
                const double sum = p->c + q->c;
                const double largest = fmax(fabs(p->c), fabs(q->c));
                p->c = fabs(sum) <= HN_CANCEL_TOL * largest ? 0 : sum;
                all->item[k] = all->item[--all->n];
            }
        }
    }
    int n = 0;
    for (int i = 0; i < all->n; i++) {
        if (all->item[i].c != 0) {
            all->item[n++] = all->item[i];
        }
    }
    all->n = n;
    return n < before;
}

static hn_ex build_term(hn_graph *g, const product *p) {
    hn_ex term = hn_num(p->c);
    for (int k = 0; k < p->n; k++) {
        term = hn_mul(g, term, (hn_ex){1, p->node[k]});
    }
    return term;
}

static hn_ex build(hn_graph *g, const products *all) {
    hn_ex term[MOST_TERMS];
    for (int i = 0; i < all->n; i++) {
        term[i] = build_term(g, &all->item[i]);
    }
    return hn_sum(g, term, all->n);
}

// ---- the shorter of two ----

/// Adds the symbols and functions of a node as text has them, up to LONGEST.
static void add_length(const hn_graph *g, int32_t node, int *length) {
    const hn_node_view view = hn_graph_node(g, node);
    *length += view.op != HN_OP_ONE && view.op != HN_OP_MUL && view.op != HN_OP_SUM;
    for (int i = 0; i < view.n_args && *length <= LONGEST; i++) {
        add_length(g, view.args[i].n, length);
    }
}

static int length_of(const hn_graph *g, hn_ex e) {
    int length = 0;
    add_length(g, e.n, &length);
    return length;
}

/// The sum multiplied out and joined, where it is shorter.
static hn_ex shorten(hn_graph *g, hn_ex sum, products *room) {
    const int length = length_of(g, sum);
    if (length > LONGEST) {
        return sum;
    }
    const product whole = {.c = sum.c};
    room->n = 0;
    room->failed = false;
    expand(g, &whole, &sum.n, 1, room);
    if (room->failed) {
        return sum;
    }
    join_pairs(g, room);
    const hn_ex joined = build(g, room);
    return !hn_graph_failed(g) && length_of(g, joined) < length ? joined : sum;
}

// ---- all nodes, arguments first ----

typedef struct rewriter {
    hn_graph *g;
    hn_ex *now; ///< of each node: what it has become
    products *room;
} rewriter;

/// Returns what a node becomes when its arguments have.
static hn_ex rebuild(rewriter *w, int32_t node) {
    const hn_node_view view = hn_graph_node(w->g, node);
    hn_ex *args = calloc((size_t)view.n_args + 1, sizeof *args), out = {1, node};
    bool changed = false;
    for (int i = 0; args && i < view.n_args; i++) {
        const hn_ex inner = w->now[view.args[i].n];
        args[i] = hn_scale(view.args[i].c, inner);
        changed |= !hn_ex_same(inner, (hn_ex){1, view.args[i].n});
    }
    if (changed) {
        out = view.op == HN_OP_SUM   ? hn_sum(w->g, args, view.n_args)
              : view.op == HN_OP_MUL ? hn_mul(w->g, args[0], args[1])
                                     : hn_apply(w->g, view.op, args);
    }
    free(args);
    return out;
}

hn_status hn_angles_join(hn_graph *g, hn_ex *e, int n) {
    const int32_t n_nodes = hn_graph_size(g);
    rewriter w = {g, malloc((size_t)n_nodes * sizeof *w.now), malloc(sizeof *w.room)};
    bool *used = calloc((size_t)n_nodes, sizeof *used);
    const bool ready = w.now && w.room && used;

    // the nodes below the expressions; an argument has a smaller number than what it is in
    for (int i = 0; ready && i < n; i++) {
        used[e[i].n] = true;
    }
    for (int32_t k = n_nodes - 1; ready && k >= 0; k--) {
        const hn_node_view view = hn_graph_node(g, k);
        for (int i = 0; used[k] && i < view.n_args; i++) {
            used[view.args[i].n] = true;
        }
    }
    for (int32_t k = 0; ready && k < n_nodes; k++) {
        w.now[k] = used[k] ? rebuild(&w, k) : (hn_ex){1, k};
        if (used[k] && hn_graph_node(g, w.now[k].n).op == HN_OP_SUM) {
            w.now[k] = shorten(g, w.now[k], w.room);
        }
    }
    for (int i = 0; ready && i < n; i++) {
        e[i] = hn_scale(e[i].c, w.now[e[i].n]);
    }
    free(w.now);
    free(w.room);
    free(used);
    return ready && !hn_graph_failed(g) ? HN_OK : HN_ERR_MEMORY;
}

int hn_angles_terms(hn_graph *g, hn_ex e, hn_ex *out, int most) {
    products *room = calloc(1, sizeof *room);
    int n = 0;
    if (room && length_of(g, e) <= LONGEST) {
        const product whole = {.c = e.c};
        expand(g, &whole, &e.n, 1, room);
        if (!room->failed) {
            do {
                join_pairs(g, room);
            } while (merge_like(room)); // what was added up may have a partner now
            n = room->n <= most ? room->n : 0;
        }
    }
    for (int i = 0; i < n; i++) {
        out[i] = build_term(g, &room->item[i]);
    }
    free(room);
    return n;
}
