// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/project.h"
#include "dynamics/evaluate/accel.h"
#include "formulations/ground/accel_ode.h"
#include "formulations/ground/formulation.h"

#include <math.h>
#include <stdio.h>

enum { OPT_WEIGHT, OPT_WHAT, OPT_SOLVER, N_OPTIONS };
enum { WHAT_BOTH, WHAT_POSITION, WHAT_VELOCITY };
// of the characteristic length: rounding level times sqrt(rows), and what is accepted where
// rounding is coarser
#define GAP_TOL 3e-16
#define GAP_TOL_COARSE 1e-12
// likewise: a step that is too long opens dependent rows by more
#define CONTRADICTION 1e-6

typedef struct projection {
    hn_accel_ode ode; // first: see accel_ode.h
    hn_projector *projector;
    int what;
} projection;

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    projection *p = hn_arena_get(arena, sizeof *p);
    if (!p) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = p;
    p->what = (int)options[OPT_WHAT];
    hn_status status =
        hn_accel_ode_init(&p->ode, sys, 0, (hn_solver)options[OPT_SOLVER], arena, diag);
    if (status != HN_OK || p->ode.base.nc == 0) {
        return status;
    }
    const hn_weight weight = options[OPT_WEIGHT] > 0 ? HN_WEIGHT_EUCLIDEAN : HN_WEIGHT_MASS;
    status = hn_projector_create(sys, weight, arena, &p->projector);
    return status == HN_OK
               ? HN_OK
               : hn_diag_set(diag, status, NULL, NULL, "the projection cannot be set up: %s",
                             hn_status_text(status));
}

static void destroy(void *self) {
    projection *p = self;
    hn_projector_free(p->projector);
    p->projector = NULL;
    hn_accel_ode_destroy(self);
}

/// `limit`: where equations depend on each other, a gap below it is no matter of the step.
static hn_status tell(projection *p, hn_status status, double t, const char *part,
                      const hn_project_info *info, double limit) {
    const double gap = fmin(info->gap_before, info->gap);
    if (status == HN_ERR_NO_CONVERGENCE && info->rank < p->ode.base.nc && gap < limit) {
        snprintf(p->ode.base.why, sizeof p->ode.base.why,
                 "the projection of %s at t = %.6g s failed: %d of %d constraint equations depend "
                 "on the others and contradict them by %.2g, as rounded numbers of a scene do; "
                 "then no step is short enough",
                 part, t, p->ode.base.nc - info->rank, p->ode.base.nc, gap);
    } else if (status != HN_OK) {
        snprintf(p->ode.base.why, sizeof p->ode.base.why,
                 "the projection of %s at t = %.6g s failed: %s; the step was too long for it",
                 part, t, hn_status_text(status));
    }
    return status;
}

static hn_status project_position(projection *p, double t, double *q, hn_project_info *info) {
    const double tol = GAP_TOL * sqrt(p->ode.base.nc);
    hn_status status = hn_project_position(p->projector, t, q, tol, info);
    p->ode.base.cost.newton += info->iterations;
    if (status == HN_ERR_NO_CONVERGENCE) {
        status = hn_project_position(p->projector, t, q, GAP_TOL_COARSE, info);
        p->ode.base.cost.newton += info->iterations;
    }
    return status;
}

static hn_status after_step(void *self, double t, double *y, int *changed) {
    projection *p = self;
    hn_project_info info = {0};
    (void)hn_state_ode_after_step(self, t, y, changed);
    if (!p->projector) {
        return HN_OK; // no loop to close
    }

    // positions
    *changed = 1;
    p->ode.base.cost.projections++;
    if (p->what != WHAT_VELOCITY) {
        const hn_status status = project_position(p, t, y, &info);
        if (status != HN_OK) {
            return tell(p, status, t, "the position", &info,
                        CONTRADICTION * hn_system_length(p->ode.base.sys));
        }
    }

    // velocities, at the new positions
    if (p->what != WHAT_POSITION) {
        const hn_status status = hn_project_velocity(p->projector, t, y, y + p->ode.base.nq, &info);
        if (status != HN_OK) {
            return tell(p, status, t, "the speeds", &info, HUGE_VAL);
        }
        p->ode.base.cost.energy_removed += info.energy_removed;
    }
    return HN_OK;
}

static void add_cost(const void *self, hn_cost *cost) {
    const projection *p = self;
    hn_accel_ode_add_cost(self, cost);
    if (p->projector) {
        cost->ops += hn_projector_ops(p->projector);
        cost->factorisations += hn_projector_evals(p->projector);
    }
}

static const char *const weights[] = {"mass", "euclidean"};
static const char *const whats[] = {"both", "position", "velocity"};

const hn_formulation hn_formulation_projection = {
    .name = "projection",
    .title = "projection after each step",
    .short_name = "projection",
    .rule = "Step as index-1, then move the state to the nearest one with closed loops: "
            "first positions, then velocities. Measured with the mass matrix, this can "
            "only remove kinetic energy.",
    .drift = "none: gap and velocity violation at rounding level after every step; energy "
             "may still drift",
    .when = "short and medium runs: accurate and cheap; a good first choice",
    .when_not = "very long conservative runs (energy drifts linearly); massless links with "
                "weight=mass",
    .source = "Eich 1993; Ascher, Chin & Reich 1994; Blajer 2002",
    .needs = "M f phi J gamma",
    .index = 1,
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY,
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_WEIGHT] =
                {.key = "weight",
                 .max = 1,
                 .about = "metric for the nearest state: kinetic energy, or the sum of squares",
                 .choices = weights,
                 .n_choices = 2},
            [OPT_WHAT] = {.key = "what",
                          .max = 2,
                          .about = "part of the state that is projected",
                          .choices = whats,
                          .n_choices = 3},
            [OPT_SOLVER] = HN_ACCEL_ODE_SOLVER_OPTION,
        },
    .create = create,
    .destroy = destroy,
    .ode = hn_accel_ode_get,
    .set_state = hn_state_ode_set_state,
    .get_state = hn_state_ode_get_state,
    .after_step = after_step,
    .add_cost = add_cost,
    .fallbacks = hn_accel_ode_fallbacks,
    .why = hn_state_ode_why,
};
