// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ASSEMBLE_H
#define HN_DYNAMICS_ASSEMBLE_H
// Computes consistent initial values: positions first, then velocities, then accelerations and
// multipliers.
//
// Positions are found by Levenberg-Marquardt from the guess, with the pinned coordinates held, and
// by minimum-norm Newton near the end. Homotopy and multi-start follow where that fails. Loops that
// cannot be closed are an error, with the reason; they are never left open.
// Source: Wehage & Haug 1982; Nocedal & Wright 2006, ch. 10.

#include "base/diag.h"
#include "dynamics/compile/system.h"

typedef struct hn_assembly {
    int ok; ///< 1: the loops are closed and the velocities fit them; 0: they are open
    double gap_before, gap; ///< ||phi|| at the guess and at the end [row units]
    double moved;           ///< largest change of a user coordinate from its guess
    double velocity_gap_before, velocity_gap; ///< ||J v + phi_t||
    int rank;                                 ///< rank of J at the assembled pose
    int freedoms;                             ///< degrees of freedom: nv - rank
    int redundant;                            ///< constraint equations that follow from the others
    /// singular values of J D, D = diag(M)^-1/2: the smallest of those that count for the rank, and
    /// the largest
    double sigma_min, sigma_max;
    int mode; ///< assembly mode of the first loop: +1 or -1, 0 unknown (see hn_mode_watch)
    const char *mode_name; ///< "open", "crossed" (four-bar), "+", "-", "none": static text
    char modes[64]; ///< of every loop, as scene.h spells it: "+", "-", 0 for unknown; the first 63
    int iterations;
    /// "already closed", "newton", "levenberg-marquardt", "homotopy", "multi-start", "mode search":
    /// static text
    const char *route;
    int worst_loop; ///< loop with the largest residual when not ok, else -1
    double energy;  ///< T + V [J]
} hn_assembly;

/// Computes a consistent state at time t from the scene's start values.
///
/// q (nq), v (nv), a (nv), lambda (nc) are in system coordinates. `a`, `lambda`, `report` and
/// `diags` may be NULL. Pinned coordinates and rates (q0_pinned, v0_pinned) keep their values; free
/// rates change as little as possible, weighted by mass. If the guess leads to another assembly
/// mode than the scene asks for, the loops in the wrong mode are closed again from other starting
/// points, with the pins held. Loops for which the scene gives no mode may have either.
///
/// Fails, with q and v as far as they were reached (else 0), a and lambda untouched:
///   HN_ERR_UNREACHABLE   a loop cannot be closed: `diags` name it, the gap, the pins, and the
///                        missing length of a polygon of links; or the assembly mode was not found:
///                        `diags` list those that were
///   HN_ERR_INCONSISTENT  pinned rates contradict each other
///   HN_ERR_UNSUPPORTED   a pin on a joint that closes a loop
///   HN_ERR_SINGULAR      (and the other failures of hn_accel_eval) no accelerations
///   HN_ERR_DIVERGED      the constraints are not finite at the start
///   HN_ERR_MEMORY
HN_MUST_CHECK hn_status hn_assemble(const hn_system *sys, double t, double *q, double *v, double *a,
                                    double *lambda, hn_assembly *report, hn_diags *diags);

#endif
