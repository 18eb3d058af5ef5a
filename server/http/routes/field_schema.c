// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/field_schema.h"

/// The type of a value by its JSON name.
static void put_type(hn_strbuf *b, const char *type) {
    hn_json_put_string(b, "type", type);
}

static void put_items(hn_strbuf *b, const hn_field *f, const char *type) {
    put_type(b, "array");
    hn_json_key(b, "items");
    hn_json_object(b);
    put_type(b, type);
    hn_json_end_object(b);
    if (f->max > 0) {
        hn_json_put_number(b, "minItems", f->min);
        hn_json_put_number(b, "maxItems", f->max);
    }
}

static void put_number_field(hn_strbuf *b, const hn_field *f) {
    put_type(b, f->type == HN_FIELD_INTEGER ? "integer" : "number");
    if (f->min != 0 || f->max != 0) {
        hn_json_put_number(b, "minimum", f->min);
        hn_json_put_number(b, "maximum", f->max);
    }
}

static void put_choices(hn_strbuf *b, const hn_field *f) {
    put_type(b, "string");
    hn_json_key(b, "enum");
    hn_json_array(b);
    for (int i = 0; f->choices[i]; i++) {
        hn_json_string(b, f->choices[i]);
    }
    hn_json_end_array(b);
}

static void put_field_type(hn_strbuf *b, const hn_field *f) {
    switch (f->type) {
    // a name or a whole scene; numbers by name
    case HN_FIELD_SCENE:
        hn_json_key(b, "type");
        hn_json_raw(b, "[\"string\",\"object\"]");
        break;
    case HN_FIELD_BY_NAME:
        put_type(b, "object");
        hn_json_key(b, "additionalProperties");
        hn_json_raw(b, "{\"type\":\"number\"}");
        break;

    // values
    case HN_FIELD_NUMBER:
    case HN_FIELD_INTEGER:
        put_number_field(b, f);
        break;
    case HN_FIELD_BOOL:
        put_type(b, "boolean");
        break;
    case HN_FIELD_TEXT:
        put_type(b, "string");
        break;

    // lists and choices
    case HN_FIELD_TEXTS:
        put_items(b, f, "string");
        break;
    case HN_FIELD_NUMBERS:
        put_items(b, f, "number");
        break;
    case HN_FIELD_CHOICE:
        put_choices(b, f);
        break;
    case HN_FIELD_RECORD:
    case HN_FIELD_ANY:
        break;
    }
}

/// The members of a schema of an object with these fields; the object is open.
static void put_schema_members(hn_strbuf *b, const hn_field *fields) {
    put_type(b, "object");
    hn_json_put_bool(b, "additionalProperties", 0);
    hn_json_key(b, "properties");
    hn_json_object(b);
    for (const hn_field *f = fields; f->name; f++) {
        hn_json_key(b, f->name);
        hn_json_object(b);
        hn_json_put_string(b, "description", f->about);
        if (f->type == HN_FIELD_RECORD) {
            put_schema_members(b, f->record);
        } else {
            put_field_type(b, f);
        }
        hn_json_end_object(b);
    }
    hn_json_end_object(b);

    // fields that must be there
    hn_json_key(b, "required");
    hn_json_array(b);
    for (const hn_field *f = fields; f->name; f++) {
        if (f->required) {
            hn_json_string(b, f->name);
        }
    }
    hn_json_end_array(b);
}

void hn_fields_schema_json(hn_strbuf *b, const hn_field *fields) {
    hn_json_object(b);
    put_schema_members(b, fields);
    hn_json_end_object(b);
}
