// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/step/compensated.h"

#include <string.h>

const char *const hn_compensated_choices[2] = {"plain", "compensated"};

int hn_compensated_init(hn_compensated *c, int n, hn_arena *arena) {
    *c = (hn_compensated){.n = n};
    c->kept = hn_arena_doubles(arena, (size_t)n);
    c->trial = hn_arena_doubles(arena, (size_t)n);
    return c->kept && c->trial;
}

void hn_compensated_switch(hn_compensated *c, int on) {
    c->on = on;
}

// eq. (1); the part of y + s that rounding cut off is found whichever of the two is larger
void hn_compensated_add(hn_compensated *c, int first, int n, const double *y,
                        const double *increment, double *y_new) {
    for (int i = 0; i < n && !c->on; i++) {
        y_new[first + i] = y[first + i] + increment[i];
    }
    for (int i = 0; i < n && c->on; i++) {
        const int k = first + i;
        const double s = increment[i] + c->kept[k], sum = y[k] + s, part = sum - y[k];
        c->trial[k] = (y[k] - (sum - part)) + (s - part);
        y_new[k] = sum;
    }
}

void hn_compensated_accepted(hn_compensated *c, int changed) {
    if (!c->on) {
        return;
    }
    if (changed) {
        memset(c->kept, 0, (size_t)c->n * sizeof *c->kept);
        return;
    }
    double *const spent = c->kept;
    c->kept = c->trial;
    c->trial = spent;
}
