// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_BUDGETS_BUDGETS_STORE_H
#define HN_SESSION_BUDGETS_BUDGETS_STORE_H
// The journal of unfinished budgets: a line for each method.

#include "session/budgets/budgets_internal.h"

/// Opens the journal of these budgets and reads what it holds. Fails as hn_journal_open().
HN_MUST_CHECK hn_status hn_budgets_open_journal(hn_budgets *budgets, hn_diags *diags);
/// Writes row i to the journal.
void hn_budgets_keep(hn_budgets *budgets, int i);
#endif
