// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LESSON_TEX_TEXT_H
#define HN_LESSON_TEX_TEXT_H
// Formulas for a terminal: \dot q^{\top} M\ddot q becomes q̇ᵀ M q̈.

#include "base/strbuf.h"

/// Appends a TeX formula as Unicode text. Rows of aligned formulas and of cases go on lines of
/// their own; a matrix becomes [a, b; c, d]. A command that is not known keeps its name. Output is
/// bounded by a few times the input.
void hn_tex_text(hn_strbuf *b, const char *tex);
#endif
