// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_JOINT_FORCES_H
#define HN_TUI_JOINT_FORCES_H
// Multipliers and joint forces at one state of a mechanism, computed on the thread of the viewer:
// the recording has a model of its own.

#include "dynamics/evaluate/accel.h"
#include "session/model/reactions_json.h"

#include <cjson/cJSON.h>

typedef struct hn_joint_forces {
    hn_model *model; ///< owned
    hn_arena *arena; ///< owned
    hn_accel *accel;
    hn_reaction_writer *writer;
    double *q, *v, *a; ///< the state in system coordinates, its accelerations
    const double *at;  ///< the coordinates that were given last; NULL: none yet

    int first;      ///< line of the view that is shown first
    double longest; ///< [N] what the longest arrow stands for; 0: none drawn yet

    // of that state
    hn_status status; ///< HN_OK, or why there are no forces
    double *lambda;   ///< nc
    hn_multiplier_mark mark;
    cJSON *document; ///< owned: {"reactions", "efforts"} (session/model/reactions_json.h)
} hn_joint_forces;

/// Loads the scene once more. Returns owned in *out. Fails: as hn_model_load(), or without a
/// sentence in diags where memory is out.
HN_MUST_CHECK hn_status hn_joint_forces_create(const hn_library *library,
                                               const hn_model_source *source, hn_joint_forces **out,
                                               hn_diags *diags);
void hn_joint_forces_free(hn_joint_forces *f); ///< NULL is legal
/// Computes everything at a state.
///
/// q, v  in  (n_user) coordinates and rates as in the scene; the same q as at the last call: the
///           results of that call stay
/// gap   in  [m] of the loops: from HN_RUN_WARN_GAP on the mark says that a loop is open
void hn_joint_forces_calc(hn_joint_forces *f, double t, const double *q, const double *v,
                          double gap);
#endif
