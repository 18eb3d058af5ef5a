// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_FRAME_H
#define HN_SESSION_STABILITY_FRAME_H
// Layout of a picture of a map and the look of each class, shared by the SVG and the PNG.

#include "render/look.h"
#include "session/stability/stability.h"

enum {
    HN_MAP_WIDTH = 900,
    HN_MAP_LEFT = 86,
    HN_MAP_TOP = 106,   ///< above the first panel
    HN_MAP_PANEL = 432, ///< from the top of one panel to that of the next
    HN_MAP_FIELD_WIDTH = 560,
    HN_MAP_FIELD_HEIGHT = 300
};

typedef struct hn_map_class_look {
    hn_stability_class kind;
    const char *words; ///< for the legend
    const char *glyph; ///< one column wide, UTF-8; "" for none
    int slot;          ///< of the table of colours; -1: tear, -2: muted, -3: hairline
    double opacity;
} hn_map_class_look;
/// Returns how a cell of this class is drawn, and its colour 0xRRGGBB.
const hn_map_class_look *hn_map_class_look_get(hn_stability_class kind);
uint32_t hn_map_class_colour(hn_stability_class kind, hn_theme theme);

/// Returns the height of the whole picture [px].
int hn_map_height(const hn_map *map);
/// Returns the top of method m's field.
double hn_map_field_top(int m);
enum { HN_MAP_SAID_LINES = 3, HN_MAP_SAID_COLUMNS = 124, HN_MAP_SAID_HEIGHT = 16 };
typedef char hn_map_said_line[HN_MAP_SAID_COLUMNS + 4];
/// Breaks the text on a method (hn_map_agreement_text) into lines as wide as the picture. Returns
/// how many; text that needs more ends in "...". The last line is right above the field, the
/// method's name above the first.
int hn_map_said(const hn_map *map, int m, hn_map_said_line lines[HN_MAP_SAID_LINES]);
/// Left edge of column i (0 .. n), top edge of row j counted from below (0 .. n).
double hn_map_column_edge(const hn_map *map, int i);
double hn_map_row_edge(const hn_map *map, int m, int j);
/// Height of a value on the vertical axis: rows stand for their values at their middle.
double hn_map_height_of(const hn_map *map, int m, double value);
/// Computes the x at which the predicted boundary passes between columns i and i + 1 of row j, on
/// maps whose vertical axis is no step. Returns 0 where it does not pass there.
int hn_map_crossing_x(const hn_map *map, int m, int i, int j, double *x);
/// Ticks: values at rows or columns that label an axis; at most 8, returns how many. `at` is the
/// index.
int hn_map_ticks(const hn_map_axis *a, int at[8]);
/// "h [s]"
void hn_map_axis_title(const hn_map_axis *a, char out[96]);
/// The outcome of a cell in words: values, class, reason, errors, prediction.
void hn_map_cell_text(hn_strbuf *b, const hn_map *map, int m, int column, int row);
#endif
