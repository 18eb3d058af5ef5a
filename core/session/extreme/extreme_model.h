// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_MODEL_H
#define HN_SESSION_EXTREME_EXTREME_MODEL_H
// The scene of a point and where its runs start: settings filled in from the sweep, states off the
// loops by a stated amount.

#include "session/extreme/extreme_internal.h"

/// Value of a number at a point; HN_ERR_INPUT (reported in diags) where a formula has none.
HN_MUST_CHECK hn_status hn_extreme_value(const hn_extreme_number *number, const char *name,
                                         double value, double *out, hn_diags *diags);
/// The method's spelling with its {formulas} filled in.
HN_MUST_CHECK hn_status hn_extreme_spell(const hn_extreme_point *point, char out[256],
                                         hn_diags *diags);
/// (q, v) where the point's runs start, system coordinates, from arena; HN_ERR_INPUT,
/// HN_ERR_MEMORY, HN_ERR_SINGULAR.
HN_MUST_CHECK hn_status hn_extreme_start(hn_extreme_bench *bench, const hn_model *model,
                                         const hn_extreme_trial *trial, hn_arena *arena, double **q,
                                         double **v);
/// The model of the point, borrowed from the bench until the next call; NULL with
/// bench->load_status and diags.
const hn_model *hn_extreme_model(hn_extreme_bench *bench, const hn_extreme_point *point);
/// Unloads the model.
void hn_extreme_bench_clear(hn_extreme_bench *bench);
#endif
