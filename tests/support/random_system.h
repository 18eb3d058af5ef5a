// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_RANDOM_SYSTEM_H
#define HN_SUPPORT_RANDOM_SYSTEM_H
// Random mechanisms, compiled, and what holds for every one of them: the terms of plain
// body-by-body mechanics (mechanism.h), and derivatives.

#include "dynamics/evaluate/eval.h"
#include "support/mechanism.h"

#include <stdbool.h>

enum { HN_RANDOM_N = 48, HN_RANDOM_Q = 64, HN_RANDOM_M = 40 };

typedef struct hn_random_system {
    hn_arena *arena;
    hn_scene *scene;
    hn_system *sys;
    hn_eval *eval;
    int n, nq, m; ///< velocities, positions, rows
    double q[HN_RANDOM_Q], v[HN_RANDOM_N], user_q[HN_RANDOM_N], user_v[HN_RANDOM_N];
} hn_random_system;

void hn_random_begin(hn_random_system *s, const mechanism_opts *o);
void hn_random_end(hn_random_system *s);
/// A random state, or where `closed` the pose of the scene's own q0 with random rates.
void hn_random_state(hn_random_system *s, unsigned seed, bool closed);
/// M, f and energies at two random states are those of plain mechanics.
void hn_random_check_tree(const mechanism_opts *o);
/// J and gamma are the derivatives of phi.
void hn_random_check_closure(hn_random_system *s);
/// The halves of the first loop's joint are drawn where plain mechanics has them.
void hn_random_check_halves(const mechanism_opts *o, unsigned seed);
/// Coordinates and rates of the scene, there and back; a force has the same power in both.
void hn_random_check_user(const mechanism_opts *o, unsigned seed);

#endif
