// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/model_json.h"

#include "dynamics/compile/coordinates.h"
#include "session/model/caption.h"
#include "session/model/envelope.h"
#include "session/model/model.h"

static void put_params(hn_strbuf *b, const hn_scene *scene) {
    hn_json_key(b, "parameters");
    hn_json_array(b);
    for (int i = 0; i < scene->n_params; i++) {
        const hn_param *p = &scene->params[i];
        hn_json_object(b);
        hn_json_put_string(b, "name", p->name);
        hn_json_put_string(b, "unit", p->unit);
        hn_json_put_string(b, "about", p->about);
        hn_json_put_number(b, "value", p->value);
        hn_json_put_number(b, "initial", p->initial);
        hn_json_put_number(b, "min", p->min);
        hn_json_put_number(b, "max", p->max);
        hn_json_put_bool(b, "integer", p->integer);
        hn_json_put_bool(b, "beyond", p->beyond);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_scene_head(hn_strbuf *b, const hn_model *model) {
    const hn_scene *scene = hn_model_scene(model);
    char caption[160];
    hn_model_caption(model, caption, sizeof caption);
    hn_json_put_string(b, "id", scene->id);
    hn_json_put_string(b, "title", scene->title);
    hn_json_put_string(b, "about", scene->about);
    hn_json_put_string(b, "look_for", scene->look_for);
    hn_json_put_string(b, "exhibit", scene->exhibit);
    hn_json_put_string(b, "kind",
                       scene->is_lagrangian  ? "Lagrangian"
                       : scene->has_formulas ? "bodies, joints and formulas"
                                             : "bodies and joints");
    hn_json_put_string(b, "caption", caption);
    hn_json_put_int(b, "dof", hn_model_assembly(model)->freedoms);
    put_params(b, scene);
}

static const char *kind_name(hn_unit_kind kind) {
    return kind == HN_ANGLE ? "angle" : kind == HN_LENGTH ? "length" : "other";
}

/// Writes what a script needs before it runs the scene: suggested times, the length that errors are
/// measured by, kinds of coordinates.
static void put_measures(hn_strbuf *b, const hn_model *model) {
    const hn_scene *scene = hn_model_scene(model);
    const hn_system *sys = hn_model_system(model);
    hn_json_put_number(b, "duration", scene->duration);
    hn_json_put_number(b, "step", scene->step);
    hn_json_put_number(b, "length", hn_system_length(sys));
    hn_json_key(b, "coordinate_kinds");
    hn_json_array(b);
    for (int i = 0; i < hn_system_get_info(sys).n_user; i++) {
        hn_json_string(b, kind_name(scene->coordinates[hn_system_user_coordinate(sys, i)].kind));
    }
    hn_json_end_array(b);
}

static void put_one_scene(hn_strbuf *b, const hn_library *lib, const char *id) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_model_source source = {.name = id, .allow_open = 1};
    hn_json_object(b);
    if (hn_model_load(lib, &source, &model, &diags) == HN_OK) {
        put_scene_head(b, model);
        put_measures(b, model);
    } else {
        hn_json_put_string(b, "id", id);
        hn_json_key(b, "errors");
        hn_json_diags(b, &diags);
    }
    hn_json_end_object(b);
    hn_model_free(model);
}

void hn_scenes_json(hn_strbuf *b, const hn_library *lib) {
    hn_json_object(b);
    hn_json_key(b, "scenes");
    hn_json_array(b);
    for (int i = 0; i < hn_library_n_scenes(lib); i++) {
        put_one_scene(b, lib, hn_library_scene_id(lib, i));
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

/// Coordinates that carry freedom, with the assembled start in user coordinates.
static void put_coordinates(hn_strbuf *b, const hn_model *model, const double *uq,
                            const double *uv) {
    const hn_scene *scene = hn_model_scene(model);
    int n = hn_system_get_info(hn_model_system(model)).n_user;
    hn_json_key(b, "coordinates");
    hn_json_array(b);
    for (int i = 0; i < n; i++) {
        const hn_coordinate *c =
            &scene->coordinates[hn_system_user_coordinate(hn_model_system(model), i)];
        hn_json_object(b);
        hn_json_put_string(b, "name", c->name);
        hn_json_put_string(b, "rate", c->rate);
        hn_json_put_string(b, "kind", kind_name(c->kind));
        hn_json_put_string(b, "joint", c->joint >= 0 ? scene->joints[c->joint].name : NULL);
        hn_json_put_bool(b, "actuated", c->actuated);
        hn_json_put_bool(b, "pinned", c->q0_pinned);
        hn_json_put_number(b, "value", uq[i]);
        hn_json_put_number(b, "rate_value", uv[i]);
        hn_json_put_string(b, "start_parameter", c->q0_param);
        hn_json_put_string(b, "rate_parameter", c->v0_param);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_vector(hn_strbuf *b, const char *key, const hn_quantity at[3]) {
    const double place[3] = {at[0].value, at[1].value, at[2].value};
    hn_json_put_numbers(b, key, place, 3);
}

/// One joint: where it sits in both bodies and along which axes, as hn_joint says.
static void put_joint(hn_strbuf *b, const hn_joint *joint) {
    hn_json_object(b);
    hn_json_put_string(b, "name", joint->name);
    hn_json_put_string(b, "type", hn_joint_type_name(joint->type));
    hn_json_put_int(b, "parent", joint->parent);
    hn_json_put_int(b, "child", joint->child);
    put_vector(b, "parent_at", joint->parent_at);
    put_vector(b, "child_at", joint->child_at);
    hn_json_put_numbers(b, "parent_axis", joint->parent_axis, 3);
    hn_json_put_numbers(b, "child_axis", joint->child_axis, 3);
    hn_json_put_numbers(b, "parent_ref", joint->parent_ref, 3);
    hn_json_put_numbers(b, "child_ref", joint->child_ref, 3);
    hn_json_end_object(b);
}

/// Bodies and joints with numbers: with the coordinates they give the frame of every body.
static void put_bodies_and_joints(hn_strbuf *b, const hn_scene *scene) {
    hn_json_key(b, "bodies");
    hn_json_array(b);
    for (int i = 0; i < scene->n_bodies; i++) {
        hn_json_object(b);
        hn_json_put_string(b, "name", scene->bodies[i].name);
        put_vector(b, "com", scene->bodies[i].com);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);

    // a joint that only carries a coordinate of formulas is not drawn
    hn_json_key(b, "joints");
    hn_json_array(b);
    for (int i = 0; i < scene->n_joints; i++) {
        if (!scene->joints[i].is_formal) {
            put_joint(b, &scene->joints[i]);
        }
    }
    hn_json_end_array(b);
}

static void put_rows(hn_strbuf *b, const hn_system *sys) {
    hn_json_key(b, "rows");
    hn_json_array(b);
    for (int i = 0; i < hn_system_get_info(sys).nc; i++) {
        hn_json_object(b);
        hn_json_put_string(b, "name", hn_system_row_name(sys, i));
        hn_json_put_string(b, "loop", hn_system_loop_name(sys, hn_system_row_loop(sys, i)));
        hn_json_put_string(b, "unit", hn_system_row_is_length(sys, i) ? "m" : "1");
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_sizes(hn_strbuf *b, const hn_model *model) {
    hn_system_info info = hn_system_get_info(hn_model_system(model));
    const hn_assembly *a = hn_model_assembly(model);
    hn_json_put_int(b, "n", info.nv);
    hn_json_put_int(b, "m", info.nc);
    hn_json_put_int(b, "rank", a->rank);
    hn_json_put_int(b, "redundant", a->redundant);
    hn_json_put_int(b, "loops", info.n_loops);
    hn_json_put_number(b, "length", hn_system_length(hn_model_system(model)));
}

void hn_model_closed_put(hn_strbuf *b, const hn_model *model) {
    const hn_diag *open = hn_model_why_open(model);
    hn_json_put_bool(b, "ok", hn_model_assembly(model)->ok);
    if (open) {
        hn_json_put_string(b, "reason", open->message);
        hn_json_put_string(b, "hint", open->hint);
    }
}

static void put_assembly_fields(hn_strbuf *b, const hn_model *model) {
    const hn_assembly *a = hn_model_assembly(model);
    hn_model_closed_put(b, model);
    hn_json_put_string(b, "route", a->route);
    hn_json_put_int(b, "iterations", a->iterations);
    hn_json_put_number(b, "gap_before", a->gap_before);
    hn_json_put_number(b, "gap", a->gap);
    hn_json_put_number(b, "moved", a->moved);
    hn_json_put_number(b, "velocity_gap_before", a->velocity_gap_before);
    hn_json_put_number(b, "velocity_gap", a->velocity_gap);
    hn_json_put_int(b, "rank", a->rank);
    hn_json_put_int(b, "dof", a->freedoms);
    hn_json_put_int(b, "redundant", a->redundant);
    hn_json_put_number(b, "sigma_min", a->sigma_min);
    hn_json_put_number(b, "sigma_max", a->sigma_max);
    hn_json_put_int(b, "mode", a->mode);
    hn_json_put_string(b, "mode_name", a->mode_name);
    hn_json_put_number(b, "energy", a->energy);
}

/// Indices of the points that stand still whatever moves.
static void put_ground_points(hn_strbuf *b, const hn_model *model, hn_arena *arena) {
    const int n = hn_system_get_info(hn_model_system(model)).n_points;
    char *is_ground = hn_arena_get(arena, (size_t)n + 1);
    if (!is_ground || hn_model_ground_points(model, is_ground) != HN_OK) {
        b->failed = 1;
        return;
    }
    hn_json_key(b, "ground_points");
    hn_json_array(b);
    for (int i = 0; i < n; i++) {
        if (is_ground[i]) {
            hn_json_int(b, i);
        }
    }
    hn_json_end_array(b);
}

/// Places of the drawn points at the start; an empty list for a scene without any.
static void put_start_points(hn_strbuf *b, const hn_model *model, hn_arena *arena) {
    const int n = hn_system_get_info(hn_model_system(model)).n_points;
    double *points = hn_arena_doubles(arena, 3 * (size_t)n + 1);
    if (!points || hn_model_points(model, hn_model_q(model), points) != HN_OK) {
        b->failed = 1;
        return;
    }
    hn_json_put_numbers(b, "points", points, 3 * (size_t)n);
}

/// World points at the start; the box around the motion in the world, and in the view that fits it.
static void put_points(hn_strbuf *b, const hn_model *model) {
    const int n = hn_system_get_info(hn_model_system(model)).n_points;
    hn_arena *arena = hn_arena_create(0);
    double *points = arena ? hn_arena_doubles(arena, 3 * (size_t)n + 1) : NULL;

    // positions at the start
    if (points && hn_model_points(model, hn_model_q(model), points) == HN_OK) {
        hn_envelope e;
        hn_model_envelope(model, NULL, &e);
        b->failed |= hn_graph_failed(hn_system_graph(hn_model_system(model)));
        hn_json_put_numbers(b, "points", points, 3 * (size_t)n);
        put_ground_points(b, model, arena);

        // a scene without points has no view
        if (n > 0) {
            hn_json_put_numbers(b, "envelope", e.box, 4);
            if (e.spatial) {
                hn_json_put_numbers(b, "extremes", e.extremes[0], 3 * HN_ENVELOPE_EXTREMES);
            }
            hn_json_key(b, "view");
            hn_json_object(b);
            hn_json_put_bool(b, "spatial", e.spatial);
            hn_json_put_string(b, "vertical", e.z_up ? "z" : "y");
            hn_json_put_numbers(b, "right", e.look.right, 3);
            hn_json_put_numbers(b, "up", e.look.up, 3);
            hn_json_end_object(b);
        }
    } else {
        b->failed = 1;
    }
    hn_arena_free(arena);
}

/// The start in user coordinates; NULL when memory is out.
static double *user_start(const hn_model *model, hn_arena *arena) {
    const hn_system *sys = hn_model_system(model);
    hn_system_info info = hn_system_get_info(sys);
    double *u = arena ? hn_arena_doubles(arena, 2 * (size_t)info.n_user + 1) : NULL;
    if (u) {
        hn_system_to_user(sys, hn_model_q(model), u);
        hn_system_rates_to_user(sys, hn_model_v(model), u + info.n_user);
    }
    return u;
}

void hn_model_json(hn_strbuf *b, const hn_model *model) {
    const hn_scene *scene = hn_model_scene(model);
    hn_arena *arena = hn_arena_create(0);
    double *u = user_start(model, arena);
    if (!u) {
        hn_arena_free(arena);
        b->failed = 1;
        return;
    }

    // the system: sizes, coordinates, constraint rows
    hn_json_object(b);
    put_scene_head(b, model);
    put_sizes(b, model);
    put_coordinates(b, model, u, u + hn_system_get_info(hn_model_system(model)).n_user);
    put_rows(b, hn_model_system(model));
    put_bodies_and_joints(b, scene);

    // how the start was assembled
    hn_json_key(b, "assembly");
    hn_json_object(b);
    put_assembly_fields(b, model);
    hn_json_end_object(b);

    // shapes, points and the view that fits them
    hn_json_key(b, "drawing");
    hn_drawing_json(b, hn_model_system(model));
    put_points(b, model);

    // suggested runs
    hn_json_key(b, "methods");
    int n_methods;
    const char *const *methods = hn_model_methods(model, &n_methods);
    hn_json_strings(b, methods, (size_t)n_methods);
    hn_json_put_number(b, "duration", scene->duration);
    hn_json_put_number(b, "step", scene->step);
    hn_json_end_object(b);
    hn_arena_free(arena);
}

void hn_model_assembly_json(hn_strbuf *b, const hn_model *model) {
    hn_arena *arena = hn_arena_create(0);
    double *u = user_start(model, arena);
    if (!u) {
        hn_arena_free(arena);
        b->failed = 1;
        return;
    }
    hn_json_object(b);
    hn_json_put_string(b, "scene", hn_model_scene(model)->id);
    put_assembly_fields(b, model);
    put_coordinates(b, model, u, u + hn_system_get_info(hn_model_system(model)).n_user);
    put_start_points(b, model, arena);
    hn_json_end_object(b);
    hn_arena_free(arena);
}
