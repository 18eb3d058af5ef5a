// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/truth/errors.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"

#include <math.h>

struct hn_errors {
    const hn_system *sys;
    hn_system_info info;
    double length;
    hn_eval *jacobian;
    int *is_length;               ///< n_user
    double *q, *other, *v;        ///< system coordinates
    double *delta, *user;         ///< differences
    double *multipliers, *forces; ///< nc, nv
    int worst;                    ///< user coordinate of the largest difference of q seen last
};

static const char *const names[HN_ERROR_COUNT] = {
#define HN_ERROR_ROW(code, name, title) name,
    HN_ERROR_LIST(HN_ERROR_ROW)
#undef HN_ERROR_ROW
};
static const char *const titles[HN_ERROR_COUNT] = {
#define HN_ERROR_ROW(code, name, title) title,
    HN_ERROR_LIST(HN_ERROR_ROW)
#undef HN_ERROR_ROW
};

const char *hn_error_name(hn_error_kind kind) {
    HN_ASSERT((int)kind >= 0 && kind < HN_ERROR_COUNT);
    return names[kind];
}

const char *hn_error_title(hn_error_kind kind) {
    HN_ASSERT((int)kind >= 0 && kind < HN_ERROR_COUNT);
    return titles[kind];
}

hn_status hn_errors_create(const hn_system *sys, hn_arena *arena, hn_errors **out) {
    const hn_system_info info = hn_system_get_info(sys);
    hn_errors *e = hn_arena_get(arena, sizeof *e);
    if (!e) {
        return HN_ERR_MEMORY;
    }

    const size_t nq = (size_t)info.nq, nv = (size_t)info.nv, nc = (size_t)info.nc;
    *e = (hn_errors){.sys = sys, .info = info, .length = hn_system_length(sys)};

    // memory
    e->is_length = hn_arena_ints(arena, (size_t)info.n_user);
    e->q = hn_arena_doubles(arena, nq);
    e->other = hn_arena_doubles(arena, nq);
    e->v = hn_arena_doubles(arena, nv);
    e->delta = hn_arena_doubles(arena, nv);
    e->user = hn_arena_doubles(arena, (size_t)info.n_user);
    e->multipliers = hn_arena_doubles(arena, nc);
    e->forces = hn_arena_doubles(arena, nv);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // which user coordinates are lengths: they are scaled by that of the mechanism
    const hn_scene *scene = hn_system_scene(sys);
    for (int i = 0; i < info.n_user; i++) {
        e->is_length[i] = scene->coordinates[hn_system_user_coordinate(sys, i)].kind == HN_LENGTH;
    }

    // constraint forces need J
    HN_TRY(hn_eval_create(sys, HN_TERM_J, arena, &e->jacobian));
    *out = e;
    return HN_OK;
}

void hn_errors_free(hn_errors *e) {
    if (e) {
        hn_eval_free(e->jacobian);
    }
}

/// Largest entry, lengths over L. `at`, if any, gets its index; 0 without entries.
static double largest(const hn_errors *e, const double *user, int *at) {
    double worst = 0;
    int where = 0;
    for (int i = 0; i < e->info.n_user; i++) {
        const double size = fabs(user[i]) / (e->is_length[i] ? e->length : 1);
        if (size > worst || isnan(size)) {
            worst = size;
            where = i;
        }
    }
    if (at) {
        *at = where;
    }
    return worst;
}

const hn_coordinate *hn_errors_worst_coordinate(const hn_errors *e) {
    const hn_scene *scene = hn_system_scene(e->sys);
    const bool none = e->info.n_user == 0;
    return none ? NULL : &scene->coordinates[hn_system_user_coordinate(e->sys, e->worst)];
}

double hn_errors_in_unit(const hn_errors *e, const hn_coordinate *coordinate, double error) {
    return error * (coordinate->kind == HN_LENGTH ? e->length : 1);
}

double hn_errors_rate(const hn_errors *e, const double *user_v) {
    return largest(e, user_v, NULL);
}

double hn_errors_between(hn_errors *e, const double *q, const double *other) {
    hn_system_from_user(e->sys, q, e->q);
    hn_system_from_user(e->sys, other, e->other);
    hn_system_difference(e->sys, e->other, e->q, e->delta);
    hn_system_rates_to_user(e->sys, e->delta, e->user);
    return largest(e, e->user, &e->worst);
}

double hn_errors_between_rates(const hn_errors *e, const double *v, const double *other,
                               const hn_scales *scales) {
    for (int i = 0; i < e->info.n_user; i++) {
        e->user[i] = v[i] - other[i];
    }
    return largest(e, e->user, NULL) / scales->rate;
}

double hn_errors_reaction(hn_errors *e, const hn_state_seen *at, const double *lambda) {
    const int nv = e->info.nv, nc = e->info.nc;
    hn_system_from_user(e->sys, at->q, e->q);
    hn_system_rates_from_user(e->sys, at->v, e->v);
    hn_eval_run(e->jacobian, at->t, e->q, e->v);
    const double *J = hn_eval_get(e->jacobian, HN_TERM_J);
    for (int j = 0; j < nv; j++) {
        e->forces[j] = 0;
        for (int i = 0; i < nc; i++) {
            e->forces[j] += J[i * nv + j] * lambda[i];
        }
    }
    hn_system_forces_to_user(e->sys, e->forces, e->user);
    double sum = 0;
    for (int i = 0; i < e->info.n_user; i++) {
        const double moment = e->user[i] * (e->is_length[i] ? e->length : 1);
        sum += moment * moment;
    }
    return sqrt(sum);
}

bool hn_errors_has_reactions(const hn_errors *e) {
    return e->info.nc > 0;
}

double hn_errors_least_reaction(const hn_errors *e, double rate) {
    static const double OF_WEIGHT = 1e-3, OF_INERTIA = 1e-7;
    const hn_scene *scene = hn_system_scene(e->sys);
    double mass = 0, gravity = 0;
    for (int i = 0; i < scene->n_bodies; i++) {
        mass += scene->bodies[i].mass.value;
    }
    for (int i = 0; i < 3; i++) {
        gravity = hypot(gravity, scene->gravity[i].value);
    }
    const double inertia = rate * rate * e->length;
    if (e->info.nc == 0) {
        return 0;
    }
    return mass * e->length * (OF_WEIGHT * gravity + OF_INERTIA * inertia);
}

void hn_errors_calc(hn_errors *e, const hn_state_seen *state, const hn_state_seen *reference,
                    const hn_scales *scales, double out[HN_ERROR_COUNT]) {
    out[HN_ERROR_Q] = hn_errors_between(e, state->q, reference->q);
    out[HN_ERROR_V] = hn_errors_between_rates(e, state->v, reference->v, scales);
    for (int i = 0; i < e->info.nc; i++) {
        e->multipliers[i] = state->lambda[i] - reference->lambda[i];
    }
    out[HN_ERROR_REACTION] = hn_errors_reaction(e, reference, e->multipliers) / scales->reaction;
    out[HN_ERROR_GAP] = state->gap / scales->length;
    out[HN_ERROR_VELOCITY_GAP] = state->velocity_gap / (scales->length * scales->rate);
    out[HN_ERROR_ENERGY] = fabs(state->energy - reference->energy) / scales->energy;
}
