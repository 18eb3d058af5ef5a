// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/sixel_image.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { SLOTS = 1024, MOST_BITS_OUT = 7, FIRST_SIXEL = 63, SHORTEST_RUN = 4 };

/// The colours of a picture, found by a table of hashes.
typedef struct palette {
    uint32_t colour[HN_SIXEL_COLOURS];
    int16_t slot[SLOTS]; ///< index of a colour + 1; 0: free
    int n, bits_out;     ///< lower bits of a shade that are left out
} palette;

/// A picture with a number of its palette for each pixel.
typedef struct picture {
    int width, height;
    unsigned char *index;
    palette colours;
} picture;

/// A shade without its lower bits, in the middle of those that share it.
static uint32_t coarse(unsigned shade, int bits_out) {
    const unsigned middle = bits_out > 0 ? 1u << (bits_out - 1) : 0;
    return (shade >> bits_out << bits_out) + middle;
}

static uint32_t colour_of(const unsigned char *pixel, int bits_out) {
    return coarse(pixel[0], bits_out) << 16 | coarse(pixel[1], bits_out) << 8 |
           coarse(pixel[2], bits_out);
}

/// The number of a colour, which is added where it is new; -1: there is no room for it.
static int number_of(palette *p, uint32_t colour) {
    uint32_t at = (colour * 2654435761u) >> 22;
    while (p->slot[at] != 0 && p->colour[p->slot[at] - 1] != colour) {
        at = (at + 1) % SLOTS;
    }
    if (p->slot[at] == 0) {
        if (p->n == HN_SIXEL_COLOURS) {
            return -1;
        }
        p->colour[p->n] = colour;
        p->slot[at] = (int16_t)++p->n;
    }
    return p->slot[at] - 1;
}

/// Numbers all pixels; false: there are more colours than a palette has.
static bool number_pixels(picture *p, const unsigned char *rgb, int bits_out) {
    const size_t n = (size_t)p->width * (size_t)p->height;
    memset(&p->colours, 0, sizeof p->colours);
    p->colours.bits_out = bits_out;
    for (size_t i = 0; i < n; i++) {
        // most pixels are what the one before is
        if (i > 0 && memcmp(rgb + 3 * i, rgb + 3 * i - 3, 3) == 0) {
            p->index[i] = p->index[i - 1];
            continue;
        }
        const int number = number_of(&p->colours, colour_of(rgb + 3 * i, bits_out));
        if (number < 0) {
            return false;
        }
        p->index[i] = (unsigned char)number;
    }
    return true;
}

/// A sixel n times; from a few on with a count.
static void put_run(hn_strbuf *b, int sixel, int n) {
    const char character = (char)(FIRST_SIXEL + sixel);
    if (n >= SHORTEST_RUN) {
        hn_strbuf_printf(b, "!%d%c", n, character);
    } else {
        hn_strbuf_add_n(b, (const char[]){character, character, character}, (size_t)n);
    }
}

/// One colour of a band: `bits` holds a sixel a column. Blanks behind the last are left out.
static void put_colour(hn_strbuf *b, int number, const unsigned char *bits, int width) {
    hn_strbuf_printf(b, "#%d", number);
    int end = width;
    while (end > 0 && bits[end - 1] == 0) {
        end--;
    }
    for (int x = 0, run; x < end; x += run) {
        for (run = 1; x + run < end && bits[x + run] == bits[x]; run++) {}
        put_run(b, bits[x], run);
    }
    hn_strbuf_add(b, "$");
}

/// One band; `bits` is scratch for a row of sixels of each colour, all 0 before and after.
static void put_band(hn_strbuf *b, const picture *p, int top, unsigned char *bits) {
    bool used[HN_SIXEL_COLOURS] = {false};
    for (int y = top; y < top + HN_SIXEL_BAND && y < p->height; y++) {
        const unsigned char *row = p->index + (size_t)y * (size_t)p->width;
        for (int x = 0; x < p->width; x++) {
            used[row[x]] = true;
            bits[(size_t)row[x] * (size_t)p->width + (size_t)x] |= (unsigned char)(1 << (y - top));
        }
    }
    for (int k = 0; k < p->colours.n; k++) {
        if (used[k]) {
            unsigned char *of = bits + (size_t)k * (size_t)p->width;
            put_colour(b, k, of, p->width);
            memset(of, 0, (size_t)p->width);
        }
    }
    hn_strbuf_add(b, "-");
}

static unsigned per_cent(uint32_t shade) {
    return (100 * (shade & 0xff) + 127) / 255;
}

/// The whole sequence; false: no memory.
static bool put_picture(hn_strbuf *b, const picture *p) {
    unsigned char *bits = calloc((size_t)p->colours.n, (size_t)p->width);
    if (!bits) {
        return false;
    }

    // square pixels, the size, the palette
    hn_strbuf_printf(b, "\033P0;1q\"1;1;%d;%d", p->width, p->height);
    for (int k = 0; k < p->colours.n; k++) {
        const uint32_t c = p->colours.colour[k];
        hn_strbuf_printf(b, "#%d;2;%u;%u;%u", k, per_cent(c >> 16), per_cent(c >> 8), per_cent(c));
    }
    for (int y = 0; y < p->height; y += HN_SIXEL_BAND) {
        put_band(b, p, y, bits);
    }
    hn_strbuf_add(b, "\033\\");
    free(bits);
    return true;
}

bool hn_sixel_show(hn_strbuf *b, const unsigned char *rgb, int width, int height) {
    picture p = {.width = width, .height = height};
    p.index = malloc((size_t)width * (size_t)height);
    int bits_out = 0;
    while (p.index && bits_out < MOST_BITS_OUT && !number_pixels(&p, rgb, bits_out)) {
        bits_out++;
    }

    // two shades of each colour always fit
    const bool good = p.index && (bits_out < MOST_BITS_OUT || number_pixels(&p, rgb, bits_out)) &&
                      put_picture(b, &p);
    free(p.index);
    return good;
}
