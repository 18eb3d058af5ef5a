// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_BUDGETS_BUDGETS_DOC_H
#define HN_SESSION_BUDGETS_BUDGETS_DOC_H
// Accounts as JSON and as CSV.

#include "session/budgets/budgets.h"

/// {"scene","title","time","methods":[{"method","state","reason","t","steps",
///  "error":{"coordinate","unit","value","sum","mismatch","holds","holds_until",
///  "parts":{cause: number or null}} or null,
///  "energy":{"change","swing","conservative","loops_back_and_forth","parts":{item: number}}}...]},
/// energies in J; from "t" on only where there is a budget.
void hn_budgets_json(hn_strbuf *b, const hn_budgets *budgets);
/// Writes a head and a row for each method; unknown values are empty cells.
void hn_budgets_csv(hn_strbuf *b, const hn_budgets *budgets);
/// Writes one entry of "methods".
void hn_budget_put(hn_strbuf *b, const hn_model *model, const hn_budget_row *row);
#endif
