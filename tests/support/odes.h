// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_ODES_H
#define HN_SUPPORT_ODES_H
// Motions known in closed form, as right-hand sides for steppers, and a plain fixed-step loop.

#include "integrators/step/stepper.h"

/// x'' + 2 a x' + b^2 x = 0; y = (x, x'). evals counts right-hand sides.
typedef struct hn_test_oscillator {
    double a, b;
    int evals;
} hn_test_oscillator;
hn_ode hn_test_oscillator_ode(hn_test_oscillator *self);

/// A planet about a sun of strength 1, eccentricity e, semi-axis 1, from perihelion; y = (x, z, x',
/// z').
hn_ode hn_test_kepler_ode(void);
void hn_test_kepler_exact(double e, double t, double y[4]);

/// n equal steps from t = 0 to T; y in place. Memory from `arena`.
hn_status hn_test_integrate(const hn_stepper *stepper, const hn_ode *ode, double T, int n,
                            double *y, hn_arena *arena);

/// Slope of the least-squares line through (log2 x_i, log2 y_i).
double hn_test_slope(int n, const double *x, const double *y);

#endif
