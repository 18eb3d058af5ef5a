// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_GRAPH_INTERNAL_H
#define HN_EXPR_GRAPH_INTERNAL_H
// Storage of the graph's nodes; for the files of expr/ alone.
//
// A node's key is what makes two of them equal: a product's key is its sorted list of factors with
// powers, so that a (b c) and (a b) c are one node; any other node's key is its operator and
// arguments. Node ids ascend from arguments to results, so a loop over ids replaces recursion
// everywhere.

#include "base/arena.h"
#include "expr/graph.h"

#include <stdbool.h>
#include <stddef.h>

/// Products of more different factors than this stop merging their lists (which would cost n^2
/// memory on a chain of n): the operands then count as factors themselves.
enum { HN_MAX_FACTORS = 24 };

/// So many nodes take some 0.1 ms; then the interrupt is asked.
enum { HN_NODES_BETWEEN_QUESTIONS = 256 };

typedef struct hn_factor {
    int32_t node, power;
} hn_factor;

enum { HN_NODE_TRIG_SQUARE = 1 }; ///< a product with sin^2 or cos^2 among its factors

typedef struct hn_node {
    uint64_t hash;
    uint64_t deps; ///< bit (symbol % 64) for every symbol below
    const hn_ex *args;
    const hn_factor *factors; ///< products only
    int32_t n_args, n_factors;
    int32_t symbol;
    uint8_t op, flags;
} hn_node;

typedef struct hn_symbol_entry {
    const char *name, *latex; ///< latex NULL: derived from the name
    int32_t node;
} hn_symbol_entry;

/// Scratch of the sweeps, by node id; grown to the size of the graph on demand.
typedef struct hn_sweep {
    int32_t *stamp; ///< equals `now` where the current sweep has been
    int32_t *slot;  ///< position of the node in `order`
    int32_t cap, now;
    int32_t *order; ///< nodes of the sweep, ascending
    int32_t n;
} hn_sweep;

struct hn_graph {
    hn_node *nodes;
    int32_t n, cap;
    int32_t *table; ///< open addressing, -1 where empty
    uint32_t table_size;
    hn_symbol_entry *symbols;
    int32_t n_symbols, cap_symbols;
    hn_arena *arena; ///< arguments, factors, names: addresses never move
    char *piece;
    size_t piece_left;
    hn_sweep *sweep;
    struct hn_tape_store *tapes; ///< that have been compiled; NULL: none yet
    void (*free_tapes)(struct hn_tape_store *tapes);
    int failed;
    hn_interrupt interrupt;
    bool interrupted; ///< and for that reason failed
};

/// The node of this key, or -1. Nothing is created.
int32_t hn_graph_lookup_args(const hn_graph *g, hn_op op, const hn_ex *args, int n_args);
int32_t hn_graph_lookup_product(const hn_graph *g, const hn_factor *factors, int n);
/// The same, created where missing; -1 when memory is out.
int32_t hn_graph_intern_args(hn_graph *g, hn_op op, const hn_ex *args, int n_args);
int32_t hn_graph_intern_product(hn_graph *g, const hn_factor *factors, int n, int32_t left,
                                int32_t right);

/// The factors of any node: those of a product, else the node itself once (in *one).
const hn_factor *hn_node_factors(const hn_graph *g, int32_t node, hn_factor *one, int *n);

/// Collects the nodes below e[0..n-1] into g->sweep->order (ascending), following a node only where
/// it depends on one of `deps`. Returns 0 when memory is out.
int hn_sweep_collect(const hn_graph *g, const hn_ex *e, int n, uint64_t deps);
/// Position of a node in the order of the last sweep, or -1.
int32_t hn_sweep_find(const hn_graph *g, int32_t node);

static inline hn_ex hn_zero(void) {
    return (hn_ex){0.0, HN_NODE_ONE};
}

#endif
