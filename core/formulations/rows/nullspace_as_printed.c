// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/tangent_state.h"
#include "formulations/ground/formulation.h"

// The lesson's section 3 prints N' M N u' + N' (C v + g) = N' S' tau: the term N' M (dN/dt) u is
// missing, although its Problem 2 introduces the rate of N. The rest converges, to the wrong
// motion, and to a different one for each basis: the closed loop proves nothing. Kept as an exhibit
// of model error against discretisation error.

enum { OPT_BASIS, N_OPTIONS };

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    hn_tangent_state *s = hn_arena_get(arena, sizeof *s);
    if (!s) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = s;
    return hn_tangent_init(s, sys, 0, options[OPT_BASIS] > 0, arena, diag);
}

static const char *const bases[] = {"first-entry-1", "unit-length"};

const hn_formulation hn_formulation_nullspace_as_printed = {
    .name = "nullspace-as-printed",
    .title = "null-space, with the printed lesson's mistake",
    .short_name = "as printed",
    .rule = "The printed lesson, which lesson 3 corrects, omits the rate of the basis. The loop "
            "stays closed to rounding while the energy is wrong; halving the step does not help.",
    .drift = "none in the gap; the energy is wrong at any step size, by an amount that "
             "depends on the basis",
    .when = "to compare a model error with a discretisation error",
    .when_not = "any result that matters",
    .source = "the printed lesson that lesson 1 introduces, section 3",
    .needs = "M f phi J",
    .model_error = true,
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY | HN_TRAIT_HAS_CHART |
              HN_TRAIT_HAS_BASIS | HN_TRAIT_COUNTER_EXAMPLE,
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_BASIS] = {.key = "basis",
                           .max = 1,
                           .about = "scaling of the columns of N",
                           .choices = bases,
                           .n_choices = 2},
        },
    .create = create,
    .destroy = hn_tangent_destroy,
    .ode = hn_tangent_ode,
    .set_state = hn_tangent_set_state,
    .get_state = hn_tangent_get_state,
    .after_step = hn_tangent_after_step,
    .change_chart = hn_tangent_change_chart,
    .add_cost = hn_tangent_add_cost,
    .why = hn_tangent_why,
};
