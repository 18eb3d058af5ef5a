// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/store/stored_json.h"

#include "base/file.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { MOST_BYTES = 256 << 20 };

char *hn_stored_text_of(FILE *f, size_t *n) {
    if (fseek(f, 0, SEEK_END) != 0) {
        return NULL;
    }
    const long size = ftell(f);
    rewind(f);
    char *text = size >= 0 && size <= MOST_BYTES ? malloc((size_t)size + 1) : NULL;
    if (text) {
        *n = fread(text, 1, (size_t)size, f);
        text[*n] = 0;
    }
    return text;
}

cJSON *hn_stored_open(const char *path) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    const bool was_read = hn_file_read(path, MOST_BYTES, &text, NULL) == HN_OK;
    cJSON *object = was_read ? cJSON_Parse(hn_strbuf_text(&text)) : NULL;
    hn_strbuf_reset(&text);
    return object;
}

bool hn_stored_numbers(const cJSON *object, const char *key, double *out, size_t n) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, key), *item;
    if (!cJSON_IsArray(list) || (size_t)cJSON_GetArraySize(list) != n) {
        return false;
    }
    size_t i = 0;
    cJSON_ArrayForEach(item, list) {
        if (!cJSON_IsNumber(item) && !cJSON_IsNull(item)) {
            return false;
        }
        out[i++] = cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
    }
    return true;
}

bool hn_stored_number(const cJSON *object, const char *key, double *out) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    *out = cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
    return cJSON_IsNumber(item) || cJSON_IsNull(item);
}

bool hn_stored_int(const cJSON *object, const char *key, int below, int *out) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    const int fits = cJSON_IsNumber(item) && item->valuedouble == item->valueint &&
                     item->valueint >= 0 && item->valueint < below;
    *out = fits ? item->valueint : 0;
    return fits;
}

bool hn_stored_text(const cJSON *object, const char *key, char *out, size_t size) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));
    return text && (size_t)snprintf(out, size, "%s", text) < size;
}
