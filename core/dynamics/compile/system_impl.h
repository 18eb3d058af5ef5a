// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_SYSTEM_IMPL_H
#define HN_DYNAMICS_SYSTEM_IMPL_H
// The inside of a system, for the files of dynamics/ only. system.h says what it means to the
// outside.

#include "dynamics/compile/compile.h"
#include "dynamics/compile/drawing.h"
#include "dynamics/compile/entries.h"
#include "dynamics/compile/pull.h"
#include "dynamics/compile/system.h"
#include "dynamics/compile/tree.h"
#include "dynamics/compile/vec3.h"

#include <stdbool.h>

/// The forces of one unit of a row's multiplier, in the frame of its closure (closure.h): `force`
/// acts on end b at its point and opposite on end a at its own; the moments act on the two bodies
/// in addition. `turn` takes the axes E of b's link to that frame.
typedef struct hn_row_wrench {
    hn_vec3 force, moment_a, moment_b;
    hn_mat3 turn;
} hn_row_wrench;

typedef struct hn_row {
    const char *name;
    int loop;
    bool is_length;
    hn_row_wrench wrench; ///< bodies only; zero for gears and formulas, which act along coordinates
} hn_row;

/// Three rows of J from `row` on, seen from the leg of their loop (leg.h).
typedef struct hn_leg {
    int row;
    hn_mat3 turn; ///< the leg's axes to the frame of the rows
    hn_ex phi[3], gamma[3];
    hn_entries J; ///< owned; sorted
} hn_leg;

typedef struct hn_loop {
    const char *name;
    int joint;       ///< scene joint, -1: a tear or formula
    const char *why; ///< why this joint was cut, for reports; static text
    int constraint;  ///< scene constraint beside the joints, -1: none
    int tear;        ///< its pair of points in the drawing, -1: none
} hn_loop;

/// The value of a load, kept to report its wrenches: a force [N] or moment [N m] in world axes; of
/// a spring between points, force over length in x[0]; along a coordinate, force or torque in x[0].
typedef struct hn_load_value {
    hn_ex x[3];
} hn_load_value;

/// A ball: four entries of q from `position` on, three of v from `speed` on (tree.h).
typedef struct hn_ball {
    int position, speed;
} hn_ball;

/// The expressions that a scene coordinate has: none, position and rate, the rate alone.
enum { HN_KNOWN_NOTHING, HN_KNOWN_BOTH, HN_KNOWN_RATE };

enum { HN_SYSTEM_LDLS = 3 }; ///< one for each hn_factor_weight

struct hn_system {
    const hn_scene *scene;
    hn_system_opts opts;
    hn_arena *arena;
    hn_graph *g;
    hn_diags *diags; ///< while compiling
    hn_tree tree;    ///< bodies and joints only
    int nq, nv, nc;
    int n_balls;
    hn_ball *balls;
    hn_system_info info;

    // symbols
    hn_ex *q, *v;         ///< nq, nv
    hn_ex t, alpha, beta; ///< alpha, beta: Baumgarte's gains
    int *q_symbols, *v_symbols;
    int t_symbol, alpha_symbol, beta_symbol;
    hn_ex *params;          ///< per scene parameter: a number, or its symbol
    hn_ex *user_q, *user_v; ///< per SCENE coordinate; a cut joint's is derived
    hn_ex *user_gamma;      ///< its acceleration at zero u-dot
    char *user_known;       ///< per scene coordinate: HN_KNOWN_...

    // terms
    hn_entries M; ///< lower triangle with diagonal: row >= col
    hn_entries J;
    hn_ex *f, *phi, *phi_t, *gamma, *points;
    hn_ex kinetic, potential;

    bool *is_angle; ///< nq
    hn_row *rows;
    const char **dropped; ///< names of the info.rows_dropped rows that vanish identically
    int n_loops;
    hn_loop *loops;
    int n_legs;
    hn_leg *legs;   ///< as many as loops at most
    int *leg_nodes; ///< one: nodes of the graph that were made for them
    double length;
    hn_drawing drawing;
    const struct hn_mech *mech; ///< bodies: the trace, kept for reactions
    hn_load_value *load_values; ///< per load
    int n_pulls;                ///< loads of kind HN_LOAD_PULL
    hn_ex *pull_inputs;         ///< HN_PULL_INPUTS symbols for each, in the order of pull.h
    hn_pull_log *pulls;         ///< owned; NULL where nothing can be pulled
    struct hn_ldl **ldls; ///< HN_SYSTEM_LDLS factorisations, NULL until asked for (ldl_kept.h)
    struct hn_solve_rows **solve_rows; ///< NULL until asked for (solve_rows.h)
    hn_entries efforts;                ///< row, scene coordinate: d phi / dx of gears and formulas
};

#endif
