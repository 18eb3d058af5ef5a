// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/kitty_image.h"

#include "base/base64.h"

#include <stdlib.h>
#include <zlib.h>

enum { PIECE = 4096, FAST = 1 }; // characters of base64; level of zlib

/// Returns the pixels compressed and in base64.
static bool pack(hn_strbuf *packed, const unsigned char *rgb, size_t n) {
    uLongf size = compressBound(n);
    unsigned char *bytes = malloc(size);
    const bool good = bytes && compress2(bytes, &size, rgb, n, FAST) == Z_OK;
    if (good) {
        hn_base64(packed, bytes, size);
    }
    free(bytes);
    return good && !packed->failed;
}

bool hn_kitty_show(hn_strbuf *b, const unsigned char *rgb, int width, int height, int columns,
                   int rows, int id) {
    hn_strbuf packed;
    hn_strbuf_init(&packed);
    const bool good = pack(&packed, rgb, (size_t)3 * (size_t)width * (size_t)height);
    const char *text = hn_strbuf_text(&packed);

    // the first piece says what it is; m=1: more pieces follow; q=2: no answer
    for (size_t at = 0; good && at < packed.n; at += PIECE) {
        const size_t n = packed.n - at < PIECE ? packed.n - at : PIECE;
        hn_strbuf_add(b, "\033_G");
        if (at == 0) {
            hn_strbuf_printf(b, "a=T,f=24,o=z,C=1,i=%d,s=%d,v=%d,c=%d,r=%d,", id, width, height,
                             columns, rows);
        }
        hn_strbuf_printf(b, "q=2,m=%d;", at + n < packed.n);
        hn_strbuf_add_n(b, text + at, n);
        hn_strbuf_add(b, "\033\\");
    }
    hn_strbuf_reset(&packed);
    return good;
}

void hn_kitty_remove(hn_strbuf *b, int id) {
    hn_strbuf_printf(b, "\033_Ga=d,d=I,q=2,i=%d\033\\", id);
}
