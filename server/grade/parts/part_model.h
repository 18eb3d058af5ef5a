// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_PART_MODEL_H
#define HN_GRADE_PART_MODEL_H
// The mechanism that a part of an exercise is about: a shipped scene with the numbers of the
// variant.
//
//     "scene": "four-bar", "set": ["l1", "l2"]          names of the draw and of the scene
//     "scene": "four-bar", "set": {"l1": "0.8*a"}       parameters, each with a formula of the draw

#include "grade/parts/part.h"
#include "session/model/model.h"
#include "study/run/run.h"

enum { HN_PART_SETTINGS = 24 };

/// The settings of "set"; their names are borrowed from the exercise. `n` receives how many.
/// Fails: HN_ERR_INPUT (the exercise is at fault), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_part_settings(const hn_part *p, hn_setting settings[HN_PART_SETTINGS],
                                         int *n, hn_diag *diag);
/// Loads and assembles the scene of the part with the settings of "set". Returns owned in *model.
/// Fails: HN_ERR_INPUT (the exercise is at fault), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_part_load_model(const hn_part *p, hn_model **model, hn_diag *diag);
/// Advances a run to the time t, as hn_run_advance() does. Fails: as that does, and HN_ERR_STOPPED
/// where the interrupt of the part ends it.
HN_MUST_CHECK hn_status hn_part_advance(const hn_part *p, hn_run *run, double t);
/// Writes "; it is ... with --set l1=0.5": how a student makes the same mechanism.
void hn_part_put_settings(hn_strbuf *b, const hn_part *p);
/// Index of a free coordinate of the scene among the user coordinates; -1 with the nearest name in
/// diag.
int hn_part_find_coordinate(const hn_model *model, const char *name, hn_diag *diag);
const hn_coordinate *hn_part_coordinate(const hn_model *model, int i);
#endif
