// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/store/cost_json.h"

#include <math.h>

static const char UNKNOWN[] =
    "an external program computes the accelerations, and its operations are not counted";

void hn_cost_put_ops_json(hn_strbuf *b, const char *key, const hn_cost *cost) {
    hn_json_put_number(b, key, hn_cost_known_ops(cost));
}

void hn_cost_put_reason_json(hn_strbuf *b, const char *key, const hn_cost *cost) {
    if (isnan(hn_cost_known_ops(cost))) {
        hn_json_put_string(b, key, UNKNOWN);
    }
}
