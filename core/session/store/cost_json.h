// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_COST_JSON_H
#define HN_SESSION_COST_JSON_H
// Arithmetic operations as JSON: the same in runs, comparisons and studies.

#include "base/strbuf.h"
#include "formulations/ground/cost.h"

/// Puts the member `key`: the operations, or null where nobody counts them.
void hn_cost_put_ops_json(hn_strbuf *b, const char *key, const hn_cost *cost);
/// Puts the member `key`, the reason of that null. Puts nothing where the operations are counted.
void hn_cost_put_reason_json(hn_strbuf *b, const char *key, const hn_cost *cost);
#endif
