// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_BASE64_H
#define HN_BASE_BASE64_H
// Bytes as text: base64 with the alphabet and the padding of RFC 4648, section 4.

#include "base/strbuf.h"

/// Appends n bytes in base64: 4 characters for every 3 bytes begun.
void hn_base64(hn_strbuf *b, const void *bytes, size_t n);
#endif
