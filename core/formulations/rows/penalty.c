// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/penalised.h"
#include "formulations/ground/formulation.h"

#include <string.h>

// (M + a J' J) acc = f - a J' (gamma + 2 xi omega (J v + phi_t) + omega^2 phi)
// (1)
//
// Mass, damping and stiffness of the loop are penalised together, so the gap's own motion has the
// rates of (xi, omega) whatever a is: (1) is not stiff in time. A loop that carries the force
// lambda stays open by |lambda| / (a omega^2).

static hn_status accelerate(void *self, double t, const double *v, double *acc) {
    hn_penalised *p = self;
    hn_dense_ode_pull(&p->ode, v, p->omega, p->xi, p->pull);
    HN_TRY(hn_penalised_factor(p, t, p->a));
    memcpy(acc, p->ode.f, (size_t)p->ode.base.nv * sizeof *acc);
    for (int k = 0; k < p->ode.base.nc; k++) {
        p->work[k] = -p->a * p->pull[k];
    }
    hn_dense_ode_add_rows(&p->ode, p->work, acc);
    hn_penalised_solve(p, acc);
    p->ode.base.cost.ops += 4.0 * p->ode.n_J;
    return HN_OK;
}

// lambda = -a (J acc + gamma + ...) gives (1) the form of accel_jacobian.h
static hn_accel_law law(const void *self) {
    const hn_penalised *p = self;
    return (hn_accel_law){p->xi * p->omega, p->omega, 1 / p->a};
}

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    hn_penalised *p = hn_arena_get(arena, sizeof *p);
    if (!p) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = p;
    p->ode.accelerate = accelerate;
    p->ode.base.law = law;
    return hn_penalised_init(p, sys, options, arena, diag);
}

const hn_formulation hn_formulation_penalty = {
    .name = "penalty",
    .title = "penalty",
    .short_name = "penalty",
    .rule = "Replace the closed loop by a very stiff spring, damper and mass acting on the "
            "gap. The stiffer they are, the closer the motion is to the true one, until "
            "rounding dominates.",
    .drift = "bounded: the gap follows the loop force, |lambda| / (a omega^2), at any step "
             "size",
    .when = "redundant constraints, massless links, joints with real compliance",
    .when_not = "more than a few digits: the error falls only as 1 / a, and rounding dominates "
                "for a above 1e10; singular configurations; omega h beyond the integrator's "
                "stability limit",
    .source = "Bayo, Garcia de Jalon & Serna 1988",
    .needs = "M f phi J gamma",
    .model_error = true,
    .traits = HN_TRAIT_PULLS_GAP | HN_TRAIT_ADDS_VIBRATIONS,
    .n_options = HN_PENALISED_OPTIONS,
    .options =
        {
            [HN_PENALISED_A] = {.key = "a",
                                .initial = 1e7,
                                .min = 1e-3,
                                .max = 1e15,
                                .about = "penalty weight relative to the masses"},
            [HN_PENALISED_OMEGA] = {.key = "omega",
                                    .initial = 10,
                                    .max = 1e6,
                                    .unit = "1/s",
                                    .about = "natural frequency of the gap"},
            [HN_PENALISED_XI] = {.key = "xi",
                                 .initial = 1,
                                 .max = 100,
                                 .about = "damping ratio of the gap; 1: critical"},
        },
    .create = create,
    .destroy = hn_dense_ode_destroy,
    .ode = hn_dense_ode_get,
    .set_state = hn_state_ode_set_state,
    .get_state = hn_state_ode_get_state,
    .after_step = hn_state_ode_after_step,
    .set = hn_penalised_set,
    .add_cost = hn_dense_ode_add_cost,
    .why = hn_state_ode_why,
};
