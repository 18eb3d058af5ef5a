// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/mechanism_picture.h"

#include "base/clock.h"
#include "base/hash.h"
#include "render/raster.h"
#include "render/snapshot.h"
#include "terminal/kitty_image.h"
#include "terminal/sixel_image.h"
#include "tui/force_arrows.h"
#include "tui/mechanism_view.h"
#include "tui/reactions_view.h"

#include <math.h>
#include <stdlib.h>

static const double SHARE = 1.0 / 15; // of a processor, for painting; the rest of it is characters
// [px] xterm shows no more of a sixel picture; kitty stretches a picture that is painted smaller
enum { MOST_SIXELS = 1000, MOST_PIXELS = 300000 };
enum { GUESSED_WIDTH = 8, GUESSED_HEIGHT = 16 }; // [px] of a cell, for kitty, where it is not known

/// Describes what is to be drawn.
typedef struct subject {
    hn_drawing drawing;
    const hn_envelope *envelope;
    hn_snapshot_pose poses[HN_COMPARISON_MAX_METHODS + 1];
    int n_poses;
    hn_force_arrows arrows;
} subject;

static void add_pose(subject *s, const double *points, int slot, bool selected) {
    if (points) {
        s->poses[s->n_poses++] =
            (hn_snapshot_pose){.points = points, .slot = slot, .selected = selected};
    }
}

/// The methods at the frame shown, the mechanism that is dragged, or the scene that a list is at.
static subject subject_of(const hn_workbench *w) {
    const bool listed = w->panel == HN_PANEL_LIST;
    const hn_model *model = listed ? w->preview.model : w->model;
    subject s = {.envelope = listed ? &w->preview.envelope : &w->envelope};
    if (!model) {
        return s;
    }
    s.drawing = hn_system_drawing(hn_model_system(model));
    if (listed || w->drag.points) {
        add_pose(&s, listed ? w->preview.points : w->drag.points, 0, true);
        return s;
    }

    // the reference and the methods that are not hidden
    const int frame = hn_workbench_frame(w);
    const size_t n = 3 * (size_t)s.drawing.n_points;
    add_pose(&s, hn_recording_reference(w->recording, frame), HN_LOOK_REFERENCE, false);
    for (int m = 0; m < w->n_methods; m++) {
        const hn_track *track = hn_recording_track(w->recording, m);
        if (!w->hidden[m]) {
            add_pose(&s, track->points + (size_t)frame * n, track->slot, m == w->selected);
        }
    }
    hn_reactions_update(w);
    hn_force_arrows_take(w, &s.arrows);
    return s;
}

static uint64_t hash_of(const subject *s, int theme) {
    uint64_t hash = hn_hash_bytes(HN_HASH_START, &theme, sizeof theme);
    hash = hn_hash_bytes(hash, s->envelope->box, sizeof s->envelope->box);
    for (int i = 0; i < s->n_poses; i++) {
        const hn_snapshot_pose *pose = &s->poses[i];
        hash = hn_hash_double(hash, 2 * pose->slot + pose->selected);
        hash = hn_hash_bytes(hash, pose->points,
                             3 * (size_t)s->drawing.n_points * sizeof *pose->points);
    }
    for (int i = 0; i < s->arrows.n; i++) {
        hash = hn_hash_bytes(hash, s->arrows.load[i].force, sizeof s->arrows.load[i].force);
    }
    return hash;
}

/// The size of a picture of an area [px].
static void size_of(const hn_pictures *p, hn_area area, int *width, int *height) {
    const bool known = p->cell_width > 0;
    *width = area.columns * (known ? p->cell_width : GUESSED_WIDTH);
    *height = area.rows * (known ? p->cell_height : GUESSED_HEIGHT);
    if (hn_pictures_form(p) == HN_PIXELS_SIXEL) {
        // whole bands: nothing stands out below
        *width = *width < MOST_SIXELS ? *width : MOST_SIXELS;
        *height = *height < MOST_SIXELS ? *height : MOST_SIXELS;
        *height -= *height % HN_SIXEL_BAND;
        return;
    }
    const double shrink = fmin(1, sqrt(MOST_PIXELS / ((double)*width * *height)));
    *width = (int)(shrink * *width);
    *height = (int)(shrink * *height);
}

/// Paints the subject; NULL: there is nothing to draw, or no memory. Returns owned pixels.
static unsigned char *paint(const subject *s, int theme, int width, int height,
                            hn_snapshot_place *place) {
    const double *box = s->envelope->box;
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    opts.bare = true;
    opts.look = s->envelope->look;
    opts.loads = s->arrows.load;
    opts.n_loads = s->arrows.n;
    opts.longest_load = s->arrows.longest;
    if (box[2] > box[0]) {
        opts.view[0] = box[0];
        opts.view[1] = box[2];
        opts.view[2] = box[1];
        opts.view[3] = box[3];
    }

    // where it is, then the pixels
    hn_canvas *canvas = NULL;
    unsigned char *rgb = malloc((size_t)3 * (size_t)width * (size_t)height);
    hn_status status = rgb ? HN_OK : HN_ERR_MEMORY;
    HN_THEN(status, hn_snapshot_find_place(place, width, height, &s->drawing, s->poses, s->n_poses,
                                           &opts, NULL));
    HN_THEN(status, hn_canvas_create(width, height, (hn_theme)theme, &canvas, NULL));
    HN_THEN(status, hn_snapshot_draw(canvas, &s->drawing, s->poses, s->n_poses, &opts, NULL));
    HN_THEN(status, hn_raster_paint(canvas, rgb, NULL));
    hn_canvas_free(canvas);
    if (status != HN_OK) {
        free(rgb);
        return NULL;
    }
    return rgb;
}

/// Dots of characters, as the mouse counts them, from pixels of the picture.
static hn_placing placing_of(const hn_pictures *p, hn_area area, const hn_snapshot_place *at,
                             int width, int height) {
    const bool kitty = hn_pictures_form(p) == HN_PIXELS_KITTY;
    const double cell_width = kitty ? (double)width / area.columns : p->cell_width;
    const double cell_height = kitty ? (double)height / area.rows : p->cell_height;
    const double across = HN_DOTS_ACROSS / cell_width, down = HN_DOTS_DOWN / cell_height;
    return (hn_placing){across * at->scale, down * at->scale, across * at->x, down * at->y};
}

/// The sequence of the picture at its place; the cursor is where it was before.
static void send(hn_mechanism_picture *p, hn_strbuf *b, hn_pixels form, hn_area area,
                 const unsigned char *rgb, int width, int height) {
    hn_strbuf_printf(b, "\0337\033[%d;%dH", area.y + 1, area.x + 1);
    if (form == HN_PIXELS_KITTY) {
        const int before = p->form == HN_PIXELS_KITTY ? p->id : 0;
        p->id = before == 1 ? 2 : 1;
        hn_kitty_show(b, rgb, width, height, area.columns, area.rows, p->id);
        if (before) {
            hn_kitty_remove(b, before);
        }
    } else {
        hn_sixel_show(b, rgb, width, height);
    }
    hn_strbuf_add(b, "\0338");
}

void hn_mechanism_picture_show(hn_mechanism_picture *p, hn_strbuf *b, hn_workbench *w,
                               hn_area area) {
    const subject s = subject_of(w);
    const uint64_t hash = hash_of(&s, w->pictures.theme);
    const double now = hn_clock_wall(), before = hn_clock_thread();
    const bool there = p->form != HN_PIXELS_OFF;
    if (there && (hash == p->shows || now < p->due)) {
        return;
    }

    // the pixels
    int width, height;
    hn_snapshot_place at;
    size_of(&w->pictures, area, &width, &height);
    unsigned char *rgb = s.n_poses > 0 ? paint(&s, w->pictures.theme, width, height, &at) : NULL;
    if (!rgb) {
        hn_mechanism_picture_remove(p, b);
        return;
    }
    const hn_pixels form = hn_pictures_form(&w->pictures);
    const size_t start = b->n;
    w->place = placing_of(&w->pictures, area, &at, width, height);
    send(p, b, form, area, rgb, width, height);
    free(rgb);
    p->form = form;
    p->area = area;
    p->shows = hash;
    p->bytes = (int)(b->n - start);
    p->due = now + (hn_clock_thread() - before) / SHARE;
}

void hn_mechanism_picture_remove(hn_mechanism_picture *p, hn_strbuf *b) {
    if (p->form == HN_PIXELS_KITTY) {
        hn_kitty_remove(b, p->id);
    }
    p->form = HN_PIXELS_OFF;
}
