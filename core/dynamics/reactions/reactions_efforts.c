// SPDX-License-Identifier: GPL-3.0-or-later
// Energies given as formulas beside bodies, as what they do along the scene's coordinates x; and
// the list of efforts.
//
//     Q_i  = dT/dx_i - dV/dx_i - d/dt dT/dx_i' = c_i - sum_k m_ik a_k                          (1)
//     c_i  = dT/dx_i - dV/dx_i - sum_j (d2T/dx_i'dx_j x_j' + d2T/dx_i'dx_j' g_j)
//     m_ik = sum_j d2T/dx_i'dx_j' dx_j'/du_k
//
// a: accelerations of the system, g_j: x_j'' at a = 0. Lagrange's derivative is the same covector
// in any coordinates, so (1) does the work along the scene's coordinates that the equations of
// motion, traced in the system's own, say it does.
#include "dynamics/reactions/reactions_efforts.h"

#include "dynamics/compile/formula.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/// While it is built; n scene coordinates.
typedef struct derivation {
    const hn_system *sys;
    hn_graph *g;
    int n;
    int *symbols;      ///< 2 n: of coordinates, then of rates
    hn_ex *x, *rates;  ///< n each, side by side: the symbols themselves
    hn_ex *along;      ///< 2 n: how they move at a = 0
    hn_ex *T_x, *V_x;  ///< n
    hn_ex *p, *p_rate; ///< n: dT/dx', and what of its rate has no a
    hn_ex *row;        ///< n or nv
    hn_ex kinetic, potential;
} derivation;

static hn_status begin(hn_reactions *r, hn_arena *arena, derivation *d) {
    const hn_system *sys = r->sys; // only its graph grows
    const hn_lagrangian *l = &r->scene->lagrangian;
    const size_t n = (size_t)r->scene->n_coordinates;
    const size_t widest = n > (size_t)r->nv ? n : (size_t)r->nv;
    *d = (derivation){.sys = sys, .g = sys->g, .n = (int)n};
    d->symbols = hn_arena_ints(arena, 2 * n);
    d->x = hn_arena_get(arena, (8 * n + widest) * sizeof *d->x);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // one block of memory, in parts
    d->rates = d->x + n;
    d->along = d->x + 2 * n;
    d->T_x = d->x + 4 * n;
    d->V_x = d->x + 5 * n;
    d->p = d->x + 6 * n;
    d->p_rate = d->x + 7 * n;
    d->row = d->x + 8 * n;

    // symbols in place of the coordinates, and how they move at a = 0
    hn_system_stand_ins(sys, "coordinate", d->x, d->symbols);
    hn_system_stand_ins(sys, "rate", d->rates, d->symbols + n);
    memcpy(d->along, sys->user_v, n * sizeof *d->along);
    memcpy(d->along + n, sys->user_gamma, n * sizeof *d->along);

    HN_TRY(hn_system_quantity_of(sys, &l->kinetic, d->x, d->rates, &d->kinetic));
    return hn_system_quantity_of(sys, &l->potential, d->x, d->rates, &d->potential);
}

/// Puts the coordinates' own expressions back.
static hn_ex put_back(const derivation *d, hn_ex e) {
    hn_ex half, out;
    hn_substitute(d->g, &e, 1, d->symbols, d->sys->user_q, d->n, &half);
    hn_substitute(d->g, &half, 1, d->symbols + d->n, d->sys->user_v, d->n, &out);
    return out;
}

/// m_ik of coordinate i: as entries (at, k).
static void add_inertia(derivation *d, int i, int at, hn_entries *inertia) {
    hn_ex *by_rate = d->T_x; // read already
    hn_diff_reverse(d->g, d->p[i], d->symbols + d->n, d->n, by_rate);

    const int first = inertia->n;
    for (int j = 0; j < d->n; j++) {
        // the mass along coordinate j, then x_j' by the system's velocities
        const hn_ex m = put_back(d, by_rate[j]);
        if (hn_is_zero(m)) {
            continue;
        }
        hn_diff_reverse(d->g, d->sys->user_v[j], d->sys->v_symbols, d->sys->nv, d->row);
        for (int k = 0; k < d->sys->nv; k++) {
            const hn_ex e = hn_mul(d->g, m, d->row[k]);

            // one entry for each acceleration
            int at_entry = first;
            while (at_entry < inertia->n && inertia->at[at_entry].col != k) {
                at_entry++;
            }
            if (at_entry < inertia->n) {
                inertia->at[at_entry].e = hn_add(d->g, inertia->at[at_entry].e, e);
            } else {
                hn_entries_add(inertia, at, k, e);
            }
        }
    }
}

hn_status hn_reaction_derive_energies(hn_reactions *r, hn_arena *arena, hn_ex **at_zero,
                                      hn_entries *inertia) {
    derivation d;
    HN_TRY(begin(r, arena, &d));

    // derivatives of (1)
    hn_diff_reverse(d.g, d.kinetic, d.symbols, d.n, d.T_x);
    hn_diff_reverse(d.g, d.potential, d.symbols, d.n, d.V_x);
    hn_diff_reverse(d.g, d.kinetic, d.symbols + d.n, d.n, d.p);
    hn_diff_forward(d.g, d.p, d.n, d.symbols, d.along, 2 * d.n, d.p_rate);

    r->energy_coordinate = hn_arena_ints(arena, (size_t)d.n + 1);
    r->energy = hn_arena_doubles(arena, (size_t)d.n + 1);
    *at_zero = hn_arena_get(arena, ((size_t)d.n + 1) * sizeof **at_zero);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // what they do at zero accelerations, where they do anything
    for (int i = 0; i < d.n; i++) {
        const hn_ex terms[3] = {d.T_x[i], hn_neg(d.V_x[i]), hn_neg(d.p_rate[i])};
        const hn_ex e = put_back(&d, hn_sum(d.g, terms, 3));
        if (!hn_is_zero(e) || !hn_is_zero(d.p[i])) {
            (*at_zero)[r->n_energies] = e;
            r->energy_coordinate[r->n_energies++] = i;
        }
    }

    // and per acceleration
    for (int i = 0; i < r->n_energies; i++) {
        add_inertia(&d, r->energy_coordinate[i], i, inertia);
    }
    r->n_inertia = inertia->n;
    r->inertia = hn_arena_get(arena, ((size_t)inertia->n + 1) * sizeof *r->inertia);
    for (int k = 0; k < inertia->n && r->inertia; k++) {
        r->inertia[k] = inertia->at[k];
    }
    return hn_arena_failed(arena) || inertia->failed ? HN_ERR_MEMORY : HN_OK;
}

void hn_reaction_read_energies(hn_reactions *r, const double *a) {
    for (int i = 0; i < r->n_energies; i++) {
        r->energy[i] = hn_reaction_value(r, r->first_energy + i);
    }
    for (int k = 0; k < r->n_inertia; k++) {
        r->energy[r->inertia[k].row] -=
            hn_reaction_value(r, r->first_inertia + k) * a[r->inertia[k].col];
    }
}

// ---- the list ----

bool hn_reaction_is_formal(const hn_reactions *r, int coordinate) {
    const int joint = r->scene->coordinates[coordinate].joint;
    return joint < 0 || r->scene->joints[joint].is_formal;
}

hn_status hn_reaction_list_efforts(hn_reactions *r, hn_arena *arena) {
    const hn_entries *rows = &r->sys->efforts;
    r->efforts =
        hn_arena_get(arena, ((size_t)rows->n + (size_t)r->n_energies + 1) * sizeof *r->efforts);
    if (!r->efforts) {
        return HN_ERR_MEMORY;
    }
    for (int k = 0; k < rows->n; k++) {
        r->efforts[r->n_efforts++] =
            (hn_effort){.name = hn_system_row_name(r->sys, rows->at[k].row),
                        .row = rows->at[k].row,
                        .coordinate = rows->at[k].col};
    }
    for (int i = 0; i < r->n_energies; i++) {
        if (!hn_reaction_is_formal(r, r->energy_coordinate[i])) {
            r->efforts[r->n_efforts++] =
                (hn_effort){.name = "energies", .row = -1, .coordinate = r->energy_coordinate[i]};
        }
    }
    return HN_OK;
}

void hn_reaction_read_efforts(hn_reactions *r, const double *lambda) {
    hn_effort *e = r->efforts;
    for (int k = 0; k < r->sys->efforts.n; k++, e++) {
        e->value = lambda[e->row] * hn_reaction_value(r, r->first_effort + k);
        e->determined = 1;
    }
    for (int i = 0; i < r->n_energies; i++) {
        if (!hn_reaction_is_formal(r, r->energy_coordinate[i])) {
            e->value = r->energy[i];
            (e++)->determined = 1;
        }
    }
}
