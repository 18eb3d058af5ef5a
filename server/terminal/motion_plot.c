// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/motion_plot.h"

#include "render/look.h"

#include <math.h>
#include <stdlib.h>

enum { FIRST_CAPACITY = 256, PLOT_ROWS = 14 };

static bool grow(double **column, int cap) {
    double *more = realloc(*column, (size_t)cap * sizeof *more);
    *column = more ? more : *column;
    return more != NULL;
}

bool hn_motion_plot_next(hn_motion_plot *p) {
    if (p->n == p->cap) {
        const int cap = p->cap ? 2 * p->cap : FIRST_CAPACITY;
        for (int i = 0; i < p->n_tracks; i++) {
            p->failed |= !grow(&p->tracks[i].gap, cap) || !grow(&p->tracks[i].energy, cap);
        }
        p->cap = p->failed ? p->cap : cap;
    }
    if (p->failed) {
        return false;
    }
    for (int i = 0; i < p->n_tracks; i++) {
        p->tracks[i].gap[p->n] = p->tracks[i].energy[p->n] = (double)NAN;
    }
    p->n++;
    return true;
}

void hn_motion_plot_free(hn_motion_plot *p) {
    for (int i = 0; i < p->n_tracks; i++) {
        free(p->tracks[i].gap);
        free(p->tracks[i].energy);
    }
    p->n_tracks = p->n = p->cap = 0;
}

static void draw(hn_cells *c, hn_area area, const hn_motion_plot *p, bool energy) {
    hn_plot plot = {.dt = p->dt,
                    .t_end = p->dt * (p->n > 1 ? p->n - 1 : 1),
                    .cursor = (double)NAN,
                    .logarithmic = true,
                    .floor = 1e-16,
                    .unit = energy ? "J" : p->gap_unit,
                    .n = p->n_tracks};
    for (int i = 0; i < p->n_tracks; i++) {
        const hn_motion_track *t = &p->tracks[i];
        const bool dashed = hn_look_get(t->slot)->n_dash > 0;
        plot.series[i] = (hn_series){.y = energy ? t->energy : t->gap,
                                     .n = p->n,
                                     .colour = t->slot,
                                     .glyph = hn_look_get(t->slot)->glyph,
                                     .on = dashed ? 3 : 1,
                                     .off = dashed ? 2 : 0};
    }
    hn_plot_draw(c, area, &plot, HN_DOTS_BRAILLE);
}

void hn_motion_plot_text(hn_strbuf *b, const hn_motion_plot *p, int columns, bool colours) {
    hn_cells cells = {0};
    const int rows = 2 * (PLOT_ROWS + 1) + p->n_tracks;
    if (p->failed || !hn_cells_resize(&cells, columns, rows)) {
        hn_strbuf_add(b, "no memory for the plot\n");
        return;
    }

    // two titled plots, then a line a method
    const hn_area page = {0, 0, columns, rows};
    hn_cells_put(&cells, page, 0, 0, HN_CELL_INK, HN_CELL_BOLD, "loop gap (constraint violation)");
    draw(&cells, (hn_area){0, 1, columns, PLOT_ROWS}, p, false);
    hn_cells_put(&cells, page, 0, PLOT_ROWS + 1, HN_CELL_INK, HN_CELL_BOLD,
                 "energy change since the start, size");
    draw(&cells, (hn_area){0, PLOT_ROWS + 2, columns, PLOT_ROWS}, p, true);
    for (int i = 0; i < p->n_tracks; i++) {
        const int y = 2 * (PLOT_ROWS + 1) + i, slot = p->tracks[i].slot;
        hn_cells_put(&cells, page, 2, y, slot, HN_CELL_BOLD, hn_look_get(slot)->glyph);
        hn_cells_put(&cells, page, 4, y, HN_CELL_INK, 0, p->tracks[i].name);
    }
    hn_cells_text(b, &cells, colours);
    hn_cells_free(&cells);
}
