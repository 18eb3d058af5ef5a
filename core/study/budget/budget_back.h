// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_BUDGET_BACK_H
#define HN_STUDY_BUDGET_BACK_H
// The second half of an error budget: from the end of a run back to its start. Each part of each
// step is carried to the end of the run, where the parts add up to the error; see budget.h (2).

#include "study/budget/budget_state.h"

/// Finds the error at the end T [s] of the recorded run and splits it by cause, into b->out:
/// coordinate, error, part and sum. Fails: HN_ERR_NO_CONVERGENCE (the exact motion, or the flow
/// beside a step, could not be followed), HN_ERR_DIVERGED (the end of the run is not finite),
/// HN_ERR_STOPPED (stopped on request).
HN_MUST_CHECK hn_status hn_budget_work_look_back(hn_budget_work *b, double T, hn_diag *diag);
#endif
