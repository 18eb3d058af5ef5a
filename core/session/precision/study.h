#ifndef HN_SESSION_STUDY_H
#define HN_SESSION_STUDY_H
// A work-precision study of a scene: reference solution, ladders, documents. What takes long is kept in a folder: references
// (by the scene's hash and the time), and unfinished studies, line by line, so that the same request goes on where it was
// interrupted, at whatever moment that was.

#include "session/model/model.h"
#include "study/truth/chaos.h"
#include "study/cost/pareto.h"

typedef struct hn_study hn_study;

typedef struct hn_study_request {
    const char *const *methods; ///< spellings; steps and tolerances in them are replaced by ladders
    int n_methods;              ///< 0: hn_study_standard()
    double time;                ///< [s]; NaN: the scene's
    double budget;              ///< wall time [s]; NaN: 60; 0: none
    int levels;                 ///< sizes per method; 0: 7
    int samples;                ///< of time per point; 0: HN_WP_SAMPLES; -1: none
    int shard, n_shards;        ///< part 1..n_shards of the study (study/cost/shards.h); 0, 0: the whole
    const char *build;  ///< what the program calls itself, for parts of a study; NULL: not told
    const char *folder; ///< where references and unfinished studies are kept; NULL: nowhere
    int keep; ///< 1: what is kept of it stays when it is finished too, until hn_study_forget()
    hn_wp_hooks
        hooks; ///< `stop` and `progress` are asked and told, also while the reference is computed
} hn_study_request;
hn_study_request hn_study_request_default(void);

/// The methods of a study that names none.
const char *const *hn_study_standard(int *n);

/// Checks the request, finds or computes the reference, takes up what an interrupted study of the same request left. The model and the
/// request's texts must outlive it. Fails as hn_ref_create() and hn_wp_create() do; HN_ERR_IO: another program is at this very study.
HN_MUST_CHECK hn_status hn_study_open(const hn_model *model, const hn_study_request *request,
                                      hn_study **out, hn_diags *diags);
void hn_study_free(hn_study *study); ///< NULL is legal; what was kept of an unfinished study stays
/// Runs what is left. Returns 1 when the study is finished, and then nothing of it is kept but the reference; 0: stopped, or out of its budget.
int hn_study_run(hn_study *study);
void hn_study_forget(
    hn_study *study); ///< after a run: deletes what is kept of it, but the reference

// parts
/// What a part of a study has to hand over: JSON that holds the scene, the request, the reference and this part's points.
void hn_study_part(hn_strbuf *b, const hn_study *study);

typedef struct hn_study_part_text {
    const char *name; ///< of the file, for messages
    const char *text;
    size_t n;
} hn_study_part_text;
/// The study that these parts are of, as hn_study_run() would have left it: the same numbers (but a clock's) however it was split,
/// whatever the order, and as often as one is given. Overlapping parts are allowed. Fails: HN_ERR_INPUT, told: a text that is no part, parts
/// that contradict each other (in which field), parts that are missing or unfinished (which). HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_study_merge(const hn_study_part_text *parts, int n, hn_study **out,
                                       hn_diags *diags);

const hn_wp *hn_study_wp(const hn_study *study);
const hn_class *hn_study_classes(const hn_study *study); ///< one per method, after a run
const hn_model *hn_study_model(const hn_study *study);
/// How fast neighbouring motions part, and what that means in words. A study to beyond the horizon, from which differences of
/// HN_STUDY_TINY are as large as HN_STUDY_LARGE, ranks nothing but energy and gaps. A part of a study does not ask.
const hn_chaos *hn_study_chaos(const hn_study *study);
#define HN_STUDY_TINY 1e-13 ///< what rounding leaves of some thousand steps
#define HN_STUDY_LARGE 0.1  ///< no digit is left

int hn_study_resumed(const hn_study *study);        ///< points taken up from an interrupted study
int hn_study_kept_reference(const hn_study *study); ///< 1: the reference was read, not computed

// documents
void hn_study_json(hn_strbuf *b, const hn_study *study);
/// One row a point, with a head.
void hn_study_csv(hn_strbuf *b, const hn_study *study);
/// One file without network: plots, tables, sentences; light and dark, for the screen and for paper.
void hn_study_html(hn_strbuf *b, const hn_study *study);
#endif
