// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STUDY_INTERNAL_H
#define HN_SESSION_STUDY_INTERNAL_H
// The internal structure of a study, for study.c (life cycle), study_store.c (files), study_part.c
// and study_merge.c (parts), study_doc.c and study_html.c (documents).

#include "session/precision/study.h"
#include "session/store/journal.h"

#define HN_PART_STUDY "part of work-precision" ///< member "study" of a part
enum { HN_PART_FORMAT = 3 }; // counts up when the meaning of a part's fields changes

struct hn_study {
    const hn_model *model;
    hn_model *own_model;    ///< of a merged study: the scene came with the parts
    hn_job_request request; ///< time, time limit and methods filled in
    hn_ref *ref;
    hn_wp *wp;
    hn_class classes[HN_WP_METHODS];
    int resumed, kept_reference;
    hn_chaos chaos; ///< `why` "": no estimate was made
    hn_journal journal;
};

/// Computes `chaos` and the horizon of the study. When the limits stop it, `chaos.why` says that
/// the answer is not known.
void hn_study_find_chaos(hn_study *study, const hn_walk_limits *limits);

#endif
