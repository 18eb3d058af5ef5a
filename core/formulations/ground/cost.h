// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_COST_H
#define HN_FORMULATIONS_COST_H
// Work and events of a formulation or an integrator, summed over a run: plain counters, reset by
// the run.

typedef struct hn_cost {
    long long evals; ///< right-hand sides
    long long factorisations, solves, newton;
    double ops;            ///< arithmetic operations, tape plus linear algebra
    long long fallbacks;   ///< dense solves in place of the tape's
    long long refinements; ///< solutions of the tape that were corrected because pivots were small
    long long projections;
    double energy_removed; ///< by projection [J]
    long long chart_changes;
    long long rejected; ///< trial steps rejected by an integrator with a step control of its own
    double elsewhere;   ///< computing time of other processes that were asked [s]
} hn_cost;

/// sum += part, field by field.
void hn_cost_add(hn_cost *sum, const hn_cost *part);
/// Returns the difference of two readings: after - before.
hn_cost hn_cost_between(const hn_cost *before, const hn_cost *after);

/// Returns `ops` for a document; NaN where right-hand sides were computed outside of this program,
/// which counts nothing of them.
double hn_cost_known_ops(const hn_cost *cost);

#endif
