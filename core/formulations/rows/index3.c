// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/formulation.h"

static const char *const projects[] = {"no", "yes"};

// q' = G v,   M v' = f + J' lambda,   phi = 0: the loop as it is. What a collocation method loses
// of the speeds lies across the loops (in M^-1 J'), so that a projection at the end of a step gives
// back the order that positions have.
const hn_formulation hn_formulation_index3 = {
    .name = "index3",
    .title = "index 3, position constraints",
    .short_name = "index-3",
    .rule = "Require closed loops at the end of each step, and nothing else. The gap stays "
            "at rounding level; velocities and multipliers converge with a lower order.",
    .drift = "gap at rounding level; the velocity violation has the order of the velocities",
    .when = "to see what the index costs; implicit Euler for robust first-order runs",
    .when_not = "accurate velocities or reactions, variable steps at tight tolerances: use ggl",
    .source =
        "Hairer, Lubich & Roche 1989; Hairer & Wanner 1996, VII; Bottasso, Dopico & Trainelli 2008",
    .needs = "M f phi J and derivatives",
    .order_note = "radau5: q 5, v 3, its own multipliers 2, with project=yes 5 in q, v and "
                  "recomputed lambda; implicit Euler: 1, 1, 1",
    .limits = "Gauss methods do not converge on it",
    .form = HN_FORM_INDEX3,
    .index = 3,
    .traits = HN_TRAIT_CLOSES_POSITION,
    .n_options = HN_INDEX3_OPTIONS,
    .options =
        {
            [HN_INDEX3_PROJECT] =
                {.key = "project",
                 .max = 1,
                 .about =
                     "project the velocities onto the constraints at the end of each step; radau5, "
                     "radau3 and implicit-euler only",
                 .choices = projects,
                 .n_choices = 2},
        },
};
