// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/tape_check.h"

#include <math.h>
#include <string.h>

/// Twice the bits of |x|: ordered as |x| is; what is not finite is not below NOT_FINITE. Integers,
/// since a chain of them waits one cycle for each number where one of doubles waits four.
static inline uint64_t order_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits << 1;
}
static const uint64_t NOT_FINITE = 0xffe0000000000000;

static double number_of(uint64_t order) {
    double x;
    order >>= 1;
    memcpy(&x, &order, sizeof x);
    return x;
}

static bool rows_hold(int n, const uint16_t *slots, const double *work, double row) {
    uint64_t least = NOT_FINITE, most = 0;
    for (int k = 0; k < n; k++) {
        const uint64_t order = order_of(work[slots[k]]);
        least = order < least ? order : least;
        most = order > most ? order : most;
    }
    return n == 0 || (most < NOT_FINITE && number_of(least) > row * number_of(most));
}

bool hn_tape_check_guards_hold(const hn_tape_check *check, const uint16_t *slots,
                               const double *work) {
    bool sure = true;
    slots += check->n_answer;
    for (int k = 0; k < check->n_pairs; k++) { // a NaN is not above anything
        sure &= fabs(work[slots[2 * k]]) > check->pair * fabs(work[slots[2 * k + 1]]);
    }
    return sure && rows_hold(check->n_rows, slots + 2 * check->n_pairs, work, check->row);
}

bool hn_tape_check_holds(const hn_tape_check *check, const uint16_t *slots, const double *work) {
    bool finite = true;
    for (int k = 0; k < check->n_answer; k++) {
        finite &= order_of(work[slots[k]]) < NOT_FINITE;
    }
    return finite && hn_tape_check_guards_hold(check, slots, work);
}

bool hn_tape_check_equals(const hn_tape_check *a, const hn_tape_check *b) {
    return a->n_answer == b->n_answer && a->n_pairs == b->n_pairs && a->n_rows == b->n_rows &&
           a->pair == b->pair && a->row == b->row;
}
