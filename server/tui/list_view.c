// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/list_view.h"

#include "tui/mechanism_view.h"

#include <stdio.h>

enum { PREVIEW_COLUMNS = 60 }; // from which on the list of scenes has a picture
enum { ABOUT_COLUMNS = 24 };   // in fewer of them most titles would be cut: they stand below alone
enum { LEAST_FOOT = 3 };       // rows, with the empty one above

/// The column of names is as wide as the longest one, within bounds: methods are known by theirs.
static int name_width(const hn_workbench *w) {
    enum { LEAST = 20, MOST = 28, MOST_OF_METHODS = 44 };
    const bool methods = w->list == HN_LIST_METHODS || w->list == HN_LIST_REMEDIES;
    const int most = methods ? MOST_OF_METHODS : MOST;
    int width = LEAST;
    for (int i = 0; i < w->n_items; i++) {
        const int n = hn_text_columns(w->items[i].name);
        width = n > width && n <= most ? n : width;
    }
    return width;
}

static bool is_pictured(hn_area in, const hn_workbench *w) {
    const bool scenes = w->panel == HN_PANEL_LIST && w->list == HN_LIST_SCENES;
    return scenes && in.columns >= PREVIEW_COLUMNS;
}

static const char *words_of(const hn_item *item) {
    return item->more[0] ? item->more : item->about;
}

/// Rows below the list: as many as the longest words need, while the list keeps half of them.
static int foot_rows(hn_area in, const hn_workbench *w) {
    int needed = LEAST_FOOT;
    for (int i = 0; i < w->n_items; i++) {
        const int rows = 1 + hn_text_rows(words_of(&w->items[i]), in.columns - 2);
        needed = rows > needed ? rows : needed;
    }
    const int spare = in.rows - w->n_items, half = in.rows / 2;
    const int most = spare > half ? spare : half;
    return needed < most ? needed : most > LEAST_FOOT ? most : LEAST_FOOT;
}

bool hn_list_view_picture(hn_area in, const hn_workbench *w, hn_area *out) {
    if (!is_pictured(in, w)) {
        return false;
    }
    // the list is no wider than its names where titles have no room
    const int share = in.columns * 11 / 20, names = name_width(w) + 4;
    const int items = share - names >= ABOUT_COLUMNS ? share : names;
    *out = (hn_area){in.x + items + 1, in.y, in.columns - items - 2, in.rows - foot_rows(in, w)};
    return true;
}

/// Says in the empty row below the list how many items are above and below those shown.
static void draw_rest(hn_cells *c, hn_area in, int y, int above, int below) {
    char line[64];
    int n = above > 0 ? snprintf(line, sizeof line, "↑ %d more  ", above) : 0;
    n += below > 0 ? snprintf(line + n, sizeof line - (size_t)n, "↓ %d more", below) : 0;
    if (n > 0) {
        hn_cells_put(c, in, 1, y, HN_CELL_MUTED, 0, line);
    }
}

static void draw_item(hn_cells *c, hn_area in, int y, int width, const hn_item *item, bool chosen) {
    const int style = chosen ? HN_CELL_REVERSE : HN_CELL_PLAIN;
    const int used = hn_text_columns(item->name), x = used > width ? used : width;
    hn_cells_printf(c, in, 1, y, HN_CELL_INK, style, "%s%*s", item->name, x - used, "");

    // the words below say all that has no room here
    if (in.columns - width - 4 >= ABOUT_COLUMNS) {
        hn_cells_put_fitted(c, in, x + 3, y, HN_CELL_MUTED, 0, item->about);
    }
}

void hn_list_view_draw(hn_cells *c, hn_area area, const hn_workbench *w) {
    const hn_area frame = hn_cells_frame(c, area, w->title);
    hn_area picture;
    const bool pictured = hn_list_view_picture(frame, w, &picture);
    const int below = foot_rows(frame, w), rows = frame.rows - below;
    const hn_area in = {frame.x, frame.y, pictured ? picture.x - 1 - frame.x : frame.columns,
                        frame.rows};
    const int width = name_width(w), first = w->cursor < rows ? 0 : w->cursor - rows + 1;
    for (int i = first; i < w->n_items && i - first < rows; i++) {
        draw_item(c, in, i - first, width, &w->items[i], i == w->cursor);
    }
    draw_rest(c, in, rows, first, w->n_items - first - rows);
    if (w->n_items > 0) {
        const hn_area foot = {frame.x + 1, frame.y + rows + 1, frame.columns - 2, below - 1};
        hn_cells_fold_fitted(c, foot, HN_CELL_INK, words_of(&w->items[w->cursor]));
    }
    if (pictured) {
        hn_mechanism_preview(c, picture, w);
    }
}
