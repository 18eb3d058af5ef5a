// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STUDY_PLOT_H
#define HN_SESSION_STUDY_PLOT_H
// Error against cost as an SVG picture, in the colours, dashes and markers of render/look.h.
// Colours are variables of the page (--slot-0 to --slot-7, --ink, --muted, --hairline, --raised),
// so that one picture serves the light theme, the dark theme and paper.

#include "base/markup.h"
#include "session/precision/study.h"

/// Writes one <svg> element. Labels stand at the ends of the curves. A failed run is a cross on the
/// upper edge, at its cost until the failure. The band at the lower edge is below the resolution of
/// the reference.
void hn_study_plot(hn_strbuf *b, const hn_study *study, hn_error_kind error, hn_cost_kind cost);
/// Writes the line and the marker of method m, for legends.
void hn_study_key(hn_strbuf *b, int m);
/// Opens an <svg> of this size; `about` is its accessible name.
void hn_plot_begin(hn_strbuf *b, int width, int height, const char *about);
/// Writes a text at (x, y) in a class of style/plots.css.
void hn_plot_text(hn_strbuf *b, double x, double y, const char *class_name, const char *text);
#endif
