// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/odes.h"

#include <math.h>
#include <string.h>

enum { MAX_N = 8 };

static hn_status oscillator_rhs(void *self, double t, const double *y, double *ydot) {
    hn_test_oscillator *o = self;
    (void)t;
    o->evals++;
    ydot[0] = y[1];
    ydot[1] = -2 * o->a * y[1] - o->b * o->b * y[0];
    return HN_OK;
}

static hn_status oscillator_kinematics(void *self, double t, const double *y, double *pos_dot) {
    (void)self;
    (void)t;
    pos_dot[0] = y[1];
    return HN_OK;
}

hn_ode hn_test_oscillator_ode(hn_test_oscillator *self) {
    return (hn_ode){.n_pos = 1,
                    .n_vel = 1,
                    .self = self,
                    .rhs = oscillator_rhs,
                    .kinematics = oscillator_kinematics};
}

static hn_status kepler_rhs(void *self, double t, const double *y, double *ydot) {
    (void)self;
    (void)t;
    const double r = hypot(y[0], y[1]), k = -1 / (r * r * r);
    ydot[0] = y[2];
    ydot[1] = y[3];
    ydot[2] = k * y[0];
    ydot[3] = k * y[1];
    return HN_OK;
}

static hn_status kepler_kinematics(void *self, double t, const double *y, double *pos_dot) {
    (void)self;
    (void)t;
    pos_dot[0] = y[2];
    pos_dot[1] = y[3];
    return HN_OK;
}

hn_ode hn_test_kepler_ode(void) {
    return (hn_ode){.n_pos = 2, .n_vel = 2, .rhs = kepler_rhs, .kinematics = kepler_kinematics};
}

void hn_test_kepler_exact(double e, double t, double y[4]) {
    double anomaly = t; // E - e sin E = t
    for (int i = 0; i < 60; i++) {
        anomaly -= (anomaly - e * sin(anomaly) - t) / (1 - e * cos(anomaly));
    }
    const double c = cos(anomaly), s = sin(anomaly), b = sqrt(1 - e * e), rate = 1 / (1 - e * c);
    y[0] = c - e;
    y[1] = b * s;
    y[2] = -s * rate;
    y[3] = b * c * rate;
}

hn_status hn_test_integrate(const hn_stepper *stepper, const hn_ode *ode, double T, int n,
                            double *y, hn_arena *arena) {
    double next[MAX_N], err[MAX_N];
    const int size = ode->n_pos + ode->n_vel;
    const double h = T / n;
    HN_ASSERT(size <= MAX_N);
    void *self = stepper->create(ode->n_pos, ode->n_vel, arena);
    if (!self) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < n; i++) {
        const hn_status status = stepper->step(self, ode, i * h, h, y, next, err);
        if (status != HN_OK) {
            return status;
        }
        stepper->on_accepted(self, 0);
        memcpy(y, next, (size_t)size * sizeof *y);
    }
    return HN_OK;
}

double hn_test_slope(int n, const double *x, const double *y) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int i = 0; i < n; i++) {
        const double a = log2(x[i]), b = log2(y[i]);
        sx += a;
        sy += b;
        sxx += a * a;
        sxy += a * b;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}
