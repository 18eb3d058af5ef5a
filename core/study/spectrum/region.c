// SPDX-License-Identifier: GPL-3.0-or-later
// Stability regions by trial: one step of length 1 of the integrator itself on a linear problem
// with the eigenvalue z. No formula of a stability function is used, so the result holds for the
// code that runs.
#include "study/spectrum/region.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define GROWS 1e-12         // |R| - 1 above rounding, where the step is explicit
#define GROWS_IMPLICIT 1e-8 // the same where Newton's method ends an iteration
#define SHARP 1e-7          // growth just beyond a limit that rounding does not blur
#define NEGLIGIBLE 1e-7     // of the fastest eigenvalue: zero
#define OSCILLATES 0.1      // re / |im| below which growth is the motion's turning
#define FIRST_Z 1e-4
#define FINE_Z 0.02   // spacing of trials up to COARSE_Z
#define COARSE_Z 25.0 // beyond it trials are a constant ratio apart
#define RATIO 1.1
#define LAST_Z 1e6

/// y' = A y with A = [a b; c d].
typedef struct linear_problem {
    double a, b, c, d;
} linear_problem;

typedef struct probe {
    const hn_stepper *stepper;
    void *self;
    hn_arena *arena;
    linear_problem problem;
    hn_ode ode;
    double grows; ///< |R| - 1 that is not rounding
} probe;

static hn_status slope(void *self, double t, const double *y, double *ydot) {
    const linear_problem *p = self;
    (void)t;
    ydot[0] = p->a * y[0] + p->b * y[1];
    ydot[1] = p->c * y[0] + p->d * y[1];
    return HN_OK;
}

static hn_status speed(void *self, double t, const double *y, double *pos_dot) {
    const linear_problem *p = self;
    (void)t;
    pos_dot[0] = p->a * y[0] + p->b * y[1];
    return HN_OK;
}

static hn_status matrix(void *self, double t, const double *y, double *jac) {
    const linear_problem *p = self;
    (void)t;
    (void)y;
    jac[0] = p->a;
    jac[1] = p->b;
    jac[2] = p->c;
    jac[3] = p->d;
    return HN_OK;
}

const char *hn_stability_why_not(const hn_stepper *stepper) {
    if (stepper->order == 0) {
        return "its steps are made by a program outside, of which nothing is known";
    }
    if (!stepper->create) {
        return "it solves differential-algebraic systems only, to which the test equation does not "
               "apply";
    }
    return stepper->step ? NULL
                         : "it chooses its own steps and order, so it has no limit of the step";
}

static bool open_probe(probe *p, const hn_stepper *stepper) {
    double settings[HN_MAX_OPTIONS] = {0};
    *p = (probe){.stepper = stepper};
    if (hn_stability_why_not(stepper)) {
        return false;
    }

    // a stepper for one position and one velocity, with its default options
    p->arena = hn_arena_create(0);
    p->self = p->arena ? stepper->create(1, 1, p->arena) : NULL;
    if (!p->self) {
        hn_arena_free(p->arena);
        return false;
    }
    for (int i = 0; i < stepper->n_options; i++) {
        settings[i] = stepper->options[i].initial;
    }
    if (stepper->configure) {
        stepper->configure(p->self, settings);
    }

    // the test equation
    p->ode = (hn_ode){.n_pos = 1,
                      .n_vel = 1,
                      .self = &p->problem,
                      .rhs = slope,
                      .kinematics = speed,
                      .jacobian = matrix};
    p->grows = isfinite(stepper->real_limit) ? GROWS : GROWS_IMPLICIT;
    return true;
}

static void close_probe(probe *p) {
    if (p->self && p->stepper->destroy) {
        p->stepper->destroy(p->self);
    }
    hn_arena_free(p->arena);
}

// one step of length 1 from (1, 0) or (0, 1); 0 when it fails or is not finite
static bool take_step(probe *p, int column, double y_new[2]) {
    double y[2] = {column == 0, column == 1}, err[2];
    p->stepper->on_accepted(p->self, 1);
    return p->stepper->step(p->self, &p->ode, 0, 1, y, y_new, err) == HN_OK && isfinite(y_new[0]) &&
           isfinite(y_new[1]);
}

// the larger of the moduli of the eigenvalues of [u v], columns; roots of w^2 - tr w + det
static double spectral_radius(const double u[2], const double v[2]) {
    const double half = (u[0] + v[1]) / 2, det = u[0] * v[1] - u[1] * v[0];
    const double disc = half * half - det;
    return disc < 0 ? sqrt(det) : fabs(half) + sqrt(disc);
}

// x'' = (z1 + z2) x' - z1 z2 x for a partitioned integrator; any other one meets z1 alone
static double growth(probe *p, const hn_eigenvalue *z1, const hn_eigenvalue *z2) {
    double u[2], v[2];
    if (!p->stepper->partitioned) {
        p->problem = (linear_problem){z1->re, -z1->im, z1->im, z1->re};
        return take_step(p, 0, u) ? hypot(u[0], u[1]) : HUGE_VAL;
    }
    const double sum = z1->re + z2->re, product = z1->re * z2->re - z1->im * z2->im;
    p->problem = (linear_problem){0, 1, -product, sum};
    return take_step(p, 0, u) && take_step(p, 1, v) ? spectral_radius(u, v) : HUGE_VAL;
}

static hn_eigenvalue conjugate(const hn_eigenvalue *s) {
    return (hn_eigenvalue){s->re, -s->im};
}

double hn_stability_growth(const hn_stepper *stepper, double z_re, double z_im) {
    const hn_eigenvalue z = {z_re, z_im}, partner = conjugate(&z);
    probe p;
    if (!open_probe(&p, stepper)) {
        return (double)NAN;
    }
    const double result = growth(&p, &z, &partner);
    close_probe(&p);
    return result;
}

static double growth_at(probe *p, double h, const hn_eigenvalue pair[2]) {
    const hn_eigenvalue z[2] = {{h * pair[0].re, h * pair[0].im}, {h * pair[1].re, h * pair[1].im}};
    return growth(p, &z[0], &z[1]) - 1;
}

static double next_trial(double z) {
    return z < FINE_Z ? 2 * z : z < COARSE_Z ? z + FINE_Z : RATIO * z;
}

// Bisects between h_below (no growth) and h_above (growth) down to the limit. Methods such as
// explicit Euler grow on the imaginary axis at any step, by a power of h that rounding hides near
// 0: there is no decay below the limit found, growth sets in gently, and their limit is 0.
static double refine(probe *p, const hn_eigenvalue pair[2], double h_below, double h_above) {
    for (int k = 0; k < 60 && h_above - h_below > 1e-13 * h_above; k++) {
        const double middle = (h_below + h_above) / 2;
        *(growth_at(p, middle, pair) > p->grows ? &h_above : &h_below) = middle;
    }
    const int decays =
        growth_at(p, 0.5 * h_below, pair)<-p->grows, sharp = growth_at(p, 1.1 * h_above, pair)>
            SHARP;
    return decays || sharp ? h_below : 0;
}

// returns the first h where the pair grows, or at_most
static double limit_of(probe *p, const hn_eigenvalue pair[2], double at_most) {
    const double modulus = hypot(pair[0].re, pair[0].im);
    double below = 0;
    for (double z = FIRST_Z; z <= LAST_Z && below / modulus < at_most; z = next_trial(z)) {
        if (growth_at(p, z / modulus, pair) > p->grows) {
            return fmin(at_most, below == 0 ? 0 : refine(p, pair, below / modulus, z / modulus));
        }
        below = z;
    }
    return at_most;
}

// the real eigenvalue number `so_many` from the slow end: in an overdamped mode it is the partner
// of a fast one
static hn_eigenvalue slow_partner(const hn_eigenvalue *s, int n, int so_many) {
    for (int i = n - 1; i >= 0; i--) {
        if (s[i].im == 0 && so_many-- == 0) {
            return (hn_eigenvalue){fmin(s[i].re, 0), 0};
        }
    }
    return (hn_eigenvalue){0, 0};
}

double hn_stability_limit(const hn_stepper *stepper, const hn_eigenvalue *s, int n) {
    double limit = HUGE_VAL, fastest = 0;
    int n_real = 0, place = 0;
    probe p;
    if (!open_probe(&p, stepper)) {
        return (double)NAN;
    }

    // scale of the spectrum
    for (int i = 0; i < n; i++) {
        fastest = fmax(fastest, hypot(s[i].re, s[i].im));
        n_real += s[i].im == 0;
    }

    // the smallest limit over all eigenvalues; in a partitioned integrator a fast real eigenvalue
    // acts together with a slow one
    for (int i = 0; i < n; i++) {
        const double modulus = hypot(s[i].re, s[i].im);
        const int is_real = s[i].im == 0, grows = s[i].re > OSCILLATES * fabs(s[i].im);
        const int is_slow = is_real && stepper->partitioned && 2 * place >= n_real;
        hn_eigenvalue pair[2] = {{fmin(s[i].re, 0), s[i].im}};
        pair[1] = is_real ? slow_partner(s, n, place) : conjugate(&pair[0]);
        place += is_real;

        if (grows || is_slow || s[i].im < 0 || !(modulus > NEGLIGIBLE * fastest)) {
            continue;
        }
        limit = limit_of(&p, pair, limit);
    }

    close_probe(&p);
    return limit;
}

void hn_stability_baumgarte(double alpha, double beta, hn_eigenvalue out[2]) {
    const double disc = alpha * alpha - beta * beta;
    if (disc < 0) {
        const double im = sqrt(-disc);
        out[0] = (hn_eigenvalue){-alpha, im};
        out[1] = (hn_eigenvalue){-alpha, -im};
        return;
    }
    // the larger root first, the other from the product: no digits lost
    const double fast = -(alpha + copysign(sqrt(disc), alpha));
    out[0] = (hn_eigenvalue){fast, 0};
    out[1] = (hn_eigenvalue){fast != 0 ? beta * beta / fast : 0, 0};
}
