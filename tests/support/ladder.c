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

// one step of the classical Runge-Kutta method; with these steps its error is below 1e-12 after 10 s
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

/// Largest distance of a tip from its exact place; *spread: of two tips from each other, as seen from their pivots.
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

static hn_ladder_end judge_wrong(const hn_run *run) {
    const hn_incident *incident = NULL;
    const int n = hn_run_incidents(run, &incident);
    for (int i = 0; i < n; i++) {
        switch (incident[i].code) {
        case HN_INCIDENT_BRANCH_FLIP:
        case HN_INCIDENT_GAP_OPEN:
        case HN_INCIDENT_ENERGY_JUMP:
        case HN_INCIDENT_STEP_LIMIT:
            return HN_LADDER_TOLD;
        default:
            break; // that a pose was near singular does not say that the run is wrong
        }
    }
    return HN_LADDER_SILENT;
}

hn_ladder_end hn_ladder_run(const hn_model *m, const hn_ladder_motion *motion, const char *method,
                            double *worst) {
    hn_run *run = hn_motion_start(m, method);
    hn_ladder_end end = HN_LADDER_SURVIVED;
    double largest = 0, spread = 0;
    for (int k = 1; k <= LOOKS && end == HN_LADDER_SURVIVED; k++) {
        hn_sample sample = {0};
        // the last look is a step early, so that the exact motion covers it
        const double t = motion->duration * (k - 0.5) / LOOKS;
        if (hn_run_advance(run, t) != HN_OK ||
            hn_run_sample(run, hn_run_time(run), &sample) != HN_OK) {
            end = HN_LADDER_STOPPED;
        } else {
            largest = fmax(largest, distance(m, motion, &sample, &spread));
        }
    }
    if (end == HN_LADDER_SURVIVED && !(largest <= MAX_DISTANCE)) {
        end = spread < FOLDED ? HN_LADDER_OFF : judge_wrong(run);
    }
    if (worst) {
        *worst = largest;
    }
    hn_run_free(run);
    return end;
}

double hn_ladder_step(int k, int n) {
    return 0.0022 + (0.02 - 0.0022) * k / (n - 1);
}
