// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_ERRORS_H
#define HN_STUDY_ERRORS_H
// The error of a state against the reference solution, in six numbers without units that are never
// mixed: closed is not correct, and correct positions do not promise correct reactions.
//
//     q             max |q - q_ref|, lengths over the scene's length L, angles as they are, never
//                   modulo a turn
//     v             max |v - v_ref|, length rates over L, all over the largest rate of the
//                   reference
//     reaction      |J'(lambda - lambda_ref)| over the largest |J' lambda_ref|, J at the reference:
//                   lambda alone is not determined where rows are redundant
//     gap           |phi| / L
//     velocity gap  |J v + phi_t| over L and the largest rate
//     energy        |E - E_ref| over (largest kinetic energy + range of the potential): work done
//                   from outside is in both

#include "base/arena.h"
#include "study/run/run.h"

#define HN_ERROR_LIST(X)                                               \
    X(HN_ERROR_Q, "q", "coordinates")                                  \
    X(HN_ERROR_V, "v", "rates")                                        \
    X(HN_ERROR_REACTION, "reaction", "reactions")                      \
    X(HN_ERROR_GAP, "gap", "loop gap")                                 \
    X(HN_ERROR_VELOCITY_GAP, "velocity_gap", "speed gap of the loops") \
    X(HN_ERROR_ENERGY, "energy", "energy")

typedef enum hn_error_kind {
#define HN_ERROR_ENUM(code, name, title) code,
    HN_ERROR_LIST(HN_ERROR_ENUM)
#undef HN_ERROR_ENUM
        HN_ERROR_COUNT
} hn_error_kind;
const char *hn_error_name(hn_error_kind kind);  ///< "q", as in JSON
const char *hn_error_title(hn_error_kind kind); ///< "coordinates", for people

/// The scales of errors.
typedef struct hn_scales {
    double length;   ///< L [m]
    double rate;     ///< largest |v| of the reference, length rates over L [1/s]
    double reaction; ///< largest |J' lambda| of the reference, forces times L [N m]
    double energy;   ///< [J]
} hn_scales;

/// A state to be compared, in user coordinates.
typedef struct hn_state_seen {
    double t;
    const double *q, *v, *lambda; ///< n_user, n_user, nc
    double energy, gap, velocity_gap;
} hn_state_seen;

/// Scratch and evaluators of one system; one per thread.
typedef struct hn_errors hn_errors;
/// Memory from `arena`. Not thread-safe for one system (see system.h). Fails: HN_ERR_MEMORY,
/// HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_errors_create(const hn_system *sys, hn_arena *arena, hn_errors **out);
void hn_errors_free(hn_errors *e); ///< NULL is legal
/// The six errors of a state; NaN where a state has no multipliers. Allocates nothing.
void hn_errors_calc(hn_errors *e, const hn_state_seen *state, const hn_state_seen *reference,
                    const hn_scales *scales, double out[HN_ERROR_COUNT]);
/// Largest |v| with length rates over L, and |J' lambda| with forces times L: what scales are made
/// of.
double hn_errors_rate(const hn_errors *e, const double *user_v);
double hn_errors_reaction(hn_errors *e, const hn_state_seen *at, const double *lambda);
/// Has the mechanism constraint rows? Without them there is nothing to be off.
bool hn_errors_has_reactions(const hn_errors *e);
/// Returns the least divisor of reactions [N m]: a thousandth of the weights times L, and 1e-7 of
/// what bodies at the largest rate of the motion, `rate`, would need. Loops that close without a
/// force have reactions of rounding, and these say nothing. 0 without bodies or rows.
double hn_errors_least_reaction(const hn_errors *e, double rate);
/// Largest difference of two states' coordinates as the error of q counts it, or of rates (over
/// `scales->rate`).
double hn_errors_between(hn_errors *e, const double *q, const double *other);
/// The coordinate in which hn_errors_calc() or hn_errors_between() found the largest difference,
/// the last time; NULL: there is none.
const hn_coordinate *hn_errors_worst_coordinate(const hn_errors *e);
/// A difference of that coordinate as the error of q counts it, in its own unit [rad or m].
double hn_errors_in_unit(const hn_errors *e, const hn_coordinate *coordinate, double error);
double hn_errors_between_rates(const hn_errors *e, const double *v, const double *other,
                               const hn_scales *scales);
#endif
