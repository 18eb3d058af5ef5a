// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_MARKUP_H
#define HN_BASE_MARKUP_H
// Text inside HTML and XML: what would be read as markup (& < > ") is written as an entity.

#include "base/strbuf.h"

/// Adds a text as the content of an element or the value of an attribute.
void hn_html_text(hn_strbuf *b, const char *text);
/// The same for the first n bytes of a text.
void hn_html_text_n(hn_strbuf *b, const char *text, size_t n);

#endif
