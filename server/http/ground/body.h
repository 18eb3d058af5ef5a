// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_BODY_H
#define HN_HTTP_BODY_H
// The JSON body of a request. Each route names the fields it takes in one table; the same table
// checks the body (every fault with its pointer) and writes the schema of the OpenAPI document.

#include "base/diag.h"

#include <cjson/cJSON.h>

typedef enum hn_field_type {
    HN_FIELD_SCENE,   ///< a shipped scene's id, or a scene object
    HN_FIELD_BY_NAME, ///< an object of numbers: {"l1": 1.2}
    HN_FIELD_NUMBER,
    HN_FIELD_INTEGER,
    HN_FIELD_BOOL,
    HN_FIELD_TEXT,
    HN_FIELD_TEXTS,   ///< an array of strings, min..max of them
    HN_FIELD_NUMBERS, ///< an array of numbers, min..max of them
    HN_FIELD_CHOICE,  ///< one of `choices`
    HN_FIELD_RECORD,  ///< an object with the fields of `record`
    HN_FIELD_ANY
} hn_field_type;

typedef struct hn_field {
    const char *name;
    hn_field_type type;
    int required;
    double min, max;            ///< of a number, or how many entries; both 0: any finite number
    const char *const *choices; ///< ends with NULL
    const struct hn_field *record;
    const char *about;
} hn_field;

/// Checks the members of an object against its fields, in one pass.
///
/// Reports what is unknown (with a near miss), written twice, missing, of a wrong type or out of
/// range; stops at the first HN_DIAG_MAX faults. `fields` ends with a row without a name; `parent`
/// is the pointer of `object` ("" at the top). Fails: HN_ERR_INPUT.
/// Cost: members times fields, whatever they are called.
HN_MUST_CHECK hn_status hn_body_check(const cJSON *object, const hn_field *fields,
                                      const char *parent, hn_diags *diags);
// reading a body that was checked
double hn_body_number(const cJSON *body, const char *name, double otherwise);
const char *hn_body_text(const cJSON *body, const char *name); ///< NULL when absent
#endif
