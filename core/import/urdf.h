// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_IMPORT_URDF_H
#define HN_IMPORT_URDF_H
// URDF, the robot description of ROS: a tree of links and joints fixed to the ground.

#include "import/build.h"

/// Reads the element <robot> into `b`; returns 0 after a fault.
bool hn_im_read_urdf(hn_build *b, const xmlNode *root);

#endif
