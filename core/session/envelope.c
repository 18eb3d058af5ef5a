#include "session/envelope.h"

#include "dynamics/eval.h"
#include "study/run.h"

#include <math.h>
#include <string.h>

/// How far the envelope looks ahead: enough for a few turns, bounded in steps so that no scene makes it slow.
enum { ENVELOPE_SAMPLES = 160, ENVELOPE_MAX_STEPS = 4000, ENVELOPE_MAX_ROWS = 120 };
static const double ENVELOPE_SECONDS = 10;
static const char *const ENVELOPE_METHOD = "index1@dopri5:rtol=1e-5";

/// 1 for a point that only tells the direction of a slider or a guide: nothing is drawn there.
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

/// Box around every point that is drawn, from points (3 n).
static void grow_box(double box[4], const double *points, const char *skipped, int n) {
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < 2; k++) {
            double x = points[3 * i + k];
            if (!skipped[i] && isfinite(x)) {
                box[k] = fmin(box[k], x);
                box[2 + k] = fmax(box[2 + k], x);
            }
        }
    }
}

/// Looks ahead along the motion, so that a view can be fitted once. What a failing run reached still counts.
static void grow_box_by_motion(double box[4], const char *skipped, const hn_model *model) {
    hn_system_info info = hn_system_get_info(hn_model_system(model));
    hn_method_spec spec;
    hn_run *run = NULL;
    hn_run_opts opts = hn_run_opts_default();
    opts.max_steps = ENVELOPE_MAX_STEPS;
    if (!hn_model_assembly(model)->ok || info.nc > ENVELOPE_MAX_ROWS ||
        hn_method_parse(ENVELOPE_METHOD, &spec, NULL) != HN_OK ||
        hn_run_create(hn_model_system(model), &spec, hn_model_q(model), hn_model_v(model), &opts,
                      &run, NULL) != HN_OK) {
        return;
    }
    hn_run_watch(run, 0);
    double end = fmin(ENVELOPE_SECONDS, hn_model_scene(model)->duration);
    for (int k = 1; k <= ENVELOPE_SAMPLES; k++) {
        double t = end * k / ENVELOPE_SAMPLES;
        hn_sample sample;
        if (hn_run_advance(run, t) != HN_OK || hn_run_sample(run, t, &sample) != HN_OK) {
            break;
        }
        grow_box(box, sample.points, skipped, info.n_points);
    }
    hn_run_free(run);
}

hn_status hn_model_points(const hn_model *model, const double *q, double *points) {
    const int n = hn_system_get_info(hn_model_system(model)).n_points;
    hn_arena *arena = hn_arena_create(0);
    hn_eval *eval = NULL;
    hn_status status = arena ? hn_eval_create(hn_model_system(model), HN_TERM_POINTS, arena, &eval)
                             : HN_ERR_MEMORY;
    if (status == HN_OK) {
        hn_eval_run(eval, 0, q, hn_model_v(model));
        memcpy(points, hn_eval_get(eval, HN_TERM_POINTS), 3 * (size_t)n * sizeof *points);
    }
    hn_eval_free(eval);
    hn_arena_free(arena);
    return status;
}

void hn_model_envelope(const hn_model *model, double box[4]) {
    const int n = hn_system_get_info(hn_model_system(model)).n_points;
    hn_arena *arena = hn_arena_create(0);
    double *points = arena ? hn_arena_doubles(arena, 3 * (size_t)n + 1) : NULL;
    char *skipped = arena ? hn_arena_get(arena, (size_t)n + 1) : NULL;
    memset(box, 0, 4 * sizeof *box);
    if (n > 0 && points && skipped && hn_model_points(model, hn_model_q(model), points) == HN_OK) {
        box[0] = box[1] = HUGE_VAL;
        box[2] = box[3] = -HUGE_VAL;
        const hn_drawing drawing = hn_system_drawing(hn_model_system(model));
        for (int i = 0; i < n; i++) {
            skipped[i] = is_direction_only(&drawing, i);
        }
        grow_box(box, points, skipped, n);
        grow_box_by_motion(box, skipped, model);
        for (int k = 0; k < 4; k++) {
            box[k] = isfinite(box[k]) ? box[k] : 0;
        }
    }
    hn_arena_free(arena);
}
