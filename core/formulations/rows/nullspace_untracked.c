// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/orthonormal_state.h"
#include "formulations/ground/formulation.h"

// v = N u with an orthonormal N from a factorisation of J at each right-hand side. J N = 0 leaves N
// free up to a rotation, and the factorisation chooses: when it changes its mind, a column changes
// its sign (or turns) from one evaluation to the next, u does not, and so v does. The loop stays
// closed. An exhibit; nullspace:basis=orthonormal is the same with the basis carried.

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    (void)options;
    hn_orthonormal_state *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = s;
    return hn_orthonormal_init(s, sys, 0, arena, diag);
}

const hn_formulation hn_formulation_nullspace_untracked = {
    .name = "nullspace-untracked",
    .title = "null-space, basis not tracked",
    .short_name = "untracked",
    .rule = "Compute a new orthonormal basis of the free velocities at every evaluation. "
            "The factorisation may flip a column's sign at any time; the velocity along "
            "that column then reverses.",
    .drift = "none in the gap; after the basis first changes its sign the motion is wrong by "
             "radians",
    .when = "to see why a basis must follow the motion continuously",
    .when_not = "any result that matters: use nullspace:basis=orthonormal, whose basis follows "
                "the motion",
    .source = "Kim & Vanderploeg 1986; the remedy: Liang & Lance 1987",
    .needs = "M f phi J gamma",
    .order_note = "none: the basis jumps",
    .model_error = true,
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY | HN_TRAIT_HAS_BASIS |
              HN_TRAIT_COUNTER_EXAMPLE,
    .create = create,
    .destroy = hn_orthonormal_destroy,
    .ode = hn_orthonormal_ode,
    .set_state = hn_orthonormal_set_state,
    .get_state = hn_orthonormal_get_state,
    .after_step = hn_orthonormal_after_step,
    .add_cost = hn_orthonormal_add_cost,
    .why = hn_orthonormal_why,
};
