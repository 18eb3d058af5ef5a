#include "linalg/saddle.h"
#include "methods/dense_ode.h"
#include "methods/flops.h"
#include "methods/registry.h"

#include <stdio.h>

// J N = 0:  a = N z + c,  (N' M N) z = N' (f - M c),  c = -J^+ gamma, at the state (q, v) as it stands.        (1)
//
// N is an orthonormal basis by pivoted QR, found anew each time (linalg/saddle.h). It may turn or change sign from one
// evaluation to the next: only a is used, which no choice of N changes.

typedef struct nullspace_solver {
    hn_dense_ode ode; // first: see dense_ode.h
    hn_saddle_ws *ws;
} nullspace_solver;

static hn_status accelerate(void *self, double t, const double *v, double *a) {
    nullspace_solver *s = self;
    hn_dense_ode *ode = &s->ode;
    (void)v;
    const hn_status status = hn_saddle_solve(ode->nv, ode->nc, ode->M, ode->J, ode->f, ode->gamma,
                                             a, NULL, NULL, NULL, s->ws);
    ode->cost.factorisations++;
    ode->cost.solves++;
    ode->cost.ops += hn_flops_saddle(ode->nv, ode->nc);
    if (status != HN_OK) {
        snprintf(ode->why, sizeof ode->why, "accelerations at t = %.6g s: %s", t,
                 hn_status_text(status));
    }
    return status;
}

static hn_status create(const hn_system *sys, const double *settings, hn_arena *arena, void **self,
                        hn_diag *diag) {
    (void)settings;
    const hn_system_info info = hn_system_get_info(sys);
    nullspace_solver *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = s;
    s->ode.accelerate = accelerate;
    const hn_status status = hn_dense_ode_init(&s->ode, sys, 0, arena, diag);
    if (status != HN_OK) {
        return status;
    }
    s->ws = hn_saddle_ws_create(arena, info.nv, info.nc);
    return s->ws ? HN_OK : hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
}

const hn_formulation hn_formulation_nullspace_solver = {
    .name = "nullspace-solver",
    .title = "null space as a linear solver",
    .short_name = "NS solver",
    .rule = "Use the null space of J only to solve for the accelerations, at positions and speeds "
            "that are free. The multipliers are gone, and nothing else: it drifts exactly as "
            "index-1 does.",
    .drift = "as index-1: the gap grows like t^2, the speed gap like t",
    .when = "to see that eliminating multipliers does not remove drift; redundant rows",
    .when_not = "long runs; large mechanisms (dense)",
    .source = "Kim & Vanderploeg 1986; Potra & Rheinboldt 1991",
    .needs = "M f J gamma",
    .index = 1,
    .create = create,
    .destroy = hn_dense_ode_destroy,
    .ode = hn_dense_ode_get,
    .set_state = hn_dense_ode_set_state,
    .get_state = hn_dense_ode_get_state,
    .add_cost = hn_dense_ode_add_cost,
    .why = hn_dense_ode_why,
};
