// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_MODEL_H
#define HN_SUPPORT_MODEL_H
// A scene loaded, compiled and assembled, for tests of dynamics and above. Failures stop the test
// with their message.

#include "dynamics/assembly/assemble.h"
#include "dynamics/compile/system.h"
#include "scene/scene.h"

typedef struct hn_model {
    hn_scene *scene;
    hn_system *sys;
    hn_system_info info;
    hn_arena *arena;
    hn_diags diags;
    double *q, *v, *a, *lambda; ///< assembled, system coordinates
    double *user_q, *user_v;    ///< the same, user coordinates
    hn_assembly assembly;
    hn_status status; ///< of the assembly
} hn_model;

/// Scenes of the lessons ("fb0"), of the tests ("fb0-redundant") and of published problems
/// ("andrews"), by name. `settings` is NULL or "l1=1.2 m2=3". The assembly may fail: see status.
void hn_model_begin(hn_model *m, const char *name, const char *settings);
/// From JSON text.
void hn_model_open_text(hn_model *m, const char *json, const char *settings);
/// The same, and the assembly has to succeed.
void hn_model_open_closed(hn_model *m, const char *name, const char *settings);
void hn_model_close(hn_model *m);
/// Index of a user coordinate by name; the test fails if there is none.
int hn_model_user(const hn_model *m, const char *name);

#endif
