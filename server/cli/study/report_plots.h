// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_REPORT_PLOTS_H
#define HN_CLI_REPORT_PLOTS_H
// Every plot of the full report as files: SVG, and PNG where rsvg-convert is installed.

#include "cli/shell/args.h"
#include "session/report/report.h"

/// Writes them into the folder of --plots, which is made when it is not there.
hn_exit hn_write_plots(const hn_args *args, const hn_report *report);
#endif
