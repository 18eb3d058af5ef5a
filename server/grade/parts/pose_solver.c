// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/pose_solver.h"

#include "dynamics/assembly/mode.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/qr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ITERATIONS = 60, MAX_HALVINGS = 12 };
static const double CLOSED = 1e-11; // largest |phi| of a closed pose, in row units
static const double RANK = 1e-9;    // pivots of J below this, relative to the largest, count as 0
static const double LONGEST = 0.5;  // correction of one iteration, in units of reach

struct hn_pose_solver {
    const hn_system *sys;
    hn_arena *arena;
    hn_eval *eval;
    hn_qr qr;
    int n, nq, nc;
    double *q, *tried; ///< nq
    double *x;         ///< n, scene's coordinates of q
    double *reach;     ///< n
    double *unit;      ///< nc, of the rows
    double *rates;     ///< n x n: row k holds the system rates of a unit rate of coordinate k
    double *A;         ///< nc x n: J in the scene's rates times reach, divided by the row units
    double *b, *d, *v; ///< nc; n; n
    int *index;        ///< n: the coordinates that may move
};

static hn_status make(hn_pose_solver *s, const hn_model *model) {
    const hn_system_info info = hn_system_get_info(s->sys);
    const size_t n = (size_t)info.n_user, nc = (size_t)info.nc;
    s->n = info.n_user;
    s->nq = info.nq;
    s->nc = info.nc;
    s->q = hn_arena_doubles(s->arena, (size_t)info.nq + 1);
    s->tried = hn_arena_doubles(s->arena, (size_t)info.nq + 1);
    double *all = hn_arena_doubles(s->arena, 4 * n + 2 * nc + n * n + nc * n + 1);
    s->index = hn_arena_get(s->arena, (n + 1) * sizeof *s->index);
    if (!s->q || !s->tried || !all || !s->index ||
        !hn_qr_init(&s->qr, s->arena, s->n + 1, s->nc + 1)) {
        return HN_ERR_MEMORY;
    }
    double **const parts[] = {&s->x, &s->reach, &s->d, &s->v, &s->unit, &s->b, &s->rates, &s->A};
    const size_t sizes[] = {n, n, n, n, nc, nc, n * n, nc * n};
    for (int i = 0; i < 8; i++) {
        *parts[i] = all;
        all += sizes[i];
    }

    // scales, and the map of rates, which is constant
    const double length = hn_system_length(s->sys);
    for (int k = 0; k < s->n; k++) {
        const int c = hn_system_user_coordinate(s->sys, k);
        s->reach[k] = hn_model_scene(model)->coordinates[c].kind == HN_LENGTH ? length : 1;
        memset(s->v, 0, n * sizeof *s->v);
        s->v[k] = 1;
        hn_system_rates_from_user(s->sys, s->v, s->rates + (size_t)k * n);
    }
    for (int i = 0; i < s->nc; i++) {
        s->unit[i] = hn_system_row_unit(s->sys, i);
    }
    return hn_eval_create(s->sys, HN_TERM_PHI | HN_TERM_J | HN_TERM_POINTS, s->arena, &s->eval);
}

static void evaluate(hn_pose_solver *s) {
    hn_eval_run(s->eval, 0, s->q, NULL);
    hn_system_to_user(s->sys, s->q, s->x);
}

hn_status hn_pose_solver_create(const hn_model *model, hn_pose_solver **out) {
    hn_arena *arena = hn_arena_create(0);
    hn_pose_solver *s = arena ? hn_arena_get(arena, sizeof *s) : NULL;
    *out = NULL;
    if (!s) {
        hn_arena_free(arena);
        return HN_ERR_MEMORY;
    }
    *s = (hn_pose_solver){.sys = hn_model_system(model), .arena = arena};
    const hn_status status = make(s, model);
    if (status != HN_OK) {
        hn_pose_solver_free(s);
        return status;
    }
    memcpy(s->q, hn_model_q(model), (size_t)s->nq * sizeof *s->q);
    evaluate(s);
    *out = s;
    return HN_OK;
}

void hn_pose_solver_free(hn_pose_solver *s) {
    if (s) {
        hn_eval_free(s->eval);
        hn_arena_free(s->arena);
    }
}

int hn_pose_solver_count(const hn_pose_solver *s) {
    return s->n;
}

const double *hn_pose_solver_coordinates(const hn_pose_solver *s) {
    return s->x;
}

const double *hn_pose_solver_points(const hn_pose_solver *s) {
    return hn_eval_get(s->eval, HN_TERM_POINTS);
}

double hn_pose_solver_reach(const hn_pose_solver *s, int coordinate) {
    return s->reach[coordinate];
}

/// Largest |phi|, each row divided by its unit; HUGE_VAL where it is not finite.
static double measure(const hn_pose_solver *s) {
    const double *phi = hn_eval_get(s->eval, HN_TERM_PHI);
    double worst = 0;
    for (int i = 0; i < s->nc; i++) {
        const double size = fabs(phi[i]) / s->unit[i];
        worst = isfinite(size) ? fmax(worst, size) : HUGE_VAL;
    }
    return worst;
}

double hn_pose_solver_gap(const hn_pose_solver *s) {
    return measure(s);
}

double hn_pose_solver_open(const hn_pose_solver *s) {
    const double *phi = hn_eval_get(s->eval, HN_TERM_PHI);
    double sum = 0;
    for (int i = 0; i < s->nc; i++) {
        sum = hypot(sum, phi[i]);
    }
    return sum;
}

void hn_pose_solver_place(hn_pose_solver *s, const double *coordinates) {
    hn_system_from_user(s->sys, coordinates, s->q);
    evaluate(s);
}

/// J in the scene's rates, columns times reach, rows divided by their units.
static void scale_rows(hn_pose_solver *s) {
    const double *J = hn_eval_get(s->eval, HN_TERM_J);
    for (int i = 0; i < s->nc; i++) {
        for (int k = 0; k < s->n; k++) {
            double sum = 0;
            for (int j = 0; j < s->n; j++) {
                sum += J[(size_t)i * (size_t)s->n + (size_t)j] *
                       s->rates[(size_t)k * (size_t)s->n + (size_t)j];
            }
            s->A[(size_t)i * (size_t)s->n + (size_t)k] = sum * s->reach[k] / s->unit[i];
        }
    }
}

/// Factors the columns of A that may move; returns how many these are.
static int factor(hn_pose_solver *s, const bool *held) {
    int m = 0;
    scale_rows(s);
    for (int k = 0; k < s->n; k++) {
        if (!held || !held[k]) {
            s->index[m++] = k;
        }
    }
    for (int i = 0; i < s->nc; i++) {
        for (int k = 0; k < m; k++) {
            s->qr.a[(size_t)i * (size_t)m + (size_t)k] =
                s->A[(size_t)i * (size_t)s->n + (size_t)s->index[k]];
        }
    }
    hn_qr_factor(&s->qr, m, s->nc, RANK);
    return m;
}

/// Moves from `s->tried` by a share of the correction.
static void move(hn_pose_solver *s, int m, double share) {
    memset(s->v, 0, (size_t)s->n * sizeof *s->v);
    for (int k = 0; k < m; k++) {
        const int c = s->index[k];
        for (int j = 0; j < s->n; j++) {
            s->v[j] +=
                share * s->d[k] * s->reach[c] * s->rates[(size_t)c * (size_t)s->n + (size_t)j];
        }
    }
    memcpy(s->q, s->tried, (size_t)s->nq * sizeof *s->q);
    hn_system_move(s->sys, s->q, s->v);
    evaluate(s);
}

/// One iteration: false where no shorter correction makes the gap smaller.
static bool correct(hn_pose_solver *s, const bool *held) {
    const double before = measure(s), *phi = hn_eval_get(s->eval, HN_TERM_PHI);
    const int m = factor(s, held);
    double longest = 0;
    for (int i = 0; i < s->nc; i++) {
        s->b[i] = -phi[i] / s->unit[i];
    }
    hn_qr_least_norm(&s->qr, s->b, s->d);
    for (int k = 0; k < m; k++) {
        longest = fmax(longest, fabs(s->d[k]));
    }

    // cut, then halved
    double share = longest > LONGEST ? LONGEST / longest : 1;
    memcpy(s->tried, s->q, (size_t)s->nq * sizeof *s->q);
    for (int i = 0; i < MAX_HALVINGS; i++, share /= 2) {
        move(s, m, share);
        if (measure(s) < before) {
            return true;
        }
    }
    move(s, m, 0);
    return false;
}

hn_status hn_pose_solver_close(hn_pose_solver *s, const bool *held) {
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        if (measure(s) <= CLOSED) {
            return HN_OK;
        }
        if (!isfinite(measure(s)) || !correct(s, held)) {
            break;
        }
    }
    return measure(s) <= CLOSED ? HN_OK : HN_ERR_UNREACHABLE;
}

int hn_pose_solver_direction(hn_pose_solver *s, double *direction) {
    const int m = factor(s, NULL), freedoms = m - s->qr.rank;
    if (freedoms != 1) {
        return freedoms;
    }

    // the last column of Q is orthogonal to all rows
    memset(direction, 0, (size_t)s->n * sizeof *direction);
    direction[m - 1] = 1;
    hn_qr_apply_q(&s->qr, direction);
    return freedoms;
}

bool hn_pose_solver_same_modes(const hn_pose_solver *s, const double *one, const double *other) {
    hn_mode_watch *watch = NULL;
    hn_arena *arena = hn_arena_create(0);
    double *q = arena ? hn_arena_doubles(arena, (size_t)s->nq + 1) : NULL;
    bool same = true;
    if (q && hn_mode_watch_create(s->sys, arena, &watch) == HN_OK) {
        const int n = hn_mode_watch_count(watch);
        double *values = hn_arena_doubles(arena, 2 * (size_t)n + 1);
        for (int k = 0; k < 2 && values; k++) {
            hn_system_from_user(s->sys, k ? other : one, q);
            hn_mode_watch_values(watch, 0, q, values + (size_t)k * (size_t)n);
        }
        for (int i = 0; i < n && values; i++) {
            same &= hn_mode_sign(values[i]) == hn_mode_sign(values[n + i]);
        }
    }
    hn_mode_watch_free(watch);
    hn_arena_free(arena);
    return same;
}
