// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_CONTENTS_H
#define HN_GRADE_CONTENTS_H
// Contents of an exercise as hashes: with them a later program can say what has changed in it
// since a verdict was written. A verdict holds them as
//
//     "contents": {"statement": "1f0c...", "numbers": "77ab...", "parts": {"a": "09d1...", ...}}
//
// and, of a matrix of formulas, "equations" and "judging" in place of the parts.

#include "base/strbuf.h"
#include "grade/parts/part.h"

enum { HN_CONTENTS_PARTS = 12 };

/// Hashes of an exercise as its file says it: before a rubric changes points.
typedef struct hn_contents {
    uint64_t statement; ///< with the title
    uint64_t numbers;   ///< how the numbers are drawn
    uint64_t part[HN_CONTENTS_PARTS];
    int n_parts;        ///< 0: a matrix of formulas
    uint64_t equations; ///< of a matrix: the constraints and what is asked
    uint64_t judging;   ///< of a matrix: its tolerance and the shares of mistakes
} hn_contents;

/// Takes the hashes from the exercise's file.
void hn_contents_read(hn_contents *c, const cJSON *root);
/// Writes them as a member of the open object. parts: those of the exercise, for their names.
void hn_contents_put(hn_strbuf *b, const hn_contents *c, const hn_part *parts);
/// Names what differs from the hashes of a verdict: "its statement, part a, part d (gone)". Nothing
/// where the verdict has none.
void hn_contents_put_changes(hn_strbuf *b, const hn_contents *c, const hn_part *parts,
                             const cJSON *old);
#endif
