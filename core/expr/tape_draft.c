// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/tape_draft.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const hn_ir_arg *args_of(const hn_drafter *c, int32_t id) {
    return c->ir->args + c->ir->nodes[id].first;
}

static bool is_lone(const hn_drafter *c, int32_t id, hn_ir_kind kind) {
    return c->ir->nodes[id].kind == kind && c->ir->nodes[id].uses == 1 && !c->absorbed[id];
}

/// A sum of two slots, which (a + b) * c can take in.
static bool is_lone_pair(const hn_drafter *c, int32_t id) {
    if (!is_lone(c, id, HN_IR_SUM) || c->ir->nodes[id].n_args != 2) {
        return false;
    }
    const hn_ir_arg *a = args_of(c, id);
    return !c->absorbed[a[0].node] && !c->absorbed[a[1].node];
}

static void absorb_in_sums(hn_drafter *c) {
    for (int32_t i = 0; i < c->ir->n; i++) {
        if (!c->ir->nodes[i].live || c->ir->nodes[i].kind != HN_IR_SUM) {
            continue;
        }
        for (int32_t k = 0; k < c->ir->nodes[i].n_args; k++) {
            const int32_t a = args_of(c, i)[k].node;
            c->absorbed[a] = (uint8_t)(c->absorbed[a] || is_lone(c, a, HN_IR_MUL));
        }
    }
}

/// Products from the outermost inwards: up to four factors, or a pair's sum and a factor.
static void absorb_in_products(hn_drafter *c) {
    for (int32_t i = c->ir->n - 1; i >= 0; i--) {
        if (!c->ir->nodes[i].live || c->ir->nodes[i].kind != HN_IR_MUL || c->absorbed[i]) {
            continue;
        }
        const int32_t a = args_of(c, i)[0].node, b = args_of(c, i)[1].node;
        const int product_a = is_lone(c, a, HN_IR_MUL), product_b = is_lone(c, b, HN_IR_MUL);
        if (product_a || product_b) {
            c->absorbed[a] = (uint8_t)(c->absorbed[a] || product_a);
            c->absorbed[b] = (uint8_t)(c->absorbed[b] || product_b);
        } else if (is_lone_pair(c, a)) {
            c->absorbed[a] = 1;
        } else if (is_lone_pair(c, b)) {
            c->absorbed[b] = 1;
        }
    }
}

/// sine_of: by argument, the node of its sine; scratch.
static void find_partners(hn_drafter *c, int32_t *sine_of) {
    for (int32_t i = 0; i < c->ir->n; i++) {
        c->partner[i] = -1;
    }
    memset(sine_of, 0xff, (size_t)c->ir->n * sizeof *sine_of);

    // sines are noted by argument, then cosines look for theirs
    for (int pass = 0; pass < 2; pass++) {
        const int op = pass ? HN_OP_COS : HN_OP_SIN;
        for (int32_t i = 0; i < c->ir->n; i++) {
            const hn_ir_node *node = &c->ir->nodes[i];
            if (!node->live || node->kind != HN_IR_CALL || node->op != op) {
                continue;
            }
            const int32_t a = args_of(c, i)[0].node;
            if (!pass) {
                sine_of[a] = i;
            } else if (sine_of[a] >= 0) {
                c->partner[i] = sine_of[a];
                c->partner[sine_of[a]] = i;
            }
        }
    }
}

static void add_operand(hn_draft *d, int32_t id) {
    d->operand[d->n_operands++] = id;
}

static int code_of_key(int key) {
    for (int code = 0; code < TAPE_SINCOS; code++) {
        if (hn_tape_get_code_info(code).key == key) {
            return code;
        }
    }
    HN_ASSERT(key == 0); // every sum of two or three terms has an instruction
    return TAPE_END;
}

static int digit(const hn_drafter *c, hn_ir_arg a) {
    return (a.sign > 0 ? 1 : 3) + !c->absorbed[a.node];
}

static void draft_sum(const hn_drafter *c, int32_t id, hn_draft *d) {
    const hn_ir_node *node = &c->ir->nodes[id];
    int key = 0;
    for (int want = 1; want <= 4; want++) {
        for (int32_t k = 0; k < node->n_args; k++) {
            const hn_ir_arg a = args_of(c, id)[k];
            if (digit(c, a) != want) {
                continue;
            }
            key = 10 * key + want;
            if (c->absorbed[a.node]) {
                add_operand(d, args_of(c, a.node)[0].node);
                add_operand(d, args_of(c, a.node)[1].node);
            } else {
                add_operand(d, a.node);
            }
        }
    }
    d->code = (uint16_t)code_of_key(key);
}

static void draft_product(const hn_drafter *c, int32_t id, hn_draft *d) {
    const int32_t a = args_of(c, id)[0].node, b = args_of(c, id)[1].node;
    const int32_t inner = c->absorbed[a] ? a : b, other = c->absorbed[a] ? b : a;

    // a plain product
    d->code = TAPE_MUL;
    if (!c->absorbed[inner]) {
        add_operand(d, a);
        add_operand(d, b);
        return;
    }

    // (a + b) * c
    const hn_ir_arg *in = args_of(c, inner);
    if (c->ir->nodes[inner].kind == HN_IR_SUM) {
        const int swap = in[0].sign < 0;
        d->code = in[0].sign == in[1].sign ? TAPE_MUL_ADD : TAPE_MUL_SUB;
        add_operand(d, in[swap].node);
        add_operand(d, in[!swap].node);
        add_operand(d, other);
        return;
    }

    // three factors, or four
    add_operand(d, in[0].node);
    add_operand(d, in[1].node);
    d->code = TAPE_MUL3;
    if (c->absorbed[other]) {
        d->code = TAPE_MUL4;
        add_operand(d, args_of(c, other)[0].node);
        add_operand(d, args_of(c, other)[1].node);
    } else {
        add_operand(d, other);
    }
}

static void draft_call(const hn_drafter *c, int32_t id, hn_draft *d) {
    const hn_ir_node *node = &c->ir->nodes[id];
    for (int32_t k = 0; k < node->n_args; k++) {
        add_operand(d, args_of(c, id)[k].node);
    }
    d->op = node->op;
    if (node->op == HN_OP_SQRT) {
        d->code = TAPE_SQRT;
    } else if (node->op != HN_OP_SIN && node->op != HN_OP_COS) {
        d->code = node->n_args == 1 ? TAPE_CALL1 : TAPE_CALL2;
    } else if (c->partner[id] < 0) {
        d->code = node->op == HN_OP_SIN ? TAPE_SIN : TAPE_COS;
    } else {
        d->code = TAPE_SINCOS;
        d->result = node->op == HN_OP_SIN ? id : c->partner[id];
        d->second = node->op == HN_OP_SIN ? c->partner[id] : id;
    }
}

hn_draft hn_draft_make(const hn_drafter *c, int32_t id) {
    hn_draft d = {.code = TAPE_END, .result = id, .second = -1};

    // nothing to do for what is there before the tape runs
    switch ((hn_ir_kind)c->ir->nodes[id].kind) {
    case HN_IR_CONST:
    case HN_IR_INPUT:
        break;
    case HN_IR_MUL:
        draft_product(c, id, &d);
        break;
    case HN_IR_DIV:
    case HN_IR_NEG:
        d.code = c->ir->nodes[id].kind == HN_IR_DIV ? TAPE_DIV : TAPE_NEG;
        for (int32_t k = 0; k < c->ir->nodes[id].n_args; k++) {
            add_operand(&d, args_of(c, id)[k].node);
        }
        break;
    case HN_IR_SUM:
        draft_sum(c, id, &d);
        break;
    case HN_IR_CALL:
        draft_call(c, id, &d);
        break;
    }
    return d;
}

hn_status hn_drafter_create(const hn_ir *ir, hn_drafter *c) {
    const size_t n = (size_t)ir->n + 1;
    *c = (hn_drafter){.ir = ir,
                      .absorbed = calloc(n, sizeof *c->absorbed),
                      .partner = calloc(n, sizeof *c->partner)};
    int32_t *scratch = malloc(n * sizeof *scratch);
    const hn_status status = c->absorbed && c->partner && scratch ? HN_OK : HN_ERR_MEMORY;
    if (status == HN_OK) {
        absorb_in_sums(c);
        absorb_in_products(c);
        find_partners(c, scratch);
    }
    free(scratch);
    return status;
}

void hn_drafter_reset(hn_drafter *c) {
    free(c->absorbed);
    free(c->partner);
    *c = (hn_drafter){0};
}
