// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_TOKEN_H
#define HN_HTTP_TOKEN_H
// A server that is reached from other machines asks for a token: in the link that it prints, then
// in a cookie, or in a header of a script. Guests, if the server takes them, may read without it.

#include "http/request/request.h"

enum { HN_TOKEN = 23 };

/// Makes a token of 132 random bits, in letters of URLs. Returns 0 when there is no randomness.
int hn_token_make(char out[HN_TOKEN]);
/// Returns 1 when the request may go on; otherwise the reply is made: a problem, or the redirect
/// that turns the token of a link into a cookie. The route may be NULL.
int hn_token_check(hn_request *r, const char *method);
#endif
