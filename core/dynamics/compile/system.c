// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/system.h"

#include "dynamics/compile/system_impl.h"

#include <math.h>
#include <stdbool.h>

const hn_scene *hn_system_scene(const hn_system *sys) {
    return sys->scene;
}

hn_system_info hn_system_get_info(const hn_system *sys) {
    hn_system_info info = sys->info;
    info.nodes = hn_graph_size(sys->g) - sys->leg_nodes[0];
    return info;
}

int hn_system_user_coordinate(const hn_system *sys, int i) {
    HN_ASSERT(i >= 0 && i < sys->nv);
    return sys->scene->is_lagrangian ? i : sys->tree.user[i];
}

const char *hn_system_row_name(const hn_system *sys, int row) {
    HN_ASSERT(row >= 0 && row < sys->nc);
    return sys->rows[row].name;
}

int hn_system_row_loop(const hn_system *sys, int row) {
    HN_ASSERT(row >= 0 && row < sys->nc);
    return sys->rows[row].loop;
}

bool hn_system_row_is_length(const hn_system *sys, int row) {
    HN_ASSERT(row >= 0 && row < sys->nc);
    return sys->rows[row].is_length;
}

double hn_system_row_unit(const hn_system *sys, int row) {
    return sys->rows[row].is_length ? sys->length : 1;
}

double hn_system_velocity_unit(const hn_system *sys, int i) {
    const hn_coordinate *c = &sys->scene->coordinates[hn_system_user_coordinate(sys, i)];
    return c->kind == HN_LENGTH ? sys->length : 1;
}

int hn_system_loop_joint(const hn_system *sys, int loop) {
    HN_ASSERT(loop >= 0 && loop < sys->n_loops);
    return sys->loops[loop].joint;
}

const char *hn_system_loop_name(const hn_system *sys, int loop) {
    HN_ASSERT(loop >= 0 && loop < sys->n_loops);
    return sys->loops[loop].name;
}

double hn_system_length(const hn_system *sys) {
    return sys->length;
}

int hn_system_tree_joint(const hn_system *sys, int body) {
    HN_ASSERT(body >= 0 && body < sys->scene->n_bodies);
    return sys->scene->is_lagrangian ? -1 : sys->tree.links[body].joint;
}

bool hn_system_joint_is_cut(const hn_system *sys, int joint) {
    HN_ASSERT(joint >= 0 && joint < sys->scene->n_joints);
    return !sys->scene->is_lagrangian && sys->tree.joint_cut[joint] >= 0;
}

hn_graph *hn_system_graph(const hn_system *sys) {
    return sys->g;
}

bool hn_system_was_stopped(const hn_system *sys) {
    return hn_graph_was_interrupted(sys->g);
}

hn_status hn_system_stopped(const hn_system *sys, hn_status status, hn_diag *diag) {
    return hn_system_was_stopped(sys)
               ? hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL, "stopped on request")
               : status;
}

hn_system_exprs hn_system_get_exprs(const hn_system *sys) {
    return (hn_system_exprs){.f = sys->f,
                             .phi = sys->phi,
                             .phi_t = sys->phi_t,
                             .gamma = sys->gamma,
                             .points = sys->points,
                             .kinetic = sys->kinetic,
                             .potential = sys->potential,
                             .q_symbols = sys->q_symbols,
                             .v_symbols = sys->v_symbols,
                             .t_symbol = sys->t_symbol};
}

static hn_ex *spread(const hn_entries *list, int rows, int cols, hn_arena *arena) {
    const size_t n = (size_t)cols;
    hn_ex *dense = hn_arena_get(arena, ((size_t)rows * n + 1) * sizeof *dense);
    for (int k = 0; dense && k < list->n; k++) {
        dense[(size_t)list->at[k].row * n + (size_t)list->at[k].col] = list->at[k].e;
    }
    return dense;
}

const hn_ex *hn_system_dense_mass(const hn_system *sys, hn_arena *arena) {
    const size_t n = (size_t)sys->nv;
    hn_ex *dense = spread(&sys->M, sys->nv, sys->nv, arena);
    for (int k = 0; dense && k < sys->M.n; k++) {
        const hn_entry *e = &sys->M.at[k];
        dense[(size_t)e->col * n + (size_t)e->row] = e->e;
    }
    return dense;
}

const hn_ex *hn_system_dense_jacobian(const hn_system *sys, hn_arena *arena) {
    return spread(&sys->J, sys->nc, sys->nv, arena);
}

int hn_system_position_of(const hn_system *sys, int i) {
    HN_ASSERT(i >= 0 && i < sys->nv);
    return sys->scene->is_lagrangian ? i : sys->tree.position[i];
}

const bool *hn_system_angles(const hn_system *sys) {
    return sys->is_angle;
}

hn_pull_log *hn_system_pulls(const hn_system *sys) {
    return sys->pulls;
}

double hn_system_next_corner(const hn_system *sys, double t) {
    double next = sys->pulls ? hn_pull_log_next_corner(sys->pulls, t) : HUGE_VAL;
    for (int k = 0; k < sys->scene->n_loads; k++) {
        const hn_profile *table = &sys->scene->loads[k].table;
        for (int i = 0; i < table->n; i++) {
            if (table->t[i] > t) {
                next = fmin(next, table->t[i]);
                break;
            }
        }
    }
    return next;
}
