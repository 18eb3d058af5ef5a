// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/analyse/pilot.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"

#include <math.h>
#include <string.h>

struct hn_pilot {
    const hn_system *sys;
    hn_accel *accel;
    int nq, nv;
    double *unit; ///< nv: the characteristic length for lengths, else 1
    double t, h;  ///< of the present state; of the last step
    double *q, *v;
    double *q_before, *v_before, *way; ///< start of the last step; nv: from there to q
    double *q_stage, *v_stage, *a, *dq, *dv, *move;
};

hn_status hn_pilot_create(const hn_system *sys, hn_arena *arena, hn_pilot **out) {
    const hn_system_info info = hn_system_get_info(sys);
    hn_pilot *p = hn_arena_get(arena, sizeof *p);
    *out = NULL;
    if (!p) {
        return HN_ERR_MEMORY;
    }
    *p = (hn_pilot){.sys = sys, .nq = info.nq, .nv = info.nv};

    // room for two states and a stage between them
    double **of_nq[] = {&p->q, &p->q_before, &p->q_stage};
    double **of_nv[] = {&p->v,  &p->v_before, &p->way,  &p->v_stage, &p->a,
                        &p->dq, &p->dv,       &p->move, &p->unit};
    for (size_t i = 0; i < sizeof of_nq / sizeof *of_nq; i++) {
        *of_nq[i] = hn_arena_doubles(arena, (size_t)info.nq);
    }
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(arena, (size_t)info.nv);
    }
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    for (int i = 0; i < info.nv; i++) {
        const int user = hn_system_user_coordinate(sys, i);
        const int is_length = hn_system_scene(sys)->coordinates[user].kind == HN_LENGTH;
        p->unit[i] = is_length ? hn_system_length(sys) : 1;
    }
    HN_TRY(hn_accel_create(sys, &(hn_accel_opts){0}, arena, &p->accel));
    *out = p;
    return HN_OK;
}

void hn_pilot_free(hn_pilot *p) {
    if (p) {
        hn_accel_free(p->accel);
        p->accel = NULL;
    }
}

double hn_pilot_half_turn(const hn_pilot *p, const double *v) {
    double fastest = 0;
    for (int i = 0; i < p->nv; i++) {
        fastest = fmax(fastest, fabs(v[i]) / p->unit[i]);
    }
    return fastest > 0 ? M_PI / fastest : HUGE_VAL;
}

void hn_pilot_start(hn_pilot *p, double t, const double *q, const double *v) {
    p->t = t;
    p->h = 0;
    memcpy(p->q, q, (size_t)p->nq * sizeof *q);
    memcpy(p->v, v, (size_t)p->nv * sizeof *v);
}

/// Adds the weighted slope at (t + share h) to the sums, and sets the next stage from it.
static hn_status add_stage(hn_pilot *p, double share, double weight, double next) {
    HN_TRY(hn_accel_eval(p->accel, p->t + share * p->h, p->q_stage, p->v_stage, 0, 0, p->a, NULL,
                         NULL));
    for (int i = 0; i < p->nv; i++) {
        p->dq[i] += weight * p->v_stage[i];
        p->dv[i] += weight * p->a[i];
        p->move[i] = next * p->h * p->v_stage[i];
        p->v_stage[i] = p->v[i] + next * p->h * p->a[i];
    }
    memcpy(p->q_stage, p->q, (size_t)p->nq * sizeof *p->q);
    hn_system_move(p->sys, p->q_stage, p->move);
    return HN_OK;
}

hn_status hn_pilot_step(hn_pilot *p, double h) {
    static const struct {
        double share, weight, next;
    } stages[] = {{0, 1.0 / 6, 0.5}, {0.5, 1.0 / 3, 0.5}, {0.5, 1.0 / 3, 1}, {1, 1.0 / 6, 0}};
    const size_t nv = (size_t)p->nv;
    p->h = h;
    memset(p->dq, 0, nv * sizeof *p->dq);
    memset(p->dv, 0, nv * sizeof *p->dv);
    memcpy(p->q_stage, p->q, (size_t)p->nq * sizeof *p->q);
    memcpy(p->v_stage, p->v, nv * sizeof *p->v);
    for (int k = 0; k < 4; k++) {
        HN_TRY(add_stage(p, stages[k].share, stages[k].weight, stages[k].next));
    }

    // the step, with what is needed to look inside it
    memcpy(p->q_before, p->q, (size_t)p->nq * sizeof *p->q);
    memcpy(p->v_before, p->v, nv * sizeof *p->v);
    for (int i = 0; i < p->nv; i++) {
        p->way[i] = h * p->dq[i];
        p->v[i] += h * p->dv[i];
    }
    hn_system_move(p->sys, p->q, p->way);
    (void)hn_system_normalise(p->sys, p->q);
    p->t += h;
    return HN_OK;
}

double hn_pilot_time(const hn_pilot *p) {
    return p->t;
}

const double *hn_pilot_q(const hn_pilot *p) {
    return p->q;
}

const double *hn_pilot_v(const hn_pilot *p) {
    return p->v;
}

void hn_pilot_inside(hn_pilot *p, double share, double *q) {
    const double s = share, whole = s * s * (3 - 2 * s), first = s * (1 - s) * (1 - s) * p->h,
                 last = -s * s * (1 - s) * p->h;
    for (int i = 0; i < p->nv; i++) {
        p->move[i] = whole * p->way[i] + first * p->v_before[i] + last * p->v[i];
    }
    memcpy(q, p->q_before, (size_t)p->nq * sizeof *q);
    hn_system_move(p->sys, q, p->move);
}
