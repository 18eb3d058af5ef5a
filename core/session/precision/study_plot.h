// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STUDY_PLOT_H
#define HN_SESSION_STUDY_PLOT_H
// Error against cost as an SVG picture, in the colours, dashes and markers of render/look.h.
// Colours are the variables --slot-0 ..
// --slot-6, --ink, --muted, --hairline, --raised of the page around it, so that one picture serves
// light, dark and paper.

#include "session/precision/study.h"

/// One <svg> element. Curves are labelled at their ends; failed points stand on the upper edge, at
/// what they had cost by then; the band at the lower edge is what the reference cannot resolve.
void hn_study_plot(hn_strbuf *b, const hn_study *study, hn_error_kind error, hn_cost_kind cost);
/// Line and marker of method m on their own, for legends.
void hn_study_key(hn_strbuf *b, int m);
/// What plots need of a style sheet, beside the variables.
const char *hn_plot_style(void);
/// Begins an <svg> of this size, with what it shows in words.
void hn_plot_begin(hn_strbuf *b, int width, int height, const char *about);
/// Text at (x, y) in a class of hn_plot_style().
void hn_plot_text(hn_strbuf *b, double x, double y, const char *class_name, const char *text);
/// Text with &, <, > and " escaped.
void hn_html_text(hn_strbuf *b, const char *text);
void hn_html_text_n(hn_strbuf *b, const char *text, size_t n); ///< its first n bytes
#endif
