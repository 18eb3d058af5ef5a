// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_REACTIONS_STATE_H
#define HN_DYNAMICS_REACTIONS_STATE_H
// The state of the reactions, shared by their parts, with the small vectors and places that they
// are written with.
//
// Each body is seen from the ground (relate.c), in a frame that does not move:
//     x, R, w of its centre of mass and axes;   a = a0 + sum c_i a_i,   al = al0 + sum z_i a_i
// with the accelerations a_i of the system. Then F = m a - m g, N = I al + w x I w is what acts on
// it; loads and the rows' wrenches are taken off, and from the leaves to the root what is left is
// the wrench of its tree joint, which the joint hands on to the body below.

#include "dynamics/compile/mech.h"
#include "dynamics/evaluate/inputs.h"
#include "dynamics/reactions/reactions.h"
#include "linalg/qr.h"

typedef struct hn_reaction_wrench {
    /// about the centre of mass of the body it stands for, or about a place that is said
    double f[3], n[3];
} hn_reaction_wrench;

typedef struct hn_reaction_body {
    int first;       ///< of its outputs
    int n;           ///< levers
    int *coordinate; ///< n
    double to_world[3][3];
    double R[3][3], x[3]; ///< axes to world; centre of mass
    double force, moment; ///< sizes of what its inertia and weight consist of: these may cancel
    hn_reaction_wrench inertial; ///< what must act on it
    hn_reaction_wrench rest;     ///< the same less what does, without its tree joint
} hn_reaction_body;

struct hn_reactions {
    const hn_system *sys;
    const hn_scene *scene;
    hn_inputs in;
    int n_bodies, nc, nv;
    hn_reaction_body *bodies;
    int *order; ///< bodies, parents first
    int first_load, first_row, first_effort, first_jacobian;
    hn_reaction_wrench *joints;      ///< per joint, about its place, on its child
    double (*places)[3];             ///< of the joints, on their children
    double *tau;                     ///< per scene coordinate: effort along it
    double *lambda;                  ///< nc, a free combination
    hn_reaction_wrench *constraints; ///< per constraint
    /// beside bodies, energies given as formulas: see reactions_efforts.c
    int n_energies, n_inertia;
    int *energy_coordinate; ///< n_energies coordinates of the scene that they move
    double *energy;         ///< n_energies: what they do along those
    hn_entry *inertia;      ///< n_inertia: which of these, which acceleration
    int first_energy, first_inertia;
    int n_efforts;
    hn_effort *efforts;
    hn_qr qr;
    double defect;
};

/// Outputs of a body: U, x, a0, w, al0, then c and z of each lever; of a row in E of end b: force,
/// the two moments; of a load.
enum { HN_REACTION_POSE = 21, HN_REACTION_LEVER = 6, HN_REACTION_ROW = 9, HN_REACTION_LOAD = 3 };

// ---- small vectors and places ----
void hn_reaction_add_cross(double out[3], double k, const double a[3],
                           const double b[3]);                                  ///< += k a x b
void hn_reaction_add_scaled(double out[3], double k, const double a[3]);        ///< += k a
void hn_reaction_apply(const double m[3][3], const double v[3], double out[3]); ///< out may be v
void hn_reaction_apply_transposed(const double m[3][3], const double v[3], double out[3]);
double hn_reaction_value(const hn_reactions *r, int k); ///< output k
void hn_reaction_values3(const hn_reactions *r, int k, double out[3]);
/// A direction in the axes of a body, in the world.
void hn_reaction_to_world(const hn_reactions *r, int body, const double v[3], double out[3]);
/// A point of a body, in the world.
void hn_reaction_place_of(const hn_reactions *r, int body, const hn_quantity *at, double out[3]);

#endif
