// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/zip_file.h"

#include <stdio.h>
#include <string.h>
#include <zlib.h>

// Source: PKWARE, APPNOTE.TXT 6.3, sections 4.3.7 (local header), 4.3.12 (central directory),
// 4.3.16.
enum { END_SIZE = 22, CENTRAL_SIZE = 46, LOCAL_SIZE = 30, MOST_COMMENT = 65535 };
enum { ENCRYPTED = 1, STORED = 0, DEFLATED = 8 };

static uint32_t read16(const unsigned char *p) {
    return (uint32_t)p[0] | (uint32_t)p[1] << 8;
}

static uint32_t read32(const unsigned char *p) {
    return read16(p) | read16(p + 2) << 16;
}

/// The end of the central directory, searched from behind: a comment may follow it.
static const unsigned char *find_end(const unsigned char *bytes, size_t n) {
    for (size_t back = END_SIZE; back <= n && back <= END_SIZE + MOST_COMMENT; back++) {
        if (memcmp(bytes + n - back, "PK\5\6", 4) == 0) {
            return bytes + n - back;
        }
    }
    return NULL;
}

hn_status hn_zip_list(const char *text, size_t n, hn_zip_entry **out, int *n_entries,
                      hn_diag *diag) {
    const unsigned char *bytes = (const unsigned char *)text;
    const unsigned char *end = find_end(bytes, n);
    *out = NULL;
    *n_entries = 0;
    if (!end) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "this is not a zip archive");
    }
    const size_t count = read16(end + 10);
    size_t at = read32(end + 16);
    hn_zip_entry *list = calloc(count < HN_ZIP_MOST ? count + 1 : HN_ZIP_MOST, sizeof *list);
    if (!list) {
        return HN_ERR_MEMORY;
    }

    // entry by entry; one that does not lie within the archive ends the list
    for (size_t i = 0; i < count && *n_entries < HN_ZIP_MOST - 1; i++) {
        const unsigned char *p = bytes + at;
        if (at + CENTRAL_SIZE > n || memcmp(p, "PK\1\2", 4) != 0) {
            free(list);
            return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "the zip archive is damaged");
        }
        const size_t name = read16(p + 28);
        hn_zip_entry *e = &list[*n_entries];
        if (at + CENTRAL_SIZE + name <= n && name > 0 && name < HN_ZIP_NAME &&
            p[CENTRAL_SIZE + name - 1] != '/') {
            *e = (hn_zip_entry){.packed = read32(p + 20),
                                .size = read32(p + 24),
                                .offset = read32(p + 42),
                                .method = read16(p + 8) & ENCRYPTED ? -1 : (int)read16(p + 10)};
            memcpy(e->name, p + CENTRAL_SIZE, name);
            ++*n_entries;
        }
        at += CENTRAL_SIZE + name + read16(p + 30) + read16(p + 32);
    }
    *out = list;
    return HN_OK;
}

static hn_status inflate_to(const unsigned char *from, size_t n, size_t most, hn_strbuf *text,
                            hn_diag *diag) {
    unsigned char piece[16384];
    z_stream z = {.next_in = (unsigned char *)from, .avail_in = (uInt)n};
    size_t written = 0;
    int state = inflateInit2(&z, -MAX_WBITS);

    // piece by piece, so that a small archive cannot fill the memory
    while (state == Z_OK && written <= most) {
        z.next_out = piece;
        z.avail_out = sizeof piece;
        state = inflate(&z, Z_NO_FLUSH);
        const size_t got = sizeof piece - z.avail_out;
        hn_strbuf_add_n(text, (const char *)piece, got);
        written += got;
        if (got == 0 && state == Z_OK && z.avail_in == 0) {
            state = Z_DATA_ERROR; // the stream is cut
        }
    }

    inflateEnd(&z);
    if (written > most) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL,
                           "a file in the archive is larger than %zu bytes", most);
    }
    return state == Z_STREAM_END
               ? HN_OK
               : hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "the zip archive is damaged");
}

hn_status hn_zip_read(const char *text, size_t n, const hn_zip_entry *e, size_t most,
                      hn_strbuf *out, hn_diag *diag) {
    const unsigned char *bytes = (const unsigned char *)text;

    // the local header; what it says must lie inside the archive
    if ((size_t)e->offset + LOCAL_SIZE > n || memcmp(bytes + e->offset, "PK\3\4", 4) != 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "the zip archive is damaged");
    }
    const unsigned char *p = bytes + e->offset;
    const size_t at = (size_t)e->offset + LOCAL_SIZE + read16(p + 26) + read16(p + 28);
    if (at > n || e->packed > n - at) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "the zip archive is damaged");
    }

    // by the way it is packed
    if (e->method == DEFLATED) {
        return inflate_to(bytes + at, e->packed, most, out, diag);
    }
    if (e->method != STORED) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           e->method < 0 ? "the zip archive is encrypted"
                                         : "the zip archive is packed by method %d; only stored "
                                           "and deflated files are read",
                           e->method);
    }
    if (e->packed > most) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL,
                           "a file in the archive is larger than %zu bytes", most);
    }
    hn_strbuf_add_n(out, (const char *)bytes + at, e->packed);
    return HN_OK;
}
