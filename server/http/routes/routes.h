// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_ROUTES_H
#define HN_HTTP_ROUTES_H
// The table of routes: the server dispatches by it, the index and the OpenAPI document are written
// from it.

#include "http/request/route.h"

/// Returns the table.
hn_route_table hn_routes(void);
#endif
