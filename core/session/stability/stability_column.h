// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_STABILITY_COLUMN_H
#define HN_SESSION_STABILITY_STABILITY_COLUMN_H
// One column of a map: the predicted boundary, the observed boundary, and whether they agree.

#include "session/stability/stability.h"
#include "session/stability/stability_internal.h"

#include <stdbool.h>

/// Whether the predicted limit of method m and the observed one agree, over all columns.
hn_map_agreement hn_map_agrees(const hn_map *map, int m);
/// "prediction within 5 % in 31 of 32 columns; 1: growth too slow to be seen"
void hn_map_agreement_text(hn_strbuf *b, const hn_map *map, int m);
/// The same of method m of the map of steps that chose this map, hn_map_steps(), after its name.
void hn_map_steps_text(hn_strbuf *b, const hn_map *map, int m);
/// Predicts the margins and the boundary of a column; its scenes must be loaded.
void hn_map_predict_column(hn_map *map, int m, int column);
/// Step axis: halves the interval between the last stable and the first other step.
/// Returns false when stopped.
bool hn_map_observe_column(hn_map *map, int m, int column);
/// Map of one column: finds the largest accurate step to HN_MAP_ACCURATE_WITHIN. Returns false when
/// stopped.
bool hn_map_observe_accuracy(hn_map *map, int m);
void hn_map_judge_column(hn_map *map, int m, int column);
#endif
