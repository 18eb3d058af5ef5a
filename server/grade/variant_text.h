// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VARIANT_TEXT_H
#define HN_GRADE_VARIANT_TEXT_H
// What a student reads of a variant: statement, parts and hints, as text and as JSON.

#include "grade/variant.h"

/// Writes the statement, the parts with their numbers, and the shape of a submission.
void hn_variant_text(hn_strbuf *b, hn_variant *x);
/// Writes how formulas are typed, a line for each kind of answer that has them.
void hn_variant_notation(hn_strbuf *b, const hn_variant *x);
/// Writes a hint of the exercise, from 1 to its n_hints, with the numbers of this variant.
void hn_variant_hint(hn_strbuf *b, hn_variant *x, int number);
/// Writes the variant as `problem --json` and the page get it: one object, solutions left out.
void hn_variant_json(hn_strbuf *b, hn_variant *x);

#endif
