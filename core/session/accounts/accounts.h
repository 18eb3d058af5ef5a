// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_ACCOUNTS_H
#define HN_SESSION_ACCOUNTS_H
// Error and energy budgets (study/account/account.h) of several methods on one scene, as tables,
// documents and plots. With a folder each budget is kept when it is complete, so that the same
// request continues after the last complete one.

#include "session/job/job_request.h"
#include "study/account/account.h"

#include <stdbool.h>

enum { HN_ACCOUNTS_METHODS = 24 };

/// One method's account, or why there is none.
typedef struct hn_account_row {
    char spelling[HN_SPEC_MAX];
    hn_status status;             ///< HN_OK: `account` is one; HN_ERR_BUDGET: left out
    char reason[HN_DIAG_MESSAGE]; ///< why there is none, or why the run ended early; "" else
    hn_account account;
    /// [s] latest of the times T, T/2, T/4 ... until which the parts add up to the error; NaN: not
    /// searched, or not found
    double holds_until;
} hn_account_row;
#define HN_ACCOUNT_HOLDS 0.1 ///< difference of sum and error, over the larger: first order holds
/// Returns |sum of the parts - error| over the larger of them; NaN: there is no error at the end.
double hn_account_mismatch(const hn_account_row *row);
/// Returns false where the parts do not add up to the error: the error is beyond first order.
bool hn_account_holds(const hn_account_row *row);
enum { HN_ACCOUNT_NOTE = 200 };
/// Writes the sentence that says so, with the sum and the time until which it held; "" where it
/// holds.
void hn_account_note(const hn_model *model, const hn_account_row *row, char out[HN_ACCOUNT_NOTE]);
/// "done", "failed" (the run ended early), "refused" or "left out".
const char *hn_account_state(const hn_account_row *row);
/// Coordinate whose error it is; NULL: there is no error at the end.
const hn_coordinate *hn_account_coordinate(const hn_model *model, const hn_account_row *row);
/// Part i of the error (energy = 0, of HN_CAUSE_COUNT) or of the energy (1, of HN_BILL_COUNT); NaN:
/// unknown.
double hn_account_part(const hn_account_row *row, int energy, int i);

typedef struct hn_accounts hn_accounts;
/// Checks the request and takes up what an interrupted job of the same request left.
///
/// request  in  one model; methods: the scene's where it has none; time limit: none where it has
///              none
/// Returns owned in *out. The model and the texts of the request must outlive it.
/// Fails:   HN_ERR_INPUT and HN_ERR_LIMIT (methods, times), HN_ERR_IO as hn_journal_open(),
///          HN_ERR_MEMORY. All reported in diags.
HN_MUST_CHECK hn_status hn_accounts_open(const hn_job_request *request, hn_accounts **out,
                                         hn_diags *diags);
void hn_accounts_free(hn_accounts *accounts); ///< NULL is legal
/// Computes the missing budgets. Returns whether all are complete; false when it was stopped or out
/// of time. The row of a method without a budget gives the reason.
bool hn_accounts_run(hn_accounts *accounts);
bool hn_accounts_stopped(const hn_accounts *accounts),
    hn_accounts_out_of_time(const hn_accounts *accounts);

bool hn_accounts_lost(const hn_accounts *accounts);   ///< the journal could not be written
int hn_accounts_resumed(const hn_accounts *accounts); ///< budgets kept from an earlier run
/// Methods of the budget, and the account of method i.
int hn_accounts_n(const hn_accounts *accounts);
const hn_account_row *hn_accounts_at(const hn_accounts *accounts, int i);
/// Borrowed: what it was computed for.
const hn_model *hn_accounts_model(const hn_accounts *accounts);
double hn_accounts_time(const hn_accounts *accounts); ///< [s]

// documents

#endif
