// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_REFERENCE_H
#define HN_STUDY_REFERENCE_H
// A reference solution: what the motion of a scene is, by two computations that share nothing but
// the scene's equations, and how far these are apart. That difference is the reference's own error:
// no error below it is ever claimed.
//
// The first two of a fixed list that come to the end are taken. First stand the two in extended
// precision of study/truth/precise.h; then, in double, accelerations and multipliers together with
// projection by our Dormand-Prince 8; the equations on the null space of J by GSL's Prince-Dormand;
// the loops at position and speed level, with multipliers, by Radau IIA collocation.
//
// Numbers are stored as doubles, so the error of a coordinate is never called less than half a unit
// of its last place.

#include "study/run/walk.h"
#include "study/truth/errors.h"

#include <stdbool.h>

enum { HN_REF_TIMES = 32, HN_REF_MEANS = 2 };

typedef struct hn_ref {
    hn_arena *arena; ///< owns everything below
    uint64_t scene;  ///< hash of the scene with its parameters
    double T;        ///< end [s]
    int n;           ///< intervals: times T k / n, k = 0..n
    int n_user, nc;
    double *q, *v;                ///< (n + 1) x n_user, user coordinates
    double *lambda;               ///< (n + 1) x nc
    double *energy;               ///< n + 1 [J]
    double *between;              ///< (n + 1) x HN_ERROR_COUNT: how far the two are apart
    double error[HN_ERROR_COUNT]; ///< the largest of them
    hn_scales scales;
    char means[HN_REF_MEANS][HN_SPEC_MAX]; ///< the first is the one that is kept
    /// computations that did not come to the end, with their reasons; "" when none
    char refused[320];
} hn_ref;

typedef struct hn_ref_opts {
    int n;                 ///< intervals; 0: HN_REF_TIMES
    hn_walk_limits limits; ///< of each computation; those in extended precision get 0.4 of the time
    bool skip_precise;     ///< those in double alone
    void (*progress)(
        void *user,
        /// of both computations; falls where one did not come to the end. NULL: not told
        double share);
    void *user; ///< of `progress`
} hn_ref_opts;
hn_ref_opts hn_ref_opts_default(void);

/// From the assembled state (q, v) in system coordinates to T. Returns owned in *out. Fails:
/// HN_ERR_NO_CONVERGENCE when fewer than two computations come to the end, HN_ERR_STOPPED when
/// stopped on request; told in diag. HN_ERR_INPUT (T), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_ref_create(const hn_system *sys, const double *q, const double *v,
                                      double T, const hn_ref_opts *opts, hn_ref **out,
                                      hn_diag *diag);
/// An empty one of these sizes, to be filled from a file. NULL when memory is out.
hn_ref *hn_ref_blank(uint64_t scene, double T, int n, int n_user, int nc);
void hn_ref_free(hn_ref *ref); ///< NULL is legal
/// The state at time number k (borrowed).
hn_state_seen hn_ref_at(const hn_ref *ref, int k);
/// Digits of the coordinates that both computations share: -log10 of the error of q, at most 16.
double hn_ref_digits(const hn_ref *ref);
#endif
