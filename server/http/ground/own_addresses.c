// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // IFF_UP
#include "http/ground/own_addresses.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

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

/// Asks the kernel for the interfaces by way of a socket, which names those of IPv4 alone.
/// getifaddrs() needs a socket of AF_NETLINK, which a sandbox may refuse.
static int ask_by_socket(char (*out)[HN_ADDRESS_TEXT]) {
    struct ifreq each[64];
    struct ifconf all = {.ifc_len = sizeof each, .ifc_req = each};
    int n = 0;

    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (fd < 0) {
        return 0;
    }
    const size_t found = ioctl(fd, SIOCGIFCONF, &all) == 0 ? (size_t)all.ifc_len / sizeof *each : 0;
    for (size_t k = 0; k < found && n < HN_OWN_ADDRESSES; k++) {
        struct sockaddr address = each[k].ifr_addr; // the flags take its place
        if (ioctl(fd, SIOCGIFFLAGS, &each[k]) == 0) {
            const struct ifaddrs i = {.ifa_addr = &address,
                                      .ifa_flags = (unsigned short)each[k].ifr_flags};
            n += write_address(&i, AF_INET, out[n]);
        }
    }
    close(fd);
    return n;
}

int hn_own_addresses(bool with_ip6, char (*out)[HN_ADDRESS_TEXT]) {
    struct ifaddrs *all = NULL;
    int n = 0;
    if (getifaddrs(&all) != 0) {
        return ask_by_socket(out);
    }
    for (int k = 0; k < (with_ip6 ? 2 : 1); k++) {
        for (const struct ifaddrs *i = all; i && n < HN_OWN_ADDRESSES; i = i->ifa_next) {
            n += write_address(i, k == 0 ? AF_INET : AF_INET6, out[n]);
        }
    }
    freeifaddrs(all);
    return n;
}
