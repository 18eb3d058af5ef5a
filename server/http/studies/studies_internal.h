// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STUDIES_INTERNAL_H
#define HN_HTTP_STUDIES_INTERNAL_H
// Shared by studies.c (life of the resource) and studies_kinds.c (what each kind of study does).

#include "http/request/scene_request.h"
#include "http/studies/studies.h"

#include <stdatomic.h>

/// What is asked for; owns what it names.
typedef struct hn_study_order {
    hn_scene_request scene;
    char *methods[HN_STUDIES_METHODS];
    int n_methods;
    double time;   ///< [s]; NaN: the scene's
    double budget; ///< wall time [s]
    int levels, samples;
    char *preset, *over; ///< of a map
    int columns, rows;
} hn_study_order;

typedef enum hn_study_state {
    HN_STUDY_RUNNING,
    HN_STUDY_FINISHED,
    HN_STUDY_STOPPED, ///< a part is done: `reason` says why no more
    HN_STUDY_FAILED   ///< there is no document
} hn_study_state;

/// What the thread of a study works on. It alone touches it once it runs, but for the atomics.
typedef struct hn_study_work {
    const struct hn_study_kind_row *kind;
    const hn_library *lib;
    hn_study_order order;
    hn_model *model;
    void *prepared;  ///< of the kind
    double cpu_end;  ///< [s] of the thread's own clock
    double wall_end; ///< [s, monotonic] of the budget, for kinds that do not keep it themselves
    int cpu_used_up, out_of_time;
    _Atomic double share; ///< of the whole study
    atomic_int stop;
} hn_study_work;

/// How a study ended.
typedef struct hn_study_result {
    hn_study_state state;
    hn_strbuf document; ///< JSON
    hn_strbuf report;   ///< HTML; empty when the kind has none
    char reason[HN_DIAG_MESSAGE], hint[HN_DIAG_HINT];
} hn_study_result;

typedef struct hn_study_kind_row {
    const char *name;
    int most_methods;
    const char *
        options; ///< members of the body that it takes besides scene, settings, methods, time and budget
    /// Checks what can be told quickly, before the thread starts. NULL: nothing.
    hn_status (*prepare)(hn_study_work *w, hn_diags *diags);
    /// Runs to the end or until told to stop. The document is complete JSON whatever the end, but not when it failed.
    void (*run)(hn_study_work *w, hn_study_result *out);
    void (*release)(hn_study_work *w); ///< what `prepare` made; NULL: nothing
} hn_study_kind_row;

/// NULL when there is none of that name.
const hn_study_kind_row *hn_study_kind_find(const char *name);
#endif
