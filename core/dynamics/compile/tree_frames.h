// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_TREE_FRAMES_H
#define HN_DYNAMICS_TREE_FRAMES_H
// The frames of a spanning tree (tree.h): the groups of parallel revolute axes, and how each link
// stands in the frame of its group. Two passes over the links, parents first; the coordinates are
// numbered between them.

#include "dynamics/compile/tree.h"

#include <stdbool.h>

/// Chooses the frame of everything that does not rotate: that of the first revolute axis that hangs
/// on the ground. Links before it are placed in the world's axes; the tree has links and order.
void hn_tree_choose_ground_frame(const hn_scene *scene, hn_tree *tree);

/// Gives each link its group, its angle and the constant rotation in the group's frame.
///
/// align  in  as in hn_tree_build
void hn_tree_place_links(const hn_scene *scene, hn_tree *tree, bool align);
#endif
