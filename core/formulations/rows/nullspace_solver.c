// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/accel.h"
#include "formulations/ground/accel_ode.h"
#include "formulations/ground/formulation.h"

// J N = 0:  a = N z + c,  (N' M N) z = N' (f - M c),  c = -J^+ gamma, at the state (q, v) as it
// stands.        (1)
//
// N is an orthonormal basis by pivoted QR, found anew each time (linalg/saddle.h). It may turn or
// change sign from one evaluation to the next: only a is used, which no choice of N changes. The
// same as index1 with its solver set to least-norm, under the name that textbooks give it.

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    (void)options;
    hn_accel_ode *ode = hn_arena_get(arena, sizeof *ode);
    if (!ode) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = ode;
    return hn_accel_ode_init(ode, sys, 0, HN_SOLVER_LEAST_NORM, arena, diag);
}

const hn_formulation hn_formulation_nullspace_solver = {
    .name = "nullspace-solver",
    .title = "null space as a linear solver",
    .short_name = "NS solver",
    .rule = "Use the null space of J only as a linear solver for the accelerations; "
            "positions and velocities stay free. The multipliers are gone, but the gap "
            "drifts exactly as with index-1.",
    .drift = "as index-1: the gap grows like t^2, the velocity violation like t",
    .when = "to see that eliminating multipliers does not remove drift; redundant "
            "constraints",
    .when_not = "long runs; large mechanisms (dense algebra)",
    .source = "Kim & Vanderploeg 1986; Potra & Rheinboldt 1991",
    .needs = "M f J gamma",
    .index = 1,
    .traits = HN_TRAIT_HAS_BASIS,
    .create = create,
    .destroy = hn_accel_ode_destroy,
    .ode = hn_accel_ode_get,
    .set_state = hn_state_ode_set_state,
    .get_state = hn_state_ode_get_state,
    .add_cost = hn_accel_ode_add_cost,
    .why = hn_state_ode_why,
};
