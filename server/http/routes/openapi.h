// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_OPENAPI_H
#define HN_HTTP_OPENAPI_H
// The OpenAPI 3.1 document, written from the table of routes and their fields.

#include "base/strbuf.h"
#include "session/job/field.h"

struct hn_request;

/// Writes the JSON Schema (2020-12) of an object with these fields.
void hn_fields_schema_json(hn_strbuf *b, const hn_field *fields);

void hn_handle_openapi(struct hn_request *r);
#endif
