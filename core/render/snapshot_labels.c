// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/snapshot_labels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double SAME_PLACE = 2;   // [px]
static const double TIME_SIZE = 0.85; // letters of the time of a pose, of the body text

/// Returns whether a text at `place` seems to belong to another point with a name than the one at
/// `xy`, because that is nearer.
static bool is_nearer_to_another(const hn_sheet *s, const hn_drawing *d, const double *points,
                                 const double xy[2], double half, const double place[2]) {
    const double own = hn_label_room_to_line(place, half, s->font, xy, xy);
    for (int i = 0; i < d->n_points; i++) {
        double at[2];
        hn_sheet_pixel(s, points + 3 * i, at);
        const double least = fmax(fabs(at[0] - place[0]) - half, fabs(at[1] - place[1]));
        if (d->labels[i] && least - 0.5 * s->font < own &&
            hypot(at[0] - xy[0], at[1] - xy[1]) > s->font &&
            hn_label_room_to_line(place, half, s->font, at, at) < own) {
            return true;
        }
    }
    return false;
}

/// Takes the nearest of sixteen places around a point that is free and has room enough; the one
/// with the most room where none has. Returns whether one is free.
static bool place_label(const hn_sheet *s, const hn_drawing *d, const double *points,
                        const double xy[2], const hn_label_places *placed, double half,
                        double out[2]) {
    enum { PLACES = 16, RINGS = 5 };
    const double wider = fmax(0, half - 0.5 * s->font); // a long text begins where a short one does
    const double enough = 0.45 * s->font, step = 0.45 * s->font;
    double most = -HUGE_VAL;
    for (int k = 0; k < PLACES * RINGS; k++) {
        const double angle = 2 * 3.14159265358979324 * (k % PLACES) / PLACES;
        const double off = 0.75 * s->bar + 0.85 * s->font + step * (k / PLACES);
        const double place[2] = {xy[0] + (off + wider) * cos(angle), xy[1] - off * sin(angle)};
        const double highest = enough - 0.25 * step * (k / PLACES);
        if (highest <= most + 0.5) {
            break;
        }
        if (!hn_label_is_free(s, placed, place, half)) {
            continue;
        }

        // the dearest question last, and only where its answer matters
        const double room = hn_label_room_of_all(s, d, points, placed, place, half);
        double worth = fmin(room, enough) - 0.25 * step * (k / PLACES);
        if (worth > most + 0.5) {
            worth -= s->font * is_nearer_to_another(s, d, points, xy, half, place);
        }
        if (worth > most + 0.5) {
            most = worth;
            memcpy(out, place, 2 * sizeof *out);
        }
    }
    return most > -HUGE_VAL;
}

/// The names of all points that are seen where point `first` is, "B1 A2"; 0: an earlier one has
/// told them.
static bool names_at(const hn_sheet *s, const hn_drawing *d, const double *points, int first,
                     char text[HN_LABEL_TEXT]) {
    double here[2], there[2];
    size_t used = 0;
    hn_sheet_pixel(s, points + 3 * first, here);
    for (int i = 0; i < d->n_points; i++) {
        hn_sheet_pixel(s, points + 3 * i, there);
        if (d->labels[i] == NULL || hypot(there[0] - here[0], there[1] - here[1]) > SAME_PLACE) {
            continue;
        }
        if (i < first) {
            return false;
        }
        const int n =
            snprintf(text + used, HN_LABEL_TEXT - used, used ? " %s" : "%s", d->labels[i]);
        used = n > 0 && used + (size_t)n < HN_LABEL_TEXT ? used + (size_t)n : HN_LABEL_TEXT - 1;
    }
    return true;
}

/// What names are drawn with.
typedef struct writer {
    hn_canvas *c;
    const hn_sheet *s;
    const hn_drawing *d;
    const double *points;
    bool halo;
    hn_label_places *placed;
    char missing[HN_LABEL_TEXT]; ///< names without room
} writer;

static void draw_name(writer *w, const double at[2], const char *text) {
    const hn_surface *surface = hn_surface_get(hn_canvas_theme(w->c));
    const double size = w->s->font, half = 0.5 * hn_canvas_text_width(size, text);
    double xy[2];
    if (w->placed->n == HN_LABELS_PLACED ||
        !place_label(w->s, w->d, w->points, at, w->placed, half, xy)) {
        const size_t used = strlen(w->missing);
        snprintf(w->missing + used, sizeof w->missing - used, "%s%s",
                 used ? ", " : "no room for the name ", text);
        return;
    }
    if (w->halo) {
        hn_label_halo(w->c, w->s, xy, half);
    }
    hn_canvas_text(w->c, xy[0], xy[1] + 0.35 * size, size, HN_ALIGN_CENTRE,
                   hn_paint_solid(surface->ink), text);
    hn_label_remember(w->placed, HN_LABEL_NAME, text, xy, half);
}

/// Returns whether a point of the drawing has the name, or it has been drawn.
static bool is_named(const writer *w, const char *name) {
    for (int i = 0; i < w->d->n_points; i++) {
        if (w->d->labels[i] && strcmp(w->d->labels[i], name) == 0) {
            return true;
        }
    }
    for (int i = 0; i < w->placed->n; i++) {
        if (w->placed->kind[i] == HN_LABEL_NAME && strcmp(w->placed->text[i], name) == 0) {
            return true;
        }
    }
    return false;
}

/// The joint that the inset shows, then those whose forces have values beside their arrows.
static void draw_joint_names(writer *w, const hn_snapshot_pose *poses,
                             const hn_snapshot_opts *opts) {
    double at[2];
    if (w->s->widest.pose >= 0) {
        const char *name = w->d->tear_names[w->s->widest.index];
        const int point = w->d->tears[w->s->widest.index][0];
        hn_sheet_pixel(w->s, poses[w->s->widest.pose].points + 3 * point, at);
        if (name && !is_named(w, name)) {
            draw_name(w, at, name);
        }
    }
    for (int i = 0; i < opts->n_loads && !w->placed->numbered; i++) {
        const hn_snapshot_load *load = &opts->loads[i];
        if (load->name && load->point < 0 && !is_named(w, load->name)) {
            hn_sheet_pixel(w->s, load->place, at);
            draw_name(w, at, load->name);
        }
    }
}

void hn_snapshot_names(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *poses, const hn_snapshot_opts *opts,
                       hn_label_places *placed) {
    writer w = {.c = c,
                .s = s,
                .d = d,
                .points = poses[s->selected].points,
                .halo = opts->dimensions || opts->n_traces > 0, // over the lines of both
                .placed = placed};
    for (int i = 0; i < d->n_points; i++) {
        char text[HN_LABEL_TEXT];
        double at[2];
        if (d->labels[i] && names_at(s, d, w.points, i, text)) {
            hn_sheet_pixel(s, w.points + 3 * i, at);
            draw_name(&w, at, text);
        }
    }
    draw_joint_names(&w, poses, opts);
    if (w.missing[0]) {
        hn_label_add_row(placed, w.missing);
    }
}

// ---- times ----

/// The points of a faint pose, those first that are farther from the selected pose and from the
/// faint ones that follow: returns the k-th best, -1 where no other is there.
static int far_point(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                     const double *selected, double below, double *distance) {
    int best = -1;
    *distance = -1;
    for (int i = 0; i < d->n_points; i++) {
        double here[2], there[2];
        hn_sheet_pixel(s, pose->points + 3 * i, here);
        hn_sheet_pixel(s, selected + 3 * i, there);
        const double away = hypot(here[0] - there[0], here[1] - there[1]);
        if (away < below && away > *distance) {
            *distance = away;
            best = i;
        }
    }
    return best;
}

/// Writes the time beside the point that is farthest from the selected pose and has room.
static void draw_time(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                      const hn_snapshot_pose *pose, const double *selected,
                      hn_label_places *placed) {
    char text[HN_LABEL_TEXT];
    double below = HUGE_VAL, at[2], xy[2], distance;
    snprintf(text, sizeof text, "%.4g s", pose->time);
    const double half = 0.5 * hn_canvas_text_width(TIME_SIZE * s->font, text);
    for (int point; (point = far_point(s, d, pose, selected, below, &distance)) >= 0;) {
        below = distance;
        hn_sheet_pixel(s, pose->points + 3 * point, at);
        if (place_label(s, d, selected, at, placed, half, xy)) {
            hn_label_halo(c, s, xy, half);
            hn_canvas_text(c, xy[0], xy[1] + 0.3 * s->font, TIME_SIZE * s->font, HN_ALIGN_CENTRE,
                           hn_paint_solid(hn_surface_get(hn_canvas_theme(c))->muted), text);
            hn_label_remember(placed, HN_LABEL_TIME, text, xy, half);
            return;
        }
    }
}

void hn_snapshot_times(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                       const hn_snapshot_pose *poses, int n_poses, hn_label_places *placed) {
    for (int i = 0; i < n_poses; i++) {
        if (poses[i].faint && hn_pose_is_drawable(d, &poses[i])) {
            draw_time(c, s, d, &poses[i], poses[s->selected].points, placed);
        }
    }
}
