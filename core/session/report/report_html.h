// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REPORT_REPORT_HTML_H
#define HN_SESSION_REPORT_REPORT_HTML_H
// The report as one HTML file: the answer on the first screen, then each scene. Scripts are
// optional: without them the browser shows the numbers of a point as its title, and every method is
// drawn.

#include "session/report/report.h"

/// One file without network: the answer in a table, then each scene with its plots; works without
/// scripts, and with them points show their numbers and methods can be hidden; light, dark, and A4
/// in grey.
void hn_report_html(hn_strbuf *b, const hn_report *report);
#endif
