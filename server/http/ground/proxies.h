// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_PROXIES_H
#define HN_HTTP_PROXIES_H
// Addresses, and the networks of the proxies that are believed when they name the address they
// speak for.

#include <stdbool.h>
#include <stddef.h>
#include <sys/socket.h>

enum { HN_ADDRESS_BYTES = 16, HN_MAX_PROXIES = 16 };

/// An address of IPv6; one of IPv4 is written ::ffff:a.b.c.d.
typedef struct hn_address {
    unsigned char byte[HN_ADDRESS_BYTES];
} hn_address;

/// The addresses whose first bits are these.
typedef struct hn_network {
    hn_address address;
    int bits;
} hn_network;

typedef struct hn_proxies {
    hn_network network[HN_MAX_PROXIES];
    int n;
} hn_proxies;

/// Reads n bytes of text: an address of either family, with a port behind it or not, in brackets or
/// not. Returns false where it is none.
bool hn_address_read(const char *text, size_t n, hn_address *out);
hn_address hn_address_of(const struct sockaddr *address);
bool hn_address_is_ip4(const hn_address *address);
/// Returns whether it is 127.0.0.1 or ::1.
bool hn_address_is_loopback(const hn_address *address);
/// Reads an address, or a network as "10.0.0.0/8". Returns false where it is neither.
bool hn_network_read(const char *text, hn_network *out);
/// Returns whether an address is a proxy's: those of this machine are, and those of the networks.
bool hn_proxies_have(const hn_proxies *proxies, const hn_address *address);
#endif
