// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/tape_ir.h"

#include "base/hash.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_TABLE = 256 };

void hn_ir_reset(hn_ir *ir) {
    free(ir->nodes);
    free(ir->args);
    free(ir->table);
    free(ir->outputs);
    *ir = (hn_ir){0};
}

static bool grow(hn_ir *ir, int32_t more_args) {
    if (ir->n == ir->cap) {
        const int32_t cap = ir->cap ? 2 * ir->cap : FIRST_TABLE;
        hn_ir_node *nodes = realloc(ir->nodes, (size_t)cap * sizeof *nodes);
        if (!nodes) {
            return false;
        }
        ir->nodes = nodes;
        ir->cap = cap;
    }
    if (!ir->args || ir->n_args + more_args > ir->cap_args) {
        const int32_t cap = 2 * (ir->n_args + more_args) + FIRST_TABLE;
        hn_ir_arg *args = realloc(ir->args, (size_t)cap * sizeof *args);
        if (!args) {
            return false;
        }
        ir->args = args;
        ir->cap_args = cap;
    }
    return true;
}

static uint64_t word_of(int32_t high, int32_t low) {
    return (uint64_t)(uint32_t)high << 32 | (uint32_t)low;
}

static uint64_t hash_node(const hn_ir_node *node, const hn_ir_arg *args) {
    uint64_t h = hn_hash_word(HN_HASH_START, word_of(node->kind, node->op));
    h = hn_hash_word(h, word_of(node->n_args, node->input));
    if (node->kind == HN_IR_CONST) {
        h = hn_hash_double(h, node->value);
    }
    for (int i = 0; i < node->n_args; i++) {
        h = hn_hash_word(h, word_of(args[i].node, args[i].sign));
    }
    return hn_hash_mix(h);
}

static bool same_node(const hn_ir *ir, const hn_ir_node *a, const hn_ir_node *b,
                      const hn_ir_arg *b_args) {
    return a->kind == b->kind && a->op == b->op && a->n_args == b->n_args && a->input == b->input &&
           (a->kind != HN_IR_CONST || memcmp(&a->value, &b->value, sizeof a->value) == 0) &&
           (a->n_args == 0 ||
            memcmp(ir->args + a->first, b_args, (size_t)a->n_args * sizeof *b_args) == 0);
}

static int32_t find_node(const hn_ir *ir, const hn_ir_node *node, const hn_ir_arg *args) {
    if (!ir->table_size) {
        return -1;
    }
    uint32_t k = (uint32_t)hash_node(node, args) & (ir->table_size - 1);
    for (; ir->table[k] >= 0; k = (k + 1) & (ir->table_size - 1)) {
        if (same_node(ir, &ir->nodes[ir->table[k]], node, args)) {
            return ir->table[k];
        }
    }
    return -1;
}

static void enter(hn_ir *ir, int32_t id) {
    const hn_ir_node *node = &ir->nodes[id];
    uint32_t k = (uint32_t)hash_node(node, ir->args + node->first) & (ir->table_size - 1);
    while (ir->table[k] >= 0) {
        k = (k + 1) & (ir->table_size - 1);
    }
    ir->table[k] = id;
}

static bool grow_table(hn_ir *ir) {
    if (2u * (uint32_t)(ir->n + 1) <= ir->table_size) {
        return true;
    }
    const uint32_t size = ir->table_size ? 2 * ir->table_size : FIRST_TABLE;
    int32_t *table = malloc(size * sizeof *table);
    if (!table) {
        return false;
    }
    memset(table, 0xff, size * sizeof *table);
    free(ir->table);
    ir->table = table;
    ir->table_size = size;
    for (int32_t i = 0; i < ir->n; i++) {
        enter(ir, i);
    }
    return true;
}

static int32_t intern(hn_ir *ir, hn_ir_node node, const hn_ir_arg *args, int *fresh) {
    const int32_t found = find_node(ir, &node, args);
    if (fresh) {
        *fresh = found < 0;
    }
    if (found >= 0) {
        return found;
    }
    if (ir->failed || !grow(ir, node.n_args) || !grow_table(ir)) {
        ir->failed = 1;
        return 0;
    }
    node.first = ir->n_args;
    if (node.n_args) {
        memcpy(ir->args + ir->n_args, args, (size_t)node.n_args * sizeof *args);
        ir->n_args += node.n_args;
    }
    ir->nodes[ir->n] = node;
    enter(ir, ir->n);
    return ir->n++;
}

int32_t hn_ir_const(hn_ir *ir, double value) {
    return intern(ir, (hn_ir_node){.kind = HN_IR_CONST, .value = value + 0.0}, NULL, NULL);
}

int32_t hn_ir_input(hn_ir *ir, int32_t input) {
    return intern(ir, (hn_ir_node){.kind = HN_IR_INPUT, .input = input}, NULL, NULL);
}

int32_t hn_ir_mul(hn_ir *ir, int32_t a, int32_t b, int *fresh) {
    const hn_ir_arg args[2] = {{a < b ? a : b, 1}, {a < b ? b : a, 1}};
    return intern(ir, (hn_ir_node){.kind = HN_IR_MUL, .n_args = 2}, args, fresh);
}

int32_t hn_ir_find_mul(const hn_ir *ir, int32_t a, int32_t b) {
    const hn_ir_arg args[2] = {{a < b ? a : b, 1}, {a < b ? b : a, 1}};
    return find_node(ir, &(hn_ir_node){.kind = HN_IR_MUL, .n_args = 2}, args);
}

int32_t hn_ir_div(hn_ir *ir, int32_t a, int32_t b, int *fresh) {
    const hn_ir_arg args[2] = {{a, 1}, {b, 1}};
    return intern(ir, (hn_ir_node){.kind = HN_IR_DIV, .n_args = 2}, args, fresh);
}

int32_t hn_ir_sum(hn_ir *ir, const hn_ir_arg *args, int32_t n, int *fresh) {
    return intern(ir, (hn_ir_node){.kind = HN_IR_SUM, .n_args = n}, args, fresh);
}

int32_t hn_ir_neg(hn_ir *ir, int32_t a) {
    return intern(ir, (hn_ir_node){.kind = HN_IR_NEG, .n_args = 1}, &(hn_ir_arg){a, 1}, NULL);
}

int32_t hn_ir_call(hn_ir *ir, hn_op op, const int32_t *args, int n, int *fresh) {
    hn_ir_arg list[2] = {{args[0], 1}, {n > 1 ? args[1] : 0, 1}};
    return intern(ir, (hn_ir_node){.kind = HN_IR_CALL, .op = (uint8_t)op, .n_args = n}, list,
                  fresh);
}

// ---- passes ----

/// Arguments have lower ids than what uses them until sums are split; then only a walk is safe.
void hn_ir_mark_live(hn_ir *ir) {
    int32_t *stack = malloc(((size_t)ir->n + 1) * sizeof *stack);
    if (!stack) {
        ir->failed = 1;
        return;
    }

    int32_t n = 0;
    for (int32_t i = 0; i < ir->n; i++) {
        ir->nodes[i].live = 0;
        ir->nodes[i].uses = 0;
    }
#define USE(id)                      \
    if (ir->nodes[id].uses++ == 0) { \
        ir->nodes[id].live = 1;      \
        stack[n++] = (id);           \
    }

    // from the outputs down, each node once
    for (int32_t i = 0; i < ir->n_outputs; i++) {
        USE(ir->outputs[i])
    }
    while (n > 0) {
        const hn_ir_node *node = &ir->nodes[stack[--n]];
        for (int32_t k = 0; k < node->n_args; k++) {
            USE(ir->args[node->first + k].node)
        }
    }
#undef USE
    free(stack);
}

static bool is_lone_sum(const hn_ir *ir, int32_t id) {
    return ir->nodes[id].kind == HN_IR_SUM && ir->nodes[id].uses == 1;
}

/// A new list of arguments at the end of the pool; those of lone sums take the sums' places.
static void flatten_sum(hn_ir *ir, int32_t id) {
    const int32_t n = ir->nodes[id].n_args, first = ir->nodes[id].first;
    int32_t total = 0;
    for (int32_t i = 0; i < n; i++) {
        const int32_t a = ir->args[first + i].node;
        total += is_lone_sum(ir, a) ? ir->nodes[a].n_args : 1;
    }

    if (total == n || !grow(ir, total)) {
        ir->failed |= total != n;
        return;
    }

    // terms of inner sums take their places in the outer one
    hn_ir_arg *out = ir->args + ir->n_args;
    for (int32_t i = 0; i < n; i++) {
        const hn_ir_arg a = ir->args[first + i];
        if (!is_lone_sum(ir, a.node)) {
            *out++ = a;
            continue;
        }
        hn_ir_node *inner = &ir->nodes[a.node];
        for (int32_t k = 0; k < inner->n_args; k++) {
            const hn_ir_arg b = ir->args[inner->first + k];
            *out++ = (hn_ir_arg){b.node, a.sign * b.sign};
        }
        inner->live = 0;
        inner->uses = 0;
    }

    ir->nodes[id].first = ir->n_args;
    ir->nodes[id].n_args = total;
    ir->n_args += total;
}

void hn_ir_flatten_sums(hn_ir *ir) {
    const int32_t n = ir->n;
    for (int32_t i = 0; i < n && !ir->failed; i++) {
        if (ir->nodes[i].live && ir->nodes[i].kind == HN_IR_SUM) {
            flatten_sum(ir, i);
        }
    }
}

/// Puts a positive term first among those that open the sum.
static void lead_with_positive(hn_ir_arg *t, int32_t n) {
    for (int32_t i = 0; i < n; i++) {
        if (t[i].sign > 0) {
            const hn_ir_arg first = t[i];
            memmove(t + 1, t, (size_t)i * sizeof *t);
            t[0] = first;
            return;
        }
    }
}

static void split_sum(hn_ir *ir, int32_t id) {
    const int32_t n = ir->nodes[id].n_args;
    hn_ir_arg *t = malloc((size_t)n * sizeof *t);
    if (!t) {
        ir->failed = 1;
        return;
    }
    memcpy(t, ir->args + ir->nodes[id].first, (size_t)n * sizeof *t);
    lead_with_positive(t, n);

    // pieces of three terms, each the first term of the next
    int32_t at = 0;
    hn_ir_arg piece[3] = {t[0], {0, 1}, {0, 1}};
    for (at = 1; n - at > 2; at += 2) {
        piece[1] = t[at];
        piece[2] = t[at + 1];
        piece[0] = (hn_ir_arg){hn_ir_sum(ir, piece, 3, NULL), 1};
    }
    hn_ir_arg *own = ir->args + ir->nodes[id].first; // after hn_ir_sum, which may move them
    own[0] = piece[0];
    memcpy(own + 1, t + at, (size_t)(n - at) * sizeof *t);
    ir->nodes[id].n_args = 1 + n - at;
    free(t);
}

void hn_ir_split_sums(hn_ir *ir) {
    const int32_t n = ir->n;
    for (int32_t i = 0; i < n && !ir->failed; i++) {
        if (ir->nodes[i].live && ir->nodes[i].kind == HN_IR_SUM && ir->nodes[i].n_args > 3) {
            split_sum(ir, i);
        }
    }
}
