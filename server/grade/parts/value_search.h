// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VALUE_SEARCH_H
#define HN_GRADE_VALUE_SEARCH_H
// A search among candidates for the mistake in one wrong entry. A candidate is a formula that the
// mistake would give. It agrees by chance where one number equals another, so a candidate counts as
// certain only when it also agrees after the numbers of the variant are changed. That can be tried
// where the answer names those numbers.

#include "grade/parts/value_sheet.h"

/// Notes a candidate: its formula, and what the mistake is called, earns and says.
typedef void hn_value_note(void *user, hn_ex e, const char *id, double share, const char *says);

/// The search for one entry. Set by hn_value_search_begin().
typedef struct hn_value_search {
    hn_value_sheet *sheet; ///< borrowed
    int entry;
    const double *given; ///< values of the answer at all states
    hn_ex formula;       ///< the answer
    hn_part_result *result;
    int n_found; ///< candidates that explain the answer equally well: 0, 1, 2
    int close;   ///< how closely the first of them agrees: 0 as is asked for, 1 ten times better,
                 ///< 2 a thousand times better
    hn_ex first; ///< its formula, and the factor of it
    double first_factor;
    double alone; ///< of the candidates tried next: the share of the mistake that is named, where
                  ///< a second one beside it lowers the share; 0: nothing lowers it
    /// how closely, as `close` counts, a number must agree with the candidates tried next: the more
    /// there are, the closer
    int closeness;
    hn_value_note *note; ///< takes single mistakes, which are not compared then; NULL: they are
    void *notes;
} hn_value_search;

/// Begins the search for the mistake in entry k, whose values `given` are wrong.
void hn_value_search_begin(hn_value_search *f, hn_value_sheet *sheet, int k, const double *given,
                           hn_ex formula, hn_part_result *r);
/// Compares the answer with `factor` times the formula `e`. The first candidate that agrees is
/// written to the result; a second one that is another function is added to its sentence.
/// Returns true when the values agree and the changed numbers do not speak against it; false where
/// candidates are only noted.
bool hn_value_search_try(hn_value_search *f, hn_ex e, double factor, const char *id, double share,
                         const char *format, ...) HN_PRINTF(6, 7);
/// The name in a formula with the right values that makes it wrong once its number is another one,
/// as t1 in place of l1 where both are 0.77. NULL: none, or its number cannot be changed by itself.
const char *hn_value_search_stray_name(hn_value_sheet *sheet, int k, hn_ex formula);
#endif
