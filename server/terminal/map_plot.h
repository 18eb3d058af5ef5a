// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_MAP_PLOT_H
#define HN_TERMINAL_MAP_PLOT_H
// A stability map in character cells: the outcome of every cell and the predicted limit. If
// neither axis is the step, cells that came to their end are shaded by their worst loop gap, and
// the best cell for the gap, the motion and the energy is marked.

#include "session/stability/stability.h"
#include "terminal/cells.h"

typedef struct hn_map_plot_cell {
    unsigned char kind; ///< hn_stability_class
    bool limit;         ///< the predicted limit passes here
    double gap;         ///< worst loop gap [m]
    double error;       ///< largest error of the velocity, a share
    double energy;      ///< largest energy gained, a share
    double margin;      ///< step over the predicted limit; NaN: nothing is predicted
} hn_map_plot_cell;

/// One method of a map as it is now; a copy that outlives it.
typedef struct hn_map_plot {
    hn_map_axis x, y;
    bool heat; ///< shaded by the gap
    char name[HN_SPEC_MAX];
    hn_map_plot_cell cell[HN_MAP_SIDE * HN_MAP_SIDE]; ///< y.n rows of x.n, the lowest y first
} hn_map_plot;

/// A cell of a map; column -1: none.
typedef struct hn_map_place {
    int column, row;
} hn_map_place;

/// Quantities of a cell; for each a map has a best cell.
typedef enum hn_map_quantity {
    HN_MAP_GAP,
    HN_MAP_ERROR,
    HN_MAP_ENERGY,
    HN_MAP_QUANTITIES
} hn_map_quantity;

/// Copies what is done so far of method m.
void hn_map_plot_take(hn_map_plot *p, const hn_map *map, int m);
/// The cell whose values are nearest; values beyond the map have a cell at its edge. None for NaN.
hn_map_place hn_map_plot_place(const hn_map_plot *p, double x, double y);
/// Returns whether the values lie beyond the map.
bool hn_map_plot_is_beyond(const hn_map_plot *p, double x, double y);
/// The cell that came to its end with the smallest value; none where no cell did, or where an axis
/// is the step.
hn_map_place hn_map_plot_best(const hn_map_plot *p, hn_map_quantity quantity);
/// Adds a line for each best cell, with its mark, its value and where it is; of a map of alpha and
/// beta also what the map shows. "g smallest worst loop gap: 19 µm at alpha = 11.1, beta = 17.6"
void hn_map_plot_best_words(hn_strbuf *b, const hn_map_plot *p);
/// Rows that the map takes of an area of `columns` and `rows`, with its axis and its legend, which
/// stands beside it where there is room.
int hn_map_plot_rows(const hn_map_plot *p, int columns, int rows);
/// Draws the map as large as there is room for, its axes and its legend at the top left of the
/// area. present, cursor: cells to mark.
void hn_map_plot_draw(hn_cells *c, hn_area area, const hn_map_plot *p, hn_map_place present,
                      hn_map_place cursor);
/// "alpha = 12, beta = 40: stable, velocities right to 1 %; worst gap 73 µm; the step is 0.35 of
/// the predicted limit"
void hn_map_plot_words(hn_strbuf *b, const hn_map_plot *p, hn_map_place at);
/// Adds the method's name and the map, as wide as `columns`.
void hn_map_plot_text(hn_strbuf *b, const hn_map_plot *p, int columns, bool colours);
#endif
