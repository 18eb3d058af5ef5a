#ifndef HN_HTTP_BODY_H
#define HN_HTTP_BODY_H
// The JSON body of a request. Each route names the fields it takes in one table; the same table checks the body
// (every fault with its pointer) and writes the schema of the OpenAPI document.

#include "base/diag.h"
#include "base/strbuf.h"
#include "scene/scene.h"
#include "session/model/library.h"
#include "session/model/model.h"

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

/// Tells every field that is unknown (near miss), written twice, missing, of a wrong type or out of range. `fields` ends with a
/// row without a name; `parent` is the pointer of `object` ("" at the top). HN_ERR_INPUT when anything is at fault.
HN_MUST_CHECK hn_status hn_body_check(const cJSON *object, const hn_field *fields,
                                      const char *parent, hn_diags *diags);
/// JSON Schema (2020-12) of an object with these fields.
void hn_fields_schema_json(hn_strbuf *b, const hn_field *fields);

// reading a body that was checked
double hn_body_number(const cJSON *body, const char *name, double otherwise);
const char *hn_body_text(const cJSON *body, const char *name); ///< NULL when absent

/// What a model is made from; owns copies of everything it names.
typedef struct hn_scene_order {
    char *name, *text; ///< one of them
    int n;
    hn_setting settings[HN_SCENE_MAX_PARAMS];
    char *names[HN_SCENE_MAX_PARAMS];
} hn_scene_order;

/// From the members "scene" and "settings". Start from a zeroed order; hn_scene_order_reset() afterwards in any case.
HN_MUST_CHECK hn_status hn_scene_order_read(hn_scene_order *order, const cJSON *body,
                                            hn_diags *diags);
/// The settings alone; those that were there are forgotten.
HN_MUST_CHECK hn_status hn_scene_order_read_settings(hn_scene_order *order, const cJSON *settings,
                                                     hn_diags *diags);
HN_MUST_CHECK hn_status hn_scene_order_add(hn_scene_order *order, const char *name, size_t n_name,
                                           double value, hn_diags *diags);
HN_MUST_CHECK hn_status hn_scene_order_copy(hn_scene_order *to, const hn_scene_order *from);
void hn_scene_order_reset(hn_scene_order *order);
/// Loads; pointers of faults inside a scene object begin with "/scene".
HN_MUST_CHECK hn_status hn_scene_order_load(const hn_scene_order *order, const hn_library *lib,
                                            int allow_open, hn_model **out, hn_diags *diags);
/// {"l1": 1.2}
void hn_scene_order_settings_json(hn_strbuf *b, const hn_scene_order *order);
#endif
