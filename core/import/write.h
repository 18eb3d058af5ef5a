// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_IMPORT_WRITE_H
#define HN_IMPORT_WRITE_H
// Writes the scene.

#include "import/build.h"

/// Adds the scene of `b` to `out` as JSON text.
void hn_im_write_scene(hn_build *b, hn_strbuf *out);

#endif
