// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_ACCOUNTS_ACCOUNTS_STORE_H
#define HN_SESSION_ACCOUNTS_ACCOUNTS_STORE_H
// The journal of unfinished accounts: a line for each method.

#include "session/accounts/accounts_internal.h"

/// Opens the journal of these accounts and reads what it holds. Fails as hn_journal_open().
HN_MUST_CHECK hn_status hn_accounts_open_journal(hn_accounts *accounts, hn_diags *diags);
/// Writes row i to the journal.
void hn_accounts_keep(hn_accounts *accounts, int i);
#endif
