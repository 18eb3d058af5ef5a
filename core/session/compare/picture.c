// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/picture.h"

#include "base/arena.h"
#include "base/units.h"
#include "render/snapshot.h"
#include "session/model/caption.h"
#include "session/compare/comparison.h"
#include "session/model/envelope.h"
#include "session/model/state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DEFAULT_WIDTH = 1200, DEFAULT_HEIGHT = 720, MAX_NOTE = 160, MAX_FRAMES = 1000 };

/// The data of one picture.
typedef struct scene_picture {
    const hn_model *model;
    const hn_picture_request *request;
    hn_arena *arena;
    hn_comparison *comparison;
    int n_poses;
    hn_snapshot_pose poses[HN_COMPARISON_MAX_METHODS];
    char names[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    char notes[HN_COMPARISON_MAX_METHODS][MAX_NOTE];
    double *points; ///< 3 n_points per pose
    hn_snapshot_opts opts;
    char caption[160];
} scene_picture;

static hn_status check_time(double time, hn_diags *diags) {
    if (!(time >= 0) || !(time <= 1e6)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/time", NULL,
                            "the time is %g s; 0 to 1e6 s are allowed", time);
    }
    return HN_OK;
}

static double cpu_used(const hn_comparison *c) {
    double sum = 0;
    for (int i = 0; i < hn_comparison_n_methods(c); i++) {
        sum += hn_run_get_summary(hn_comparison_run(c, i)).cpu_seconds;
    }
    return sum;
}

/// Runs every method to the requested time. The clock advances in whole frames, so the frame length
/// divides that time.
static hn_status run_methods(scene_picture *p, hn_diags *diags) {
    const hn_picture_request *r = p->request;
    hn_status status = check_time(r->time, diags);
    if (status != HN_OK) {
        return status;
    }

    // frame length that divides the time asked for
    const int frames = r->time > 0 ? (int)fmin(MAX_FRAMES, ceil(r->time / 0.05)) : 0;
    hn_comparison_opts opts = hn_comparison_opts_default();
    opts.frame_dt = frames > 0 ? fmax(r->time / frames, 1e-6) : 1;
    opts.duration = fmax(r->time, 1e-6);

    // advance until the time, the stop request or the time limit
    status = hn_comparison_create(p->model, r->methods, r->n_methods, &opts, &p->comparison, diags);
    for (int k = 0; k < frames && status == HN_OK; k++) {
        if (!hn_comparison_work(p->comparison, r->stop, r->user)) {
            return hn_diags_add(diags, HN_ERR_LIMIT, "/time", NULL, "stopped on request");
        }
        if (r->cpu_limit > 0 && cpu_used(p->comparison) > r->cpu_limit) {
            status = hn_diags_add(diags, HN_ERR_LIMIT, "/time", "take a larger step or less time",
                                  "%g s of computing were used up at t = %g s", r->cpu_limit,
                                  (k + 1) * opts.frame_dt);
        }
    }
    return status;
}

static void note_method(scene_picture *p, int i, const hn_sample *sample, int good) {
    const hn_run_summary s = hn_run_get_summary(hn_comparison_run(p->comparison, i));
    char gap[HN_SI_TEXT], t[HN_SI_TEXT];
    hn_si_format(sample->gap, "m", 2, gap);
    hn_si_format(s.t, "s", 3, t);
    if (good) {
        snprintf(p->notes[i], MAX_NOTE, "gap %s", gap);
    } else {
        snprintf(p->notes[i], MAX_NOTE, "stopped at %s: %s", t, hn_status_text(s.status));
    }
}

/// Writes the shortest name that distinguishes the methods: "index-1", "index-1, rk4", or the whole
/// spelling.
static void name_method(scene_picture *p, int i) {
    const hn_method_spec *spec = hn_run_spec(hn_comparison_run(p->comparison, i));
    int alike = 0, twins = 0; // others of the same formulation, of the same integrator too
    for (int k = 0; k < hn_comparison_n_methods(p->comparison); k++) {
        const hn_method_spec *other = hn_run_spec(hn_comparison_run(p->comparison, k));
        if (k != i && other->formulation == spec->formulation) {
            alike++;
            twins += other->stepper == spec->stepper;
        }
    }
    if (twins > 0) {
        hn_method_format(spec, p->names[i]);
    } else {
        snprintf(p->names[i], HN_SPEC_MAX, "%s%s%s", spec->formulation->short_name,
                 alike ? ", " : "", alike ? spec->stepper->name : "");
    }
}

/// The pose each method reached; the first method is the selected one.
static void gather_poses(scene_picture *p, hn_status *ended) {
    const int n = hn_comparison_n_methods(p->comparison);
    const size_t width = 3 * (size_t)hn_system_get_info(hn_model_system(p->model)).n_points;
    for (int i = 0; i < n; i++) {
        hn_sample sample = {0};
        const int good = hn_comparison_sample(p->comparison, i, &sample);
        const hn_run *run = hn_comparison_run(p->comparison, i);
        hn_snapshot_pose *pose = &p->poses[i];

        // a method without a sample has a pose without points
        if (sample.points) {
            memcpy(p->points + (size_t)i * width, sample.points, width * sizeof(double));
            pose->points = p->points + (size_t)i * width;
        }

        // legend entry
        note_method(p, i, &sample, good);
        name_method(p, i);
        pose->name = p->names[i];
        pose->note = p->notes[i];
        pose->slot = hn_comparison_slot(p->comparison, i);
        pose->selected = i == 0;

        // the first failure is reported
        if (!good && *ended == HN_OK) {
            *ended = hn_run_get_summary(run).status;
        }
    }
    p->n_poses = n;
}

static hn_status gather_given_pose(scene_picture *p, hn_diags *diags) {
    const hn_system_info info = hn_system_get_info(hn_model_system(p->model));
    double *q = hn_arena_doubles(p->arena, (size_t)info.nq + 1);
    double *v = hn_arena_doubles(p->arena, (size_t)info.nv + 1);
    if (!q || !v) {
        return HN_ERR_MEMORY;
    }
    hn_status status =
        hn_model_state(p->model, p->request->entries, p->request->n_entries, q, v, diags);
    HN_THEN(status, hn_model_points(p->model, q, p->points));
    p->poses[0] = (hn_snapshot_pose){.points = p->points, .name = "this pose", .selected = 1};
    p->n_poses = 1;
    return status;
}

/// Fits the view to the whole motion, so that it does not change in a series of pictures. A given
/// pose may lie outside the motion, so its view is not fitted to it.
static hn_status choose_view(scene_picture *p, hn_diags *diags) {
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
    p->opts.time = p->request->methods ? p->request->time : (double)NAN;
    return HN_OK;
}

static hn_status add_diag(hn_diags *diags, hn_status status, const hn_diag *d) {
    return status == HN_OK ? HN_OK
                           : hn_diags_add(diags, status, d->pointer, d->hint, "%s", d->message);
}

static hn_status paint(const scene_picture *p, hn_strbuf *png, hn_diags *diags) {
    hn_canvas *canvas = NULL;
    hn_diag diag = {0};
    const int width = p->request->width ? p->request->width : DEFAULT_WIDTH;
    const int height = p->request->height ? p->request->height : DEFAULT_HEIGHT;
    const hn_drawing drawing = hn_system_drawing(hn_model_system(p->model));
    hn_status status = hn_canvas_create(width, height, p->request->theme, &canvas, &diag);
    HN_THEN(status, hn_snapshot_draw(canvas, &drawing, p->poses, p->n_poses, &p->opts, &diag));
    HN_THEN(status, hn_canvas_png(canvas, png, &diag));
    hn_canvas_free(canvas);
    return add_diag(diags, status, &diag);
}

static hn_status describe_picture(hn_strbuf *b, const scene_picture *p, hn_diags *diags) {
    const int width = p->request->width ? p->request->width : DEFAULT_WIDTH;
    const int height = p->request->height ? p->request->height : DEFAULT_HEIGHT;
    const hn_drawing drawing = hn_system_drawing(hn_model_system(p->model));
    hn_diag diag = {0};

    // what was asked for
    hn_json_object(b);
    hn_json_put_string(b, "scene", hn_model_scene(p->model)->id);
    hn_json_put_int(b, "width", width);
    hn_json_put_int(b, "height", height);
    if (p->comparison) {
        hn_json_put_number(b, "time", p->request->time);
        hn_json_key(b, "methods");
        hn_comparison_summary_json(b, p->comparison);
    }

    // what is drawn, element by element
    hn_json_key(b, "picture");
    const hn_status status =
        hn_snapshot_describe(b, width, height, &drawing, p->poses, p->n_poses, &p->opts, &diag);
    hn_json_end_object(b);
    return add_diag(diags, status, &diag);
}

hn_status hn_model_picture(hn_strbuf *png, hn_strbuf *describe, const hn_model *model,
                           const hn_picture_request *request, hn_status *ended, hn_diags *diags) {
    scene_picture p = {.model = model, .request = request, .arena = hn_arena_create(0)};
    const int n_points = hn_system_get_info(hn_model_system(model)).n_points;
    hn_status run_status = HN_OK;
    p.points = p.arena
                   ? hn_arena_doubles(p.arena, 3 * (size_t)n_points * HN_COMPARISON_MAX_METHODS + 1)
                   : NULL;

    // poses: reached by methods, or given
    hn_status status = p.points ? HN_OK : HN_ERR_MEMORY;
    if (status == HN_OK && request->methods) {
        status = run_methods(&p, diags);
        if (status == HN_OK) {
            gather_poses(&p, &run_status);
        }
    } else if (status == HN_OK) {
        status = gather_given_pose(&p, diags);
    }
    HN_THEN(status, choose_view(&p, diags));
    HN_THEN(status, paint(&p, png, diags));
    if (status == HN_OK && describe) {
        status = describe_picture(describe, &p, diags);
    }
    if (ended) {
        *ended = run_status;
    }
    hn_comparison_free(p.comparison);
    hn_arena_free(p.arena);
    return status;
}
