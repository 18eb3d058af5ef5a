// SPDX-License-Identifier: GPL-3.0-or-later
// Painting what a canvas has recorded: OSMesa for the pixels, the built-in renderer where it is
// missing.
#include "render/canvas.h"

#include "base/clock.h"
#include "base/file.h"
#include "render/canvas_bounds.h"
#include "render/canvas_record.h"
#include "render/osmesa.h"
#include "render/osmesa_turn.h"
#include "render/png_file.h"
#include "render/raster.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// a tile of 256 pixels has 1024 samples a side: 4 MB of colour and 4 MB of stencil, whatever the
// sheet
enum { TILE = 256, SIDE = HN_CANVAS_SAMPLES * TILE, MAX_STENCIL = 255 };

/// A thread paints for so long before another may [s].
static const double SLICE = 0.05;

typedef struct tile {
    int x0, y0, x1, y1; ///< [px], always TILE by TILE: the last ones reach over the sheet's edge
} tile;

static void set_colour(const hn_osmesa *gl, uint32_t rgb, double alpha) {
    gl->glColor4f((float)(rgb >> 16 & 0xff) / 255.0f, (float)(rgb >> 8 & 0xff) / 255.0f,
                  (float)(rgb & 0xff) / 255.0f, (float)alpha);
}

static void set_view(const hn_osmesa *gl, const tile *t, uint32_t paper) {
    gl->glViewport(0, 0, SIDE, SIDE);
    gl->glMatrixMode(GL_PROJECTION);
    gl->glLoadIdentity();
    gl->glOrtho(t->x0, t->x1, t->y1, t->y0, -1, 1);
    gl->glMatrixMode(GL_MODELVIEW);
    gl->glLoadIdentity();

    gl->glDisable(GL_SCISSOR_TEST);
    gl->glClearColor((float)(paper >> 16 & 0xff) / 255.0f, (float)(paper >> 8 & 0xff) / 255.0f,
                     (float)(paper & 0xff) / 255.0f, 1);
    gl->glClear(GL_COLOR_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

static int max_int(int a, int b) {
    return a > b ? a : b;
}

static int min_int(int a, int b) {
    return a < b ? a : b;
}

/// Limits drawing to the shape's rectangle within the tile; 0 if nothing is left.
static bool set_clip(const hn_osmesa *gl, const hn_canvas_shape *s, const tile *t) {
    const int x0 = max_int(s->clip[0], t->x0), x1 = min_int(s->clip[2], t->x1);
    const int y0 = max_int(s->clip[1], t->y0), y1 = min_int(s->clip[3], t->y1);
    if (x0 >= x1 || y0 >= y1) {
        return false;
    }
    gl->glEnable(GL_SCISSOR_TEST);
    gl->glScissor(HN_CANVAS_SAMPLES * (x0 - t->x0), HN_CANVAS_SAMPLES * (t->y1 - y1),
                  HN_CANVAS_SAMPLES * (x1 - x0), HN_CANVAS_SAMPLES * (y1 - y0));
    return true;
}

static void draw_shape(const hn_osmesa *gl, const hn_canvas *c, const hn_canvas_shape *s,
                       const tile *t) {
    if (set_clip(gl, s, t)) {
        set_colour(gl, s->paint.rgb, s->paint.alpha * c->layers[s->layer]);
        gl->glDrawArrays(GL_TRIANGLES, s->first, s->count);
    }
}

/// Every sample of a layer takes its colour from one shape, the last that covers it: shapes are
/// drawn last to first, and the stencil keeps the layer's number where a sample is taken.
static void draw_layer(const hn_osmesa *gl, const hn_canvas *c, const hn_bounds *box, int first,
                       int end, int number, const tile *t) {
    gl->glStencilFunc(GL_NOTEQUAL, number, 0xff);
    for (int i = end - 1; i >= first; i--) {
        if (c->shapes[i].count > 0 && !hn_bounds_is_beside(box[i], t->x0, t->y0, TILE)) {
            draw_shape(gl, c, &c->shapes[i], t);
        }
    }
}

static void draw_tile(const hn_osmesa *gl, const hn_canvas *c, const hn_bounds *box,
                      const tile *t) {
    set_view(gl, t, hn_surface_get(c->theme)->paper);
    int number = 0;
    for (int first = 0, end; first < c->n_shapes; first = end) {
        for (end = first + 1; end < c->n_shapes && c->shapes[end].layer == c->shapes[first].layer;
             end++) {}
        if (++number > MAX_STENCIL) {
            gl->glDisable(GL_SCISSOR_TEST);
            gl->glClear(GL_STENCIL_BUFFER_BIT);
            number = 1;
        }
        draw_layer(gl, c, box, first, end, number, t);
    }
    gl->glFinish();
}

static void set_state(const hn_osmesa *gl, const hn_canvas *c) {
    gl->OSMesaPixelStore(OSMESA_Y_UP, 0);
    gl->glDisable(GL_DEPTH_TEST);
    gl->glDisable(GL_DITHER);
    gl->glEnable(GL_BLEND);
    gl->glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl->glEnable(GL_STENCIL_TEST);
    gl->glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    gl->glEnableClientState(GL_VERTEX_ARRAY);
    gl->glVertexPointer(2, GL_FLOAT, 0, c->xy);
}

/// Averages squares of samples into the pixels of the tile that are on the sheet.
static void average(const unsigned char *samples, const tile *t, const hn_canvas *c,
                    unsigned char *rgb) {
    const int n = HN_CANVAS_SAMPLES, area = n * n;
    for (int y = t->y0; y < min_int(t->y1, c->height); y++) {
        for (int x = t->x0; x < min_int(t->x1, c->width); x++) {
            int sum[3] = {0, 0, 0};
            for (int j = 0; j < area; j++) {
                const size_t row = (size_t)(n * (y - t->y0) + j / n),
                             column = (size_t)(n * (x - t->x0) + j % n);
                const unsigned char *s = samples + 4 * (row * SIDE + column);
                sum[0] += s[0];
                sum[1] += s[1];
                sum[2] += s[2];
            }
            unsigned char *pixel = rgb + 3 * ((size_t)y * (size_t)c->width + (size_t)x);
            for (int k = 0; k < 3; k++) {
                pixel[k] = (unsigned char)((sum[k] + area / 2) / area);
            }
        }
    }
}

/// What one painting needs; the context is the thread's current one while it has the turn.
typedef struct painting {
    const hn_osmesa *gl;
    const hn_canvas *c;
    const hn_bounds *box; ///< of each shape
    unsigned char *samples, *rgb;
    OSMesaContext context;
    double slice_end; ///< the turn passes to others then [s, wall clock]
    bool has_turn;
} painting;

static hn_status fail_stopped(hn_diag *diag) {
    return hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL, "the picture was not painted to its end");
}

/// Lets others paint where this thread has painted for a slice of time.
static hn_status pass_turn(painting *p, hn_diag *diag) {
    if (hn_clock_wall() < p->slice_end) {
        return HN_OK;
    }
    p->gl->OSMesaMakeCurrent(NULL, NULL, 0, 0, 0);
    p->has_turn = hn_osmesa_turn_pass(p->c->interrupt);
    if (!p->has_turn) {
        return fail_stopped(diag);
    }
    p->slice_end = hn_clock_wall() + SLICE;
    return p->gl->OSMesaMakeCurrent(p->context, p->samples, GL_UNSIGNED_BYTE, SIDE, SIDE)
               ? HN_OK
               : hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "no memory to paint a tile");
}

static hn_status paint_tiles(painting *p, hn_diag *diag) {
    const hn_canvas *c = p->c;
    set_state(p->gl, c);
    for (int y = 0; y < c->height; y += TILE) {
        for (int x = 0; x < c->width; x += TILE) {
            const tile t = {x, y, x + TILE, y + TILE};
            HN_TRY(pass_turn(p, diag));
            draw_tile(p->gl, c, p->box, &t);
            const GLenum fault = p->gl->glGetError();
            if (fault != GL_NO_ERROR) {
                return hn_diag_set(diag, HN_ERR_INTERNAL, NULL, NULL,
                                   "OSMesa reports GL fault 0x%04x while drawing", (unsigned)fault);
            }
            average(p->samples, &t, c, p->rgb);
        }
    }
    return HN_OK;
}

/// Makes a context that draws into the samples, paints, and lets it go.
static hn_status paint_with_context(painting *p, hn_diag *diag) {
    const hn_osmesa *gl = p->gl;
    p->context = gl->OSMesaCreateContextExt(OSMESA_RGBA, 0, 8, 0, NULL);
    if (p->context == NULL ||
        !gl->OSMesaMakeCurrent(p->context, p->samples, GL_UNSIGNED_BYTE, SIDE, SIDE)) {
        if (p->context != NULL) {
            gl->OSMesaDestroyContext(p->context);
        }
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "install libosmesa6",
                           "OSMesa gives no off-screen drawing context, so no picture can be made");
    }
    const hn_status status = paint_tiles(p, diag);

    // a context goes in its turn only
    p->has_turn = p->has_turn || hn_osmesa_turn_take(NULL);
    gl->OSMesaMakeCurrent(NULL, NULL, 0, 0, 0);
    gl->OSMesaDestroyContext(p->context);
    return status;
}

static hn_renderer chosen = HN_RENDERER_COUNT; // none: HOLONOM_RENDERER decides

void hn_canvas_choose_renderer(hn_renderer renderer) {
    chosen = renderer;
}

/// Returns whether the built-in renderer is asked for, by choice or by HOLONOM_RENDERER.
static bool wants_builtin(void) {
    const char *wanted = getenv("HOLONOM_RENDERER");
    return chosen == HN_RENDERER_BUILT_IN ||
           (chosen == HN_RENDERER_COUNT && wanted && strcmp(wanted, "built-in") == 0);
}

const char *hn_canvas_renderer(void) {
    return !wants_builtin() && hn_osmesa_get(NULL) ? "OSMesa" : "built-in";
}

/// With OSMesa's samples. HN_ERR_UNSUPPORTED: it gives no context.
static hn_status paint_with_osmesa(const hn_osmesa *gl, const hn_canvas *c, unsigned char *rgb,
                                   hn_diag *diag) {
    unsigned char *samples = malloc((size_t)4 * SIDE * SIDE);
    hn_bounds *box = hn_bounds_of_shapes(c);
    hn_status status =
        samples && box ? HN_OK
                       : hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "no memory to paint a tile");
    if (status == HN_OK && !hn_osmesa_turn_take(c->interrupt)) {
        status = fail_stopped(diag);
    } else if (status == HN_OK) {
        painting p = {.gl = gl, .c = c, .box = box, .samples = samples, .rgb = rgb};
        p.has_turn = true;
        p.slice_end = hn_clock_wall() + SLICE;
        status = paint_with_context(&p, diag);
        hn_osmesa_turn_give();
    }
    free(box);
    free(samples);
    return status;
}

hn_status hn_canvas_paint(const hn_canvas *c, unsigned char *rgb, hn_diag *diag) {
    HN_ASSERT(c != NULL && rgb != NULL && !c->in_layer);
    if (c->failed) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "memory ran out while drawing");
    }
    const hn_osmesa *gl = wants_builtin() ? NULL : hn_osmesa_get(NULL);
    return gl != NULL ? paint_with_osmesa(gl, c, rgb, diag) : hn_raster_paint(c, rgb, diag);
}

hn_status hn_canvas_png(const hn_canvas *c, hn_strbuf *png, hn_diag *diag) {
    HN_ASSERT(c != NULL && png != NULL);
    unsigned char *rgb = malloc((size_t)3 * (size_t)c->width * (size_t)c->height);
    if (rgb == NULL) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL,
                           "no memory for a picture of %d by %d pixels", c->width, c->height);
    }
    hn_status status = hn_canvas_paint(c, rgb, diag);
    HN_THEN(status, hn_png_encode(png, c->width, c->height, rgb, c->interrupt, diag));
    free(rgb);
    return status;
}
