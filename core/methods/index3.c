#include "methods/registry.h"

// q' = G v,   M v' = f + J' lambda,   phi = 0: the loop as it is.
const hn_formulation hn_formulation_index3 = {
    .name = "index3",
    .title = "index 3, the loop as it is",
    .short_name = "index-3",
    .rule = "Ask that the loop is closed at the end of the step, nothing else. The gap stays at "
            "rounding; speeds and multipliers pay for it with orders.",
    .drift = "loop gap at rounding, speed gap of the order of the speeds",
    .when = "to see what the index costs; implicit Euler for robust first-order runs",
    .when_not = "accurate speeds or reactions, variable steps at tight tolerances: take ggl",
    .source =
        "Hairer, Lubich & Roche 1989; Hairer & Wanner 1996, VII; Bottasso, Dopico & Trainelli 2008",
    .needs = "M f phi J and derivatives",
    .order_note = "radau5: q 5, v 3, its own multipliers 2; implicit Euler: 1, 1, 1",
    .limits = "Gauss methods do not converge on it",
    .form = HN_FORM_INDEX3,
    .index = 3,
    .keeps_gap = 1,
};
