// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STUDY_WORK_H
#define HN_HTTP_STUDY_WORK_H
// One study as work: what a body asks for, and the job (session/kinds/job.h) that computes it.

#include "http/ground/http_opts.h"
#include "http/request/scene_request.h"
#include "session/kinds/job.h"

#include <stdatomic.h>
#include <stdbool.h>

typedef enum hn_study_state {
    HN_STUDY_RUNNING,
    HN_STUDY_FINISHED,
    HN_STUDY_STOPPED, ///< a part is done: `reason` says why no more
    HN_STUDY_FAILED   ///< there is no document
} hn_study_state;

/// The data of a study's thread. Once the thread runs it alone touches them, but for the atomics.
typedef struct hn_study_work {
    const hn_library *lib;
    const hn_job_kind *kind;
    hn_scene_request scene;
    cJSON *body; ///< owned: the values of the kind's fields; the job borrows its texts
    hn_model *model;
    hn_job_request request;
    char folder[512];           ///< where unfinished work is kept, if the server keeps runs
    hn_job *job;                ///< NULL before hn_study_work_run(), for kinds that open slowly
    double cpu_end;             ///< [s] of the thread's own clock
    const atomic_int *stopping; ///< the server ends
    struct hn_request *asker;   ///< while its body is read; NULL afterwards
    double load_end;  ///< until then the scene must have its equations [s, thread's own clock]
    bool computes;    ///< between the begin and the end of hn_study_work_run()
    double wall_end;  ///< of the computing, by the study's own time limit [s, wall clock]
    bool out_of_time; ///< equations were ended at wall_end
    bool is_kept;     ///< what its last run has done is in the folder
    int cpu_used_up;
    double cpu_spent, wall_spent; ///< by all runs that have ended [s]
    _Atomic double share;         ///< of the whole study that is done
    atomic_int stop;
} hn_study_work;

/// Outcome of a study.
typedef struct hn_study_result {
    hn_study_state state;
    hn_strbuf document; ///< JSON
    hn_strbuf report;   ///< HTML; empty when the kind has none
    char reason[HN_DIAG_MESSAGE], hint[HN_DIAG_HINT];
} hn_study_result;

/// Reads and checks a body and loads its scene; start from a zeroed work with `lib` and
/// `stopping` set; HN_ERR_STOPPED where the client of `asker` has gone. Fails:
/// HN_ERR_INPUT, HN_ERR_LIMIT and what the kind refuses before its computation; reported in diags
/// with pointers into the body. hn_study_work_reset() afterwards in any case.
HN_MUST_CHECK hn_status hn_study_work_read(hn_study_work *w, const cJSON *body,
                                           const hn_http_opts *opts, hn_diags *diags);
/// Computes until the end, the time limit, `cpu_seconds` of computing over all runs, or w->stop.
/// The document is complete JSON whatever the end; a study that failed, or was stopped before there
/// was anything to show, has none. A study that was stopped may be run again, by another thread
/// too: it goes on with what is left, once hn_study_work_again() was called.
void hn_study_work_run(hn_study_work *w, double cpu_seconds, hn_study_result *out);
/// Returns how much of `cpu_seconds` the runs so far have left [s].
double hn_study_work_left(const hn_study_work *w, double cpu_seconds);
/// Makes a stopped study ready to go on, for this wall time [s].
void hn_study_work_again(hn_study_work *w, double time_limit);
void hn_study_work_reset(hn_study_work *w);
#endif
