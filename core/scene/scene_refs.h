// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SCENE_SCENE_REFS_H
#define HN_SCENE_SCENE_REFS_H
// References by name that several parts of the reader follow: each fault says what is named and
// what is there.

#include "scene/reader.h"

/// A coordinate by its own or (if `rates`) its rate's name at node; -1 after a fault.
int hn_rd_coordinate(hn_reader *r, const char *name, int rates);
/// The point under `key`, which must be there; -1 after a fault.
int hn_rd_end(hn_reader *r, const cJSON *node, const char *key);
/// The coordinate of "joint" (a joint with one only) or "coordinate"; -1 after a fault. `position`:
/// its value is needed, so that an entry of a rotation vector is refused.
int hn_rd_target(hn_reader *r, const cJSON *node, int position);

#endif
