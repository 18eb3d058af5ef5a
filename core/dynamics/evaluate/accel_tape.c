// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/accel_tape.h"

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/solve_rows.h"
#include "expr/construct.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/// Outputs of the tape: a, lambda, guards, rows. Returns owned, or NULL.
static hn_ex *list_outputs(hn_accel_tape *tape, const hn_system *sys, const hn_ldl *ldl,
                           const hn_ex *x, bool want_lambda) {
    hn_ex *outputs = malloc((4 * (size_t)ldl->n + 1) * sizeof *outputs);
    if (!outputs) {
        return NULL;
    }
    int n = 0;
    for (int i = 0; i < sys->nv + (want_lambda ? sys->nc : 0); i++) {
        outputs[n++] = i < sys->nv ? x[i] : hn_neg(x[i]);
    }
    for (int k = 0; k < ldl->n_guards; k++) {
        outputs[n++] = ldl->guard[k][0];
        outputs[n++] = ldl->guard[k][1];
    }
    memcpy(outputs + n, ldl->row_ref, (size_t)sys->nc * sizeof *outputs);
    tape->n_answer = sys->nv + (want_lambda ? sys->nc : 0);
    tape->n_guards = ldl->n_guards;
    tape->n_out = n + sys->nc;
    return outputs;
}

static hn_tape_check check_of(const hn_accel_tape *tape) {
    return (hn_tape_check){.n_answer = tape->n_answer,
                           .n_pairs = tape->n_guards,
                           .n_rows = tape->n_out - tape->n_answer - 2 * tape->n_guards,
                           .pair = HN_ACCEL_SURE_PIVOT,
                           .row = HN_ACCEL_SURE_ROW};
}

static hn_status compile_checked(const hn_system *sys, const hn_ex *outputs,
                                 const hn_accel_tape *tape, hn_arena *arena, hn_inputs *inputs) {
    const hn_tape_check check = check_of(tape);
    return hn_inputs_compile_checked(sys, outputs, tape->n_out, &check, arena, inputs);
}

hn_status hn_accel_tape_compile(const hn_system *sys, bool want_lambda, bool baumgarte,
                                hn_arena *arena, hn_inputs *inputs, hn_accel_tape *tape) {
    hn_arena *scratch = hn_arena_create(0);
    if (!scratch) {
        return HN_ERR_MEMORY;
    }

    // the order of elimination; without one there is no tape
    const hn_solve_rows *rows = NULL;
    hn_ex *x = NULL, *outputs = NULL;
    hn_status status = hn_solve_rows_get(sys, &rows);
    const hn_ldl *ldl = status == HN_OK ? rows->ldl : NULL;
    tape->available = ldl && ldl->available;
    if (tape->available) {
        x = hn_arena_get(scratch, ((size_t)ldl->n + 1) * sizeof *x);
        status = x ? HN_OK : HN_ERR_MEMORY;
    }

    // the solution for these right-hand sides
    if (status == HN_OK && tape->available) {
        hn_solve_rows_rhs(sys, rows, baumgarte, x);
        status = hn_ldl_solve(sys->g, ldl, x, x);
        hn_solve_rows_turn(sys, rows, x + sys->nv);
        outputs = status == HN_OK ? list_outputs(tape, sys, ldl, x, want_lambda) : NULL;
        status = outputs ? compile_checked(sys, outputs, tape, arena, inputs) : HN_ERR_MEMORY;
    }

    free(outputs);
    hn_arena_free(scratch);
    return status;
}

double hn_accel_tape_worst_pivot(const hn_accel_tape *tape, const hn_inputs *in) {
    const double *x = in->x;
    const uint16_t *slots = in->slots + tape->n_answer;
    double worst = 1;
    for (int k = 0; k < tape->n_guards; k++) {
        double ratio = fabs(x[slots[2 * k]]) / fabs(x[slots[2 * k + 1]]);
        if (!(ratio >= worst)) {
            worst = ratio;
        }
    }
    return worst >= 0 ? worst : 0;
}

/// Copies outputs first .. end - 1 to `to` (NULL: nowhere); returns zero times their sum, which is
/// NaN where one of them is not finite.
static inline double copy_outputs(const hn_inputs *in, int first, int end, double *to) {
    double zero = 0;
    for (int k = first; k < end; k++) {
        const double value = in->x[in->slots[k]];
        zero += 0 * value;
        if (to) {
            *to++ = value;
        }
    }
    return zero;
}

bool hn_accel_tape_take(const hn_accel_tape *tape, const hn_inputs *in, double *a, double *lambda) {
    const double zero = copy_outputs(in, 0, in->nv, a);
    return zero + copy_outputs(in, in->nv, tape->n_answer, lambda) == 0;
}

bool hn_accel_tape_solve(const hn_accel_tape *tape, const hn_inputs *in, double *a,
                         double *lambda) {
    const hn_tape_verdict verdict = hn_tape_run_checked(in->tape, in->x);
    if (verdict == HN_TAPE_UNCHECKED) {
        const hn_tape_check check = check_of(tape);
        return hn_accel_tape_take(tape, in, a, lambda) &&
               hn_tape_check_guards_hold(&check, in->slots, in->x);
    }

    // that the numbers are finite is known
    for (int k = 0; k < in->nv; k++) {
        a[k] = in->x[in->slots[k]];
    }
    for (int k = in->nv; lambda && k < tape->n_answer; k++) {
        lambda[k - in->nv] = in->x[in->slots[k]];
    }
    return verdict == HN_TAPE_SURE;
}
