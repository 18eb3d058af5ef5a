// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_BEST_SCORES_H
#define HN_TUI_BEST_SCORES_H
// The best score of each exercise, kept between sessions as the page keeps it in its browser: in
// holonom/lessons.json of the user's folder for state (XDG_STATE_HOME, else ~/.local/state), as
// {"solved": {"p3": {"score": 7, "most": 8}}}. Nothing else depends on this file.

#include "base/diag.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

/// Reads the file. Returns it owned; NULL: there is none, or it cannot be read.
cJSON *hn_best_scores_load(void);
/// The best score of an exercise among those loaded (NULL is legal); false: none.
bool hn_best_scores_find(const cJSON *scores, const char *exercise, double *score, double *most);
/// Keeps a score that is not below the one that is kept. Fails: HN_ERR_IO (no folder, not
/// writable), HN_ERR_INPUT (the file there is not one of scores, and stays as it is),
/// HN_ERR_MEMORY; diag names the file.
HN_MUST_CHECK hn_status hn_best_scores_keep(const char *exercise, double score, double most,
                                            hn_diag *diag);
#endif
