// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_WORK_PRECISION_TEXT_H
#define HN_CLI_WORK_PRECISION_TEXT_H
// A work-precision study for people at a terminal: verdicts, a plot, who is cheapest for which
// accuracy, what equal cost buys.

#include "session/precision/study.h"

/// The study for people: table, orders, plot.
void hn_study_text(hn_strbuf *b, const hn_study *study);
/// Writes the cheapest method in words, then the plot with a legend.
void hn_study_plot_text(hn_strbuf *b, const hn_study *study);
#endif
