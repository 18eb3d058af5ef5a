// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_LOOK_H
#define HN_RENDER_LOOK_H
// The one table of colours, dashes, markers and glyphs. The page (through its JSON), the snapshot,
// the report and the terminal read it, so that a method looks the same everywhere. Colour is never
// the only difference.

#include "base/strbuf.h"

#include <stdint.h>

/// Slots 0..7 are for methods, as many as a comparison takes; slot 8 is the grey of the reference
/// solution.
enum { HN_LOOK_METHODS = 8, HN_LOOK_REFERENCE = 8, HN_LOOK_SLOTS = 9, HN_LOOK_MAX_DASH = 6 };

typedef enum hn_theme { HN_THEME_LIGHT, HN_THEME_DARK, HN_THEME_COUNT } hn_theme;

#define HN_MARKER_LIST(X)             \
    X(HN_MARKER_DISC, "disc")         \
    X(HN_MARKER_SQUARE, "square")     \
    X(HN_MARKER_TRIANGLE, "triangle") \
    X(HN_MARKER_DIAMOND, "diamond")   \
    X(HN_MARKER_CROSS, "cross")       \
    X(HN_MARKER_RING, "ring")         \
    X(HN_MARKER_PLUS, "plus")         \
    X(HN_MARKER_BOX, "box")           \
    X(HN_MARKER_DOT, "dot")
typedef enum hn_marker {
#define HN_MARKER_ENUM(code, name) code,
    HN_MARKER_LIST(HN_MARKER_ENUM)
#undef HN_MARKER_ENUM
        HN_MARKER_COUNT
} hn_marker;

typedef struct hn_look {
    const char *name;                ///< of the colour, for people
    uint32_t colour[HN_THEME_COUNT]; ///< 0xRRGGBB
    int n_dash;                      ///< 0: a full line
    double dash[HN_LOOK_MAX_DASH];   ///< on, off, ... in pixels for a line 2 px wide
    hn_marker marker;
    const char *glyph; ///< for the terminal, UTF-8, one column wide
} hn_look;

/// The row of a slot 0..8.
const hn_look *hn_look_get(int slot);
/// The slot of the i-th method of a list: 0..7, then from 0 again.
int hn_look_slot(int i);

/// The glyph of the i-th method of a list: those of the slots, then HN_LOOK_GLYPHS - 8 others, and
/// from the first again.
enum { HN_LOOK_GLYPHS = 13 };
const char *hn_look_glyph(int i);

/// Colours of everything but methods: surfaces and inks.
typedef struct hn_surface {
    uint32_t paper;    ///< behind everything
    uint32_t raised;   ///< the second level: insets, panels
    uint32_t ink;      ///< text
    uint32_t muted;    ///< captions, ground, guides
    uint32_t hairline; ///< borders
    uint32_t tear;     ///< the gap at a cut joint
} hn_surface;
const hn_surface *hn_surface_get(hn_theme theme);

/// Writes the table: {"surfaces":{"light":{"paper":"#FCFCFA",...},"dark":{...}},
/// "slots":[{"slot":0,"name","light","dark","dash":[...],"marker","glyph"}, ... 8 methods],
/// "reference":{the same}}
void hn_look_json(hn_strbuf *b);

#endif
