// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_OPENAPI_H
#define HN_HTTP_OPENAPI_H
// The OpenAPI 3.1 document, written from the table of routes and their fields.

struct hn_request;

/// Replies with the document of this server.
void hn_handle_openapi(struct hn_request *r);
#endif
