// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_STABILITY_AXES_H
#define HN_SESSION_STABILITY_STABILITY_AXES_H
// Reads the request of a map: axes from text or from a preset, methods, and how long a trial lasts.

#include "session/stability/stability.h"
#include "session/stability/stability_internal.h"

/// Returns preset i; NULL beyond the last.
const hn_job_preset *hn_map_preset_at(int i);
/// The request of the map that `map` chooses: its own with the preset, fewer points where it
/// names no number of them, and without methods that lack the options of the preset.
hn_job_request hn_map_request_for(const hn_map *map, const char *preset);
/// Axes, methods and time from the request.
HN_MUST_CHECK hn_status hn_map_set_up(hn_map *map, hn_diags *diags);
#endif
