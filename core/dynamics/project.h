#ifndef HN_DYNAMICS_PROJECT_H
#define HN_DYNAMICS_PROJECT_H
// Projection of a state onto phi = 0 and J v + phi_t = 0, mass-weighted or Euclidean. Rank-deficient J is handled
// (minimum-norm), never NaN. Source: Eich 1993; Ascher, Chin & Reich 1994; Blajer 2002.

#include "base/arena.h"
#include "dynamics/system.h"

typedef enum hn_weight { HN_WEIGHT_MASS, HN_WEIGHT_EUCLIDEAN } hn_weight;

typedef struct hn_project_info {
    int iterations;      ///< phi evaluations of the position part
    double gap_before, gap;
    double energy_removed; ///< 1/2 dv' M dv of the velocity part [J] (mass weight only, else 0)
    int rank;
} hn_project_info;

typedef struct hn_projector hn_projector;
HN_MUST_CHECK hn_status hn_projector_create(const hn_system *sys, hn_weight weight, hn_arena *arena, hn_projector **out);
void hn_projector_free(hn_projector *p);
/// q in place until ||phi|| <= tol * hn_system_length(): 1e-13 is a good tol. Frozen matrices, refactored when the contraction exceeds 0.1.
/// Fails: HN_ERR_NO_CONVERGENCE after 8 iterations, HN_ERR_DIVERGED. Then q is untouched.
HN_MUST_CHECK hn_status hn_project_position(hn_projector *p, double t, double *q, double tol, hn_project_info *info);
/// v in place so that J v + phi_t = 0 at q.
HN_MUST_CHECK hn_status hn_project_velocity(hn_projector *p, double t, const double *q, double *v, hn_project_info *info);
long long hn_projector_evals(const hn_projector *p); ///< evaluations of M, J, phi so far
double hn_projector_ops(const hn_projector *p);      ///< arithmetic operations so far (tape + linear algebra, counted)
#endif
