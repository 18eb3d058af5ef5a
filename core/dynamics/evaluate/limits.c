// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/limits.h"

#include "dynamics/evaluate/inputs.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

struct hn_limits {
    hn_inputs in;
    int n, *coordinate;
};

static bool is_limited(const hn_system *sys, int i) {
    const hn_coordinate *c = &sys->scene->coordinates[i];
    return (c->min > -HUGE_VAL || c->max < HUGE_VAL) && sys->user_known[i] == HN_KNOWN_BOTH;
}

static hn_status compile(hn_limits *l, const hn_system *sys, hn_arena *arena) {
    hn_ex *outputs = malloc((size_t)l->n * sizeof *outputs);
    if (!outputs) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < l->n; i++) {
        outputs[i] = sys->user_q[l->coordinate[i]];
    }
    // only the graph grows
    hn_status status = hn_inputs_compile(sys, outputs, l->n, arena, &l->in);
    free(outputs);
    return status;
}

hn_status hn_limits_create(const hn_system *sys, hn_arena *arena, hn_limits **out) {
    const int n = sys->scene->n_coordinates;
    hn_limits *l = hn_arena_get(arena, sizeof *l);
    *out = NULL;
    if (!l) {
        return HN_ERR_MEMORY;
    }
    *l = (hn_limits){.coordinate = hn_arena_ints(arena, (size_t)n + 1)};
    if (!l->coordinate) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < n; i++) {
        if (is_limited(sys, i)) {
            l->coordinate[l->n++] = i;
        }
    }
    HN_TRY(l->n > 0 ? compile(l, sys, arena) : HN_OK);
    *out = l;
    return HN_OK;
}

void hn_limits_free(hn_limits *l) {
    if (l) {
        hn_inputs_free(&l->in);
    }
}

int hn_limits_count(const hn_limits *l) {
    return l->n;
}

int hn_limits_coordinate(const hn_limits *l, int i) {
    HN_ASSERT(i >= 0 && i < l->n);
    return l->coordinate[i];
}

void hn_limits_eval(hn_limits *l, double t, const double *q, double *values) {
    if (l->n == 0) {
        return;
    }
    hn_inputs_set(&l->in, t, q, NULL, 0, 0);
    hn_tape_run(l->in.tape, l->in.x);
    for (int i = 0; i < l->n; i++) {
        values[i] = l->in.x[l->in.slots[i]];
    }
}
