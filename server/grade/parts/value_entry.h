// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VALUE_ENTRY_H
#define HN_GRADE_VALUE_ENTRY_H
// One entry of an answer as the student wrote it: a number, a number with its unit, or a formula.

#include "grade/parts/value_sheet.h"

#include <stdbool.h>

/// Reads an entry. x receives its values at the states of s->draw, in the unit of the sheet. Of the
/// sheet p, draw, unit and symbolic are used. False: the entry is blank, cannot be read, or has
/// another unit; `r` then says so.
bool hn_value_entry_read(hn_value_sheet *s, const cJSON *node, double x[HN_DRAW_STATES], hn_ex *e,
                         hn_part_result *r);
/// Reads the formula before the unit that the text may end with, though the unit is the name of a
/// number too: "L*sin(th) m". False: the text ends with no unit.
bool hn_value_entry_read_before_unit(hn_value_sheet *s, const cJSON *node, double x[HN_DRAW_STATES],
                                     hn_ex *e, hn_part_result *r);
#endif
