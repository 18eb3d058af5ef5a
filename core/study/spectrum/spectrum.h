// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_SPECTRUM_H
#define HN_STUDY_SPECTRUM_H
// The spectrum of the motion on the loops at one state: it decides which steps are stable, before
// any is taken.
//
//     N spans ker J, N'N = 1
//     (s^2 M_r + s C_r + K_r) x = 0,   M_r = N'M N,   C_r = N'C N,
//     K_r = N'((M a)_q - f_q - (J'lambda)_q) N    at the a and lambda of the saddle system  (1)
//
// The spectrum on the loops limits a step, not that of the free links: the loops can make a stiff
// spring act softer or stiffer.
// Source: Hairer and Wanner 1996, Solving Ordinary Differential Equations II, section IV.2, for the
// regions.

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
/// The 2 r eigenvalues at (t, q, v) in system coordinates, fastest (largest modulus) first; *n of
/// them (borrowed until the next call). Rows that always depend on others do no harm. Fails:
/// HN_ERR_SINGULAR where M_r or J has lost rank, HN_ERR_DIVERGED (an entry is not finite),
/// HN_ERR_NO_CONVERGENCE; *n is then 0.
HN_MUST_CHECK hn_status hn_spectrum_calc(hn_spectrum *s, double t, const double *q, const double *v,
                                         const hn_eigenvalue **out, int *n);
/// Writes the direction of motion x (nv) of one of the eigenvalues of the last calculation, with
/// x' M x = 1: of a damped mode, or of a vibration without its damping. Fails: HN_ERR_MEMORY,
/// HN_ERR_NO_CONVERGENCE.
HN_MUST_CHECK hn_status hn_spectrum_mode(hn_spectrum *s, hn_eigenvalue value, double *x);

#endif
