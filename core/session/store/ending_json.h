// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_ENDING_JSON_H
#define HN_SESSION_ENDING_JSON_H
// The reason why a run ended early, as data: the same object in runs, comparisons, studies and on
// the command line.

#include "base/strbuf.h"
#include "study/run/ending.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

/// Puts the member "failure": null where there is no code, otherwise
/// {"code","quantity","value","limit","t","message","remedies":[...]}.
/// `message` is the sentence for people, `t` the time reached [s], NaN: none.
void hn_ending_put_json(hn_strbuf *b, const hn_ending *e, const char *message, double t);
/// Reads the member back. Returns false where it is not as it was written.
bool hn_ending_take_json(const cJSON *object, hn_ending *e);

#endif
