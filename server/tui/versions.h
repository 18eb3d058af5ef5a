// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_VERSIONS_H
#define HN_TUI_VERSIONS_H
// The history for undo and redo: scene, settings and methods after every change.

#include "tui/workbench.h"

enum { HN_TUI_VERSIONS = 32 };

typedef struct hn_version {
    char scene[HN_TUI_LINE];
    char names[HN_TUI_SETTINGS][64];
    double values[HN_TUI_SETTINGS];
    int n_settings;
    char methods[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    int n_methods;
} hn_version;

struct hn_versions {
    int n, now; ///< versions kept; index of the one that is open
    bool going; ///< a version is being opened: it is not kept again
    hn_version at[HN_TUI_VERSIONS];
};

hn_versions *hn_versions_create(void); ///< NULL: no memory
void hn_versions_free(hn_versions *v); ///< NULL is legal
/// Keeps what is open now as the newest version; those that were undone are forgotten. A copy of
/// the present version is not kept again.
void hn_versions_keep(hn_workbench *w);
/// Writes what is otherwise in version `to` than in version `from`: "l1 = 2.5".
void hn_versions_change(const hn_versions *v, int from, int to, char *out, size_t size);
#endif
