// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/client.h"

#include "base/hash.h"

#include <arpa/inet.h>
#include <string.h>

enum { NETWORK_BYTES = 8 }; ///< of an IPv6 address: RFC 4291, section 2.5.4

static hn_client make_client(const void *bytes, size_t n) {
    return hn_hash_mix(hn_hash_bytes(HN_HASH_START, bytes, n)) | 1; // 0 is this machine
}

static hn_client client_of_ip4(struct in_addr a) {
    return ntohl(a.s_addr) == INADDR_LOOPBACK ? 0 : make_client(&a, sizeof a);
}

/// A socket for both families shows IPv4 addresses as ::ffff:a.b.c.d. A household has 2^64 IPv6
/// addresses, which are one client.
static hn_client client_of_ip6(const struct in6_addr *a) {
    if (IN6_IS_ADDR_V4MAPPED(a)) {
        struct in_addr inner;
        memcpy(&inner, a->s6_addr + NETWORK_BYTES + 4, sizeof inner);
        return client_of_ip4(inner);
    }
    return IN6_IS_ADDR_LOOPBACK(a) ? 0 : make_client(a, NETWORK_BYTES);
}

hn_client hn_client_of_address(const struct sockaddr *address) {
    if (!address) {
        return 0;
    }
    if (address->sa_family == AF_INET6) {
        return client_of_ip6(&((const struct sockaddr_in6 *)address)->sin6_addr);
    }
    return client_of_ip4(((const struct sockaddr_in *)address)->sin_addr);
}

/// The client that a proxy names: the last entry of a list, which the proxy itself has written.
static hn_client find_forwarded(const hn_request *r) {
    const char *list = hn_request_header(r, "X-Forwarded-For");
    const char *comma = list ? strrchr(list, ',') : NULL;
    const char *last = comma ? comma + 1 : list;
    if (!last) {
        return 0;
    }
    last += strspn(last, " \t");
    const size_t n = strcspn(last, " \t");
    return n > 0 ? make_client(last, n) : 0;
}

void hn_request_identify(hn_request *r) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(r->connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    r->client = hn_client_of_address(info ? info->client_addr : NULL);
    if (r->client == 0) {
        r->client = find_forwarded(r);
    }
    r->queues_as = r->client;
    if (r->queues_as == 0) {
        const char *agent = hn_request_header(r, "User-Agent");
        r->queues_as = make_client(agent ? agent : "", agent ? strlen(agent) : 0);
    }
}
