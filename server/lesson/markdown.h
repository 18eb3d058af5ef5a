// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LESSON_MARKDOWN_H
#define HN_LESSON_MARKDOWN_H
// Markdown with formulas as a tree of nodes. Each node is an object with a "kind":
//
//   blocks    heading {level}, paragraph, list {ordered, start}, item, quote, table, row {head},
//             cell {align}, code {info, text}, rule, figure {src}
//   in a line text {text}, mono {text}, math {tex, display}, strong, em, link {href}, break
//
// Nodes with contents hold them in "children". An item or a cell may hold nodes of a line directly.
// A picture that stands alone in its paragraph is a figure; its children are the caption.

#include "base/status.h"

#include <cjson/cJSON.h>
#include <stddef.h>

/// Appends the nodes of n bytes of Markdown (CommonMark, tables, $..$ and $$..$$; no HTML) to the
/// array `children`. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT (nested deeper than 64).
HN_MUST_CHECK hn_status hn_markdown_parse(const char *text, size_t n, cJSON *children);
#endif
