// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/near.h"
#include "support/reference.h"

#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// States that are known to many digits: the reference four-bar, Andrews' squeezer.

enum { KEPT = 6 };
static const char *const kept_names[KEPT] = {"th1 [rad]",  "th2 [rad]", "th3 [rad]",
                                             "w1 [rad/s]", "lam1 [N]",  "lam2 [N]"};

static void keep(const hn_sample *s, double x[KEPT]) {
    for (int i = 0; i < 3; i++) {
        x[i] = s->q[i];
    }
    x[3] = s->v[0];
    x[4] = s->lambda[0];
    x[5] = s->lambda[1];
}

static void state_at(const hn_model *m, const char *method, double t, double x[KEPT]) {
    hn_run *run = hn_motion_start(m, method);
    const hn_sample s = hn_motion_at(run, t);
    keep(&s, x);
    hn_run_free(run);
}

static const struct {
    double t;
    const char *printed[KEPT];
    double units;
    const char *note;
} states[] = {
    {0,
     {"1", "0.498324904142577", "1.516841745037813", "2", "0.921838074449043", "6.630912100630129"},
     5,
     "rounding"},
    {1,
     {"2.72677524435375", "0.43412079439446", "2.37837623328494", "4.16807616253500",
      "-0.87024247816248", "-4.59980302488838"},
     40,
     "rounding of two codes adds up: the angles are apart by up to 6e-14, the multipliers by more"},
    {2,
     {NULL, "0.4646903788896", "1.5617825877135", NULL, "-0.4306137880871", "6.9445833305829"},
     10,
     "the two computations behind the printed digits are 4e-13 apart"},
    {10,
     {"32.896786971", "0.402619599", "1.721426337", "1.073877967", "-2.21084468", "8.27521005"},
     3,
     "the printed digits were cut where their energy was off by 2e-11 J"},
};

/// Returns how far a pose of the four-bar is open [m].
static double opening(const hn_model *m, const double *q) {
    hn_eval *phi = NULL;
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_PHI, m->arena, &phi), HN_OK);
    hn_eval_run(phi, 0, q, NULL);
    const double open = hn_norm2(m->info.nc, hn_eval_get(phi, HN_TERM_PHI));
    hn_eval_free(phi);
    return open;
}

static void misprints(hn_figures *f, const hn_model *m, const double x[KEPT]) {
    const double printed[3] = {7.4113667966919, x[1], x[2]};
    char note[160];
    (void)snprintf(note, sizeof note,
                   "a misprint, with it the loop stands open by %.1e m, without by %.0e m",
                   opening(m, printed), opening(m, x));
    const hn_figure th1 = {.what = "th1 [rad]",
                           .how = "fb0, 2 s",
                           .printed = "7.4113667966919",
                           .instead = "7.4113667986921",
                           .units = 10,
                           .note = note},
                    w1 = {.what = "w1 [rad/s]",
                          .how = "fb0, 2 s",
                          .printed = "1.5715906085063",
                          .instead = "1.5714906085069",
                          .units = 20,
                          .note = "a misprint likewise, which two computations here agree on"};
    hn_figure_add(f, &th1, x[0]);
    hn_figure_add(f, &w1, x[3]);
}

/// Largest difference of two computations without common code.
static double two_means(const hn_model *m, double t) {
    double a[KEPT], b[KEPT], most = 0;
    state_at(m, "reduced@dop853:rtol=1e-13", t, a);
    state_at(m, "projection@rk4:h=1e-4", t, b);
    for (int i = 0; i < 3; i++) {
        most = fmax(most, fabs(a[i] - b[i]));
    }
    return most;
}

void hn_figures_reference(hn_figures *f) {
    hn_model m;
    hn_model_open_closed(&m, "fb0-lagrangian", NULL);
    static const hn_figure energy = {.what = "energy [J]",
                                     .how = "fb0",
                                     .printed = "49.34675722838445",
                                     .units = 3,
                                     .note = "rounding"};
    hn_figure_add(f, &energy, m.assembly.energy);
    for (size_t k = 0; k < sizeof states / sizeof *states; k++) {
        double x[KEPT];
        char how[64];
        state_at(&m, "projection@dop853:rtol=1e-13", states[k].t, x);
        (void)snprintf(how, sizeof how, "fb0, projection@dop853:rtol=1e-13, %g s", states[k].t);
        for (int i = 0; i < KEPT; i++) {
            if (states[k].printed[i]) {
                const hn_figure row = {.what = kept_names[i],
                                       .how = how,
                                       .printed = states[k].printed[i],
                                       .units = states[k].units,
                                       .note = states[k].note};
                hn_figure_add(f, &row, x[i]);
            }
        }
        if (states[k].t == 2) {
            misprints(f, &m, x);
        }
    }
    static const hn_figure apart[] = {
        {.what = "two computations, largest difference of an angle [rad]",
         .how = "fb0, reduced@dop853:rtol=1e-13 and projection@rk4:h=1e-4, 1 s",
         .printed = "1e-14",
         .factor = 10,
         .note = "rounding of two codes"},
        {.what = "two computations, largest difference of an angle [rad]",
         .how = "fb0, reduced@dop853:rtol=1e-13 and projection@rk4:h=1e-4, 2 s",
         .printed = "4e-13",
         .factor = 10,
         .note = "rounding of two codes"}};
    hn_figure_add(f, &apart[0], two_means(&m, 1));
    hn_figure_add(f, &apart[1], two_means(&m, 2));
    hn_model_close(&m);
}

void hn_figures_squeezer(hn_figures *f) {
    static const char *const names[7] = {"beta",  "Theta", "gamma",  "Phi",
                                         "delta", "Omega", "epsilon"};
    static const char *const end[7] = {
        "15.8107711951537",  "-15.7563710584118", "0.0408222401196458", "-0.534730116342080",
        "0.524409965879954", "0.534730116342080", "1.04808074104194"};
    const char *method = "projection@dop853:rtol=1e-13";
    hn_reference *r = hn_reference_open("andrews");
    const hn_reference_state start = hn_reference_run_to(r, "andrews", method, 0),
                             at_end = hn_reference_run_to(r, "andrews", method, 0.03);
    hn_reference_close(r);
    const char *at_start_how = "squeezer, 0 s",
               *note = "rounding of angles of 15 rad, and of speeds of 1e3 rad/s";
    hn_figure_put(f, "beta'' [rad/s^2]", at_start_how, "14222.4439199541",
                  start.x[HN_REFERENCE_A][0]);
    hn_figure_put(f, "Theta'' [rad/s^2]", at_start_how, "-10666.8329399656",
                  start.x[HN_REFERENCE_A][1]);
    hn_figure_put(f, "lambda 1", at_start_how, "98.5668703962411", start.x[HN_REFERENCE_LAMBDA][0]);
    hn_figure_put(f, "lambda 2", at_start_how, "-6.12268834425567",
                  start.x[HN_REFERENCE_LAMBDA][1]);
    for (int i = 0; i < 7; i++) {
        const hn_figure row = {.what = names[i],
                               .how = "squeezer, projection@dop853:rtol=1e-13, 0.03 s",
                               .printed = end[i],
                               .units = 200,
                               .note = note};
        hn_figure_add(f, &row, at_end.x[HN_REFERENCE_Q][i]);
    }
    const hn_figure v = {.what = "beta' [rad/s]",
                         .how = "squeezer, projection@dop853:rtol=1e-13, 0.03 s",
                         .printed = "1139.92030225910607",
                         .units = 2e6,
                         .note = note};
    hn_figure_add(f, &v, at_end.x[HN_REFERENCE_V][0]);
}
