// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/blank.h"

#include <string.h>

cJSON *hn_blank_text(const hn_part *p) {
    (void)p;
    return cJSON_CreateString("");
}

cJSON *hn_blank_number(const hn_part *p) {
    (void)p;
    return cJSON_CreateNull();
}

/// A copy of the shape with blank leaves.
static cJSON *make_shape(const cJSON *shape, bool text) {
    if (!cJSON_IsArray(shape)) {
        return text ? cJSON_CreateString("") : cJSON_CreateNull();
    }
    cJSON *list = cJSON_CreateArray();
    const cJSON *m;
    cJSON_ArrayForEach(m, shape) {
        cJSON_AddItemToArray(list, make_shape(m, text));
    }
    return list;
}

cJSON *hn_blank_texts(const hn_part *p) {
    return make_shape(cJSON_GetObjectItemCaseSensitive(p->node, "answer"), true);
}

cJSON *hn_blank_numbers(const hn_part *p) {
    return make_shape(cJSON_GetObjectItemCaseSensitive(p->node, "answer"), false);
}

cJSON *hn_blank_names(const hn_part *p) {
    static const struct {
        const char *member;
        bool list;
    } ROWS[] = {{"asked", false}, {"free", false}, {"numbers", false}, {"given", true}};
    cJSON *out = cJSON_CreateObject();
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
        const cJSON *m;
        cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->node, ROWS[i].member)) {
            if (cJSON_IsString(m)) {
                cJSON_AddItemToObject(out, m->valuestring,
                                      ROWS[i].list ? cJSON_CreateArray() : cJSON_CreateNull());
            }
        }
    }
    return out;
}

bool hn_blank_is(const cJSON *given) {
    const char *text = cJSON_GetStringValue(given);
    const cJSON *m;
    if (!given || cJSON_IsNull(given)) {
        return true;
    }
    if (text) {
        return !text[strspn(text, " \t\r\n")];
    }
    if (!cJSON_IsArray(given) && !cJSON_IsObject(given)) {
        return false;
    }
    cJSON_ArrayForEach(m, given) {
        if (!hn_blank_is(m)) {
            return false;
        }
    }
    return true;
}
