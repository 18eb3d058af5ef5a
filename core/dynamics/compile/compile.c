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
                                "coordinate '%s' moves nothing that has mass", c->name);
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

static hn_status finish(hn_system *sys) {
    size_t n = (size_t)sys->nv, m = (size_t)sys->nc;
    sys->M_dense = hn_system_get_zeros(sys, n * n);
    sys->J_dense = hn_system_get_zeros(sys, m * n);
    HN_TRY(hn_graph_status(sys->g));
    if (hn_arena_failed(sys->arena) || sys->M.failed || sys->J.failed || sys->efforts.failed) {
        return HN_ERR_MEMORY;
    }

    // dense copies of the sorted entries, for printing and grading
    hn_entries_sort(&sys->M);
    hn_entries_sort(&sys->J);
    for (int k = 0; k < sys->M.n; k++) {
        const hn_entry *e = &sys->M.at[k];
        sys->M_dense[(size_t)e->row * n + (size_t)e->col] = e->e;
        sys->M_dense[(size_t)e->col * n + (size_t)e->row] = e->e;
    }
    for (int k = 0; k < sys->J.n; k++) {
        sys->J_dense[(size_t)sys->J.at[k].row * n + (size_t)sys->J.at[k].col] = sys->J.at[k].e;
    }

    // the sizes that callers ask for
    sys->info.nq = sys->nq;
    sys->info.nv = sys->info.n_user = sys->nv;
    sys->info.nc = sys->nc;
    sys->info.n_loops = sys->n_loops;
    sys->info.has_time = depends_on_time(sys) || sys->n_pulls > 0;
    return check_freedoms(sys);
}

static const hn_quantity *place_on(const hn_joint *joint, int body) {
    return joint->parent == body ? joint->parent_at : joint->child == body ? joint->child_at : NULL;
}

/// Largest distance between two joints of one body, of the ground only if `grounds`.
static double largest_arm(const hn_scene *scene, int grounds) {
    double largest = 0;
    for (int a = 0; a < scene->n_joints; a++) {
        int bodies[2] = {scene->joints[a].parent, scene->joints[a].child};
        for (int e = 0; e < 2; e++) {
            for (int b = 0; b < a && (bodies[e] == HN_GROUND) == grounds; b++) {
                const hn_quantity *p = place_on(&scene->joints[a], bodies[e]);
                const hn_quantity *q = place_on(&scene->joints[b], bodies[e]);
                double d[3] = {0, 0, 0};
                for (int i = 0; q && i < 3; i++) {
                    d[i] = p[i].value - q[i].value;
                }
                largest = fmax(largest, sqrt(hn_num3_dot(d, d)));
            }
        }
    }
    return largest;
}

static double characteristic_length(const hn_scene *scene) {
    double length = largest_arm(scene, 0);
    if (length <= 0) {
        length = largest_arm(scene, 1);
    }
    return length > 0 ? length : 1;
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
    sys->length = characteristic_length(sys->scene);
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
    hn_pull_log_free(sys->pulls);
    hn_graph_free(sys->g);
    hn_arena_free(sys->arena);
    free(sys);
}
