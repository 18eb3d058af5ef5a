// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_BUDGET_TEXT_H
#define HN_CLI_BUDGET_TEXT_H
// Error and energy budgets as text for a terminal, method by method.

#include "session/budgets/budgets.h"

/// The budget for people.
void hn_budgets_text(hn_strbuf *b, const hn_budgets *budgets);
/// A bar for every part of every error.
void hn_budgets_bars_text(hn_strbuf *b, const hn_budgets *budgets);
#endif
