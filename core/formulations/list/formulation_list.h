// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_FORMULATION_LIST_H
#define HN_FORMULATIONS_FORMULATION_LIST_H
// The list of all formulations. A new formulation is one file in formulations/rows and one line
// here.

#include "formulations/ground/formulation.h"

/// In the order of `list methods`, the page and the API.
#define HN_FORMULATION_LIST(X) \
    X(index1)                  \
    X(baumgarte)               \
    X(projection)              \
    X(nullspace)               \
    X(nullspace_as_printed)    \
    X(partitioning)            \
    X(reduced)                 \
    X(penalty)                 \
    X(augmented_lagrangian)    \
    X(udwadia_kalaba)          \
    X(ggl)                     \
    X(index2)                  \
    X(index3)                  \
    X(ali3p)                   \
    X(symmetric_projection)    \
    X(nullspace_solver)        \
    X(nullspace_tangent)       \
    X(nullspace_untracked)

#define HN_FORMULATION_DECLARE(name) extern const hn_formulation hn_formulation_##name;
HN_FORMULATION_LIST(HN_FORMULATION_DECLARE)
#undef HN_FORMULATION_DECLARE

/// The table of formulations: its length, and row i of it.
int hn_formulation_count(void);
const hn_formulation *hn_formulation_at(int i);
/// The formulation of this name ("baumgarte"); NULL when unknown.
const hn_formulation *hn_formulation_find(const char *name);
/// Returns the first formulation of the list that has all traits in `have` and none in `lack`;
/// NULL: there is none.
const hn_formulation *hn_formulation_with(unsigned have, unsigned lack);

#endif
