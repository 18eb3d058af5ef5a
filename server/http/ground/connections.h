// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_CONNECTIONS_H
#define HN_HTTP_CONNECTIONS_H
// Deadlines and places of connections. The HTTP library counts the seconds since the last byte, so
// that a client which sends a byte now and then keeps its place for ever; here a head and a body
// have a time in all. And the connections of each client are counted: it may have its share of
// them. If all places are taken, a new connection takes that of the oldest one that is idle, or
// else of the oldest one that has not read its answer: of the same client where its share is used
// up, otherwise of the client with the most.

#include "base/status.h"
#include "http/ground/http_opts.h"
#include "http/ground/shares.h"

#include <stdbool.h>

typedef struct hn_connections hn_connections;
typedef struct hn_connection_watch hn_connection_watch;

/// Starts the thread that looks at deadlines. NULL when memory or threads are out.
hn_connections *hn_connections_create(const hn_http_opts *opts);
void hn_connections_free(hn_connections *all); ///< NULL is legal; no connection may be left

/// Makes room for one more connection of a client: closes one that is not being served where no
/// place is left. Returns false when the client has its share and each of them is being served.
bool hn_connections_make_room(hn_connections *all, hn_client client);
/// Closes the connection whose client reads its answer most slowly, in bytes a second; of those
/// that are on their way for so many seconds at least. Returns false when there is none, and within
/// unread_pause after the last one.
bool hn_connections_end_slowest(hn_connections *all, double seconds);
/// A connection has been accepted. NULL when memory is out: it then has no deadline of its own.
hn_connection_watch *hn_connections_add(hn_connections *all, int fd, hn_client client);
/// The connection is about to be closed; from here on its descriptor is not touched. NULL is legal.
void hn_connections_remove(hn_connections *all, hn_connection_watch *w);

// what the connection is doing; NULL is legal
/// A request has begun: it is told when it is too late, and a head has its deadline.
void hn_connection_asks(hn_connections *all, hn_connection_watch *w);
/// A piece of the body has come: one that stands still is told that it is late before the library
/// closes the connection.
void hn_connection_goes_on(hn_connections *all, hn_connection_watch *w);
/// The request has its answer, whatever else it sends.
void hn_connection_is_answered(hn_connections *all, hn_connection_watch *w);
void hn_connection_reads_body(hn_connections *all, hn_connection_watch *w);
/// Its request is whole and has no deadline. Returns false where the connection has been ended, for
/// example because the request was late: it is not to be carried out.
HN_MUST_CHECK bool hn_connection_is_served(hn_connections *all, hn_connection_watch *w);
/// The answer goes out, one with an end.
void hn_connection_sends(hn_connections *all, hn_connection_watch *w);
void hn_connection_is_idle(hn_connections *all, hn_connection_watch *w);
#endif
