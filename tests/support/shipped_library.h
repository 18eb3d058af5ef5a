// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_SHIPPED_LIBRARY_H
#define HN_SUPPORT_SHIPPED_LIBRARY_H
// The library of shipped scenes, for a group of tests that read it and leave it as it is.

#include "session/model/library.h"

/// Open between the two calls below.
extern hn_library *hn_test_library;
/// Setup and teardown of a group of tests.
int hn_test_library_open(void **state);
int hn_test_library_close(void **state);

#endif
