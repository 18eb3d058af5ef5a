// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_FAILURE_H
#define HN_SESSION_FAILURE_H
// The reason why a run ended early, as data: the same object in runs, comparisons, studies
// and on the command line.

#include "base/strbuf.h"
#include "study/run/run.h"

/// Puts the member "failure": null where `ended` is HN_OK, otherwise
/// {"code","quantity","value","limit","t","message","remedies":[...]}.
///
/// If an incident ended the run, code and figures are those of the incident. Otherwise code is the
/// name of the status, and quantity, value and limit are null. `reason` is the sentence for people,
/// `t` the time reached [s].
void hn_failure_put_json(hn_strbuf *b, const hn_run *run, hn_status ended, const char *reason,
                         double t);
#endif
