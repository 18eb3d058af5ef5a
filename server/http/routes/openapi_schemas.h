// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_OPENAPI_SCHEMAS_H
#define HN_HTTP_OPENAPI_SCHEMAS_H
// The schemas of all answers, by the names that the table of routes gives them.

#include "base/strbuf.h"

/// Writes the members of "schemas".
void hn_openapi_put_schemas(hn_strbuf *b);
#endif
