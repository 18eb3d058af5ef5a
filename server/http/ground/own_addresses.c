// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // IFF_UP
#include "http/ground/own_addresses.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <stdio.h>

/// Writes the address of an interface as a link names it. Returns false where no other machine gets
/// here by it.
static bool write_address(const struct ifaddrs *i, int family, char out[HN_ADDRESS_TEXT]) {
    if (!i->ifa_addr || i->ifa_addr->sa_family != family || !(i->ifa_flags & IFF_UP) ||
        (i->ifa_flags & IFF_LOOPBACK)) {
        return false;
    }
    char text[INET6_ADDRSTRLEN];
    if (family == AF_INET) {
        const struct in_addr *four = &((const struct sockaddr_in *)i->ifa_addr)->sin_addr;
        return inet_ntop(family, four, out, HN_ADDRESS_TEXT) != NULL;
    }
    const struct in6_addr *six = &((const struct sockaddr_in6 *)i->ifa_addr)->sin6_addr;
    if (IN6_IS_ADDR_LINKLOCAL(six) || !inet_ntop(family, six, text, sizeof text)) {
        return false; // such an address names its interface too, which a link cannot
    }
    snprintf(out, HN_ADDRESS_TEXT, "[%s]", text);
    return true;
}

int hn_own_addresses(bool with_ip6, char (*out)[HN_ADDRESS_TEXT]) {
    struct ifaddrs *all = NULL;
    int n = 0;
    if (getifaddrs(&all) != 0) {
        return 0;
    }
    for (int k = 0; k < (with_ip6 ? 2 : 1); k++) {
        for (const struct ifaddrs *i = all; i && n < HN_OWN_ADDRESSES; i = i->ifa_next) {
            n += write_address(i, k == 0 ? AF_INET : AF_INET6, out[n]);
        }
    }
    freeifaddrs(all);
    return n;
}
