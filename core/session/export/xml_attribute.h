// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_XML_ATTRIBUTE_H
#define HN_SESSION_XML_ATTRIBUTE_H
// Common part of the writers of MJCF and URDF: attributes of an element, and notes of what is left
// out.

#include "base/strbuf.h"

/// Adds ` key="text"`, with `suffix` behind the text.
void hn_xml_put_text(hn_strbuf *b, const char *key, const char *text, const char *suffix);
/// Adds ` key="x[0] x[1] ..."` with digits that read back the same; -0 is written as 0.
void hn_xml_put_numbers(hn_strbuf *b, const char *key, const double *x, int n);
/// Notes, as a line, that something of the scene is not in the model; `name` may be NULL.
void hn_xml_leave_out(hn_strbuf *left_out, const char *what, const char *name, const char *why);

#endif
