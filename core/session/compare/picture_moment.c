// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/picture_moment.h"

#include "base/units.h"
#include "dynamics/compile/coordinates.h"
#include "session/compare/picture_angles.h"
#include "session/model/envelope.h"
#include "session/model/reactions_json.h"
#include "session/model/run_time.h"
#include "session/model/state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_FRAMES = 6000, FORCES_NAMED = 6 };
static const double FRAME = 0.05, TRACE_FRAME = 0.01; // [s] at most, without and with traces
static const double SMALLEST_FORCE = 1e-6;            // of the largest: a smaller one is no arrow
static const double SAME_GAP = 0.01;                  // relative: two digits are shown
static const double ROUNDING = 1e-12; // [m] a gap below it has other digits wherever it is computed

static double cpu_used(const hn_comparison *c) {
    double sum = 0;
    for (int i = 0; i < hn_comparison_n_methods(c); i++) {
        const hn_run_summary s = hn_run_get_summary(hn_comparison_run(c, i));
        sum += s.cpu_seconds - s.cost.elsewhere;
    }
    return sum;
}

/// A copy that lives as long as the moment; NULL where memory is out.
static const char *keep_text(hn_picture_moment *p, const char *text) {
    const size_t n = text ? strlen(text) + 1 : 0;
    char *copy = text ? hn_arena_get(p->arena, n) : NULL;
    return copy ? memcpy(copy, text, n) : NULL;
}

// ---- traces ----

static int find_point(const hn_drawing *d, const char *label) {
    for (int i = 0; i < d->n_points; i++) {
        if (d->labels[i] && strcmp(d->labels[i], label) == 0) {
            return i;
        }
    }
    return -1;
}

/// The name of a path: that of its point, or "a point on" its body.
static void name_trace(hn_picture_moment *p, const char *label, int body) {
    const hn_scene *scene = hn_model_scene(p->model);
    char text[HN_SPEC_MAX];
    const char *of = body >= 0 && body < scene->n_bodies ? scene->bodies[body].name : "the ground";
    snprintf(text, sizeof text, "a point on %.80s", of);
    p->trace_names[p->n_traces] = label ? label : keep_text(p, text);
}

/// The points that leave a trace: those of the scene, then those asked for.
static hn_status choose_traces(hn_picture_moment *p, hn_diags *diags) {
    const hn_drawing d = hn_system_drawing(hn_model_system(p->model));
    for (int i = 0; i < d.n_shapes && p->n_traces < HN_PICTURE_TRACES; i++) {
        if (d.shapes[i].kind == HN_SHAPE_TRACE) {
            name_trace(p, d.labels[d.shapes[i].p], d.shapes[i].body);
            p->trace_points[p->n_traces++] = d.shapes[i].p;
        }
    }
    for (int i = 0; i < p->request->n_traces && p->n_traces < HN_PICTURE_TRACES; i++) {
        const int point = find_point(&d, p->request->traces[i]);
        if (point < 0) {
            hn_strbuf names;
            hn_strbuf_init(&names);
            for (int k = 0; k < d.n_points; k++) {
                hn_strbuf_add(&names, d.labels[k] ? " " : "");
                hn_strbuf_add(&names, d.labels[k] ? d.labels[k] : "");
            }
            const hn_status status =
                hn_diags_add(diags, HN_ERR_INPUT, "/trace", NULL,
                             "the drawing has no point '%.40s'; its points are:%.200s",
                             p->request->traces[i], hn_strbuf_text(&names));
            hn_strbuf_reset(&names);
            return status;
        }
        bool is_traced = false; // by the scene, or asked for twice
        for (int k = 0; k < p->n_traces; k++) {
            is_traced = is_traced || p->trace_points[k] == point ||
                        strcmp(p->trace_names[k], d.labels[point]) == 0;
        }
        if (is_traced) {
            continue;
        }
        p->trace_names[p->n_traces] = d.labels[point];
        p->trace_points[p->n_traces++] = point;
    }
    return HN_OK;
}

/// The places of the traced points at this frame. Each point has a line of its own, which ends in a
/// NaN; a method that has failed goes no further.
static void record_traces(hn_picture_moment *p, double *const *lines, int frame, int frames) {
    for (int i = 0; i < hn_comparison_n_methods(p->comparison); i++) {
        hn_sample sample = {0};
        const bool good = hn_comparison_sample(p->comparison, i, &sample);
        for (int k = 0; k < p->n_traces; k++) {
            double *at = lines[i] + 3 * ((size_t)k * (size_t)(frames + 2) + (size_t)frame);
            for (int j = 0; j < 3; j++) {
                at[j] =
                    good && sample.points ? sample.points[3 * p->trace_points[k] + j] : (double)NAN;
                at[j + 3] = (double)NAN; // until the next frame is there
            }
        }
    }
}

// ---- running ----

/// Room for the lines of all methods.
static hn_status make_lines(hn_picture_moment *p, int frames, double **lines) {
    const size_t n = (size_t)p->n_traces * (size_t)(frames + 2);
    for (int i = 0; i < p->request->n_methods && n > 0; i++) {
        lines[i] = hn_arena_doubles(p->arena, 3 * n);
        if (!lines[i]) {
            return HN_ERR_MEMORY;
        }
        for (size_t k = 0; k < 3 * n; k++) {
            lines[i][k] = (double)NAN;
        }
        p->poses[i].trace = lines[i];
        p->poses[i].n_trace = (int)n;
    }
    return HN_OK;
}

/// Runs every method to the requested time. The clock advances in whole frames, so the frame length
/// divides that time.
static hn_status run_methods(hn_picture_moment *p, hn_diags *diags) {
    const hn_picture_request *r = p->request;
    double *lines[HN_COMPARISON_MAX_METHODS] = {NULL};
    HN_TRY(hn_run_time_check(p->time, true, "time", "/time", diags));

    // frame length that divides the time asked for
    const double longest = p->n_traces ? TRACE_FRAME : FRAME;
    const int frames = p->time > 0 ? (int)fmin(MAX_FRAMES, ceil(p->time / longest)) : 0;
    hn_comparison_opts opts = hn_comparison_opts_default();
    opts.frame_dt = frames > 0 ? fmax(p->time / frames, 1e-6) : 1;
    opts.duration = fmax(p->time, 1e-6);

    // advance until the time, the stop request or the time limit
    hn_status status =
        hn_comparison_create(p->model, r->methods, r->n_methods, &opts, &p->comparison, diags);
    HN_THEN(status, make_lines(p, frames, lines));
    if (status == HN_OK) {
        record_traces(p, lines, 0, frames);
    }
    for (int k = 0; k < frames && status == HN_OK; k++) {
        if (!hn_comparison_work(p->comparison, r->stop, r->user)) {
            return hn_diags_add(diags, HN_ERR_LIMIT, "/time", NULL, "stopped on request");
        }
        record_traces(p, lines, k + 1, frames);
        if (r->cpu_limit > 0 && cpu_used(p->comparison) > r->cpu_limit) {
            status = hn_diags_add(diags, HN_ERR_LIMIT, "/time", "take a larger step or less time",
                                  "the limit of %g s of computing was reached at t = %g s",
                                  r->cpu_limit, (k + 1) * opts.frame_dt);
        }
    }
    return status;
}

/// The reason without the time that it may begin with: the legend has said it.
static const char *without_time(const char *reason) {
    const char *after = strstr(reason, " s ");
    return strncmp(reason, "at t = ", 7) == 0 && after ? after + 3 : reason;
}

/// Why the method has ended early.
static const char *reason_of(const hn_picture_moment *p, int i, const hn_run_summary *s) {
    return hn_comparison_slowness(p->comparison, i) > 0 ? "it was slower than it may be"
           : s->reason[0]                               ? without_time(s->reason)
                                                        : hn_status_text(s->status);
}

/// Returns whether the gap, a norm over all constraints, is not the one that the drawing shows at a
/// joint.
static bool is_over_all(const hn_picture_moment *p, const hn_sample *sample) {
    const hn_drawing d = hn_system_drawing(hn_model_system(p->model));
    double widest = 0;
    for (int k = 0; k < d.n_tears && sample->points; k++) {
        const double *a = sample->points + 3 * d.tears[k][0];
        const double *b = sample->points + 3 * d.tears[k][1];
        widest = fmax(widest, hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]));
    }
    return widest > ROUNDING && fabs(sample->gap - widest) > SAME_GAP * widest;
}

static void note_method(hn_picture_moment *p, int i, const hn_sample *sample, int good) {
    const hn_run_summary s = hn_run_get_summary(hn_comparison_run(p->comparison, i));
    char gap[HN_SI_TEXT], t[HN_SI_TEXT];
    hn_si_format(sample->gap, "m", 2, gap);
    hn_si_format(s.t, "s", 3, t);
    p->reached[i] = good ? p->time : s.t;
    if (good && hn_system_get_info(hn_model_system(p->model)).nc == 0) {
        snprintf(p->notes[i], HN_PICTURE_NOTE, "no constraints");
    } else if (good) {
        snprintf(p->notes[i], HN_PICTURE_NOTE, "gap %s%s", gap,
                 is_over_all(p, sample) ? " over all constraints" : "");
    } else {
        snprintf(p->notes[i], HN_PICTURE_NOTE, "stopped at %s: %.170s", t, reason_of(p, i, &s));
    }
}

/// Writes the shortest name that distinguishes the methods: "index-1", "index-1, rk4", or the whole
/// spelling.
static void name_method(hn_picture_moment *p, int i) {
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
static void gather_poses(hn_picture_moment *p, hn_status *ended) {
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
            if (p->request->ending) {
                hn_strbuf_printf(p->request->ending, "%s %s", pose->name, pose->note);
            }
        }
    }
    p->n_poses = n;
}

/// The points of one pose that was given.
static hn_status place_pose(hn_picture_moment *p, const hn_state_entry *entries, int n,
                            double *points, hn_diags *diags) {
    const hn_system_info info = hn_system_get_info(hn_model_system(p->model));
    double *q = hn_arena_doubles(p->arena, (size_t)info.nq + 1);
    double *v = hn_arena_doubles(p->arena, (size_t)info.nv + 1);
    if (!q || !v) {
        return HN_ERR_MEMORY;
    }
    hn_status status = hn_model_state(p->model, entries, n, q, v, diags);
    HN_THEN(status, hn_model_points(p->model, q, points));
    return status;
}

static hn_status gather_given_pose(hn_picture_moment *p, hn_diags *diags) {
    const hn_picture_request *r = p->request;
    double *other = p->points + 3 * (size_t)hn_system_get_info(hn_model_system(p->model)).n_points;
    hn_status status = place_pose(p, r->entries, r->n_entries, p->points, diags);
    p->poses[0] = (hn_snapshot_pose){.points = p->points,
                                     .name = "this pose",
                                     .selected = 1,
                                     .trace = r->lines,
                                     .n_trace = r->n_lines};
    p->n_poses = 1;
    if (status == HN_OK && r->expected) {
        status = place_pose(p, r->expected, r->n_expected, other, diags);
        p->poses[0].name = "given";
        p->poses[1] =
            (hn_snapshot_pose){.points = other, .name = "expected", .slot = HN_LOOK_REFERENCE};
        p->n_poses = 2;
    }
    return status;
}

// ---- angles ----

/// The angles at the state that the first method has reached, or at the pose that was given.
static hn_status gather_angles(hn_picture_moment *p, hn_diags *diags) {
    const hn_system *sys = hn_model_system(p->model);
    const hn_system_info info = hn_system_get_info(sys);
    const size_t n = (size_t)hn_model_scene(p->model)->n_coordinates;
    double *q = hn_arena_doubles(p->arena, (size_t)info.nq + 1);
    double *v = hn_arena_doubles(p->arena, (size_t)info.nv + 1);
    double *user = hn_arena_doubles(p->arena, n + 1);
    hn_sample sample = {0};
    p->angles = hn_arena_get(p->arena, (n + 1) * sizeof *p->angles);
    if (!q || !v || !user || !p->angles) {
        return HN_ERR_MEMORY;
    }
    if (p->comparison) {
        hn_comparison_sample(p->comparison, 0, &sample);
    } else {
        const hn_picture_request *r = p->request;
        HN_TRY(hn_model_state(p->model, r->entries, r->n_entries, q, v, diags));
        hn_system_to_user(sys, q, user);
        sample.q = user;
    }
    return sample.q ? hn_picture_angles(p->model, &sample, p->angles, &p->n_angles) : HN_OK;
}

// ---- forces ----

/// Says in the legend at which joint each arrow acts, and on which body: "forces: A on coupler";
/// and where redundant constraints leave them undetermined. `drawn` are the indices of the arrows.
static void note_forces(hn_picture_moment *p, const hn_reaction_writer *w, const int *drawn) {
    char *note = p->notes[0];
    double force[3], place[3];
    size_t used = strlen(note);
    bool determined = true;
    for (int i = 0; i < p->n_loads; i++) {
        determined = determined && hn_reaction_writer_is_determined(w, drawn[i]);
    }
    const char *mark = determined ? "" : ", one set of many";
    const size_t gap = used;
    for (int i = 0; i < p->n_loads && used < HN_PICTURE_NOTE; i++) {
        const char *name = hn_reaction_writer_force(w, drawn[i], force, place);
        used += (size_t)snprintf(note + used, HN_PICTURE_NOTE - used, "%s%s%s %s on %s",
                                 i ? "," : "; forces", i ? "" : mark, i ? "" : ":", name,
                                 hn_reaction_writer_body(w, drawn[i]));
    }

    // many arrows, or names too long for the legend
    if (p->n_loads > FORCES_NAMED || used >= HN_PICTURE_NOTE) {
        snprintf(note + gap, HN_PICTURE_NOTE - gap,
                 "; arrows: forces%s, each on the second body of its joint", mark);
    }
}

/// Adds an arrow for each force of the writer but those that are zero to rounding. `drawn` has room
/// for all of them.
static void add_loads(hn_picture_moment *p, const hn_reaction_writer *w, int *drawn) {
    double largest = 0, size;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < hn_reaction_writer_count(w); i++) {
            hn_snapshot_load load = {.point = -1, .unit = "N"};
            load.name = hn_reaction_writer_force(w, i, load.force, load.place);
            size = hypot(hypot(load.force[0], load.force[1]), load.force[2]);
            largest = fmax(largest, size);
            if (pass == 1 && size > SMALLEST_FORCE * largest) {
                drawn[p->n_loads] = i;
                load.name = keep_text(p, load.name);
                p->loads[p->n_loads++] = load;
            }
        }
    }
    const size_t used = strlen(p->notes[0]);
    if (p->n_loads > 0) {
        note_forces(p, w, drawn);
    } else {
        snprintf(p->notes[0] + used, HN_PICTURE_NOTE - used, "; no force at any joint");
    }
}

/// The forces in the joints at the state that the first method has reached; where they are not
/// determined, the legend says so.
static hn_status eval_forces(hn_picture_moment *p, hn_reaction_writer *w, double *state) {
    hn_sample sample = {0};
    const hn_system *sys = hn_model_system(p->model);
    const int nq = hn_system_get_info(sys).nq;
    int *drawn = hn_arena_get(p->arena, ((size_t)hn_reaction_writer_count(w) + 1) * sizeof *drawn);
    if (!drawn) {
        return HN_ERR_MEMORY;
    }
    hn_comparison_sample(p->comparison, 0, &sample);
    if (!sample.q) {
        return HN_OK; // the legend says that the method has ended
    }
    hn_system_from_user(sys, sample.q, state);
    hn_system_rates_from_user(sys, sample.v, state + nq);
    const hn_status status = hn_reaction_writer_eval(w, sample.t, state, state + nq);
    if (status == HN_OK) {
        add_loads(p, w, drawn);
    } else if (status != HN_ERR_MEMORY) {
        const size_t used = strlen(p->notes[0]);
        snprintf(p->notes[0] + used, HN_PICTURE_NOTE - used, "; no forces: %s",
                 hn_status_text(status));
    }
    return status == HN_ERR_MEMORY ? status : HN_OK;
}

static hn_status gather_forces(hn_picture_moment *p, hn_diags *diags) {
    hn_reaction_writer *w = NULL;
    const hn_system_info info = hn_system_get_info(hn_model_system(p->model));
    double *state = hn_arena_doubles(p->arena, (size_t)info.nq + (size_t)info.nv + 1);
    if (!p->comparison) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/forces", "name a method",
                            "forces can be drawn only after a run, and no method is named");
    }
    HN_TRY(state ? HN_OK : HN_ERR_MEMORY);
    HN_TRY(hn_reaction_writer_create(p->model, p->arena, &w, diags));
    const size_t n = (size_t)hn_reaction_writer_count(w);
    p->loads = hn_arena_get(p->arena, (n + 1) * sizeof *p->loads);
    const hn_status status = p->loads ? eval_forces(p, w, state) : HN_ERR_MEMORY;
    hn_reaction_writer_free(w);
    return status;
}

// ---- the whole ----

hn_status hn_picture_moment_make(hn_picture_moment *p, const hn_model *model,
                                 const hn_picture_request *request, double time, hn_status *ended,
                                 hn_diags *diags) {
    *p = (hn_picture_moment){
        .model = model, .request = request, .time = time, .arena = hn_arena_create(0)};
    const size_t n_points = (size_t)hn_system_get_info(hn_model_system(model)).n_points;
    p->points =
        p->arena ? hn_arena_doubles(p->arena, 3 * n_points * HN_COMPARISON_MAX_METHODS + 1) : NULL;
    hn_status status = p->points ? HN_OK : HN_ERR_MEMORY;
    HN_THEN(status, choose_traces(p, diags));

    // poses: reached by methods, or given
    if (status == HN_OK && request->methods) {
        status = run_methods(p, diags);
        if (status == HN_OK) {
            gather_poses(p, ended);
        }
    } else if (status == HN_OK) {
        status = gather_given_pose(p, diags);
    }
    HN_THEN(status, request->dimensions ? gather_angles(p, diags) : HN_OK);
    HN_THEN(status, request->forces ? gather_forces(p, diags) : HN_OK);
    return status;
}

void hn_picture_moment_reset(hn_picture_moment *p) {
    hn_comparison_free(p->comparison);
    hn_arena_free(p->arena);
}
