// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/lagrangian.h"

#include "dynamics/compile/formula.h"
#include "dynamics/compile/loads.h"
#include "dynamics/compile/system_build.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static hn_status make_symbols(hn_system *sys) {
    const hn_scene *scene = sys->scene;
    size_t n = (size_t)scene->n_coordinates + 1;
    const char **names = hn_arena_get(sys->arena, n * sizeof *names);
    const char **rates = hn_arena_get(sys->arena, n * sizeof *rates);
    if (!names || !rates) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < scene->n_coordinates; i++) {
        names[i] = scene->coordinates[i].name;
        rates[i] = scene->coordinates[i].rate;
    }
    HN_TRY(hn_system_make_symbols(sys, names, rates));
    for (int i = 0; i < scene->n_coordinates; i++) {
        sys->user_q[i] = sys->q[i];
        sys->user_v[i] = sys->v[i];
        sys->user_known[i] = 1;
    }
    return HN_OK;
}

static bool depends_on_any(const hn_system *sys, hn_ex e, const int *symbols) {
    for (int i = 0; i < sys->nv; i++) {
        if (hn_depends_on(sys->g, e, symbols[i])) {
            return true;
        }
    }
    return false;
}

/// Values of a formula with every rate zero.
static hn_ex at_rest(hn_system *sys, hn_ex e) {
    hn_ex *zeros = hn_arena_get(sys->arena, (size_t)sys->nv * sizeof *zeros);
    hn_ex out = hn_num(0);
    if (zeros) {
        hn_substitute(sys->g, &e, 1, sys->v_symbols, zeros, sys->nv, &out);
    }
    return out;
}

// ---- kinetic and potential energy ----

static hn_status refuse_kinetic(hn_system *sys, const char *what) {
    return hn_diags_add(hn_system_faults(sys), HN_ERR_INPUT, sys->scene->lagrangian.kinetic.pointer,
                        "each term must be (something of the coordinates) * rate * rate",
                        "the kinetic energy must be quadratic in the rates: %s", what);
}

/// Coordinates with a position of their own: all but balls, whose rates are no derivatives of
/// coordinates.
typedef struct plain {
    int n;
    int *speed, *q_symbols, *v_symbols;
    hn_ex *v;
} plain;

static hn_status list_plain(hn_system *sys, plain *p) {
    const size_t n = (size_t)sys->nv;
    *p = (plain){0};
    p->speed = hn_arena_ints(sys->arena, n);
    p->q_symbols = hn_arena_ints(sys->arena, n);
    p->v_symbols = hn_arena_ints(sys->arena, n);
    p->v = hn_arena_get(sys->arena, n * sizeof *p->v);
    if (hn_arena_failed(sys->arena)) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < sys->nv; i++) {
        const int at = hn_system_position_of(sys, i);
        if (at >= 0) {
            p->speed[p->n] = i;
            p->q_symbols[p->n] = sys->q_symbols[at];
            p->v_symbols[p->n] = sys->v_symbols[i];
            p->v[p->n++] = sys->v[i];
        }
    }
    return HN_OK;
}

/// The first `n_theirs` entries of M are the bodies': one that is there already takes the formulas'
/// share.
static void add_mass(hn_system *sys, int n_theirs, int row, int col, hn_ex e) {
    for (int k = 0; k < n_theirs && !hn_is_zero(e); k++) {
        hn_entry *at = &sys->M.at[k];
        if (at->row == row && at->col == col) {
            at->e = hn_add(sys->g, at->e, e);
            return;
        }
    }
    hn_entries_add(&sys->M, row, col, e);
}

static hn_status trace_mass(hn_system *sys, const plain *c, const hn_ex *p) {
    hn_ex *row = hn_arena_get(sys->arena, (size_t)sys->nv * sizeof *row);
    const int n_theirs = sys->M.n;
    if (!row) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < c->n; i++) {
        hn_diff(sys->g, p[i], c->v_symbols, i + 1, row);
        for (int j = 0; j <= i; j++) {
            if (depends_on_any(sys, row[j], sys->v_symbols)) {
                return refuse_kinetic(sys,
                                      "its second derivative by the rates still contains a rate");
            }
            add_mass(sys, n_theirs, c->speed[i], c->speed[j], row[j]);
        }
        if (!hn_is_zero(at_rest(sys, p[i]))) {
            return refuse_kinetic(sys, "it has a term that is linear in a rate");
        }
    }
    return HN_OK;
}

static hn_status check_energies(hn_system *sys, hn_ex kinetic, hn_ex potential) {
    if (hn_depends_on(sys->g, kinetic, sys->t_symbol)) {
        return refuse_kinetic(sys, "it depends on t, which is not supported");
    }
    for (int k = 0; k < 3 * sys->n_balls; k++) {
        const int speed = sys->balls[k / 3].speed + k % 3;
        if (hn_depends_on(sys->g, kinetic, sys->v_symbols[speed])) {
            return refuse_kinetic(
                sys,
                "it has the angular velocity of an orientation, which is no coordinate's rate");
        }
    }
    if (depends_on_any(sys, potential, sys->v_symbols)) {
        return hn_diags_add(
            hn_system_faults(sys), HN_ERR_INPUT, sys->scene->lagrangian.potential.pointer,
            "write it as a force on a coordinate", "the potential energy contains a rate");
    }
    return hn_is_zero(at_rest(sys, kinetic))
               ? HN_OK
               : refuse_kinetic(sys, "it is not zero when the rates are zero");
}

hn_status hn_lagrangian_add_energies(hn_system *sys) {
    const hn_lagrangian *l = &sys->scene->lagrangian;
    hn_graph *g = sys->g;
    plain c;
    const size_t n = (size_t)sys->nv + 1;
    hn_ex *p = hn_arena_get(sys->arena, 4 * n * sizeof *p);
    hn_ex kinetic, potential;
    HN_TRY(hn_system_quantity(sys, &l->kinetic, &kinetic));
    HN_TRY(hn_system_quantity(sys, &l->potential, &potential));
    HN_TRY(check_energies(sys, kinetic, potential));
    HN_TRY(list_plain(sys, &c));
    if (!p) {
        return HN_ERR_MEMORY;
    }

    // p, its rate at zero u-dot, dT/dq, dV/dq
    hn_ex *p_rate = p + n, *T_q = p + 2 * n, *V_q = p + 3 * n;
    hn_diff_reverse(g, kinetic, c.v_symbols, c.n, p);
    hn_diff_forward(g, p, c.n, c.q_symbols, c.v, c.n, p_rate);
    hn_diff_reverse(g, kinetic, c.q_symbols, c.n, T_q);
    hn_diff_reverse(g, potential, c.q_symbols, c.n, V_q);

    // f = Q - h of (1)
    for (int i = 0; i < c.n; i++) {
        hn_ex terms[4] = {sys->f[c.speed[i]], T_q[i], hn_neg(p_rate[i]), hn_neg(V_q[i])};
        sys->f[c.speed[i]] = hn_sum(g, terms, 4);
    }

    sys->kinetic = hn_add(g, sys->kinetic, kinetic);
    sys->potential = hn_add(g, sys->potential, potential);
    return trace_mass(sys, &c, p);
}

// ---- constraints ----

/// J (nv entries), phi_t and gamma of (2) for the row's phi.
static hn_status differentiate_row(hn_system *sys, hn_new_row *row, hn_entry *entries) {
    hn_graph *g = sys->g;
    const int n = sys->nv;
    hn_ex *along = hn_arena_get(sys->arena, 2 * ((size_t)n + 1) * sizeof *along);
    int *symbols = hn_arena_ints(sys->arena, (size_t)n + 1);
    if (!along || !symbols) {
        return HN_ERR_MEMORY;
    }

    // along the motion: (q', v', t') = (v, 0, 1)
    for (int j = 0; j < n; j++) {
        symbols[j] = sys->q_symbols[j];
        along[j] = sys->v[j];
    }
    symbols[n] = sys->t_symbol;
    along[n] = hn_num(1);

    hn_ex *J = along + n + 1, rate;
    hn_diff_reverse(g, row->phi, sys->q_symbols, n, J);
    hn_diff(g, row->phi, &sys->t_symbol, 1, &row->phi_t);
    hn_diff_forward(g, &row->phi, 1, symbols, along, n + 1, &rate);
    hn_diff_forward(g, &rate, 1, symbols, along, n + 1, &row->gamma);
    for (int j = 0; j < n; j++) {
        entries[j] = (hn_entry){0, j, J[j]};
    }
    return HN_OK;
}

static hn_status add_constraint(hn_system *sys, int i) {
    const hn_lagrangian *l = &sys->scene->lagrangian;
    hn_entry *entries = hn_arena_get(sys->arena, (size_t)sys->nv * sizeof *entries);
    hn_new_row row = {.name = l->constraint_names[i],
                      .loop = i,
                      .pointer = l->constraints[i].pointer,
                      .J = entries,
                      .n_J = sys->nv};
    HN_TRY(hn_system_quantity(sys, &l->constraints[i], &row.phi));
    if (!entries) {
        return HN_ERR_MEMORY;
    }
    if (depends_on_any(sys, row.phi, sys->v_symbols)) {
        return hn_diags_add(
            hn_system_faults(sys), HN_ERR_UNSUPPORTED, row.pointer,
            "write the constraint on positions",
            "constraint '%s' contains a rate; only constraints on positions are supported",
            row.name);
    }

    // the row, and what its multiplier does along the coordinates
    const int before = sys->nc;
    HN_TRY(differentiate_row(sys, &row, entries));
    HN_TRY(hn_system_add_row(sys, &row));
    for (int j = 0; j < sys->nv && sys->nc > before; j++) {
        hn_entries_add(&sys->efforts, before, j, entries[j].e);
    }
    return HN_OK;
}

static hn_status trace_constraints(hn_system *sys) {
    const hn_lagrangian *l = &sys->scene->lagrangian;
    for (int i = 0; i < l->n_constraints; i++) {
        sys->loops[i] = (hn_loop){.constraint = -1,
                                  .tear = -1,
                                  .name = l->constraint_names[i],
                                  .joint = -1,
                                  .why = "a constraint of the scene"};
        HN_TRY(add_constraint(sys, i));
    }
    return HN_OK;
}

/// The arm by which an angle moves the constraints at the start, the largest of them: what joints
/// of a body are apart in a scene of bodies. It is the length of a column of J, so that turning the
/// axes changes nothing. Constraints that no angle moves leave 1.
static hn_status find_length(hn_system *sys) {
    const hn_coordinate *c = sys->scene->coordinates;
    double *x = hn_arena_doubles(sys->arena, (size_t)hn_graph_n_symbols(sys->g));
    double *square = hn_arena_doubles(sys->arena, (size_t)sys->nv);
    double largest = 0;
    if (!x || !square) {
        return HN_ERR_MEMORY;
    }

    // the start, and the parameters that stayed symbols
    for (int j = 0; j < sys->nv; j++) {
        x[sys->q_symbols[j]] = c[j].q0;
    }
    for (int i = 0; sys->opts.symbolic_params && i < sys->scene->n_params; i++) {
        x[hn_ex_symbol(sys->g, sys->params[i])] = sys->scene->params[i].value;
    }

    // squared length of each column of J there
    for (int k = 0; k < sys->J.n; k++) {
        const hn_entry *at = &sys->J.at[k];
        const double value = hn_graph_eval(sys->g, at->e, x);
        square[at->col] += value * value;
    }

    // the largest column of an angle
    for (int j = 0; j < sys->nv; j++) {
        largest = fmax(largest, c[j].kind == HN_ANGLE ? square[j] : 0);
    }
    if (largest > 0 && isfinite(largest)) {
        sys->length = sqrt(largest);
    }
    return HN_OK;
}

// ---- points ----

static hn_status trace_points(hn_system *sys) {
    for (int k = 0; k < sys->scene->n_points; k++) {
        hn_vec3 p;
        HN_TRY(hn_system_vector(sys, sys->scene->points[k].at, &p));
        for (int i = 0; i < 3; i++) {
            sys->points[3 * k + i] = p.x[i];
        }
    }
    return HN_OK;
}

static hn_status span_of_points(void *self, int p, int q, hn_span *out) {
    hn_system *sys = self;
    size_t n = (size_t)sys->nv;
    hn_ex *gradient = hn_arena_get(sys->arena, n * sizeof *gradient);
    out->coordinate = hn_arena_ints(sys->arena, n);
    out->coefficient = hn_arena_get(sys->arena, n * sizeof *out->coefficient);
    if (!gradient || !out->coordinate || !out->coefficient) {
        return HN_ERR_MEMORY;
    }
    out->n = sys->nv;
    for (int i = 0; i < 3; i++) {
        out->delta.x[i] = q < 0 ? sys->points[3 * p + i]
                                : hn_sub(sys->g, sys->points[3 * p + i], sys->points[3 * q + i]);
        hn_diff_reverse(sys->g, out->delta.x[i], sys->q_symbols, sys->nv, gradient);
        for (int j = 0; j < sys->nv; j++) {
            out->coordinate[j] = j;
            out->coefficient[j].x[i] = gradient[j];
        }
    }
    return HN_OK;
}

hn_status hn_lagrangian_compile(hn_system *sys) {
    const hn_scene *scene = sys->scene;
    int m = scene->lagrangian.n_constraints;
    HN_TRY(
        hn_system_allocate(sys, scene->n_coordinates, scene->n_coordinates, m, m, scene->n_points));
    HN_TRY(make_symbols(sys));
    HN_TRY(hn_lagrangian_add_energies(sys));
    HN_TRY(trace_constraints(sys));
    HN_TRY(find_length(sys));
    HN_TRY(trace_points(sys));
    hn_geometry geometry = {.self = sys, .span = span_of_points};
    HN_TRY(hn_loads_compile(sys, &geometry));
    return hn_system_make_drawing(sys, scene->n_tears);
}
