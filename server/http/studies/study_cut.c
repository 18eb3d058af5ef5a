// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/studies/study_cut.h"

#include <stdio.h>

void hn_study_report_cut(hn_studies *all) {
    const int lost = all->n_cut - all->n_cut_kept;
    if (all->n_cut_kept > 0) {
        fprintf(stderr,
                "holonom: the server ends while %d of its studies %s; what they have done is kept: "
                "the same request to a server with the same --runs continues from there\n",
                all->n_cut_kept, all->n_cut_kept == 1 ? "runs" : "run");
    }
    if (lost > 0) {
        fprintf(stderr, "holonom: the server ends while %d of its studies %s; %s\n", lost,
                lost == 1 ? "runs" : "run",
                all->opts->runs_folder
                    ? "not all that they have done could be written to the folder of --runs, and "
                      "the same request computes the rest again"
                    : "their results are lost; 'serve --runs DIR' keeps what "
                      "studies have done");
    }
    all->n_cut = all->n_cut_kept = 0;
}
