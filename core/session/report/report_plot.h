// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REPORT_REPORT_PLOT_H
#define HN_SESSION_REPORT_REPORT_PLOT_H
// The survival plot, which only a report has, and any plot of a report as a file.

#include "session/report/report.h"
#include "session/report/report_internal.h"

#include <stdbool.h>

/// Plots of the report, and plot i.
int hn_report_n_plots(const hn_report *report);
hn_report_plot hn_report_plot_at(const hn_report *report, int i);
/// Writes a standalone SVG file in the light theme. Returns false when there is nothing to draw.
bool hn_report_plot_svg(hn_strbuf *b, const hn_report_plot *plot);
/// Draws every counted run: its step size across, the time it reached upwards.
void hn_report_survival_plot(hn_strbuf *b, const hn_report_scene *scene);
#endif
