// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_places.h"

#include "expr/construct.h"

#include <string.h>

static void collect(hn_value_places *list, const hn_graph *g, int32_t node, int depth) {
    for (int i = 0; i < list->n; i++) {
        if (list->node[i] == node) {
            return;
        }
    }
    const hn_node_view view = hn_graph_node(g, node);
    if (list->n == HN_VALUE_NODES || depth == HN_VALUE_DEPTH || view.n_args > HN_VALUE_ARGS) {
        list->whole = false;
        return;
    }
    list->node[list->n++] = node;
    for (int i = 0; i < view.n_args; i++) {
        collect(list, g, view.args[i].n, depth + 1);
    }
}

void hn_value_places_find(hn_value_places *list, const hn_graph *g, hn_ex e) {
    *list = (hn_value_places){.whole = true};
    collect(list, g, e.n, 0);
}

/// One node that is written anew. `seen` counts its places so far.
typedef struct rewriting {
    int32_t node;
    int place, seen;
    hn_value_write *write;
    const void *user;
} rewriting;

static hn_ex rewrite(hn_graph *g, hn_ex e, rewriting *r) {
    const hn_node_view view = hn_graph_node(g, e.n);
    const hn_op op = view.op;
    const int n = view.n_args;
    hn_ex a[HN_VALUE_ARGS];
    if (n == 0 || n > HN_VALUE_ARGS) {
        return e;
    }

    // the view's arguments may move when the graph grows
    memcpy(a, view.args, sizeof *a * (size_t)n);
    const bool here = e.n == r->node && (++r->seen == r->place || r->place == 0);
    for (int i = 0; i < n; i++) {
        a[i] = rewrite(g, a[i], r);
    }
    double c = e.c;
    const hn_ex whole = here              ? r->write(g, op, a, n, &c, r->user)
                        : op == HN_OP_SUM ? hn_sum(g, a, n)
                        : op == HN_OP_MUL ? hn_mul(g, a[0], a[1])
                                          : hn_apply(g, op, a);
    return hn_scale(c, whole);
}

hn_ex hn_value_rewrite(hn_graph *g, hn_ex e, int32_t node, int place, hn_value_write *write,
                       const void *user) {
    rewriting r = {node, place, 0, write, user};
    return rewrite(g, e, &r);
}
