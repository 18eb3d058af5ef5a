// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_STUDY_H
#define HN_CLI_STUDY_H
// What a study command may be about: one table of kinds, each kind a file study_KIND.c, and what they share.

#include "cli/shell/args.h"
#include "cli/shell/forms.h"
#include "session/model/model.h"

typedef struct hn_study_kind {
    const char *name;    ///< "work-precision", the word behind the scene
    const char *about;   ///< one clause for the list of kinds
    const char *options; ///< that it reads, separated by spaces; others are refused
    /// Faults that can be told before the scene is loaded. NULL: none.
    hn_status (*check)(const hn_args *args, hn_diags *diags);
    hn_exit (*run)(const hn_library *lib, const hn_args *args, const hn_model *model);
} hn_study_kind;

extern const hn_study_kind hn_study_kind_work_precision, hn_study_kind_budget,
    hn_study_kind_stability;

/// Of a work-precision study, whole or merged from parts.
extern const hn_forms hn_study_forms;

/// From here to the end Ctrl-C asks a study to stop instead of ending the program.
void hn_interrupt_begin(void);
void hn_interrupt_end(void);
int hn_is_interrupted(void *unused); ///< 1 once asked; as the `stop` of a study's hooks

/// HOLONOM_CACHE, or holonom in the user's folder for what can be computed again; made when it is not there. 0 when there is none.
int hn_find_cache(char out[400]);

// what people are told on standard error
/// The same folder, in `out`; NULL, and told, when there is none to keep unfinished work in.
const char *hn_study_folder(const hn_args *args, char out[400]);
/// "going on with 7 points from before"; nothing for 0.
void hn_study_tell_resumed(const hn_args *args, int n, const char *pieces);
/// How it ended before its end: on request, or by a budget [s] that left some of these pieces out.
void hn_study_tell_end(int stopped, int out_of_time, double budget, const char *pieces,
                       const char *folder);
#endif
