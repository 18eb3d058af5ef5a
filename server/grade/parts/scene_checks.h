// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_SCENE_CHECKS_H
#define HN_GRADE_SCENE_CHECKS_H
// Properties of a mechanism with one degree of freedom, tested on its whole motion: the tests of
// the kind of answer "scene" (part_scene.c lists them).

#include "grade/parts/circuit.h"
#include "grade/parts/part_model.h"

#include <stdbool.h>

/// A mechanism under test.
typedef struct hn_scene_check {
    const hn_part *p;
    const hn_model *model;
    hn_draw draw; ///< the numbers of the variant, the parameters, then the coordinates
    int n_coordinates;
    bool walked;
    hn_circuit circuit;
    double *path; ///< owned: coordinates of every configuration, n a step
    int n_path, cap;
    double *points; ///< owned: drawn points of every configuration
    int n_points;
    bool failed; ///< no memory for the path
} hn_scene_check;

/// Makes the names of the formulas. hn_scene_check_close() in any case.
/// Fails: HN_ERR_INPUT (the exercise is at fault), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_scene_check_open(hn_scene_check *c, const hn_setting *settings, int n,
                                            hn_diag *diag);
void hn_scene_check_close(hn_scene_check *c);
/// Writes the curve of a test "curve", and a cross at each point that it should pass, as lines for
/// a picture. Nothing for other tests, and where the motion cannot be followed.
void hn_scene_check_draw(hn_scene_check *c, const cJSON *node, hn_part_view *out);
/// Runs one test; `r` becomes wrong where it fails. Fails: HN_ERR_INPUT (the exercise is at fault),
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_scene_check_run(hn_scene_check *c, const cJSON *node, hn_part_result *r,
                                           hn_diag *diag);
#endif
