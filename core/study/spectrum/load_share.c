// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/spectrum/load_share.h"

#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

/// Share of the rate of a mode that the largest load must make. Six like drives share a mode.
static const double GOOD_PART = 0.1;
/// Share of the size of a displacement or velocity, for central differences.
static const double PROBE = 1e-4;
enum { MOST_LOADS = 16 };

/// The force against a displacement (or velocity) along x, and along x: x' K x or x' C x of all
/// loads of `sys`, with everything else that pushes there.
static hn_status resistance(const hn_system *sys, const hn_mode_at *mode, double *out) {
    const hn_system_info info = hn_system_get_info(sys);
    const size_t nq = (size_t)info.nq, nv = (size_t)info.nv;
    hn_arena *arena = hn_arena_create(0);
    hn_eval *eval = NULL;
    if (!arena) {
        return HN_ERR_MEMORY;
    }
    double *q = hn_arena_doubles(arena, nq), *v = hn_arena_doubles(arena, nv);
    double *step = hn_arena_doubles(arena, nv);
    hn_status status =
        hn_arena_failed(arena) ? HN_ERR_MEMORY : hn_eval_create(sys, HN_TERM_F, arena, &eval);

    // a difference of both sides, so that the force at rest drops out
    const double size = PROBE / fmax(1e-12, hn_norm_max((int)nv, mode->x));
    *out = 0;
    for (int side = -1; side <= 1 && status == HN_OK; side += 2) {
        memcpy(q, mode->q, nq * sizeof *q);
        memcpy(v, mode->v, nv * sizeof *v);
        for (size_t i = 0; i < nv; i++) {
            step[i] = side * size * mode->x[i];
        }
        if (mode->damped) {
            hn_axpy((int)nv, 1, step, v);
        } else {
            hn_system_move(sys, q, step);
        }
        hn_eval_run(eval, mode->t, q, v);
        *out -= side * hn_dot((int)nv, mode->x, hn_eval_get(eval, HN_TERM_F)) / (2 * size);
    }

    hn_eval_free(eval);
    hn_arena_free(arena);
    return status;
}

/// The same with load k left out.
static hn_status resistance_without(const hn_scene *scene, int k, const hn_mode_at *mode,
                                    double *out) {
    hn_load loads[MOST_LOADS];
    hn_scene rest = *scene;
    hn_system *sys = NULL;
    memcpy(loads, scene->loads, (size_t)k * sizeof *loads);
    memcpy(loads + k, scene->loads + k + 1, (size_t)(scene->n_loads - k - 1) * sizeof *loads);
    rest.loads = loads;
    rest.n_loads = scene->n_loads - 1;

    hn_status status = hn_system_compile(&rest, NULL, &sys, NULL);
    if (status == HN_OK) {
        status = resistance(sys, mode, out);
    }
    hn_system_free(sys);
    return status;
}

const hn_load *hn_load_share_find(const hn_system *sys, const hn_mode_at *mode, double rate) {
    const hn_scene *scene = hn_system_scene(sys);
    const hn_load *found = NULL;
    double all = 0, most = GOOD_PART * rate;
    if (hn_system_pulls(sys) || scene->n_loads > MOST_LOADS ||
        resistance(sys, mode, &all) != HN_OK) {
        return NULL;
    }
    for (int k = 0; k < scene->n_loads; k++) {
        double rest = 0;
        if (resistance_without(scene, k, mode, &rest) != HN_OK) {
            return NULL;
        }
        if (all - rest > most) {
            most = all - rest;
            found = &scene->loads[k];
        }
    }
    return found;
}
