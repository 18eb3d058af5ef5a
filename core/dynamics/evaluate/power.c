// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/power.h"

#include "dynamics/compile/direction.h"
#include "dynamics/evaluate/inputs.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <stdlib.h>
#include <string.h>

struct hn_power {
    int nc;
    bool needs_lambda;
    hn_inputs in; ///< outputs: v . f + D(T + V), then phi_t (nc)
};

static int place_of(const hn_system *sys, int symbol) {
    int i = 0;
    while (sys->q_symbols[i] != symbol) {
        i++;
        HN_ASSERT(i < sys->nq);
    }
    return i;
}

/// The direction (G v, 1) of (q, t): nq + 1 symbols and rates.
static void find_direction(const hn_system *sys, int *symbols, hn_ex *rates) {
    hn_graph *g = sys->g;
    memcpy(symbols, sys->q_symbols, (size_t)sys->nq * sizeof *symbols);
    symbols[sys->nq] = sys->t_symbol;
    rates[sys->nq] = hn_num(1);
    for (int j = 0; j < sys->nv; j++) {
        int moved[HN_DIRECTION_MOST];
        hn_ex seed[HN_DIRECTION_MOST];
        const int n = hn_direction_of_speed(sys, j, moved, seed);
        for (int k = 0; k < n; k++) {
            hn_ex *rate = &rates[place_of(sys, moved[k])];
            *rate = hn_add(g, *rate, hn_mul(g, seed[k], sys->v[j]));
        }
    }
}

/// v . f + D(T + V)
static hn_ex calc_load_power(const hn_system *sys, const int *symbols, const hn_ex *rates) {
    hn_graph *g = sys->g;
    hn_ex power;
    const hn_ex energy = hn_add(g, sys->kinetic, sys->potential);
    hn_diff_forward(g, &energy, 1, symbols, rates, sys->nq + 1, &power);
    for (int i = 0; i < sys->nv; i++) {
        power = hn_add(g, power, hn_mul(g, sys->v[i], sys->f[i]));
    }
    return power;
}

static hn_status compile(const hn_system *sys, hn_arena *arena, hn_power *p) {
    const size_t n = (size_t)sys->nq + 1, outputs = (size_t)sys->nc + 1;
    int *symbols = calloc(n, sizeof *symbols);
    hn_ex *rates = calloc(n + outputs, sizeof *rates); // a zeroed expression is the number 0
    hn_status status = symbols && rates ? HN_OK : HN_ERR_MEMORY;
    if (status == HN_OK) {
        hn_ex *out = rates + n;
        find_direction(sys, symbols, rates);
        out[0] = calc_load_power(sys, symbols, rates);
        for (int i = 0; i < sys->nc; i++) {
            out[i + 1] = sys->phi_t[i];
            p->needs_lambda |= !hn_is_zero(sys->phi_t[i]);
        }
        const int used = p->needs_lambda ? (int)outputs : 1;
        status = hn_graph_status(sys->g);
        HN_THEN(status, hn_inputs_compile(sys, out, used, arena, &p->in));
    }
    free(symbols);
    free(rates);
    return status;
}

hn_status hn_power_create(const hn_system *sys, hn_arena *arena, hn_power **out) {
    HN_ASSERT(sys && arena && out);
    hn_power *p = hn_arena_get(arena, sizeof *p);
    *out = NULL;
    if (!p) {
        return HN_ERR_MEMORY;
    }
    // the graph may gain nodes; system.h says that this is the one thing that changes a system
    *p = (hn_power){.nc = sys->nc};
    const hn_status status = compile(sys, arena, p);
    if (status == HN_OK) {
        *out = p;
    }
    return status;
}

void hn_power_free(hn_power *p) {
    if (p) {
        hn_inputs_free(&p->in);
    }
}

bool hn_power_needs_lambda(const hn_power *p) {
    return p->needs_lambda;
}

double hn_power_run(hn_power *p, double t, const double *q, const double *v, const double *lambda) {
    hn_inputs_set(&p->in, t, q, v, 0, 0);
    hn_tape_run(p->in.tape, p->in.x);
    double power = p->in.x[p->in.slots[0]];
    for (int i = 0; p->needs_lambda && i < p->nc; i++) {
        power -= lambda[i] * p->in.x[p->in.slots[i + 1]];
    }
    return power;
}
