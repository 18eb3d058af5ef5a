#include "formulations/ground/penalised.h"
#include "formulations/ground/registry.h"

#include <string.h>

// (M + a J' J) acc = f - a J' (gamma + 2 xi omega (J v + phi_t) + omega^2 phi)                       (1)
//
// Mass, damping and stiffness of the loop are penalised together, so the gap's own motion has the rates of (xi, omega)
// whatever a is: (1) is not stiff in time. A loop that carries the force lambda stays open by |lambda| / (a omega^2).

static hn_status accelerate(void *self, double t, const double *v, double *acc) {
    hn_penalised *p = self;
    hn_dense_ode_pull(&p->ode, v, p->omega, p->xi, p->pull);
    const hn_status status = hn_penalised_factor(p, t, p->a);
    if (status != HN_OK) {
        return status;
    }
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

static hn_status create(const hn_system *sys, const double *settings, hn_arena *arena, void **self,
                        hn_diag *diag) {
    hn_penalised *p = hn_arena_get(arena, sizeof *p);
    if (!p) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = p;
    p->ode.accelerate = accelerate;
    p->ode.base.law = law;
    return hn_penalised_init(p, sys, settings, arena, diag);
}

const hn_formulation hn_formulation_penalty = {
    .name = "penalty",
    .title = "penalty",
    .short_name = "penalty",
    .rule =
        "Replace the closed loop by a very strong spring, damper and mass acting on the gap. The "
        "stronger they are, the nearer the motion comes to the true one, until rounding wins.",
    .traits = HN_TRAIT_PULLS_GAP | HN_TRAIT_ADDS_VIBRATIONS,
    .drift = "bounded: the gap follows the loop force, |lambda| / (a omega^2), whatever the step",
    .when = "redundant rows, massless links, joints that do give",
    .when_not = "more than a few digits: the error falls only as 1 / a, and a beyond 1e10 meets "
                "rounding; poses where the loop loses rank; omega h beyond the integrator's "
                "stability limit",
    .source = "Bayo, Garcia de Jalon & Serna 1988",
    .needs = "M f phi J gamma",
    .model_error = 1,
    .n_settings = 3,
    .settings =
        {
            {"a", 1e7, 1e-3, 1e15, "", "weight of the gap against the masses", NULL, 0, 0},
            {"omega", 10, 0, 1e6, "1/s", "natural rate of the gap", NULL, 0, 0},
            {"xi", 1, 0, 100, "", "damping of the gap; 1: critical", NULL, 0, 0},
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
