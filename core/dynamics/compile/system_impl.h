#ifndef HN_DYNAMICS_SYSTEM_IMPL_H
#define HN_DYNAMICS_SYSTEM_IMPL_H
// Inside a system; for the files of dynamics/ only. See system.h for what it means to the outside.

#include "dynamics/compile/drawing.h"
#include "dynamics/compile/entries.h"
#include "dynamics/compile/system.h"
#include "dynamics/compile/tree.h"
#include "dynamics/compile/vec3.h"

/// What the multiplier of a row does, per unit of it, in the frame of its closure (closure.h):
/// `force` on end b at its point, the opposite on end a at its own; the moments on the two bodies
/// beside that. `turn` takes the axes E of b's link to that frame.
typedef struct hn_row_wrench {
    hn_vec3 force, moment_a, moment_b;
    hn_mat3 turn;
} hn_row_wrench;

typedef struct hn_row {
    const char *name;
    int loop;
    int is_length;
    hn_row_wrench wrench; ///< bodies only; zero for gears and formulas, which act along coordinates
} hn_row;

typedef struct hn_loop {
    const char *name;
    int joint;       ///< scene joint, -1: a tear or formula
    const char *why; ///< why this joint was cut, for telling; static text
    int constraint;  ///< scene constraint beside the joints, -1: none
    int tear;        ///< its pair of points in the drawing, -1: none
} hn_loop;

/// What a load gives, for telling its wrenches: a force [N] or moment [N m] in world axes; a spring
/// between points: force over length in x[0]; along a coordinate: force or torque in x[0].
typedef struct hn_load_value {
    hn_ex x[3];
} hn_load_value;

/// Four entries of q from `position` and three speeds from `speed`: see tree.h.
typedef struct hn_ball {
    int position, speed;
} hn_ball;

/// What a formula may say about a scene coordinate.
enum { HN_KNOWN_NOTHING, HN_KNOWN_BOTH, HN_KNOWN_RATE };

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
    hn_ex *M_dense, *J_dense;

    hn_row *rows;
    const char **dropped; ///< names of the info.rows_dropped rows that vanish identically
    int n_loops;
    hn_loop *loops;
    double length;
    hn_drawing drawing;
    const struct hn_mech *mech; ///< bodies: the trace, kept for reactions
    hn_load_value *load_values; ///< per load
    hn_entries efforts;         ///< row, scene coordinate: d phi / dx of gears and formulas
};

/// The expression of a quantity: its number, or its formula in parameters and, where it varies, the
/// state.
HN_MUST_CHECK hn_status hn_system_quantity(hn_system *sys, const hn_quantity *quantity, hn_ex *out);
/// The same with these expressions for the scene's coordinates and their rates (by index) instead
/// of their own.
HN_MUST_CHECK hn_status hn_system_quantity_of(hn_system *sys, const hn_quantity *quantity,
                                              const hn_ex *positions, const hn_ex *rates,
                                              hn_ex *out);
/// Symbols "kind name" to stand for the scene's coordinates (or their rates) while a formula is
/// differentiated by them.
void hn_system_stand_ins(hn_system *sys, const char *kind, hn_ex *out, int *symbols);
/// Three at once.
HN_MUST_CHECK hn_status hn_system_vector(hn_system *sys, const hn_quantity *quantity, hn_vec3 *out);
/// A closure row: kept, dropped when it vanishes identically, or refused when it is a constant that
/// is not zero. `J` holds n_J entries (row ignored). is_length decides the unit in messages.
typedef struct hn_new_row {
    const char *name;
    int loop, is_length;
    hn_ex phi, phi_t, gamma;
    const hn_entry *J;
    int n_J;
    const char *pointer;         ///< of the joint or formula
    const hn_row_wrench *wrench; ///< NULL: none
} hn_new_row;
HN_MUST_CHECK hn_status hn_system_add_row(hn_system *sys, const hn_new_row *row);

// ---- the two kinds of scenes: symbols, terms, rows, loops, points, drawing ----
HN_MUST_CHECK hn_status hn_bodies_compile(hn_system *sys);
HN_MUST_CHECK hn_status hn_lagrangian_compile(hn_system *sys);
/// Adds the Lagrangian's energies to M, f and the energies. Coordinates must be known to formulas
/// by then.
HN_MUST_CHECK hn_status hn_lagrangian_add_energies(hn_system *sys);

/// The difference of two scene points, and how the rates move it.
typedef struct hn_span {
    hn_vec3 delta; ///< point p minus point q
    int n;
    int *coordinate;      ///< n system coordinates
    hn_vec3 *coefficient; ///< d delta / dt = sum coefficient u (without what t alone moves)
} hn_span;

/// How a kind of scene gives spans: p minus q in any one frame (only lengths and powers are taken
/// from it), or, with q < 0, p seen from the world's origin in world axes.
typedef struct hn_geometry {
    void *self;
    hn_status (*span)(void *self, int p, int q, hn_span *out);
    /// How the rates turn the body of point p, in world axes (delta is not used); NULL where there
    /// are no bodies.
    hn_status (*spin)(void *self, int p, hn_span *out);
} hn_geometry;
/// Loads of either kind, by virtual work: adds to f, springs also to potential.
HN_MUST_CHECK hn_status hn_loads_compile(hn_system *sys, const hn_geometry *geometry);

/// Symbols of the nq coordinates and nv rates under these names (a name that is taken gets
/// underscores), then t and the gains.
HN_MUST_CHECK hn_status hn_system_make_symbols(hn_system *sys, const char *const *names,
                                               const char *const *rates);
/// Allocates what is sized by nq and nv, and rows for at most max_rows.
HN_MUST_CHECK hn_status hn_system_allocate(hn_system *sys, int nq, int nv, int max_rows,
                                           int n_loops, int n_points);
HN_MUST_CHECK hn_status hn_system_make_drawing(hn_system *sys, int n_tears);
#endif
