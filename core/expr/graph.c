// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/graph_internal.h"

#include "base/hash.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { PIECE_BYTES = 1 << 16, FIRST_NODES = 256, FIRST_TABLE = 1024 };

// ---- memory ----

/// Bytes that never move, carved from large pieces of the arena; NULL when memory is out.
static void *carve(hn_graph *g, size_t size) {
    size = (size + 7) & ~(size_t)7;
    if (size > PIECE_BYTES / 4) {
        void *own = hn_arena_get(g->arena, size);
        g->failed |= own == NULL;
        return own;
    }
    if (size > g->piece_left) {
        g->piece = hn_arena_get(g->arena, PIECE_BYTES);
        g->piece_left = g->piece ? PIECE_BYTES : 0;
        if (!g->piece) {
            g->failed = 1;
            return NULL;
        }
    }
    void *p = g->piece;
    g->piece += size;
    g->piece_left -= size;
    return p;
}

static bool grow_nodes(hn_graph *g) {
    if (g->n < g->cap) {
        return true;
    }
    const int32_t cap = g->cap ? 2 * g->cap : FIRST_NODES;
    hn_node *nodes = realloc(g->nodes, (size_t)cap * sizeof *nodes);
    if (!nodes) {
        g->failed = 1;
        return false;
    }
    g->nodes = nodes;
    g->cap = cap;
    return true;
}

/// Keeps the table at most half full.
static bool grow_table(hn_graph *g) {
    if (2u * (uint32_t)(g->n + 1) <= g->table_size) {
        return true;
    }

    const uint32_t size = g->table_size ? 2 * g->table_size : FIRST_TABLE;
    int32_t *table = malloc(size * sizeof *table);
    if (!table) {
        g->failed = 1;
        return false;
    }

    // every node finds its place in the larger table
    memset(table, 0xff, size * sizeof *table);
    for (int32_t i = 0; i < g->n; i++) {
        uint32_t k = (uint32_t)g->nodes[i].hash & (size - 1);
        while (table[k] >= 0) {
            k = (k + 1) & (size - 1);
        }
        table[k] = i;
    }

    free(g->table);
    g->table = table;
    g->table_size = size;
    return true;
}

// ---- keys ----

static uint64_t hash_args(hn_op op, const hn_ex *args, int n) {
    uint64_t h = hn_hash_word(HN_HASH_START, (uint64_t)op);
    for (int i = 0; i < n; i++) {
        const double c = args[i].c + 0.0; // -0 becomes 0
        uint64_t bits;
        memcpy(&bits, &c, sizeof bits);
        h = hn_hash_word(hn_hash_word(h, bits), (uint64_t)(uint32_t)args[i].n);
    }
    return hn_hash_mix(h);
}

static uint64_t hash_product(const hn_factor *f, int n) {
    uint64_t h = hn_hash_word(HN_HASH_START, HN_OP_MUL);
    for (int i = 0; i < n; i++) {
        h = hn_hash_word(h, (uint64_t)(uint32_t)f[i].node << 32 | (uint32_t)f[i].power);
    }
    return hn_hash_mix(h);
}

static bool same_args(const hn_node *node, hn_op op, const hn_ex *args, int n) {
    if (node->op != op || node->n_args != n || op == HN_OP_MUL || op == HN_OP_SYMBOL) {
        return false;
    }
    for (int i = 0; i < n; i++) {
        if (node->args[i].n != args[i].n || node->args[i].c != args[i].c) {
            return false;
        }
    }
    return true;
}

static bool same_product(const hn_node *node, const hn_factor *f, int n) {
    return node->op == HN_OP_MUL && node->n_factors == n &&
           memcmp(node->factors, f, (size_t)n * sizeof *f) == 0;
}

#define FOR_CANDIDATES(g, h, id)                                                            \
    for (uint32_t k_ = (uint32_t)(h) & ((g)->table_size - 1); ((id) = (g)->table[k_]) >= 0; \
         k_ = (k_ + 1) & ((g)->table_size - 1))

static int32_t find_args(const hn_graph *g, uint64_t h, hn_op op, const hn_ex *args, int n) {
    int32_t id;
    FOR_CANDIDATES(g, h, id) {
        if (g->nodes[id].hash == h && same_args(&g->nodes[id], op, args, n)) {
            return id;
        }
    }
    return -1;
}

static int32_t find_product(const hn_graph *g, uint64_t h, const hn_factor *f, int n) {
    int32_t id;
    FOR_CANDIDATES(g, h, id) {
        if (g->nodes[id].hash == h && same_product(&g->nodes[id], f, n)) {
            return id;
        }
    }
    return -1;
}

int32_t hn_graph_lookup_args(const hn_graph *g, hn_op op, const hn_ex *args, int n_args) {
    return find_args(g, hash_args(op, args, n_args), op, args, n_args);
}

int32_t hn_graph_lookup_product(const hn_graph *g, const hn_factor *factors, int n) {
    return find_product(g, hash_product(factors, n), factors, n);
}

// ---- nodes ----

/// Appends a node with room for n arguments; NULL when memory is out or the work is to end.
static hn_node *new_node(hn_graph *g, hn_op op, uint64_t hash, const hn_ex *args, int n_args) {
    if (g->n % HN_NODES_BETWEEN_QUESTIONS == 0 && hn_graph_is_interrupted(g)) {
        return NULL;
    }
    if (g->failed || !grow_nodes(g) || !grow_table(g)) {
        return NULL;
    }
    hn_ex *own = n_args ? carve(g, (size_t)n_args * sizeof *own) : NULL;
    if (n_args && !own) {
        return NULL;
    }
    hn_node *node = &g->nodes[g->n];
    *node = (hn_node){.hash = hash, .args = own, .n_args = n_args, .symbol = -1, .op = (uint8_t)op};
    for (int i = 0; i < n_args; i++) {
        own[i] = args[i];
        node->deps |= g->nodes[args[i].n].deps;
    }
    return node;
}

/// Makes the node appended last part of the graph.
static int32_t publish(hn_graph *g) {
    uint32_t k = (uint32_t)g->nodes[g->n].hash & (g->table_size - 1);
    while (g->table[k] >= 0) {
        k = (k + 1) & (g->table_size - 1);
    }
    g->table[k] = g->n;
    return g->n++;
}

int32_t hn_graph_intern_args(hn_graph *g, hn_op op, const hn_ex *args, int n_args) {
    const uint64_t h = hash_args(op, args, n_args);
    const int32_t found = find_args(g, h, op, args, n_args);
    if (found >= 0) {
        return found;
    }
    return new_node(g, op, h, args, n_args) ? publish(g) : -1;
}

static bool has_trig_square(const hn_graph *g, const hn_factor *f, int n) {
    for (int i = 0; i < n; i++) {
        const int op = g->nodes[f[i].node].op;
        if (f[i].power >= 2 && (op == HN_OP_SIN || op == HN_OP_COS)) {
            return true;
        }
    }
    return false;
}

int32_t hn_graph_intern_product(hn_graph *g, const hn_factor *factors, int n, int32_t left,
                                int32_t right) {
    const uint64_t h = hash_product(factors, n);
    const int32_t found = find_product(g, h, factors, n);
    if (found >= 0) {
        return found;
    }
    const int32_t low = left < right ? left : right, high = left < right ? right : left;
    hn_factor *own = carve(g, (size_t)n * sizeof *own);
    hn_node *node = own ? new_node(g, HN_OP_MUL, h, (hn_ex[2]){{1, low}, {1, high}}, 2) : NULL;
    if (!node) {
        return -1;
    }
    memcpy(own, factors, (size_t)n * sizeof *own);
    node->factors = own;
    node->n_factors = n;
    node->flags = has_trig_square(g, own, n) ? HN_NODE_TRIG_SQUARE : 0;
    return publish(g);
}

const hn_factor *hn_node_factors(const hn_graph *g, int32_t node, hn_factor *one, int *n) {
    if (g->nodes[node].op == HN_OP_MUL) {
        *n = g->nodes[node].n_factors;
        return g->nodes[node].factors;
    }
    *one = (hn_factor){node, 1};
    *n = 1;
    return one;
}

// ---- the graph ----

hn_graph *hn_graph_create(void) {
    hn_graph *g = calloc(1, sizeof *g);
    if (!g) {
        return NULL;
    }
    g->arena = hn_arena_create(PIECE_BYTES);
    g->sweep = calloc(1, sizeof *g->sweep);
    if (!g->arena || !g->sweep || !grow_nodes(g) || !grow_table(g) ||
        hn_graph_intern_args(g, HN_OP_ONE, NULL, 0) != HN_NODE_ONE) {
        hn_graph_free(g);
        return NULL;
    }
    return g;
}

void hn_graph_free(hn_graph *g) {
    if (!g) {
        return;
    }
    if (g->sweep) {
        free(g->sweep->stamp);
        free(g->sweep->slot);
        free(g->sweep->order);
    }
    if (g->tapes) {
        g->free_tapes(g->tapes);
    }
    free(g->sweep);
    free(g->symbols);
    free(g->table);
    free(g->nodes);
    hn_arena_free(g->arena);
    free(g);
}

bool hn_graph_failed(const hn_graph *g) {
    return g->failed;
}

hn_status hn_graph_status(const hn_graph *g) {
    return g->interrupted ? HN_ERR_STOPPED : g->failed ? HN_ERR_MEMORY : HN_OK;
}

void hn_graph_set_interrupt(hn_graph *g, hn_interrupt interrupt) {
    g->interrupt = interrupt;
}

bool hn_graph_is_interrupted(hn_graph *g) {
    g->interrupted = g->interrupted || hn_interrupt_ask(&g->interrupt);
    g->failed |= g->interrupted;
    return g->interrupted;
}

bool hn_graph_was_interrupted(const hn_graph *g) {
    return g->interrupted;
}

void hn_graph_go_on(hn_graph *g) {
    if (g->interrupted) {
        g->interrupted = false;
        g->failed = 0;
    }
}

int hn_graph_size(const hn_graph *g) {
    return g->n;
}

// ---- symbols ----

static uint64_t hash_symbol(const char *name) {
    return hn_hash_mix(hn_hash_text(HN_HASH_START + HN_OP_SYMBOL, name));
}

int hn_graph_find_symbol(const hn_graph *g, const char *name) {
    const uint64_t h = hash_symbol(name);
    int32_t id;
    FOR_CANDIDATES(g, h, id) {
        const hn_node *node = &g->nodes[id];
        if (node->op == HN_OP_SYMBOL && strcmp(g->symbols[node->symbol].name, name) == 0) {
            return node->symbol;
        }
    }
    return -1;
}

static const char *copy_text(hn_graph *g, const char *text) {
    const size_t n = strlen(text) + 1;
    char *own = carve(g, n);
    return own ? memcpy(own, text, n) : NULL;
}

static bool grow_symbols(hn_graph *g) {
    if (g->n_symbols < g->cap_symbols) {
        return true;
    }
    const int32_t cap = g->cap_symbols ? 2 * g->cap_symbols : 32;
    hn_symbol_entry *symbols = realloc(g->symbols, (size_t)cap * sizeof *symbols);
    if (!symbols) {
        g->failed = 1;
        return false;
    }
    g->symbols = symbols;
    g->cap_symbols = cap;
    return true;
}

hn_ex hn_symbol(hn_graph *g, const char *name, const char *latex) {
    HN_ASSERT(name && name[0]);
    const int known = hn_graph_find_symbol(g, name);
    if (known >= 0) {
        return hn_graph_symbol_expr(g, known);
    }
    hn_symbol_entry entry = {copy_text(g, name), latex ? copy_text(g, latex) : NULL, g->n};
    if (g->failed || !grow_symbols(g)) {
        return hn_zero();
    }
    hn_node *node = new_node(g, HN_OP_SYMBOL, hash_symbol(name), NULL, 0);
    if (!node) {
        return hn_zero();
    }
    node->symbol = g->n_symbols;
    node->deps = 1ull << (g->n_symbols % 64);
    g->symbols[g->n_symbols++] = entry;
    return (hn_ex){1, publish(g)};
}

int hn_graph_n_symbols(const hn_graph *g) {
    return g->n_symbols;
}

const char *hn_graph_symbol_name(const hn_graph *g, int symbol) {
    HN_ASSERT(symbol >= 0 && symbol < g->n_symbols);
    return g->symbols[symbol].name;
}

hn_ex hn_graph_symbol_expr(const hn_graph *g, int symbol) {
    HN_ASSERT(symbol >= 0 && symbol < g->n_symbols);
    return (hn_ex){1, g->symbols[symbol].node};
}

int hn_ex_symbol(const hn_graph *g, hn_ex e) {
    return e.c == 1 ? g->nodes[e.n].symbol : -1;
}

// ---- reading ----

bool hn_is_zero(hn_ex e) {
    return e.n == HN_NODE_ONE && e.c == 0;
}

bool hn_is_number(hn_ex e, double *value) {
    if (e.n != HN_NODE_ONE) {
        return 0;
    }
    if (value) {
        *value = e.c;
    }
    return 1;
}

bool hn_ex_same(hn_ex a, hn_ex b) {
    return a.n == b.n && a.c == b.c;
}

hn_node_view hn_graph_node(const hn_graph *g, int32_t node) {
    HN_ASSERT(node >= 0 && node < g->n);
    const hn_node *p = &g->nodes[node];
    return (hn_node_view){(hn_op)p->op, p->n_args, p->args, p->symbol};
}

// ---- sweeps ----

static bool grow_sweep(hn_sweep *s, int32_t size) {
    if (size <= s->cap) {
        return true;
    }
    const int32_t cap = size + size / 2 + 64;
    int32_t *stamp = realloc(s->stamp, (size_t)cap * sizeof *stamp);
    s->stamp = stamp ? stamp : s->stamp;
    int32_t *slot = realloc(s->slot, (size_t)cap * sizeof *slot);
    s->slot = slot ? slot : s->slot;
    int32_t *order = realloc(s->order, (size_t)cap * sizeof *order);
    s->order = order ? order : s->order;
    if (!stamp || !slot || !order) {
        return false;
    }
    memset(s->stamp + s->cap, 0, (size_t)(cap - s->cap) * sizeof *stamp);
    s->cap = cap;
    return true;
}

static int compare_ids(const void *a, const void *b) {
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/// Breadth first, `order` being the queue as well; the sort by id then makes it topological.
int hn_sweep_collect(const hn_graph *g, const hn_ex *e, int n, uint64_t deps) {
    hn_sweep *s = g->sweep;
    if (!grow_sweep(s, g->n)) {
        return 0;
    }
    s->now++;
    s->n = 0;
#define VISIT(id)                                                                \
    if (s->stamp[id] != s->now && (g->nodes[id].deps & deps || deps == ~0ull)) { \
        s->stamp[id] = s->now;                                                   \
        s->order[s->n++] = (id);                                                 \
    }

    // breadth first from the roots; `order` is the queue
    for (int i = 0; i < n; i++) {
        VISIT(e[i].n)
    }
    for (int32_t head = 0; head < s->n; head++) {
        const hn_node *node = &g->nodes[s->order[head]];
        for (int i = 0; i < node->n_args; i++) {
            VISIT(node->args[i].n)
        }
    }
#undef VISIT

    // ascending ids: arguments before results
    qsort(s->order, (size_t)s->n, sizeof *s->order, compare_ids);
    for (int32_t i = 0; i < s->n; i++) {
        s->slot[s->order[i]] = i;
    }
    return 1;
}

int32_t hn_sweep_find(const hn_graph *g, int32_t node) {
    const hn_sweep *s = g->sweep;
    return node < s->cap && s->stamp[node] == s->now ? s->slot[node] : -1;
}

bool hn_depends_on(const hn_graph *g, hn_ex e, int symbol) {
    HN_ASSERT(symbol >= 0 && symbol < g->n_symbols);
    const uint64_t bit = 1ull << (symbol % 64);
    if (!(g->nodes[e.n].deps & bit) || g->n_symbols <= 64) {
        return (g->nodes[e.n].deps & bit) != 0;
    }
    // without memory for the walk the mask alone answers: it may say yes too often, never no
    return !hn_sweep_collect(g, &e, 1, bit) || hn_sweep_find(g, g->symbols[symbol].node) >= 0;
}
