// SPDX-License-Identifier: GPL-3.0-or-later
// IR to tape: in what order the instructions of tape_draft.h run, which slot holds what.

#include "expr/tape_code.h"

#include "expr/graph_internal.h"
#include "expr/native.h"
#include "expr/tape_draft.h"
#include "expr/tape_interpret.h"
#include "expr/tape_lower.h"
#include "expr/tape_store.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct compiler {
    hn_ir ir;
    hn_drafter drafter;
    uint8_t *state; ///< of the walk
    int32_t *need;  ///< slots needed to compute a node (Sethi and Ullman's number)
    hn_draft *drafts;
    int32_t n_drafts;
    int32_t *stack;
    uint16_t *slot; ///< by IR node
    int32_t *last_use;
    int32_t n_constants, n_slots;
    int keep_drafts;
} compiler;

enum { NEW, OPEN, DONE };

// ---- order ----

static void sort_by_need(const compiler *c, hn_draft *d) {
    for (int i = 1; i < d->n_operands; i++) {
        const int32_t x = d->operand[i];
        int k = i;
        for (; k > 0 && c->need[d->operand[k - 1]] > c->need[x]; k--) {
            d->operand[k] = d->operand[k - 1];
        }
        d->operand[k] = x;
    }
}

/// Sethi and Ullman: the operand that needs most goes first, each one done occupies a slot. `d` is
/// sorted.
static int32_t need_of(const compiler *c, const hn_draft *d) {
    int32_t need = d->n_operands ? 1 : 0;
    for (int i = d->n_operands - 1, held = 0; i >= 0; i--, held++) {
        const int32_t n = c->need[d->operand[i]];
        need = n + held > need && n > 0 ? n + held : need;
    }
    return need;
}

static void finish_node(compiler *c, int32_t id, const hn_draft *d, const hn_draft *sorted) {
    c->state[id] = DONE;
    if (d->second >= 0) {
        c->state[d->result] = c->state[d->second] = DONE;
    }
    if (c->keep_drafts) {
        c->drafts[c->n_drafts++] = *d;
    } else {
        c->need[d->result] = need_of(c, sorted);
        if (d->second >= 0) {
            c->need[d->second] = c->need[d->result];
        }
    }
}

/// Depth first from one output, on a stack of our own: graphs may be 100,000 deep.
static void walk(compiler *c, int32_t root) {
    int32_t n = 0;
    c->stack[n++] = root;
    while (n > 0) {
        const int32_t id = c->stack[n - 1];
        const hn_draft d =
            c->state[id] == DONE ? (hn_draft){.code = TAPE_END} : hn_draft_make(&c->drafter, id);
        if (d.code == TAPE_END) {
            c->state[id] = DONE;
            n--;
            continue;
        }

        // operands are done: the node comes after them
        hn_draft sorted = d;
        sort_by_need(c, &sorted);
        if (c->state[id] == OPEN) {
            finish_node(c, id, &d, &sorted);
            n--;
            continue;
        }

        // first its operands, the most demanding one last on the stack
        c->state[id] = OPEN;
        for (int i = 0; i < sorted.n_operands; i++) {
            if (c->state[sorted.operand[i]] == NEW) {
                c->stack[n++] = sorted.operand[i];
            }
        }
    }
}

/// Two walks: the first learns what each node needs, the second keeps the order.
static void order_all(compiler *c) {
    for (int pass = 0; pass < 2; pass++) {
        memset(c->state, NEW, (size_t)c->ir.n);
        c->keep_drafts = pass;
        c->n_drafts = 0;
        for (int32_t i = 0; i < c->ir.n_outputs; i++) {
            walk(c, c->ir.outputs[i]);
        }
    }
}

static bool is_of_input(const compiler *c, const hn_draft *d) {
    return d->code == TAPE_SINCOS && c->ir.nodes[d->operand[0]].kind == HN_IR_INPUT;
}

enum { MOST_SORTED = 4 }; // angles that are found together, see hn_lanes_sincos_four

static int32_t input_of(const compiler *c, const hn_draft *d) {
    return c->ir.nodes[d->operand[0]].input;
}

/// Orders sines and cosines by their inputs: tapes that take the same angles take them in the same
/// places.
static void sort_angles(const compiler *c, int32_t n, hn_draft *d) {
    for (int32_t i = 1; i < n; i++) {
        const hn_draft next = d[i];
        int32_t k = i;
        for (; k > 0 && input_of(c, &d[k - 1]) > input_of(c, &next); k--) {
            d[k] = d[k - 1];
        }
        d[k] = next;
    }
}

/// Moves sines and cosines of inputs to the front; the others keep their order. Returns how many.
static int32_t put_angles_first(compiler *c) {
    int32_t n = 0;
    for (int32_t i = 0; i < c->n_drafts; i++) {
        n += is_of_input(c, &c->drafts[i]);
    }

    // from behind, since the others move back by those that follow them
    hn_draft *first = malloc(((size_t)n + 1) * sizeof *first);
    if (!first) {
        c->ir.failed = 1;
        return 0;
    }
    int32_t at = n, to = c->n_drafts;
    for (int32_t i = c->n_drafts - 1; i >= 0; i--) {
        if (is_of_input(c, &c->drafts[i])) {
            first[--at] = c->drafts[i];
        } else {
            c->drafts[--to] = c->drafts[i];
        }
    }
    if (n <= MOST_SORTED) {
        sort_angles(c, n, first);
    }
    memcpy(c->drafts, first, (size_t)n * sizeof *first);
    free(first);
    return n;
}

// ---- slots ----

static void find_last_uses(compiler *c) {
    memset(c->last_use, 0xff, (size_t)c->ir.n * sizeof *c->last_use);
    for (int32_t i = 0; i < c->n_drafts; i++) {
        for (int k = 0; k < c->drafts[i].n_operands; k++) {
            c->last_use[c->drafts[i].operand[k]] = i;
        }
    }
    for (int32_t i = 0; i < c->ir.n_outputs; i++) {
        c->last_use[c->ir.outputs[i]] = INT32_MAX;
    }
}

/// Inputs and constants have places of their own. Returns 0 beyond the limit.
static bool place_fixed(compiler *c, int n_inputs) {
    int32_t next = n_inputs;
    for (int32_t i = 0; i < c->ir.n; i++) {
        const hn_ir_node *node = &c->ir.nodes[i];
        if (node->kind == HN_IR_INPUT) {
            c->slot[i] = (uint16_t)node->input;
        } else if (node->kind == HN_IR_CONST && node->live) {
            if (next >= HN_TAPE_MAX_SLOTS) {
                return false;
            }
            c->slot[i] = (uint16_t)next++;
        }
    }
    c->n_constants = next - n_inputs;
    c->n_slots = next;
    return n_inputs <= HN_TAPE_MAX_SLOTS;
}

typedef struct free_slots {
    uint16_t *slot;
    int32_t n;
} free_slots;

static bool take_slot(compiler *c, free_slots *f, int32_t id) {
    if (f->n == 0 && c->n_slots >= HN_TAPE_MAX_SLOTS) {
        return false;
    }
    c->slot[id] = f->n ? f->slot[--f->n] : (uint16_t)c->n_slots++;
    return true;
}

/// Frees the slots of operands that die here; the result may take one of them at once.
static void release_operands(compiler *c, free_slots *f, int32_t at, int32_t fixed) {
    const hn_draft *d = &c->drafts[at];
    for (int k = 0; k < d->n_operands; k++) {
        const int32_t id = d->operand[k];
        if (c->last_use[id] == at && c->slot[id] >= fixed) {
            f->slot[f->n++] = c->slot[id];
            c->last_use[id] = -1; // an operand named twice is freed once
        }
    }
}

static void write_instruction(const compiler *c, const hn_draft *d, hn_tape_instruction *out,
                              const uint16_t *operand_slots) {
    *out = (hn_tape_instruction){.code = d->code};
    out->v[0] = c->slot[d->result];
    memcpy(out->v + 1, operand_slots, d->n_operands * sizeof *operand_slots);
    if (d->second >= 0) {
        out->v[2] = c->slot[d->second];
    }
    if (d->code == TAPE_CALL1 || d->code == TAPE_CALL2) {
        out->v[6] = (uint16_t)d->op;
    }
}

/// Gives every value a slot and writes the code. Returns 0 beyond the limit.
static bool place_all(compiler *c, free_slots *f, hn_tape_instruction *code) {
    const int32_t fixed = c->n_slots;
    for (int32_t i = 0; i < c->n_drafts; i++) {
        const hn_draft *d = &c->drafts[i];
        uint16_t slots[HN_TAPE_OPERANDS] = {0};
        for (int k = 0; k < d->n_operands; k++) {
            slots[k] = c->slot[d->operand[k]];
        }
        release_operands(c, f, i, fixed);
        if (!take_slot(c, f, d->result) || (d->second >= 0 && !take_slot(c, f, d->second))) {
            return false;
        }
        write_instruction(c, d, &code[i], slots);
    }
    code[c->n_drafts] = (hn_tape_instruction){.code = TAPE_END};
    return true;
}

// ---- counting and assembling ----

static void count_operations(const compiler *c, hn_tape_info *info) {
    for (int32_t i = 0; i < c->ir.n; i++) {
        const hn_ir_node *node = &c->ir.nodes[i];
        if (!node->live) {
            continue;
        }

        // operations as written, whatever instruction they share
        switch ((hn_ir_kind)node->kind) {
        case HN_IR_CONST:
        case HN_IR_INPUT:
            break;
        case HN_IR_MUL:
            info->mul++;
            break;
        case HN_IR_DIV:
            info->div++;
            break;
        case HN_IR_SUM:
            info->add += node->n_args - 1;
            break;
        case HN_IR_NEG:
            info->other++;
            break;
        case HN_IR_CALL:
            if (node->op == HN_OP_SIN || node->op == HN_OP_COS) {
                info->sincos += c->drafter.partner[i] < i; // a pair counts once
            } else if (node->op == HN_OP_SQRT) {
                info->sqrt++;
            } else {
                info->other++;
            }
            break;
        }
    }
    info->ops = info->add + info->mul + info->div + info->sincos + info->sqrt + info->other;
}

static void compiler_reset(compiler *c) {
    hn_ir_reset(&c->ir);
    hn_drafter_reset(&c->drafter);
    free(c->state);
    free(c->need);
    free(c->drafts);
    free(c->stack);
    free(c->slot);
    free(c->last_use);
}

static int compiler_alloc(compiler *c) {
    const size_t n = (size_t)c->ir.n + 1;
    c->state = calloc(n, 1);
    c->need = calloc(n, sizeof *c->need);
    c->drafts = calloc(n, sizeof *c->drafts);
    c->stack = calloc((HN_TAPE_OPERANDS + 1) * n, sizeof *c->stack);
    c->slot = calloc(n, sizeof *c->slot);
    c->last_use = calloc(n, sizeof *c->last_use);
    return c->state && c->need && c->drafts && c->stack && c->slot && c->last_use;
}

static void copy_constants(const compiler *c, int n_inputs, double *constants) {
    for (int32_t i = 0; i < c->ir.n; i++) {
        if (c->ir.nodes[i].live && c->ir.nodes[i].kind == HN_IR_CONST) {
            constants[c->slot[i] - n_inputs] = c->ir.nodes[i].value;
        }
    }
}

static hn_status assemble(compiler *c, int n_inputs, hn_tape *tape) {
    free_slots f = {0};
    hn_status status = HN_OK;
    if (!place_fixed(c, n_inputs)) {
        return HN_ERR_LIMIT;
    }

    tape->code = malloc(((size_t)c->n_drafts + 1) * sizeof *tape->code);
    tape->constants = calloc((size_t)c->n_constants + 1, sizeof *tape->constants);
    tape->outputs = calloc((size_t)c->ir.n_outputs + 1, sizeof *tape->outputs);
    const size_t most = c->ir.n < HN_TAPE_MAX_SLOTS ? (size_t)c->ir.n : HN_TAPE_MAX_SLOTS;
    f.slot = malloc((most + 1) * sizeof *f.slot); // a value has one slot at a time

    // slots are given out in the order of the drafts
    if (!tape->code || !tape->constants || !tape->outputs || !f.slot) {
        status = HN_ERR_MEMORY;
    } else if (!place_all(c, &f, tape->code)) {
        status = HN_ERR_LIMIT;
    } else {
        copy_constants(c, n_inputs, tape->constants);
        for (int32_t i = 0; i < c->ir.n_outputs; i++) {
            tape->outputs[i] = c->slot[c->ir.outputs[i]];
        }
        tape->n_constants = c->n_constants;
        tape->info = (hn_tape_info){.n_inputs = n_inputs,
                                    .n_outputs = c->ir.n_outputs,
                                    .instructions = c->n_drafts,
                                    .slots = c->n_slots};
        count_operations(c, &tape->info);
    }

    free(f.slot);
    return status;
}

/// Compiles a tape that the graph has not yet.
static hn_status compile(hn_graph *g, const hn_tape_key *key, hn_tape **out) {
    compiler c = {0};
    hn_tape *tape = calloc(1, sizeof *tape);
    hn_status status = tape ? HN_OK : HN_ERR_MEMORY;

    // graph to operations without coefficients
    if (!status) {
        status = hn_ir_lower(&c.ir, g, key->outputs, key->n_out, key->symbols, key->n_sym);
    }

    // sums of two and three terms, dead code gone
    if (!status) {
        hn_ir_mark_live(&c.ir);
        hn_ir_flatten_sums(&c.ir);
        hn_ir_split_sums(&c.ir);
        hn_ir_mark_live(&c.ir);
        status = c.ir.failed || !compiler_alloc(&c) ? HN_ERR_MEMORY : HN_OK;
        HN_THEN(status, hn_drafter_create(&c.ir, &c.drafter));
    }

    // instructions, their order, their slots
    if (!status) {
        order_all(&c);
        tape->n_angles = put_angles_first(&c);
        tape->four = tape->n_angles > 1 ? hn_lanes_sincos_four_get() : NULL;
        find_last_uses(&c);
        status = c.ir.failed ? HN_ERR_MEMORY : assemble(&c, key->n_sym, tape);
    }

    compiler_reset(&c);
    if (status) {
        hn_tape_free(tape);
        return status;
    }
    *out = tape;
    return HN_OK;
}

/// The same, and the graph keeps it for the next who asks.
static hn_status compile_and_keep(hn_graph *g, const hn_tape_key *key, hn_tape **out) {
    hn_tape *tape = NULL;
    HN_TRY(compile(g, key, &tape));
    tape->sharers = malloc(sizeof *tape->sharers);
    hn_status status = tape->sharers ? HN_OK : HN_ERR_MEMORY;
    if (status == HN_OK) {
        atomic_init(tape->sharers, 1);
        g->free_tapes = hn_tape_store_free;
        status = hn_tape_store_keep(&g->tapes, key, tape);
    }
    if (status != HN_OK) {
        hn_tape_free(tape);
        return status;
    }
    *out = tape;
    return HN_OK;
}

hn_status hn_tape_compile(hn_graph *g, const hn_ex *outputs, int n_out, const int *symbols,
                          int n_sym, hn_tape **out) {
    const hn_tape_check none = {0};
    return hn_tape_compile_checked(g, outputs, n_out, symbols, n_sym, &none, out);
}

hn_status hn_tape_compile_checked(hn_graph *g, const hn_ex *outputs, int n_out, const int *symbols,
                                  int n_sym, const hn_tape_check *check, hn_tape **out) {
    HN_ASSERT(check->n_answer + 2 * check->n_pairs + check->n_rows <= n_out);
    const hn_tape_key key = {outputs, n_out, symbols, n_sym};
    hn_tape *tape = NULL;
    if (!g->failed) {
        HN_TRY(hn_tape_store_find(g->tapes, &key, &tape));
    }
    if (!tape) {
        HN_TRY(compile_and_keep(g, &key, &tape));
    }
    tape->check = *check;
    tape->native = hn_native_state_create(tape, HN_NATIVE_SINGLE);
    *out = tape;
    return HN_OK;
}
