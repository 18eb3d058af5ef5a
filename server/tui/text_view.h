// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_TEXT_VIEW_H
#define HN_TUI_TEXT_VIEW_H
// A text as it is drawn: paragraphs in the width of the panel, from the line that was scrolled to.

#include "terminal/cells.h"
#include "tui/text_panel.h"

/// A line (n bytes) of the text as it is shown: in ASCII where the screen shows nothing else.
void hn_text_view_paragraph(const hn_workbench *w, const char *line, size_t n,
                            char out[HN_TUI_PARAGRAPH]);
/// The indent of a paragraph [columns]: its lines after the first have it too.
int hn_text_view_indent(const char *paragraph, int columns);
void hn_text_view_draw(hn_cells *c, hn_area area, const hn_workbench *w);
#endif
