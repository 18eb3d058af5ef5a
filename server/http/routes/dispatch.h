// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_DISPATCH_H
#define HN_HTTP_DISPATCH_H
// The life of a request: head, body, work, reply. The callbacks of the HTTP library; `cls` is the
// hn_dispatch of the server.

#include "http/ground/connections.h"
#include "http/ground/jobs.h"
#include "http/ground/microhttpd.h"
#include "http/request/context.h"

/// Borrowed from the server.
typedef struct hn_dispatch {
    hn_context *context;
    hn_jobs *quick, *heavy;
    hn_connections *connections;
} hn_dispatch;

/// An address has come, as it was sent: makes the request. One that is too long is answered here,
/// since the library closes the connection without an answer where its parameters are many.
void *hn_dispatch_address(void *cls, const char *uri, struct MHD_Connection *connection);
/// A part of a request has come; one is finished; a connection opens or closes.
enum MHD_Result hn_dispatch_request(void *cls, struct MHD_Connection *connection, const char *url,
                                    const char *method, const char *version, const char *data,
                                    size_t *n_data, void **req_cls);
void hn_dispatch_completed(void *cls, struct MHD_Connection *connection, void **req_cls,
                           enum MHD_RequestTerminationCode how);
/// Whether a connection from this address is accepted: a client that has its share is refused.
enum MHD_Result hn_dispatch_accept(void *cls, const struct sockaddr *address, socklen_t length);
void hn_dispatch_connection(void *cls, struct MHD_Connection *connection, void **socket_context,
                            enum MHD_ConnectionNotificationCode what);
/// Serves one request on a thread of a pool.
void hn_dispatch_job(void *job, hn_job_turn *turn);
#endif
