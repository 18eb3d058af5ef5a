// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STUDY_FIELDS_H
#define HN_HTTP_STUDY_FIELDS_H
// The fields of POST /studies: the scene, the kind, and the fields of all kinds that are served.

#include "session/job/field.h"

enum { HN_STUDY_FIELDS = 24 };

/// Ends with a row without a name. Filled by hn_study_fields_fill() before the server answers
/// anything.
extern hn_field hn_study_fields[HN_STUDY_FIELDS];
/// Fills the table from the registry of jobs (session/kinds/job.h).
void hn_study_fields_fill(void);
#endif
