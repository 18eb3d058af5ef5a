// SPDX-License-Identifier: GPL-3.0-or-later

#include "dynamics/assembly/assemble_position.h"

#include "dynamics/assembly/assemble_pose.h"
#include "dynamics/assembly/assemble_rows.h"
#include "linalg/dense.h"
#include "linalg/qr.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

static const double CLOSED = 1e-12;     // scaled |phi| that counts as closed
static const double ROUNDING = 2e-15;   // per sqrt(nc): no more to gain
static const double NEWTON_FROM = 1e-2; // scaled |phi| below which Newton takes over
static const double STATIONARY = 1e-10; // |J' r| / (|J| |r|): a minimum that does not close
static const double ANGLE_CAP = 0.5;    // largest step [rad]
static const double LENGTH_CAP = 0.2;   // largest step of a length, in characteristic lengths
static const double RANK_TOL = 1e-9;
enum {
    MAX_ITERATIONS = 100,
    MAX_HOMOTOPY_STEPS = 60,
    MAX_CORRECTIONS = 8,
    RANDOM_STARTS = 8,
    FLIPPED_STARTS = 40
};

/// Scratch of the search, all in scaled free coordinates z.
struct hn_assemble_search {
    hn_assembler *s;
    int n, nc;
    double *J;                         // nc x n, scaled
    double *goal;                      // nc: the residual aimed at; 0 but during homotopy
    double *A, *g;                     // J'J + mu I, J' r
    hn_assemble_rows *rows;            // of a large mechanism; J, A and qr are not used then
    double *step, *start, *r, *change; // change: J dz
    double *delta;                     // n of all user coordinates, unscaled
    double *best_x, best_size;
    int damped; // damped steps taken
    hn_qr qr;
};
typedef struct hn_assemble_search search;

static hn_status search_init(search *w, hn_assembler *s) {
    size_t n = (size_t)s->n_free, nc = (size_t)s->nc;
    *w = (search){.s = s, .n = s->n_free, .nc = s->nc, .best_size = HUGE_VAL};
    w->g = hn_arena_doubles(s->arena, n);
    w->step = hn_arena_doubles(s->arena, (size_t)s->n);
    w->delta = hn_arena_doubles(s->arena, (size_t)s->n);
    w->start = hn_arena_doubles(s->arena, (size_t)s->n);
    w->best_x = hn_arena_doubles(s->arena, (size_t)s->n);
    w->goal = hn_arena_doubles(s->arena, nc);
    w->r = hn_arena_doubles(s->arena, nc);
    w->change = hn_arena_doubles(s->arena, nc);
    if (hn_assemble_is_large(s)) {
        HN_TRY(hn_assemble_rows_create(s, s->n_free, s->free, &w->rows));
    }

    // the dense matrices where they are used
    if (!w->rows) {
        w->J = hn_arena_doubles(s->arena, nc * n);
        w->A = hn_arena_doubles(s->arena, n * n);
        if (!hn_qr_init(&w->qr, s->arena, s->n_free, s->nc)) {
            return HN_ERR_MEMORY;
        }
    }
    return hn_arena_failed(s->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// Evaluates at s->x and sets w->r = residual - goal. Returns |r|, HUGE_VAL when not finite.
static double evaluate(search *w) {
    if (!hn_assemble_evaluate(w->s)) {
        return HUGE_VAL;
    }
    for (int i = 0; i < w->nc; i++) {
        w->r[i] = w->s->residual[i] - w->goal[i];
    }
    return hn_norm2(w->nc, w->r);
}

static void keep_best(search *w) {
    if (w->s->size < w->best_size) {
        w->best_size = w->s->size;
        memcpy(w->best_x, w->s->x, (size_t)w->s->n * sizeof *w->best_x);
    }
}

/// The scaled J of the free coordinates where s->eval was last run.
static void fill_jacobian(search *w) {
    hn_assembler *s = w->s;
    if (w->rows) {
        hn_assemble_rows_fill(w->rows, s->row_scale);
        return;
    }
    for (int i = 0; i < w->nc; i++) {
        hn_assemble_user_row(s, i, w->step);
        for (int k = 0; k < w->n; k++) {
            w->J[(size_t)i * w->n + k] =
                s->row_scale[i] * w->step[s->free[k]] * s->reach[s->free[k]];
        }
    }
}

/// Shortens the step so that no coordinate moves further than it may.
static void cap_step(search *w) {
    double factor = 1;
    for (int k = 0; k < w->n; k++) {
        hn_unit_kind kind =
            w->s->scene->coordinates[hn_system_user_coordinate(w->s->sys, w->s->free[k])].kind;
        double cap = kind == HN_LENGTH ? LENGTH_CAP : ANGLE_CAP;
        if (fabs(w->step[k]) * factor > cap) {
            factor = cap / fabs(w->step[k]);
        }
    }
    for (int k = 0; k < w->n; k++) {
        w->step[k] *= factor;
    }
}

static void save_start(search *w) {
    memcpy(w->start, w->s->x, (size_t)w->s->n * sizeof *w->start);
}

static void move_from_start(search *w) {
    hn_assembler *s = w->s;
    for (int k = 0; k < w->n; k++) {
        w->delta[s->free[k]] = s->reach[s->free[k]] * w->step[k];
    }
    memcpy(s->x, w->start, (size_t)s->n * sizeof *s->x);
    hn_assemble_move(s, s->x, w->delta);
}

/// Back to w->start, with everything evaluated there.
static double go_back(search *w) {
    memcpy(w->s->x, w->start, (size_t)w->s->n * sizeof *w->start);
    return evaluate(w);
}

/// dz = -J^+ r. Returns false where the rows of a large mechanism depend on each other: damped
/// steps serve those.
static bool find_newton_step(search *w) {
    fill_jacobian(w);
    if (w->rows) {
        return hn_assemble_rows_step(w->rows, w->r, 0, w->step) == HN_OK;
    }
    memcpy(w->qr.a, w->J, (size_t)w->nc * w->n * sizeof *w->J);
    hn_qr_factor(&w->qr, w->n, w->nc, RANK_TOL);
    hn_qr_least_norm(&w->qr, w->r, w->step);
    for (int k = 0; k < w->n; k++) {
        w->step[k] = -w->step[k];
    }
    return true;
}

/// One least-norm Newton step. Returns the new |r|, or a negative number when it did not pay (x is
/// then as before).
static double newton_step(search *w, double size) {
    if (!find_newton_step(w)) {
        return -1;
    }
    cap_step(w);
    save_start(w);
    move_from_start(w);
    double reached = evaluate(w);
    w->s->iterations++;
    if (reached < 0.9 * size) {
        return reached;
    }
    (void)go_back(w);
    return -1;
}

/// g = J' r, and where that is dense A = J'J; returns the largest diagonal entry of J'J (dense) or
/// J J'. Rows of J are mostly zero, so they are walked one by one.
static double fill_normal_equations(search *w) {
    int n = w->n;
    if (w->rows) {
        hn_assemble_rows_gradient(w->rows, w->r, w->g);
        return hn_assemble_rows_largest(w->rows);
    }
    memset(w->A, 0, (size_t)n * n * sizeof *w->A);
    memset(w->g, 0, (size_t)n * sizeof *w->g);
    for (int i = 0; i < w->nc; i++) {
        const double *row = w->J + (size_t)i * n;
        hn_axpy(n, w->r[i], row, w->g);
        for (int k = 0; k < n; k++) {
            if (row[k] != 0) {
                hn_axpy(k + 1, row[k], row, w->A + (size_t)k * n);
            }
        }
    }
    double largest = 0;
    for (int k = 0; k < n; k++) {
        largest = fmax(largest, w->A[(size_t)k * n + k]);
    }
    return largest;
}

static double jacobian_size(const search *w) {
    return w->rows ? hn_assemble_rows_size(w->rows) : hn_norm2(w->nc * w->n, w->J);
}

/// |r|^2 - |r + J dz|^2, what the linear model promises.
static double predicted_gain(const search *w) {
    double gain = 0;
    if (w->rows) {
        hn_assemble_rows_change(w->rows, w->step, w->change);
    }
    for (int i = 0; i < w->nc; i++) {
        double change = w->rows ? w->change[i] : hn_dot(w->n, w->J + (size_t)i * w->n, w->step);
        gain -= change * (2 * w->r[i] + change);
    }
    return gain;
}

/// (J'J + mu I) dz = -J' r, either way. A dense factor overwrites A.
static hn_status find_damped_step(search *w, double mu) {
    if (w->rows) {
        return hn_assemble_rows_step(w->rows, w->r, mu, w->step);
    }
    for (int k = 0; k < w->n; k++) {
        w->A[(size_t)k * w->n + k] += mu;
        w->step[k] = -w->g[k];
    }
    HN_TRY(hn_cholesky(w->n, w->A, w->n, 0));
    hn_cholesky_solve(w->n, w->A, w->n, w->step);
    return HN_OK;
}

/// One damped step (J'J + mu I) dz = -J' r with damping *mu (0: to be chosen), which follows the
/// gain ratio. Returns the new |r|, or a negative number at a stationary point (x is then as
/// before).
static double damped_step(search *w, double size, double *mu) {
    fill_jacobian(w);

    // a stationary point of |r| ends the descent
    double largest = fill_normal_equations(w);
    double steepness = hn_norm2(w->n, w->g) / (jacobian_size(w) * size);
    if (!(steepness > STATIONARY) || largest == 0) {
        return -1;
    }
    if (*mu == 0) {
        *mu = 1e-3 * largest;
    }

    // more damping until a step pays
    save_start(w);
    for (int attempt = 0; attempt < 40; attempt++) {
        if (find_damped_step(w, *mu) == HN_OK) {
            cap_step(w);
            double predicted = predicted_gain(w);
            move_from_start(w);
            w->s->iterations++;
            double reached = evaluate(w), gain = (size - reached) * (size + reached) / predicted;
            if (reached < size && gain > 1e-4) {
                w->damped++;
                *mu *= gain > 0.75 ? 1.0 / 3 : (gain < 0.25 ? 2 : 1);
                return reached;
            }
        }
        // once more from the same place: the factor has overwritten A
        *mu *= 4;
        (void)go_back(w);
        (void)fill_normal_equations(w);
    }
    return -1;
}

/// Minimises |r| from s->x. Returns 1 when it went below `tol`; then goes on as long as Newton
/// gains.
static bool descend(search *w, double tol, int max_iterations) {
    double size = evaluate(w), mu = 0, floor_size = ROUNDING * sqrt(w->nc);

    if (!isfinite(size)) {
        return false;
    }

    // Newton near the end, damped steps elsewhere, until neither gains
    for (int it = 0; it < max_iterations && size > floor_size; it++) {
        double next = -1;
        if (size < NEWTON_FROM) {
            next = newton_step(w, size);
        }

        if (next < 0 && size <= tol) {
            break;
        }
        if (next < 0) {
            next = damped_step(w, size, &mu);
        }
        if (next < 0) {
            break;
        }
        size = next;
    }
    return size <= tol;
}

/// Follows phi(z) = (1 - s) phi(z_guess) from s = 0, where the guess solves it, to s = 1. Returns 1
/// when it arrived.
static bool follow_homotopy(search *w) {
    hn_assembler *s = w->s;
    double at = 0, stride = 0.1;

    // from the guess, where the shifted problem is solved
    memcpy(s->x, s->guess, (size_t)s->n * sizeof *s->x);
    memset(w->goal, 0, (size_t)w->nc * sizeof *w->goal);
    (void)evaluate(w);

    double *from = hn_arena_doubles(s->arena, (size_t)w->nc),
           *last = hn_arena_doubles(s->arena, (size_t)s->n);
    if (!from || !last) {
        return false;
    }
    memcpy(from, s->residual, (size_t)w->nc * sizeof *from);

    // each stretch corrected by Newton; the stride follows its success
    for (int step = 0; step < MAX_HOMOTOPY_STEPS && at < 1 && stride > 1e-4; step++) {
        double to = fmin(1, at + stride);
        for (int i = 0; i < w->nc; i++) {
            w->goal[i] = (1 - to) * from[i];
        }
        memcpy(last, s->x, (size_t)s->n * sizeof *last);
        double size = evaluate(w);
        for (int k = 0; k < MAX_CORRECTIONS && size > 1e-9 && size >= 0; k++) {
            size = newton_step(w, size);
        }
        if (size >= 0 && size <= 1e-9) {
            at = to;
            stride *= 1.5;
        } else {
            memcpy(s->x, last, (size_t)s->n * sizeof *last);
            stride /= 2;
        }
    }

    // the true problem again
    memset(w->goal, 0, (size_t)w->nc * sizeof *w->goal);
    return at >= 1;
}

/// SplitMix64 (Steele, Lea & Flood 2014): the same starts on every machine.
double hn_assemble_random(uint64_t *seed) {
    uint64_t z = (*seed += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1; // [-1, 1)
}

/// Descends from random places around the guess, further and further away.
static bool try_random_starts(search *w) {
    hn_assembler *s = w->s;
    uint64_t seed = 20;
    int starts = RANDOM_STARTS;
    for (int k = 1; k <= starts; k++) {
        // 2 rad, or two characteristic lengths, at most; half a turn where it closes, but the wrong
        // way round
        double spread = fmin(2.0 * k / RANDOM_STARTS, starts > RANDOM_STARTS ? M_PI : 2);

        memcpy(s->x, s->guess, (size_t)s->n * sizeof *s->x);
        for (int i = 0; i < w->n; i++) {
            w->delta[s->free[i]] = spread * s->reach[s->free[i]] * hn_assemble_random(&seed);
        }
        hn_assemble_move(s, s->x, w->delta);

        // a pose that is closed the right way round ends it
        int closed = descend(w, CLOSED, MAX_ITERATIONS);
        keep_best(w);
        if (closed && hn_assemble_flipped(s) < 0) {
            return true;
        }
        starts = closed ? FLIPPED_STARTS : starts;
    }
    return false;
}

hn_status hn_assemble_search_create(hn_assembler *s, hn_assemble_search **out) {
    *out = hn_arena_get(s->arena, sizeof **out);
    return *out ? search_init(*out, s) : HN_ERR_MEMORY;
}

bool hn_assemble_descend(hn_assemble_search *w) {
    return descend(w, CLOSED, MAX_ITERATIONS) && hn_assemble_flipped(w->s) < 0;
}

hn_status hn_assemble_position(hn_assembler *s) {
    s->route = "already closed";
    s->iterations = 0;

    if (!hn_assemble_evaluate(s)) {
        return HN_ERR_DIVERGED;
    }
    if (s->size <= ROUNDING * sqrt(s->nc) && hn_assemble_flipped(s) < 0) {
        return HN_OK;
    }

    // from the guess, downhill
    search w;
    if (search_init(&w, s) != HN_OK) {
        return HN_ERR_MEMORY;
    }
    int was_closed = s->size <= CLOSED;
    if (descend(&w, CLOSED, MAX_ITERATIONS) && hn_assemble_flipped(s) < 0) {
        s->route = was_closed ? "already closed" : (w.damped ? "levenberg-marquardt" : "newton");
        return HN_OK;
    }
    keep_best(&w);

    // then along a homotopy, then from random places
    s->route = "homotopy";
    int closed =
        follow_homotopy(&w) && descend(&w, CLOSED, MAX_ITERATIONS) && hn_assemble_flipped(s) < 0;
    keep_best(&w);

    if (!closed) {
        s->route = "multi-start";
        closed = try_random_starts(&w);
    }
    if (closed) {
        return HN_OK;
    }

    // the best pose found, for the report
    memcpy(s->x, w.best_x, (size_t)s->n * sizeof *s->x);
    (void)hn_assemble_evaluate(s);
    return HN_ERR_UNREACHABLE;
}
