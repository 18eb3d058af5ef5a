// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/constrained/newmark.h"
#include "integrators/step/options.h"

#include "linalg/dense.h"

#include <math.h>
#include <string.h>

// HHT-I3: with F = f + J' lambda and alpha in [-1/3, 0]
//
//     1 / (1 + alpha) M(q1) a1 - F1 + alpha / (1 + alpha) F0 = 0                              (1)
//     gamma = (1 - 2 alpha) / 2,  beta = (1 - alpha)^2 / 4                                    (2)
//
// (1) weighs forces of two times against an acceleration that M of ONE time multiplies. If M
// depends on q that is an error of the order h in each step: order 2 for constant M, little more
// than 1 in angles. Source: Negrut et al. 2007; Jay & Negrut 2007.

enum { OPT_STEP, OPT_DAMPING, N_OPTIONS };

typedef struct hht {
    hn_newmark n; // first
    double alpha;
    hn_newmark_carried now, next; // forces in e
} hht;

static hn_status create(const hn_system *sys, hn_dae_form form, const double *options,
                        const double *form_options, hn_arena *arena, void **self, hn_diag *diag) {
    HN_TRY(hn_dae_instance(form, form_options, "hht", sizeof(hht), arena, self, diag));
    hht *s = *self;
    HN_TRY(hn_newmark_init(&s->n, sys, 0, arena, diag));
    s->alpha = -options[OPT_DAMPING];
    s->n.gamma = (1 - 2 * s->alpha) / 2;
    s->n.beta = (1 - s->alpha) * (1 - s->alpha) / 4;
    s->n.weight = 1 / (1 + s->alpha);
    const size_t nv = (size_t)s->n.base.nv, nc = (size_t)s->n.base.nc;
    hn_newmark_carried_init(&s->now, arena, nv, nc);
    hn_newmark_carried_init(&s->next, arena, nv, nc);
    return hn_arena_failed(arena) ? hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory")
                                  : HN_OK;
}

static void destroy(void *self) {
    hht *s = self;
    hn_newmark_destroy(&s->n);
}

// F at a state: R of the linearised equations without acceleration is its negative
static void find_force(hht *s, double t, const double *y, const double *lambda, double *force) {
    const hn_dae_base *b = &s->n.base;
    hn_linear_run(s->n.rest, t, y, y + b->nq, NULL, lambda);
    const double *R = hn_linear_get(s->n.rest, HN_LINEAR_RESIDUAL);
    for (int i = 0; i < b->nv; i++) {
        force[i] = -R[i];
    }
}

static hn_status start(void *self, double t, const double *y) {
    hht *s = self;
    hn_dae_base *b = &s->n.base;
    HN_TRY(hn_dae_accelerate(b, t, y, y + b->nq, s->now.a, s->now.lambda));
    find_force(s, t, y, s->now.lambda, s->now.e);
    return HN_OK;
}

static hn_status step(void *self, double t, double h, const double *y, double *y_new, double *err) {
    (void)err;
    hht *s = self;
    const size_t nv = (size_t)s->n.base.nv, nc = (size_t)s->n.base.nc;
    memcpy(s->n.a0, s->now.a, nv * sizeof *s->n.a0);
    memcpy(s->n.guess, s->now.lambda, nc * sizeof *s->n.guess);
    for (size_t i = 0; i < nv; i++) {
        s->n.carry[i] = s->alpha / (1 + s->alpha) * s->now.e[i];
    }
    HN_TRY(hn_newmark_step(&s->n, t, h, y, y_new));
    memcpy(s->next.a, s->n.a1, nv * sizeof *s->n.a1);
    memcpy(s->next.lambda, s->n.lambda, nc * sizeof *s->n.lambda);
    find_force(s, t + h, y_new, s->next.lambda, s->next.e);
    return HN_OK;
}

static void accepted(void *self, int changed) {
    hht *s = self;
    const hn_newmark_carried spare = s->now;
    (void)changed; // a small mending of the state leaves the forces as good as they were
    s->now = s->next;
    s->next = spare;
}

static const double *raw_lambda(const void *self) {
    const hht *s = self;
    return s->now.lambda;
}

static const hn_dae_stepper dae = {
    .create = create,
    .destroy = destroy,
    .start = start,
    .step = step,
    .on_accepted = accepted,
    .raw_lambda = raw_lambda,
    .add_cost = hn_newmark_add_cost,
    .why = hn_newmark_why,
};

const hn_stepper hn_stepper_hht = {
    .name = "hht",
    .title = "HHT-I3",
    .about = "Newmark's method with a weighted mean of the forces at both ends of the step. Order "
             "2 if the mass matrix is constant, as for points in Cartesian coordinates; little "
             "more than order 1 in angles, which genalpha avoids by an extra variable.",
    .source = "Negrut, Rampalli, Ottarsson & Sajdak 2007; Jay & Negrut 2007",
    .order = 2,
    .stages = 1,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_STEP] = HN_OPTION_STEP,
            [OPT_DAMPING] = {.key = "damping",
                             .initial = 0.05,
                             .max = 1.0 / 3,
                             .about = "numerical damping, -alpha of the papers"},
        },
    .forms = 1u << HN_FORM_INDEX3,
    .dae = &dae,
};
