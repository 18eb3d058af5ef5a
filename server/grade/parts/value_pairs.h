// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_PARTS_VALUE_PAIRS_H
#define HN_GRADE_PARTS_VALUE_PAIRS_H
// Two mistakes in one formula. Every single mistake in the formula, and in each of its terms, is
// written down with its values; then each two of them are put together. Besides, each is tried with
// the formula, or a term, that has a wrong number as its factor.

#include "grade/parts/value_search.h"

/// Tries single mistakes: of the formula, or, where `term`, of what stands for one of its terms, of
/// which the exercise lists none.
typedef hn_status hn_value_singles(hn_value_search *f, bool term);

/// Tries each two of the mistakes that `singles` tries; it is called with a search that only notes
/// its candidates. For formulas alone: a number tells too little.
/// Fails: HN_ERR_MEMORY, and what `singles` returns.
HN_MUST_CHECK hn_status hn_value_pairs_try(hn_value_search *f, hn_value_singles *singles);
#endif
