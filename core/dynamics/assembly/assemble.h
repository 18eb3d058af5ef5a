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

/// Watches the assembly modes of the loops: of each the sign of -det J_d, with J_d the loop's rows
/// and the coordinates that depend on the others. Independent are the loop's actuated coordinates,
/// then its pinned ones, then the first ones, as many as it has freedoms; the dependent ones are
/// taken in the order of the ring. For a four-bar driven by th1 that is the sign of sin(th3 - th2):
/// open +, crossed -. It passes through 0 where the independent coordinates stop serving (dead
/// point); a change of sign without that is a branch jump.
typedef struct hn_mode_watch hn_mode_watch;
/// Memory from `arena`, the tape owned by the watch. A system without a first loop of that kind
/// gives a watch that says 0. Not thread-safe for one system (see system.h); hn_mode_watch_value()
/// is. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_mode_watch_create(const hn_system *sys, hn_arena *arena,
                                             hn_mode_watch **out);
void hn_mode_watch_free(hn_mode_watch *w); ///< NULL is legal
/// Of the first loop: -det J_d over the product of its column lengths, in [-1, 1]; 0 when
/// undefined. Allocates nothing.
double hn_mode_watch_value(hn_mode_watch *w, double t, const double *q);
/// The same of all loops (joints that close one; of formulas, sets of constraints on the same
/// coordinates): their number, and their values.
int hn_mode_watch_count(const hn_mode_watch *w);
void hn_mode_watch_values(hn_mode_watch *w, double t, const double *q, double *values);

/// The sign alone, once: makes and frees a watch, so for a look now and then; 0 when undefined.
int hn_assembly_mode(const hn_system *sys, double t, const double *q);
#endif
