// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_ROUTE_H
#define HN_HTTP_ROUTE_H
// One row of the table of routes, and the search for the row that an address belongs to.

#include "session/job/field.h"

enum { HN_MAX_PARTS = 2, HN_HEADER_TEXT = 256 };

struct hn_request;

typedef enum hn_work {
    /// answered at once on the connection's thread: lookups and copies only, no body
    HN_WORK_LIGHT,
    HN_WORK_QUICK, ///< done by the quick pool: reads a shipped scene, opens a comparison
    HN_WORK_HEAVY, ///< done by the pool, for as long as run_cpu_s; a full pool: 429
    /// the same two, asynchronous: the handler finishes the request, or has it finished
    HN_WORK_QUICK_OWN,
    HN_WORK_HEAVY_OWN,
    HN_WORK_OWN ///< asynchronous: the handler replies now or arranges a later reply
} hn_work;

typedef struct hn_route_query {
    const char *name, *type,
        *about; ///< type: JSON Schema type; "array": it may be given several times
} hn_route_query;

typedef struct hn_route {
    const char *method, *path; ///< "/api/v1/scenes/{id}"
    hn_work work;
    void (*handle)(struct hn_request *r);
    const hn_field *fields; ///< of the JSON body; NULL: no body
    const char *media_type; ///< of the answer; several are separated by blanks
    const char *status;     ///< of the answer when all is well; several are separated by blanks
    const char
        *schema; ///< name of the answer's schema in the OpenAPI document, NULL when it has no body
    const char *summary;
    const hn_route_query *query; ///< ends with a row without a name; may be NULL
    const char *example; ///< a body that is served, for the OpenAPI document; the tests send it
} hn_route;

/// Copies the i-th media type of a route; returns 0 when there are not so many.
int hn_route_media_type(const hn_route *route, int i, char out[64]);

/// All rows.
typedef struct hn_route_table {
    const hn_route *row;
    int n;
} hn_route_table;

/// The result of a search for an address: the route for the verb (HEAD is served by GET), or why
/// there is none.
typedef struct hn_route_match {
    const hn_route *route; ///< NULL: see `allow`
    char allow[64];        ///< verbs this address takes; "" when there is no such address
} hn_route_match;

/// Finds the row of an address. `parts` receives the text in place of each {...} of the path.
hn_route_match hn_route_find(const hn_route_table *table, const char *method, const char *path,
                             char (*parts)[HN_HEADER_TEXT]);
/// Returns the path of the table that is most like this one, or NULL.
const char *hn_route_nearest(const hn_route_table *table, const char *path);
#endif
