// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_SYSTEM_H
#define HN_DYNAMICS_SYSTEM_H
// A system: a scene compiled to equations. It keeps the expressions of every term; an evaluator
// (eval.h) compiles a tape for the terms that one method needs and nothing else.
//
//     M(q) a = f(q,v,t) + J' lambda,   phi(q,t) = 0,   J v + phi_t = 0,   J a + gamma = 0     (1)
//
// Signs. J' lambda is the generalised force ON the bodies, so a multiplier is positive where the
// constraint pushes towards growing phi. Signs of reactions: dynamics/reactions/reactions.h.
//
// Coordinates. There are two sets:
//   SYSTEM coordinates q (nq), v (nv), chosen by the compiler: absolute angles along consecutive
//   parallel revolute axes (they make M sparse), the scene's coordinates everywhere else. All
//   functions of the layers above take these unless they say otherwise.
//   USER coordinates (nv), those of the scene, which people see.
// coordinates.h has the maps between them. nq == nv but for orientations (spherical and free
// joints): q then has a unit quaternion of four entries, the user sees its rotation vector (axis
// times angle, no longer than pi), and the velocity of both is the angular velocity.
//
// Threads. A system is constant after compilation, and threads may share it, with two exceptions:
// creating an evaluator, or anything else with a tape of its own, adds nodes to its graph: create
// those from one thread at a time. And a system with pulls belongs to the thread that writes their
// log.

#include "dynamics/compile/pull.h"
#include "expr/graph.h"
#include "scene/scene.h"

#include <stdbool.h>

typedef struct hn_system hn_system;

/// Borrowed: the scene that it was compiled from.
const hn_scene *hn_system_scene(const hn_system *sys);

typedef struct hn_system_info {
    int nq, nv;   ///< sizes in system coordinates
    int nc;       ///< rows, those that vanish identically left out
    int n_user;   ///< scene coordinates of tree joints, as many as nv
    int n_loops;  ///< joints (or tears) that close a loop
    int n_points; ///< world points for drawing
    /// closure rows written down, and those that vanished identically
    int rows_before, rows_dropped;
    bool has_time; ///< phi or f depend on t explicitly
    /// graph size, without what the rows seen from legs add (leg.h): they replace others
    int nodes;
} hn_system_info;
hn_system_info hn_system_get_info(const hn_system *sys);

/// Index into scene->coordinates of user coordinate i (0..n_user-1).
int hn_system_user_coordinate(const hn_system *sys, int i);
/// Properties of a row: its name, such as "C: x"; the number of its loop; 1 where it is in metres,
/// 0 where it is an angle or has another unit.
const char *hn_system_row_name(const hn_system *sys, int row);
int hn_system_row_loop(const hn_system *sys, int row);
bool hn_system_row_is_length(const hn_system *sys, int row);
/// The unit in which rows are compared: the characteristic length for a row in metres, else 1.
double hn_system_row_unit(const hn_system *sys, int row);
/// The unit in which velocities are compared: the characteristic length for one of a length, else
/// 1. With both, J is the same matrix for similar mechanisms of any size.
double hn_system_velocity_unit(const hn_system *sys, int i);
/// The joint that closes a loop, by its index in the scene; -1 where a constraint or a formula
/// closes it.
int hn_system_loop_joint(const hn_system *sys, int loop);
/// The name of what closes a loop: of the joint or the constraint.
const char *hn_system_loop_name(const hn_system *sys, int loop);
/// The characteristic length [m] for relative tolerances: the largest distance between joint
/// locations of one body; in a scene of formulas, the largest arm by which an angle moves a
/// constraint at the start. 1 if there is none.
double hn_system_length(const hn_system *sys);

/// The joint by which a body hangs in the spanning tree; -1 in a scene of formulas.
int hn_system_tree_joint(const hn_system *sys, int body);
/// Returns whether the joint was cut to close a loop.
bool hn_system_joint_is_cut(const hn_system *sys, int joint);

/// The entry of q whose rate entry i of v is; -1 for the angular velocity of a ball.
int hn_system_position_of(const hn_system *sys, int i);
/// Returns flags (nq) of the entries of q that are angles; borrowed. An angle plus a whole turn
/// stands for the same position of its body.
const bool *hn_system_angles(const hn_system *sys);
/// Returns the log of the forces with which a user pulls at the mechanism while it runs; NULL where
/// the scene has no such load.
hn_pull_log *hn_system_pulls(const hn_system *sys);
/// The first time after t at which a load given as a table, or a pull, has a corner (an integrator
/// restarts there), HUGE_VAL: none.
double hn_system_next_corner(const hn_system *sys, double t);

// ---- expressions, for printing, exporting and grading; borrowed arrays in the system's graph ----
hn_graph *hn_system_graph(const hn_system *sys);
/// Returns whether the interrupt ended the making of equations since the last hn_graph_go_on().
bool hn_system_was_stopped(const hn_system *sys);
/// The status of a call that makes equations: HN_ERR_STOPPED, told in diag, where the interrupt
/// ended it, since the call then fails for lack of its equations; else `status`.
hn_status hn_system_stopped(const hn_system *sys, hn_status status, hn_diag *diag);
typedef struct hn_system_exprs {
    const hn_ex *f;      ///< nv
    const hn_ex *phi;    ///< nc
    const hn_ex *phi_t;  ///< nc
    const hn_ex *gamma;  ///< nc
    const hn_ex *points; ///< 3 n_points, world [m]
    hn_ex kinetic, potential;
    const int *q_symbols, *v_symbols; ///< symbol numbers of q (nq), v (nv)
    int t_symbol;
} hn_system_exprs;
hn_system_exprs hn_system_get_exprs(const hn_system *sys);
/// M (nv x nv) and J (nc x nv), row-major, in memory from `arena`; NULL when that is out.
HN_MUST_CHECK const hn_ex *hn_system_dense_mass(const hn_system *sys, hn_arena *arena);
HN_MUST_CHECK const hn_ex *hn_system_dense_jacobian(const hn_system *sys, hn_arena *arena);

#endif
