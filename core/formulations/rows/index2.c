#include "formulations/ground/registry.h"

// q' = G v,   M v' = f + J' lambda,   J v + phi_t = 0: the rows of the loop differentiated once.
const hn_formulation hn_formulation_index2 = {
    .name = "index2",
    .title = "index 2, the loop at speed level",
    .short_name = "index-2",
    .rule = "Ask that the loop keeps closing at speed level, nothing more. The speed gap stays at "
            "rounding; the loop gap grows with what integration of the speeds leaves.",
    .traits = HN_TRAIT_CLOSES_VELOCITY,
    .drift = "speed gap at rounding, loop gap grows like h^p t",
    .when = "stiff scenes where the gap may open a little; implicit midpoint, which needs one "
            "evaluation a step",
    .when_not = "long runs at loose tolerances: the gap opens without bound; ggl closes it",
    .source =
        "Brenan, Campbell & Petzold 1996; Hairer & Wanner 1996, VII.1; Hairer, Lubich & Roche 1989",
    .needs = "M f J and derivatives",
    .order_note = "radau5: q 5, v 5, its own multipliers 3; midpoint: 2, 2, 1; Gauss methods "
                  "lose theirs (2 and 4, for 4 and 6) and do not serve it",
    .limits = "redundant rows contradict each other once the gap is open: there the position is "
              "projected after each step (close=0); with close=-1 the run ends or goes astray",
    .form = HN_FORM_INDEX2,
    .index = 2,
    .n_settings = 1,
    .settings = {{"close", 0, -1, 1e6, "steps",
                  "the position is projected every so many steps; 0: after each step where rows "
                  "depend on each other, else never; -1: never (ida: always never)",
                  NULL, 0, 0}},
};
