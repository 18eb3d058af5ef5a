// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/direction.h"

#include "expr/construct.h"

// The quaternion (w, u) of a ball turns with (w, u)' = 1/2 (-u . e, w e + u x e), e the axis of
// the velocity.
int hn_direction_of_speed(const hn_system *sys, int j, int symbols[HN_DIRECTION_MOST],
                          hn_ex seed[HN_DIRECTION_MOST]) {
    // a coordinate with a position of its own
    const int position = hn_system_position_of(sys, j);
    if (position >= 0) {
        symbols[0] = sys->q_symbols[position];
        seed[0] = hn_num(1);
        return 1;
    }

    // the ball that the velocity belongs to
    int k = 0;
    while (j < sys->balls[k].speed || j >= sys->balls[k].speed + 3) {
        k++;
        HN_ASSERT(k < sys->n_balls);
    }

    // (w, u)' = 1/2 (-u . e, w e + u x e), e the axis of the velocity
    const hn_ball *ball = &sys->balls[k];
    const int x = j - ball->speed, y = (x + 1) % 3, z = (x + 2) % 3;
    const hn_ex *w = sys->q + ball->position, *u = w + 1;
    for (int i = 0; i < 4; i++) {
        symbols[i] = sys->q_symbols[ball->position + i];
    }
    seed[0] = hn_scale(-0.5, u[x]);
    seed[1 + x] = hn_scale(0.5, *w);
    seed[1 + y] = hn_scale(0.5, u[z]);
    seed[1 + z] = hn_scale(-0.5, u[y]);
    return 4;
}
