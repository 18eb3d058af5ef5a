// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_SUGGEST_H
#define HN_BASE_SUGGEST_H
// Hints for a word that is none of the known names: "did you mean 'revolute'?".

#include "base/diag.h"

/// Writes "did you mean 'NAME'?" with the name nearest to `word` (hn_nearest_name()); where none is
/// near, `otherwise` (NULL: nothing). Returns `hint`.
const char *hn_suggest(char hint[HN_DIAG_HINT], const char *word, const char *const *names, int n,
                       const char *otherwise);
/// The same; where none is near, `before` and all names, as "fields: a, b, c", cut at the room.
const char *hn_suggest_or_list(char hint[HN_DIAG_HINT], const char *word, const char *const *names,
                               int n, const char *before);

#endif
