// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/external/ida_words.h"

#include <ida/ida.h>
#include <stdio.h>
#include <string.h>

static const struct {
    int flag;
    hn_status status;
    const char *words;
} FLAGS[] = {
    {IDA_TOO_MUCH_WORK, HN_ERR_STOPPED, "the steps allowed are used up"},
    {IDA_TOO_MUCH_ACC, HN_ERR_INPUT, "the tolerances are smaller than rounding lets it reach"},
    {IDA_ERR_FAIL, HN_ERR_STEP_UNDERFLOW,
     "the error test failed again and again, or the step fell to the smallest one"},
    {IDA_CONV_FAIL, HN_ERR_NO_CONVERGENCE, "the corrector did not converge"},
    {IDA_LINIT_FAIL, HN_ERR_INTERNAL, "the linear solver could not be set up"},
    {IDA_LSETUP_FAIL, HN_ERR_SINGULAR, "the matrix of the corrector could not be factored"},
    {IDA_LSOLVE_FAIL, HN_ERR_SINGULAR, "the matrix of the corrector could not be solved with"},
    {IDA_RES_FAIL, HN_ERR_DIVERGED, "the equations could not be evaluated"},
    {IDA_REP_RES_ERR, HN_ERR_DIVERGED, "the equations have no finite value here"},
    {IDA_CONSTR_FAIL, HN_ERR_NO_CONVERGENCE, "a bound on the unknowns could not be kept"},
    {IDA_FIRST_RES_FAIL, HN_ERR_DIVERGED, "the equations have no finite value at the start"},
    {IDA_NLS_SETUP_FAIL, HN_ERR_SINGULAR, "the matrix of the corrector could not be factored"},
    {IDA_NLS_FAIL, HN_ERR_NO_CONVERGENCE, "the corrector failed"},
    {IDA_MEM_FAIL, HN_ERR_MEMORY, "out of memory"},
    {IDA_ILL_INPUT, HN_ERR_INPUT, "it refused its input"},
};
enum { N_FLAGS = sizeof FLAGS / sizeof *FLAGS };

hn_status hn_ida_status(int flag, double t, char *why, size_t size) {
    if (flag >= 0) {
        return HN_OK;
    }
    const char *words = "it failed";
    hn_status status = HN_ERR_INTERNAL;
    for (int i = 0; i < N_FLAGS; i++) {
        if (FLAGS[i].flag == flag) {
            words = FLAGS[i].words;
            status = FLAGS[i].status;
        }
    }
    snprintf(why, size, "IDA: %s at t = %.6g s (flag %d)", words, t, flag);
    return status;
}

void hn_ida_add_remedy(const hn_ida_problem *p, hn_status status, char *why, size_t size) {
    const int n = p->nc - p->n_kept;
    const size_t used = strlen(why);
    const bool stuck = status == HN_ERR_NO_CONVERGENCE || status == HN_ERR_STEP_UNDERFLOW;
    if (!stuck || p->form == HN_FORM_GGL) {
        return;
    }
    if (n > 0) {
        snprintf(why + used, size - used,
                 ": %d of %d constraint equations depend on the others; use ggl@ida or projection",
                 n, p->nc);
    } else if (p->form == HN_FORM_INDEX3) {
        snprintf(why + used, size - used,
                 ": at index 3 rounding errors of the multipliers grow as 1/h^2; use index2@ida");
    }
}
