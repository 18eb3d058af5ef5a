// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/reactions_json.h"

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/reactions/reactions.h"

#include <string.h>

struct hn_reaction_writer {
    const hn_scene *scene;
    hn_accel *accel;
    hn_reactions *reactions;
    hn_wrench *wrenches; ///< joints, then constraints
    /// indices of the wrenches that act at a place: joints of bodies, and constraints on their
    /// points
    int *carrier;
    int n_carriers;
    double *a, *lambda;
    int known; ///< 1: the last state was computed without failure
};

/// Unit of a generalised force, by the kind of its coordinate.
static const char *const EFFORT_UNITS[] = {[HN_ANGLE] = "N m", [HN_LENGTH] = "N", [HN_OTHER] = "J"};

static void list_carriers(hn_reaction_writer *w) {
    const hn_scene *scene = w->scene;
    for (int j = 0; j < scene->n_joints; j++) {
        if (!scene->joints[j].is_formal) {
            w->carrier[w->n_carriers++] = j;
        }
    }
    for (int k = 0; k < scene->n_constraints; k++) {
        if (hn_reactions_has_place(w->reactions, k)) {
            w->carrier[w->n_carriers++] = scene->n_joints + k;
        }
    }
}

hn_status hn_reaction_writer_create(const hn_model *model, hn_arena *arena,
                                    hn_reaction_writer **out, hn_diags *diags) {
    const hn_system *sys = hn_model_system(model);
    const hn_system_info info = hn_system_get_info(sys);
    hn_diag diag = {0};
    *out = NULL;

    // buffers for one state
    hn_reaction_writer *w = hn_arena_get(arena, sizeof *w);
    if (!w) {
        return HN_ERR_MEMORY;
    }
    *w = (hn_reaction_writer){.scene = hn_model_scene(model)};
    const size_t n = (size_t)w->scene->n_joints + (size_t)w->scene->n_constraints + 1;
    w->wrenches = hn_arena_get(arena, n * sizeof *w->wrenches);
    w->carrier = hn_arena_ints(arena, n);
    w->a = hn_arena_doubles(arena, (size_t)info.nv + 1);
    w->lambda = hn_arena_doubles(arena, (size_t)info.nc + 1);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // evaluators of reactions and of accelerations with multipliers
    hn_status status = hn_reactions_create(sys, arena, &w->reactions, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, "/reactions", diag.hint, "%s", diag.message);
    }
    status = hn_accel_create(sys, &(hn_accel_opts){.want_lambda = 1}, arena, &w->accel);
    if (status != HN_OK) {
        hn_reactions_free(w->reactions);
        return status;
    }

    // joints and constraints that have a place
    list_carriers(w);
    *out = w;
    return HN_OK;
}

void hn_reaction_writer_free(hn_reaction_writer *w) {
    if (w) {
        hn_accel_free(w->accel);
        hn_reactions_free(w->reactions);
    }
}

int hn_reaction_writer_count(const hn_reaction_writer *w) {
    return w->n_carriers;
}

int hn_reaction_writer_efforts(const hn_reaction_writer *w) {
    return hn_reactions_effort_count(w->reactions);
}

hn_status hn_reaction_writer_eval(hn_reaction_writer *w, double t, const double *q,
                                  const double *v) {
    hn_status status = hn_accel_eval(w->accel, t, q, v, 0, 0, w->a, w->lambda, NULL);
    HN_THEN(status, hn_reactions_eval(w->reactions, t, q, v, w->a, w->lambda, w->wrenches,
                                      w->wrenches + w->scene->n_joints));
    w->known = status == HN_OK;
    return status;
}

void hn_reaction_writer_rows(const hn_reaction_writer *w, double *force, double *moment,
                             double *effort) {
    for (int i = 0; i < w->n_carriers; i++) {
        const hn_wrench *wrench = &w->wrenches[w->carrier[i]];
        memcpy(force + 3 * i, wrench->force, 3 * sizeof *force);
        memcpy(moment + 3 * i, wrench->moment, 3 * sizeof *moment);
    }
    for (int k = 0; k < hn_reaction_writer_efforts(w); k++) {
        effort[k] = hn_reactions_effort(w->reactions, k).value;
    }
}

static const char *name_of(const hn_reaction_writer *w, int k) {
    const int joint = k < w->scene->n_joints;
    return joint ? w->scene->joints[k].name : w->scene->constraints[k - w->scene->n_joints].name;
}

const char *hn_reaction_writer_force(const hn_reaction_writer *w, int i, double force[3],
                                     double place[3]) {
    const hn_wrench *wrench = &w->wrenches[w->carrier[i]];
    memcpy(force, wrench->force, 3 * sizeof *force);
    memcpy(place, wrench->place, 3 * sizeof *place);
    return name_of(w, w->carrier[i]);
}

bool hn_reaction_writer_is_determined(const hn_reaction_writer *w, int i) {
    return w->wrenches[w->carrier[i]].determined != 0;
}

static const char *body_of(const hn_reaction_writer *w, int k) {
    const int body = w->wrenches[k].body;
    return body < 0 ? "ground" : w->scene->bodies[body].name;
}

const char *hn_reaction_writer_body(const hn_reaction_writer *w, int i) {
    return body_of(w, w->carrier[i]);
}

static void put_wrench(hn_strbuf *b, const hn_reaction_writer *w, int k) {
    const hn_wrench *wrench = &w->wrenches[k];
    const int joint = k < w->scene->n_joints;
    hn_json_object(b);
    hn_json_put_string(b, "name", name_of(w, k));
    hn_json_put_string(b, "kind", joint ? "joint" : "constraint");
    hn_json_put_string(b, "on", body_of(w, k));
    hn_json_put_numbers(b, "force", wrench->force, 3);
    hn_json_put_numbers(b, "moment", wrench->moment, 3);
    hn_json_put_numbers(b, "place", wrench->place, 3);
    if (joint) {
        hn_json_put_numbers(b, "joint_force", wrench->in_joint_force, 3);
        hn_json_put_numbers(b, "joint_moment", wrench->in_joint_moment, 3);
    }
    hn_json_put_bool(b, "determined", wrench->determined);
    hn_json_end_object(b);
}

/// Writes one effort; with_value = 0 leaves out its value.
static void put_effort(hn_strbuf *b, const hn_reaction_writer *w, int k, int with_value) {
    const hn_effort e = hn_reactions_effort(w->reactions, k);
    const hn_coordinate *c = &w->scene->coordinates[e.coordinate];
    hn_json_object(b);
    hn_json_put_string(b, "name", e.name);
    hn_json_put_string(b, "kind", e.row < 0 ? "energies" : "constraint");
    hn_json_put_string(b, "coordinate", c->name);
    hn_json_put_string(b, "unit", EFFORT_UNITS[c->kind]);
    if (with_value) {
        hn_json_put_number(b, "value", e.value);
        hn_json_put_bool(b, "determined", e.determined);
    }
    hn_json_end_object(b);
}

void hn_reaction_writer_put(hn_strbuf *b, const hn_reaction_writer *w) {
    hn_json_key(b, "reactions");
    hn_json_array(b);
    for (int i = 0; i < w->n_carriers && w->known; i++) {
        put_wrench(b, w, w->carrier[i]);
    }
    hn_json_end_array(b);
    hn_json_key(b, "efforts");
    hn_json_array(b);
    for (int k = 0; k < hn_reaction_writer_efforts(w) && w->known; k++) {
        put_effort(b, w, k, 1);
    }
    hn_json_end_array(b);
}

void hn_reaction_writer_names(hn_strbuf *b, const hn_reaction_writer *w) {
    hn_json_key(b, "carriers");
    hn_json_array(b);
    for (int i = 0; i < w->n_carriers; i++) {
        hn_json_string(b, name_of(w, w->carrier[i]));
    }
    hn_json_end_array(b);
    hn_json_key(b, "efforts");
    hn_json_array(b);
    for (int k = 0; k < hn_reaction_writer_efforts(w); k++) {
        put_effort(b, w, k, 0);
    }
    hn_json_end_array(b);
}
