// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_CLASS_LINE_H
#define HN_CLASS_CLASS_LINE_H
// Fields of the line that a class has for each submission: its mistakes, and a hash by which a
// later run knows that nobody changed the line by hand.

#include "grade/verdict.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

/// Writes the mistakes, "sign in J11". A matrix that is transposed is one mistake of the whole.
void hn_class_line_put_mistakes(hn_strbuf *b, const hn_verdict *v);
/// Writes the last field of a line: the hash of what it says.
void hn_class_line_put_check(hn_strbuf *b);
/// Returns whether a line, read as `o`, is as it was written.
bool hn_class_line_is_unchanged(const char *line, const cJSON *o);
#endif
