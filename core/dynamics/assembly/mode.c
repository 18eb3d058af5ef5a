// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/mode.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/rate_tree.h"
#include "dynamics/compile/system_impl.h"
#include "expr/construct.h"
#include "expr/tape.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MAX_ROWS = 6 }; // a spatial loop has at most six

/// The tape of some loops one behind the other: (q, t) -> J_d of each, size[k] x size[k].
typedef struct loop_tape {
    hn_tape *tape;
    int n, *size; ///< loops; rows and columns of each J_d, 0: no mode
    double *work, *det;
} loop_tape;

struct hn_mode_watch {
    int nq, n_loops;
    double *in;
    loop_tape first, others; // the first is looked at after every step of a run
};

/// One loop: its rows, and the user coordinates that depend on the others, in order.
typedef struct loop_parts {
    int n_rows, rows[MAX_ROWS];
    int n_dependent, dependent[MAX_ROWS];
    int n_coordinates; ///< all that move the loop
    int independent;   ///< the one taken last
} loop_parts;

/// Common data of finding the parts of all loops.
typedef struct finder {
    const hn_system *sys;
    int n_user;
    hn_rate_tree rates;       ///< what velocities a unit rate of a user coordinate stands for
    int *start;               ///< per row of J, its first entry; nc + 1
    int *moves, *coordinates; ///< n_user each
    int *tried;               ///< n_user: the last row that a coordinate was tried with, plus 1
    char *taken;              ///< nc: the row belongs to a loop already (formulas only)
} finder;

/// Row `row` of J times a unit rate of a user coordinate.
static hn_ex row_times(const finder *f, int row, int user) {
    hn_ex sum = hn_num(0);
    for (int k = f->start[row]; k < f->start[row + 1]; k++) {
        const hn_entry *J = &f->sys->J.at[k];
        const double unit = hn_rate_tree_share(&f->rates, J->col, user);
        if (unit != 0) {
            sum = hn_add(f->sys->g, sum, hn_scale(unit, J->e));
        }
    }
    return sum;
}

static bool row_moves_with(const finder *f, int row, int user) {
    return !hn_is_zero(row_times(f, row, user));
}

/// Returns how willingly a coordinate is taken as independent: a motor first, then what the user
/// holds.
static int willingness(const hn_coordinate *c) {
    return 4 * (c->actuated != 0) + 2 * (c->q0_pinned != 0) + (c->v0_pinned != 0);
}

/// Takes the most willing coordinates (the first of equals) as independent until as many are left
/// as there are rows.
static void choose_dependent(const hn_system *sys, int *coordinates, loop_parts *parts) {
    const hn_scene *scene = hn_system_scene(sys);
    int n = parts->n_coordinates;

    // independent: the most willing ones
    for (int spare = n - parts->n_rows; spare > 0; spare--) {
        int best = -1, most = -1;
        for (int i = 0; i < n; i++) {
            if (coordinates[i] < 0) {
                continue;
            }
            int will =
                willingness(&scene->coordinates[hn_system_user_coordinate(sys, coordinates[i])]);
            if (will > most) {
                most = will;
                best = i;
            }
        }

        parts->independent = coordinates[best];
        coordinates[best] = -1;
    }

    // dependent: the rest
    for (int i = 0; i < n; i++) {
        if (coordinates[i] >= 0) {
            parts->dependent[parts->n_dependent++] = coordinates[i];
        }
    }
}

/// Returns where the joint of a coordinate stands on the way round a loop: out along the bodies
/// that carry the cut joint's parent (from the ground on), then along those that carry its child.
/// The order of scene formulas is kept.
static int place_in_ring(const hn_system *sys, int loop, int user) {
    const hn_scene *scene = hn_system_scene(sys);
    int coordinate = hn_system_user_coordinate(sys, user);
    int cut = scene->is_lagrangian ? -1 : hn_system_loop_joint(sys, loop);
    if (cut < 0) {
        return user;
    }

    // out along the parent's side, then along the child's
    const int ends[2] = {scene->joints[cut].parent, scene->joints[cut].child};
    for (int side = 0; side < 2; side++) {
        int above = -1; // bodies between the cut joint and the one that this coordinate moves
        for (int body = ends[side], n = 0; body != HN_GROUND; n++) {
            const hn_joint *joint = &scene->joints[hn_system_tree_joint(sys, body)];
            const int part = coordinate - joint->coordinate;
            above = part >= 0 && part < joint->n_coordinates ? n : above;
            body = joint->child == body ? joint->parent : joint->child;
        }
        if (above >= 0) {
            return 2 * scene->n_bodies * side + scene->n_bodies - above;
        }
    }
    return user;
}

/// Dependent coordinates in the order of the ring, which gives det J_d its sign whatever order the
/// scene lists them in.
static void sort_dependent(const hn_system *sys, int loop, loop_parts *parts) {
    for (int i = 1; i < parts->n_dependent; i++) {
        int keep = parts->dependent[i], place = place_in_ring(sys, loop, keep), j = i;
        for (; j > 0 && place_in_ring(sys, loop, parts->dependent[j - 1]) > place; j--) {
            parts->dependent[j] = parts->dependent[j - 1];
        }
        parts->dependent[j] = keep;
    }
}

static hn_status finder_init(finder *f, const hn_system *sys, hn_arena *arena) {
    const size_t n = (size_t)sys->nv, nc = (size_t)sys->nc;
    *f = (finder){.sys = sys, .n_user = sys->nv};
    f->moves = hn_arena_ints(arena, n);
    f->tried = hn_arena_ints(arena, n);
    f->coordinates = hn_arena_ints(arena, n);
    f->start = hn_arena_ints(arena, nc + 1);
    f->taken = hn_arena_get(arena, nc + 1);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(hn_rate_tree_init(&f->rates, sys, arena));

    // where each row of J starts
    for (int k = 0; k < sys->J.n; k++) {
        f->start[sys->J.at[k].row + 1] = k + 1;
    }
    for (int i = 0; i < sys->nc; i++) { // a row without entries starts where the last one ended
        f->start[i + 1] = f->start[i + 1] > f->start[i] ? f->start[i + 1] : f->start[i];
    }
    return HN_OK;
}

/// A scene of formulas does not say which rows make up one loop: there, these are the rows that
/// depend on the same coordinates as the first that is left (its set stands in f->moves).
static bool is_in_loop(const finder *f, int row, int loop) {
    if (!f->sys->scene->is_lagrangian) {
        return hn_system_row_loop(f->sys, row) == loop;
    }
    for (int k = 0; k < f->n_user && !f->taken[row]; k++) {
        if (row_moves_with(f, row, k) != f->moves[k]) {
            return false;
        }
    }
    return !f->taken[row];
}

/// f->moves[k] becomes 1 for each user coordinate that moves the row: of the velocities of its
/// entries, and what they are counted from.
static void mark_moving(finder *f, int row) {
    for (int e = f->start[row]; e < f->start[row + 1]; e++) {
        for (int k = f->sys->J.at[e].col; k >= 0 && f->tried[k] != row + 1; k = f->rates.base[k]) {
            f->tried[k] = row + 1;
            f->moves[k] |= row_moves_with(f, row, k);
        }
    }
}

/// Rows of the loop into parts; f->moves[k] becomes 1 for each user coordinate that moves one. 0
/// when it has none, or too many.
static bool find_rows(finder *f, int loop, loop_parts *parts) {
    int left = 0;
    while (left < f->sys->nc && f->taken[left]) {
        left++;
    }

    // what moves the first row that is left (formulas only)
    for (int k = 0; k < f->n_user; k++) {
        f->tried[k] = 0;
        f->moves[k] =
            f->sys->scene->is_lagrangian && left < f->sys->nc && row_moves_with(f, left, k);
    }

    // the rows of the loop
    for (int i = 0; i < f->sys->nc; i++) {
        if (!is_in_loop(f, i, loop)) {
            continue;
        }
        f->taken[i] = 1;
        if (parts->n_rows == MAX_ROWS) {
            return false;
        }
        parts->rows[parts->n_rows++] = i;
    }

    // and all that moves them
    for (int r = 0; r < parts->n_rows; r++) {
        mark_moving(f, parts->rows[r]);
    }
    return parts->n_rows > 0;
}

/// Fills `parts`; n_dependent stays 0 when the loop has fewer coordinates than rows (over-closed)
/// or there is none.
static void find_parts(finder *f, int loop, loop_parts *parts) {
    *parts = (loop_parts){0};
    if (!find_rows(f, loop, parts)) {
        return;
    }
    for (int k = 0; k < f->n_user; k++) {
        if (f->moves[k]) {
            f->coordinates[parts->n_coordinates++] = k;
        }
    }
    if (parts->n_coordinates >= parts->n_rows) {
        choose_dependent(f->sys, f->coordinates, parts);
        sort_dependent(f->sys, loop, parts);
    }
}

static hn_status compile_loops(const finder *f, hn_arena *arena, const loop_parts *parts, int n,
                               loop_tape *out) {
    const hn_system *sys = f->sys;
    size_t total = 0;
    out->size = hn_arena_ints(arena, (size_t)n);
    int *symbols = hn_arena_ints(arena, (size_t)sys->nq + 1);
    hn_ex *entries = hn_arena_get(arena, (size_t)n * MAX_ROWS * MAX_ROWS * sizeof *entries);
    if (!out->size || !symbols || !entries) {
        return HN_ERR_MEMORY;
    }

    // the entries of every J_d, one behind the other
    out->n = n;
    for (int k = 0; k < n; k++) {
        const int size = out->size[k] = parts[k].n_dependent;
        for (int r = 0; r < size; r++) {
            for (int c = 0; c < size; c++) {
                entries[total++] = row_times(f, parts[k].rows[r], parts[k].dependent[c]);
            }
        }
    }

    if (total == 0) {
        return HN_OK;
    }

    // a tape of (q, t)
    memcpy(symbols, sys->q_symbols, (size_t)sys->nq * sizeof *symbols);
    symbols[sys->nq] = sys->t_symbol;
    HN_TRY(hn_tape_compile(sys->g, entries, (int)total, symbols, sys->nq + 1, &out->tape));
    out->det = hn_arena_doubles(arena, total);
    out->work = hn_arena_doubles(arena, hn_tape_work_size(out->tape));
    if (!out->det || !out->work) {
        return HN_ERR_MEMORY;
    }
    hn_tape_prepare(out->tape, out->work);
    return HN_OK;
}

static hn_status build_watch(const hn_system *sys, hn_arena *arena, hn_mode_watch *w) {
    finder f;
    hn_status status = finder_init(&f, sys, arena);
    loop_parts *parts = hn_arena_get(arena, (size_t)sys->n_loops * sizeof *parts);
    w->in = hn_arena_doubles(arena, (size_t)sys->nq + 1);
    if (status != HN_OK || !parts || !w->in) {
        return HN_ERR_MEMORY;
    }

    // the parts of every loop
    w->nq = sys->nq;
    for (int loop = 0; loop < sys->n_loops; loop++) {
        find_parts(&f, loop, &parts[loop]);
        if (sys->scene->is_lagrangian && parts[loop].n_rows == 0) {
            break; // all constraints belong to the loops found so far
        }
        w->n_loops++;
    }

    // the first loop has a tape of its own: it is checked after every step
    if (w->n_loops > 0) {
        status = compile_loops(&f, arena, parts, 1, &w->first);
    }
    if (status == HN_OK && w->n_loops > 1) {
        status = compile_loops(&f, arena, parts + 1, w->n_loops - 1, &w->others);
    }
    return status;
}

hn_status hn_mode_watch_create(const hn_system *sys, hn_arena *arena, hn_mode_watch **out) {
    hn_mode_watch *w = hn_arena_get(arena, sizeof *w);
    if (!w) {
        return HN_ERR_MEMORY;
    }
    const hn_status status = build_watch(sys, arena, w);
    if (status != HN_OK) {
        hn_mode_watch_free(w);
        return status;
    }
    *out = w;
    return HN_OK;
}

void hn_mode_watch_free(hn_mode_watch *w) {
    if (w) {
        hn_tape_free(w->first.tape);
        hn_tape_free(w->others.tape);
        w->first.tape = w->others.tape = NULL;
    }
}

int hn_mode_watch_count(const hn_mode_watch *w) {
    return w->n_loops;
}

/// Determinant of a small n x n matrix by elimination with row pivoting; the matrix is spoiled.
static double determinant(int n, double *a) {
    double det = 1;
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) {
            best = fabs(a[i * n + k]) > fabs(a[best * n + k]) ? i : best;
        }
        if (a[best * n + k] == 0) {
            return 0;
        }

        // the largest pivot of the column, rows swapped
        if (best != k) {
            for (int j = 0; j < n; j++) {
                double keep = a[k * n + j];
                a[k * n + j] = a[best * n + j];
                a[best * n + j] = keep;
            }
            det = -det;
        }

        // eliminate below it
        det *= a[k * n + k];
        for (int i = k + 1; i < n; i++) {
            hn_axpy(n - k, -a[i * n + k] / a[k * n + k], a + k * n + k, a + i * n + k);
        }
    }
    return det;
}

/// -det over the product of the column lengths of one J_d, which is spoiled.
static double mode_of(int n, double *a) {
    double lengths = 1;
    for (int c = 0; c < n; c++) {
        double square = 0;
        for (int r = 0; r < n; r++) {
            square += a[r * n + c] * a[r * n + c];
        }
        lengths *= sqrt(square);
    }
    const double det = n > 0 ? determinant(n, a) : 0;
    return lengths > 0 && isfinite(det) ? -det / lengths : 0;
}

static void eval_loops(hn_mode_watch *w, loop_tape *loops, double t, const double *q,
                       double *values) {
    if (loops->tape) {
        memcpy(w->in, q, (size_t)w->nq * sizeof *q);
        w->in[w->nq] = t;
        hn_tape_eval(loops->tape, w->in, loops->det, loops->work);
    }
    for (int k = 0, at = 0; k < loops->n; k++) {
        const int n = loops->size[k];
        values[k] = n > 0 ? mode_of(n, loops->det + at) : 0;
        at += n * n;
    }
}

double hn_mode_watch_value(hn_mode_watch *w, double t, const double *q) {
    double value = 0;
    eval_loops(w, &w->first, t, q, &value);
    return value;
}

void hn_mode_watch_values(hn_mode_watch *w, double t, const double *q, double *values) {
    if (w->n_loops > 0) {
        eval_loops(w, &w->first, t, q, values);
        eval_loops(w, &w->others, t, q, values + 1);
    }
}

/// Below this |-det J_d| in units of its columns is rounding, not a mode.
static const double MODE_ZERO = 1e-12;

int hn_mode_sign(double value) {
    return value > MODE_ZERO ? 1 : (value < -MODE_ZERO ? -1 : 0);
}

hn_status hn_mode_dependent(const hn_system *sys, hn_arena *arena, int loop, int *dependent,
                            int *n) {
    finder f;
    loop_parts parts = {0};
    *n = 0;
    HN_TRY(finder_init(&f, sys, arena));
    for (int k = 0; k <= loop; k++) { // formulas: each takes its rows away
        if (k == loop || sys->scene->is_lagrangian) {
            find_parts(&f, k, &parts);
        }
    }
    *n = parts.n_dependent;
    memcpy(dependent, parts.dependent, (size_t)*n * sizeof *dependent);
    return HN_OK;
}

hn_status hn_mode_is_four_bar(const hn_system *sys, hn_arena *arena, int *out) {
    const hn_scene *scene = hn_system_scene(sys);
    finder f;
    loop_parts parts = {0};
    *out = 0;
    HN_TRY(finder_init(&f, sys, arena));
    if (sys->n_loops > 0) {
        find_parts(&f, 0, &parts);
    }

    // two rows and three coordinates
    if (parts.n_rows != 2 || parts.n_coordinates != 3) {
        return HN_OK;
    }

    // all angles, about axes of the same sense
    const int users[3] = {parts.independent, parts.dependent[0], parts.dependent[1]};
    const hn_joint *first = NULL;
    for (int c = 0; c < 3; c++) {
        const hn_coordinate *k = &scene->coordinates[hn_system_user_coordinate(sys, users[c])];
        const hn_joint *joint = k->joint >= 0 ? &scene->joints[k->joint] : NULL;
        if (k->kind != HN_ANGLE) {
            return HN_OK;
        }
        if (first && joint && hn_dot(3, first->parent_axis, joint->parent_axis) <= 0) {
            return HN_OK;
        }
        first = joint ? joint : first;
    }

    *out = 1;
    return HN_OK;
}
