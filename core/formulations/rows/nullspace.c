// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/orthonormal_state.h"
#include "formulations/chart/tangent_state.h"
#include "formulations/ground/formulation.h"

#include <stdbool.h>

// (N' M N) u' + N' (M N' u + h) = N' Q    with the rate of the basis (the prime is a transpose to
// the left of M, a rate to its right). Two bases: the partition N = [I; -J_d^-1 J_i], for which N'
// u = [0; -J_d^-1 gamma] (tangent_state.h), and an orthonormal one that is carried along with the
// motion (orthonormal_state.h).

enum { OPT_BASIS, N_OPTIONS };
enum { BASIS_PARTITION, BASIS_ORTHONORMAL };

typedef struct nullspace {
    int basis;
    union {
        hn_tangent_state partition;
        hn_orthonormal_state orthonormal;
    } state;
} nullspace;

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    nullspace *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = s;
    s->basis = (int)options[OPT_BASIS];
    return s->basis == BASIS_PARTITION
               ? hn_tangent_init(&s->state.partition, sys, 1, 0, arena, diag)
               : hn_orthonormal_init(&s->state.orthonormal, sys, 1, arena, diag);
}

static void destroy(void *self) {
    nullspace *s = self;
    if (s->basis == BASIS_PARTITION) {
        hn_tangent_destroy(&s->state);
    } else {
        hn_orthonormal_destroy(&s->state);
    }
}

static void ode(void *self, hn_ode *out) {
    nullspace *s = self;
    if (s->basis == BASIS_PARTITION) {
        hn_tangent_ode(&s->state, out);
    } else {
        hn_orthonormal_ode(&s->state, out);
    }
}

static hn_status set_state(void *self, double t, const double *q, const double *v, double *y) {
    nullspace *s = self;
    return s->basis == BASIS_PARTITION ? hn_tangent_set_state(&s->state, t, q, v, y)
                                       : hn_orthonormal_set_state(&s->state, t, q, v, y);
}

static hn_status get_state(void *self, double t, const double *y, double *q, double *v) {
    nullspace *s = self;
    return s->basis == BASIS_PARTITION ? hn_tangent_get_state(&s->state, t, y, q, v)
                                       : hn_orthonormal_get_state(&s->state, t, y, q, v);
}

static hn_status after_step(void *self, double t, double *y, int *changed) {
    nullspace *s = self;
    return s->basis == BASIS_PARTITION ? hn_tangent_after_step(&s->state, t, y, changed)
                                       : hn_orthonormal_after_step(&s->state, t, y, changed);
}

static hn_status change_chart(void *self, double t, double *y) {
    nullspace *s = self;
    return s->basis == BASIS_PARTITION ? hn_tangent_change_chart(&s->state, t, y) : HN_ERR_CHART;
}

// the carried basis is another one after each step
static int state_is_local(const void *self) {
    const nullspace *s = self;
    return s->basis == BASIS_ORTHONORMAL;
}

static void add_cost(const void *self, hn_cost *cost) {
    const nullspace *s = self;
    if (s->basis == BASIS_PARTITION) {
        hn_tangent_add_cost(&s->state, cost);
    } else {
        hn_orthonormal_add_cost(&s->state, cost);
    }
}

static const char *why(const void *self) {
    const nullspace *s = self;
    return s->basis == BASIS_PARTITION ? hn_tangent_why(&s->state) : hn_orthonormal_why(&s->state);
}

static const char *const bases[] = {"partition", "orthonormal"};

const hn_formulation hn_formulation_nullspace = {
    .name = "nullspace",
    .title = "null-space, full form",
    .short_name = "null-space",
    .rule = "Write the velocities as v = N u with J N = 0 and project the equations on N: "
            "no multipliers are left. N changes with the configuration, so its rate belongs "
            "in the equation.",
    .drift = "none: J v = 0 by construction, and the position is closed after each step",
    .when = "any mechanism away from singular configurations, if multipliers are not "
            "needed; basis=orthonormal for many degrees of freedom in one loop",
    .when_not = "singular configurations: N changes its number of columns there",
    .source = "Kim & Vanderploeg 1986; Liang & Lance 1987; Potra & Rheinboldt 1991",
    .needs = "M f phi J gamma",
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY | HN_TRAIT_HAS_CHART |
              HN_TRAIT_HAS_BASIS,
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_BASIS] = {.key = "basis",
                           .max = 1,
                           .about = "partition: N from independent coordinates; orthonormal: an "
                                    "orthonormal N that "
                                    "turns with the motion",
                           .choices = bases,
                           .n_choices = 2},
        },
    .create = create,
    .destroy = destroy,
    .ode = ode,
    .set_state = set_state,
    .get_state = get_state,
    .after_step = after_step,
    .change_chart = change_chart,
    .state_is_local = state_is_local,
    .add_cost = add_cost,
    .why = why,
};
