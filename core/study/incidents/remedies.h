// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_REMEDIES_H
#define HN_STUDY_REMEDIES_H
// Remedies: another formulation, chosen by its traits and never by its name, or another step. Each
// function writes one remedy for the run that is watched and returns false where it does not apply.

#include "study/incidents/watch.h"

/// The same method with its step or tolerance times `factor`.
bool hn_remedy_finer(const hn_watch *w, double factor, hn_remedy out);
/// A formulation that closes the loops after every step without a chart; not where the run has it
/// already.
bool hn_remedy_close(const hn_watch *w, double factor, hn_remedy out);
/// A remedy for singular configurations: a formulation that passes through them, with a fixed step
/// like the present one.
bool hn_remedy_robust(const hn_watch *w, double factor, hn_remedy out);
/// The same, only where the run is close to a singular configuration.
bool hn_remedy_robust_near(const hn_watch *w, double factor, hn_remedy out);
/// Feedback on the gap, for a formulation that does nothing about it: critically damped, at the
/// rate factor / h where the step is fixed.
bool hn_remedy_feedback(const hn_watch *w, double factor, hn_remedy out);
/// The right formulation beside one that is a counter-example or converges to another model.
bool hn_remedy_right_model(const hn_watch *w, double factor, hn_remedy out);
/// A formulation that changes its chart by itself; where no choice of coordinates serves, one
/// without a chart.
bool hn_remedy_other_chart(const hn_watch *w, double factor, hn_remedy out);
/// A formulation that leaves the loops alone, where closing them failed.
bool hn_remedy_plain(const hn_watch *w, double factor, hn_remedy out);
/// A formulation or a solver that never forms the inverse of M.
bool hn_remedy_singular_mass(const hn_watch *w, double factor, hn_remedy out);
/// Slower feedback that the step can follow; a step that can follow the feedback.
bool hn_remedy_slower_feedback(const hn_watch *w, double factor, hn_remedy out);
bool hn_remedy_step_for_feedback(const hn_watch *w, double factor, hn_remedy out);
/// The same method with this share of the run as its step.
bool hn_remedy_step_of_run(const hn_watch *w, double factor, hn_remedy out);
/// Implicit methods for stiff scenes: with closed loops, in the present formulation, with steps of
/// any order.
bool hn_remedy_stiff_closed(const hn_watch *w, double factor, hn_remedy out);
bool hn_remedy_stiff_same(const hn_watch *w, double factor, hn_remedy out);
bool hn_remedy_stiff_multistep(const hn_watch *w, double factor, hn_remedy out);
/// A one-step integrator in place of a multistep one; feedback instead of a correction after each
/// step.
bool hn_remedy_one_step(const hn_watch *w, double factor, hn_remedy out);
bool hn_remedy_uncorrected(const hn_watch *w, double factor, hn_remedy out);

/// The fastest rate at which the method itself pulls the gap to zero [1/s]; 0 where it does not.
double hn_pulling_rate(const hn_method_spec *spec);

#endif
