// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STUDY_FIELDS_H
#define HN_HTTP_STUDY_FIELDS_H
// The fields of POST /studies: the scene, the kind, and the fields of all kinds that are served;
// and those of PATCH /studies/{id}.

#include "session/job/field.h"

enum { HN_STUDY_FIELDS = 24 };

/// Ends with a row without a name. Filled by hn_study_fields_fill() before the server answers
/// anything.
extern hn_field hn_study_fields[HN_STUDY_FIELDS];
/// The fields of a change, filled at the same time.
extern hn_field hn_study_change[3];
/// Fills the tables from the registry of jobs (session/kinds/job.h). A study computes for at most
/// `most_seconds`, and for as long where its body says nothing.
void hn_study_fields_fill(double most_seconds);
/// The field of the time limit, in the table.
const hn_field *hn_study_fields_time_limit(void);
#endif
