// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_BUDGETS_H
#define HN_SESSION_BUDGETS_H
// Error and energy budgets (study/budget/budget.h) of several methods on one scene, as tables,
// documents and plots. With a folder each budget is kept when it is complete, so that the same
// request continues after the last complete one.

#include "session/job/job_request.h"
#include "study/budget/budget.h"

#include <stdbool.h>

enum { HN_BUDGETS_METHODS = 24 };

/// One method's budget, or why there is none.
typedef struct hn_budget_row {
    char spelling[HN_SPEC_MAX];
    hn_status status;             ///< HN_OK: `budget` is one; HN_ERR_STOPPED: left out
    char reason[HN_DIAG_MESSAGE]; ///< why there is none, or why the run ended early; "" else
    hn_budget budget;
    /// [s] latest of the times T, T/2, T/4 ... until which the parts add up to the error; NaN: not
    /// searched, or not found
    double holds_until;
} hn_budget_row;
#define HN_BUDGET_HOLDS 0.1 ///< difference of sum and error, over the larger: first order holds
/// Returns |sum of the parts - error| over the larger of them; NaN: there is no error at the end.
double hn_budget_mismatch(const hn_budget_row *row);
/// Returns false where the parts do not add up to the error: the error is beyond first order.
bool hn_budget_holds(const hn_budget_row *row);
enum { HN_BUDGET_NOTE = 200 };
/// Writes the sentence that says so, with the sum and the time until which it held; "" where it
/// holds.
void hn_budget_note(const hn_model *model, const hn_budget_row *row, char out[HN_BUDGET_NOTE]);
/// "done", "failed" (the run ended early), "refused" or "left out".
const char *hn_budget_state(const hn_budget_row *row);
/// Coordinate whose error it is; NULL: there is no error at the end.
const hn_coordinate *hn_budget_coordinate(const hn_model *model, const hn_budget_row *row);
/// Part i of the error (energy = 0, of HN_CAUSE_COUNT) or of the energy (1, of HN_ENERGY_COUNT);
/// NaN: unknown.
double hn_budget_part(const hn_budget_row *row, int energy, int i);

typedef struct hn_budgets hn_budgets;
/// Checks the request and takes up what an interrupted job of the same request left.
///
/// request  in  one model; methods: the scene's where it has none; time limit: none where it has
///              none
/// Returns owned in *out. The model and the texts of the request must outlive it.
/// Fails:   HN_ERR_INPUT and HN_ERR_LIMIT (methods, times), HN_ERR_IO as hn_journal_open(),
///          HN_ERR_MEMORY. All reported in diags.
HN_MUST_CHECK hn_status hn_budgets_open(const hn_job_request *request, hn_budgets **out,
                                        hn_diags *diags);
void hn_budgets_free(hn_budgets *budgets); ///< NULL is legal
/// Computes the missing budgets. Returns whether all are complete; false when it was stopped or out
/// of time. The row of a method without a budget gives the reason. May be called again: it goes on
/// with what is missing, and has its whole time limit again.
bool hn_budgets_run(hn_budgets *budgets);
/// Sets the wall time that each later run has [s]; 0: no limit.
void hn_budgets_set_time_limit(hn_budgets *budgets, double time_limit);
bool hn_budgets_stopped(const hn_budgets *budgets),
    hn_budgets_out_of_time(const hn_budgets *budgets);

bool hn_budgets_lost(const hn_budgets *budgets);   ///< the journal could not be written
int hn_budgets_resumed(const hn_budgets *budgets); ///< budgets kept from an earlier run
/// Methods of the budget, and the budget of method i.
int hn_budgets_n(const hn_budgets *budgets);
const hn_budget_row *hn_budgets_at(const hn_budgets *budgets, int i);
/// Borrowed: what it was computed for.
const hn_model *hn_budgets_model(const hn_budgets *budgets);
double hn_budgets_time(const hn_budgets *budgets); ///< [s]

// documents

#endif
