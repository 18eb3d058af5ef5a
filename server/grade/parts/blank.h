// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_BLANK_H
#define HN_GRADE_BLANK_H
// Answers to fill in: the shape that a part asks for, with "" for a text and null for a number.

#include "grade/parts/part.h"

/// One text, owned.
cJSON *hn_blank_text(const hn_part *p);
/// One number, owned.
cJSON *hn_blank_number(const hn_part *p);
/// The shape of the exercise's own "answer", of texts or of numbers; owned.
cJSON *hn_blank_texts(const hn_part *p);
cJSON *hn_blank_numbers(const hn_part *p);
/// An object with a number for each name of "asked", "free" or "numbers", and a list for each one
/// of "given"; owned.
cJSON *hn_blank_names(const hn_part *p);
/// Returns whether nothing was filled in: null, a text of blanks, or a list or object of such.
bool hn_blank_is(const cJSON *given);
#endif
