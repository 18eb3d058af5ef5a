// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REACTIONS_JSON_H
#define HN_SESSION_REACTIONS_JSON_H
// Reactions of joints and constraints, as JSON. A reaction is a force [N] and a moment [N m] about
// its place, in world axes. It acts on the child of a joint, on the body of a distance's second
// point, or on a body that is guided (dynamics/reactions/reactions.h). Reactions of joints are also
// given in the joint's axes (ref, axis x ref, axis). Efforts are generalised forces along
// coordinates: of constraints on coordinates, and of energies given as formulas. A scene given by
// formulas has efforts only.

#include "session/model/model.h"

#include <stdbool.h>

typedef struct hn_reaction_writer hn_reaction_writer;

/// Creates a writer. Plain memory comes from `arena`; hn_reaction_writer_free() releases the rest.
/// Errors are reported in diags under "/reactions".
HN_MUST_CHECK hn_status hn_reaction_writer_create(const hn_model *model, hn_arena *arena,
                                                  hn_reaction_writer **out, hn_diags *diags);
void hn_reaction_writer_free(hn_reaction_writer *w); ///< NULL is legal
int hn_reaction_writer_count(
    const hn_reaction_writer *w); ///< joints, then constraints that act at a place
int hn_reaction_writer_efforts(const hn_reaction_writer *w); ///< how many efforts
/// Computes reactions and efforts at a state in system coordinates. Returns the status of the
/// accelerations or of the balance; after a failure the writer has nothing to write.
HN_MUST_CHECK hn_status hn_reaction_writer_eval(hn_reaction_writer *w, double t, const double *q,
                                                const double *v);
/// Copies the results of the last state: 3 numbers per joint or constraint into `force` and
/// `moment`, one number per effort into `effort`.
void hn_reaction_writer_rows(const hn_reaction_writer *w, double *force, double *moment,
                             double *effort);
/// The force [N] and the place [m] of the i-th joint or constraint at the last state; returns its
/// name.
const char *hn_reaction_writer_force(const hn_reaction_writer *w, int i, double force[3],
                                     double place[3]);
/// Returns whether this force is the only possible one; false: redundant constraints share the load
/// in many ways, and the force is that of the least-norm multipliers.
bool hn_reaction_writer_is_determined(const hn_reaction_writer *w, int i);
/// The name of the body on which this force acts; "ground" for the ground.
const char *hn_reaction_writer_body(const hn_reaction_writer *w, int i);
/// Writes the results of the last state. "reactions": a list of
/// {"name","kind","on","force","moment","place","joint_force","joint_moment","determined"};
/// "efforts": a list of {"name","kind","coordinate","unit","value","determined"}.
void hn_reaction_writer_put(hn_strbuf *b, const hn_reaction_writer *w);
/// Writes "carriers": the names, joints first; and "efforts": a list of
/// {"name","kind","coordinate","unit"}.
void hn_reaction_writer_names(hn_strbuf *b, const hn_reaction_writer *w);
#endif
