// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STUDY_CUT_H
#define HN_HTTP_STUDY_CUT_H
// Studies that the end of the server cuts short: what is said of them.

#include "http/studies/study_places.h"

/// Reports on standard error how many studies the end of the server stopped, and whether what they
/// have done is in the folder of runs; once. With the lock held, when their threads have ended.
void hn_study_report_cut(hn_studies *all);
#endif
