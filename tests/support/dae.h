// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_DAE_H
#define HN_SUPPORT_DAE_H
// Steppers of the differential-algebraic system driven straight through their table, step by step,
// without a run around them.

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "integrators/step/dae.h"
#include "integrators/step/stepper.h"
#include "support/model.h"

typedef struct hn_test_dae {
    const hn_model *model;
    const hn_dae_stepper *table;
    hn_arena *arena;
    void *self;
    double t, *y, *y_new, *err;
    long long steps;
    hn_accel *accel;
    hn_eval *terms;     ///< phi, J, phi_t, energies
    double *a, *lambda; ///< from the saddle system, by hn_test_dae_measure()
    double gap, speed_gap, energy;
} hn_test_dae;

/// A stepper on the model's assembled state. `options` is NULL or "rho=0.9 a0=zero"; names of
/// choices are understood. The formulation's options (hn_test_dae_open_as) are given likewise.
/// Failures stop the test with their reason.
void hn_test_dae_open(hn_test_dae *d, const hn_model *m, const hn_stepper *stepper,
                      hn_dae_form form, const char *options);
void hn_test_dae_open_as(hn_test_dae *d, const hn_model *m, const hn_stepper *stepper,
                         const hn_formulation *formulation, const char *formulation_options,
                         const char *options);
void hn_test_dae_close(hn_test_dae *d);
/// n steps of size h; returns the first failure.
hn_status hn_test_dae_steps(hn_test_dae *d, double h, long long n);
/// Accelerations, multipliers, gaps and energy at the state reached.
void hn_test_dae_measure(hn_test_dae *d);

/// Orders of q, v, lambda (recomputed) and raw lambda at time T from n halvings of h (fit over
/// all), errors taken against `fine`, a state (q, v) and multipliers at T.
typedef struct hn_test_orders {
    double q, v, lambda, raw;
    double err_q[8], err_v[8], err_lambda[8], err_raw[8];
    double worst_gap, worst_speed_gap; ///< at the end, over all step sizes
} hn_test_orders;
typedef struct hn_test_state {
    double q[32], v[32], lambda[32];
} hn_test_state;
/// The state at T by dop853 of a formulation without drift, rtol 1e-13.
void hn_test_reference(const hn_model *m, double T, hn_test_state *out);
hn_test_orders hn_test_dae_orders(const hn_model *m, const hn_stepper *stepper, hn_dae_form form,
                                  const char *options, double T, int base_steps, int n,
                                  const hn_test_state *exact);

#endif
