// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_SCENE_TEXT_H
#define HN_SUPPORT_SCENE_TEXT_H
// Scenes that a test has as JSON text. A scene that cannot be read stops the test with its fault.

#include "scene/scene.h"

/// Returns owned (hn_scene_free).
hn_scene *hn_test_scene(const char *text);
/// Returns how many shapes of a kind the scene draws.
int hn_test_count_shapes(const hn_scene *scene, hn_shape_kind kind);

#endif
