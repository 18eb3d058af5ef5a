// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/formulation.h"
#include "formulations/ground/penalised.h"

#include <string.h>

// (M + a J' J) acc = f - a J' (gamma + 2 xi omega (J v + phi_t) + omega^2 phi)             (1)
//
// Mass, damping and stiffness of the loop are penalised together, so the gap's own motion has the
// rates of (xi, omega) whatever a is: (1) is not stiff in time. A loop that carries the force
// lambda stays open by |lambda| / (a omega^2).
//
// a = 0 asks for 1e7 times the typical mass at the loops, taken where the run starts and then held,
// so that similar mechanisms of any size have the same relative error.

#define AUTO_WEIGHT 1e7

typedef struct penalty {
    hn_penalised p;     // first
    double auto_weight; // for a = 0
} penalty;

static double weight_of(const penalty *s) {
    return s->p.a > 0 ? s->p.a : s->auto_weight;
}

static hn_status accelerate(void *self, double t, const double *v, double *acc) {
    penalty *s = self;
    hn_penalised *p = &s->p;
    const double a = weight_of(s);
    hn_dense_ode_pull(&p->ode, v, p->omega, p->xi, p->pull);
    HN_TRY(hn_penalised_factor(p, t, a));
    memcpy(acc, p->ode.f, (size_t)p->ode.base.nv * sizeof *acc);
    for (int k = 0; k < p->ode.base.nc; k++) {
        p->work[k] = -a * p->pull[k];
    }
    hn_dense_ode_add_rows(&p->ode, p->work, acc);
    hn_penalised_solve(p, acc);
    p->ode.base.cost.ops += 4.0 * p->ode.n_J;
    return HN_OK;
}

// lambda = -a (J acc + gamma + ...) gives (1) the form of accel_jacobian.h
static hn_accel_law law(const void *self) {
    const hn_penalised *p = self;
    return (hn_accel_law){p->xi * p->omega, p->omega, 1 / weight_of(self)};
}

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    penalty *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = s;
    s->auto_weight = AUTO_WEIGHT;
    s->p.ode.accelerate = accelerate;
    s->p.ode.base.law = law;
    return hn_penalised_init(&s->p, sys, options, arena, diag);
}

static hn_status set_state(void *self, double t, const double *q, const double *v, double *y) {
    penalty *s = self;
    HN_TRY(hn_state_ode_set_state(self, t, q, v, y));
    hn_eval_run(s->p.ode.eval, t, q, v);
    const double typical = hn_penalised_typical_mobility(&s->p);
    s->auto_weight = typical > 0 ? AUTO_WEIGHT / typical : AUTO_WEIGHT;
    return HN_OK;
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
                "for weights above 1e10 times the masses; singular configurations; omega h beyond "
                "the integrator's "
                "stability limit",
    .source = "Bayo, Garcia de Jalon & Serna 1988",
    .needs = "M f phi J gamma",
    .model_error = true,
    .traits = HN_TRAIT_PULLS_GAP | HN_TRAIT_ADDS_VIBRATIONS,
    .n_options = HN_PENALISED_OPTIONS,
    .options =
        {
            [HN_PENALISED_A] =
                {.key = "a",
                 .max = 1e15,
                 .about =
                     "penalty weight; 0: 1e7 times the typical mass at the loops, at the start"},
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
    .set_state = set_state,
    .get_state = hn_state_ode_get_state,
    .after_step = hn_state_ode_after_step,
    .set = hn_penalised_set,
    .add_cost = hn_dense_ode_add_cost,
    .why = hn_state_ode_why,
};
