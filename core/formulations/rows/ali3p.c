// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/formulation.h"

// M a - f + J' lambda* = 0 with lambda* := lambda* + w phi until phi = 0; then speeds and
// accelerations are projected with the matrix of that iteration (integrators/trapezoidal.c).

static const char *const projections[] = {[HN_PROJECTIONS_ON] = "on", [HN_PROJECTIONS_OFF] = "off"};

const hn_formulation hn_formulation_ali3p = {
    .name = "ali3p",
    .title = "index-3 augmented Lagrangian with projections",
    .short_name = "ALI3-P",
    .rule = "Hold the loops with a strong spring, add the spring's force to the loop force "
            "and repeat until the gap is closed; then project velocities and accelerations "
            "onto the constraints.",
    .drift = "none in the gap; a velocity violation of about 1 / weight remains",
    .when = "redundant constraints, motions through singular configurations, real time at "
            "a fixed step",
    .when_not = "more accuracy than order 2 gives; energy studies: each projection removes a "
                "little energy",
    .source = "Bayo & Ledesma 1996; Cuadrado, Cardenal & Bayo 1997; Dopico et al. 2014",
    .needs = "M f phi J gamma and derivatives",
    .order_note = "2 in q, v and recomputed lambda",
    .limits = "with projections=off its multipliers and velocities are unstable (kept as a "
              "counter-example)",
    .form = HN_FORM_AUGMENTED,
    .index = 3,
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY,
    .n_options = HN_AUGMENTED_OPTIONS,
    .options =
        {
            [HN_AUGMENTED_WEIGHT] =
                {.key = "weight",
                 .max = 1e18,
                 .about = "penalty weight; 0: chosen so that each iteration shrinks the gap a "
                          "thousandfold"},
            [HN_AUGMENTED_PROJECTIONS] =
                {.key = "projections",
                 .max = 1,
                 .about = "project velocities and accelerations after each step",
                 .choices = projections,
                 .n_choices = 2},
        },
};
