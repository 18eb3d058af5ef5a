// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_LISTEN_H
#define HN_HTTP_LISTEN_H
// A listening socket: on the port asked, or the next free one.

#include "base/diag.h"

/// Returns a listening socket in *fd and its port; `address` ("127.0.0.1", "[::1]") is how a link
/// names it. `next_ports`: how many following ports are tried when one is taken. HN_ERR_IO with one
/// sentence on why no port could be had.
HN_MUST_CHECK hn_status hn_listen(const char *host, int port, int next_ports, int *fd, int *bound,
                                  char address[256], hn_diag *diag);
#endif
