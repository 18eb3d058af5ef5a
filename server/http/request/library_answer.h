// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_LIBRARY_ANSWER_H
#define HN_HTTP_LIBRARY_ANSWER_H
// Answers that libmicrohttpd gives by itself, to requests that it cannot read: a page of HTML each.
// Here they become problem documents.
//
// The library offers no hook for them, but it calls its own exported functions by name, and the
// dynamic linker looks for a name in the program first. The program therefore exports a function
// MHD_queue_response of its own (--export-dynamic-symbol in the Makefile): the library comes
// through it with each answer of its own, and the server's answers go to the library's directly.
// A library that was linked with -Bsymbolic never calls it, and sends its HTML.

#include "http/ground/microhttpd.h"

#undef MHD_queue_response // the function below bears the library's name itself

/// Queues a problem document in place of the library's page where the status is one of those that
/// the library gives, and the page itself otherwise. Returns what the library's function returns.
__attribute__((visibility("default"))) enum MHD_Result
MHD_queue_response(struct MHD_Connection *connection, unsigned status, struct MHD_Response *page);
#endif
