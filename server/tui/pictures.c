// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/pictures.h"

#include "render/look.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIXEL = 4, FIRST_OF_VT220 = 60, SMALLEST_CELL = 3, LARGEST_CELL = 200 };

static const char WINDOW[] = "\033[14t";
static const char WINDOW_AND_NAME[] = "\033[14t\033[c";
#define KITTY "\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\033\\\033[c"
static const char KITTY_AND_NAME[] = KITTY;
static const char BACKGROUND_KITTY_AND_NAME[] = "\033]11;?\a" KITTY;

hn_pictures hn_pictures_start(hn_pixels wanted, int theme) {
    return (hn_pictures){.wanted = wanted,
                         .kitty = wanted == HN_PIXELS_KITTY,
                         .sixel = wanted == HN_PIXELS_SIXEL,
                         .asks_background = theme < 0,
                         .theme = theme < 0 ? HN_THEME_DARK : theme};
}

bool hn_pixels_parse(const char *word, hn_pixels *out) {
    static const char *const words[] = {[HN_PIXELS_AUTO] = "auto",
                                        [HN_PIXELS_KITTY] = "kitty",
                                        [HN_PIXELS_SIXEL] = "sixel",
                                        [HN_PIXELS_OFF] = "off"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcmp(words[i], word) == 0) {
            *out = (hn_pixels)i;
            return true;
        }
    }
    return false;
}

const char *hn_pictures_question(const hn_pictures *p) {
    return p->wanted == HN_PIXELS_OFF ? NULL : WINDOW_AND_NAME;
}

/// The numbers of "62;4;22": whether sixels are among them, and the first.
static int read_name(const char *text, bool *sixel) {
    int first = 0, used;
    bool at_first = true;
    for (int value; sscanf(text, "%d%n", &value, &used) == 1; at_first = false) {
        first = at_first ? value : first;
        *sixel = *sixel || (!at_first && value == SIXEL);
        text += used;
        text += *text == ';';
    }
    return first;
}

static void take_window(hn_pictures *p, int width, int height) {
    const int across = p->columns > 0 ? width / p->columns : 0;
    const int down = p->rows > 0 ? height / p->rows : 0;
    const bool sound = across >= SMALLEST_CELL && across <= LARGEST_CELL && down >= SMALLEST_CELL &&
                       down <= LARGEST_CELL;
    p->cell_width = sound ? across : 0;
    p->cell_height = sound ? down : 0;
}

/// "rgb:ffff/ffff/ffff", each channel of one to four digits.
static void take_background(hn_pictures *p, const char *text) {
    static const double weight[] = {0.2126, 0.7152, 0.0722}; // of luminance, ITU-R BT.709
    char channels[3][5];
    double light = 0;
    if (!p->asks_background || sscanf(text, "rgb:%4[0-9a-fA-F]/%4[0-9a-fA-F]/%4[0-9a-fA-F]",
                                      channels[0], channels[1], channels[2]) != 3) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        const int bits = 4 * (int)strlen(channels[i]);
        light += weight[i] * (double)strtol(channels[i], NULL, 16) / (double)((1 << bits) - 1);
    }
    p->theme = light > 0.5 ? HN_THEME_LIGHT : HN_THEME_DARK;
}

const char *hn_pictures_answer(hn_pictures *p, const char *answer) {
    static const char window[] = "\033[4;", name[] = "\033[?", kitty[] = "\033_Gi=31;OK";
    static const char background[] = "\033]11;";
    int width, height;
    if (strncmp(answer, background, sizeof background - 1) == 0) {
        take_background(p, answer + sizeof background - 1);
    } else if (strncmp(answer, kitty, sizeof kitty - 1) == 0) {
        p->kitty = true;
    } else if (strncmp(answer, window, sizeof window - 1) == 0) {
        if (sscanf(answer + sizeof window - 1, "%d;%dt", &height, &width) == 2) {
            take_window(p, width, height);
        }
    } else if (strncmp(answer, name, sizeof name - 1) == 0) {
        const int first = read_name(answer + sizeof name - 1, &p->sixel);
        if (first >= FIRST_OF_VT220 && !p->asked_kitty) {
            p->asked_kitty = true;
            return p->asks_background ? BACKGROUND_KITTY_AND_NAME : KITTY_AND_NAME;
        }
        p->known = true;
    }
    return NULL;
}

const char *hn_pictures_resize(hn_pictures *p, int columns, int rows, int width, int height) {
    if (columns == p->columns && rows == p->rows) {
        return NULL;
    }
    const bool first = p->columns == 0;
    p->columns = columns;
    p->rows = rows;
    take_window(p, width, height);
    // the first question asks after the window already
    const bool ask = !first && p->cell_width == 0 && hn_pictures_form(p) != HN_PIXELS_OFF;
    return ask ? WINDOW : NULL;
}

hn_pixels hn_pictures_form(const hn_pictures *p) {
    const hn_pixels best = p->kitty ? HN_PIXELS_KITTY : p->sixel ? HN_PIXELS_SIXEL : HN_PIXELS_OFF;
    const hn_pixels form = p->wanted != HN_PIXELS_AUTO ? p->wanted
                           : p->known                  ? best
                                                       : HN_PIXELS_OFF;
    // sixels are as large as they are: without the size of a cell they would cover something else
    return form == HN_PIXELS_SIXEL && p->cell_width == 0 ? HN_PIXELS_OFF : form;
}

const char *hn_pictures_next(hn_pictures *p) {
    static const char *const says[] = {
        [HN_PIXELS_KITTY] = "the mechanism is a picture now (kitty graphics)",
        [HN_PIXELS_SIXEL] = "the mechanism is a picture now (sixels)",
        [HN_PIXELS_OFF] = "the mechanism is drawn in characters now"};
    if (!p->kitty && !p->sixel) {
        p->wanted = HN_PIXELS_OFF;
        return "this terminal does not say that it shows pictures: the mechanism stays in "
               "characters";
    }
    if (!p->kitty && p->cell_width == 0) {
        return "this terminal shows sixels but does not say how large a cell is; they would not "
               "fit";
    }

    // characters, kitty, sixel, and from the start
    const hn_pixels now = hn_pictures_form(p);
    p->wanted = now == HN_PIXELS_OFF && p->kitty                          ? HN_PIXELS_KITTY
                : now != HN_PIXELS_SIXEL && p->sixel && p->cell_width > 0 ? HN_PIXELS_SIXEL
                                                                          : HN_PIXELS_OFF;
    return says[p->wanted];
}
