// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_DYADS_H
#define HN_DYNAMICS_DYADS_H
// Position analysis in closed form. Once the independent coordinates are fixed, the closure rows
// and the dependent coordinates fall apart into blocks that can be solved one after the other
// (block triangular form of the pattern of J_d). In a plane most mechanisms fall apart into single
// unknowns and dyads: two links, three joints, two rows, two unknowns:
//
//     RRR   two angles              R(x) a + R(y) c + e = 0          a circle meets a circle
//     RRP   an angle and a slide    R(x) a + y u + e = 0             a circle meets a line
//     RPR   a slide that turns      R(x) (a + y u) + e = 0           a point seen along a line
//     PRP   two slides              x u + y w + e = 0                a line meets a line
//
// (all given here but x and y are functions of what is known by then). They are recognised from the
// expressions of phi, whatever coordinates the scene is written in: the coefficients are read off
// by differentiation, and phi made from them has to be phi at random poses. With two ways to
// assemble a dyad the one of the present pose is kept, as the sign of a square root.
//
// Source: Assur groups of the second class, e.g. Manolescu 1979, "A unitary method for construction
// of the kinematic plane chains"; block triangular form: Duff & Reid 1978, Davis 2006 (SuiteSparse
// BTF).

#include "base/arena.h"
#include "dynamics/compile/system.h"
#include "expr/tape.h"

#include <stdbool.h>

typedef struct hn_dyads hn_dyads;

#define HN_DYAD_KIND_LIST(X)                            \
    X(HN_DYAD_SINGLE, "one unknown", "a line")          \
    X(HN_DYAD_TURN, "one angle", "a circle and a line") \
    X(HN_DYAD_RRR, "RRR", "a circle and a circle")      \
    X(HN_DYAD_RRP, "RRP", "a circle and a line")        \
    X(HN_DYAD_RPR, "RPR", "a slide that turns")         \
    X(HN_DYAD_PRP, "PRP", "a line and a line")
typedef enum hn_dyad_kind {
#define HN_DYAD_ENUM(code, name, about) code,
    HN_DYAD_KIND_LIST(HN_DYAD_ENUM)
#undef HN_DYAD_ENUM
        HN_DYAD_KIND_COUNT
} hn_dyad_kind;

/// One step of the analysis, for reports.
typedef struct hn_dyad {
    hn_dyad_kind kind;
    int n;          ///< 1 or 2
    int row[2];     ///< closure rows
    int unknown[2]; ///< system coordinates
} hn_dyad;
const char *hn_dyad_kind_name(hn_dyad_kind kind);
const char *hn_dyad_kind_about(hn_dyad_kind kind);

/// Analyses the position problem for the dependent columns `dep` (n of them, ascending). Adds nodes
/// to the graph, as an evaluator does. The tape is owned (hn_dyads_free), the rest from `arena`.
/// The object of loops without a closed form says why (hn_dyads_refusal) and solves nothing.
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_dyads_create(const hn_system *sys, const int *dep, int n,
                                        hn_arena *arena, hn_dyads **out);
void hn_dyads_free(hn_dyads *d); ///< NULL is legal
/// NULL where there is a closed form, else the reason, as a clause to follow "Newton, because".
const char *hn_dyads_refusal(const hn_dyads *d);
bool hn_dyads_serve(const hn_dyads *d, const int *dep, int n); ///< made for these columns
int hn_dyads_count(const hn_dyads *d);                         ///< steps
int hn_dyads_proper(const hn_dyads *d); ///< those of them with two unknowns: dyads
hn_dyad hn_dyads_at(const hn_dyads *d, int k);
hn_tape_info hn_dyads_info(const hn_dyads *d);        ///< of one solve
hn_tape_info hn_dyads_branch_info(const hn_dyads *d); ///< of one check of the branches
double hn_dyads_ops(const hn_dyads *d);               ///< arithmetic operations so far

/// Takes the branch of every dyad at q (nq) as the one to keep. Returns false when a dyad is at its
/// dead point, where the two branches meet; its sign is then 0.
bool hn_dyads_take_branch(hn_dyads *d, double t, const double *q);
/// Returns the first step that is on the other branch at q (nq), -1 when none is. q is near a pose,
/// e.g. predicted along a tangent.
int hn_dyads_find_turned(hn_dyads *d, double t, const double *q);
/// Sets the dependent entries of q (nq) from the others; an angle takes the whole turn nearest to
/// its old value. Returns -1, or the first step that cannot be closed (its circles do not meet); q
/// is then unchanged. Allocates nothing.
int hn_dyads_solve(hn_dyads *d, double t, double *q);

/// Step k as an equation for people: its unknown i in terms of what is known before (for i = 1 also
/// unknown 0, or the other way round); hn_dyads_sign_name() is the symbol of its branch. In the
/// graph of the system.
hn_ex hn_dyads_expression(const hn_dyads *d, int k, int i);
/// Names for parts of the expressions of step k, in the order in which they are defined.
enum { HN_DYAD_PARTS = 4 };
typedef struct hn_dyad_part {
    hn_ex name, is;
} hn_dyad_part;
int hn_dyads_n_parts(const hn_dyads *d, int k);
hn_dyad_part hn_dyads_part(const hn_dyads *d, int k, int i);
/// The name of the symbol of the branch; NULL where there is one way only.
const char *hn_dyads_sign_name(const hn_dyads *d, int k);
/// +1 or -1 for the branch kept; 0: it was taken at the dead point, where both branches meet.
double hn_dyads_sign(const hn_dyads *d, int k);
#endif
