// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/job/field.h"

#include "base/suggest.h"
#include "integrators/method/method_spec.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FIELDS = 24, MAX_MEMBERS = 5000 };

/// Returns how many rows a table has before the row without a name.
static int count_fields(const hn_field *fields) {
    int n = 0;
    while (fields[n].name) {
        n++;
    }
    return n;
}

const hn_field *hn_fields_find(const hn_field *fields, const char *name) {
    for (; fields->name; fields++) {
        if (strcmp(fields->name, name) == 0) {
            return fields;
        }
    }
    return NULL;
}

/// JSON pointer of a member; '~' and '/' of the name are escaped as RFC 6901 has it.
static void member_pointer(char out[HN_DIAG_POINTER], const char *parent, const char *name) {
    int n = snprintf(out, HN_DIAG_POINTER, "%s/", parent);
    size_t at = n > 0 && n < HN_DIAG_POINTER ? (size_t)n : HN_DIAG_POINTER - 1;
    for (; *name && at + 3 < HN_DIAG_POINTER; name++) {
        if (*name == '~' || *name == '/') {
            out[at++] = '~';
            out[at++] = *name == '~' ? '0' : '1';
        } else {
            out[at++] = *name;
        }
    }
    out[at] = 0;
}

static const char *type_words(const hn_field *f) {
    // the wording completes "it must be ..."
    switch (f->type) {
    case HN_FIELD_SCENE:
        return "the id of a shipped scene or a scene object";
    case HN_FIELD_BY_NAME:
        return "an object of numbers";
    case HN_FIELD_NUMBER:
        return "a number";
    case HN_FIELD_INTEGER:
        return "a whole number";
    case HN_FIELD_BOOL:
        return "true or false";

    // strings, of which a choice is one
    case HN_FIELD_TEXT:
    case HN_FIELD_CHOICE:
        return "a string";

    // lists and objects
    case HN_FIELD_TEXTS:
        return "an array of strings";
    case HN_FIELD_NUMBERS:
        return "an array of numbers";
    case HN_FIELD_RECORD:
        return "an object";
    case HN_FIELD_ANY:
        break;
    }

    // no type is asked for
    return "any value";
}

/// Returns true if every member is a number (or string).
static bool all_are(const cJSON *list, bool (*is)(const cJSON *)) {
    const cJSON *item;
    cJSON_ArrayForEach(item, list) {
        if (!is(item)) {
            return false;
        }
    }
    return true;
}

static bool is_number(const cJSON *item) {
    return cJSON_IsNumber(item);
}

static bool is_text(const cJSON *item) {
    return cJSON_IsString(item);
}

static bool has_type(const cJSON *value, const hn_field *f) {
    // objects and what may stand for one
    switch (f->type) {
    case HN_FIELD_SCENE:
        return cJSON_IsString(value) || cJSON_IsObject(value);
    case HN_FIELD_BY_NAME:
        return cJSON_IsObject(value) && all_are(value, is_number);

    // numbers and truth values
    case HN_FIELD_NUMBER:
        return cJSON_IsNumber(value);
    case HN_FIELD_INTEGER:
        return cJSON_IsNumber(value) && value->valuedouble == floor(value->valuedouble);
    case HN_FIELD_BOOL:
        return cJSON_IsBool(value);

    // strings, of which a choice is one
    case HN_FIELD_TEXT:
    case HN_FIELD_CHOICE:
        return cJSON_IsString(value);

    // lists and records
    case HN_FIELD_TEXTS:
        return cJSON_IsArray(value) && all_are(value, is_text);
    case HN_FIELD_NUMBERS:
        return cJSON_IsArray(value) && all_are(value, is_number);
    case HN_FIELD_RECORD:
        return cJSON_IsObject(value);
    case HN_FIELD_ANY:
        break;
    }

    // any value will do
    return true;
}

static hn_status check_choice(const char *text, const hn_field *f, const char *pointer,
                              hn_diags *diags) {
    int n = 0;
    for (; f->choices[n]; n++) {
        if (strcmp(f->choices[n], text) == 0) {
            return HN_OK;
        }
    }
    char hint[HN_DIAG_HINT];
    hn_suggest_or_list(hint, text, f->choices, n, "one of: ");
    return hn_diags_add(diags, HN_ERR_INPUT, pointer, hint, "'%.60s' is not offered for '%s'", text,
                        f->name);
}

static hn_status check_range(const cJSON *value, const hn_field *f, const char *pointer,
                             bool served, hn_diags *diags) {
    const bool counted = cJSON_IsArray(value);
    const double x = counted ? cJSON_GetArraySize(value) : value->valuedouble;
    const double max = served && f->served_max > 0 ? f->served_max : f->max;
    if ((f->min == 0 && max == 0) || (x >= f->min && x <= max)) {
        return HN_OK;
    }
    return hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL,
                        counted ? "'%s' has %g entries; %g to %g are allowed"
                                : "'%s' is %g; %g to %g are allowed",
                        f->name, x, f->min, max);
}

static int compare_names(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/// Reports a name that an object has twice.
static hn_status check_names(const cJSON *object, const char *pointer, hn_diags *diags) {
    const int n = cJSON_GetArraySize(object);
    const char **names = calloc((size_t)n + 1, sizeof *names);
    hn_status status = names ? HN_OK : HN_ERR_MEMORY;
    int i = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, object) {
        if (names) {
            names[i++] = item->string;
        }
    }

    // equal names are neighbours
    if (i > 0) {
        qsort(names, (size_t)i, sizeof *names, compare_names);
    }
    for (int k = 1; k < i && status == HN_OK; k++) {
        if (strcmp(names[k], names[k - 1]) == 0) {
            char place[HN_DIAG_POINTER];
            member_pointer(place, pointer, names[k]);
            status = hn_diags_add(diags, HN_ERR_INPUT, place, NULL, "'%.60s' is written twice",
                                  names[k]);
        }
    }
    free(names);
    return status;
}

/// The same of every object in a value.
static hn_status check_all_names(const cJSON *value, const char *pointer, hn_diags *diags) {
    hn_status status = cJSON_IsObject(value) ? check_names(value, pointer, diags) : HN_OK;
    int index = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, value) {
        if (status == HN_OK && (cJSON_IsObject(item) || cJSON_IsArray(item))) {
            char place[HN_DIAG_POINTER], number[16];
            snprintf(number, sizeof number, "%d", index);
            member_pointer(place, pointer, item->string ? item->string : number);
            status = check_all_names(item, place, diags);
        }
        index++;
    }
    return status;
}

/// Checks that a text, or each of a list, spells a method.
static hn_status check_spelling(const cJSON *value, const char *pointer, hn_diags *diags) {
    hn_status status = HN_OK;
    if (cJSON_IsString(value)) {
        hn_method_spec spec;
        hn_diag diag = {0};
        status = hn_method_parse(value->valuestring, &spec, &diag);
        return status == HN_OK
                   ? HN_OK
                   : hn_diags_add(diags, status, pointer, diag.hint, "%s", diag.message);
    }
    int index = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, value) {
        char place[HN_DIAG_POINTER], number[16];
        snprintf(number, sizeof number, "%d", index++);
        member_pointer(place, pointer, number);
        const hn_status one = check_spelling(item, place, diags);
        status = one != HN_OK ? one : status;
    }
    return status;
}

/// Names what stands where something else is expected.
static void describe(const cJSON *value, char *out, size_t size) {
    if (cJSON_IsString(value)) {
        snprintf(out, size, "the text '%.40s'", value->valuestring);
    } else if (cJSON_IsNumber(value)) {
        snprintf(out, size, "%.17g", value->valuedouble);
    } else {
        snprintf(out, size, "%s",
                 cJSON_IsArray(value)    ? "an array"
                 : cJSON_IsObject(value) ? "an object"
                 : cJSON_IsTrue(value)   ? "true"
                 : cJSON_IsFalse(value)  ? "false"
                                         : "null");
    }
}

/// Reports the members of an object or array that are not numbers (or strings), up to the first of
/// an array; returns whether there was one.
static bool refuse_members(const cJSON *value, const hn_field *f, const char *pointer,
                           hn_diags *diags) {
    const bool texts = f->type == HN_FIELD_TEXTS;
    bool found = false;
    int index = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, value) {
        char place[HN_DIAG_POINTER], number[16], word[64];
        snprintf(number, sizeof number, "%d", index++);
        if (texts ? cJSON_IsString(item) : cJSON_IsNumber(item)) {
            continue;
        }
        describe(item, word, sizeof word);
        member_pointer(place, pointer, item->string ? item->string : number);
        if (item->string) {
            hn_diags_add(diags, HN_ERR_INPUT, place, NULL, "'%.60s' is %s; it must be a number",
                         item->string, word);
        } else if (!found) {
            hn_diags_add(diags, HN_ERR_INPUT, place, NULL,
                         "entry %d of '%s' is %s; it must be a %s", index, f->name, word,
                         texts ? "string" : "number");
        }
        found = true;
    }
    return found;
}

/// Reports a value of the wrong type: what it is, and what it must be.
static hn_status refuse_type(const cJSON *value, const hn_field *f, const char *pointer,
                             hn_diags *diags) {
    const bool has_members =
        f->type == HN_FIELD_BY_NAME
            ? cJSON_IsObject(value)
            : (f->type == HN_FIELD_TEXTS || f->type == HN_FIELD_NUMBERS) && cJSON_IsArray(value);
    if (has_members && refuse_members(value, f, pointer, diags)) {
        return HN_ERR_INPUT;
    }
    char word[64];
    describe(value, word, sizeof word);
    return hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL, "'%s' is %s; it must be %s", f->name,
                        word, type_words(f));
}

static hn_status check_member(const cJSON *value, const hn_field *f, const char *pointer,
                              bool served, hn_diags *diags) {
    if (!has_type(value, f)) {
        return refuse_type(value, f, pointer, diags);
    }
    if (cJSON_IsNumber(value) || cJSON_IsArray(value)) {
        HN_TRY(check_range(value, f, pointer, served, diags));
    }
    if (f->is_method && served) {
        return check_spelling(value, pointer, diags);
    }
    if (f->type == HN_FIELD_BY_NAME && cJSON_GetArraySize(value) > MAX_MEMBERS) {
        return hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL,
                            "'%s' has %d members; at most %d are read", f->name,
                            cJSON_GetArraySize(value), MAX_MEMBERS);
    }
    if (f->type == HN_FIELD_CHOICE) {
        return check_choice(value->valuestring, f, pointer, diags);
    }
    if (f->type == HN_FIELD_BY_NAME || f->type == HN_FIELD_ANY) {
        return check_all_names(value, pointer, diags);
    }
    return f->type == HN_FIELD_RECORD ? hn_fields_check(value, f->record, pointer, served, diags)
                                      : HN_OK;
}

static hn_status report_unknown(const char *name, const hn_field *fields, const char *pointer,
                                hn_diags *diags) {
    const char *names[MAX_FIELDS];
    int n = count_fields(fields);
    HN_ASSERT(n <= MAX_FIELDS);
    for (int i = 0; i < n; i++) {
        names[i] = fields[i].name;
    }
    char hint[HN_DIAG_HINT];
    hn_suggest_or_list(hint, name, names, n, "fields: ");
    return hn_diags_add(diags, HN_ERR_INPUT, pointer, hint, "there is no field '%.60s' here", name);
}

/// Checks one member of the object; `seen` has a bit for each field that came before.
static hn_status check_one(const cJSON *item, const hn_field *fields, const char *parent,
                           bool served, uint32_t *seen, hn_diags *diags) {
    char pointer[HN_DIAG_POINTER];
    const hn_field *f = hn_fields_find(fields, item->string);
    member_pointer(pointer, parent, item->string);
    if (!f || (served && f->served_max < 0)) {
        return report_unknown(item->string, fields, pointer, diags);
    }
    const uint32_t bit = UINT32_C(1) << (f - fields);
    if (*seen & bit) {
        return hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL, "'%s' is written twice", f->name);
    }
    *seen |= bit;
    return check_member(item, f, pointer, served, diags);
}

hn_status hn_fields_check(const cJSON *object, const hn_field *fields, const char *parent,
                          bool served, hn_diags *diags) {
    HN_ASSERT(count_fields(fields) <= MAX_FIELDS);
    uint32_t seen = 0;
    hn_status status = HN_OK;
    const cJSON *item;

    // every member is known, written once, and of its type
    cJSON_ArrayForEach(item, object) {
        const hn_status one = check_one(item, fields, parent, served, &seen, diags);
        status = one != HN_OK ? one : status;
        // no further checks once the list of faults is full
        if (diags->found >= HN_DIAG_MAX) {
            return status;
        }
    }

    // every required field is there
    for (const hn_field *f = fields; f->name; f++) {
        if (f->required && !(seen & UINT32_C(1) << (f - fields))) {
            char pointer[HN_DIAG_POINTER];
            member_pointer(pointer, parent, f->name);
            status = hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL, "'%s' is missing: %s",
                                  f->name, f->about);
        }
    }
    return status;
}

double hn_fields_number(const cJSON *object, const char *name, double otherwise) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    return cJSON_IsNumber(item) ? item->valuedouble : otherwise;
}

const char *hn_fields_text(const cJSON *object, const char *name) {
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, name));
}
