// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/drag.h"

#include "base/clock.h"
#include "dynamics/assembly/project.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "linalg/saddle.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MAX_STEPS = 1000, MAX_DAMPINGS = 12 };
// of one step in any coordinate, in radians or lengths: loops stay on their branch
static const double LONGEST_STEP = 0.25;
// of the projection after a step, against the step: a longer one went somewhere else
static const double LONGEST_CORRECTION = 1.0;
// central differences: error about 1e-10 of a length
static const double DIFFERENCE = 1e-5;
static const double CLOSED = 1e-13;  // of the projection, lengths
static const double REACHED = 1e-10; // lengths
// a step that gains less than this part of the distance ends the search
static const double NO_GAIN = 1e-9;
static const double FIRST_DAMPING = 1e-4, LEAST_DAMPING = 1e-12;

/// One drag at work.
typedef struct drag {
    const hn_system *sys;
    const hn_drag_goal *goal;
    hn_system_info info;
    hn_arena *arena;
    hn_eval *points, *rows; ///< world points; phi and J
    hn_projector *projector;
    hn_saddle_ws *saddle;
    double t, length;
    double *unit;                             ///< nv: a radian, or the characteristic length
    double *q, *trial, *user, *move, *change; ///< nq, nq, nv, nv, nv
    double *A, *M, *f;                        ///< n x nv, nv x nv, nv
    double miss[3], distance;                 ///< target - p at q, and its length
    double damping;
} drag;

// ---- setting up ----

static hn_status create(drag *d) {
    const size_t nv = (size_t)d->info.nv, nq = (size_t)d->info.nq;
    double **const of_nv[] = {&d->unit, &d->user, &d->move, &d->change, &d->f};
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(d->arena, nv + 1);
    }
    d->q = hn_arena_doubles(d->arena, nq + 1);
    d->trial = hn_arena_doubles(d->arena, nq + 1);
    d->A = hn_arena_doubles(d->arena, 3 * nv + 1);
    d->M = hn_arena_doubles(d->arena, nv * nv + 1);
    d->saddle = hn_saddle_ws_create(d->arena, d->info.nv, d->info.nc);
    if (hn_arena_failed(d->arena) || !d->saddle) {
        return HN_ERR_MEMORY;
    }

    // what is measured, and the way back onto the constraints
    HN_TRY(hn_eval_create(d->sys, HN_TERM_POINTS, d->arena, &d->points));
    HN_TRY(hn_eval_create(d->sys, HN_TERM_PHI | HN_TERM_J, d->arena, &d->rows));
    return hn_projector_create(d->sys, HN_WEIGHT_EUCLIDEAN, d->arena, &d->projector);
}

static void set_units(drag *d) {
    const hn_scene *scene = hn_system_scene(d->sys);
    for (int i = 0; i < d->info.nv; i++) {
        const int k = hn_system_user_coordinate(d->sys, i);
        d->unit[i] = scene->coordinates[k].kind == HN_LENGTH ? d->length : 1;
    }
}

// ---- measuring ----

/// The position of the dragged point or coordinate at q.
static void find_place(drag *d, const double *q, double place[3]) {
    if (d->goal->point >= 0) {
        hn_eval_run(d->points, d->t, q, NULL);
        memcpy(place, hn_eval_get(d->points, HN_TERM_POINTS) + 3 * d->goal->point,
               3 * sizeof *place);
    } else {
        hn_system_to_user(d->sys, q, d->user);
        place[0] = d->user[d->goal->coordinate];
    }
}

static double find_miss(drag *d, const double *q, double miss[3]) {
    double place[3] = {0};
    find_place(d, q, place);
    for (int i = 0; i < d->goal->n; i++) {
        miss[i] = d->goal->target[i] - place[i];
    }
    return hn_norm2(d->goal->n, miss);
}

/// A by central differences along each velocity.
static void differentiate(drag *d) {
    const int nv = d->info.nv, n = d->goal->n;
    memset(d->move, 0, (size_t)nv * sizeof *d->move);
    for (int k = 0; k < nv; k++) {
        double ends[2][3] = {{0}};
        for (int side = 0; side < 2; side++) {
            memcpy(d->trial, d->q, (size_t)d->info.nq * sizeof *d->q);
            d->move[k] = (side ? DIFFERENCE : -DIFFERENCE) * d->unit[k];
            hn_system_move(d->sys, d->trial, d->move);
            find_place(d, d->trial, ends[side]);
        }
        d->move[k] = 0;
        for (int i = 0; i < n; i++) {
            d->A[i * nv + k] = (ends[1][i] - ends[0][i]) / (2 * DIFFERENCE * d->unit[k]);
        }
    }
}

// ---- stepping ----

/// Solves (2) for d->move, no longer than a step may be.
static hn_status find_move(drag *d) {
    const int nv = d->info.nv, n = d->goal->n;
    const double scale = d->goal->point >= 0 ? d->length : d->unit[d->goal->coordinate];
    for (int i = 0; i < nv; i++) {
        for (int k = 0; k < nv; k++) {
            double sum = i == k ? d->damping * scale * scale / (d->unit[k] * d->unit[k]) : 0;
            for (int row = 0; row < n; row++) {
                sum += d->A[row * nv + i] * d->A[row * nv + k];
            }
            d->M[i * nv + k] = sum;
        }
        d->f[i] = 0;
        for (int row = 0; row < n; row++) {
            d->f[i] += d->A[row * nv + i] * d->miss[row];
        }
    }
    hn_saddle_opts opts = hn_saddle_opts_default();
    opts.residual_tol = HUGE_VAL; // rows that depend on others may disagree by rounding
    HN_TRY(hn_saddle_solve(nv, d->info.nc, d->M, hn_eval_get(d->rows, HN_TERM_J), d->f,
                           hn_eval_get(d->rows, HN_TERM_PHI), d->move, NULL, NULL, &opts,
                           d->saddle));

    // shortened as a whole
    double longest = 0;
    for (int i = 0; i < nv; i++) {
        longest = fmax(longest, fabs(d->move[i]) / d->unit[i]);
    }
    if (longest > LONGEST_STEP) {
        for (int i = 0; i < nv; i++) {
            d->move[i] *= LONGEST_STEP / longest;
        }
    }
    return HN_OK;
}

/// Length of a change of the velocities, in radians and characteristic lengths.
static double size_of(const drag *d, const double *change) {
    double sum = 0;
    for (int i = 0; i < d->info.nv; i++) {
        sum += change[i] * change[i] / (d->unit[i] * d->unit[i]);
    }
    return sqrt(sum);
}

/// Tries the move: 1 when it leads to a closed pose of the same branch, left in d->trial.
static bool close_after_move(drag *d) {
    memcpy(d->trial, d->q, (size_t)d->info.nq * sizeof *d->q);
    hn_system_move(d->sys, d->trial, d->move);
    if (hn_project_position(d->projector, d->t, d->trial, CLOSED, NULL) != HN_OK) {
        return false;
    }
    hn_system_difference(d->sys, d->q, d->trial, d->change);
    for (int i = 0; i < d->info.nv; i++) {
        d->change[i] -= d->move[i];
    }
    return size_of(d, d->change) <= LONGEST_CORRECTION * size_of(d, d->move) + CLOSED;
}

typedef enum outcome { NEARER, NO_NEARER, NOT_CLOSED } outcome;

/// One step, with as much damping as it takes.
static outcome step(drag *d) {
    outcome result = NO_NEARER;
    hn_eval_run(d->rows, d->t, d->q, NULL);
    differentiate(d);

    // more damping until the loops close and the miss shrinks
    for (int i = 0; i < MAX_DAMPINGS; i++, d->damping *= 10) {
        if (find_move(d) != HN_OK || !close_after_move(d)) {
            result = NOT_CLOSED;
            continue;
        }

        // a move that closes counts only where it comes nearer
        double miss[3] = {0};
        const double distance = find_miss(d, d->trial, miss);
        result = NO_NEARER;
        if (distance < d->distance) {
            const bool gains = distance < d->distance * (1 - NO_GAIN);
            memcpy(d->q, d->trial, (size_t)d->info.nq * sizeof *d->q);
            memcpy(d->miss, miss, sizeof miss);
            d->distance = distance;
            d->damping = fmax(d->damping / 10, LEAST_DAMPING);
            return gains ? NEARER : NO_NEARER;
        }
    }
    return result;
}

static hn_drag_end walk(drag *d, double seconds, int *steps) {
    const double end = hn_clock_thread() + seconds;
    const double scale = d->goal->point >= 0 ? d->length : d->unit[d->goal->coordinate];
    for (*steps = 0; *steps < MAX_STEPS; (*steps)++) {
        if (d->distance <= REACHED * scale) {
            return HN_DRAG_REACHED;
        }
        if (hn_clock_thread() > end) {
            return HN_DRAG_TIME;
        }
        const outcome o = step(d);
        if (o != NEARER) {
            return d->distance <= REACHED * scale ? HN_DRAG_REACHED
                   : o == NOT_CLOSED              ? HN_DRAG_STUCK
                                                  : HN_DRAG_NEAREST;
        }
    }
    return HN_DRAG_TIME;
}

static hn_status drag_from(drag *d, double seconds, double *q, hn_drag_info *info) {
    HN_TRY(create(d));
    set_units(d);
    memcpy(d->q, q, (size_t)d->info.nq * sizeof *q);
    HN_TRY(hn_project_position(d->projector, d->t, d->q, CLOSED, NULL));

    // from the closed pose nearest to the one given
    d->distance = find_miss(d, d->q, d->miss);
    *info = (hn_drag_info){.distance_before = d->distance};
    info->end = walk(d, seconds, &info->steps);
    info->distance = d->distance;
    hn_eval_run(d->rows, d->t, d->q, NULL);
    info->gap = hn_norm2(d->info.nc, hn_eval_get(d->rows, HN_TERM_PHI));
    memcpy(q, d->q, (size_t)d->info.nq * sizeof *q);
    return HN_OK;
}

hn_status hn_drag(const hn_system *sys, double t, const hn_drag_goal *goal, double seconds,
                  double *q, hn_drag_info *info) {
    drag d = {.sys = sys,
              .goal = goal,
              .info = hn_system_get_info(sys),
              .arena = hn_arena_create(0),
              .t = t,
              .length = hn_system_length(sys),
              .damping = FIRST_DAMPING};
    if (!d.arena) {
        return HN_ERR_MEMORY;
    }
    const hn_status status = drag_from(&d, seconds, q, info);
    hn_projector_free(d.projector);
    hn_eval_free(d.points);
    hn_eval_free(d.rows);
    hn_arena_free(d.arena);
    return status;
}
