#ifndef HN_HTTP_ROUTES_H
#define HN_HTTP_ROUTES_H
// The one table of routes: the server dispatches by it, the index and the OpenAPI document are written from it.

#include "http/body.h"

struct hn_request;

typedef enum hn_work {
    HN_WORK_LIGHT, ///< answered at once on the connection's thread: lookups and copies only
    HN_WORK_HEAVY, ///< done by the pool; full pool: 429
    HN_WORK_OWN    ///< the handler sees to it that somebody answers later (or answers itself)
} hn_work;

typedef struct hn_route_query {
    const char *name, *type, *about; ///< type: JSON Schema type
} hn_route_query;

typedef struct hn_route {
    const char *method, *path; ///< "/api/v1/scenes/{id}"
    hn_work work;
    void (*handle)(struct hn_request *r);
    const hn_field *fields; ///< of the JSON body; NULL: no body
    const char *media_type; ///< of the answer
    const char *status;     ///< of the answer when all is well
    const char
        *schema; ///< name of the answer's schema in the OpenAPI document, NULL when it has no body
    const char *summary;
    const hn_route_query *query; ///< ends with a row without a name; may be NULL
} hn_route;

int hn_route_count(void);
const hn_route *hn_route_at(int i);

/// What an address has: the route for the verb (HEAD is served by GET), or why not.
typedef struct hn_route_match {
    const hn_route *route; ///< NULL: see `allow`
    char allow[64];        ///< verbs this address takes; "" when there is no such address
} hn_route_match;

/// `parts` receives what stands for {…} in the path, HN_MAX_PARTS rows of HN_HEADER_TEXT bytes.
hn_route_match hn_route_find(const char *method, const char *path, char (*parts)[256]);
/// A path of the table that is near to this one, or NULL.
const char *hn_route_nearest(const char *path);
#endif
