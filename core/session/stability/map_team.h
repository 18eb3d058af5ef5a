// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_MAP_TEAM_H
#define HN_SESSION_STABILITY_MAP_TEAM_H
// The cells of a map tried by several threads. Each has a model and a motion of its own, loaded and
// computed like those of the map, so that a cell is the same bit for bit whoever tries it.

#include "session/stability/stability_internal.h"

#include <stdbool.h>

typedef struct hn_map_team hn_map_team;

/// Makes a team of the map's limits.threads. NULL where one thread is to do the work: no more are
/// asked for, the scene cannot be loaded again, a parameter is an axis and cells have scenes of
/// their own, or a method is a program.
hn_map_team *hn_map_team_create(hn_map *map);
void hn_map_team_free(hn_map_team *team); ///< NULL is legal

/// Tries n cells, numbers in map->cells. The calling thread keeps each as it is done and calls
/// `seen`. Returns false when the map must end; cells that were not done stay pending.
bool hn_map_team_try(hn_map_team *team, const int *cells, int n, void (*seen)(hn_map *map));
#endif
