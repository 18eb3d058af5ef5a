// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_FIELD_SCHEMA_H
#define HN_HTTP_FIELD_SCHEMA_H
// The JSON Schema of a request body, written from the table of its fields.

#include "base/strbuf.h"
#include "session/job/field.h"

/// Writes the JSON Schema (2020-12) of an object with these fields.
void hn_fields_schema_json(hn_strbuf *b, const hn_field *fields);
#endif
