// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_CONTROL_H
#define HN_INTEGRATORS_CONTROL_H
// Step size control of adaptive integrators: the error norm, the first step and the next one.
// Sources: Gustafsson 1991 (PI control); Hairer, Norsett & Wanner 1993, section II.4.

#include "base/status.h"
#include "formulations/ground/formulation.h"

#include <stdbool.h>

#define HN_STEP_SAFETY 0.9
#define HN_STEP_GROW 5.0
#define HN_STEP_SHRINK 0.2

/// The error that a step may make in each entry of y: atol unit_i + rtol size_i.
typedef struct hn_tolerance {
    double rtol, atol;
    const double *unit;   ///< of atol; NULL: all 1
    const bool *is_angle; ///< of the first n_pos entries; NULL: none is an angle
    int n_pos;
} hn_tolerance;

/// The tolerance of the state of an equation.
static inline hn_tolerance hn_tolerance_for(const hn_ode *ode, double rtol, double atol) {
    return (hn_tolerance){rtol, atol, ode->unit, ode->is_angle, ode->n_pos};
}

/// Returns the size of entry i that rtol refers to: |y|, and for an angle its distance from the
/// nearest whole turn, at most pi, so that a crank many turns ahead is computed as at the start.
/// This size is continuous in y, the same after any whole number of turns, and |y| itself up to pi;
/// where it is small atol decides, as it does near y = 0. It is not below the rounding of y over
/// rtol: no step can be more accurate.
double hn_tolerance_size(const hn_tolerance *tol, int i, double y);
/// Returns the error allowed in entry i on the way from y0 to y1: the larger of both sizes counts.
double hn_tolerance_of(const hn_tolerance *tol, int i, double y0, double y1);

/// Writes the whole turns of the angles in y and 0 elsewhere to `turns` (n): a library whose own
/// measures are relative to |y| gets y without them.
void hn_whole_turns(const hn_tolerance *tol, int n, const double *y, double *turns);

/// sqrt(mean((err_i / (atol unit_i + rtol size_i))^2)); accepted when <= 1. Infinite when an entry
/// is not finite, 0 for n = 0.
double hn_error_norm(int n, const double *err, const double *y0, const double *y1,
                     const hn_tolerance *tol);

/// Units of an absolute tolerance that the user did not choose, so that a mechanism of any size is
/// computed alike: atol of an entry is rtol times its unit.
///
/// A coordinate that is a length has the characteristic length L, any other 1. Velocities have the
/// unit of their coordinate times a rate w, the larger of the fastest velocity at the start and of
/// sqrt(g / L). L and w are powers of ten, and 1 between HN_UNIT_LENGTH_LEAST and
/// HN_UNIT_LENGTH_MOST [m], and HN_UNIT_RATE_LEAST and HN_UNIT_RATE_MOST [1/s]: there plain numbers
/// serve, which are easier to read.
///
/// is_chosen  in  the user chose atol: all units are 1
/// v          in  (nv) velocities at the start
/// unit       out (nq + nv)
void hn_tolerance_units(const hn_system *sys, bool is_chosen, const double *v, double *unit);
#define HN_UNIT_LENGTH_LEAST 1e-2
#define HN_UNIT_LENGTH_MOST 1e2
#define HN_UNIT_RATE_LEAST 1e-2
#define HN_UNIT_RATE_MOST 1e3

/// unit out (nv) of the coordinates of velocities: as above, those of angles are 1.
void hn_coordinate_units(const hn_system *sys, double *unit);

/// Units of the multipliers for such a tolerance: of a force [N], and of a moment [N m]. They are 1
/// from HN_UNIT_FORCE_LEAST on, and below it powers of ten of what gives the mechanism its rate w:
/// the largest M_jj (unit_j w)^2, over L for a force. `rate` is the unit of w, for what is a force
/// times a time.
///
/// M   in  (nv x nv) mass matrix at the start, or NULL: the user chose atol, and all units are 1
/// v   in  (nv) velocities at the start
typedef struct hn_force_units {
    double force, moment, rate;
} hn_force_units;
hn_force_units hn_tolerance_forces(const hn_system *sys, const double *M, const double *v);
#define HN_UNIT_FORCE_LEAST 1e-3

/// A PI controller; start from {.last = 1}.
typedef struct hn_step_control {
    double last;       ///< error norm of the last accepted step, not below 1e-4
    int just_rejected; ///< the step must not grow right after a rejection
} hn_step_control;

/// The factor for the next step size after an error norm `err` (accepted when err <= 1); k =
/// embedded order + 1.
double hn_step_factor(hn_step_control *control, double err, int k);

/// [rad], or of the characteristic length: the largest displacement of a coordinate in one step of
/// a mechanism without degrees of freedom. Its state is empty and its error 0, so the drive bounds
/// the step: about 25 steps in a turn of the fastest part show the motion and keep each position
/// solve near its prediction.
#define HN_DRIVE_STEP 0.25

/// Returns the largest displacement from q0 to q1 (nq each) over HN_DRIVE_STEP: an error norm for
/// steps of such a mechanism (accepted when <= 1, order 1).
double hn_drive_norm(const hn_system *sys, const double *q0, const double *q1);
/// Returns a first step size for velocities v (nv); 0 where everything is at rest.
double hn_drive_first_step(const hn_system *sys, const double *v);

/// A first step size from two right-hand sides: h such that an explicit Euler step and the change
/// of slope stay small. f0, work and work2 are (n) scratch. Fails with the right-hand side's
/// status.
HN_MUST_CHECK hn_status hn_first_step(const hn_ode *ode, double t, const double *y, int order,
                                      double rtol, double atol, double hmax, double *f0,
                                      double *work, double *work2, double *h);

#endif
