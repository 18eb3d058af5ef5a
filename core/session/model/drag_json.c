// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/drag_json.h"

#include "base/clock.h"
#include "dynamics/assembly/drag.h"
#include "dynamics/assembly/project.h"
#include "dynamics/compile/coordinates.h"
#include "session/model/envelope.h"
#include "session/model/state.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *name, *reason;
} ENDS[] = {
    [HN_DRAG_REACHED] = {"reached", NULL},
    [HN_DRAG_NEAREST] = {"nearest",
                         "no closed configuration near this one is nearer to the target"},
    [HN_DRAG_TIME] = {"time", "the computing time ended on the way; drag on from here"},
    [HN_DRAG_STUCK] =
        {"stuck", "the loops cannot be closed nearer to the target: the configuration is singular"},
};

static const hn_coordinate *user_coordinate(const hn_model *model, int i) {
    return &hn_model_scene(model)
                ->coordinates[hn_system_user_coordinate(hn_model_system(model), i)];
}

// ---- what is asked ----

static hn_status find_coordinate(const hn_model *model, const char *name, int *out,
                                 hn_diags *diags) {
    const int n = hn_system_get_info(hn_model_system(model)).n_user;
    for (*out = 0; *out < n; (*out)++) {
        if (strcmp(user_coordinate(model, *out)->name, name) == 0) {
            return HN_OK;
        }
    }
    return hn_diags_add(diags, HN_ERR_INPUT, "/coordinate",
                        "name a free coordinate; a joint that closes a loop has none",
                        "the scene has no free coordinate '%.80s'", name);
}

static hn_status read_goal(const hn_model *model, const hn_drag_request *r, hn_drag_goal *goal,
                           hn_diags *diags) {
    const int n_points = hn_system_get_info(hn_model_system(model)).n_points;
    *goal = (hn_drag_goal){.point = r->point, .n = r->n_target};
    memcpy(goal->target, r->target, (size_t)r->n_target * sizeof *r->target);
    if (r->coordinate) {
        goal->point = -1;
        HN_TRY(find_coordinate(model, r->coordinate, &goal->coordinate, diags));
    } else if (r->point < 0 || r->point >= n_points) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/point", NULL,
                            "the scene has no point %d; it has %d points, the first is 0", r->point,
                            n_points);
    }
    if (r->coordinate ? r->n_target != 1 : r->n_target < 2) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/target",
                            r->coordinate ? "one number, in the unit of the coordinate"
                                          : "[x, y] or [x, y, z] in metres",
                            "%d numbers were given", r->n_target);
    }
    return HN_OK;
}

// ---- the way ----

/// Rates that are consistent with q, as near to v as the masses say.
static hn_status close_rates(const hn_model *model, const double *q, double *v) {
    hn_arena *arena = hn_arena_create(0);
    hn_projector *p = NULL;
    hn_status status = arena
                           ? hn_projector_create(hn_model_system(model), HN_WEIGHT_MASS, arena, &p)
                           : HN_ERR_MEMORY;
    HN_THEN(status, hn_project_velocity(p, 0, q, v, NULL));
    hn_projector_free(p);
    hn_arena_free(arena);
    return status;
}

static void put_state(hn_strbuf *b, const hn_model *model, const double *q, const double *v,
                      double *user) {
    const hn_system *sys = hn_model_system(model);
    const int n = hn_system_get_info(sys).n_user;
    hn_json_key(b, "state");
    hn_json_object(b);
    hn_system_to_user(sys, q, user);
    for (int i = 0; i < n; i++) {
        hn_json_put_number(b, user_coordinate(model, i)->name, user[i]);
    }
    hn_system_rates_to_user(sys, v, user);
    for (int i = 0; i < n; i++) {
        hn_json_put_number(b, user_coordinate(model, i)->rate, user[i]);
    }
    hn_json_end_object(b);
}

static void put_drag(hn_strbuf *b, const hn_model *model, const hn_drag_info *info,
                     double cpu_seconds) {
    hn_json_put_string(b, "scene", hn_model_scene(model)->id);
    hn_json_put_bool(b, "reached", info->end == HN_DRAG_REACHED);
    hn_json_put_string(b, "end", ENDS[info->end].name);
    hn_json_put_string(b, "reason", ENDS[info->end].reason);
    hn_json_put_number(b, "distance_before", info->distance_before);
    hn_json_put_number(b, "distance", info->distance);
    hn_json_put_number(b, "gap", info->gap);
    hn_json_put_int(b, "steps", info->steps);
    hn_json_put_number(b, "cpu_seconds", cpu_seconds);
}

/// Drags from the state that the request gives, in memory of the arena.
static hn_status drag(hn_strbuf *b, const hn_model *model, const hn_drag_request *r,
                      hn_arena *arena, hn_diags *diags) {
    const hn_system_info size = hn_system_get_info(hn_model_system(model));
    double *q = hn_arena_doubles(arena, (size_t)size.nq + 1),
           *v = hn_arena_doubles(arena, (size_t)size.nv + 1),
           *user = hn_arena_doubles(arena, (size_t)size.nv + 1),
           *points = hn_arena_doubles(arena, 3 * (size_t)size.n_points + 1);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // from where, to where
    hn_drag_goal goal;
    hn_drag_info info;
    HN_TRY(read_goal(model, r, &goal, diags));
    HN_TRY(hn_model_state(model, r->from, r->n_from, q, v, diags));
    const double start = hn_clock_thread();
    hn_status status = hn_drag(hn_model_system(model), 0, &goal, r->seconds, q, &info);
    HN_THEN(status, close_rates(model, q, v));
    if (status != HN_OK) {
        return hn_diags_add(diags, status, "/state", "drag from a state with closed loops",
                            "the loops cannot be closed near this state: %s",
                            hn_status_text(status));
    }

    // the document
    HN_TRY(hn_model_points(model, q, points));
    hn_json_object(b);
    put_drag(b, model, &info, hn_clock_thread() - start);
    put_state(b, model, q, v, user);
    hn_json_put_numbers(b, "points", points, 3 * (size_t)size.n_points);
    hn_json_end_object(b);
    return HN_OK;
}

hn_status hn_model_drag_json(hn_strbuf *b, const hn_model *model, const hn_drag_request *request,
                             hn_diags *diags) {
    hn_arena *arena = hn_arena_create(0);
    const hn_status status = arena ? drag(b, model, request, arena, diags) : HN_ERR_MEMORY;
    hn_arena_free(arena);
    return status;
}
