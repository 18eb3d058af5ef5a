// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_STUDY_JOB_H
#define HN_TUI_STUDY_JOB_H
// A study of the scene shown, on a thread of its own: its plot is there while it is computed.

#include "session/kinds/job.h"
#include "terminal/cost_plot.h"
#include "terminal/map_plot.h"

typedef enum hn_tui_study_kind { HN_TUI_COST, HN_TUI_STABILITY, HN_TUI_STUDIES } hn_tui_study_kind;

/// The request of a study; copied.
typedef struct hn_tui_study_request {
    const hn_library *library;
    const hn_model_source *source;
    hn_tui_study_kind kind;
    const char *const *methods;
    int n_methods;
    double time;       ///< of motion [s]; 0: a short one, so that something is seen within seconds
    int columns, rows; ///< of a map
} hn_tui_study_request;

typedef struct hn_tui_study hn_tui_study;

/// Loads the scene once more and starts computing. Returns owned in *out. Fails: as
/// hn_model_load(), HN_ERR_LIMIT (no thread), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_tui_study_start(const hn_tui_study_request *request, hn_tui_study **out,
                                           hn_diags *diags);
/// Asks the thread to stop, waits for it and frees all. NULL is legal.
void hn_tui_study_free(hn_tui_study *s);
/// Asks it to stop; what is done stays to be seen.
void hn_tui_study_stop(hn_tui_study *s);
/// Returns whether it was asked to stop.
bool hn_tui_study_stopping(const hn_tui_study *s);
bool hn_tui_study_running(const hn_tui_study *s);
/// Returns whether it has come to its end with nothing left out: it was not stopped, and no limit
/// cut it.
bool hn_tui_study_is_whole(const hn_tui_study *s);
double hn_tui_study_share(const hn_tui_study *s); ///< of the whole that is done, 0 to 1
hn_tui_study_kind hn_tui_study_get_kind(const hn_tui_study *s);
double hn_tui_study_time(const hn_tui_study *s); ///< of motion [s]
/// Copies of the plot as it is now; of the kind that was started.
void hn_tui_study_cost(hn_tui_study *s, hn_cost_plot *out);
void hn_tui_study_map(hn_tui_study *s, hn_map_plot *out);
/// Writes which method is the cheapest for an error as it is typed (session/precision/wanted.h),
/// and its spelling; false: the study is no work-precision study that has come to its end, or the
/// text is no error.
bool hn_tui_study_wanted(const hn_tui_study *s, const char *wanted, hn_strbuf *b,
                         char spelling[HN_SPEC_MAX]);
/// Appends the result in words: classes and the cheapest methods, the agreement of a map, or the
/// fault; nothing before the end.
void hn_tui_study_words(hn_tui_study *s, hn_strbuf *b);
#endif
