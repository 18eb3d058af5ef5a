// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/rate_tree.h"

#include "dynamics/compile/system_impl.h"

/// Bases and signs of angles and slides; the rates of balls and of formulas are the user's own.
static void list_links(hn_rate_tree *r, const hn_system *sys) {
    for (int i = 0; i < r->n; i++) {
        r->base[i] = -1;
        r->sign[i] = 1;
    }
    for (int k = 0; k < sys->tree.n_order && !sys->scene->is_lagrangian; k++) {
        const hn_link *l = &sys->tree.links[sys->tree.order[k]];
        if (l->n_speeds == 1) {
            r->base[l->coordinate] = l->angle_ref;
            r->sign[l->coordinate] = l->sign;
        }
    }
}

/// Those without a base, then those that the tree lists, bases first.
static void list_order(hn_rate_tree *r, const hn_system *sys) {
    int n = 0;
    for (int i = 0; i < r->n; i++) {
        if (r->base[i] < 0) {
            r->order[n++] = i;
        }
    }
    for (int k = 0; k < sys->tree.n_order && !sys->scene->is_lagrangian; k++) {
        const hn_link *l = &sys->tree.links[sys->tree.order[k]];
        if (l->n_speeds == 1 && l->angle_ref >= 0) {
            r->order[n++] = l->coordinate;
        }
    }
    HN_ASSERT(n == r->n);
}

/// Each with a number, and behind it, one after the other, all that is counted from it.
static void number(hn_rate_tree *r, int *next) {
    for (int i = 0; i < r->n; i++) {
        r->beyond[i] = 1; // how many, itself included, at first
    }
    for (int k = r->n - 1; k >= 0; k--) {
        const int i = r->order[k];
        if (r->base[i] >= 0) {
            r->beyond[r->base[i]] += r->beyond[i];
        }
    }
    int top = 0;
    for (int k = 0; k < r->n; k++) {
        const int i = r->order[k], base = r->base[i], count = r->beyond[i];
        int *at = base < 0 ? &top : &next[base];
        r->first[i] = *at;
        r->beyond[i] = *at += count;
        next[i] = r->first[i] + 1;
    }
}

hn_status hn_rate_tree_init(hn_rate_tree *r, const hn_system *sys, hn_arena *arena) {
    const size_t n = (size_t)sys->nv;
    *r = (hn_rate_tree){.n = sys->nv,
                        .base = hn_arena_ints(arena, n),
                        .sign = hn_arena_doubles(arena, n),
                        .order = hn_arena_ints(arena, n),
                        .first = hn_arena_ints(arena, n),
                        .beyond = hn_arena_ints(arena, n)};
    int *next = hn_arena_ints(arena, n);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    list_links(r, sys);
    list_order(r, sys);
    number(r, next);
    return HN_OK;
}

double hn_rate_tree_share(const hn_rate_tree *r, int i, int k) {
    return r->first[k] <= r->first[i] && r->first[i] < r->beyond[k] ? r->sign[k] : 0;
}
