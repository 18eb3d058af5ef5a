// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/client.h"

#include "base/hash.h"
#include "http/request/context.h"

#include <string.h>
#include <strings.h>

enum { NETWORK_BYTES = 8 }; ///< of an IPv6 address: RFC 4291, section 2.5.4

static hn_client make_client(const void *bytes, size_t n) {
    return hn_hash_mix(hn_hash_bytes(HN_HASH_START, bytes, n)) | 1; // 0 is this machine
}

/// A household has 2^64 IPv6 addresses, which are one client.
static hn_client client_of(const hn_address *address) {
    return hn_address_is_loopback(address)
               ? 0
               : make_client(address->byte,
                             hn_address_is_ip4(address) ? sizeof address->byte : NETWORK_BYTES);
}

hn_client hn_client_of_connection(const hn_proxies *proxies, const struct sockaddr *address) {
    if (!address) {
        return 0;
    }
    const hn_address from = hn_address_of(address);
    return hn_proxies_have(proxies, &from) ? 0 : client_of(&from);
}

/// The last header of the name: a proxy may add one behind that of its client.
static enum MHD_Result keep_last(void *cls, enum MHD_ValueKind kind, const char *key,
                                 const char *value) {
    (void)kind;
    if (strcasecmp(key, "X-Forwarded-For") == 0) {
        *(const char **)cls = value;
    }
    return MHD_YES;
}

/// Takes the last entry off a list of n bytes, without the blanks around it.
static const char *take_last(const char *list, size_t *n, size_t *n_entry) {
    size_t at = *n;
    while (at > 0 && list[at - 1] != ',') {
        at--;
    }
    const char *entry = list + at, *end = list + *n;
    while (entry < end && (*entry == ' ' || *entry == '\t')) {
        entry++;
    }
    while (end > entry && (end[-1] == ' ' || end[-1] == '\t')) {
        end--;
    }
    *n = at > 0 ? at - 1 : 0;
    *n_entry = (size_t)(end - entry);
    return entry;
}

/// The words of a proxy that knows no address of its client: of Squid, and of nginx where the
/// client comes by a socket of the system.
static bool says_no_address(const char *entry, size_t n) {
    static const char *const words[] = {"unknown", "unix:"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (n == strlen(words[i]) && strncasecmp(entry, words[i], n) == 0) {
            return true;
        }
    }
    return false;
}

/// Follows the proxies from `from` to the address that the last of them speaks for.
static bool follow(hn_request *r, hn_address *from) {
    const char *list = NULL;
    MHD_get_connection_values(r->connection, MHD_HEADER_KIND, keep_last, &list);
    size_t n = list ? strlen(list) : 0;
    while (n > 0 && hn_proxies_have(&r->context->opts.proxies, from)) {
        size_t n_entry;
        const char *entry = take_last(list, &n, &n_entry);
        if (says_no_address(entry, n_entry)) {
            return true; // it counts as the proxy's own
        }
        if (!hn_address_read(entry, n_entry, from)) {
            hn_reply_problem(r, HN_PROBLEM_BAD_REQUEST,
                             "a proxy writes the address of its client there",
                             "X-Forwarded-For holds '%.*s', which is not an address",
                             n_entry < 60 ? (int)n_entry : 60, entry);
            return false;
        }
    }
    return true;
}

bool hn_request_identify(hn_request *r) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(r->connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    bool is_known = true;
    if (info && info->client_addr) {
        hn_address from = hn_address_of(info->client_addr);
        is_known = follow(r, &from);
        r->client = client_of(&from);
    }
    r->queues_as = r->client;
    if (r->queues_as == 0) {
        const char *agent = hn_request_header(r, "User-Agent");
        r->queues_as = make_client(agent ? agent : "", agent ? strlen(agent) : 0);
    }
    return is_known;
}
