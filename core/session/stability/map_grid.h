// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_MAP_GRID_H
#define HN_SESSION_STABILITY_MAP_GRID_H
// The grid of a stability map: cells and columns, the scene and the method of a cell, one trial.

#include "session/stability/stability_internal.h"

#include <stdbool.h>

/// The cell of method m at this column and row, and the column; both counted from 0.
hn_map_cell *hn_map_cell_at(const hn_map *map, int m, int column, int row);
hn_map_column *hn_map_column_at(const hn_map *map, int m, int column);
/// Returns the scene of a cell, with its motion if there is one; loads it on first use.
hn_map_scene *hn_map_scene_of(hn_map *map, int column, int row);
/// Returns the method of a cell, with `y` in place of the row's value.
hn_method_spec hn_map_spec_at(const hn_map *map, int m, int column, double y);
/// Returns whether asked to stop or out of time, and records which.
bool hn_map_must_end(hn_map *map);
/// Runs one trial within the limits of a cell; it stays pending, with the reason, where the motion
/// to compare with was cut short. Returns false when it was stopped.
bool hn_map_try(hn_map *map, hn_map_scene *scene, const hn_method_spec *spec,
                hn_stability_trial *out);
#endif
