// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_FILLED_PARTS_H
#define HN_CLASS_FILLED_PARTS_H
// The parts that a student filled in, beside the right ones: what each is worth, and what is wrong
// with it.

#include "class/filled_program.h"
#include "export/language.h"

#define HN_FILLED_POINTS 2.0 ///< of a part

/// Answers of a program: for each state all parts behind each other.
typedef struct hn_filled_answers {
    int n; ///< numbers a state
    double *value;
} hn_filled_answers;

/// Returns whether a part is not zero everywhere: else nothing is to be filled in.
bool hn_filled_part_is_asked(const hn_export_exam *exam, hn_export_part part);
/// Fills the entries of a verdict, its score and its summary. Entries are named as the language
/// counts. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_filled_parts_compare(const hn_filled_exam *f,
                                                const hn_language *language,
                                                const hn_filled_answers *given, hn_verdict *v);

#endif
