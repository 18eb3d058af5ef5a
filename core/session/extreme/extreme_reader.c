// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_reader.h"

#include "base/suggest.h"
#include "session/extreme/extreme_model.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// where we are, what is wrong ----

void hn_xr_fault(hn_xr *r, const char *key, const char *hint, const char *format, ...) {
    char message[HN_DIAG_MESSAGE], pointer[HN_DIAG_POINTER];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    snprintf(pointer, sizeof pointer, "%s%s%s", r->path, key ? "/" : "", key ? key : "");
    r->status = hn_diags_add(r->diags, HN_ERR_INPUT, pointer, hint, "%s: %.400s", r->file, message);
}

size_t hn_xr_enter(hn_xr *r, const char *key, int index) {
    const size_t mark = strlen(r->path);
    if (index < 0) {
        snprintf(r->path + mark, sizeof r->path - mark, "/%s", key);
    } else {
        snprintf(r->path + mark, sizeof r->path - mark, "/%s/%d", key, index);
    }
    return mark;
}

void hn_xr_leave(hn_xr *r, size_t mark) {
    r->path[mark] = 0;
}

static int count(const char *const *names) {
    int n = 0;
    while (names[n]) {
        n++;
    }
    return n;
}

/// "did you mean 'x'?", or the list of what there is.
void hn_xr_suggest(char hint[HN_DIAG_HINT], const char *word, const char *const *names, int n) {
    hn_suggest_or_list(hint, word, names, n, "there is ");
}

/// Checks that `node` is an object and reports fields that are unknown or given twice.
/// Returns 1 for an object, else 0.
bool hn_xr_object(hn_xr *r, const cJSON *node, const char *const *fields) {
    if (!cJSON_IsObject(node)) {
        hn_xr_fault(r, NULL, NULL, "expected an object");
        return false;
    }

    // check every member
    const cJSON *m;
    cJSON_ArrayForEach(m, node) {
        int known = 0, again = 0;

        // whether it is known, and whether it came before
        for (int i = 0; fields[i]; i++) {
            known |= strcmp(fields[i], m->string) == 0;
        }
        for (const cJSON *o = node->child; o != m; o = o->next) {
            again |= strcmp(o->string, m->string) == 0;
        }

        // report what is wrong with it
        if (!known) {
            char hint[HN_DIAG_HINT] = "";
            hn_xr_suggest(hint, m->string, fields, count(fields));
            hn_xr_fault(r, m->string, hint, "there is no field '%.60s' here", m->string);
        } else if (again) {
            hn_xr_fault(r, m->string, NULL, "the field is given twice");
        }
    }
    return true;
}

// values ----

const cJSON *hn_xr_get(const cJSON *object, const char *key) {
    return cJSON_GetObjectItemCaseSensitive(object, key);
}

const char *hn_xr_keep(hn_xr *r, const char *text) {
    const char *copy = hn_arena_strdup(r->arena, text);
    r->status = copy ? r->status : HN_ERR_MEMORY;
    return copy ? copy : "";
}

const char *hn_xr_text(hn_xr *r, const cJSON *object, const char *key, bool required) {
    const cJSON *m = hn_xr_get(object, key);
    if (!m && !required) {
        return NULL;
    }
    if (!cJSON_IsString(m) || !m->valuestring[0] || strlen(m->valuestring) > HN_XR_TEXT) {
        hn_xr_fault(r, key, NULL, "expected a text of 1 to %d bytes", HN_XR_TEXT);
        return "";
    }
    return hn_xr_keep(r, m->valuestring);
}

double hn_xr_check_number(hn_xr *r, const cJSON *m, const char *key, double low, double high) {
    if (!cJSON_IsNumber(m) || !(m->valuedouble >= low && m->valuedouble <= high)) {
        hn_xr_fault(r, key, NULL, "expected a number from %g to %g", low, high);
        return low;
    }
    return m->valuedouble;
}

double hn_xr_number(hn_xr *r, const cJSON *object, const char *key, double low, double high,
                    double otherwise) {
    const cJSON *m = hn_xr_get(object, key);
    return m ? hn_xr_check_number(r, m, key, low, high) : otherwise;
}

bool hn_xr_flag(hn_xr *r, const cJSON *object, const char *key) {
    const cJSON *m = hn_xr_get(object, key);
    if (m && !cJSON_IsBool(m)) {
        hn_xr_fault(r, key, NULL, "expected true or false");
    }
    return cJSON_IsTrue(m);
}

/// Reads a number, or a formula in the swept name; checks that the formula has a value at the first
/// value of the sweep.
hn_extreme_number hn_xr_formula(hn_xr *r, const cJSON *m, const char *key,
                                const hn_extreme_trial *trial, double low, double high) {
    hn_extreme_number number = {0};
    if (!cJSON_IsString(m)) {
        number.value = hn_xr_check_number(r, m, key, low, high);
        return number;
    }
    number.formula = hn_xr_keep(r, m->valuestring);
    double value;
    hn_diags diags = {0};
    if (strlen(m->valuestring) > HN_XR_TEXT ||
        hn_extreme_value(&number, trial->sweep, trial->values[0], &value, &diags) != HN_OK) {
        hn_xr_fault(r, key, diags.n ? diags.item[0].hint : NULL, "%s",
                    diags.n ? diags.item[0].message : "the formula is too long");
    } else if (!(value >= low && value <= high)) {
        hn_xr_fault(r, key, NULL, "expected a number from %g to %g, the formula gives %g", low,
                    high, value);
    }
    return number;
}

int hn_xr_assigns(hn_xr *r, const cJSON *object, const char *key, const hn_extreme_trial *trial,
                  hn_extreme_assign *out) {
    const cJSON *node = hn_xr_get(object, key), *m;
    int n = 0;
    if (!node) {
        return 0;
    }
    const size_t mark = hn_xr_enter(r, key, -1);
    if (!cJSON_IsObject(node) || cJSON_GetArraySize(node) > HN_EXTREME_SETTINGS) {
        hn_xr_fault(r, NULL, NULL, "expected an object of at most %d names", HN_EXTREME_SETTINGS);
        hn_xr_leave(r, mark);
        return 0;
    }
    cJSON_ArrayForEach(m, node) {
        out[n].name = hn_xr_keep(r, m->string);
        out[n].number = hn_xr_formula(r, m, m->string, trial, -HN_XR_NUMBER, HN_XR_NUMBER);
        n++;
    }
    hn_xr_leave(r, mark);
    return n;
}

/// Reads one text under `one`, or a list of texts under `many`. Returns how many.
int hn_xr_texts(hn_xr *r, const cJSON *object, const char *one, const char *many,
                const char **out) {
    const cJSON *node = hn_xr_get(object, many), *m;
    int n = 0;

    // one text
    if (hn_xr_get(object, one)) {
        if (node) {
            hn_xr_fault(r, many, NULL, "'%s' is given too", one);
        }
        out[0] = hn_xr_text(r, object, one, 1);
        return 1;
    }

    // a list of texts, which may be absent
    if (!node) {
        return 0;
    }
    if (!cJSON_IsArray(node) || cJSON_GetArraySize(node) > HN_EXTREME_RUNS) {
        hn_xr_fault(r, many, NULL, "expected a list of at most %d texts", HN_EXTREME_RUNS);
        return 0;
    }

    cJSON_ArrayForEach(m, node) {
        if (!cJSON_IsString(m) || strlen(m->valuestring) > HN_XR_TEXT) {
            hn_xr_fault(r, many, NULL, "expected texts");
            return n;
        }
        out[n++] = hn_xr_keep(r, m->valuestring);
    }
    return n;
}
