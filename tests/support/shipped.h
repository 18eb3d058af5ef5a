// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_SHIPPED_H
#define HN_SUPPORT_SHIPPED_H
// Checks of a scene of the library that hold for any mechanism. Failures stop the test and name the
// scene.

#include "session/model/model.h"

/// At so many random states near the start, closed again: J and gamma against differences; M
/// symmetric and positive where loops allow motion; accelerations by two solvers and speeds by two
/// formulations alike; the balance of every body; loops that do no work.
void shipped_obeys_mechanics(hn_library *lib, int scene, int states);
#endif
