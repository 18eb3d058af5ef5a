// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/pull_force.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/inputs.h"

#include <stdlib.h>

struct hn_pull_force {
    const hn_system *sys;
    hn_inputs in; ///< outputs: three for each pull
    double *q, *v;
};

hn_status hn_pull_force_create(const hn_system *sys, hn_arena *arena, hn_pull_force **out) {
    HN_ASSERT(sys && sys->n_pulls > 0 && arena && out);
    const hn_scene *scene = sys->scene;
    hn_pull_force *p = hn_arena_get(arena, sizeof *p);
    hn_ex *outputs = hn_arena_get(arena, 3 * (size_t)sys->n_pulls * sizeof *outputs);
    *out = NULL;
    if (!p || !outputs) {
        return HN_ERR_MEMORY;
    }
    *p = (hn_pull_force){.sys = sys,
                         .q = hn_arena_doubles(arena, (size_t)sys->nq),
                         .v = hn_arena_doubles(arena, (size_t)sys->nv)};

    // in the order of the log's points
    int n = 0;
    for (int k = 0; k < scene->n_loads; k++) {
        for (int i = 0; i < 3 && scene->loads[k].kind == HN_LOAD_PULL; i++) {
            outputs[n++] = sys->load_values[k].x[i];
        }
    }
    HN_TRY(hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK);
    HN_TRY(hn_inputs_compile(sys, outputs, n, arena, &p->in));
    *out = p;
    return HN_OK;
}

void hn_pull_force_free(hn_pull_force *p) {
    if (p) {
        hn_inputs_free(&p->in);
    }
}

void hn_pull_force_run(hn_pull_force *p, double t, const double *user_q, const double *user_v,
                       double force[3]) {
    const hn_pull *held = hn_pull_log_at(p->sys->pulls, t);
    if (!held) {
        force[0] = force[1] = force[2] = 0;
        return;
    }
    hn_system_from_user(p->sys, user_q, p->q);
    hn_system_rates_from_user(p->sys, user_v, p->v);
    hn_inputs_set(&p->in, t, p->q, p->v, 0, 0);
    hn_tape_run(p->in.tape, p->in.x);
    const int first = 3 * hn_pull_log_find(p->sys->pulls, held->point);
    for (int i = 0; i < 3; i++) {
        force[i] = p->in.x[p->in.slots[first + i]];
    }
}
