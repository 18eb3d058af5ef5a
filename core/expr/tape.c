// SPDX-License-Identifier: GPL-3.0-or-later
// The tape at work: evaluation and what can be read from it.
#include "expr/tape_code.h"

#include "base/strbuf.h"
#include "expr/native.h"
#include "expr/tape_interpret.h"

#include <stdlib.h>
#include <string.h>

void hn_tape_free(hn_tape *tape) {
    if (!tape) {
        return;
    }
    if (!tape->sharers || atomic_fetch_sub(tape->sharers, 1) == 1) {
        free(tape->code);
        free(tape->constants);
        free(tape->outputs);
        free(tape->sharers);
    }
    hn_native_state_release(tape->native);
    free(tape);
}

hn_tape_info hn_tape_get_info(const hn_tape *tape) {
    return tape->info;
}

size_t hn_tape_work_size(const hn_tape *tape) {
    return (size_t)tape->info.slots;
}

void hn_tape_prepare(const hn_tape *tape, double *work) {
    memset(work, 0, (size_t)tape->info.slots * sizeof *work);
    memcpy(work + tape->info.n_inputs, tape->constants, (size_t)tape->n_constants * sizeof *work);
}

// ---- evaluation ----

void hn_tape_eval(const hn_tape *tape, const double *in, double *out, double *work) {
    if (tape->info.n_inputs > 0) {
        memcpy(work, in, (size_t)tape->info.n_inputs * sizeof *work);
    }
    hn_tape_run(tape, work);
    for (int k = 0; k < tape->info.n_outputs; k++) {
        out[k] = work[tape->outputs[k]];
    }
}

/// The native code, if it is there; else the evaluation is counted.
static inline hn_native_code find_code(const hn_tape *tape) {
    hn_native_code code = NULL;
    if (tape->native) {
        code = atomic_load_explicit(&tape->native->code, memory_order_acquire);
        if (!code) {
            hn_native_count(tape, tape->native);
        }
    }
    return code;
}

void hn_tape_run(const hn_tape *tape, double *work) {
    const hn_native_code code = find_code(tape);
    if (code) {
        code(work, tape->native->calls);
    } else {
        hn_tape_interpret(tape, work);
    }
}

hn_tape_verdict hn_tape_run_checked(const hn_tape *tape, double *work) {
    const hn_native_code code = find_code(tape);
    if (code) {
        return (hn_tape_verdict)code(work, tape->native->calls);
    }
    hn_tape_interpret(tape, work);
    return HN_TAPE_UNCHECKED;
}

const uint16_t *hn_tape_output_slots(const hn_tape *tape) {
    return tape->outputs;
}

// ---- listing ----

static const char *name_of(const hn_tape_instruction *i) {
    switch (i->code) {
    case TAPE_SINCOS:
        return "sincos a";
    case TAPE_SIN:
        return "sin a";
    case TAPE_COS:
        return "cos a";
    case TAPE_CALL1:
    case TAPE_CALL2:
        return hn_op_get_info((hn_op)i->v[6])->name;
    default:
        return hn_tape_get_code_info(i->code).text;
    }
}

/// "in 3" for an input, the number for a constant, "s12" for a slot.
static void list_place(const hn_tape *tape, int slot, hn_strbuf *text) {
    const int constant = slot - tape->info.n_inputs;
    if (constant < 0) {
        hn_strbuf_printf(text, " in%d", slot);
    } else if (constant < tape->n_constants) {
        hn_strbuf_printf(text, " %.17g", tape->constants[constant]);
    } else {
        hn_strbuf_printf(text, " s%d", slot);
    }
}

void hn_tape_list(const hn_tape *tape, hn_strbuf *text) {
    for (const hn_tape_instruction *i = tape->code; i->code != TAPE_END; i++) {
        hn_strbuf_printf(text, "s%d", i->v[0]);
        if (i->code == TAPE_SINCOS) {
            hn_strbuf_printf(text, " s%d", i->v[2]);
        }
        hn_strbuf_printf(text, " = %s :", name_of(i));
        for (int k = 0; k < hn_tape_operands(i); k++) {
            list_place(tape, i->v[1 + k], text);
        }
        hn_strbuf_add(text, "\n");
    }
    hn_strbuf_add(text, "out");
    for (int k = 0; k < tape->info.n_outputs; k++) {
        list_place(tape, tape->outputs[k], text);
    }
    hn_strbuf_add(text, "\n");
}
