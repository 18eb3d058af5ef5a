// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STUDY_H
#define HN_SESSION_STUDY_H
// A work-precision study of a scene: reference solution, ladders, documents. What takes long is
// kept in a folder: references (by the scene's hash and the time), and unfinished studies, line by
// line, so that the same request goes on where it was interrupted, at whatever moment that was.

#include "session/job/job_request.h"
#include "study/truth/chaos.h"
#include "study/cost/pareto.h"

typedef struct hn_study hn_study;

/// The methods of a study that names none.
const char *const *hn_study_standard(int *n);

/// Checks the request, finds or computes the reference solution, and takes up what an interrupted
/// study of the same request left.
///
/// request  in  one model; methods: hn_study_standard() where it has none; time limit: 60 s where
///              it has none. Values: "levels" (sizes per method, 7), "samples" (of time per point,
///              HN_WP_SAMPLES; 0: none), "shard" ("2/4": the part of the study; the whole).
/// Returns owned in *out. The model and the texts of the request must outlive it.
/// Fails:   as hn_ref_create() and hn_wp_create(); HN_ERR_INPUT: the request; HN_ERR_IO: another
///          program computes this very study. All reported in diags.
HN_MUST_CHECK hn_status hn_study_open(const hn_job_request *request, hn_study **out,
                                      hn_diags *diags);
void hn_study_free(hn_study *study); ///< NULL is legal; what was kept of an unfinished study stays
/// Runs what is left. Returns 1 when the study is finished, and then nothing of it is kept but the
/// reference; 0: stopped, or out of its budget.
int hn_study_run(hn_study *study);
void hn_study_forget(
    hn_study *study); ///< after a run: deletes what is kept of it, but the reference

// parts

typedef struct hn_study_part_text {
    const char *name; ///< of the file, for messages
    const char *text;
    size_t n;
} hn_study_part_text;

const hn_wp *hn_study_wp(const hn_study *study);
const hn_class *hn_study_classes(const hn_study *study); ///< one per method, after a run
const hn_model *hn_study_model(const hn_study *study);
/// How fast neighbouring motions part, and what that means in words. A study to beyond the horizon,
/// from which differences of HN_STUDY_TINY are as large as HN_STUDY_LARGE, ranks nothing but energy
/// and gaps. A part of a study does not ask.
const hn_chaos *hn_study_chaos(const hn_study *study);
#define HN_STUDY_TINY 1e-13 ///< what rounding leaves of some thousand steps
#define HN_STUDY_LARGE 0.1  ///< no digit is left

int hn_study_resumed(const hn_study *study);        ///< points taken up from an interrupted study
int hn_study_kept_reference(const hn_study *study); ///< 1: the reference was read, not computed

// documents
#endif
