// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/solve_rows.h"

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/inputs.h"
#include "dynamics/evaluate/ldl_kept.h"
#include "expr/construct.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- right-hand sides, multipliers ----

void hn_solve_rows_rhs(const hn_system *sys, const hn_solve_rows *rows, bool baumgarte,
                       hn_ex *rhs) {
    hn_graph *g = sys->g;
    memcpy(rhs, sys->f, (size_t)sys->nv * sizeof *rhs);
    rhs += sys->nv;
    if (!baumgarte) {
        for (int i = 0; i < sys->nc; i++) {
            rhs[i] = hn_neg(rows->gamma[i]);
        }
        return;
    }
    for (int i = 0; i < sys->nc; i++) {
        rhs[i] = sys->phi_t[i]; // gathers J v + phi_t; no place of a joint depends on time
    }
    for (int k = 0; k < rows->J.n; k++) {
        const hn_entry *J = &rows->J.at[k];
        rhs[J->row] = hn_add(g, rhs[J->row], hn_mul(g, J->e, sys->v[J->col]));
    }

    // with Baumgarte's terms
    hn_ex damping = hn_scale(2, sys->alpha), stiffness = hn_mul(g, sys->beta, sys->beta);
    for (int i = 0; i < sys->nc; i++) {
        hn_ex terms[3] = {rows->gamma[i], hn_mul(g, damping, rhs[i]),
                          hn_mul(g, stiffness, rows->phi[i])};
        rhs[i] = hn_neg(hn_sum(g, terms, 3));
    }
}

void hn_solve_rows_turn(const hn_system *sys, const hn_solve_rows *rows, hn_ex *lambda) {
    for (int k = 0; k < sys->n_legs && rows->of_legs; k++) {
        const hn_leg *leg = &sys->legs[k];
        hn_vec3 of_leg;
        memcpy(of_leg.x, lambda + leg->row, sizeof of_leg.x);
        const hn_vec3 turned = hn_mat3_apply(sys->g, &leg->turn, of_leg);
        memcpy(lambda + leg->row, turned.x, sizeof turned.x);
    }
}

// ---- the rows of the legs ----

/// Marks which rows of the system are replaced: marked (nc).
static void mark_legs(const hn_system *sys, char *marked) {
    for (int k = 0; k < sys->n_legs; k++) {
        memset(marked + sys->legs[k].row, 1, 3);
    }
}

/// J with the rows of the legs in place of the system's, sorted, in memory from the arena.
static hn_status gather_entries(const hn_system *sys, const char *marked, hn_entries *out) {
    hn_entries all = {0};
    for (int k = 0; k < sys->J.n; k++) {
        const hn_entry *e = &sys->J.at[k];
        if (!marked[e->row]) {
            hn_entries_add(&all, e->row, e->col, e->e);
        }
    }
    for (int k = 0; k < sys->n_legs; k++) {
        for (int i = 0; i < sys->legs[k].J.n; i++) {
            const hn_entry *e = &sys->legs[k].J.at[i];
            hn_entries_add(&all, e->row, e->col, e->e);
        }
    }
    hn_entries_sort(&all);

    // the list itself is freed with the system's arena
    *out = (hn_entries){.n = all.n, .cap = all.n, .failed = all.failed};
    out->at = hn_arena_get(sys->arena, ((size_t)all.n + 1) * sizeof *out->at);
    if (out->at && all.n > 0) {
        memcpy(out->at, all.at, (size_t)all.n * sizeof *out->at);
    }
    hn_entries_reset(&all);
    return out->at && !out->failed ? HN_OK : HN_ERR_MEMORY;
}

static hn_status make_leg_rows(const hn_system *sys, hn_solve_rows *out) {
    const size_t n = (size_t)sys->nc;
    char *marked = hn_arena_get(sys->arena, n);
    hn_ex *phi = hn_arena_get(sys->arena, n * sizeof *phi);
    hn_ex *gamma = hn_arena_get(sys->arena, n * sizeof *gamma);
    hn_ldl *ldl = hn_arena_get(sys->arena, sizeof *ldl);
    if (!marked || !phi || !gamma || !ldl) {
        return HN_ERR_MEMORY;
    }
    mark_legs(sys, marked);
    memcpy(phi, sys->phi, n * sizeof *phi);
    memcpy(gamma, sys->gamma, n * sizeof *gamma);
    for (int k = 0; k < sys->n_legs; k++) {
        const hn_leg *leg = &sys->legs[k];
        memcpy(phi + leg->row, leg->phi, sizeof leg->phi);
        memcpy(gamma + leg->row, leg->gamma, sizeof leg->gamma);
    }
    *out = (hn_solve_rows){.ldl = ldl, .phi = phi, .gamma = gamma, .of_legs = true};
    HN_TRY(gather_entries(sys, marked, &out->J));
    const hn_ldl_input in = {sys->nv, sys->nc, &sys->M, &out->J, HN_ACCEL_PAIRS};
    return hn_ldl_build(sys->g, &in, sys->arena, ldl);
}

// ---- the choice ----

/// Accelerations and multipliers (n of them, from the scratch arena) with these rows.
static hn_status solve(const hn_system *sys, const hn_solve_rows *rows, hn_arena *scratch,
                       hn_ex **x) {
    *x = hn_arena_get(scratch, ((size_t)rows->ldl->n + 1) * sizeof **x);
    if (!*x) {
        return HN_ERR_MEMORY;
    }
    hn_solve_rows_rhs(sys, rows, false, *x);
    HN_TRY(hn_ldl_solve(sys->g, rows->ldl, *x, *x));
    hn_solve_rows_turn(sys, rows, *x + sys->nv);
    return hn_graph_status(sys->g);
}

typedef struct search {
    char *seen; ///< per node
    int *stack; ///< nodes that are still to be counted
    int top;
} search;

static void meet(search *s, int node) {
    if (!s->seen[node]) {
        s->seen[node] = 1;
        s->stack[s->top++] = node;
    }
}

/// Sums, products and functions of all nodes that n expressions need, each once. A tape takes
/// fewer, in about the same proportion, and longer to compile.
static hn_status count_work(const hn_graph *g, const hn_ex *x, int n, hn_arena *scratch,
                            long *work) {
    const size_t size = (size_t)hn_graph_size(g);
    search s = {.seen = hn_arena_get(scratch, size), .stack = hn_arena_ints(scratch, size)};
    if (!s.seen || !s.stack) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < n; i++) {
        meet(&s, x[i].n);
    }
    *work = 0;
    while (s.top > 0) {
        const hn_node_view node = hn_graph_node(g, s.stack[--s.top]);
        *work += node.op == HN_OP_SUM ? node.n_args - 1 : node.n_args > 0;
        for (int k = 0; k < node.n_args; k++) {
            const bool is_number = node.args[k].n == HN_NODE_ONE;
            *work += node.op == HN_OP_SUM && !is_number && fabs(node.args[k].c) != 1;
            meet(&s, node.args[k].n);
        }
    }
    return HN_OK;
}

static hn_status find_work(const hn_system *sys, const hn_solve_rows *rows, long *work) {
    hn_arena *scratch = hn_arena_create(0);
    hn_ex *x;
    hn_status status = scratch ? solve(sys, rows, scratch, &x) : HN_ERR_MEMORY;
    HN_THEN(status, count_work(sys->g, x, rows->ldl->n, scratch, work));
    hn_arena_free(scratch);
    return status;
}

static hn_status own_rows(const hn_system *sys, hn_solve_rows *out) {
    *out = (hn_solve_rows){.J = sys->J, .phi = sys->phi, .gamma = sys->gamma};
    return hn_ldl_kept_get(sys, HN_FACTOR_MASS, &out->ldl);
}

static hn_status choose(const hn_system *sys, hn_solve_rows *out) {
    HN_TRY(own_rows(sys, out));
    if (sys->n_legs == 0) {
        return HN_OK;
    }

    // without an order of elimination there is no tape
    const int before = hn_graph_size(sys->g);
    hn_solve_rows legs;
    HN_TRY(make_leg_rows(sys, &legs));
    if (!legs.ldl->available) {
        return HN_OK;
    }
    HN_TRY(find_work(sys, &legs, &legs.work_legs));
    sys->leg_nodes[0] += hn_graph_size(sys->g) - before;
    if (out->ldl->available) {
        HN_TRY(find_work(sys, out, &out->work_own));
    }

    out->work_legs = legs.work_legs;
    legs.work_own = out->work_own;
    if (!out->ldl->available || legs.work_legs < legs.work_own) {
        *out = legs;
    }
    return HN_OK;
}

hn_status hn_solve_rows_get(const hn_system *sys, const hn_solve_rows **out) {
    hn_solve_rows **kept = sys->solve_rows;
    if (!*kept) {
        hn_solve_rows *made = hn_arena_get(sys->arena, sizeof *made);
        HN_TRY(made ? choose(sys, made) : HN_ERR_MEMORY);
        *kept = made;
    }
    *out = *kept;
    return HN_OK;
}

static hn_status count_ops(const hn_system *sys, const hn_solve_rows *rows, int *ops) {
    hn_arena *scratch = hn_arena_create(0);
    hn_inputs in = {0};
    hn_ex *x;
    hn_status status = scratch ? solve(sys, rows, scratch, &x) : HN_ERR_MEMORY;
    HN_THEN(status, hn_inputs_compile(sys, x, rows->ldl->n, scratch, &in));
    *ops = status == HN_OK ? hn_tape_get_info(in.tape).ops : 0;
    hn_inputs_free(&in);
    hn_arena_free(scratch);
    return status;
}

hn_status hn_solve_rows_saved(const hn_system *sys, int *ops) {
    const hn_solve_rows *rows;
    hn_solve_rows own;
    int before, after;
    *ops = 0;
    HN_TRY(hn_solve_rows_get(sys, &rows));
    HN_TRY(own_rows(sys, &own));
    if (!rows->of_legs || !own.ldl->available) {
        return HN_OK;
    }
    HN_TRY(count_ops(sys, &own, &before));
    HN_TRY(count_ops(sys, rows, &after));
    *ops = before - after;
    return HN_OK;
}
