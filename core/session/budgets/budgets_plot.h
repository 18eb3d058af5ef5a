// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_BUDGETS_BUDGETS_PLOT_H
#define HN_SESSION_BUDGETS_BUDGETS_PLOT_H
// The plot of budgets: a bar for each method, a block for each part.

#include "session/budgets/budgets.h"

#include <stdbool.h>

/// Returns whether one of the rows has an error at the end (energy = 0), an energy budget (1) to
/// draw.
bool hn_budgets_can_plot(const hn_budget_row *rows, int n, int energy);
/// One <svg> element: where the errors come from (energy = 0) or who put energy in (1), a bar a
/// row; colours as in study_plot.h.
void hn_budgets_plot(hn_strbuf *b, const hn_model *model, const hn_budget_row *rows, int n,
                     int energy);
#endif
