// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_SHA256_H
#define HN_HTTP_SHA256_H
// SHA-256 in base64, as a content security policy names an inline script. Source: FIPS 180-4, RFC
// 4648.

#include <stddef.h>

enum { HN_SHA256_BASE64 = 45 };

/// The digest of n bytes, in base64, with a zero at its end.
void hn_sha256_base64(const void *bytes, size_t n, char out[HN_SHA256_BASE64]);
#endif
