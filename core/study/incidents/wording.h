// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_WORDING_H
#define HN_STUDY_WORDING_H
// Messages of incidents behind the time of the incident.

#include <stdbool.h>
#include <stddef.h>

/// Rewrites a message about a step that failed after the time t that the run has reached [s]:
/// "a2 = -1.4 at t = 6.55 s: no ..." becomes "in the step to t = 6.55 s with a2 = -1.4: no ...".
/// Returns false, with out unchanged, where the message does not begin so.
bool hn_wording_of_step(double t, const char *message, char *out, size_t size);
/// Writes a message that stands behind "1.72 s: " for its time t [s]: a step that failed is said as
/// above, and "at t = 1.72 s " is not said again.
void hn_wording_behind_time(double t, const char *message, char *out, size_t size);
#endif
