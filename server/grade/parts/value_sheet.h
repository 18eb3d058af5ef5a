// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VALUE_SHEET_H
#define HN_GRADE_VALUE_SHEET_H
// A reference of numbers or formulas with its values at all states: what answers of the kinds
// number, vector, formula and formulas are compared with.

#include "grade/parts/part.h"
#include "grade/parts/unit_text.h"

#include <stdbool.h>

enum { HN_VALUE_ENTRIES = HN_PART_RESULTS };

/// Entries of an answer with their values at all states. An entry that an answer leaves out (null
/// in a fault) is that of the reference.
typedef struct hn_values {
    int n, columns; ///< columns 0: no matrix
    hn_ex e[HN_VALUE_ENTRIES];
    double x[HN_VALUE_ENTRIES][HN_DRAW_STATES];
} hn_values;

/// An answer being graded.
typedef struct hn_value_sheet {
    const hn_part *p;
    hn_draw *draw;
    hn_diag *diag;
    hn_values reference;
    double allowed[HN_VALUE_ENTRIES];
    int symbolic; ///< formulas are asked for, not numbers
    hn_unit unit;
} hn_value_sheet;

/// 1 for the kinds formula and formulas.
int hn_value_is_symbolic(const hn_part *p);
/// The largest difference between the values of "answer" and of "second" over the states, as a
/// share of the value, or of 1 where that is smaller; NaN: the kind of the part has no "second", or
/// a form cannot be evaluated.
double hn_value_worst_difference(const hn_part *p);
/// Returns the difference that a tolerance allows in an entry, of a matrix or of a part: the larger
/// of `absolute` and `relative` times `size`, the entry's largest value over the states.
double hn_value_allowed(double relative, double absolute, double size);
/// Reads the tolerance of a part; what it leaves out has the values of the part's kind.
void hn_value_tolerance(const hn_part *p, double *relative, double *absolute);
/// The states and the reference. hn_draw_reset(s->draw) and free afterwards in any case.
/// Fails: HN_ERR_INPUT (the exercise is at fault), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_value_open(hn_value_sheet *s, const hn_part *p, hn_draw *draw,
                                      hn_diag *diag);
/// The entries of an answer: one, a list, or a list of rows. Returns how many, -1 if too many.
int hn_value_flatten(const cJSON *node, const cJSON *list[HN_VALUE_ENTRIES], int *columns);
/// Reads formulas of the exercise itself; `base` (may be NULL) stands in for null entries.
/// Fails: HN_ERR_INPUT, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_value_read(hn_value_sheet *s, const cJSON *node, const hn_values *base,
                                      hn_values *out);
/// Returns whether counts are asked for: numbers without a unit that are whole in this variant.
/// False where the sheet has no reference.
bool hn_value_is_count(const hn_value_sheet *s);
/// 1 when the values are those of entry k, within its tolerance, at all states.
int hn_value_is_right(const hn_value_sheet *s, int k, const double *given);
#endif
