// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STUDY_H
#define HN_SESSION_STUDY_H
// A work-precision study of a scene: reference solution, ladders of sizes, documents. A folder
// keeps the expensive results: references, by the scene's hash and the end time; and unfinished
// studies, line by line, so that the same request continues where it was interrupted.

#include "session/job/job_request.h"
#include "study/cost/pareto.h"
#include "study/truth/chaos.h"

#include <stdbool.h>

typedef struct hn_study hn_study;

/// Returns the methods of a study whose request names none.
const char *const *hn_study_standard(int *n);

/// Checks the request, finds or computes the reference solution, and resumes an interrupted study
/// of the same request.
///
/// request  in  one model; methods: hn_study_standard() where it has none; time limit: 60 s where
///              it has none. Values: "levels" (sizes per method, 7), "samples" (of time per point,
///              HN_WP_SAMPLES; 0: none), "shard" ("2/4": the part of the study; the whole).
/// Returns owned in *out. The model and the texts of the request must outlive it.
/// Fails:   as hn_ref_create() and hn_wp_create(); HN_ERR_INPUT: the request; HN_ERR_IO: another
///          program computes this very study. All reported in diags.
HN_MUST_CHECK hn_status hn_study_open(const hn_job_request *request, hn_study **out,
                                      hn_diags *diags);
void hn_study_free(hn_study *study); ///< NULL is legal; the journal of an unfinished study stays
/// Runs the remaining points. Returns whether the study is finished; its journal is then deleted,
/// the reference stays. Returns false when it was stopped or the time limit was reached. May be
/// called again: it goes on with the points that are left, and has its whole time limit again.
bool hn_study_run(hn_study *study);
/// Sets the wall time that each later run has [s]; 0: no limit.
void hn_study_set_time_limit(hn_study *study, double time_limit);
void hn_study_forget(hn_study *study); ///< after a run: deletes its journal; the reference stays

// parts

typedef struct hn_study_part_text {
    const char *name; ///< of the file, for messages
    const char *text;
    size_t n;
} hn_study_part_text;

/// Borrowed: the points, and what they were computed for.
const hn_wp *hn_study_wp(const hn_study *study);
const hn_class *hn_study_classes(const hn_study *study); ///< one per method, after a run
const hn_model *hn_study_model(const hn_study *study);
/// Returns the estimate of how fast neighbouring motions diverge, with a sentence. Beyond the
/// horizon, where a difference of HN_STUDY_TINY has grown to HN_STUDY_LARGE, a study ranks methods
/// by energy and constraint violation only. A part of a study makes no estimate.
const hn_chaos *hn_study_chaos(const hn_study *study);
#define HN_STUDY_TINY 1e-13 ///< rounding error of some thousand steps
#define HN_STUDY_LARGE 0.1  ///< no correct digit is left

bool hn_study_lost(const hn_study *study);           ///< the journal could not be written
int hn_study_resumed(const hn_study *study);         ///< points resumed from an interrupted study
bool hn_study_kept_reference(const hn_study *study); ///< read, not computed

/// Returns at how many times the errors of every complete run were taken; 0: there is none.
int hn_study_times(const hn_study *study);
/// Writes the times that errors are taken at, a sentence without its stop.
void hn_study_put_times(hn_strbuf *b, const hn_study *study);

// documents
#endif
