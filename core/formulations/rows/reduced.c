// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/minimal_state.h"
#include "formulations/ground/formulation.h"

// q = f(q_r) for a fixed choice q_r, with B = df/dq_r:
//
//     M_r q_r'' + B' (M B' q_r' + h) = B' Q,   M_r = B' M B,   B' q_r' = [0; -J_d^-1 gamma]   (1)
//
// (the primes on B mark its rate on the left of q_r', its transpose elsewhere). f exists as far as
// the next fold, det J_d = 0; there the method stops and says so. If the loops fall apart into
// dyads f can be written down (dynamics/analyse/dyads.h) and nothing is iterated; else it is found
// by Newton's method. Neither is always cheaper: a parallelogram moves along its tangent, where
// Newton's method has nothing to do.

enum { OPT_COORDINATE, OPT_POSITION, N_OPTIONS };

static const char *const positions[] = {"auto", "newton", "dyads"}; // as hn_position counts them
enum { N_POSITIONS = sizeof positions / sizeof positions[0] };

typedef struct reduced {
    hn_minimal_state state; // first: see minimal_state.h
    int first;              // column that has to be independent, -1: any
} reduced;

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    reduced *red = hn_arena_get(arena, sizeof *red);
    if (!red) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = red;
    // 0 is "the best choice": HN_CHART_PREFERRED
    red->first = (int)options[OPT_COORDINATE] - 1;
    const int nv = hn_system_get_info(sys).nv;
    if (red->first >= nv) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, NULL,
                           "coordinate=%d: this scene has coordinates 1 to %d", red->first + 1, nv);
    }
    const hn_status status = hn_minimal_init(&red->state, sys, arena, diag);
    red->state.chart.advises = true;
    red->state.position = (hn_position)options[OPT_POSITION];
    return status;
}

static hn_status set_state(void *self, double t, const double *q, const double *v, double *y) {
    reduced *red = self;
    return hn_minimal_start(&red->state, red->first, t, q, v, y);
}

static hn_status after_step(void *self, double t, double *y, int *changed) {
    reduced *red = self;
    *changed = 0;
    return hn_minimal_settle(&red->state, t, y);
}

const hn_formulation hn_formulation_reduced = {
    .name = "reduced",
    .title = "reduced coordinates",
    .short_name = "reduced",
    .rule = "Write all coordinates as functions of as many as there are degrees of freedom "
            "and integrate only those; the loops are closed by construction, within the "
            "range of the chosen coordinates.",
    .drift = "none: every evaluation closes the loops",
    .when = "teaching, loops with a closed-form solution, a driven crank that turns all "
            "the way round",
    .when_not = "motions through a dead point of the chosen coordinate: the run stops there "
                "(partitioning continues)",
    .source = "Wehage & Haug 1982; Featherstone 2008, ch. 8",
    .needs = "M f phi J gamma",
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY | HN_TRAIT_HAS_CHART |
              HN_TRAIT_FIXED_CHART,
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_COORDINATE] =
                {.key = "coordinate",
                 .max = 4000,
                 .about =
                     "number of the joint coordinate to keep, as inspect lists them; 0: the best "
                     "choice at the start"},
            [OPT_POSITION] =
                {.key = "position",
                 .initial = HN_POSITION_AUTO,
                 .max = N_POSITIONS - 1,
                 .about =
                     "how the loops are closed: dyads in closed form, Newton's method, or auto: "
                     "dyads once Newton's method has cost more",
                 .choices = positions,
                 .n_choices = N_POSITIONS},
        },
    .create = create,
    .destroy = hn_minimal_destroy,
    .ode = hn_minimal_ode,
    .set_state = set_state,
    .get_state = hn_minimal_get_state,
    .after_step = after_step,
    .add_cost = hn_minimal_add_cost,
    .why = hn_minimal_why,
};
