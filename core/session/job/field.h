// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_FIELD_H
#define HN_SESSION_FIELD_H
// Fields of a request: one table names what a request takes. The command line reads its options
// from the table, the server checks a JSON body with it, the OpenAPI document and the index of the
// API are written from it.

#include "base/diag.h"
#include "base/strbuf.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

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
    const char *name; ///< in JSON; as an option of the command line "--" and dashes for underscores
    hn_field_type type;
    bool required;
    bool is_method;                ///< texts are spellings of methods; checked where served
    double min, max;               ///< of a number, or how many entries; both 0: any finite number
    double served_max;             ///< the bound of a request to a server; 0: `max`
    const char *argument;          ///< of the option: "N"; NULL: no option of the command line
    const char *const *choices;    ///< ends with NULL
    const struct hn_field *record; ///< as a table
    const char *about;
} hn_field;

/// Returns the field of this name; NULL: there is none.
const hn_field *hn_fields_find(const hn_field *fields, const char *name);
/// Checks an object against a table and reports every field that is unknown (with a near miss),
/// written twice, missing, of a wrong type or out of range.
///
/// fields  in  ends with a row without a name
/// parent  in  JSON pointer of `object`; "" at the top
/// served  in  true: the bounds of a server hold
/// Fails:  HN_ERR_INPUT when anything is at fault.
HN_MUST_CHECK hn_status hn_fields_check(const cJSON *object, const hn_field *fields,
                                        const char *parent, bool served, hn_diags *diags);

// reading an object that was checked
double hn_fields_number(const cJSON *object, const char *name, double otherwise);
const char *hn_fields_text(const cJSON *object, const char *name); ///< NULL when absent
#endif
