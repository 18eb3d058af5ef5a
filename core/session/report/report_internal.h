// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REPORT_INTERNAL_H
#define HN_SESSION_REPORT_INTERNAL_H
// The state of a report, shared by report.c (computing), report_words.c (summary), report_plot.c
// (plots), report_html.c and report_doc.c (documents).

#include "session/report/report.h"

struct hn_report {
    hn_job_request request; ///< methods and time limit filled in
    int n;
    hn_report_scene scenes[HN_JOB_SCENES];
    double started, elapsed; ///< wall clock [s]
    int stopped, no_memory;
    // while it is made
    int at;       ///< the present scene
    double until; ///< when the present part of it has to end, wall clock [s]
};

#endif
