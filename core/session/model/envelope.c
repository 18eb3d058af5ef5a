// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/envelope.h"

#include "dynamics/evaluate/eval.h"
#include "study/run/run.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/// Bounds of the motion that the envelope covers: some revolutions, and little computing time for
/// any scene.
enum { ENVELOPE_SAMPLES = 160, ENVELOPE_MAX_STEPS = 4000, ENVELOPE_MAX_ROWS = 120 };
static const double ENVELOPE_SECONDS = 10;
static const double FAR = 4;     ///< multiple of the extent at the start
static const double FLAT = 1e-6; ///< of the largest extent: a thinner mechanism is planar
static const char *const ENVELOPE_METHOD = "index1@dopri5:rtol=1e-5";

/// Returns 1 for a point that only gives the direction of a slider or a guide and is not drawn.
static char is_direction_only(const hn_drawing *d, int point) {
    char directs = 0;
    for (int i = 0; i < d->n_shapes; i++) {
        const hn_shape *s = &d->shapes[i];
        const int directed = s->kind == HN_SHAPE_SLIDER || s->kind == HN_SHAPE_GUIDE;
        const int last = s->kind == HN_SHAPE_POLYGON ? s->p + s->n - 1 : s->p;
        if ((point >= s->p && point <= last) || (!directed && point == s->q)) {
            return 0;
        }
        directs |= directed && point == s->q;
    }
    return directs && !d->labels[point];
}

void hn_model_drawn_points(const hn_model *model, char *is_drawn) {
    const hn_drawing drawing = hn_system_drawing(hn_model_system(model));
    for (int i = 0; i < hn_system_get_info(hn_model_system(model)).n_points; i++) {
        is_drawn[i] = !is_direction_only(&drawing, i);
    }
}

enum { FRONT, SPACE, FRONT_Z_UP, SPACE_Z_UP, VIEWS };

/// The extents that the drawn points have reached: in the world, and in the front and the oblique
/// view, with y and with z upwards.
typedef struct reach {
    double low[3], high[3];
    double direction[HN_ENVELOPE_EXTREMES][3], farthest[HN_ENVELOPE_EXTREMES];
    double extremes[HN_ENVELOPE_EXTREMES][3];
    hn_view views[VIEWS];
    double boxes[VIEWS][4];
} reach;

/// Directions spread evenly over the sphere, each a golden angle further round than the one before.
static void spread_directions(reach *r) {
    const double golden = 3.14159265358979324 * (3 - sqrt(5.0));
    for (int i = 0; i < HN_ENVELOPE_EXTREMES; i++) {
        const double y = 1 - (2.0 * i + 1) / HN_ENVELOPE_EXTREMES, across = sqrt(1 - y * y);
        r->direction[i][0] = across * cos(golden * i);
        r->direction[i][1] = y;
        r->direction[i][2] = across * sin(golden * i);
        r->farthest[i] = -HUGE_VAL;
    }
}

static void grow_extremes(reach *r, const double p[3]) {
    for (int i = 0; i < HN_ENVELOPE_EXTREMES; i++) {
        const double *d = r->direction[i];
        const double far = d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
        if (far > r->farthest[i]) {
            r->farthest[i] = far;
            memcpy(r->extremes[i], p, sizeof r->extremes[i]);
        }
    }
}

static void begin_reach(reach *r, const hn_view *look) {
    r->views[FRONT] = look ? *look : hn_view_front();
    r->views[SPACE] = look ? *look : hn_view_space();
    r->views[FRONT_Z_UP] = hn_view_z_up(r->views[FRONT]);
    r->views[SPACE_Z_UP] = hn_view_z_up(r->views[SPACE]);
    memset(r->extremes, 0, sizeof r->extremes);
    spread_directions(r);
    for (int k = 0; k < 3; k++) {
        r->low[k] = HUGE_VAL;
        r->high[k] = -HUGE_VAL;
    }
    for (int i = 0; i < VIEWS; i++) {
        r->boxes[i][0] = r->boxes[i][1] = HUGE_VAL;
        r->boxes[i][2] = r->boxes[i][3] = -HUGE_VAL;
    }
}

static void grow(reach *r, const double *points, const char *skipped, int n) {
    for (int i = 0; i < n; i++) {
        const double *p = points + 3 * i;
        if (skipped[i] || !isfinite(p[0] + p[1] + p[2])) {
            continue;
        }
        grow_extremes(r, p);
        for (int k = 0; k < 3; k++) {
            r->low[k] = fmin(r->low[k], p[k]);
            r->high[k] = fmax(r->high[k], p[k]);
        }
        for (int i_view = 0; i_view < VIEWS; i_view++) {
            double seen[2];
            hn_view_project(&r->views[i_view], p, seen);
            for (int k = 0; k < 2; k++) {
                r->boxes[i_view][k] = fmin(r->boxes[i_view][k], seen[k]);
                r->boxes[i_view][2 + k] = fmax(r->boxes[i_view][2 + k], seen[k]);
            }
        }
    }
}

static double extent(const reach *r) {
    double size = 0;
    for (int k = 0; k < 3; k++) {
        size = fmax(size, r->high[k] - r->low[k]);
    }
    return size;
}

/// Extends the box by the motion, so that a view has to be fitted only once. A failing run counts
/// up to its failure. A mechanism that falls or flies away is followed for a few lengths only, as a
/// view of its whole path would show a dot.
static void grow_by_motion(reach *r, const char *skipped, const hn_model *model) {
    hn_system_info info = hn_system_get_info(hn_model_system(model));
    hn_method_spec spec;
    hn_run *run = NULL;
    hn_run_opts opts = hn_run_opts_default();
    opts.max_steps = ENVELOPE_MAX_STEPS;

    // a scene that does not assemble, or has too many constraint rows, is not run
    if (!hn_model_assembly(model)->ok || info.nc > ENVELOPE_MAX_ROWS ||
        hn_method_parse(ENVELOPE_METHOD, &spec, NULL) != HN_OK ||
        hn_run_create(hn_model_system(model), &spec, hn_model_q(model), hn_model_v(model), &opts,
                      &run, NULL) != HN_OK) {
        return;
    }
    hn_run_watch(run, 0);

    // sample the motion until it ends, fails or leaves the neighbourhood
    const double far = FAR * fmax(extent(r), hn_system_length(hn_model_system(model)));
    double end = fmin(ENVELOPE_SECONDS, hn_model_scene(model)->duration);
    for (int k = 1; k <= ENVELOPE_SAMPLES; k++) {
        double t = end * k / ENVELOPE_SAMPLES;
        hn_sample sample;
        if (hn_graph_is_interrupted(hn_system_graph(hn_model_system(model)))) {
            break;
        }
        if (hn_run_advance(run, t) != HN_OK || hn_run_sample(run, t, &sample) != HN_OK) {
            break;
        }
        reach more = *r;
        grow(&more, sample.points, skipped, info.n_points);
        if (extent(&more) > far) {
            break;
        }
        *r = more;
    }
    hn_run_free(run);
}

static hn_status eval_points(const hn_model *model, double t, const double *q, double *points) {
    const int n = hn_system_get_info(hn_model_system(model)).n_points;
    hn_arena *arena = hn_arena_create(0);
    hn_eval *eval = NULL;
    hn_status status = arena ? hn_eval_create(hn_model_system(model), HN_TERM_POINTS, arena, &eval)
                             : HN_ERR_MEMORY;
    if (status == HN_OK) {
        hn_eval_run(eval, t, q, hn_model_v(model));
        memcpy(points, hn_eval_get(eval, HN_TERM_POINTS), 3 * (size_t)n * sizeof *points);
    }
    hn_eval_free(eval);
    hn_arena_free(arena);
    return status;
}

hn_status hn_model_points(const hn_model *model, const double *q, double *points) {
    return eval_points(model, 0, q, points);
}

// a point of a body is a function of the coordinates and time, so it differs between two states in
// which all of them differ; a point of the ground is constant
hn_status hn_model_ground_points(const hn_model *model, char *is_ground) {
    const hn_system_info info = hn_system_get_info(hn_model_system(model));
    const size_t n = 3 * (size_t)info.n_points;
    hn_arena *arena = hn_arena_create(0);
    double *here = arena ? hn_arena_doubles(arena, n + 1) : NULL;
    double *there = arena ? hn_arena_doubles(arena, n + 1) : NULL;
    double *q = arena ? hn_arena_doubles(arena, (size_t)info.nq + 1) : NULL;

    // points at the start, and at another configuration and time
    hn_status status = here && there && q ? HN_OK : HN_ERR_MEMORY;
    if (status == HN_OK) {
        for (int i = 0; i < info.nq; i++) {
            q[i] = hn_model_q(model)[i] + 0.3 + 0.7 / (i + 2); // unequal, never a full turn
        }
        status = hn_model_points(model, hn_model_q(model), here);
    }
    HN_THEN(status, eval_points(model, 0.7312, q, there));

    // a point of the ground is the same in both, to the last bit
    for (int i = 0; i < info.n_points && status == HN_OK; i++) {
        is_ground[i] = memcmp(here + 3 * i, there + 3 * i, 3 * sizeof *here) == 0;
    }
    hn_arena_free(arena);
    return status;
}

static bool pulls_along_z(const hn_scene *scene) {
    const double x = scene->gravity[0].value, y = scene->gravity[1].value,
                 z = scene->gravity[2].value;
    return z < 0 && fabs(z) > 10 * hypot(x, y);
}

static void read_reach(const reach *r, const hn_scene *scene, hn_envelope *out) {
    double size = 0;
    for (int k = 0; k < 3; k++) {
        out->low[k] = isfinite(r->low[k]) ? r->low[k] : 0;
        out->high[k] = isfinite(r->high[k]) ? r->high[k] : 0;
        size = fmax(size, out->high[k] - out->low[k]);
    }

    // a plane mechanism has no extent along one axis
    memcpy(out->extremes, r->extremes, sizeof out->extremes);
    const int flat_in_z = !(out->high[2] - out->low[2] > FLAT * size);
    const int flat_in_y = !(out->high[1] - out->low[1] > FLAT * size);
    out->z_up = pulls_along_z(scene) && !flat_in_z;
    out->spatial = out->z_up ? !flat_in_y : !flat_in_z;

    // the projection that fits, and the box in it
    const int view = 2 * out->z_up + out->spatial;
    out->look = r->views[view];
    for (int k = 0; k < 4; k++) {
        const double x = r->boxes[view][k];
        out->box[k] = isfinite(x) ? x : 0;
    }
}

void hn_model_envelope(const hn_model *model, const hn_view *look, hn_envelope *out) {
    const int n = hn_system_get_info(hn_model_system(model)).n_points;
    hn_arena *arena = hn_arena_create(0);
    double *points = arena ? hn_arena_doubles(arena, 3 * (size_t)n + 1) : NULL;
    char *skipped = arena ? hn_arena_get(arena, (size_t)n + 1) : NULL;
    reach r;
    begin_reach(&r, look);
    if (n > 0 && points && skipped && hn_model_points(model, hn_model_q(model), points) == HN_OK) {
        const hn_drawing drawing = hn_system_drawing(hn_model_system(model));
        for (int i = 0; i < n; i++) {
            skipped[i] = is_direction_only(&drawing, i);
        }
        grow(&r, points, skipped, n);
        grow_by_motion(&r, skipped, model);
    }
    read_reach(&r, hn_model_scene(model), out);
    hn_arena_free(arena);
}
