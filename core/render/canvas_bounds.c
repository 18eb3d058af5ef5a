// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/canvas_bounds.h"

#include <stdlib.h>

hn_bounds hn_bounds_of(const float *xy, int n) {
    hn_bounds out = {{xy[0], xy[1]}, {xy[0], xy[1]}};
    for (int i = 1; i < n; i++) {
        for (int k = 0; k < 2; k++) {
            const float x = xy[2 * i + k];
            out.low[k] = x < out.low[k] ? x : out.low[k];
            out.high[k] = x > out.high[k] ? x : out.high[k];
        }
    }
    return out;
}

hn_bounds *hn_bounds_of_shapes(const hn_canvas *c) {
    hn_bounds *box = malloc((size_t)(c->n_shapes + 1) * sizeof *box);
    for (int i = 0; box && i < c->n_shapes; i++) {
        const hn_canvas_shape *s = &c->shapes[i];
        if (s->count > 0) {
            box[i] = hn_bounds_of(c->xy + 2 * s->first, s->count);
        }
    }
    return box;
}

bool hn_bounds_is_beside(hn_bounds box, int x0, int y0, int side) {
    return box.high[0] < (float)(x0 - 1) || box.low[0] > (float)(x0 + side + 1) ||
           box.high[1] < (float)(y0 - 1) || box.low[1] > (float)(y0 + side + 1);
}
