// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_BUDGETS_INTERNAL_H
#define HN_SESSION_BUDGETS_INTERNAL_H
// The inside of budgets: budgets.c (life and making), budgets_store.c (what is kept of
// unfinished ones), budgets_doc.c, budgets_html.c and budgets_plot.c (documents).

#include "session/budgets/budgets.h"
#include "session/store/journal.h"

struct hn_budgets {
    const hn_model *model;
    hn_job_request request; ///< time, time limit and methods filled in
    int n;
    hn_method_spec specs[HN_BUDGETS_METHODS];
    hn_budget_row rows[HN_BUDGETS_METHODS]; ///< HN_ERR_STOPPED until there is one
    bool whole[HN_BUDGETS_METHODS];         ///< the row needs no more work
    hn_journal journal;
    int resumed, stopped, out_of_time;
    double deadline; ///< wall clock [s]; infinite: none
    int at;          ///< the present one
    int coordinate;  ///< 1 + the user coordinate whose error is split; 0: the largest
};

#endif
