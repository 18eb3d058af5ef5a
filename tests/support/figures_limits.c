// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/list/stepper_list.h"
#include "support/figures_sets.h"

#include "support/near.h"
#include "support/odes.h"

#include <math.h>
#include <stdio.h>

// Limits of the steps, from the steps themselves: one step on x'' + 2 a x' + b^2 x = 0 with h = 1
// is a 2 x 2 matrix, and its spectral radius says what becomes of x.

static hn_arena *arena;

static double spectral_radius(const hn_stepper *s, double a, double b) {
    hn_test_oscillator o = {a, b, 0};
    const hn_ode ode = hn_test_oscillator_ode(&o);
    double m[2][2];
    for (int column = 0; column < 2; column++) {
        double y[2] = {column == 0, column == 1};
        assert_int_equal(hn_test_integrate(s, &ode, 1, 1, y, arena), HN_OK);
        m[0][column] = y[0];
        m[1][column] = y[1];
    }
    const double half = (m[0][0] + m[1][1]) / 2, det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    const double d = half * half - det;
    // roots that fall together leave 1e-8 of noise in the root of d
    return d > 0 ? fabs(half) + sqrt(d) : sqrt(fabs(det));
}

static double damped(const hn_stepper *s, double x) {
    return spectral_radius(s, x, x);
}

static double undamped(const hn_stepper *s, double x) {
    return spectral_radius(s, 0, x);
}

/// The first x where the radius passes 1, by steps of 1e-2 and halving.
static double limit_of(const hn_stepper *s, double (*radius)(const hn_stepper *, double),
                       double slack) {
    double low = 0.01;
    while (low < 20 && radius(s, low + 0.01) <= 1 + slack) {
        low += 0.01;
    }
    double high = low + 0.01;
    for (int i = 0; i < 30; i++) {
        const double x = (low + high) / 2;
        *(radius(s, x) <= 1 + slack ? &low : &high) = x;
    }
    return low;
}

/// Returns where the radius is least, between 0 and the limit.
static double fastest(const hn_stepper *s, double limit, double *radius) {
    double best = 0;
    *radius = 1;
    for (double x = 1e-3; x < limit; x += 1e-3) {
        const double r = damped(s, x);
        if (r < *radius) {
            *radius = r;
            best = x;
        }
    }
    return best;
}

static const struct {
    const char *name, *limit, *fastest, *radius, *imaginary; // NULL: not printed
} rows[] = {
    {"euler", "2", "1", "<1e-7", NULL},
    {"heun", "2", "1", "0.5", NULL},
    {"rk4", "2.785", "1.595", "0.2704", "2.828"},
    {"dopri5", "3.307", "2.03", "0.173", "0.997"},
    {"dop853", "6.394", "4.35", NULL, "5.960"},
    {"symplectic-euler", "0.828", NULL, NULL, "2"},
    {"verlet", NULL, NULL, NULL, "2"},
};

static void put(hn_figures *f, const char *what, const char *name, const char *printed,
                double found) {
    char how[64];
    snprintf(how, sizeof how, "gap of alpha = beta, %s", name);
    hn_figure_put(f, what, how, printed, found);
}

void hn_figures_limits(hn_figures *f) {
    arena = hn_arena_create(0);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const hn_stepper *s = hn_stepper_find(rows[k].name);
        const double limit = limit_of(s, damped, 1e-7);
        if (rows[k].limit) {
            put(f, "largest alpha h", rows[k].name, rows[k].limit, limit);
        }
        if (rows[k].fastest) {
            double radius;
            const double at = fastest(s, limit, &radius);
            put(f, "alpha h of fastest decay", rows[k].name, rows[k].fastest, at);
            if (rows[k].radius) {
                put(f, "factor per step there", rows[k].name, rows[k].radius, radius);
            }
        }
        if (rows[k].imaginary) {
            put(f, "largest w h without damping", rows[k].name, rows[k].imaginary,
                limit_of(s, undamped, 1e-9));
        }
    }
    static const hn_figure least = {.what = "factor per step at alpha h = 4.35",
                                    .how = "gap of alpha = beta, dop853",
                                    .printed = "1e-4",
                                    .units = 1,
                                    .note = "a single digit; it is 0 close by"};
    hn_figure_add(f, &least, damped(hn_stepper_find("dop853"), 4.35));
    const hn_stepper *s = hn_stepper_find("symplectic-euler");
    hn_figure_put(f, "factor per step at alpha h = 0.8283", "symplectic-euler", "<1",
                  damped(s, 0.8283));
    hn_figure_put(f, "factor per step at alpha h = 0.8285", "symplectic-euler", ">1",
                  damped(s, 0.8285));
    static const struct {
        double x;
        const char *wh, *grows;
    } beyond[] = {{1.2, "growth per step at w h = 1.2", "3e-4"},
                  {1.5, "growth per step at w h = 1.5", "3e-3"},
                  {2.0, "growth per step at w h = 2", "3e-2"},
                  {2.5, "growth per step at w h = 2.5", "0.15"}};
    for (int i = 0; i < 4; i++) {
        hn_figure_put(f, beyond[i].wh, "dopri5", beyond[i].grows,
                      undamped(hn_stepper_find("dopri5"), beyond[i].x) - 1);
    }
    hn_arena_free(arena);
    arena = NULL;
}
