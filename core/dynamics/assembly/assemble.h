#ifndef HN_DYNAMICS_ASSEMBLE_H
#define HN_DYNAMICS_ASSEMBLE_H
// Consistent starting values: position, then velocity, then acceleration and multipliers.
// Levenberg-Marquardt from the guess with pinned entries held, minimum-norm Newton near the end,
// homotopy and multi-start as fall-backs; an unreachable closure is explained, never accepted.
// Source: Wehage & Haug 1982; Nocedal & Wright 2006, ch. 10.

#include "base/diag.h"
#include "dynamics/compile/system.h"

typedef struct hn_assembly {
    int ok;
    double gap_before, gap; ///< ||phi|| at the guess and at the end [row units]
    double moved;           ///< largest change of a user coordinate from its guess
    double velocity_gap_before, velocity_gap; ///< ||J v + phi_t||
    int rank;                                 ///< rank of J at the assembled pose
    int freedoms;                             ///< nv - rank
    int redundant;                            ///< nc - rank
    double sigma_min, sigma_max; ///< of J D, D = diag(M)^-1/2: smallest nonzero-by-rank, largest
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

/// Fills q (nq), v (nv), a (nv), lambda (nc) in system coordinates from the scene's start values.
/// Pins are user coordinates with q0_pinned / v0_pinned; free rates change as little as possible,
/// weighted by mass. `a`, `lambda`, `report` and `diags` may be NULL. The assembly mode that the
/// scene asks for is searched for when the guess leads to another: loops in the wrong mode are
/// begun anew elsewhere, pins held. Fewer signs than loops: the rest may be either.
/// Fails: HN_ERR_UNREACHABLE: the mode asked for was not found (diags say which were), or `report`
/// is filled (gap, worst loop) and `diags` say which loop, the gap in metres, the pins that are
/// active, and the missing length where the free part of the loop is a chain of parallel revolute
/// joints. HN_ERR_INCONSISTENT: pinned rates contradict each other. HN_ERR_UNSUPPORTED: a pin on a
/// joint that closes a loop. HN_ERR_SINGULAR and the like: accelerations are not determined.
/// HN_ERR_DIVERGED: not finite at the start. HN_ERR_MEMORY. On failure q and v hold what was
/// reached, 0 where nothing was; a and lambda are untouched.
HN_MUST_CHECK hn_status hn_assemble(const hn_system *sys, double t, double *q, double *v, double *a,
                                    double *lambda, hn_assembly *report, hn_diags *diags);

#endif
