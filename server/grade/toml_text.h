// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_TOML_TEXT_H
#define HN_GRADE_TOML_TEXT_H
// TOML as teachers write rubrics in it: names with values, tables, lists, inline tables, comments.

#include "base/diag.h"
#include "base/strbuf.h"

#include <cjson/cJSON.h>

/// Rewrites TOML 1.0 as one JSON object on the same lines, so that a line of one is that of the
/// other. Not read: dates, numbers in other bases, with underscores or of more than 39 characters,
/// text on several lines, \U and \e in texts, names with a point (a.b = 1; write [a]) or of more
/// than 78 bytes, lists of tables ([[a]]); a table must stand in one piece.
/// Fails: HN_ERR_INPUT (`diag` names the line), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_toml_to_json(hn_strbuf *out, const char *text, hn_diag *diag);
/// Writes an object as TOML: values first, then a table for each member that is an object.
void hn_toml_write(hn_strbuf *out, const cJSON *object);
#endif
