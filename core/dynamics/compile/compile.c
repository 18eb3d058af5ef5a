// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/compile.h"

#include "dynamics/compile/bodies.h"
#include "dynamics/compile/lagrangian.h"
#include "dynamics/compile/system_build.h"
#include "expr/construct.h"

#include <math.h>
#include <stdbool.h>

/// A coordinate that no mass and no closure touches has no equation.
static hn_status check_freedoms(hn_system *sys) {
    char *touched = hn_arena_get(sys->arena, (size_t)sys->nv + 1);
    if (!touched) {
        return HN_ERR_MEMORY;
    }

    // marks every coordinate with a mass or a closure
    for (int k = 0; k < sys->M.n; k++) {
        touched[sys->M.at[k].row] = touched[sys->M.at[k].col] = 1;
    }
    for (int k = 0; k < sys->J.n; k++) {
        touched[sys->J.at[k].col] = 1;
    }

    for (int i = 0; i < sys->nv; i++) {
        if (!touched[i]) {
            const hn_coordinate *c = &sys->scene->coordinates[hn_system_user_coordinate(sys, i)];
            return hn_diags_add(sys->diags, HN_ERR_INPUT,
                                c->joint >= 0 ? sys->scene->joints[c->joint].pointer : NULL,
                                "give the body a mass or an inertia about the joint",
                                "coordinate '%s' moves no mass", c->name);
        }
    }
    return HN_OK;
}

static bool depends_on_time(const hn_system *sys) {
    for (int i = 0; i < sys->nv; i++) {
        if (hn_depends_on(sys->g, sys->f[i], sys->t_symbol)) {
            return true;
        }
    }
    for (int i = 0; i < sys->nc; i++) {
        if (hn_depends_on(sys->g, sys->phi[i], sys->t_symbol)) {
            return true;
        }
    }
    return false;
}

static hn_status find_angles(hn_system *sys) {
    sys->is_angle = hn_arena_get(sys->arena, (size_t)sys->nq + 1);
    if (!sys->is_angle) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < sys->nv; i++) {
        const int at = hn_system_position_of(sys, i);
        if (at >= 0) {
            const int user = hn_system_user_coordinate(sys, i);
            sys->is_angle[at] = sys->scene->coordinates[user].kind == HN_ANGLE;
        }
    }
    return HN_OK;
}

static hn_status finish(hn_system *sys) {
    HN_TRY(hn_graph_status(sys->g));
    if (hn_arena_failed(sys->arena) || sys->M.failed || sys->J.failed || sys->efforts.failed) {
        return HN_ERR_MEMORY;
    }

    hn_entries_sort(&sys->M);
    hn_entries_sort(&sys->J);

    // the sizes that callers ask for
    sys->info.nq = sys->nq;
    sys->info.nv = sys->info.n_user = sys->nv;
    sys->info.nc = sys->nc;
    sys->info.n_loops = sys->n_loops;
    sys->info.has_time = depends_on_time(sys) || sys->n_pulls > 0;
    HN_TRY(find_angles(sys));
    return check_freedoms(sys);
}

static const hn_quantity *place_on(const hn_joint *joint, int body) {
    return joint->parent == body ? joint->parent_at : joint->child == body ? joint->child_at : NULL;
}

/// Joints of each body, one body after the other: list[start[body]] .. list[start[body + 1] - 1];
/// the ground comes last.
typedef struct joints_of {
    int *start, *list;
} joints_of;

static int place_in_list(const hn_scene *scene, int body) {
    return body == HN_GROUND ? scene->n_bodies : body;
}

static hn_status list_joints(const hn_scene *scene, hn_arena *arena, joints_of *out) {
    const size_t n = (size_t)scene->n_bodies + 1;
    out->start = hn_arena_ints(arena, n + 2);
    out->list = hn_arena_ints(arena, 2 * (size_t)scene->n_joints);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // counted, then listed
    for (int a = 0; a < scene->n_joints; a++) {
        out->start[place_in_list(scene, scene->joints[a].parent) + 2]++;
        out->start[place_in_list(scene, scene->joints[a].child) + 2]++;
    }
    for (size_t k = 0; k < n; k++) {
        out->start[k + 1] += out->start[k];
    }
    for (int a = 0; a < scene->n_joints; a++) {
        out->list[out->start[place_in_list(scene, scene->joints[a].parent) + 1]++] = a;
        out->list[out->start[place_in_list(scene, scene->joints[a].child) + 1]++] = a;
    }
    return HN_OK;
}

/// Largest distance between two joints of a body.
static double arm_of(const hn_scene *scene, const joints_of *joints, int body) {
    const int at = place_in_list(scene, body);
    double largest = 0;
    for (int a = joints->start[at]; a < joints->start[at + 1]; a++) {
        for (int b = joints->start[at]; b < a; b++) {
            const hn_quantity *p = place_on(&scene->joints[joints->list[a]], body);
            const hn_quantity *q = place_on(&scene->joints[joints->list[b]], body);
            double d[3];
            for (int i = 0; i < 3; i++) {
                d[i] = p[i].value - q[i].value;
            }
            largest = fmax(largest, sqrt(hn_num3_dot(d, d)));
        }
    }
    return largest;
}

/// The largest arm of a body; where no body has one, that of the ground.
static hn_status find_length(hn_system *sys) {
    const hn_scene *scene = sys->scene;
    joints_of joints;
    double length = 0;
    HN_TRY(list_joints(scene, sys->arena, &joints));
    for (int body = 0; body < scene->n_bodies; body++) {
        length = fmax(length, arm_of(scene, &joints, body));
    }
    length = length > 0 ? length : arm_of(scene, &joints, HN_GROUND);
    sys->length = length > 0 ? length : 1;
    return HN_OK;
}

hn_system_opts hn_system_opts_default(void) {
    return (hn_system_opts){.symbolic_params = 0};
}

static hn_status compile(hn_system *sys) {
    sys->arena = hn_arena_create(0);
    sys->g = hn_graph_create();
    if (!sys->arena || !sys->g) {
        return HN_ERR_MEMORY;
    }
    hn_graph_set_interrupt(sys->g, sys->opts.interrupt);
    HN_TRY(find_length(sys));
    sys->kinetic = sys->potential = hn_num(0);
    const hn_status status =
        sys->scene->is_lagrangian ? hn_lagrangian_compile(sys) : hn_bodies_compile(sys);

    // a graph or an arena that failed hands out zeros, which look like faults of the scene
    HN_TRY(hn_graph_status(sys->g));
    if (hn_arena_failed(sys->arena)) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(status);
    return finish(sys);
}

hn_status hn_system_compile(const hn_scene *scene, const hn_system_opts *opts, hn_system **out,
                            hn_diags *diags) {
    HN_ASSERT(scene && out);
    hn_system *sys = calloc(1, sizeof *sys);
    *out = NULL;
    if (!sys) {
        return HN_ERR_MEMORY;
    }
    sys->scene = scene;
    sys->opts = opts ? *opts : hn_system_opts_default();
    sys->diags = diags;
    const hn_status status = compile(sys);
    sys->diags = NULL;
    if (status != HN_OK) {
        hn_system_free(sys);
        return status;
    }
    *out = sys;
    return HN_OK;
}

void hn_system_free(hn_system *sys) {
    if (!sys) {
        return;
    }
    hn_entries_reset(&sys->M);
    hn_entries_reset(&sys->J);
    hn_entries_reset(&sys->efforts);
    for (int k = 0; k < sys->n_legs; k++) {
        hn_entries_reset(&sys->legs[k].J);
    }
    hn_pull_log_free(sys->pulls);
    hn_graph_free(sys->g);
    hn_arena_free(sys->arena);
    free(sys);
}
