#include "methods/registry.h"
#include "methods/tangent_state.h"

// (N' M N) u' + N' (M N' u + h) = N' Q    with the rate of the basis, N' u = [0; -J_d^-1 gamma] for the partition basis
// (the prime is a transpose to the left of M, a rate to its right).

static hn_status create(const hn_system *sys, const double *settings, hn_arena *arena, void **self,
                        hn_diag *diag) {
    (void)settings;
    hn_tangent_state *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = s;
    return hn_tangent_init(s, sys, 1, 0, arena, diag);
}

const hn_formulation hn_formulation_nullspace = {
    .name = "nullspace",
    .title = "null-space, full form",
    .short_name = "null-space",
    .rule = "Write the speeds as v = N u with J N = 0 and project the equations on N: the "
            "multipliers vanish. N turns "
            "with the mechanism, so its rate belongs in the equation.",
    .drift = "none: J v = 0 by construction, positions are closed after each step",
    .when = "any mechanism off its singular poses; multipliers not needed",
    .when_not = "poses where the rank of J drops: N changes its width there",
    .source = "Kim & Vanderploeg 1986; Liang & Lance 1987; Potra & Rheinboldt 1991",
    .needs = "M f phi J gamma",
    .keeps_gap = 1,
    .create = create,
    .destroy = hn_tangent_destroy,
    .ode = hn_tangent_ode,
    .set_state = hn_tangent_set_state,
    .get_state = hn_tangent_get_state,
    .after_step = hn_tangent_after_step,
    .add_cost = hn_tangent_add_cost,
    .why = hn_tangent_why,
};
