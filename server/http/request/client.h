// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_CLIENT_H
#define HN_HTTP_CLIENT_H
// Tells the clients of the server apart. A client is an address, of IPv6 a network of 64 bits. A
// proxy names the address that it speaks for in X-Forwarded-For: one on this machine, and those
// that the server was told of. The last entry of a list that is no proxy itself counts; what stands
// before it anybody may have written. All requests of this machine without that header are one
// client, which may take every place. In the queues the programs of this machine are told apart by
// their User-Agent, so that a script that fills its share of a queue leaves the rest to a browser.

#include "http/ground/proxies.h"
#include "http/request/request.h"

/// The client of a connection (NULL: unknown); 0 for this machine and for proxies, which may have
/// every place.
hn_client hn_client_of_connection(const hn_proxies *proxies, const struct sockaddr *address);
/// Sets the client of a request whose head is complete. Returns false with a problem as reply where
/// a proxy names something that is no address.
HN_MUST_CHECK bool hn_request_identify(hn_request *r);
#endif
