// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_HAND_H
#define HN_SESSION_HAND_H
// The hand that pulls a mechanism while a comparison runs: its log by frames, how stiff its spring
// is, and the force that it exerts on a method's state.

#include "base/arena.h"
#include "base/diag.h"
#include "base/strbuf.h"
#include "dynamics/evaluate/pull_force.h"

#include <stdbool.h>

/// A change of the hand at a frame: `pull` holds from then on.
typedef struct hn_pull_event {
    long long frame;
    hn_pull pull;
} hn_pull_event;

typedef struct hn_hand {
    const hn_system *sys;
    hn_arena *arena;
    hn_pull_event *events; ///< by frame, owned
    int n, cap;
    int done; ///< events that the present run has felt
    hn_pull_force *force;
} hn_hand;

/// Chooses stiffness and damping where they are below 0: stiffness from the weight and the size of
/// the mechanism, damping half the critical one of its whole mass, both of three digits.
void hn_pull_choose_spring(const hn_system *sys, hn_pull *pull);
/// Makes an idle hand for a system; in one without pulls it stays idle. Fails: HN_ERR_MEMORY,
/// HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_hand_create(const hn_system *sys, hn_hand *hand);
void hn_hand_free(hn_hand *hand); ///< frees what it owns
/// Adds an event at a frame and forgets those that were not done yet. Stiffness and damping below 0
/// are chosen, and written to *pull. Fails with the reason in diag: HN_ERR_INPUT (a point without
/// a load, a place that is not finite), HN_ERR_LIMIT, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_hand_add(hn_hand *hand, long long frame, hn_pull *pull, hn_diag *diag);
void hn_hand_rewind(hn_hand *hand); ///< the run is back at frame 0; the events stay
/// Returns whether an event is due at the frame.
bool hn_hand_is_due(const hn_hand *hand, long long frame);
/// Does the events that are due at the frame: they are felt from time t on [s]. If memory is out
/// they stay due.
void hn_hand_do(hn_hand *hand, long long frame, double t);
/// Writes the pull that holds at time t: {"point","to","stiffness","damping"}, or null.
void hn_hand_put_json(hn_strbuf *b, const hn_hand *hand, double t);
/// Writes an event: [frame, point, x, y, z, stiffness, damping].
void hn_pull_event_json(hn_strbuf *b, const hn_pull_event *event);

#endif
