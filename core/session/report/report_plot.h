// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REPORT_REPORT_PLOT_H
#define HN_SESSION_REPORT_REPORT_PLOT_H
// Strips of survival, the pictures that a report alone has; and any picture as a file.

#include "session/report/report.h"
#include "session/report/report_internal.h"

int hn_report_n_plots(const hn_report *report);
hn_report_plot hn_report_plot_at(const hn_report *report, int i);
/// An SVG file on its own, in the light theme. 0: there is nothing to draw.
int hn_report_plot_svg(hn_strbuf *b, const hn_report_plot *plot);
/// Every run that was counted: its size across, where it ended up.
void hn_report_survival_plot(hn_strbuf *b, const hn_report_scene *scene);
#endif
