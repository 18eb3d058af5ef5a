// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/accel.h"
#include "formulations/ground/accel_ode.h"
#include "formulations/ground/formulation.h"

enum { OPT_SOLVER, N_OPTIONS };

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    hn_accel_ode *ode = hn_arena_get(arena, sizeof *ode);
    if (!ode) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = ode;
    return hn_accel_ode_init(ode, sys, 0, (hn_solver)options[OPT_SOLVER], arena, diag);
}

static bool lanes(const double *options, hn_accel_opts *accel, double *alpha, double *beta) {
    *accel = (hn_accel_opts){.solver = (hn_solver)options[OPT_SOLVER]};
    *alpha = *beta = 0;
    return true;
}

const hn_formulation hn_formulation_index1 = {
    .name = "index1",
    .title = "index-1, not stabilised",
    .short_name = "index-1",
    .rule = "Require zero acceleration of the gap and integrate twice. Nothing corrects "
            "truncation and rounding errors, so the gap grows.",
    .drift = "the velocity violation grows like h^p t, the gap like h^p t^2; an "
             "inconsistent start is never corrected",
    .when = "short runs, small steps; the baseline for all other methods; the cheapest "
            "right-hand side",
    .when_not = "long runs: the loop opens and in the end the solution blows up",
    .source = "Brenan, Campbell & Petzold 1996; Ascher & Petzold 1998, ch. 9",
    .needs = "M f J gamma",
    .alternative_form = HN_FORM_INDEX1,
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_SOLVER] = HN_ACCEL_ODE_SOLVER_OPTION,
        },
    .index = 1,
    .create = create,
    .destroy = hn_accel_ode_destroy,
    .ode = hn_accel_ode_get,
    .set_state = hn_state_ode_set_state,
    .get_state = hn_state_ode_get_state,
    .after_step = hn_state_ode_after_step,
    .lanes = lanes,
    .add_cost = hn_accel_ode_add_cost,
    .fallbacks = hn_accel_ode_fallbacks,
    .why = hn_state_ode_why,
};
