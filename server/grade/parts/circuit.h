// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_CIRCUIT_H
#define HN_GRADE_CIRCUIT_H
// The circuit of a mechanism with one degree of freedom: all configurations that it reaches from
// its start without being taken apart. They form a closed curve in the space of the coordinates,
// followed by steps along its tangent, each followed by a correction (pose_solver.h). Dead points
// of single coordinates are ordinary points of the curve. Source: Allgower & Georg 1990, ch. 2.

#include "session/model/model.h"

#include <stdbool.h>

enum { HN_CIRCUIT_COORDINATES = 32, HN_CIRCUIT_WHY = 200 };

typedef struct hn_circuit {
    int n;       ///< coordinates of the scene
    bool closed; ///< the start was reached again
    /// full turns that each coordinate made on the way round; 0 while not closed
    int turns[HN_CIRCUIT_COORDINATES];
    double least[HN_CIRCUIT_COORDINATES], most[HN_CIRCUIT_COORDINATES];
    int steps;
    char why[HN_CIRCUIT_WHY]; ///< not closed: the reason, in words
} hn_circuit;

/// Called at the start and after each step, with the coordinates of the scene and the points drawn.
typedef void hn_circuit_visit(void *user, const double *coordinates, const double *points);

/// Follows the circuit from the assembled start of the model, in steps of at most `stride` [rad, or
/// characteristic length]. `visit` may be NULL.
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT, HN_ERR_STOPPED (the model's interrupt). A mechanism with
/// another number of degrees of freedom, and one that comes to a singular configuration, give a
/// circuit that is not closed.
HN_MUST_CHECK hn_status hn_circuit_walk(const hn_model *model, double stride,
                                        hn_circuit_visit *visit, void *user, hn_circuit *out);
#endif
