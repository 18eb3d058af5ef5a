// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_PNG_FILE_H
#define HN_RENDER_PNG_FILE_H
// PNG files: one picture, or several one after another (APNG, PNG third edition, section 11.3.6).

#include "base/diag.h"
#include "base/interrupt.h"
#include "base/strbuf.h"

/// Appends a PNG file. rgb: 3 * width * height bytes, row by row from the top.
/// `interrupt` (may be NULL) is asked between rows.
/// Fails: HN_ERR_MEMORY, HN_ERR_STOPPED; the buffer then holds what it held before.
HN_MUST_CHECK hn_status hn_png_encode(hn_strbuf *out, int width, int height,
                                      const unsigned char *rgb, const hn_interrupt *interrupt,
                                      hn_diag *diag);
/// Appends an animated PNG made of n files of hn_png_encode() of one size. It runs for ever; each
/// picture stands for `ms` milliseconds, 1 to 65,535. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_png_animate(hn_strbuf *out, const hn_strbuf *frames, int n, int ms,
                                       hn_diag *diag);
#endif
