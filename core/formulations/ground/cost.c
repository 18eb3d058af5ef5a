// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/cost.h"

#include <math.h>

void hn_cost_add(hn_cost *sum, const hn_cost *part) {
    sum->evals += part->evals;
    sum->factorisations += part->factorisations;
    sum->solves += part->solves;
    sum->newton += part->newton;
    sum->ops += part->ops;
    sum->fallbacks += part->fallbacks;
    sum->refinements += part->refinements;
    sum->projections += part->projections;
    sum->energy_removed += part->energy_removed;
    sum->chart_changes += part->chart_changes;
    sum->rejected += part->rejected;
    sum->elsewhere += part->elsewhere;
}

hn_cost hn_cost_between(const hn_cost *before, const hn_cost *after) {
    return (hn_cost){
        .evals = after->evals - before->evals,
        .factorisations = after->factorisations - before->factorisations,
        .solves = after->solves - before->solves,
        .newton = after->newton - before->newton,
        .ops = after->ops - before->ops,
        .fallbacks = after->fallbacks - before->fallbacks,
        .refinements = after->refinements - before->refinements,
        .projections = after->projections - before->projections,
        .energy_removed = after->energy_removed - before->energy_removed,
        .chart_changes = after->chart_changes - before->chart_changes,
        .rejected = after->rejected - before->rejected,
        .elsewhere = after->elsewhere - before->elsewhere,
    };
}

double hn_cost_known_ops(const hn_cost *cost) {
    return cost->evals > 0 && cost->ops == 0 ? (double)NAN : cost->ops;
}
