// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/formulation.h"

// q' = G v,   M v' = f + J' lambda,   J v + phi_t = 0: the rows of the loop differentiated once.
const hn_formulation hn_formulation_index2 = {
    .name = "index2",
    .title = "index 2, velocity constraints",
    .short_name = "index-2",
    .rule = "Require the velocity constraints only. The velocity violation stays at "
            "rounding level; the gap grows with the integration error of the velocities.",
    .drift = "velocity violation at rounding level; the gap grows like h^p t",
    .when = "stiff scenes in which the gap may open a little; implicit midpoint, which "
            "needs one evaluation per step",
    .when_not = "long runs at loose tolerances: the gap opens without bound; ggl closes it",
    .source =
        "Brenan, Campbell & Petzold 1996; Hairer & Wanner 1996, VII.1; Hairer, Lubich & Roche 1989",
    .needs = "M f J and derivatives",
    .order_note = "radau5: q 5, v 5, its own multipliers 3; midpoint: 2, 2, 1; Gauss methods "
                  "would lose half their order (2 and 4 instead of 4 and 6) and are not offered",
    .limits = "redundant constraints contradict each other once the gap is open; with "
              "close=0 the position is then projected after each step, with close=-1 the run "
              "ends or leaves the motion",
    .form = HN_FORM_INDEX2,
    .index = 2,
    .traits = HN_TRAIT_CLOSES_VELOCITY,
    .n_options = HN_INDEX2_OPTIONS,
    .options =
        {
            [HN_INDEX2_CLOSE] =
                {.key = "close",
                 .min = -1,
                 .max = 1e6,
                 .unit = "steps",
                 .about =
                     "project the position every so many steps; 0: after each step where "
                     "constraints are redundant, otherwise never; -1: never (ida: always never)"},
        },
};
