// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_SPECTRUM_H
#define HN_STUDY_SPECTRUM_H
// What an integrator will meet at a state, before a step is taken: the spectrum of the motion on the loops.
//
//     N spans ker J, N'N = 1
//     (s^2 M_r + s C_r + K_r) x = 0,   M_r = N'M N,   C_r = N'C N,
//     K_r = N'((M a)_q - f_q - (J'lambda)_q) N    at fixed a and lambda, with both from the saddle system         (1)
//
// It is the spectrum on the loops that limits a step, not that of the free links: a stiff spring may be softened, or made
// stiffer, by what the loops allow.
// Source: Hairer and Wanner 1996, Solving Ordinary Differential Equations II, section IV.2, for the regions.

#include "base/arena.h"
#include "dynamics/compile/system.h"
#include "integrators/step/stepper.h"

typedef struct hn_eigenvalue {
    double re, im; ///< [1/s]
} hn_eigenvalue;

typedef struct hn_spectrum hn_spectrum;
/// Memory from `arena`, tapes owned by it (hn_spectrum_free). Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_spectrum_create(const hn_system *sys, hn_arena *arena,
                                           hn_spectrum **out);
void hn_spectrum_free(hn_spectrum *s); ///< NULL is legal
/// The 2 r eigenvalues at (t, q, v) in system coordinates, fastest (largest modulus) first; *n of them (borrowed until the next
/// call). Rows that always depend on others do no harm. Fails: HN_ERR_SINGULAR where M_r or J has lost rank, HN_ERR_DIVERGED
/// (an entry is not finite), HN_ERR_NO_CONVERGENCE; *n is then 0.
HN_MUST_CHECK hn_status hn_spectrum_calc(hn_spectrum *s, double t, const double *q, const double *v,
                                         const hn_eigenvalue **out, int *n);

// --- regions: what a step makes of an eigenvalue (stability_region.c) ---------------------------------------------------

/// |R(z)|: the largest growth factor of one step of the integrator on y' = s y at z = h s, found by stepping; for a partitioned
/// one, on x'' = -|s|^2 x + 2 re(s) x'. NaN: not an integrator with a region of its own, see hn_stability_why_not().
double hn_stability_growth(const hn_stepper *stepper, double z_re, double z_im);
/// Why it has none ("a multistep method: ..."), NULL when it has one.
const char *hn_stability_why_not(const hn_stepper *stepper);
/// The largest step h [s] at which no eigenvalue grows: the smallest over the eigenvalues of the first h on the ray where
/// |R(h s)| = 1. Growth of the motion itself is left out: eigenvalues with re > 0, but for oscillations that grow by less than a
/// tenth of their frequency (a stiff spring on links that turn), which count as undamped. In a partitioned integrator real
/// eigenvalues act in pairs, the fastest with the slowest, as those of an overdamped mode do. HUGE_VAL: no limit; 0: an
/// undamped oscillation grows at any step. NaN as above.
double hn_stability_limit(const hn_stepper *stepper, const hn_eigenvalue *s, int n);
/// The pair that Baumgarte's terms add on each row: roots of s^2 + 2 alpha s + beta^2 = 0.
void hn_stability_baumgarte(double alpha, double beta, hn_eigenvalue out[2]);
#endif
