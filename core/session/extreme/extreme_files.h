// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_FILES_H
#define HN_SESSION_EXTREME_EXTREME_FILES_H
// The files of the extreme matrix: lessons/extreme/xNN-....json.

#include "session/extreme/extreme.h"

/// Reads lessons/extreme/ (one file a case, by number): all cases, or those named ("x4", in any
/// case). The library must outlive it. Every fault of the files is reported with the file's name
/// and a JSON pointer. Fails: HN_ERR_INPUT, HN_ERR_IO, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_extreme_load(const hn_library *lib, const char *const *ids, int n_ids,
                                        hn_extreme **out, hn_diags *diags);
void hn_extreme_free(hn_extreme *x); ///< NULL is legal
#endif
