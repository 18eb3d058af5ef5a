// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/native_check.h"

#include "base/arena.h"
#include "expr/lanes.h"
#include "expr/tape_interpret.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHECKS = 8 };

void hn_native_prepare(const hn_tape *t, double *work) {
    memset(work, 0, (size_t)t->info.slots * sizeof *work);
    memcpy(work + t->info.n_inputs, t->constants, (size_t)t->n_constants * sizeof *work);
}

void hn_native_fill(double *inputs, int n, int k) {
    uint64_t x = 88172645463325252ull + (uint64_t)k;
    for (int i = 0; i < n; i++) {
        x = x * 6364136223846793005ull + 1442695040888963407ull;
        inputs[i] = k < 2 ? k : (double)(x >> 11) * 0x1p-53 * 8 - 4;
    }
}

static bool same_bits(double a, double b) {
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static bool agrees_at_states(const hn_tape *tape, hn_native_code code,
                             const hn_native_call *calls) {
    const size_t n = (size_t)tape->info.slots + 1;
    double *w = malloc(2 * n * sizeof *w);
    bool same = w != NULL;
    for (int k = 0; k < CHECKS && same; k++) {
        double *x = w, *y = w + n;
        hn_native_prepare(tape, x);
        hn_native_fill(x, tape->info.n_inputs, k);
        memcpy(y, x, n * sizeof *y);
        hn_tape_interpret(tape, x);
        const int holds = code(y, calls);
        same = holds != HN_TAPE_SURE || hn_tape_check_holds(&tape->check, tape->outputs, x);
        for (int i = 0; i < tape->info.n_outputs && same; i++) {
            same = same_bits(x[tape->outputs[i]], y[tape->outputs[i]]);
        }
    }
    free(w);
    return same;
}

/// Every lane has a state of its own: the checks above, and more of them.
static bool agrees_in_lanes(const hn_tape *tape, hn_lanes_set set, hn_native_code code,
                            const hn_native_call *calls) {
    const size_t n = hn_lanes_work_size(tape);
    hn_arena *arena = hn_arena_create(0);
    double *x = arena ? hn_arena_doubles(arena, n) : NULL,
           *y = arena ? hn_arena_doubles(arena, n) : NULL,
           *in = arena ? hn_arena_doubles(arena, (size_t)tape->info.n_inputs) : NULL;
    bool same = x && y && in;
    if (same) {
        hn_lanes_prepare(tape, x);
        for (int k = 0; k < HN_LANES; k++) {
            hn_native_fill(in, tape->info.n_inputs, k);
            for (int i = 0; i < tape->info.n_inputs; i++) {
                x[HN_LANES * i + k] = in[i];
            }
        }
        memcpy(y, x, n * sizeof *y);
        hn_lanes_run(tape, set, x);
        code(y, calls);
    }
    for (int i = 0; i < tape->info.n_outputs && same; i++) {
        const size_t block = (size_t)tape->outputs[i] * HN_LANES;
        for (size_t k = 0; k < HN_LANES && same; k++) {
            same = same_bits(x[block + k], y[block + k]);
        }
    }
    hn_arena_free(arena);
    return same;
}

bool hn_native_agrees(const hn_tape *tape, hn_native_form form, hn_native_code code,
                      const hn_native_call *calls) {
    return form == HN_NATIVE_SINGLE
               ? agrees_at_states(tape, code, calls)
               : agrees_in_lanes(tape, (hn_lanes_set)(form - HN_NATIVE_LANES), code, calls);
}
