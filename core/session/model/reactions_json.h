// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REACTIONS_JSON_H
#define HN_SESSION_REACTIONS_JSON_H
// What joints and constraints carry, as JSON: force [N] and moment [N m] in world axes on a joint's
// child (on the body of a constraint's first point) about its place, and for joints the same in the
// joint's own axes (ref, axis x ref, axis). Beside them efforts: what constraints on coordinates,
// and energies given as formulas, do along coordinates. A scene of formulas has only these.

#include "session/model/model.h"

typedef struct hn_reaction_writer hn_reaction_writer;

/// Memory from `arena`; hn_reaction_writer_free() for the rest. What fails is told under
/// /reactions.
HN_MUST_CHECK hn_status hn_reaction_writer_create(const hn_model *model, hn_arena *arena,
                                                  hn_reaction_writer **out, hn_diags *diags);
void hn_reaction_writer_free(hn_reaction_writer *w); ///< NULL is legal
int hn_reaction_writer_count(
    const hn_reaction_writer *w); ///< joints, then constraints that act at a place
int hn_reaction_writer_efforts(const hn_reaction_writer *w); ///< how many efforts
/// Works them out at a state in system coordinates. The status of the accelerations or of the
/// balance; nothing is left to write then.
HN_MUST_CHECK hn_status hn_reaction_writer_eval(hn_reaction_writer *w, double t, const double *q,
                                                const double *v);
/// Of the last state: 3 numbers for each joint and constraint in turn, and one for each effort.
void hn_reaction_writer_rows(const hn_reaction_writer *w, double *force, double *moment,
                             double *effort);
/// Keys "reactions": the last state's list of
/// {"name","kind","force","moment","place","joint_force","joint_moment","determined"}, and
/// "efforts": of {"name","kind","coordinate","unit","value","determined"}.
void hn_reaction_writer_put(hn_strbuf *b, const hn_reaction_writer *w);
/// Keys "carriers": the names, joints first, and "efforts": {"name","kind","coordinate","unit"} of
/// each.
void hn_reaction_writer_names(hn_strbuf *b, const hn_reaction_writer *w);
#endif
