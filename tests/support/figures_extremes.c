// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/dae.h"
#include "support/near.h"

#include "dynamics/evaluate/eval.h"
#include "formulations/list/formulation_list.h"
#include "integrators/list/stepper_list.h"
#include "linalg/dense.h"
#include "linalg/saddle.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Sizes and speeds, speeds that do not fit, chaos, tolerances of a library's default.

enum { NV = 3, NC = 2 };

// ---- speeds that do not fit the loop ----

/// dv = M^-1 J' S^-1 rate: the smallest change of the speeds that makes J v = rate. Returns 1/2 dv'
/// M dv [J].
static double misfit(const hn_model *m, const double rate[NC], double dv[NV]) {
    hn_eval *e = NULL;
    double Mdv[NV];
    const double zero[NV] = {0}, off[NC] = {-rate[0], -rate[1]};
    hn_saddle_ws *ws = hn_saddle_ws_create(m->arena, NV, NC);
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_M | HN_TERM_J, m->arena, &e), HN_OK);
    hn_eval_run(e, 0, m->q, NULL);
    assert_int_equal(hn_saddle_solve(NV, NC, hn_eval_get(e, HN_TERM_M), hn_eval_get(e, HN_TERM_J),
                                     zero, off, dv, NULL, NULL, NULL, ws),
                     HN_OK);
    hn_mat_vec(NV, NV, hn_eval_get(e, HN_TERM_M), dv, Mdv);
    hn_eval_free(e);
    return hn_dot(NV, dv, Mdv) / 2;
}

/// Step times the first multiplier after one step.
static double blow(const hn_model *m, double h) {
    hn_test_dae d;
    hn_test_dae_open(&d, m, hn_stepper_find("genalpha"), HN_FORM_INDEX3, NULL);
    assert_int_equal(hn_test_dae_steps(&d, h, 1), HN_OK);
    const double found = h * fabs(d.table->raw_lambda(d.self)[0]);
    hn_test_dae_close(&d);
    return found;
}

static void wrong_speeds(hn_figures *f) {
    static const double rate[NC] = {1, 0};
    double dv[NV];
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    const double energy = misfit(&m, rate, dv);
    hn_axpy(NV, 1, dv, m.v);
    hn_figure_put(f, "h lambda in the first step [N s]",
                  "fb0, J v = (1, 0) m/s, index3@genalpha:h=0.01", "2.14", blow(&m, 0.01));
    hn_figure_put(f, "h lambda in the first step [N s]",
                  "fb0, J v = (1, 0) m/s, index3@genalpha:h=0.005", "2.15", blow(&m, 0.005));
    hn_figure_put(f, "h lambda in the first step [N s]",
                  "fb0, J v = (1, 0) m/s, index3@genalpha:h=0.0025", "2.16", blow(&m, 0.0025));
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
    (void)hn_motion_at(run, 1e-3);
    char exact[32];
    (void)snprintf(exact, sizeof exact, "%.4g", energy);
    const hn_figure lost = {.what = "energy that projection takes [J]",
                            .how = "fb0, J v = (1, 0) m/s, projection@rk4:h=1e-3, first step",
                            .printed = exact,
                            .factor = 1.01,
                            .note = "1/2 dv' M dv; a step was made before"};
    hn_figure_add(f, &lost, hn_run_get_summary(run).cost.energy_removed);
    hn_run_free(run);
    run = hn_motion_start(&m, "index1@rk4:h=1e-3");
    // a run whose loops stand open by half the length of 2 m ends; until then the gap is the time
    hn_figure_put(f, "gap after 0.9 s [m]", "fb0, J v = (1, 0) m/s, index1@rk4:h=1e-3", "0.900",
                  hn_motion_at(run, 0.9).gap);
    hn_run_free(run);
    hn_model_close(&m);
}

// ---- a library's default tolerances ----

static double rms(int n, const double *x, const double *scale) {
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] / scale[i] * (x[i] / scale[i]);
    }
    return sqrt(sum / n);
}

enum { NY = 2 * NV };

typedef struct controlled {
    const hn_stepper *stepper;
    void *self;
    hn_ode ode;
    double rtol, atol, t, h, y[NY];
} controlled;

static void scales(const controlled *c, const double *y, const double *z, double *scale) {
    for (int i = 0; i < NY; i++) {
        scale[i] = c->atol + c->rtol * fmax(fabs(y[i]), fabs(z[i]));
    }
}

/// The first step, after Hairer, Norsett & Wanner 1993, II.4.
static double first_step(controlled *c) {
    double f0[NY], f1[NY], y1[NY], scale[NY];
    scales(c, c->y, c->y, scale);
    assert_int_equal(c->ode.rhs(c->ode.self, 0, c->y, f0), HN_OK);
    const double d0 = rms(NY, c->y, scale), d1 = rms(NY, f0, scale), h0 = 0.01 * d0 / d1;
    memcpy(y1, c->y, sizeof y1);
    hn_axpy(NY, h0, f0, y1);
    assert_int_equal(c->ode.rhs(c->ode.self, h0, y1, f1), HN_OK);
    hn_axpy(NY, -1, f0, f1);
    const double d2 = rms(NY, f1, scale) / h0;
    return fmin(100 * h0, pow(0.01 / fmax(d1, d2), 0.2));
}

/// Steps to `end` as SciPy's solve_ivp does with RK45: errors by their rms, factors 0.2 to 10,
/// safety 0.9, exponent 1/5.
static void integrate(controlled *c, double end) {
    double y_new[NY], err[NY], scale[NY];
    c->h = first_step(c);
    while (c->t < end) {
        for (int rejected = 0;; rejected = 1) {
            const double h = fmin(c->h, end - c->t);
            c->stepper->on_accepted(c->self, 1);
            assert_int_equal(c->stepper->step(c->self, &c->ode, c->t, h, c->y, y_new, err), HN_OK);
            scales(c, c->y, y_new, scale);
            const double norm = rms(NY, err, scale);
            if (norm < 1) {
                double factor = norm == 0 ? 10 : fmin(10, 0.9 * pow(norm, -0.2));
                factor = rejected ? fmin(1, factor) : factor;
                c->t += h;
                c->h = h * factor;
                memcpy(c->y, y_new, sizeof y_new);
                break;
            }
            c->h = h * fmax(0.2, 0.9 * pow(norm, -0.2));
        }
    }
}

typedef struct ending {
    double gap, energy; ///< |phi| and change of energy at the end
} ending;

static ending library_default(const hn_model *m, double rtol, double atol, double t) {
    const hn_formulation *form = hn_formulation_find("index1");
    const double settings[HN_MAX_OPTIONS] = {0};
    hn_arena *arena = hn_arena_create(0);
    controlled c = {.stepper = hn_stepper_find("dopri5"), .rtol = rtol, .atol = atol};
    void *self = NULL;
    hn_diag diag = {0};
    hn_eval *e = NULL;
    assert_int_equal(form->create(m->sys, settings, arena, &self, &diag), HN_OK);
    assert_int_equal(form->set_state(self, 0, m->q, m->v, c.y), HN_OK);
    form->ode(self, &c.ode);
    c.self = c.stepper->create(c.ode.n_pos, c.ode.n_vel, arena);
    integrate(&c, t);
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_PHI | HN_TERM_ENERGY, arena, &e), HN_OK);
    hn_eval_run(e, t, c.y, c.y + NV);
    const double *energy = hn_eval_get(e, HN_TERM_ENERGY);
    const ending end = {hn_norm_max(NC, hn_eval_get(e, HN_TERM_PHI)),
                        energy[0] + energy[1] - m->assembly.energy};
    hn_eval_free(e);
    form->destroy(self);
    hn_arena_free(arena);
    return end;
}

static void default_tolerances(hn_figures *f) {
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    const ending coarse = library_default(&m, 1e-3, 1e-6, 10),
                 fine = library_default(&m, 1e-8, 1e-10, 10);
    hn_figure_put(
        f, "largest |phi_i| at the end [m]",
        "fb0, index 1 by dopri5 with SciPy's step control, rtol = 1e-3, atol = 1e-6, 10 s", "0.99",
        coarse.gap);
    hn_figure_put(
        f, "change of energy [J]",
        "fb0, index 1 by dopri5 with SciPy's step control, rtol = 1e-3, atol = 1e-6, 10 s", "-12",
        coarse.energy);
    hn_figure_put(
        f, "largest |phi_i| at the end [m]",
        "fb0, index 1 by dopri5 with SciPy's step control, rtol = 1e-8, atol = 1e-10, 10 s",
        "1.8e-6", fine.gap);
    hn_model_close(&m);
}

// ---- sizes and speeds ----

static double crank_at_one(double scale, const char *method) {
    hn_figure_links l = hn_figure_fb0();
    hn_model m;
    double *const lengths[] = {&l.l1, &l.l2, &l.l3, &l.d, &l.g};
    for (int i = 0; i < 5; i++) {
        *lengths[i] *= scale;
    }
    hn_figure_open_links(&m, &l);
    hn_run *run = hn_motion_start(&m, method);
    const double crank = hn_motion_at(run, 1).q[0];
    hn_run_free(run);
    hn_model_close(&m);
    return crank;
}

static void sizes(hn_figures *f) {
    static const struct {
        double scale;
        const char *how, *printed;
    } rows[] = {{1e-6, "fb0 in micrometres, index1@rk4:h=2e-3, 1 s", "2.726775244234155"},
                {1, "fb0, index1@rk4:h=2e-3, 1 s", "2.726775244234154"},
                {1e6, "fb0 in megametres, index1@rk4:h=2e-3, 1 s", "2.726775244234154"}};
    static const char *const more[] = {
        "projection@rk4:h=2e-3", "projection:weight=euclidean@rk4:h=2e-3", "nullspace@rk4:h=2e-3",
        "index3@rattle:h=2e-3", "ggl@radau5:h=2e-3"};
    for (int k = 0; k < 3; k++) {
        const hn_figure row = {.what = "th1 [rad]",
                               .how = rows[k].how,
                               .printed = rows[k].printed,
                               .units = 2,
                               .note = "rounding"};
        hn_figure_add(f, &row, crank_at_one(rows[k].scale, "index1@rk4:h=2e-3"));
    }
    for (size_t i = 0; i < sizeof more / sizeof *more; i++) {
        char how[120];
        const double metres = crank_at_one(1, more[i]);
        (void)snprintf(how, sizeof how, "fb0 in micrometres and in megametres, %s, 1 s", more[i]);
        hn_figure_put(f, "change of th1 by the size [rad]", how, "<1e-12",
                      fmax(fabs(crank_at_one(1e-6, more[i]) - metres),
                           fabs(crank_at_one(1e6, more[i]) - metres)));
    }
}

/// Change of the energy over the energy after 20 / w, with h w = 0.01, no gravity.
static double relative_error(double w) {
    hn_figure_links l = hn_figure_fb0();
    hn_model m;
    char method[64];
    l.g = 0;
    l.w1 = w;
    hn_figure_open_links(&m, &l);
    (void)snprintf(method, sizeof method, "index1@rk4:h=%.17g", 0.01 / w);
    hn_run *run = hn_motion_start(&m, method);
    const double found = hn_motion_at(run, 20 / w).energy_change / m.assembly.energy;
    hn_run_free(run);
    hn_model_close(&m);
    return found;
}

static void speeds(hn_figures *f) {
    static const char rounding[] = "the last digits are rounding of the energy";
    const hn_figure slow = {.what = "change of energy over the energy",
                            .how = "fb0, no gravity, w1 = 1 rad/s, index1@rk4:h=0.01, 20 s",
                            .printed = "4.39856598e-8",
                            .units = 1000,
                            .note = rounding},
                    fast = {.what = "change of energy over the energy",
                            .how = "fb0, no gravity, w1 = 1e4 rad/s, index1@rk4:h=1e-6, 2e-3 s",
                            .printed = "4.39856597e-8",
                            .units = 1000,
                            .note = rounding};
    hn_figure_add(f, &slow, relative_error(1));
    hn_figure_add(f, &fast, relative_error(1e4));
}

// ---- chaos, and what a lesson gets wrong ----

/// Mean rate at which two neighbouring motions part, set back to 1e-8 every half second.
static double lyapunov(const hn_model *m, double t) {
    const int n = m->info.nv;
    const double apart = 1e-8, span = 0.5;
    double q[2][8], v[2][8], sum = 0;
    assert_true(n <= 8);
    for (int k = 0; k < 2; k++) {
        memcpy(q[k], m->q, (size_t)n * sizeof(double));
        memcpy(v[k], m->v, (size_t)n * sizeof(double));
    }
    v[1][0] += apart;
    const int spans = (int)(t / span + 0.5);
    for (int i = 0; i < spans; i++) {
        double size = 0;
        for (int k = 0; k < 2; k++) {
            hn_run *run = hn_motion_start_at(m, "projection@rk4:h=1e-3", q[k], v[k]);
            const hn_sample s = hn_motion_at(run, span);
            memcpy(q[k], s.q, (size_t)n * sizeof(double));
            memcpy(v[k], s.v, (size_t)n * sizeof(double));
            hn_run_free(run);
        }
        for (int j = 0; j < n; j++) {
            size += (q[1][j] - q[0][j]) * (q[1][j] - q[0][j]) +
                    (v[1][j] - v[0][j]) * (v[1][j] - v[0][j]);
        }
        size = sqrt(size);
        sum += log(size / apart);
        for (int j = 0; j < n; j++) {
            q[1][j] = q[0][j] + (q[1][j] - q[0][j]) * apart / size;
            v[1][j] = v[0][j] + (v[1][j] - v[0][j]) * apart / size;
        }
    }
    return sum / t;
}

/// The four-bar with multiplier terms in the first two equations alone, by RK4: M a = f + P J'
/// lambda.
typedef struct masked {
    hn_eval *e;
} masked;

static hn_status masked_rhs(void *self, double t, const double *y, double *ydot) {
    const masked *s = self;
    double L[NV * NV], PJ[NC][NV], free_a[NV], S[NC * NC], lambda[NC];
    hn_eval_run(s->e, t, y, y + NV);
    const double *J = hn_eval_get(s->e, HN_TERM_J), *gamma = hn_eval_get(s->e, HN_TERM_GAMMA);
    memcpy(L, hn_eval_get(s->e, HN_TERM_M), sizeof L);
    memcpy(free_a, hn_eval_get(s->e, HN_TERM_F), sizeof free_a);
    memcpy(ydot, y + NV, NV * sizeof *ydot);
    if (hn_cholesky(NV, L, NV, 0) != HN_OK) {
        return HN_ERR_SINGULAR;
    }
    hn_cholesky_solve(NV, L, NV, free_a);
    for (int i = 0; i < NC; i++) {
        memcpy(PJ[i], J + (size_t)i * NV, sizeof PJ[i]);
        PJ[i][NV - 1] = 0;
        hn_cholesky_solve(NV, L, NV, PJ[i]);
    }
    for (int i = 0; i < NC; i++) {
        for (int j = 0; j < NC; j++) {
            S[i * NC + j] = hn_dot(NV, J + (size_t)i * NV, PJ[j]);
        }
        lambda[i] = -gamma[i] - hn_dot(NV, J + (size_t)i * NV, free_a);
    }
    const double det = S[0] * S[3] - S[1] * S[2];
    const double first = (lambda[0] * S[3] - lambda[1] * S[1]) / det,
                 second = (lambda[1] * S[0] - lambda[0] * S[2]) / det;
    for (int j = 0; j < NV; j++) {
        ydot[NV + j] = free_a[j] + first * PJ[0][j] + second * PJ[1][j];
    }
    return HN_OK;
}

/// Change of energy after 0.3 s, and when a speed passes 1e6 rad/s.
static void masked_multipliers(hn_figures *f) {
    hn_model m;
    masked s = {NULL};
    hn_eval *energy = NULL;
    hn_arena *arena = hn_arena_create(0);
    double y[NY], next[NY], err[NY], change = 0, lost = 0;
    const double h = 1e-4;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    assert_int_equal(
        hn_eval_create(m.sys, HN_TERM_M | HN_TERM_F | HN_TERM_J | HN_TERM_GAMMA, arena, &s.e),
        HN_OK);
    assert_int_equal(hn_eval_create(m.sys, HN_TERM_ENERGY, arena, &energy), HN_OK);
    const hn_ode ode = {.n_pos = NV, .n_vel = NV, .self = &s, .rhs = masked_rhs};
    const hn_stepper *rk4 = hn_stepper_find("rk4");
    void *self = rk4->create(NV, NV, arena);
    memcpy(y, m.q, NV * sizeof *y);
    memcpy(y + NV, m.v, NV * sizeof *y);
    for (int i = 1; i <= 20000 && lost == 0; i++) {
        const hn_status status = rk4->step(self, &ode, (i - 1) * h, h, y, next, err);
        rk4->on_accepted(self, 0);
        memcpy(y, next, sizeof y);
        if (status != HN_OK || !(hn_norm_max(NV, y + NV) < 1e6)) {
            lost = i * h;
        }
        if (i == 3000) {
            hn_eval_run(energy, 0, y, y + NV);
            change = hn_eval_get(energy, HN_TERM_ENERGY)[0] +
                     hn_eval_get(energy, HN_TERM_ENERGY)[1] - m.assembly.energy;
        }
    }
    hn_figure_put(f, "change of energy after 0.3 s [J]",
                  "fb0, multipliers left out of the third equation, rk4, h = 1e-4", "1.2", change);
    hn_figure_put(f, "it is lost at [s]",
                  "fb0, multipliers left out of the third equation, rk4, h = 1e-4", "0.92", lost);
    hn_eval_free(s.e);
    hn_eval_free(energy);
    hn_arena_free(arena);
    hn_model_close(&m);
}

void hn_figures_lesson(hn_figures *f) {
    hn_model m;
    hn_model_open_closed(&m, "four-angles-as-printed", NULL);
    hn_figure_put(f, "freedoms of the four angles", "four angles as printed", "2",
                  m.assembly.freedoms);
    const hn_figure rate = {.what = "rate at which neighbouring motions separate [1/s]",
                            .how = "four angles as printed, 30 s",
                            .printed = "1.05",
                            .factor = 1.5,
                            .note = "a mean over 30 s of one motion"};
    hn_figure_add(f, &rate, lyapunov(&m, 30));
    hn_model_close(&m);
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    hn_eval *e = NULL;
    assert_int_equal(hn_eval_create(m.sys, HN_TERM_M, m.arena, &e), HN_OK);
    hn_eval_run(e, 0, m.q, NULL);
    hn_figure_put(f, "coupling of crank and coupler, M12 [kg m^2]", "fb0", "1.75",
                  hn_eval_get(e, HN_TERM_M)[1]);
    hn_eval_free(e);
    hn_model_close(&m);
    masked_multipliers(f);
    default_tolerances(f);
}

void hn_figures_extremes(hn_figures *f) {
    wrong_speeds(f);
    sizes(f);
    speeds(f);
}
