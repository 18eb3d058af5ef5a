// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/system_build.h"

#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// A constant closure row smaller than this counts as closed, relative to the length of the
/// mechanism (or 1 for angles) [-].
static const double CLOSED = 1e-9;

static bool name_is_taken(const hn_system *sys, const char *name) {
    if (hn_graph_find_symbol(sys->g, name) >= 0) {
        return true;
    }
    return sys->opts.symbolic_params && hn_scene_find_param(sys->scene, name) >= 0;
}

static hn_ex new_symbol(hn_system *sys, const char *stem, int *number) {
    char name[128];
    snprintf(name, sizeof name - 8, "%s", stem);
    for (size_t n = strlen(name); name_is_taken(sys, name) && n < sizeof name - 1; n++) {
        name[n] = '_';
        name[n + 1] = 0;
    }
    hn_ex e = hn_symbol(sys->g, name, NULL);
    *number = hn_ex_symbol(sys->g, e);
    return e;
}

/// n expressions from the system's arena, each the number zero; NULL when memory is out.
static hn_ex *get_zeros(hn_system *sys, size_t n) {
    return hn_arena_get(sys->arena, (n ? n : 1) * sizeof(hn_ex));
}

/// The inputs and the log of the loads by which a hand pulls.
static hn_status make_pulls(hn_system *sys) {
    static const char *const stems[HN_PULL_INPUTS] = {"pull_k", "pull_c", "pull_x", "pull_y",
                                                      "pull_z"};
    const hn_scene *scene = sys->scene;
    int *points = hn_arena_ints(sys->arena, (size_t)scene->n_loads);
    for (int i = 0; points && i < scene->n_loads; i++) {
        if (scene->loads[i].kind == HN_LOAD_PULL) {
            points[sys->n_pulls++] = scene->loads[i].p;
        }
    }
    if (sys->n_pulls == 0) {
        return hn_arena_failed(sys->arena) ? HN_ERR_MEMORY : HN_OK;
    }

    sys->pull_inputs = get_zeros(sys, (size_t)(HN_PULL_INPUTS * sys->n_pulls));
    sys->pulls = hn_pull_log_create(points, sys->n_pulls);
    if (!sys->pull_inputs || !sys->pulls) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < HN_PULL_INPUTS * sys->n_pulls; i++) {
        int number;
        sys->pull_inputs[i] = new_symbol(sys, stems[i % HN_PULL_INPUTS], &number);
    }
    return HN_OK;
}

hn_status hn_system_make_symbols(hn_system *sys, const char *const *names,
                                 const char *const *rates) {
    for (int i = 0; i < sys->nq; i++) {
        sys->q[i] = new_symbol(sys, names[i], &sys->q_symbols[i]);
    }
    for (int i = 0; i < sys->nv; i++) {
        sys->v[i] = new_symbol(sys, rates[i], &sys->v_symbols[i]);
    }
    sys->t = new_symbol(sys, "t", &sys->t_symbol);
    sys->alpha = new_symbol(sys, "alpha", &sys->alpha_symbol);
    sys->beta = new_symbol(sys, "beta", &sys->beta_symbol);
    for (int i = 0; i < sys->scene->n_params; i++) {
        const hn_param *param = &sys->scene->params[i];
        sys->params[i] =
            sys->opts.symbolic_params ? hn_symbol(sys->g, param->name, NULL) : hn_num(param->value);
    }
    HN_TRY(make_pulls(sys));
    return hn_graph_status(sys->g);
}

hn_diags *hn_system_faults(const hn_system *sys) {
    return hn_graph_failed(sys->g) ? NULL : sys->diags;
}

hn_status hn_system_allocate(hn_system *sys, int nq, int nv, int max_rows, int n_loops,
                             int n_points) {
    size_t n = (size_t)nv, m = (size_t)max_rows, nu = (size_t)sys->scene->n_coordinates;
    sys->nq = nq;
    sys->nv = nv;
    sys->n_loops = n_loops;
    sys->info.n_points = n_points;

    // expressions, each the number zero so far
    sys->q = get_zeros(sys, (size_t)nq);
    sys->v = get_zeros(sys, n);
    sys->f = get_zeros(sys, n);
    sys->phi = get_zeros(sys, m);
    sys->phi_t = get_zeros(sys, m);
    sys->gamma = get_zeros(sys, m);
    sys->points = get_zeros(sys, 3 * (size_t)n_points);
    sys->params = get_zeros(sys, (size_t)sys->scene->n_params);
    sys->user_q = get_zeros(sys, nu);
    sys->user_v = get_zeros(sys, nu);
    sys->user_gamma = get_zeros(sys, nu);
    sys->load_values =
        hn_arena_get(sys->arena, ((size_t)sys->scene->n_loads + 1) * sizeof *sys->load_values);

    // plain arrays
    sys->user_known = hn_arena_get(sys->arena, nu);
    sys->q_symbols = hn_arena_ints(sys->arena, (size_t)nq);
    sys->v_symbols = hn_arena_ints(sys->arena, n);
    sys->rows = hn_arena_get(sys->arena, m * sizeof *sys->rows);
    sys->dropped = hn_arena_get(sys->arena, m * sizeof *sys->dropped);
    sys->loops = hn_arena_get(sys->arena, (size_t)n_loops * sizeof *sys->loops);
    sys->leg_nodes = hn_arena_ints(sys->arena, 1);
    sys->legs = hn_arena_get(sys->arena, (size_t)n_loops * sizeof *sys->legs);
    sys->ldls = hn_arena_get(sys->arena, HN_SYSTEM_LDLS * sizeof(struct hn_ldl *));
    sys->solve_rows = hn_arena_get(sys->arena, sizeof(struct hn_solve_rows *));
    return hn_arena_failed(sys->arena) ? HN_ERR_MEMORY : HN_OK;
}

static hn_status refuse_row(hn_system *sys, const hn_new_row *row, double offset) {
    const char *unit = row->is_length ? " m" : "";
    return hn_diags_add(
        hn_system_faults(sys), HN_ERR_INPUT, row->pointer,
        row->is_length ? "check where the joint sits on its two bodies, and the axes"
                       : "check the axes of the loop's joints",
        "the loop can never close: '%s' is off by %.6g%s in every pose", row->name, offset, unit);
}

/// Returns whether a row is the same in every pose, and its value at the scene's parameters. Where
/// these are symbols a row that is always closed may stand as terms that cancel, as c^2 + s^2 - 1.
static bool is_constant(hn_system *sys, hn_ex phi, double *value) {
    if (hn_is_number(phi, value)) {
        return true;
    }
    const int n = hn_graph_n_symbols(sys->g);
    double *x = hn_arena_doubles(sys->arena, (size_t)n);
    bool *is_param = hn_arena_get(sys->arena, (size_t)n * sizeof *is_param);
    if (!x || !is_param) {
        return false;
    }
    for (int i = 0; i < sys->scene->n_params; i++) {
        const int symbol = hn_ex_symbol(sys->g, sys->params[i]);
        if (symbol >= 0) {
            x[symbol] = sys->scene->params[i].value;
            is_param[symbol] = true;
        }
    }
    for (int k = 0; k < n; k++) {
        if (!is_param[k] && hn_depends_on(sys->g, phi, k)) {
            return false;
        }
    }
    *value = hn_graph_eval(sys->g, phi, x);
    return true;
}

hn_status hn_system_add_row(hn_system *sys, const hn_new_row *row) {
    sys->info.rows_before++;

    // a row that no velocity moves: closed already, or never
    int moves = 0;
    for (int k = 0; k < row->n_J; k++) {
        moves |= !hn_is_zero(row->J[k].e);
    }
    double value;
    if (!moves) {
        if (!is_constant(sys, row->phi, &value)) {
            return hn_diags_add(hn_system_faults(sys), HN_ERR_INPUT, row->pointer,
                                "a constraint must contain a coordinate",
                                "'%s' depends on no coordinate", row->name);
        }
        if (!(fabs(value) <= CLOSED * (row->is_length ? sys->length : 1))) {
            return refuse_row(sys, row, value);
        }
        sys->dropped[sys->info.rows_dropped++] = row->name;
        return HN_OK;
    }

    // a row that counts
    int i = sys->nc++;
    sys->phi[i] = row->phi;
    sys->phi_t[i] = row->phi_t;
    sys->gamma[i] = row->gamma;
    sys->rows[i] = (hn_row){.name = row->name, .loop = row->loop, .is_length = row->is_length};

    if (row->wrench) {
        sys->rows[i].wrench = *row->wrench;
    }
    for (int k = 0; k < row->n_J; k++) {
        hn_entries_add(&sys->J, i, row->J[k].col, row->J[k].e);
    }
    return HN_OK;
}
