// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_CLIENT_H
#define HN_HTTP_CLIENT_H
// Tells the clients of the server apart. A client is an address, of IPv6 a network of 64 bits. A
// proxy on this machine names the address that it speaks for in X-Forwarded-For; its last entry
// counts. All requests of this machine without that header are one client, which may take every
// place. In the queues the programs of this machine are told apart by their User-Agent, so that a
// script that fills its share of a queue leaves the rest to a browser.

#include "http/request/request.h"

/// The client of an address (NULL: unknown); 0 for this machine.
hn_client hn_client_of_address(const struct sockaddr *address);
/// Sets the client of a request whose head is complete.
void hn_request_identify(hn_request *r);
#endif
