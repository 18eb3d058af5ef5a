// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXPORT_SCENE_NAMES_H
#define HN_SESSION_EXPORT_SCENE_NAMES_H
// The scene's coordinates in those of an exported program, where they are others.

#include "session/export/places.h"

/// Adds a line for each coordinate of the scene that is none of the program, with its rate:
/// "a2 = theta_coupler - th1, wa2 = omega_coupler - w1"; an orientation takes one line. Adds
/// nothing where all are the same.
void hn_export_put_scene_names(hn_strbuf *b, const hn_exporter *e, int indent);
#endif
