#ifndef HN_DYNAMICS_SYSTEM_H
#define HN_DYNAMICS_SYSTEM_H
// A system: a scene compiled to equations. It keeps the expressions of every term; an evaluator
// (eval.h) compiles a tape for the terms that one method needs and nothing else.
//
//     M(q) a = f(q,v,t) + J' lambda,   phi(q,t) = 0,   J v + phi_t = 0,   J a + gamma = 0          (1)
//
// Coordinates. The compiler chooses its own: along consecutive parallel revolute axes it uses
// absolute angles and rates (M gets sparse, see the tape sizes), everywhere else the scene's.
// Everything below dynamics' callers is in SYSTEM coordinates q (nq), v (nv); people see the
// scene's USER coordinates (nv of them); the constant linear map between them is
// hn_system_to_user() and hn_system_from_user(). nq == nv but for orientations (spherical and free
// joints): there q has a unit quaternion of four entries, users see its rotation vector (axis times
// angle, no longer than pi), and the rates of both are the angular velocity.
//
// The system is constant after compilation: threads may share it, except hn_eval_create() (which
// adds nodes to the graph): create evaluators from one thread at a time.

#include "base/arena.h"
#include "base/diag.h"
#include "expr/graph.h"
#include "scene/scene.h"

typedef struct hn_system hn_system;

const hn_scene *hn_system_scene(const hn_system *sys);

typedef struct hn_system_info {
    /// sizes in system coordinates; nc rows left after identically zero rows are gone
    int nq, nv, nc;
    int n_user;   ///< scene coordinates that carry freedom (tree joints), as many as nv
    int n_loops;  ///< joints (or tears) that close a loop
    int n_points; ///< world points for drawing
    /// closure rows written down, and those that vanished identically
    int rows_before, rows_dropped;
    int has_time; ///< phi or f depend on t explicitly
    int nodes;    ///< graph size
} hn_system_info;
hn_system_info hn_system_get_info(const hn_system *sys);

/// User coordinate i (0..n_user-1): index into scene->coordinates.
int hn_system_user_coordinate(const hn_system *sys, int i);
/// Name of constraint row i, e.g. "C: x", "loop 1 y"; which loop it belongs to; its length unit (1:
/// metres, 0: angle or other).
const char *hn_system_row_name(const hn_system *sys, int row);
int hn_system_row_loop(const hn_system *sys, int row);
int hn_system_row_is_length(const hn_system *sys, int row);
/// Unit in which rows are compared: the characteristic length for a row in metres, else 1.
double hn_system_row_unit(const hn_system *sys, int row);
/// The joint (scene index) that closes loop i, or -1 for a tear or formula loop; name of the loop.
int hn_system_loop_joint(const hn_system *sys, int loop);
const char *hn_system_loop_name(const hn_system *sys, int loop);
/// Characteristic length [m] for relative tolerances: the largest distance between joint locations
/// of one body; with a Lagrangian, the largest arm by which an angle moves a constraint at the
/// start. 1 if there is none.
double hn_system_length(const hn_system *sys);

/// Tree, for telling: parent body and joint of each body in the spanning tree (joint -1 for
/// Lagrangian scenes).
int hn_system_tree_joint(const hn_system *sys, int body);
/// 1 if the joint was cut to close a loop.
int hn_system_joint_is_cut(const hn_system *sys, int joint);

/// Entry of q behind entry i of v, -1 for the speeds of a ball.
int hn_system_position_of(const hn_system *sys, int i);
/// The first time after t at which a load given as a table has a corner (an integrator restarts
/// there), HUGE_VAL: none.
double hn_system_next_corner(const hn_system *sys, double t);

// ---- expressions, for printing, exporting and grading; borrowed arrays in the system's graph ----
hn_graph *hn_system_graph(const hn_system *sys);
typedef struct hn_system_exprs {
    const hn_ex *M;      ///< nv x nv row-major
    const hn_ex *f;      ///< nv
    const hn_ex *phi;    ///< nc
    const hn_ex *phi_t;  ///< nc
    const hn_ex *J;      ///< nc x nv row-major
    const hn_ex *gamma;  ///< nc
    const hn_ex *points; ///< 3 n_points, world [m]
    hn_ex kinetic, potential;
    const int *q_symbols, *v_symbols; ///< symbol numbers of q (nq), v (nv)
    int t_symbol;
} hn_system_exprs;
hn_system_exprs hn_system_get_exprs(const hn_system *sys);

#endif
