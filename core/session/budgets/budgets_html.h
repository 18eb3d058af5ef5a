// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_BUDGETS_BUDGETS_HTML_H
#define HN_SESSION_BUDGETS_BUDGETS_HTML_H
// Accounts as one HTML file: no network, no script. Both pictures, and every number in tables.

#include "session/budgets/budgets.h"

/// One file without network or script: both pictures, and their numbers as tables; light, dark, and
/// A4.
void hn_budgets_html(hn_strbuf *b, const hn_budgets *budgets);
#endif
