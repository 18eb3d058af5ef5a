// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_DRAWING_H
#define HN_DYNAMICS_DRAWING_H
// The drawing of a system: shapes between world points, each point an index into the points that
// HN_TERM_POINTS evaluates (x, y, z each). The page, the snapshot and the terminal draw from this
// list and from nothing else.

#include "base/strbuf.h"
#include "dynamics/compile/system.h"

typedef struct hn_drawing {
    int n_points;
    const char *const *labels; ///< n_points, NULL where none
    int n_shapes;
    const hn_shape *shapes; ///< p, q are indices of world points
    int n_tears;
    /// pairs of points that coincide when the loop is closed: the two halves of a cut joint, or the
    /// point of a constraint and where it should be
    const int (*tears)[2];
    const char *const *tear_names;
} hn_drawing;

/// Makes the drawing of a compiled system, with room for n_tears pairs of points that part.
HN_MUST_CHECK hn_status hn_system_make_drawing(hn_system *sys, int n_tears);
hn_drawing hn_system_drawing(const hn_system *sys); ///< borrowed
/// Writes {"points": n, "labels": [...], "shapes": [{"kind", "p", "q", "n", "width", "body"}],
/// "tears": [{"p", "q", "name"}]}.
void hn_drawing_json(hn_strbuf *b, const hn_system *sys);

#endif
