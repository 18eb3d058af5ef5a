#ifndef HN_CLI_STUDY_H
#define HN_CLI_STUDY_H
// What a study command may be about: one table of kinds, each kind a file study_KIND.c, and what they share.

#include "cli/cli.h"

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

struct hn_study;
/// A work-precision study where --out, --json and --csv say, or as text; and the faults of these options, before anything is computed.
hn_exit hn_study_write(const hn_args *args, const struct hn_study *study);
HN_MUST_CHECK hn_status hn_study_check_output(const hn_args *args, hn_diags *diags);

/// From here to the end Ctrl-C asks a study to stop instead of ending the program.
void hn_interrupt_begin(void);
void hn_interrupt_end(void);
int hn_is_interrupted(void *unused); ///< 1 once asked; as the `stop` of a study's hooks

/// HOLONOM_CACHE, or holonom in the user's folder for what can be computed again; made when it is not there. 0 when there is none.
int hn_find_cache(char out[400]);
/// 1 when path ends in suffix and has something before it.
int hn_path_ends_in(const char *path, const char *suffix);
#endif
