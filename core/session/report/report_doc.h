// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REPORT_REPORT_DOC_H
#define HN_SESSION_REPORT_REPORT_DOC_H
// A report as JSON.

#include "session/report/report.h"

/// {"report","time_limit","elapsed","stopped","scenes":[{"scene","title","reason","study": as
/// hn_study_json(),"budgets":[as in hn_budgets_json()],
/// "singular_at","survival":[{"method","survived","tried","runs":[...]}...]}...]}
void hn_report_json(hn_strbuf *b, const hn_report *report);
#endif
