// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/picture.h"

#include "base/units.h"
#include "render/canvas_svg.h"
#include "render/png_file.h"
#include "session/compare/comparison_doc.h"
#include "session/compare/picture_moment.h"
#include "session/model/caption.h"
#include "session/model/envelope.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_WIDTH = 1200, DEFAULT_HEIGHT = 720, PANEL_WIDTH = 720, PANEL_HEIGHT = 480 };
enum { MOST_COLUMNS = 5 }; // of a strip

/// The data of one file: its moments, and a canvas for each, or one for all of them.
typedef struct sheet {
    const hn_model *model;
    const hn_picture_request *request;
    hn_drawing drawing;
    int n_moments, n_canvases, width, height;
    hn_picture_moment *moments;
    hn_canvas *canvas[HN_PICTURE_TIMES];
    hn_snapshot_pose *poses; ///< of the canvas that is drawn: faint ones first
    hn_snapshot_opts opts;
    char caption[160];
} sheet;

/// Fits the view to the whole motion, so that it does not change in a series of pictures. A given
/// pose may lie outside the motion, so its view is not fitted to it.
static hn_status choose_view(sheet *p, hn_diags *diags) {
    hn_envelope e;
    hn_view asked;
    hn_diag diag = {0};
    if (p->request->view && hn_view_parse(p->request->view, &asked, &diag) != HN_OK) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/view", diag.hint, "%s", diag.message);
    }

    // fit the frame
    hn_model_envelope(p->model, p->request->view ? &asked : NULL, &e);
    HN_TRY(hn_graph_status(hn_system_graph(hn_model_system(p->model))));
    p->opts = hn_snapshot_opts_default();
    p->opts.look = e.look;
    if (p->request->methods && e.box[2] > e.box[0]) {
        p->opts.view[0] = e.box[0];
        p->opts.view[1] = e.box[2];
        p->opts.view[2] = e.box[1];
        p->opts.view[3] = e.box[3];
    }

    // title line
    hn_model_caption(p->model, p->caption, sizeof p->caption);
    p->opts.title = hn_model_scene(p->model)->title;
    p->opts.caption = p->request->caption ? p->request->caption : p->caption;
    p->opts.dimensions = p->request->dimensions;
    return HN_OK;
}

static hn_status add_diag(hn_diags *diags, hn_status status, const hn_diag *d) {
    return status == HN_OK ? HN_OK
                           : hn_diags_add(diags, status, d->pointer, d->hint, "%s", d->message);
}

/// The poses of a canvas: those of its moment, after the faint ones of all moments before it.
static int gather(sheet *p, int moment) {
    int n = 0;
    for (int i = 0; i < moment && p->request->ghosts; i++) {
        p->poses[n] = p->moments[i].poses[0];
        p->poses[n].faint = true;
        p->poses[n].selected = 0;
        p->poses[n].time = p->moments[i].reached[0];
        p->poses[n++].n_trace = 0;
    }
    const hn_picture_moment *m = &p->moments[moment];
    memcpy(p->poses + n, m->poses, (size_t)m->n_poses * sizeof *p->poses);
    p->opts.time = m->comparison ? m->reached[0] : m->time;
    p->opts.stopped = m->comparison && m->reached[0] < m->time;
    p->opts.n_traces = m->comparison ? m->n_traces : 0;
    p->opts.traces = m->trace_names;
    p->opts.continued = moment > 0 && !p->request->ghosts && p->request->form != HN_PICTURE_APNG;
    p->opts.n_loads = m->n_loads;
    p->opts.loads = m->loads;
    p->opts.n_angles = m->n_angles;
    p->opts.angles = m->angles;
    return n + m->n_poses;
}

/// The moment that canvas k shows.
static int moment_of(const sheet *p, int k) {
    return p->request->ghosts ? p->n_moments - 1 : k;
}

/// One scale of forces for all moments: arrows of the same length are equal forces.
static void choose_force_scale(sheet *p) {
    double seen[2];
    for (int i = 0; i < p->n_moments && p->n_canvases > 1; i++) {
        const hn_picture_moment *m = &p->moments[i];
        for (int k = 0; k < m->n_loads; k++) {
            hn_view_project(&p->opts.look, m->loads[k].force, seen);
            p->opts.longest_load = fmax(p->opts.longest_load, hypot(seen[0], seen[1]));
        }
    }
}

static hn_status draw(sheet *p, hn_diags *diags) {
    const hn_picture_request *r = p->request;
    const bool strip = p->n_canvases > 1 && r->form != HN_PICTURE_APNG;
    hn_diag diag = {0};
    hn_status status = HN_OK;
    p->width = r->width ? r->width : strip ? PANEL_WIDTH : DEFAULT_WIDTH;
    p->height = r->height ? r->height : strip ? PANEL_HEIGHT : DEFAULT_HEIGHT;
    choose_force_scale(p);
    for (int k = 0; k < p->n_canvases && status == HN_OK; k++) {
        const int n = gather(p, moment_of(p, k));
        status = hn_canvas_create(p->width, p->height, r->theme, &p->canvas[k], &diag);
        if (status == HN_OK) {
            hn_canvas_interrupt(p->canvas[k], r->interrupt);
        }
        HN_THEN(status, hn_snapshot_draw(p->canvas[k], &p->drawing, p->poses, n, &p->opts, &diag));
        hn_snapshot_place at = {0};
        HN_THEN(status, hn_snapshot_find_place(&at, p->width, p->height, &p->drawing, p->poses, n,
                                               &p->opts, &diag));
        if (r->mechanism) {
            *r->mechanism = at.size;
        }
    }
    return add_diag(diags, status, &diag);
}

// ---- files ----

/// Returns how many panels of a strip stand in a row: up to three in one row; otherwise as many as
/// leave the fewest places empty, nearest to a square.
static int count_columns(int n) {
    const double square = ceil(sqrt(n));
    int best = n < 3 ? n : 3;
    for (int k = 2; k <= MOST_COLUMNS && n > 3 && k < n; k++) {
        const int empty = (k - n % k) % k, least = (best - n % best) % best;
        const double apart = fabs(k - square) - fabs(best - square);
        best = empty < least || (empty == least && apart <= 0) ? k : best;
    }
    return best;
}

/// All canvases as one PNG.
static hn_status write_strip(const sheet *p, hn_strbuf *out, hn_diag *diag) {
    const int n = p->n_canvases, across = count_columns(n);
    const int down = (n + across - 1) / across;
    const size_t row = 3 * (size_t)p->width, whole = row * (size_t)across;
    unsigned char *one = malloc(row * (size_t)p->height);
    unsigned char *all = malloc(whole * (size_t)(p->height * down));
    hn_status status = one && all ? HN_OK : HN_ERR_MEMORY;

    // empty places are paper
    const uint32_t paper = hn_surface_get(p->request->theme)->paper;
    for (size_t i = 0; status == HN_OK && i < whole * (size_t)(p->height * down); i++) {
        all[i] = (unsigned char)(paper >> (16 - 8 * (i % 3)));
    }
    for (int k = 0; k < n && status == HN_OK; k++) {
        status = hn_canvas_paint(p->canvas[k], one, diag);
        for (int y = 0; y < p->height && status == HN_OK; y++) {
            const size_t to =
                (size_t)(k / across * p->height + y) * whole + (size_t)(k % across) * row;
            memcpy(all + to, one + (size_t)y * row, row);
        }
    }
    HN_THEN(status, hn_png_encode(out, p->width * across, p->height * down, all,
                                  p->request->interrupt, diag));
    free(one);
    free(all);
    return status;
}

static hn_status write_animation(const sheet *p, hn_strbuf *out, hn_diag *diag) {
    hn_strbuf frames[HN_PICTURE_TIMES];
    hn_status status = HN_OK;
    for (int k = 0; k < p->n_canvases; k++) {
        hn_strbuf_init(&frames[k]);
        HN_THEN(status, hn_canvas_png(p->canvas[k], &frames[k], diag));
    }
    HN_THEN(status, hn_png_animate(out, frames, p->n_canvases, p->request->delay, diag));
    for (int k = 0; k < p->n_canvases; k++) {
        hn_strbuf_reset(&frames[k]);
    }
    return status;
}

// ---- words ----

/// Writes the content of the picture in sentences.
static void put_words(hn_strbuf *b, const sheet *p) {
    hn_strbuf_printf(b, "%s.", p->opts.title ? p->opts.title : "");
    for (int i = 0; i < p->n_moments; i++) {
        const hn_picture_moment *m = &p->moments[i];
        hn_strbuf_add(b, isfinite(m->time) ? "" : " One configuration, without a motion.");
        if (isfinite(m->time)) {
            hn_strbuf_printf(b, " At t = %.4g s:", m->time);
        }
        for (int k = 0; k < m->n_poses && isfinite(m->time); k++) {
            hn_strbuf_printf(b, "%s %s, %s", k ? ";" : "", m->poses[k].name, m->poses[k].note);
        }
        hn_strbuf_add(b, isfinite(m->time) ? "." : "");
        for (int k = 0; k < p->drawing.n_points && m->poses[0].points; k++) {
            const double *at = m->poses[0].points + 3 * k;
            if (p->drawing.labels[k]) {
                hn_strbuf_printf(b, " %s at (%.4g, %.4g, %.4g) m.", p->drawing.labels[k], at[0],
                                 at[1], at[2]);
            }
        }
    }
}

static hn_status describe(hn_strbuf *b, sheet *p, hn_diags *diags) {
    hn_diag diag = {0};
    hn_strbuf words;
    hn_strbuf_init(&words);
    put_words(&words, p);
    hn_status status = HN_OK;

    // what was asked for, and how it was drawn
    hn_json_object(b);
    hn_json_put_string(b, "scene", hn_model_scene(p->model)->id);
    hn_json_put_int(b, "width", p->width);
    hn_json_put_int(b, "height", p->height);
    hn_json_put_string(b, "renderer",
                       p->request->form == HN_PICTURE_SVG ? "none: vector graphics"
                                                          : hn_canvas_renderer());
    hn_json_put_string(b, "words", hn_strbuf_text(&words));
    b->failed |= words.failed;
    hn_strbuf_reset(&words);

    // the last moment, then the others, element by element
    const hn_picture_moment *last = &p->moments[p->n_moments - 1];
    if (last->comparison) {
        hn_json_put_number(b, "time", last->time);
        hn_json_key(b, "methods");
        hn_comparison_summary_json(b, last->comparison);
    }
    for (int k = p->n_canvases; k-- > 0 && status == HN_OK;) {
        const int n = gather(p, moment_of(p, k));
        if (k == p->n_canvases - 2) {
            hn_json_key(b, "before");
            hn_json_array(b);
        } else if (k == p->n_canvases - 1) {
            hn_json_key(b, "picture");
        }
        status =
            hn_snapshot_describe(b, p->width, p->height, &p->drawing, p->poses, n, &p->opts, &diag);
    }
    if (p->n_canvases > 1) {
        hn_json_end_array(b);
    }
    hn_json_end_object(b);
    return add_diag(diags, status, &diag);
}

static hn_status write_file(hn_strbuf *out, const sheet *p, hn_diags *diags) {
    hn_diag diag = {0};
    hn_strbuf words;
    hn_strbuf_init(&words);
    put_words(&words, p);
    hn_status status = words.failed ? HN_ERR_MEMORY : HN_OK;
    if (status == HN_OK && p->request->form == HN_PICTURE_SVG) {
        status = hn_canvas_svg(out, p->canvas, p->n_canvases, count_columns(p->n_canvases),
                               p->opts.title, hn_strbuf_text(&words), &diag);
    } else if (status == HN_OK && p->request->form == HN_PICTURE_APNG) {
        status = write_animation(p, out, &diag);
    } else if (status == HN_OK) {
        status = p->n_canvases == 1 ? hn_canvas_png(p->canvas[0], out, &diag)
                                    : write_strip(p, out, &diag);
    }
    hn_strbuf_reset(&words);
    return add_diag(diags, status, &diag);
}

// ---- the door ----

/// Runs to every moment, each from the start: a picture of several is what its parts are alone.
static hn_status make_moments(sheet *p, hn_status *ended, hn_diags *diags) {
    const hn_picture_request *r = p->request;
    hn_status status = HN_OK;
    if (r->n_times > 0 && !r->methods) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/at", "name a method, or leave the times out",
                            "a picture without a method has one moment, and times were asked for");
    }
    if (r->n_times > HN_PICTURE_TIMES) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/at", NULL,
                            "%d times were asked for; a picture can show 1 to %d", r->n_times,
                            HN_PICTURE_TIMES);
    }
    const int n = r->n_times > 0 ? r->n_times : 1;
    p->moments = calloc((size_t)n, sizeof *p->moments);
    p->poses = calloc(HN_PICTURE_TIMES + HN_COMPARISON_MAX_METHODS, sizeof *p->poses);
    status = p->moments && p->poses ? HN_OK : HN_ERR_MEMORY;
    for (int i = 0; i < n && status == HN_OK; i++) {
        const double time = !r->methods ? (double)NAN : r->n_times > 0 ? r->times[i] : r->time;
        p->n_moments = i + 1;
        status = hn_picture_moment_make(&p->moments[i], p->model, r, time, ended, diags);
    }
    p->n_canvases = r->ghosts ? 1 : n;
    return status;
}

hn_status hn_model_picture(hn_strbuf *file, hn_strbuf *description, const hn_model *model,
                           const hn_picture_request *request, hn_status *ended, hn_diags *diags) {
    sheet p = {
        .model = model, .request = request, .drawing = hn_system_drawing(hn_model_system(model))};
    hn_status run_status = HN_OK;
    hn_status status = make_moments(&p, &run_status, diags);
    HN_THEN(status, choose_view(&p, diags));
    HN_THEN(status, draw(&p, diags));
    HN_THEN(status, write_file(file, &p, diags));
    HN_THEN(status, description ? describe(description, &p, diags) : HN_OK);
    if (ended) {
        *ended = run_status;
    }

    for (int k = 0; k < p.n_canvases; k++) {
        hn_canvas_free(p.canvas[k]);
    }
    for (int i = 0; i < p.n_moments; i++) {
        hn_picture_moment_reset(&p.moments[i]);
    }
    free(p.moments);
    free(p.poses);
    return status;
}
