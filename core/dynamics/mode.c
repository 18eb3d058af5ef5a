// The assembly mode of the first loop: see hn_mode_watch in assemble.h.

#include "dynamics/assemble.h"
#include "dynamics/assemble_internal.h"
#include "expr/tape.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

enum { MAX_ROWS = 6 }; // a spatial loop has at most six

struct hn_mode_watch {
    int n; ///< rows and columns of J_d; 0: no mode
    int nq;
    hn_tape *tape; ///< (q, t) -> J_d, n x n
    double *in, *work;
    double det[MAX_ROWS * MAX_ROWS];
};

/// The first loop: its rows, and the user coordinates that depend on the others, in order.
typedef struct loop_parts {
    int n_rows, rows[MAX_ROWS];
    int n_dependent, dependent[MAX_ROWS];
    int n_coordinates; ///< all that move the loop
    int independent;   ///< the one taken last
} loop_parts;

/// Row `row` of J times the rates `unit` (nv) that a user coordinate's unit rate stands for.
static hn_ex row_times(const hn_system *sys, int row, const double *unit) {
    hn_system_info info = hn_system_get_info(sys);
    hn_system_exprs ex = hn_system_get_exprs(sys);
    hn_graph *g = hn_system_graph(sys);
    hn_ex sum = hn_num(0);
    for (int j = 0; j < info.nv; j++) {
        hn_ex entry = ex.J[(size_t)row * info.nv + j];
        if (unit[j] != 0 && !hn_is_zero(entry)) {
            sum = hn_add(g, sum, hn_scale(unit[j], entry));
        }
    }
    return sum;
}

static int row_moves_with(const hn_system *sys, int row, const double *unit) {
    return !hn_is_zero(row_times(sys, row, unit));
}

/// How willingly a coordinate is taken as independent: a motor first, then what the user holds.
static int willingness(const hn_coordinate *c) {
    return 4 * (c->actuated != 0) + 2 * (c->q0_pinned != 0) + (c->v0_pinned != 0);
}

/// Takes the most willing coordinates (the first of equals) as independent until as many are left as there are rows.
static void choose_dependent(const hn_system *sys, int *coordinates, loop_parts *parts) {
    const hn_scene *scene = hn_system_scene(sys);
    int n = parts->n_coordinates;
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
    for (int i = 0; i < n; i++) {
        if (coordinates[i] >= 0) {
            parts->dependent[parts->n_dependent++] = coordinates[i];
        }
    }
}

/// Where the joint of a coordinate stands on the way round the first loop: out along the bodies that carry the cut joint's parent
/// (from the ground on), then along those that carry its child. The order of scene formulas is kept.
static int place_in_ring(const hn_system *sys, int user) {
    const hn_scene *scene = hn_system_scene(sys);
    int coordinate = hn_system_user_coordinate(sys, user);
    int cut = scene->is_lagrangian ? -1 : hn_system_loop_joint(sys, 0);
    if (cut < 0) {
        return user;
    }
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

/// Dependent coordinates in the order of the ring, which gives det J_d its sign whatever order the scene lists them in.
static void sort_dependent(const hn_system *sys, loop_parts *parts) {
    for (int i = 1; i < parts->n_dependent; i++) {
        int keep = parts->dependent[i], place = place_in_ring(sys, keep), j = i;
        for (; j > 0 && place_in_ring(sys, parts->dependent[j - 1]) > place; j--) {
            parts->dependent[j] = parts->dependent[j - 1];
        }
        parts->dependent[j] = keep;
    }
}

static void unit_rate(const hn_system *sys, int user, double *user_rates, double *unit) {
    user_rates[user] = 1;
    hn_system_rates_from_user(sys, user_rates, unit);
    user_rates[user] = 0;
}

/// 1 if `row` belongs to the first loop. A scene of formulas does not say which of them make up one loop: there, these are
/// the rows that depend on the same coordinates as the first (its set is given).
static int is_in_first_loop(const hn_system *sys, int row, const int *moves, const double *units) {
    hn_system_info info = hn_system_get_info(sys);
    if (!hn_system_scene(sys)->is_lagrangian) {
        return hn_system_row_loop(sys, row) == 0;
    }
    for (int k = 0; k < info.n_user; k++) {
        if (row_moves_with(sys, row, units + (size_t)k * info.nv) != moves[k]) {
            return 0;
        }
    }
    return 1;
}

/// Rows of the first loop into parts; moves[k] becomes 1 for each user coordinate that moves one. 0 when it has too many.
static int find_rows(const hn_system *sys, const double *units, int *moves, loop_parts *parts) {
    hn_system_info info = hn_system_get_info(sys);
    for (int k = 0; k < info.n_user && info.nc > 0; k++) {
        moves[k] = row_moves_with(sys, 0, units + (size_t)k * info.nv);
    }
    for (int i = 0; i < info.nc; i++) {
        if (!is_in_first_loop(sys, i, moves, units)) {
            continue;
        }
        if (parts->n_rows == MAX_ROWS) {
            return 0;
        }
        parts->rows[parts->n_rows++] = i;
    }
    for (int r = 0; r < parts->n_rows; r++) {
        for (int k = 0; k < info.n_user; k++) {
            moves[k] |= row_moves_with(sys, parts->rows[r], units + (size_t)k * info.nv);
        }
    }
    return parts->n_rows > 0;
}

/// Row k of `units` (n_user x nv): the system rates that a unit rate of user coordinate k stands for.
static void fill_units(const hn_system *sys, double *user_rates, double *units) {
    hn_system_info info = hn_system_get_info(sys);
    for (int k = 0; k < info.n_user; k++) {
        unit_rate(sys, k, user_rates, units + (size_t)k * info.nv);
    }
}

/// Fills `parts`; n_dependent stays 0 when the loop has fewer coordinates than rows (over-closed) or there is none.
static hn_status find_parts(const hn_system *sys, hn_arena *arena, loop_parts *parts) {
    hn_system_info info = hn_system_get_info(sys);
    *parts = (loop_parts){0};
    int *moves = hn_arena_ints(arena, (size_t)info.n_user);
    int *coordinates = hn_arena_ints(arena, (size_t)info.n_user);
    double *user_rates = hn_arena_doubles(arena, (size_t)info.n_user);
    double *units = hn_arena_doubles(arena, (size_t)info.n_user * info.nv);
    if (!moves || !coordinates || !user_rates || !units) {
        return HN_ERR_MEMORY;
    }
    fill_units(sys, user_rates, units);
    if (!find_rows(sys, units, moves, parts)) {
        return HN_OK;
    }
    for (int k = 0; k < info.n_user; k++) {
        if (moves[k]) {
            coordinates[parts->n_coordinates++] = k;
        }
    }
    if (parts->n_coordinates >= parts->n_rows) {
        choose_dependent(sys, coordinates, parts);
        sort_dependent(sys, parts);
    }
    return HN_OK;
}

static hn_status compile_determinant(const hn_system *sys, hn_arena *arena, const loop_parts *parts,
                                     hn_mode_watch *w) {
    hn_system_info info = hn_system_get_info(sys);
    hn_system_exprs ex = hn_system_get_exprs(sys);
    int n = parts->n_dependent;
    double *user_rates = hn_arena_doubles(arena, (size_t)info.n_user);
    double *unit = hn_arena_doubles(arena, (size_t)info.nv);
    int *symbols = hn_arena_ints(arena, (size_t)info.nq + 1);
    if (!user_rates || !unit || !symbols) {
        return HN_ERR_MEMORY;
    }
    hn_ex entries[MAX_ROWS * MAX_ROWS];
    for (int c = 0; c < n; c++) {
        unit_rate(sys, parts->dependent[c], user_rates, unit);
        for (int r = 0; r < n; r++) {
            entries[r * n + c] = row_times(sys, parts->rows[r], unit);
        }
    }
    for (int i = 0; i < info.nq; i++) {
        symbols[i] = ex.q_symbols[i];
    }
    symbols[info.nq] = ex.t_symbol;
    hn_status status =
        hn_tape_compile(hn_system_graph(sys), entries, n * n, symbols, info.nq + 1, &w->tape);
    if (status != HN_OK) {
        return status;
    }

    w->n = n;
    w->nq = info.nq;
    w->in = hn_arena_doubles(arena, (size_t)info.nq + 1);
    w->work = hn_arena_doubles(arena, hn_tape_work_size(w->tape));
    if (!w->in || !w->work) {
        return HN_ERR_MEMORY;
    }
    hn_tape_prepare(w->tape, w->work);
    return HN_OK;
}

hn_status hn_mode_watch_create(const hn_system *sys, hn_arena *arena, hn_mode_watch **out) {
    hn_mode_watch *w = hn_arena_get(arena, sizeof *w);
    if (!w) {
        return HN_ERR_MEMORY;
    }
    loop_parts parts;
    hn_status status = find_parts(sys, arena, &parts);
    if (status == HN_OK && parts.n_dependent > 0) {
        status = compile_determinant(sys, arena, &parts, w);
    }
    if (status != HN_OK) {
        hn_mode_watch_free(w);
        return status;
    }
    *out = w;
    return HN_OK;
}

void hn_mode_watch_free(hn_mode_watch *w) {
    if (w) {
        hn_tape_free(w->tape);
        w->tape = NULL;
    }
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
        if (best != k) {
            for (int j = 0; j < n; j++) {
                double keep = a[k * n + j];
                a[k * n + j] = a[best * n + j];
                a[best * n + j] = keep;
            }
            det = -det;
        }
        det *= a[k * n + k];
        for (int i = k + 1; i < n; i++) {
            hn_axpy(n - k, -a[i * n + k] / a[k * n + k], a + k * n + k, a + i * n + k);
        }
    }
    return det;
}

double hn_mode_watch_value(hn_mode_watch *w, double t, const double *q) {
    int n = w->n;
    if (n == 0) {
        return 0;
    }
    memcpy(w->in, q, (size_t)w->nq * sizeof *q);
    w->in[w->nq] = t;
    hn_tape_eval(w->tape, w->in, w->det, w->work);

    double lengths = 1;
    for (int c = 0; c < n; c++) {
        double square = 0;
        for (int r = 0; r < n; r++) {
            square += w->det[r * n + c] * w->det[r * n + c];
        }
        lengths *= sqrt(square);
    }
    double det = determinant(n, w->det);
    return lengths > 0 && isfinite(det) ? -det / lengths : 0;
}

/// Below this |-det J_d| in units of its columns is rounding, not a mode.
static const double MODE_ZERO = 1e-12;

int hn_mode_sign(double value) {
    return value > MODE_ZERO ? 1 : (value < -MODE_ZERO ? -1 : 0);
}

int hn_assembly_mode(const hn_system *sys, double t, const double *q) {
    hn_arena *arena = hn_arena_create(0);
    hn_mode_watch *w = NULL;
    int mode = 0;
    if (arena && hn_mode_watch_create(sys, arena, &w) == HN_OK) {
        mode = hn_mode_sign(hn_mode_watch_value(w, t, q));
        hn_mode_watch_free(w);
    }
    hn_arena_free(arena);
    return mode;
}

hn_status hn_mode_is_four_bar(const hn_system *sys, hn_arena *arena, int *out) {
    const hn_scene *scene = hn_system_scene(sys);
    loop_parts parts;
    *out = 0;
    hn_status status = find_parts(sys, arena, &parts);
    if (status != HN_OK || parts.n_rows != 2 || parts.n_coordinates != 3) {
        return status;
    }
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
