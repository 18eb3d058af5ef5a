// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/look.h"

// Found by random search with the hue of each row held, for the largest smallest distance: at least
// 20 apart (CIE76) in normal, protan and deutan sight, at least 3.1:1 against the paper.
// tests/unit/render/test_look.c computes both for every pair.
static const hn_look looks[HN_LOOK_SLOTS] = {
    {"blue", {0x0A49D5, 0x6B99DB}, 0, {0}, HN_MARKER_DISC, "\xe2\x97\x8f"},
    {"orange", {0xCE7D06, 0xE1800E}, 2, {8, 4}, HN_MARKER_SQUARE, "\xe2\x96\xa0"},
    {"green", {0x0EA55D, 0x3FE49C}, 2, {2, 4}, HN_MARKER_TRIANGLE, "\xe2\x96\xb2"},
    {"purple", {0x801975, 0xC115F7}, 4, {10, 4, 2, 4}, HN_MARKER_DIAMOND, "\xe2\x97\x86"},
    {"red", {0x872138, 0xD4393F}, 2, {16, 4}, HN_MARKER_CROSS, "\xe2\x9c\x95"},
    {"cyan", {0x049BCD, 0x90E3F8}, 6, {8, 4, 2, 4, 2, 4}, HN_MARKER_RING, "\xe2\x97\x8b"},
    {"yellow", {0x615704, 0xFFE000}, 2, {5, 7}, HN_MARKER_PLUS, "+"},
    {"lime", {0x1E2400, 0xD2F67E}, 4, {14, 3, 6, 3}, HN_MARKER_BOX, "\xe2\x96\xa1"},
    {"grey", {0x7C8087, 0x878D96}, 0, {0}, HN_MARKER_DOT, "\xc2\xb7"},
};

static const hn_surface surfaces[HN_THEME_COUNT] = {
    [HN_THEME_LIGHT] = {0xFCFCFA, 0xF2F3F0, 0x1A1D21, 0x5C626A, 0xD5D8D6, 0xD81E1E},
    [HN_THEME_DARK] = {0x14171B, 0x1D2126, 0xE8E9E6, 0xA0A6AE, 0x353B43, 0xFF5C50},
};

static const char *const marker_names[HN_MARKER_COUNT] = {
#define HN_MARKER_ROW(code, name) name,
    HN_MARKER_LIST(HN_MARKER_ROW)
#undef HN_MARKER_ROW
};

static const char *const theme_names[HN_THEME_COUNT] = {"light", "dark"};

/// "circle" and so on: the word of the page and of the legend.
static const char *marker_name(hn_marker marker) {
    HN_ASSERT((int)marker >= 0 && marker < HN_MARKER_COUNT);
    return marker_names[marker];
}

const hn_look *hn_look_get(int slot) {
    HN_ASSERT(slot >= 0 && slot < HN_LOOK_SLOTS);
    return &looks[slot];
}

int hn_look_slot(int i) {
    HN_ASSERT(i >= 0);
    return i % HN_LOOK_METHODS;
}

const char *hn_look_glyph(int i) {
    static const char *const others[HN_LOOK_GLYPHS - HN_LOOK_METHODS] = {
        "\xe2\x96\xb3", "\xe2\x97\x87", "\xe2\x96\xbd", "\xe2\x96\xbc", "$"};
    HN_ASSERT(i >= 0);
    i %= HN_LOOK_GLYPHS;
    return i < HN_LOOK_METHODS ? looks[i].glyph : others[i - HN_LOOK_METHODS];
}

const hn_surface *hn_surface_get(hn_theme theme) {
    HN_ASSERT((int)theme >= 0 && theme < HN_THEME_COUNT);
    return &surfaces[theme];
}

static void put_colour(hn_strbuf *b, const char *key, uint32_t rgb) {
    hn_json_key(b, key);
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_strbuf_printf(&text, "#%06X", (unsigned)rgb);
    b->failed |= text.failed;
    hn_json_string(b, hn_strbuf_text(&text));
    hn_strbuf_reset(&text);
}

static void put_look(hn_strbuf *b, int slot) {
    const hn_look *look = &looks[slot];
    hn_json_object(b);
    hn_json_put_int(b, "slot", slot);
    hn_json_put_string(b, "name", look->name);
    for (int theme = 0; theme < HN_THEME_COUNT; theme++) {
        put_colour(b, theme_names[theme], look->colour[theme]);
    }
    hn_json_put_numbers(b, "dash", look->dash, (size_t)look->n_dash);
    hn_json_put_string(b, "marker", marker_name(look->marker));
    hn_json_put_string(b, "glyph", look->glyph);
    hn_json_end_object(b);
}

static void put_surface(hn_strbuf *b, const hn_surface *s) {
    hn_json_object(b);
    put_colour(b, "paper", s->paper);
    put_colour(b, "raised", s->raised);
    put_colour(b, "ink", s->ink);
    put_colour(b, "muted", s->muted);
    put_colour(b, "hairline", s->hairline);
    put_colour(b, "tear", s->tear);
    hn_json_end_object(b);
}

void hn_look_json(hn_strbuf *b) {
    hn_json_object(b);
    hn_json_key(b, "surfaces");
    hn_json_object(b);
    for (int theme = 0; theme < HN_THEME_COUNT; theme++) {
        hn_json_key(b, theme_names[theme]);
        put_surface(b, &surfaces[theme]);
    }
    hn_json_end_object(b);

    hn_json_key(b, "slots");
    hn_json_array(b);
    for (int slot = 0; slot < HN_LOOK_METHODS; slot++) {
        put_look(b, slot);
    }
    hn_json_end_array(b);
    hn_json_key(b, "reference");
    put_look(b, HN_LOOK_REFERENCE);
    hn_json_end_object(b);
}
