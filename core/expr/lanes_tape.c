// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/lanes_tape.h"

#include "expr/native.h"

void hn_lanes_tape_init(hn_lanes_tape *l, const hn_tape *tape, hn_lanes_set set) {
    *l = (hn_lanes_tape){.tape = tape,
                         .set = set,
                         .native = hn_native_state_create(tape, HN_NATIVE_LANES + (int)set)};
}

void hn_lanes_tape_reset(hn_lanes_tape *l) {
    hn_native_state_release(l->native);
    l->native = NULL;
}

void hn_lanes_tape_run(const hn_lanes_tape *l, double *work) {
    if (l->native) {
        const hn_native_code code = atomic_load_explicit(&l->native->code, memory_order_acquire);
        if (code) {
            code(work, l->native->calls);
            return;
        }
        hn_native_count(l->tape, l->native);
    }
    hn_lanes_run(l->tape, l->set, work);
}
