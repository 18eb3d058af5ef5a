// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/force_parts.h"

#include "dynamics/compile/direction.h"
#include "dynamics/evaluate/inputs.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct hn_force_parts {
    int nv;
    hn_inputs in;
    double *h, *g;
};

/// While it is built: gradients of the energies, momenta and their rate at a = 0, then (2) and (3).
typedef struct builder {
    const hn_system *sys;
    hn_graph *g;
    hn_ex *T_q, *V_q, *q_dot; ///< nq
    hn_ex *p, *p_dot, *out;   ///< nv, nv, 2 nv
} builder;

/// A zeroed expression is the number 0.
static bool allocate(builder *b) {
    const size_t nq = (size_t)b->sys->nq, nv = (size_t)b->sys->nv;
    b->T_q = calloc(nq + 1, sizeof *b->T_q);
    b->V_q = calloc(nq + 1, sizeof *b->V_q);
    b->q_dot = calloc(nq + 1, sizeof *b->q_dot);
    b->p = calloc(nv + 1, sizeof *b->p);
    b->p_dot = calloc(nv + 1, sizeof *b->p_dot);
    b->out = calloc(2 * nv + 1, sizeof *b->out);
    return b->T_q && b->V_q && b->q_dot && b->p && b->p_dot && b->out;
}

static void release(builder *b) {
    free(b->T_q);
    free(b->V_q);
    free(b->q_dot);
    free(b->p);
    free(b->p_dot);
    free(b->out);
}

static int place_of(const builder *b, int symbol) {
    int i = 0;
    while (b->sys->q_symbols[i] != symbol) {
        i++;
        HN_ASSERT(i < b->sys->nq);
    }
    return i;
}

/// q' = G v, and the gradients along each velocity: T_q G to h with its sign, V_q G to g.
static void go_along_speeds(builder *b) {
    const hn_system *sys = b->sys;
    for (int j = 0; j < sys->nv; j++) {
        int symbols[HN_DIRECTION_MOST];
        hn_ex seed[HN_DIRECTION_MOST];
        const int n = hn_direction_of_speed(sys, j, symbols, seed);
        for (int k = 0; k < n; k++) {
            const int i = place_of(b, symbols[k]);
            b->q_dot[i] = hn_add(b->g, b->q_dot[i], hn_mul(b->g, seed[k], sys->v[j]));
            b->out[j] = hn_sub(b->g, b->out[j], hn_mul(b->g, b->T_q[i], seed[k]));
            b->out[sys->nv + j] =
                hn_add(b->g, b->out[sys->nv + j], hn_mul(b->g, b->V_q[i], seed[k]));
        }
    }
}

/// The velocities of a ball are not rates of coordinates: its momentum turns with the axes it is
/// measured in.
static void turn_momenta(builder *b) {
    for (int k = 0; k < b->sys->n_balls; k++) {
        const int at = b->sys->balls[k].speed;
        const hn_ex *w = b->sys->v + at, *p = b->p + at;
        for (int x = 0; x < 3; x++) {
            const int y = (x + 1) % 3, z = (x + 2) % 3;
            const hn_ex turn = hn_sub(b->g, hn_mul(b->g, w[y], p[z]), hn_mul(b->g, w[z], p[y]));
            b->out[at + x] = hn_add(b->g, b->out[at + x], turn);
        }
    }
}

static void build(builder *b) {
    const hn_system *sys = b->sys;
    hn_diff_reverse(b->g, sys->kinetic, sys->q_symbols, sys->nq, b->T_q);
    hn_diff_reverse(b->g, sys->potential, sys->q_symbols, sys->nq, b->V_q);
    hn_diff_reverse(b->g, sys->kinetic, sys->v_symbols, sys->nv, b->p);
    go_along_speeds(b);
    hn_diff_forward(b->g, b->p, sys->nv, sys->q_symbols, b->q_dot, sys->nq, b->p_dot);
    for (int j = 0; j < sys->nv; j++) {
        b->out[j] = hn_add(b->g, b->out[j], b->p_dot[j]);
    }
    turn_momenta(b);
}

static hn_status compile(builder *b, hn_arena *arena, hn_force_parts *p) {
    if (!allocate(b)) {
        return HN_ERR_MEMORY;
    }
    build(b);
    HN_TRY(hn_graph_status(b->g));
    return hn_inputs_compile(b->sys, b->out, 2 * p->nv, arena, &p->in);
}

hn_status hn_force_parts_create(const hn_system *sys, hn_arena *arena, hn_force_parts **out) {
    HN_ASSERT(sys && arena && out);
    hn_force_parts *p = hn_arena_get(arena, sizeof *p);
    *out = NULL;
    if (!p) {
        return HN_ERR_MEMORY;
    }

    p->nv = sys->nv;
    p->h = hn_arena_doubles(arena, (size_t)sys->nv);
    p->g = hn_arena_doubles(arena, (size_t)sys->nv);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    // the graph may gain nodes; system.h says that this is the one thing that changes a system
    builder b = {.sys = sys, .g = sys->g};
    const hn_status status = compile(&b, arena, p);
    release(&b);
    if (status == HN_OK) {
        *out = p;
    }
    return status;
}

void hn_force_parts_free(hn_force_parts *p) {
    if (p) {
        hn_inputs_free(&p->in);
    }
}

void hn_force_parts_run(hn_force_parts *p, double t, const double *q, const double *v) {
    hn_inputs_set(&p->in, t, q, v, 0, 0);
    hn_tape_run(p->in.tape, p->in.x);
    for (int i = 0; i < p->nv; i++) {
        p->h[i] = p->in.x[p->in.slots[i]];
        p->g[i] = p->in.x[p->in.slots[p->nv + i]];
    }
}

const double *hn_force_parts_h(const hn_force_parts *p) {
    return p->h;
}

const double *hn_force_parts_g(const hn_force_parts *p) {
    return p->g;
}
