// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_ACCOUNTS_INTERNAL_H
#define HN_SESSION_ACCOUNTS_INTERNAL_H
// The inside of accounts: accounts.c (life and making), accounts_store.c (what is kept of
// unfinished ones), accounts_doc.c, accounts_html.c and accounts_plot.c (documents).

#include "session/accounts/accounts.h"
#include "session/store/journal.h"

struct hn_accounts {
    const hn_model *model;
    hn_job_request request; ///< time, time limit and methods filled in
    int n;
    hn_method_spec specs[HN_ACCOUNTS_METHODS];
    hn_account_row rows[HN_ACCOUNTS_METHODS]; ///< HN_ERR_BUDGET until there is one
    hn_journal journal;
    int resumed, stopped, out_of_time;
    double deadline; ///< wall clock [s]; infinite: none
    int at;          ///< the present one
};

#endif
