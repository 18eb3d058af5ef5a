// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_CHECK_H
#define HN_EXPR_TAPE_CHECK_H
// Conditions that make the answer of a tape sure, in terms of its outputs, in this order:
//
//   n_answer  each is finite
//   n_pairs   pairs: the first is larger in size than `pair` times the second
//   n_rows    each is finite and larger in size than `row` times the largest of them
//
// Outputs behind these are free. Nothing is divided and nothing is ordered by its last bit: a check
// that holds is sure, one that does not means that the answer is worth a closer look.

#include <stdbool.h>
#include <stdint.h>

typedef struct hn_tape_check {
    int n_answer, n_pairs, n_rows;
    double pair, row;
} hn_tape_check;

/// Verdict on the answer of a tape after a run.
typedef enum hn_tape_verdict { HN_TAPE_UNSURE, HN_TAPE_SURE, HN_TAPE_UNCHECKED } hn_tape_verdict;

/// Returns whether it holds after a run: output k is work[slots[k]]. One of no outputs holds.
bool hn_tape_check_holds(const hn_tape_check *check, const uint16_t *slots, const double *work);
/// The same without the finite answer, for those who copy it and look at each number anyway.
bool hn_tape_check_guards_hold(const hn_tape_check *check, const uint16_t *slots,
                               const double *work);
bool hn_tape_check_equals(const hn_tape_check *a, const hn_tape_check *b);

#endif
