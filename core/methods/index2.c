#include "methods/registry.h"

// q' = G v,   M v' = f + J' lambda,   J v + phi_t = 0: the rows of the loop differentiated once.
const hn_formulation hn_formulation_index2 = {
    .name = "index2",
    .title = "index 2, the loop at speed level",
    .short_name = "index-2",
    .rule = "Ask that the loop keeps closing at speed level, nothing more. The speed gap stays at "
            "rounding; the loop gap grows with what integration of the speeds leaves.",
    .drift = "speed gap at rounding, loop gap grows like h^p t",
    .when = "stiff scenes where the gap may open a little; implicit midpoint, which needs one "
            "evaluation a step",
    .when_not = "long runs at loose tolerances: the gap opens without bound; ggl closes it",
    .source =
        "Brenan, Campbell & Petzold 1996; Hairer & Wanner 1996, VII.1; Hairer, Lubich & Roche 1989",
    .needs = "M f J and derivatives",
    .order_note = "radau5: q 5, v 5, its own multipliers 3; midpoint: 2, 2, 1",
    .limits = "redundant rows: once the gap is open they contradict each other",
    .form = HN_FORM_INDEX2,
    .index = 2,
};
