// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_RING_H
#define HN_SUPPORT_RING_H
// Spatial linkages of one loop, as JSON. Every body's frame is the world's at the start, so that
// all joints stand at zero and the ring is closed there; joint 0 is the crank, coordinate "J0",
// pinned at 0 with 1.3 rad/s.

enum { RING_TEXT = 6000, RING_MAX = 6 };

typedef struct ring {
    const char *name;
    int n; ///< joints; bodies are one fewer
    const char *types[RING_MAX];
    int freedoms;
} ring;

int ring_count(void);
const ring *ring_at(int i);
/// Cuts joint `cut` (0: as the compiler chooses).
void ring_write(char text[RING_TEXT], const ring *r, int cut);
#endif
