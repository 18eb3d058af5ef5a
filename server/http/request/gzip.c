// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/gzip.h"

#include "http/request/guard.h"

#include <stdbool.h>
#include <string.h>
#include <zlib.h>

enum {
    WINDOW = 15 + 16,
    MEMORY = 8,
    LEAST = 1024
}; // 16: a gzip header; texts below are sent as they are

int hn_gzip_accepted(const hn_request *r) {
    const char *accept = hn_request_header(r, "Accept-Encoding");
    return accept && hn_accepts(accept, "gzip");
}

bool hn_gzip_is_worth(const char *media_type, size_t n) {
    return media_type && n >= LEAST &&
           (strncmp(media_type, "text/", 5) == 0 || strstr(media_type, "json") ||
            strncmp(media_type, "image/svg", 9) == 0);
}

int hn_gzip(hn_strbuf *out, const char *bytes, size_t n) {
    unsigned char piece[1 << 14];
    z_stream z = {0};
    if (deflateInit2(&z, Z_BEST_SPEED, Z_DEFLATED, WINDOW, MEMORY, Z_DEFAULT_STRATEGY) != Z_OK) {
        return 0;
    }
    z.next_in = (unsigned char *)(uintptr_t)bytes; // the library does not write to it
    z.avail_in = (unsigned)n;
    int status = Z_OK;
    while (status == Z_OK) {
        z.next_out = piece;
        z.avail_out = sizeof piece;
        status = deflate(&z, Z_FINISH);
        hn_strbuf_add_n(out, (const char *)piece, sizeof piece - z.avail_out);
    }
    deflateEnd(&z);
    return status == Z_STREAM_END && !out->failed;
}

void hn_reply_compress(hn_request *r, size_t most) {
    if (r->response || r->text.n > most || !hn_gzip_is_worth(r->media_type, r->text.n) ||
        !hn_gzip_accepted(r)) {
        return;
    }
    hn_strbuf small;
    hn_strbuf_init(&small);
    if (hn_gzip(&small, hn_strbuf_text(&r->text), r->text.n)) {
        hn_strbuf_reset(&r->text);
        r->text = small;
        hn_request_count_answer(r);
        hn_reply_header_add(r, "Content-Encoding", "gzip");
        hn_reply_header_add(r, "Vary", "Accept-Encoding");
    } else {
        hn_strbuf_reset(&small);
    }
}
