#ifndef HN_DYNAMICS_ASSEMBLE_H
#define HN_DYNAMICS_ASSEMBLE_H
// Consistent starting values: position, then velocity, then acceleration and multipliers.
// Levenberg-Marquardt from the guess with pinned entries held, minimum-norm Newton near the end, homotopy and
// multi-start as fall-backs; an unreachable closure is explained, never accepted.
// Source: Wehage & Haug 1982; Nocedal & Wright 2006, ch. 10.

#include "base/diag.h"
#include "dynamics/system.h"

typedef struct hn_assembly {
    int ok;
    double gap_before, gap;       ///< ||phi|| at the guess and at the end [row units]
    double moved;                 ///< largest change of a user coordinate from its guess
    double velocity_gap_before, velocity_gap; ///< ||J v + phi_t||
    int rank;                     ///< rank of J at the assembled pose
    int freedoms;                 ///< nv - rank
    int redundant;                ///< nc - rank
    double sigma_min, sigma_max;  ///< of the mass-scaled J: smallest nonzero-by-rank, largest
    int mode;                     ///< assembly mode: sign of det J_d, +1 or -1, 0 unknown; per first loop
    const char *mode_name;        ///< "open", "crossed", "+", "-" ...: static text
    int iterations;
    const char *route;            ///< "already closed", "levenberg-marquardt", "homotopy", "multi-start": static text
    int worst_loop;               ///< loop with the largest residual when not ok, else -1
    double energy;                ///< T + V [J]
} hn_assembly;

/// Fills q (nq), v (nv), a (nv), lambda (nc) in system coordinates from the scene's start values. Pins are user
/// coordinates with q0_pinned / v0_pinned. `a` and `lambda` may be NULL. On HN_ERR_UNREACHABLE `report` is filled (gap, worst loop)
/// and `diags` say which loop, the gap in metres, the pins that are active, and the missing length where a dyad shows it.
/// Over-pinned velocities that contradict each other: HN_ERR_INCONSISTENT.
HN_MUST_CHECK hn_status hn_assemble(const hn_system *sys, double t, double *q, double *v, double *a, double *lambda,
                                    hn_assembly *report, hn_diags *diags);

/// Sign of the assembly mode at q (see hn_assembly.mode), for watching branch jumps; 0 when undefined.
int hn_assembly_mode(const hn_system *sys, double t, const double *q);
#endif
