// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_FORCE_ARROWS_H
#define HN_TUI_FORCE_ARROWS_H
// The joint forces of the selected method as arrows over the mechanism, while they are listed
// (reactions_view.h).

#include "render/snapshot.h"
#include "tui/workbench.h"

enum { HN_FORCE_ARROWS = 256 };

typedef struct hn_force_arrows {
    int n;
    hn_snapshot_load load[HN_FORCE_ARROWS]; ///< [N]; those that are rounding are left out
    double longest;                         ///< [N] what the longest arrow stands for
} hn_force_arrows;

/// Lists the forces that hn_reactions_update() has computed, the first HN_FORCE_ARROWS of them;
/// none while they are not listed. The scale stays while the largest force is between a third of
/// `longest` and all of it.
void hn_force_arrows_take(const hn_workbench *w, hn_force_arrows *out);
#endif
