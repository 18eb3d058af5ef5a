// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_REPORT_TEXT_H
#define HN_CLI_REPORT_TEXT_H
// The full report for people at a terminal: sentences, the cheapest methods, verdicts, survival.

#include "session/report/report.h"

/// The summary of the report for people.
void hn_report_text(hn_strbuf *b, const hn_report *report);
#endif
