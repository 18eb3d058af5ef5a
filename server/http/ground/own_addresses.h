// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_OWN_ADDRESSES_H
#define HN_HTTP_OWN_ADDRESSES_H
// The addresses of this machine, as links name them: for a server that listens on all of them.

#include <stdbool.h>

enum { HN_ADDRESS_TEXT = 64, HN_OWN_ADDRESSES = 8 };

/// Lists the addresses at which another machine may reach this one ("192.168.1.5",
/// "[2001:db8::5]"), those of IPv4 first. A sandbox without AF_NETLINK leaves those of IPv4 alone.
/// Returns how many there are; 0 where there is no network.
int hn_own_addresses(bool with_ip6, char (*out)[HN_ADDRESS_TEXT]);
#endif
