// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/proxies.h"

#include <arpa/inet.h>
#include <stdlib.h>
#include <string.h>

enum { IP4_BYTES = 4, IP4_AT = HN_ADDRESS_BYTES - IP4_BYTES, PORT_DIGITS = 5 };
static const unsigned char IP4_START[IP4_AT] = {[IP4_AT - 2] = 0xff, [IP4_AT - 1] = 0xff};

static hn_address from_ip4(const void *bytes) {
    hn_address a;
    memcpy(a.byte, IP4_START, sizeof IP4_START);
    memcpy(a.byte + IP4_AT, bytes, IP4_BYTES);
    return a;
}

/// The text without the port behind it and the brackets around it; *n is its length.
static const char *strip_port(const char *text, size_t *n) {
    const char *end = text + *n, *colon = memchr(text, ':', *n);
    const bool in_brackets = *n > 0 && text[0] == '[';
    const char *close = in_brackets ? memchr(text, ']', *n) : NULL;
    if (in_brackets && !close) {
        return NULL;
    }

    // a single colon begins a port; without brackets, more of them are an address of IPv6
    const char *port = close                                                         ? close + 1
                       : colon && !memchr(colon + 1, ':', (size_t)(end - colon) - 1) ? colon
                                                                                     : end;
    const size_t digits = port < end ? (size_t)(end - port) - 1 : 0;
    if (port < end && (*port != ':' || digits == 0 || digits > PORT_DIGITS ||
                       strspn(port + 1, "0123456789") < digits)) {
        return NULL;
    }
    text += in_brackets;
    *n = (size_t)((close ? close : port) - text);
    return text;
}

bool hn_address_read(const char *text, size_t n, hn_address *out) {
    char word[INET6_ADDRSTRLEN];
    struct in_addr four;
    text = strip_port(text, &n);
    if (!text || n == 0 || n >= sizeof word) {
        return false;
    }
    memcpy(word, text, n);
    word[n] = 0;
    if (inet_pton(AF_INET, word, &four) == 1) {
        *out = from_ip4(&four);
        return true;
    }
    return inet_pton(AF_INET6, word, out->byte) == 1;
}

hn_address hn_address_of(const struct sockaddr *address) {
    if (address->sa_family == AF_INET) {
        return from_ip4(&((const struct sockaddr_in *)address)->sin_addr);
    }
    hn_address a;
    memcpy(a.byte, ((const struct sockaddr_in6 *)address)->sin6_addr.s6_addr, sizeof a.byte);
    return a;
}

bool hn_address_is_ip4(const hn_address *address) {
    return memcmp(address->byte, IP4_START, sizeof IP4_START) == 0;
}

bool hn_address_is_loopback(const hn_address *address) {
    static const unsigned char four[IP4_BYTES] = {127, 0, 0, 1},
                               six[HN_ADDRESS_BYTES] = {[HN_ADDRESS_BYTES - 1] = 1};
    return (hn_address_is_ip4(address) && memcmp(address->byte + IP4_AT, four, sizeof four) == 0) ||
           memcmp(address->byte, six, sizeof six) == 0;
}

bool hn_network_read(const char *text, hn_network *out) {
    const size_t n = strcspn(text, "/");
    if (memchr(text, '[', n) || !hn_address_read(text, n, &out->address)) {
        return false;
    }
    const int before = hn_address_is_ip4(&out->address) ? 8 * IP4_AT : 0;
    out->bits = 8 * HN_ADDRESS_BYTES;
    if (!text[n]) {
        return true;
    }

    // the bits that are written count from the beginning of the family's own address
    const char *digits = text + n + 1;
    const size_t n_digits = strlen(digits);
    if (n_digits == 0 || n_digits > 3 || strspn(digits, "0123456789") < n_digits) {
        return false;
    }
    out->bits = before + (int)strtol(digits, NULL, 10);
    return out->bits <= 8 * HN_ADDRESS_BYTES;
}

static bool has(const hn_network *network, const hn_address *address) {
    const int whole = network->bits / 8, rest = network->bits % 8;
    const unsigned mask = rest ? 0xffu << (8 - rest) & 0xffu : 0;
    const int at = rest ? whole : 0; // a byte that is there
    return memcmp(network->address.byte, address->byte, (size_t)whole) == 0 &&
           ((network->address.byte[at] ^ address->byte[at]) & mask) == 0;
}

bool hn_proxies_have(const hn_proxies *proxies, const hn_address *address) {
    bool found = hn_address_is_loopback(address);
    for (int i = 0; i < proxies->n && !found; i++) {
        found = has(&proxies->network[i], address);
    }
    return found;
}
