// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_ERROR_ADVICE_H
#define HN_CLI_ERROR_ADVICE_H
// Advice of a run and of a comparison where the error is too large.

#include <cjson/cJSON.h>

/// Returns what is known of a smaller step (or tolerance) against the error of a run, as the end of
/// a sentence: "; ..." or "".
///
/// "does not help" for a counter-example, whose error lies in its equations; "may help" where a
/// smaller step of the same method was tried against an incident of the run and removed it, and no
/// such trial was in vain; "" where nothing was tried.
///
/// run        in  document of a run, or of one method of a comparison: "method"
/// incidents  in  list of incidents, NULL: none
/// method     in  number of the method in the list of a comparison; -1: the list is all of one run
const char *hn_error_advice(const cJSON *run, const cJSON *incidents, int method);
#endif
