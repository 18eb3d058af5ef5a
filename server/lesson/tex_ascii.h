// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LESSON_TEX_ASCII_H
#define HN_LESSON_TEX_ASCII_H
// Formulas for a terminal without UTF-8: \tfrac12\dot\theta_1^2 becomes 1/2 thetadot_1^2.

#include "base/strbuf.h"

/// Appends a TeX formula in ASCII: as hn_tex_text() gives it, with its letters and signs spelled
/// out. Names that would run together are kept apart by a blank.
void hn_tex_ascii(hn_strbuf *b, const char *tex);
#endif
