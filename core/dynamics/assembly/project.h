// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_PROJECT_H
#define HN_DYNAMICS_PROJECT_H
// Projection of a state onto phi = 0 and J v + phi_t = 0, mass-weighted or Euclidean.
// Rank-deficient J is handled (minimum-norm), never NaN. Source: Eich 1993; Ascher, Chin & Reich
// 1994; Blajer 2002.
//
//     position   q <- q - W^-1 J' S^-1 phi(q),   S = J W^-1 J'                                (1)
//     velocity   v <- v - W^-1 J' S^-1 (J v + phi_t)                                          (2)
//
// W is M (mass-weighted) or the identity (Euclidean). Positions move along velocities
// (hn_system_move), so that quaternions stay unit. W and J of (1) are kept from the last
// factorisation. If one iteration reduces the gap by a factor below 1e4, they are evaluated and
// factorised again. (2) uses the factor at hand while it contracts. The factor is the sparse one of
// dynamics/evaluate/factor.h; where its pivots fail, the dense rank-revealing solve answers.

#include "base/arena.h"
#include "base/status.h"
#include "dynamics/compile/system.h"

/// The measure by which a projection makes the least change. Mass: weighted with M, which does not
/// depend on units and never adds kinetic energy to the velocities. Euclidean: of the system
/// coordinates as plain numbers, metres and radians alike; offered for comparison.
typedef enum hn_weight { HN_WEIGHT_MASS, HN_WEIGHT_EUCLIDEAN } hn_weight;

typedef struct hn_project_info {
    int iterations; ///< evaluations of phi (position) or of J v + phi_t (velocity)
    double gap_before, gap;
    double energy_removed; ///< 1/2 dv' M dv of the velocity part [J] (mass weight only, else 0)
    int rank;              ///< nc, or the numerical rank when the dense solve served
} hn_project_info;

typedef struct hn_projector hn_projector;
/// Memory from `arena`; the tapes are owned by the projector. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_projector_create(const hn_system *sys, hn_weight weight, hn_arena *arena,
                                            hn_projector **out);
void hn_projector_free(hn_projector *p); ///< NULL is legal

/// Corrects q in place until ||phi|| <= tol * hn_system_length(). 1e-13 is a good tol; 1e-15 asks
/// for all that rounding allows. A gap that stops shrinking is accepted
///   - below the rounding of q, 4 eps (1 + max |q_i|) lengths,
///   - where the correction is itself rounding (a long chain far from its origin),
///   - below 1e-6 lengths where J has lost rank: HN_OK with rank < nc.
/// info->gap says how much is left; `info` may be NULL. Allocates nothing.
/// Fails: HN_ERR_NO_CONVERGENCE after 8 evaluations, HN_ERR_DIVERGED. Then q is untouched.
HN_MUST_CHECK hn_status hn_project_position(hn_projector *p, double t, double *q, double tol,
                                            hn_project_info *info);
/// Corrects v in place so that J v + phi_t = 0 at q, to rounding; where rows depend on each other
/// they agree to 1e-12 of the velocities only. `info` may be NULL. Allocates nothing. Fails
/// likewise; v is then untouched.
HN_MUST_CHECK hn_status hn_project_velocity(hn_projector *p, double t, const double *q, double *v,
                                            hn_project_info *info);
/// Returns the evaluations so far, those of phi and of J v + phi_t together.
long long hn_projector_evals(const hn_projector *p);
/// Arithmetic operations so far (tape and linear algebra, counted).
double hn_projector_ops(const hn_projector *p);
/// Returns the factorisations so far.
long long hn_projector_factorisations(const hn_projector *p);
/// Returns how many of them were dense.
long long hn_projector_fallbacks(const hn_projector *p);
#endif
