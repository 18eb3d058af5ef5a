// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_EXERCISE_TEXT_H
#define HN_GRADE_EXERCISE_TEXT_H
// An exercise of form 1 for those who solve it; see variant.h for form 2. Its formulas are the same
// for everybody; a variant has numbers of its own to try them on.

#include "grade/exercise.h"

/// The statement for a person: what is given, what is asked, a closed state of this variant with a
/// velocity v of J v = 0, and how to hand in. seed 0: the exercise's own variant; `student`: whose
/// it is, NULL: nobody's.
void hn_exercise_text(hn_strbuf *b, const hn_exercise *problem, uint64_t seed, const char *student);
/// Writes what an exercise is called and where it stands, as members of the open object: "id",
/// "title", "lesson", "section", "scene".
void hn_exercise_put_names(hn_strbuf *b, const hn_exercise *problem);
/// Writes the member "ranges": for each name, but the hidden ones, how its number is drawn.
void hn_exercise_put_ranges(hn_strbuf *b, const hn_exercise *problem);
/// Writes between which values each number is drawn: "l1 0.4 to 0.9 m; n 6, 8 or 10", with `head`
/// before and `tail` behind it. Nothing where no number is drawn; hidden names and those that
/// follow from others are left out.
void hn_exercise_put_drawn(hn_strbuf *b, const hn_exercise *problem, const char *head,
                           const char *tail);
/// {"id","title","statement","points","entries":[..],"seed","numbers":{..},"velocity":{..},
/// "submission":".."}. The submission begins with the seed, or with the student, of the variant;
/// with neither where seed is 0 and student NULL.
void hn_exercise_json(hn_strbuf *b, const hn_exercise *problem, uint64_t seed, const char *student);
#endif
