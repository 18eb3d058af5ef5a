// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_FILLED_ORIGIN_H
#define HN_CLASS_FILLED_ORIGIN_H
// Scene and parameters for which a program with blanks was written: its text says both.

#include "base/diag.h"
#include "scene/scene.h"

#include <stdbool.h>

/// Returns whether the text is a program that `holonom export` wrote for a scene, of any name: its
/// first lines say so.
bool hn_filled_origin_is_known(const char *text);
/// Compares what the text says with the scene that it is graded against. A parameter that the text
/// does not define by a plain number is not compared. Fails: HN_ERR_INPUT where they differ, with
/// the difference and what to try in diag.
HN_MUST_CHECK hn_status hn_filled_origin_check(const hn_scene *scene, const char *text,
                                               hn_diag *diag);

#endif
