// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_SLOW_FRAME_H
#define HN_HTTP_SLOW_FRAME_H
// Reports a frame that takes long while it is computed: a reader of the events otherwise sees
// nothing until it is complete, seconds later.

#include "session/compare/comparison.h"

#include <stdbool.h>

typedef struct hn_slow_frame {
    double used;  ///< computing time of the frame in progress, before the present piece [s]
    double begun; ///< start of the present piece, on the clock of the thread [s]
    double told;  ///< the last report, wall clock; 0: none since the start [s]
} hn_slow_frame;

/// Begins the next piece of a frame; it is a frame's first unless the last piece was interrupted.
void hn_slow_frame_begin(hn_slow_frame *slow);
/// Ends a piece: the frame is complete, or goes on later.
void hn_slow_frame_end(hn_slow_frame *slow, bool is_whole);
/// Returns whether a report is due: the frame has taken a quarter of a second of computing and a
/// method is slower than the clock. At most one is due in a second. Writes its members "frame",
/// "method", "slowness" [-], "computed_s", "detail" and "hint".
///
/// speed  in  simulated seconds per second of the clock
/// On the thread that computes the comparison.
bool hn_slow_frame_report(hn_slow_frame *slow, const hn_comparison *c, double speed, hn_strbuf *b);
#endif
