// SPDX-License-Identifier: GPL-3.0-or-later
// The legend: the methods, then the keys to what is drawn, then what the drawing has no room for.
#include "render/snapshot_legend.h"

#include "base/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double LEGEND_TEXT = 4.3;   // from the left of a legend's row to its words [letters]
static const double SAMPLE = 3.6;        // the length of a sample [letters]
static const double NOTE_SIZE = 0.85;    // of the letters of a name
static const double SMALLEST_LETTER = 2; // [px]
static const double NOTE_PITCH = 1.25;   // from line to line of a note [its letters]
static const double SMALLEST_KEY = 0.7;  // of its letters that the text of a key may have
static const double KEY_PITCH = 1.5;     // from key to key [letters]
enum { TEXT = 256, NOTE_LINES = 6, MOST_KEYS = 24, COLUMNS = 3 };

void hn_legend_text(hn_canvas *c, double x, double y, double size, double width, uint32_t colour,
                    const char *text) {
    char cut[TEXT];
    snprintf(cut, sizeof cut, "%s", text);
    size_t n = strlen(cut);
    while (n > 0 && hn_canvas_text_width(size, cut) > width) {
        do {
            n--;
        } while (n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80);
        snprintf(cut + n, sizeof cut - n, "\xe2\x80\xa6");
    }
    hn_canvas_text(c, x, y, size, HN_ALIGN_LEFT, hn_paint_solid(colour), cut);
}

/// The bytes of the text that a line of this width takes, up to a space where there is one.
static size_t fit_line(double size, double width, const char *text) {
    char line[TEXT];
    size_t taken = 0;
    for (size_t n = 0; text[n] && n + 1 < sizeof line;) {
        n += 1 + strcspn(text + n + 1, " ");
        snprintf(line, sizeof line, "%.*s", (int)n, text);
        if (taken > 0 && hn_canvas_text_width(size, line) > width) {
            break;
        }
        taken = n;
    }
    return taken;
}

/// In lines of that width, the last of NOTE_LINES cut with an ellipsis. Returns how many there are;
/// c = NULL: counts only.
static int put_note(hn_canvas *c, double x, double y, double size, double width, uint32_t colour,
                    const char *text) {
    int lines = 0;
    while (*text && lines < NOTE_LINES) {
        const int last = lines == NOTE_LINES - 1;
        const size_t n = last ? strlen(text) : fit_line(size, width, text);
        char line[TEXT];
        snprintf(line, sizeof line, "%.*s", (int)n, text);
        if (c) {
            hn_legend_text(c, x, y + NOTE_PITCH * size * lines, size, width, colour, line);
        }
        lines++;
        text += n;
        text += strspn(text, " ");
    }
    return lines;
}

static const char *note_of(const hn_drawing *d, const hn_snapshot_pose *pose) {
    return pose->note != NULL ? pose->note : hn_pose_is_drawable(d, pose) ? "" : "no pose to draw";
}

/// The room right of the sample of its line, for a size of letters.
static double legend_room(const hn_sheet *s, double font) {
    return s->legend.width - LEGEND_TEXT * font;
}

/// Returns how far the next row is below this one: a name and a note of a line or more; a note
/// alone where an earlier panel has the name.
static double legend_pitch(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *pose,
                           bool continued, double font) {
    const double size = NOTE_SIZE * font;
    const int lines = put_note(NULL, 0, 0, size, legend_room(s, font), 0, note_of(d, pose));
    return (continued ? KEY_PITCH : 2.7) * font + NOTE_PITCH * size * (lines > 1 ? lines - 1 : 0);
}

static double poses_height(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *poses,
                           int n_poses, bool continued, double font) {
    double height = 0.4 * font;
    for (int i = 0; i < n_poses; i++) {
        height += poses[i].faint ? 0 : legend_pitch(s, d, &poses[i], continued, font);
    }
    return height;
}

/// What a row of the legend is drawn with.
typedef struct row {
    hn_canvas *c;
    const hn_sheet *s;
    const hn_drawing *d;
    bool continued;
    double y, font;
} row;

static void draw_legend_row(const row *r, const hn_snapshot_pose *pose, bool selected) {
    const hn_theme theme = hn_canvas_theme(r->c);
    const hn_surface *surface = hn_surface_get(theme);
    const double font = r->font, sample = SAMPLE * font, x = r->s->legend.x;
    const double text = x + LEGEND_TEXT * font, y = r->y + font, middle = y - 0.32 * font;
    const double room = legend_room(r->s, font);
    hn_stroke stroke = hn_slot_stroke(theme, pose->slot, r->s->line);
    stroke.n_dash = selected ? 0 : stroke.n_dash; // as in the drawing
    hn_canvas_segment(r->c, x, middle, x + sample, middle, &stroke);
    hn_canvas_disc(r->c, x + sample / 2, middle, 0.55 * font, hn_paint_solid(surface->paper));
    hn_canvas_marker(r->c, hn_look_get(pose->slot)->marker, x + sample / 2, middle, 0.75 * font,
                     stroke.paint);
    if (!r->continued) {
        hn_legend_text(r->c, text, y, font, room, surface->ink, pose->name ? pose->name : "");
    }
    put_note(r->c, text, r->continued ? y : y + 1.15 * font, NOTE_SIZE * font, room, surface->muted,
             note_of(r->d, pose));
}

// ---- keys ----

typedef enum key_kind { KEY_ARROW, KEY_SHORT, KEY_EARLIER, KEY_TRACE } key_kind;

/// A sample of something drawn, and what it is.
typedef struct key {
    key_kind kind;
    double length; ///< of an arrow [px]
    int trace;
    char text[TEXT];
} key;

typedef struct keys {
    int n;
    key at[MOST_KEYS];
} keys;

double hn_legend_force(const hn_sheet *s, const hn_snapshot_opts *opts) {
    const double scale = hn_load_scale(s, opts);
    return scale > 0 ? hn_round_125(SAMPLE * s->font / scale) : 0;
}

static void add_short(keys *k, const hn_label_places *placed) {
    if (placed->has_short) {
        k->at[k->n++] = (key){.kind = KEY_SHORT, .text = "shorter than drawn"};
    }
}

static void add_forces(keys *k, const hn_sheet *s, const hn_snapshot_opts *opts,
                       const hn_label_places *placed) {
    const double force = hn_legend_force(s, opts);
    char value[HN_SI_TEXT];
    if (force > 0) {
        hn_si_format(force, opts->loads[0].unit, 1, value);
        key *arrow = &k->at[k->n++];
        *arrow = (key){.kind = KEY_ARROW, .length = force * hn_load_scale(s, opts)};
        snprintf(arrow->text, TEXT, "%s%s", value, s->in_space ? " in the picture plane" : "");
    }
    add_short(k, placed);
}

/// The times of the faint poses: "earlier: t = 0, 0.2 s".
static void add_earlier(keys *k, const hn_snapshot_pose *poses, int n_poses) {
    key *earlier = &k->at[k->n];
    *earlier = (key){.kind = KEY_EARLIER, .text = "earlier: t ="};
    size_t used = strlen(earlier->text);
    int n = 0;
    for (int i = 0; i < n_poses; i++) {
        if (poses[i].faint && used < TEXT) {
            used += (size_t)snprintf(earlier->text + used, TEXT - used, "%s %.4g", n++ ? "," : "",
                                     poses[i].time);
        }
    }
    if (n > 0) {
        snprintf(earlier->text + (used < TEXT ? used : TEXT - 1), used < TEXT ? TEXT - used : 1,
                 " s");
        k->n++;
    }
}

/// Returns whether path k of a pose has a line: at the start it is one point.
static bool has_path(const hn_snapshot_pose *pose, int k, int n_traces) {
    const int n = pose->trace ? pose->n_trace / n_traces : 0;
    int finite = 0;
    for (int i = k * n; i < (k + 1) * n && finite < 2; i++) {
        finite += isfinite(pose->trace[3 * i]);
    }
    return finite > 1;
}

static keys list_keys(const hn_sheet *s, const hn_snapshot_pose *poses, int n_poses,
                      const hn_snapshot_opts *opts, const hn_label_places *placed) {
    keys k = {0};
    if (opts->continued) { // the first panel may have no such arrow
        add_short(&k, placed);
        return k;
    }
    add_forces(&k, s, opts, placed);
    add_earlier(&k, poses, n_poses);
    for (int i = 0; i < opts->n_traces && k.n < MOST_KEYS; i++) {
        if (!has_path(&poses[s->selected], i, opts->n_traces)) {
            continue;
        }
        k.at[k.n] = (key){.kind = KEY_TRACE, .trace = i};
        snprintf(k.at[k.n++].text, TEXT, "path of %.80s", opts->traces[i]);
    }
    return k;
}

static void draw_key(hn_canvas *c, const hn_sheet *s, const hn_snapshot_pose *selected,
                     const key *k, double y, double font) {
    const hn_theme theme = hn_canvas_theme(c);
    const hn_surface *surface = hn_surface_get(theme);
    const double x = s->legend.x, middle = y - 0.32 * font;
    const double size = NOTE_SIZE * font;
    double from[2] = {x, middle}, to[2] = {x + SAMPLE * font, middle};
    hn_stroke stroke = hn_slot_stroke(theme, selected->slot, s->line);
    switch (k->kind) {
    case KEY_ARROW:
        stroke = hn_stroke_solid(surface->ink, s->line);
        to[0] = x + k->length;
        hn_canvas_arrow(c, x, middle, to[0], middle, 0.8 * s->font, &stroke);
        break;
    case KEY_SHORT:
        to[0] = x + hn_load_short_length(s);
        hn_load_short_arrow(c, s, from, to);
        break;
    case KEY_EARLIER:
        stroke.n_dash = 0;
        stroke.paint.rgb = hn_tint(theme, stroke.paint.rgb, 0.35);
        hn_canvas_segment(c, x, middle, to[0], middle, &stroke);
        break;
    case KEY_TRACE:
        stroke = hn_trace_stroke(theme, selected->slot, s->line, k->trace);
        hn_canvas_segment(c, x, middle, to[0], middle, &stroke);
        break;
    }
    const double text = x + fmax(LEGEND_TEXT * font, to[0] - x + 0.7 * font);
    const double room = x + s->legend.width - text, wide = hn_canvas_text_width(size, k->text);
    const double fitting = size * fmax(SMALLEST_KEY, fmin(1, room / wide));
    hn_legend_text(c, text, y, fitting, room, surface->ink, k->text);
}

// ---- rows ----

/// How many rows stand side by side.
static int count_columns(const hn_sheet *s, const hn_label_places *placed, double font) {
    double widest = 1;
    for (int i = 0; i < placed->n_rows; i++) {
        widest = fmax(widest, hn_canvas_text_width(NOTE_SIZE * font, placed->row[i]) + font);
    }
    return (int)fmax(1, fmin(COLUMNS, floor((s->legend.width + font) / widest)));
}

static double rows_height(const hn_sheet *s, const hn_label_places *placed, double font) {
    const int columns = count_columns(s, placed, font);
    const int down = (placed->n_rows + columns - 1) / columns;
    return down > 0 ? NOTE_PITCH * NOTE_SIZE * font * (down + 0.4) : 0;
}

static void draw_rows(hn_canvas *c, const hn_sheet *s, const hn_label_places *placed, double y,
                      double font) {
    const int columns = count_columns(s, placed, font);
    const int down = (placed->n_rows + columns - 1) / columns;
    const double size = NOTE_SIZE * font, wide = s->legend.width / columns;
    for (int i = 0; i < placed->n_rows; i++) {
        hn_legend_text(c, s->legend.x + wide * (i / down), y + NOTE_PITCH * size * (i % down + 1),
                       size, wide - 0.3 * font, hn_surface_get(hn_canvas_theme(c))->ink,
                       placed->row[i]);
    }
}

// ---- the whole ----

static double whole_height(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *poses,
                           int n_poses, const hn_snapshot_opts *opts, int n_keys,
                           const hn_label_places *placed, double font) {
    return poses_height(s, d, poses, n_poses, opts->continued, font) + KEY_PITCH * font * n_keys +
           rows_height(s, placed, font);
}

double hn_legend_height(const hn_sheet *s, const hn_drawing *d, const hn_snapshot_pose *poses,
                        int n_poses, const hn_snapshot_opts *opts, const hn_label_places *placed) {
    const keys k = list_keys(s, poses, n_poses, opts, placed);
    return whole_height(s, d, poses, n_poses, opts, k.n, placed, s->font);
}

void hn_snapshot_legend(hn_canvas *c, const hn_sheet *s, const hn_drawing *d,
                        const hn_snapshot_pose *poses, int n_poses, const hn_snapshot_opts *opts,
                        const hn_label_places *placed) {
    const keys k = list_keys(s, poses, n_poses, opts, placed);
    row r = {c, s, d, opts->continued, s->legend.y, s->font};
    // smaller until they fit; narrower letters also need fewer lines
    while (r.font > SMALLEST_LETTER &&
           whole_height(s, d, poses, n_poses, opts, k.n, placed, r.font) > s->height - r.y) {
        r.font *= 0.96;
    }
    for (int i = 0; i < n_poses; i++) {
        if (!poses[i].faint) {
            draw_legend_row(&r, &poses[i], i == s->selected);
            r.y += legend_pitch(s, d, &poses[i], opts->continued, r.font);
        }
    }
    for (int i = 0; i < k.n; i++) {
        draw_key(c, s, &poses[s->selected], &k.at[i], r.y + r.font, r.font);
        r.y += KEY_PITCH * r.font;
    }
    draw_rows(c, s, placed, r.y, r.font);
}

void hn_legend_json(hn_strbuf *b, const hn_sheet *s, const hn_snapshot_pose *poses, int n_poses,
                    const hn_snapshot_opts *opts, const hn_label_places *placed) {
    const keys k = list_keys(s, poses, n_poses, opts, placed);
    hn_json_key(b, "legend");
    hn_json_array(b);
    for (int i = 0; i < k.n; i++) {
        hn_json_string(b, k.at[i].text);
    }
    hn_json_end_array(b);
    hn_json_key(b, "force_scale");
    if (opts->n_loads > 0) {
        hn_json_object(b);
        hn_json_put_number(b, "force", hn_legend_force(s, opts));
        hn_json_put_number(b, "pixels", hn_legend_force(s, opts) * hn_load_scale(s, opts));
        hn_json_end_object(b);
    } else {
        hn_json_null(b);
    }
}
