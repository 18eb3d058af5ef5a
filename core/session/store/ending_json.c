// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/store/ending_json.h"

#include "session/store/stored_json.h"

#include <math.h>
#include <stdio.h>

void hn_ending_put_json(hn_strbuf *b, const hn_ending *e, const char *message, double t) {
    hn_json_key(b, "failure");
    if (!e->code[0]) {
        hn_json_null(b);
        return;
    }
    hn_json_object(b);
    hn_json_put_string(b, "code", e->code);
    hn_json_put_string(b, "quantity", e->quantity[0] ? e->quantity : NULL);
    hn_json_put_number(b, "value", e->value);
    hn_json_put_number(b, "limit", e->limit);
    hn_json_put_number(b, "t", t);
    hn_json_put_string(b, "message", message);

    // what the engine would try
    hn_json_key(b, "remedies");
    hn_json_array(b);
    for (int i = 0; i < HN_REMEDIES && e->remedy[i][0]; i++) {
        hn_json_string(b, e->remedy[i]);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

bool hn_ending_take_json(const cJSON *object, hn_ending *e) {
    const cJSON *o = cJSON_GetObjectItemCaseSensitive(object, "failure"), *item;
    int n = 0;
    *e = hn_ending_named("");
    if (cJSON_IsNull(o)) {
        return true;
    }

    // an ending has its code; a quantity where an incident gave one
    const cJSON *quantity = cJSON_GetObjectItemCaseSensitive(o, "quantity");
    if (!hn_stored_text(o, "code", e->code, sizeof e->code) ||
        !hn_stored_number(o, "value", &e->value) || !hn_stored_number(o, "limit", &e->limit) ||
        !(cJSON_IsNull(quantity) ||
          hn_stored_text(o, "quantity", e->quantity, sizeof e->quantity))) {
        return false;
    }
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(o, "remedies")) {
        if (n == HN_REMEDIES || !cJSON_IsString(item)) {
            return false;
        }
        snprintf(e->remedy[n++], sizeof e->remedy[0], "%s", item->valuestring);
    }
    return true;
}
