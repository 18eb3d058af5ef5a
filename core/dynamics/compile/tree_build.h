// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_TREE_BUILD_H
#define HN_DYNAMICS_TREE_BUILD_H
// Building the spanning tree of a scene (tree.h): links by breadth-first search over the joints,
// their coordinates, and their frames (tree_frames.h).

#include "base/arena.h"
#include "base/diag.h"
#include "dynamics/compile/tree.h"

#include <stdbool.h>

/// Builds the tree of a scene, with memory from `arena`. The tree is of least depth in bodies
/// (breadth first from the ground, ties by the order of the joints).
///
/// align  in  1: angles count from where a body's arms lie along its axes, which makes expressions
///            short; 0: an absolute angle is a plain sum of the scene's, for equations to be read
/// Fails: HN_ERR_INPUT when joints marked "cut" leave a body hanging, or a free joint would close
///        a loop; HN_ERR_MEMORY
HN_MUST_CHECK hn_status hn_tree_build(const hn_scene *scene, bool align, hn_arena *arena,
                                      hn_tree *out, hn_diags *diags);
#endif
