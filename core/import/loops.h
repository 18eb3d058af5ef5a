// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_IMPORT_LOOPS_H
#define HN_IMPORT_LOOPS_H
// The loop file: joints that close loops, constraints and gravity, as JSON beside a model that
// cannot say them.

#include "import/build.h"

/// Reads the text into `b`; returns 0 after a fault.
bool hn_im_read_loops(hn_build *b, const char *text, size_t n);

#endif
