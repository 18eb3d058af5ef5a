// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_STUDY_STORE_H
#define HN_SESSION_PRECISION_STUDY_STORE_H
// What is kept of an unfinished study between two runs of the program: a line a point, a line a
// sample of time.

#include "session/precision/study_internal.h"

/// Opens the journal of this study and reads what it holds into the study. Fails as
/// hn_journal_open().
HN_MUST_CHECK hn_status hn_store_open(hn_study *study, hn_diags *diags);
/// What of a point is no clock's: members of the open object. `q`: n_user values.
void hn_store_put_point(hn_strbuf *b, const hn_study *study, int m, int k);
/// The same back; 0 when it is none, and then the point is not to be used.
int hn_store_take_point(const hn_study *study, const cJSON *o, hn_wp_point *p);
/// One more sample of time; 0 when it cannot be one.
int hn_store_take_sample(hn_wp_point *p, double cpu, double busy);
void hn_store_keep_point(hn_study *study, int m, int k);
void hn_store_keep_sample(hn_study *study, int m, int k);
#endif
