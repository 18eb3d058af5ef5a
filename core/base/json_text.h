// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_JSON_TEXT_H
#define HN_BASE_JSON_TEXT_H
// Is this text JSON (RFC 8259), and if not, where and why? Parsers in use here accept more than the
// standard and say less; everything that comes from outside passes this gate first, so that what
// follows only meets sound text.

#include "base/diag.h"

#include <stddef.h>

/// Checks that n bytes are one JSON value: strict grammar, valid UTF-8, no zero character (not even
/// escaped), numbers that fit a double, at most max_depth levels. The message starts with "line L,
/// column C: " (1-based; columns count characters). Allocates nothing, time linear in n. Fails:
/// HN_ERR_INPUT; HN_ERR_LIMIT (too deep).
HN_MUST_CHECK hn_status hn_json_text_check(const char *text, size_t n, int max_depth,
                                           hn_diag *diag);
/// The same, and in *offset the byte at which the text stops being JSON (untouched when it is).
HN_MUST_CHECK hn_status hn_json_text_locate(const char *text, size_t n, int max_depth,
                                            size_t *offset, hn_diag *diag);

#endif
