// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/calls.h"

#include <stdlib.h>

/// Functions of a library of mathematics, by their names there.
static const hn_op FUNCTIONS[] = {HN_OP_ACOS, HN_OP_ASIN, HN_OP_ATAN, HN_OP_ATAN2, HN_OP_COS,
                                  HN_OP_COSH, HN_OP_EXP,  HN_OP_LOG,  HN_OP_SIN,   HN_OP_SINH,
                                  HN_OP_SQRT, HN_OP_TAN,  HN_OP_TANH};

/// A walk over the nodes of the terms.
typedef struct walk {
    const hn_graph *g;
    unsigned found;
    int n;
    int32_t *stack;
    bool *seen;
} walk;

static void add_node(walk *w, int32_t node) {
    if (!w->seen[node]) {
        w->seen[node] = true;
        w->stack[w->n++] = node;
    }
}

static void add_list(walk *w, const hn_ex *list, int n) {
    for (int i = 0; i < n; i++) {
        add_node(w, list[i].n);
    }
}

static void add_terms(walk *w, const hn_exporter *e) {
    const int nv = e->info.nv, nc = e->info.nc;
    add_list(w, e->M, nv * nv);
    add_list(w, e->x.f, nv);
    add_list(w, e->J, nc * nv);
    add_list(w, e->x.gamma, nc);
    add_list(w, e->x.phi, nc);
    add_list(w, e->x.phi_t, nc);
    add_list(w, &e->x.kinetic, 1);
    add_list(w, &e->x.potential, 1);
}

unsigned hn_export_calls(const hn_exporter *e) {
    walk w = {.g = hn_system_graph(e->sys)};
    const size_t n = (size_t)hn_graph_size(w.g);
    w.stack = malloc(n * sizeof *w.stack);
    w.seen = calloc(n, sizeof *w.seen);
    if (!w.stack || !w.seen) {
        free(w.stack);
        free(w.seen);
        return ~0u;
    }
    add_terms(&w, e);
    while (w.n > 0) {
        const hn_node_view view = hn_graph_node(w.g, w.stack[--w.n]);
        w.found |= 1u << view.op;
        add_list(&w, view.args, view.n_args);
    }
    free(w.stack);
    free(w.seen);
    return w.found;
}

bool hn_export_has_functions(unsigned calls) {
    bool any = false;
    for (size_t i = 0; i < sizeof FUNCTIONS / sizeof *FUNCTIONS; i++) {
        any |= (calls & 1u << FUNCTIONS[i]) != 0;
    }
    return any;
}

void hn_export_put_functions(hn_strbuf *b, unsigned calls) {
    bool is_first = true;
    for (size_t i = 0; i < sizeof FUNCTIONS / sizeof *FUNCTIONS; i++) {
        if (calls & 1u << FUNCTIONS[i]) {
            hn_strbuf_printf(b, "%s%s", is_first ? "" : ", ", hn_op_get_info(FUNCTIONS[i])->name);
            is_first = false;
        }
    }
}
