// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/formulation.h"

// q' = G (v + M^-1 J' mu),   M v' = f + J' lambda,   phi = 0,   J v + phi_t = 0
// (1)
//
// The exact solution has mu = 0. M^-1 in front of mu is free of units; the paper's own form has the
// identity there.
const hn_formulation hn_formulation_ggl = {
    .name = "ggl",
    .title = "Gear-Gupta-Leimkuhler, stabilised index 2",
    .short_name = "GGL",
    .rule = "Require the constraints and their time derivative at once; a second "
            "multiplier, zero in the exact motion, makes room for the extra equations. "
            "Nothing drifts.",
    .drift = "none at the ends of steps: gap and velocity violation are at rounding level there; "
             "between them the motion is interpolated to the tolerance",
    .when = "stiff springs and dampers, long runs, tight tolerances; the first choice "
            "among implicit methods",
    .when_not = "short runs without stiffness: an explicit method with projection costs less; "
                "massless links: its equations contain the inverse of M (use index2 or index3)",
    .source =
        "Gear, Leimkuhler & Gupta 1985; Fuehrer & Leimkuhler 1991; Hairer & Wanner 1996, VII.2",
    .needs = "M f phi J and derivatives",
    .order_note = "q and v as the integrator; its own multipliers lower (radau5: 3)",
    .form = HN_FORM_GGL,
    .index = 2,
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY | HN_TRAIT_NEEDS_MASS_INVERSE,
};
