// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "formulations/ground/accel_ode.h"
#include "formulations/ground/formulation.h"

#include <math.h>

// J a = -gamma - 2 alpha (J v + phi_t) - beta^2 phi, so the gap e obeys e'' + 2 alpha e' + beta^2 e
// = 0; with alpha = beta it is critically damped:  e(t) = (e0 + (e0' + alpha e0) t) exp(-alpha t).
// (1)
//
// The automatic rule follows the motion, not the step: alpha = min(1.3 w_rms, 0.1 / h), where w_rms
// is the running rms of the largest rate. Tying alpha to 1/h alone would bring any integrator down
// to order 2, because inner stages leave a gap of O(h^2) that alpha^2 then multiplies.

#define AUTO_RATE 1.3
#define AUTO_STEP 0.1

typedef struct baumgarte {
    hn_accel_ode ode; // first: see accel_ode.h
    int rule;
    double *user_rates; // n_user
    double *rate_scale; // n_user: 1 for an angle, 1 / length for a length
    int n_user;
    double t_last, sum_square, sum_time;
} baumgarte;

static hn_status create(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag) {
    baumgarte *b = hn_arena_get(arena, sizeof *b);
    if (!b) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *self = b;
    const hn_scene *scene = hn_system_scene(sys);

    b->rule = (int)options[HN_STABILISED_RULE];
    b->ode.alpha = options[HN_STABILISED_ALPHA];
    b->ode.beta = options[HN_STABILISED_BETA];
    b->n_user = hn_system_get_info(sys).n_user;

    // for the automatic rule: rates of the user's coordinates in 1/s
    b->user_rates = hn_arena_doubles(arena, (size_t)b->n_user);
    b->rate_scale = hn_arena_doubles(arena, (size_t)b->n_user);
    if (!b->user_rates || !b->rate_scale) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    for (int i = 0; i < b->n_user; i++) {
        const hn_coordinate *c = &scene->coordinates[hn_system_user_coordinate(sys, i)];
        b->rate_scale[i] = c->kind == HN_LENGTH ? 1 / hn_system_length(sys) : 1;
    }
    return hn_accel_ode_init(&b->ode, sys, 1, (hn_solver)options[HN_STABILISED_SOLVER], arena,
                             diag);
}

static hn_status set_state(void *self, double t, const double *q, const double *v, double *y) {
    baumgarte *b = self;
    b->t_last = t;
    b->sum_square = b->sum_time = 0;
    // before the first step neither h nor the motion's rate is known; the start is consistent
    if (b->rule == HN_BAUMGARTE_AUTO) {
        b->ode.alpha = b->ode.beta = 0;
    }
    return hn_state_ode_set_state(self, t, q, v, y);
}

static double fastest_rate(baumgarte *b, const double *v) {
    double fastest = 0;
    hn_system_rates_to_user(b->ode.base.sys, v, b->user_rates);
    for (int i = 0; i < b->n_user; i++) {
        fastest = fmax(fastest, fabs(b->user_rates[i]) * b->rate_scale[i]);
    }
    return fastest;
}

static hn_status after_step(void *self, double t, double *y, int *changed) {
    baumgarte *b = self;
    const double h = t - b->t_last;
    (void)hn_state_ode_after_step(self, t, y, changed);
    b->t_last = t;
    if (b->rule != HN_BAUMGARTE_AUTO || !(h > 0)) {
        return HN_OK;
    }
    const double rate = fastest_rate(b, y + b->ode.base.nq);
    b->sum_square += h * rate * rate;
    b->sum_time += h;
    b->ode.alpha = fmin(AUTO_RATE * sqrt(b->sum_square / b->sum_time), AUTO_STEP / h);
    b->ode.beta = b->ode.alpha;
    *changed = 1; // y stays, its slope does not
    return HN_OK;
}

static hn_status set(void *self, int option, double value) {
    baumgarte *b = self;
    if (option == HN_STABILISED_SOLVER) {
        return HN_ERR_UNSUPPORTED; // compiled in
    }
    if (option == HN_STABILISED_RULE) {
        b->rule = (int)value;
    } else if (b->rule == HN_BAUMGARTE_AUTO) {
        return HN_ERR_UNSUPPORTED; // the rule would overwrite it at the next step
    } else if (option == HN_STABILISED_ALPHA) {
        b->ode.alpha = value;
    } else {
        b->ode.beta = value;
    }
    return HN_OK;
}

static bool lanes(const double *options, hn_accel_opts *accel, double *alpha, double *beta) {
    *accel = (hn_accel_opts){.baumgarte = true, .solver = (hn_solver)options[HN_STABILISED_SOLVER]};
    *alpha = options[HN_STABILISED_ALPHA];
    *beta = options[HN_STABILISED_BETA];
    return (int)options[HN_STABILISED_RULE] == HN_BAUMGARTE_GIVEN;
}

static const char *const rules[] = {[HN_BAUMGARTE_GIVEN] = "given", [HN_BAUMGARTE_AUTO] = "auto"};

const hn_formulation hn_formulation_baumgarte = {
    .name = "baumgarte",
    .title = "Baumgarte stabilisation",
    .short_name = "Baumgarte",
    .rule = "Replace zero acceleration error by a damped oscillator: the gap decays like "
            "exp(-alpha t) (alpha above beta: slower, like "
            "exp(-(alpha - sqrt(alpha^2 - beta^2)) t)), but the force that closes it also "
            "disturbs the motion.",
    .drift = "bounded: truncation error opens the gap, alpha and beta close it; alpha = "
             "beta is critically damped",
    .when = "a small gap at almost the price of index-1; real time",
    .when_not = "near a singular configuration (the correction is divided by a vanishing "
                "singular value); alpha h beyond the integrator's stability limit; alpha "
                "proportional to 1/h with an integrator of order above 1",
    .source = "Baumgarte 1972; Ascher, Chin, Petzold & Reich 1995",
    .needs = "M f phi J gamma",
    .alternative_form = HN_FORM_STABILISED,
    .index = 1,
    .traits = HN_TRAIT_PULLS_GAP,
    .n_options = HN_STABILISED_OPTIONS,
    .options =
        {
            [HN_STABILISED_ALPHA] = {.key = "alpha",
                                     .initial = 5,
                                     .min = -1e6,
                                     .max = 1e6,
                                     .unit = "1/s",
                                     .about = "damping of the gap",
                                     .warn_below_zero = true},
            [HN_STABILISED_BETA] = {.key = "beta",
                                    .initial = 5,
                                    .min = -1e6,
                                    .max = 1e6,
                                    .unit = "1/s",
                                    .about = "natural frequency of the gap",
                                    .warn_below_zero = true},
            [HN_STABILISED_RULE] =
                {.key = "rule",
                 .max = 1,
                 .about =
                     "given: alpha and beta as set; auto: alpha = beta = min(1.3 x rms rate, 0.1 / "
                     "step)",
                 .choices = rules,
                 .n_choices = 2},
            [HN_STABILISED_SOLVER] = HN_ACCEL_ODE_SOLVER_OPTION,
        },
    .create = create,
    .destroy = hn_accel_ode_destroy,
    .ode = hn_accel_ode_get,
    .set_state = set_state,
    .get_state = hn_state_ode_get_state,
    .after_step = after_step,
    .set = set,
    .lanes = lanes,
    .add_cost = hn_accel_ode_add_cost,
    .fallbacks = hn_accel_ode_fallbacks,
    .why = hn_state_ode_why,
};
