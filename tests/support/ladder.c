// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/ladder.h"

#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>

enum { LOOKS = 100, FINE = 10 };
#define GRAVITY 9.81
#define HALF_PI 1.57079632679489661923
#define MAX_DISTANCE 1e-2 // [m]
#define FOLDED 0.1        // [m]: tips this far from each other are not parallel any more

// one step of the classical Runge-Kutta method; with these steps its error is below 1e-12 after 10
// s
static void step_pendulum(double k, double h, double *b, double *w) {
    const double w1 = *w, a1 = k * sin(*b);
    const double w2 = *w + h / 2 * a1, a2 = k * sin(*b + h / 2 * w1);
    const double w3 = *w + h / 2 * a2, a3 = k * sin(*b + h / 2 * w2);
    const double w4 = *w + h * a3, a4 = k * sin(*b + h * w3);
    *b += h / 6 * (w1 + 2 * w2 + 2 * w3 + w4);
    *w += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
}

void hn_ladder_motion_fill(hn_ladder_motion *motion, int n_loops, double duration) {
    const double n = n_loops;
    const double k = GRAVITY * ((n + 1) / 2 + n) / ((n + 1) / 3 + n);
    double b = 0, w = 1;
    motion->n_loops = n_loops;
    motion->duration = duration;
    for (int i = 0; i <= HN_LADDER_GRID; i++) {
        motion->b[i] = b;
        motion->rate[i] = w;
        for (int j = 0; j < FINE; j++) {
            step_pendulum(k, duration / HN_LADDER_GRID / FINE, &b, &w);
        }
    }
}

double hn_ladder_motion_angle(const hn_ladder_motion *motion, double t) {
    const double h = motion->duration / HN_LADDER_GRID;
    const int i = (int)fmin(fmax(0, t / h), HN_LADDER_GRID - 1);
    const double s = t / h - i, r = 1 - s;
    return r * r * (1 + 2 * s) * motion->b[i] + s * s * (3 - 2 * s) * motion->b[i + 1] +
           h * (s * r * r * motion->rate[i] - s * s * r * motion->rate[i + 1]);
}

/// Largest distance of a tip from its exact place; *spread: of two tips from each other, as seen
/// from their pivots.
static double distance(const hn_model *m, const hn_ladder_motion *motion, const hn_sample *s,
                       double *spread) {
    const double th = HALF_PI - hn_ladder_motion_angle(motion, s->t);
    const double first = s->q[hn_model_user(m, "th0")];
    double worst = 0;
    for (int i = 0; i <= motion->n_loops; i++) {
        char name[16];
        snprintf(name, sizeof name, "th%d", i);
        const double at = s->q[hn_model_user(m, name)];
        worst = fmax(worst, 2 * fabs(sin((at - th) / 2)));
        *spread = fmax(*spread, 2 * fabs(sin((at - first) / 2)));
    }
    return worst;
}

typedef struct beside {
    const hn_model *model;
    const hn_ladder_motion *motion;
    double spread;
} beside;

static hn_survival_seen look(void *user, int k, const hn_sample *s) {
    beside *b = user;
    (void)k;
    const double off = distance(b->model, b->motion, s, &b->spread);
    return (hn_survival_seen){off, b->spread >= FOLDED};
}

hn_survival_end hn_ladder_run(const hn_model *m, const hn_ladder_motion *motion, const char *method,
                              double *worst) {
    beside b = {m, motion, 0};
    // every look is half an interval early, so that the exact motion covers the step behind the
    // last
    const hn_survival_judge judge = {.look = look,
                                     .user = &b,
                                     .T = motion->duration,
                                     .n = LOOKS,
                                     .before = 0.5,
                                     .at_steps = 1,
                                     .limit = MAX_DISTANCE};
    hn_run *run = hn_motion_start(m, method);
    hn_survival s;
    assert_true(hn_survival_try(run, &judge, &s));
    if (worst) {
        *worst = s.worst;
    }
    hn_run_free(run);
    return s.end;
}

double hn_ladder_step(int k, int n) {
    return 0.0022 + (0.02 - 0.0022) * k / (n - 1);
}

static double cost_per_loop(int n_loops, const char *method, double time, long long evals) {
    char setting[16];
    hn_model m;
    snprintf(setting, sizeof setting, "N=%d", n_loops);
    hn_model_open_closed(&m, "n-four-bar", setting);
    const hn_run_summary s = hn_motion_summary(&m, method, time);
    if (evals > 0) {
        assert_int_equal(s.cost.evals, evals);
    }
    assert_int_equal(s.cost.fallbacks, 0);
    hn_model_close(&m);
    return s.cost.ops / n_loops;
}

void hn_ladder_check_cost(const char *method, double time, long long evals) {
    const double few = cost_per_loop(10, method, time, evals);
    const double many = cost_per_loop(200, method, time, evals);
    if (!(many < 1.5 * few && many > few / 1.5)) {
        fail_msg("%s: %g operations a loop with 10 loops, %g with 200", method, few, many);
    }
}
