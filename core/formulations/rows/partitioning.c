// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/minimal_state.h"
#include "formulations/ground/formulation.h"

enum { OPT_TAU, N_OPTIONS };

typedef struct partitioning {
    hn_minimal_state state; // first: see minimal_state.h
    double tau;
} partitioning;

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    partitioning *p = hn_arena_get(arena, sizeof *p);
    if (!p) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = p;
    p->tau = options[OPT_TAU];
    return hn_minimal_init(&p->state, sys, arena, diag);
}

static hn_status set_state(void *self, double t, const double *q, const double *v, double *y) {
    partitioning *p = self;
    return hn_minimal_start(&p->state, HN_CHART_PREFERRED, t, q, v, y);
}

static hn_status after_step(void *self, double t, double *y, int *changed) {
    partitioning *p = self;
    hn_minimal_state *s = &p->state;
    hn_chart *chart = &s->chart;
    *changed = 0;
    const double h = t - chart->base.t;
    const hn_status status = hn_minimal_settle(s, t, y);
    if (status != HN_OK || !hn_chart_is_poor(chart, h, p->tau)) {
        return status;
    }
    // the chosen coordinates near their dead point: others take over, with the state as it is
    hn_chart_speeds(chart, &chart->base, y + chart->r, s->v);
    *changed = 1;
    chart->cost.chart_changes++;
    return hn_minimal_start(s, HN_CHART_BEST, t, chart->base.q, s->v, y);
}

const hn_formulation hn_formulation_partitioning = {
    .name = "partitioning",
    .title = "coordinate partitioning",
    .short_name = "partitioning",
    .rule = "Integrate as many independent coordinates as there are degrees of freedom; "
            "the loops determine the others. Near a dead point of the independent "
            "coordinates, others are chosen.",
    .drift = "none: every evaluation closes the loops",
    .when = "one or two degrees of freedom, no drift, motions through dead points",
    .when_not = "singular configurations: no choice of coordinates is regular there",
    .source = "Wehage & Haug 1982",
    .needs = "M f phi J gamma",
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY | HN_TRAIT_HAS_CHART,
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_TAU] =
                {.key = "tau",
                 .initial = HN_CHART_TAU,
                 .max = 1,
                 .about =
                     "change coordinates when |det J_d| falls below tau times that of the best "
                     "choice"},
        },
    .create = create,
    .destroy = hn_minimal_destroy,
    .ode = hn_minimal_ode,
    .set_state = set_state,
    .get_state = hn_minimal_get_state,
    .after_step = after_step,
    .change_chart = hn_minimal_change_chart,
    .add_cost = hn_minimal_add_cost,
    .why = hn_minimal_why,
};
