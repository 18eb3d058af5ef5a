// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_MINIMAL_TAPE_H
#define HN_FORMULATIONS_MINIMAL_TAPE_H
// Closing the loops in minimal coordinates by one tape (dynamics/evaluate/reduced_tape.h): from the
// tangent prediction each run makes one step of Newton's method and evaluates everything at the
// configuration that it leads to. In steps of ordinary length the first run is enough. What the
// tape cannot answer surely (a small pivot, the other assembly mode, a far prediction, slow
// convergence) is left to chart.h.

#include "dynamics/evaluate/reduced_tape.h"
#include "formulations/chart/chart.h"

#include <stdbool.h>

typedef struct hn_minimal_tape {
    hn_reduced_tape *tape; ///< NULL: there is none
    bool was_made;         ///< there was an attempt to compile it
    bool serves;           ///< it was made for the present choice of coordinates
    double unit;           ///< det J_d counts in it: the product of the scales of its columns
    // the state that the last run closed
    bool valid;
    double t, gap;
    double *y, *q, *predicted; ///< 2 r, nq, nq
} hn_minimal_tape;

/// Compiles the tape when it is called first, for the choice of coordinates of `chart`, whose point
/// `here` is closed; later calls see whether it is for the present choice. The first call adds
/// nodes to the system's graph. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_minimal_tape_begin(hn_minimal_tape *w, const hn_chart *chart,
                                              hn_arena *arena);
void hn_minimal_tape_free(hn_minimal_tape *w);
/// Closes the loops at y = (q_i, u) to `tol` as hn_chart_close() does. Returns false where the tape
/// does not serve there; of the chart only the cost has then changed. Allocates nothing.
bool hn_minimal_tape_close(hn_minimal_tape *w, hn_chart *chart, double t, const double *y,
                           double tol);
/// Writes u' (r) at the state closed last. Returns false where it is not finite.
bool hn_minimal_tape_get_accelerations(const hn_minimal_tape *w, double *u_dot);
/// Makes the state closed last the point `here` of the chart. It has no factor of J_d.
void hn_minimal_tape_put(const hn_minimal_tape *w, hn_chart *chart);

#endif
