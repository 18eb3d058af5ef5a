// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_EXERCISE_SHELF_H
#define HN_GRADE_EXERCISE_SHELF_H
// The shipped problems, by id: for the command line and the HTTP interface alike.

#include "base/strbuf.h"
#include "grade/verdict.h"
#include "session/model/library.h"

enum { HN_GRADE_TIME_LIMIT = 60 }; ///< [s] for grading one submission of a class

/// Returns owned in *out. An unknown id: HN_ERR_INPUT with a near miss (pointer "/problem").
HN_MUST_CHECK hn_status hn_shelf_exercise_load(const hn_library *lib, const char *id,
                                               hn_exercise **out, hn_diags *diags);
/// {"problems":[{"id","title","scene","points","minutes","time_limit"}...]}: minutes that a student
/// takes, estimated, and seconds that grading may take. One that does not load stands there with
/// its "errors".
void hn_shelf_exercises_json(hn_strbuf *b, const hn_library *lib);
/// The scene of an exercise with the numbers of a variant (seed 0: the exercise's own): that of its
/// matrix in the first state, that of the first part with a scene, or that of its field "picture".
/// Names are borrowed from the exercise. Fails: HN_ERR_INPUT (there is no scene, or the exercise is
/// at fault), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_shelf_exercise_view(const hn_exercise *exercise, uint64_t seed,
                                               hn_part_view *out, hn_diag *diag);
/// The scene that the exercise's field "picture" names; "" where it has none.
const char *hn_shelf_picture_scene(const hn_exercise *exercise);
/// The picture of the state at which the first wrong entry shows, as PNG; HN_ERR_UNSUPPORTED when
/// the verdict has none.
HN_MUST_CHECK hn_status hn_shelf_verdict_png(hn_strbuf *png, const hn_library *lib,
                                             const hn_verdict *verdict, hn_diags *diags);
#endif
