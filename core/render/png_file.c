// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/png_file.h"

#include <png.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <zlib.h>

static void append_bytes(png_structp png, png_bytep bytes, png_size_t n) {
    hn_strbuf_add_n(png_get_io_ptr(png), (const char *)bytes, n);
}

static void flush_nothing(png_structp png) {
    (void)png;
}

static void ignore_warning(png_structp png, png_const_charp text) {
    (void)png;
    (void)text;
}

_Noreturn static void leave(png_structp png, png_const_charp text) {
    (void)text;
    longjmp(*(jmp_buf *)png_get_error_ptr(png), 1);
}

/// The pixels of a picture, and what ends its writing early.
typedef struct pixels {
    int width, height;
    const unsigned char *rgb;
    const hn_interrupt *interrupt;
} pixels;

enum { ROWS = 64 }; // between two questions

/// libpng leaves by longjmp: everything it needs is passed in, so that no local changes between.
static bool write_png(png_structp png, png_infop info, const pixels *p, jmp_buf *back) {
    if (setjmp(*back) != 0) {
        return false;
    }
    png_set_IHDR(png, info, (png_uint_32)p->width, (png_uint_32)p->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);

    // drawings are flat: their rows repeat bytes, and differences between pixels break that up
    png_set_filter(png, 0, PNG_FILTER_NONE);
    png_write_info(png, info);
    for (int y = 0; y < p->height; y++) {
        if (y % ROWS == 0 && hn_interrupt_ask(p->interrupt)) {
            return false;
        }
        png_write_row(png, p->rgb + 3 * (size_t)y * (size_t)p->width);
    }
    png_write_end(png, info);
    return true;
}

hn_status hn_png_encode(hn_strbuf *out, int width, int height, const unsigned char *rgb,
                        const hn_interrupt *interrupt, hn_diag *diag) {
    const pixels p = {width, height, rgb, interrupt};
    jmp_buf back;
    const size_t before = out->n;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &back, leave, ignore_warning);
    png_infop info = png != NULL ? png_create_info_struct(png) : NULL;
    int written = 0;
    if (info != NULL) {
        png_set_write_fn(png, out, append_bytes, flush_nothing);
        written = write_png(png, info, &p, &back);
    }
    png_destroy_write_struct(png != NULL ? &png : NULL, info != NULL ? &info : NULL);
    if (!written || out->failed) {
        if (!out->failed && out->text != NULL) {
            out->n = before;
            out->text[before] = '\0';
        }
        return hn_interrupt_ask(interrupt)
                   ? hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL, "the PNG was not written")
                   : hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "no memory to write the PNG");
    }
    return HN_OK;
}

// ---- several pictures ----

enum { SIGNATURE = 8, CHUNK_HEAD = 8, CHUNK_END = 4 };

static void put_number(unsigned char *out, uint32_t x) {
    out[0] = (unsigned char)(x >> 24);
    out[1] = (unsigned char)(x >> 16);
    out[2] = (unsigned char)(x >> 8);
    out[3] = (unsigned char)x;
}

static uint32_t get_number(const char *at) {
    const unsigned char *x = (const unsigned char *)at;
    return (uint32_t)x[0] << 24 | (uint32_t)x[1] << 16 | (uint32_t)x[2] << 8 | x[3];
}

/// A chunk: its length, its name, `n` bytes in two pieces, and its check sum.
static void put_chunk(hn_strbuf *out, const char *name, const void *head, size_t n_head,
                      const void *body, size_t n_body) {
    unsigned char number[4];
    uLong sum = crc32(0, (const Bytef *)name, 4);
    sum = crc32(sum, head, (uInt)n_head);
    sum = n_body ? crc32(sum, body, (uInt)n_body) : sum;
    put_number(number, (uint32_t)(n_head + n_body));
    hn_strbuf_add_n(out, (const char *)number, 4);
    hn_strbuf_add_n(out, name, 4);
    hn_strbuf_add_n(out, head, n_head);
    hn_strbuf_add_n(out, body, n_body);
    put_number(number, (uint32_t)sum);
    hn_strbuf_add_n(out, (const char *)number, 4);
}

/// The control of a frame that covers the whole picture.
static void put_frame_control(hn_strbuf *out, uint32_t sequence, const char *header, int ms) {
    unsigned char control[26] = {0};
    put_number(control, sequence);
    memcpy(control + 4, header, 8); // width and height, as IHDR has them
    control[20] = (unsigned char)(ms >> 8);
    control[21] = (unsigned char)ms;
    control[22] = 1000 >> 8; // the delay is ms / 1000 s
    control[23] = 1000 & 0xff;
    put_chunk(out, "fcTL", control, sizeof control, "", 0);
}

/// The chunks of one frame: the first as they are, with the controls; of the others the image data.
static void put_frame(hn_strbuf *out, const hn_strbuf *file, int index, int n, int ms,
                      uint32_t *sequence) {
    const char *at = file->text + SIGNATURE, *const end = file->text + file->n;
    const char *header = at + CHUNK_HEAD;
    bool begun = false;
    while (at < end) {
        const uint32_t size = get_number(at);
        const char *name = at + 4, *body = at + CHUNK_HEAD;
        unsigned char number[4];
        if (memcmp(name, "IDAT", 4) == 0 && !begun) {
            put_frame_control(out, (*sequence)++, header, ms);
            begun = true;
        }
        if (memcmp(name, "IDAT", 4) == 0 && index > 0) {
            put_number(number, (*sequence)++);
            put_chunk(out, "fdAT", number, sizeof number, body, size);
        } else if (index == 0 && memcmp(name, "IEND", 4) != 0) {
            hn_strbuf_add_n(out, at, CHUNK_HEAD + (size_t)size + CHUNK_END);
        }
        if (memcmp(name, "IHDR", 4) == 0 && index == 0) {
            unsigned char control[8] = {0}; // the number of frames, and 0: for ever
            put_number(control, (uint32_t)n);
            put_chunk(out, "acTL", control, sizeof control, "", 0);
        }
        at = body + size + CHUNK_END;
    }
}

hn_status hn_png_animate(hn_strbuf *out, const hn_strbuf *frames, int n, int ms, hn_diag *diag) {
    HN_ASSERT(out && frames && n >= 1 && ms >= 1 && ms <= 65535);
    uint32_t sequence = 0;
    hn_strbuf_add_n(out, frames[0].text, SIGNATURE);
    for (int i = 0; i < n; i++) {
        put_frame(out, &frames[i], i, n, ms, &sequence);
    }
    put_chunk(out, "IEND", "", 0, "", 0);
    return out->failed ? hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "no memory for the pictures")
                       : HN_OK;
}
