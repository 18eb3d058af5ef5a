// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "integrators/constrained/newmark.h"
#include "integrators/step/options.h"

#include "linalg/dense.h"

#include <math.h>
#include <string.h>

// Generalised-alpha with the auxiliary a of Arnold & Bruls: v' is the true acceleration, and
//
//  (1 - alpha_m) a1 + alpha_m a0 = (1 - alpha_f) v'1 + alpha_f v'0, M v'1 = f + J' lambda at t1 (1)
//  alpha_m = (2 rho - 1) / (rho + 1),  alpha_f = rho / (rho + 1),
//  gamma = 1/2 + alpha_f - alpha_m,  beta = (gamma + 1/2)^2 / 4                            (2)
//
// rho is the factor that is left of an infinitely fast oscillation after a step. The equilibrium
// holds exactly at t1, so M may depend on q. a0 approximates v' at t + (alpha_m - alpha_f) h; begun
// there (shifted) the start costs no accuracy, begun with v' itself the order stays 2, begun with 0
// it falls to 1. Source: Chung & Hulbert 1993; Arnold & Bruls 2007; Arnold, Bruls & Cardona 2015.

enum { OPT_STEP, OPT_RHO, OPT_A0, N_OPTIONS };
enum { A0_SHIFTED, A0_CONSISTENT, A0_ZERO };
static const double SHIFT_STEP =
    1e-2; // of h: for the rate of v' at the start, by central differences

typedef struct genalpha {
    hn_newmark n; // first
    int a0, fresh;
    double alpha_m, alpha_f;
    hn_newmark_carried now, next;   // v' in e
    double *q, *v, *before, *after; // for the start
} genalpha;

static void choose_coefficients(genalpha *s, double rho) {
    s->alpha_m = (2 * rho - 1) / (rho + 1);
    s->alpha_f = rho / (rho + 1);
    s->n.gamma = 0.5 + s->alpha_f - s->alpha_m;
    s->n.beta = (s->n.gamma + 0.5) * (s->n.gamma + 0.5) / 4;
    s->n.weight = (1 - s->alpha_m) / (1 - s->alpha_f);
}

static hn_status create(const hn_system *sys, hn_dae_form form, const double *options,
                        const double *form_options, hn_arena *arena, void **self, hn_diag *diag) {
    HN_TRY(hn_dae_instance(form, form_options, "genalpha", sizeof(genalpha), arena, self, diag));
    genalpha *s = *self;
    HN_TRY(hn_newmark_init(&s->n, sys, form == HN_FORM_GGL, arena, diag));

    // coefficients of (2), and room for what the start and the steps carry
    const size_t nv = (size_t)s->n.base.nv, nc = (size_t)s->n.base.nc;
    choose_coefficients(s, options[OPT_RHO]);
    s->a0 = (int)options[OPT_A0];
    s->q = hn_arena_doubles(arena, (size_t)s->n.base.nq);
    s->v = hn_arena_doubles(arena, nv);
    s->before = hn_arena_doubles(arena, nv);
    s->after = hn_arena_doubles(arena, nv);
    hn_newmark_carried_init(&s->now, arena, nv, nc);
    hn_newmark_carried_init(&s->next, arena, nv, nc);
    return hn_arena_failed(arena) ? hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory")
                                  : HN_OK;
}

static void destroy(void *self) {
    genalpha *s = self;
    hn_newmark_destroy(&s->n);
}

static hn_status start(void *self, double t, const double *y) {
    genalpha *s = self;
    hn_dae_base *b = &s->n.base;
    s->fresh = 1;
    return hn_dae_accelerate(b, t, y, y + b->nq, s->now.e, s->now.lambda);
}

// v' at t + d along the motion, to the second order in d
static hn_status look_ahead(genalpha *s, double t, double d, const double *y, double *vdot) {
    hn_dae_base *b = &s->n.base;
    const double *v = y + b->nq;
    for (int i = 0; i < b->nv; i++) {
        s->v[i] = d * (v[i] + d / 2 * s->now.e[i]);
    }
    memcpy(s->q, y, (size_t)b->nq * sizeof *s->q);
    hn_system_move(b->sys, s->q, s->v);
    for (int i = 0; i < b->nv; i++) {
        s->v[i] = v[i] + d * s->now.e[i];
    }
    return hn_dae_accelerate(b, t + d, s->q, s->v, vdot, NULL);
}

static hn_status begin(genalpha *s, double t, double h, const double *y) {
    hn_dae_base *b = &s->n.base;
    memcpy(s->now.a, s->now.e, (size_t)b->nv * sizeof *s->now.a);
    if (s->a0 == A0_ZERO) {
        memset(s->now.a, 0, (size_t)b->nv * sizeof *s->now.a);
    }
    if (s->a0 != A0_SHIFTED) {
        return HN_OK;
    }
    const double d = SHIFT_STEP * h;
    hn_status status = look_ahead(s, t, -d, y, s->before);
    HN_THEN(status, look_ahead(s, t, d, y, s->after));
    for (int i = 0; i < b->nv && status == HN_OK; i++) {
        s->now.a[i] += (s->alpha_m - s->alpha_f) * h * (s->after[i] - s->before[i]) / (2 * d);
    }
    return status;
}

static hn_status step(void *self, double t, double h, const double *y, double *y_new, double *err) {
    (void)err;
    genalpha *s = self;
    const size_t nv = (size_t)s->n.base.nv, nc = (size_t)s->n.base.nc;
    HN_TRY(s->fresh ? begin(s, t, h, y) : HN_OK);
    memcpy(s->n.a0, s->now.a, nv * sizeof *s->n.a0);
    memcpy(s->n.guess, s->now.lambda, nc * sizeof *s->n.guess);
    for (size_t i = 0; i < nv; i++) {
        s->n.past[i] = (s->alpha_m * s->now.a[i] - s->alpha_f * s->now.e[i]) / (1 - s->alpha_f);
    }
    hn_status status = hn_newmark_step(&s->n, t, h, y, y_new);
    memcpy(s->next.a, s->n.a1, nv * sizeof *s->n.a1);
    memcpy(s->next.e, s->n.e, nv * sizeof *s->n.e);
    memcpy(s->next.lambda, s->n.lambda, nc * sizeof *s->n.lambda);
    return status;
}

static void accepted(void *self, int changed) {
    genalpha *s = self;
    const hn_newmark_carried spare = s->now;
    (void)changed; // a small mending of the state leaves the accelerations as good as they were
    s->now = s->next;
    s->next = spare;
    s->fresh = 0;
}

static const double *raw_lambda(const void *self) {
    const genalpha *s = self;
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

static const char *const starts[] = {"shifted", "consistent", "zero"};

const hn_stepper hn_stepper_genalpha = {
    .name = "genalpha",
    .title = "generalised-alpha",
    .about = "Order 2 in positions, velocities and multipliers for rho < 1. A fast oscillation "
             "shrinks by the factor rho in each step, a slow one hardly. At rho = 1 nothing is "
             "damped, and the multipliers of the scheme oscillate for ever.",
    .source = "Chung & Hulbert 1993; Arnold & Bruls 2007",
    .order = 2,
    .stages = 1,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_options = N_OPTIONS,
    .options =
        {
            [OPT_STEP] = HN_OPTION_STEP,
            [OPT_RHO] =
                {.key = "rho",
                 .initial = 0.8,
                 .max = 1,
                 .about = "fraction of an infinitely fast oscillation that remains after a step"},
            [OPT_A0] = {.key = "a0",
                        .max = 2,
                        .about = "start value of the auxiliary acceleration",
                        .choices = starts,
                        .n_choices = 3},
        },
    .forms = 1u << HN_FORM_INDEX3 | 1u << HN_FORM_GGL,
    .dae = &dae,
};
