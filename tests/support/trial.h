// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_TRIAL_H
#define HN_SUPPORT_TRIAL_H
// A scene file loaded, compiled and assembled, and runs on it, for tests of methods and runs. A
// failure on the way stops the test with its message.

#include "dynamics/assembly/assemble.h"
#include "study/run/run.h"

typedef struct hn_trial {
    hn_scene *scene;
    hn_system *sys;
    hn_system_info info;
    double q[64], v[64]; ///< assembled, system coordinates
} hn_trial;

#define HN_TRIAL_LESSON "lessons/01-closed-loops/scenes/"

void hn_trial_open(hn_trial *trial, const char *path);
/// The same with changed parameters.
void hn_trial_open_with(hn_trial *trial, const char *path, const hn_setting *settings, int n);
/// From JSON text.
void hn_trial_open_text(hn_trial *trial, const char *json);
void hn_trial_close(hn_trial *trial);
/// Opens the scene with its parameters at corners and edges of their ranges: each at its ends, and
/// ends drawn at random for all of them.
void hn_trial_try_ranges(const char *path);
/// The spec of a spelling that has to be right.
hn_method_spec hn_trial_spec(const char *spelling);
/// A fresh run from the assembled state.
hn_run *hn_trial_run(const hn_trial *trial, const char *spelling);
/// Index in a sample of a user coordinate, by its name or that of its rate.
int hn_trial_coordinate(const hn_trial *trial, const char *name);

/// Describes what books say of a scene's start.
typedef struct hn_trial_count {
    const char *scene; ///< a path
    int freedoms, rank, rows;
} hn_trial_count;
/// Opens each of n scenes and compares.
void hn_trial_check_counts(const hn_trial_count *known, size_t n);

#endif
