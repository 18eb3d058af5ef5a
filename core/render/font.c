// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/font.h"

#include "base/status.h"

#include <math.h>

// A glyph is a path of whole numbers: M x y moves, L x y draws a line, h x y and v x y draw a
// quarter of an ellipse that leaves horizontally or vertically and arrives the other way, q cx cy x
// y a quadratic curve.
typedef struct glyph_row {
    uint32_t code;
    int width;
    const char *path;
} glyph_row;

enum { SIDE = 3, STEPS = 8 }; // empty on either side of a glyph; chords in a quarter

static const glyph_row ascii[] = {
    {' ', 6, ""},
    {'!', 0, "M0 28L0 9M0 0L1 0L1 1L0 1"},
    {'"', 7, "M0 28L0 21M7 28L7 21"},
    {'#', 18, "M6 26L3 2M15 26L12 2M1 18L18 18M0 10L17 10"},
    {'$', 17, "M16 20v8 25h1 19v8 14L9 14h17 8v8 3h0 8M9 30L9 -2"},
    {'%', 24, "M22 28L2 0M5 16h10 22v5 28h0 22v5 16M19 0h24 6v19 12h14 6v19 0"},
    {'&', 20, "M20 0L5 19q3 22 3 24v8 28h13 24q13 20 7 16q0 12 0 7v8 0q17 0 19 12"},
    {'\'', 0, "M0 28L0 21"},
    {'(', 6, "M6 32q0 24 0 12q0 0 6 -8"},
    {')', 6, "M0 32q6 24 6 12q6 0 0 -8"},
    {'*', 12, "M6 28L6 14M0 24L12 18M12 24L0 18"},
    {'+', 16, "M0 12L16 12M8 4L8 20"},
    {',', 2, "M2 1L0 -5"},
    {'-', 10, "M0 12L10 12"},
    {'.', 1, "M0 0L1 0L1 1L0 1"},
    {'/', 12, "M0 -4L12 31"},
    {'0', 16, "M8 0h16 9L16 19v8 28h0 19L0 9v8 0"},
    {'1', 16, "M3 22L10 28L10 0"},
    {'2', 16, "M1 20v8 28h16 20q16 16 9 9L0 0L16 0"},
    {'3', 16, "M1 22v8 28h15 21v8 15L6 15M8 15h16 7v8 0h0 6"},
    {'4', 16, "M11 28L0 8L16 8M12 16L12 0"},
    {'5', 16, "M15 28L2 28L1 15q4 18 8 18h16 9v8 0h0 6"},
    {'6', 16, "M13 28q0 22 0 9v8 0h16 9v8 18h0 9"},
    {'7', 16, "M0 28L16 28L5 0"},
    {'8', 16, "M8 15h15 21v8 28h1 21v8 15h0 7v8 0h16 7v8 15"},
    {'9', 16, "M3 0q16 6 16 19v8 28h0 19v8 10h16 19"},
    {':', 1, "M0 17L1 17L1 18L0 18M0 0L1 0L1 1L0 1"},
    {';', 2, "M1 17L2 17L2 18L1 18M2 1L0 -5"},
    {'<', 15, "M15 21L0 12L15 3"},
    {'=', 16, "M0 16L16 16M0 8L16 8"},
    {'>', 15, "M0 21L15 12L0 3"},
    {'?', 14, "M0 21v7 28h14 21q14 17 10 14q7 11 7 8M7 0L7 0L7 1"},
    {'@', 26, "M19 18L19 9v22 6h26 14v13 28h0 12v13 -4q18 -4 22 -1M19 13v13 18h7 12v13 6h19 12"},
    {'A', 20, "M0 0L10 28L20 0M4 10L16 10"},
    {'B', 17, "M0 14L0 28L9 28h16 21v9 14L0 14L0 0L9 0h17 7v9 14"},
    {'C', 19, "M19 20v10 28h0 18L0 10v10 0h19 8"},
    {'D', 19, "M0 0L0 28L8 28h19 17L19 11v8 0L0 0"},
    {'E', 16, "M16 28L0 28L0 0L16 0M0 14L13 14"},
    {'F', 16, "M16 28L0 28L0 0M0 14L13 14"},
    {'G', 20, "M19 20v10 28h0 18L0 10v10 0h20 10L20 13L12 13"},
    {'H', 18, "M0 0L0 28M18 0L18 28M0 14L18 14"},
    {'I', 0, "M0 0L0 28"},
    {'J', 12, "M12 28L12 7v6 0h0 6"},
    {'K', 17, "M0 0L0 28M17 28L0 10M6 16L17 0"},
    {'L', 15, "M0 28L0 0L15 0"},
    {'M', 22, "M0 0L0 28L11 8L22 28L22 0"},
    {'N', 19, "M0 0L0 28L19 0L19 28"},
    {'O', 20, "M10 0h20 10L20 18v10 28h0 18L0 10v10 0"},
    {'P', 17, "M0 0L0 28L9 28h17 20v9 12L0 12"},
    {'Q', 20, "M10 0h20 10L20 18v10 28h0 18L0 10v10 0M13 7L20 -1"},
    {'R', 17, "M0 0L0 28L9 28h17 20v9 12L0 12M8 12L17 0"},
    {'S', 17, "M16 21v8 28h1 21v8 14L9 14h17 7v8 0h0 6"},
    {'T', 18, "M0 28L18 28M9 28L9 0"},
    {'U', 18, "M0 28L0 9v9 0h18 9L18 28"},
    {'V', 20, "M0 28L10 0L20 28"},
    {'W', 28, "M0 28L7 0L14 24L21 0L28 28"},
    {'X', 18, "M0 28L18 0M18 28L0 0"},
    {'Y', 18, "M0 28L9 13L18 28M9 13L9 0"},
    {'Z', 17, "M0 28L17 28L0 0L17 0"},
    {'[', 6, "M6 31L0 31L0 -7L6 -7"},
    {'\\', 12, "M0 31L12 -4"},
    {']', 6, "M0 31L6 31L6 -7L0 -7"},
    {'^', 12, "M0 20L6 28L12 20"},
    {'_', 17, "M0 -4L17 -4"},
    {'`', 4, "M0 28L4 23"},
    {'a', 14, "M14 20L14 0M14 13v7 20h0 12L0 8v7 0h14 7"},
    {'b', 14, "M0 28L0 0M0 13v7 20h14 12L14 8v7 0h0 7"},
    {'c', 13, "M13 15v7 20h0 12L0 8v7 0h13 5"},
    {'d', 14, "M14 28L14 0M14 13v7 20h0 12L0 8v7 0h14 7"},
    {'e', 14, "M0 10L14 10L14 12v7 20h0 12L0 8v7 0h13 4"},
    {'f', 9, "M10 28L9 28h4 22L4 0M0 19L9 19"},
    {'g', 14, "M14 20L14 -1v7 -8h1 -4M14 13v7 20h0 12L0 8v7 0h14 7"},
    {'h', 14, "M0 28L0 0M0 13v7 20h14 13L14 0"},
    {'i', 0, "M0 20L0 0M0 27L0 28"},
    {'j', 4, "M4 20L4 -3v-1 -8M4 27L4 28"},
    {'k', 13, "M0 28L0 0M12 20L0 8M5 13L13 0"},
    {'l', 4, "M0 28L0 4v4 0"},
    {'m', 22, "M0 20L0 0M0 14v6 20h11 14L11 0M11 14v17 20h22 14L22 0"},
    {'n', 14, "M0 20L0 0M0 13v7 20h14 13L14 0"},
    {'o', 14, "M7 0h14 8L14 12v7 20h0 12L0 8v7 0"},
    {'p', 14, "M0 20L0 -8M0 13v7 20h14 12L14 8v7 0h0 7"},
    {'q', 14, "M14 20L14 -8M14 13v7 20h0 12L0 8v7 0h14 7"},
    {'r', 9, "M0 20L0 0M0 12v8 20L9 20"},
    {'s', 12, "M12 16v6 20h0 15v6 10h12 5v6 0h0 4"},
    {'t', 9, "M4 26L4 5v9 0M0 19L9 19"},
    {'u', 14, "M0 20L0 7v7 0h14 7M14 20L14 0"},
    {'v', 14, "M0 20L7 0L14 20"},
    {'w', 22, "M0 20L5 0L11 18L17 0L22 20"},
    {'x', 13, "M0 20L13 0M13 20L0 0"},
    {'y', 14, "M0 20L7 0M14 20L4 -8"},
    {'z', 13, "M0 20L13 20L0 0L13 0"},
    {'{', 8, "M8 31v4 27L4 17h0 12h4 7L4 -3v8 -7"},
    {'|', 0, "M0 31L0 -7"},
    {'}', 8, "M0 31v4 27L4 17h8 12h4 7L4 -3v0 -7"},
    {'~', 16, "M0 10q4 16 8 12q12 8 16 14"},
};

static const glyph_row others[] = {
    {0x00B0, 8, "M4 20h8 24v4 28h0 24v4 20"},
    {0x00B2, 8, "M0 26v4 29h8 25q8 23 4 20L0 16L8 16"},
    {0x00B5, 14, "M0 20L0 -8M0 7v7 0h14 7M14 20L14 0"},
    {0x00B7, 1, "M0 12L1 12L1 13L0 13"},
    {0x00D7, 13, "M0 18L13 5M13 18L0 5"},
    {0x0394, 20, "M0 0L10 28L20 0L0 0"},
    {0x03BB, 14, "M0 28q3 28 5 22L14 0M8 13L0 0"},
    {0x03BC, 14, "M0 20L0 -8M0 7v7 0h14 7M14 20L14 0"},
    {0x03C6, 18, "M9 0h18 10v9 20h0 10v9 0M9 27L9 -8"},
    {0x2013, 15, "M0 12L15 12"},
    {0x2026, 16, "M0 0L1 0L1 1L0 1M8 0L9 0L9 1L8 1M16 0L17 0L17 1L16 1"},
    {0x2212, 16, "M0 12L16 12"},
};

static const glyph_row box = {0xFFFD, 14, "M0 0L14 0L14 26L0 26L0 0"};

static const glyph_row *find_row(uint32_t code) {
    if (code >= ' ' && code <= '~') {
        return &ascii[code - ' '];
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (others[i].code == code) {
            return &others[i];
        }
    }
    return &box;
}

static void add_point(hn_glyph *g, double x, double y) {
    HN_ASSERT(g->n_points < HN_FONT_MAX_POINTS);
    g->xy[2 * g->n_points] = x + SIDE;
    g->xy[2 * g->n_points + 1] = y;
    g->n_points++;
}

static void begin_line(hn_glyph *g, double x, double y) {
    HN_ASSERT((size_t)g->n_lines + 1 < sizeof g->start / sizeof *g->start);
    g->start[g->n_lines++] = g->n_points;
    add_point(g, x, y);
}

static void add_quarter(hn_glyph *g, char kind, double x0, double y0, double x, double y) {
    for (int i = 1; i <= STEPS; i++) {
        const double a = 1.57079632679489662 * i / STEPS;
        const double along = sin(a), across = 1 - cos(a);
        add_point(g, x0 + (x - x0) * (kind == 'h' ? along : across),
                  y0 + (y - y0) * (kind == 'h' ? across : along));
    }
}

static void add_quadratic(hn_glyph *g, double x0, double y0, double cx, double cy, double x,
                          double y) {
    for (int i = 1; i <= STEPS; i++) {
        const double t = (double)i / STEPS, u = 1 - t;
        add_point(g, u * u * x0 + 2 * u * t * cx + t * t * x,
                  u * u * y0 + 2 * u * t * cy + t * t * y);
    }
}

static int read_number(const char **path) {
    return (int)strtol(*path, (char **)path, 10);
}

void hn_font_glyph(uint32_t code, hn_glyph *out) {
    const glyph_row *row = find_row(code);
    const char *path = row->path;
    double x = 0, y = 0;
    out->advance = row->width + 2 * SIDE;
    out->n_lines = out->n_points = 0;

    // letter by letter of the path: where to, and how
    while (*path != '\0') {
        const char kind = *path++;
        const double first = read_number(&path), second = read_number(&path);
        double to_x = first, to_y = second;
        if (kind == 'M') {
            begin_line(out, to_x, to_y);
        } else if (kind == 'L') {
            add_point(out, to_x, to_y);
        } else if (kind == 'q') {
            to_x = read_number(&path);
            to_y = read_number(&path);
            add_quadratic(out, x, y, first, second, to_x, to_y);
        } else {
            HN_ASSERT(kind == 'h' || kind == 'v');
            add_quarter(out, kind, x, y, to_x, to_y);
        }
        x = to_x;
        y = to_y;
    }
    out->start[out->n_lines] = out->n_points;
}

double hn_font_advance(uint32_t code) {
    return find_row(code)->width + 2 * SIDE;
}

bool hn_font_has(uint32_t code) {
    return find_row(code) != &box;
}

uint32_t hn_utf8_next(const char **text) {
    const unsigned char *s = (const unsigned char *)*text;
    if (s[0] == 0) {
        return 0;
    }
    const int n = s[0] < 0x80             ? 1
                  : (s[0] & 0xe0) == 0xc0 ? 2
                  : (s[0] & 0xf0) == 0xe0 ? 3
                  : (s[0] & 0xf8) == 0xf0 ? 4
                                          : 0;
    uint32_t code = n <= 1 ? s[0] : s[0] & (0xffu >> (n + 1));
    for (int i = 1; i < n; i++) {
        if ((s[i] & 0xc0) != 0x80) {
            *text += 1;
            return 0xFFFD;
        }
        code = code << 6 | (s[i] & 0x3f);
    }
    *text += n > 0 ? n : 1;
    return n > 0 ? code : 0xFFFD;
}
