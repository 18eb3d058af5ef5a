// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/budget/budget_state.h"

#include <string.h>

double *hn_budget_work_record(const hn_budget_work *b, size_t k) {
    return b->record + k * b->width;
}

void hn_budget_work_present(const hn_budget_work *b, double *y) {
    memcpy(y, b->steps->now.q, (size_t)b->info.nq * sizeof *y);
    memcpy(y + b->info.nq, b->steps->now.v, (size_t)b->info.nv * sizeof *y);
}

int hn_budget_work_asked_to_stop(const hn_budget_work *b, double share) {
    if (b->opts->progress) {
        b->opts->progress(b->opts->user, share);
    }
    return b->opts->stop && b->opts->stop(b->opts->user);
}
