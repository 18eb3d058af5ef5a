// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_SERVER_H
#define HN_HTTP_SERVER_H
// The HTTP server: one thread speaks with the clients, a pool does long work, each comparison has a
// thread of its own.

#include "base/diag.h"
#include "http/ground/http_opts.h"
#include "session/model/library.h"

typedef struct hn_server hn_server;

/// Listens and serves until hn_server_stop(). `lib` must outlive the server. HN_ERR_IO when no port
/// could be had: diag says which and why (a privileged port, an address that is not ours).
HN_MUST_CHECK hn_status hn_server_start(const hn_library *lib, const hn_http_opts *opts,
                                        hn_server **out, hn_diag *diag);
/// Returns how many descriptors a server with these options may need.
int hn_server_descriptors(const hn_http_opts *opts);
/// Returns where the server is, "http://127.0.0.1:8080"; of one that listens on every address of
/// this machine the i-th address by which other machines get here. NULL beyond the last.
const char *hn_server_address(const hn_server *server, int i);
int hn_server_port(const hn_server *server);
/// Ends streams, comparisons and pool, then the listening; frees everything.
void hn_server_stop(hn_server *server);
#endif
