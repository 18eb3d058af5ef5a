// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/assemble_rates.h"

#include "dynamics/assembly/assemble_least.h"
#include "dynamics/assembly/assemble_rows.h"
#include "dynamics/compile/coordinates.h"
#include "linalg/dense.h"
#include "linalg/saddle.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// a velocity gap below this times |J| |v| + |phi_t| is rounding
static const double VELOCITY_ROUNDING = 4 * DBL_EPSILON;

static const hn_coordinate *user_coordinate(const hn_assembler *s, int i) {
    return &s->scene->coordinates[hn_system_user_coordinate(s->sys, i)];
}

/// The least change of the free rates that closes J v + phi_t: J (nc x n_free), weight
/// (n_free x n_free).
typedef struct rate_problem {
    int n_free, *free;
    double *change, *gap;
    hn_assemble_least *least; ///< of large mechanisms where it serves; else NULL, and dense:
    // column k of T^-1: rates of the system coordinates for a unit rate of user coordinate k,
    // nonzeros only
    int *map_start, *map_row;
    double *map_value;
    double *J, *weight, *force;
    hn_saddle_ws *ws;
} rate_problem;

/// gap = J v + phi_t, and whether it is more than rounding.
static int velocity_gap(const hn_assembler *s, const double *v, double *gap) {
    const double *J = hn_eval_list(s->eval, HN_TERM_J),
                 *phi_t = hn_eval_get(s->eval, HN_TERM_PHI_T);
    const int *row, *col, n = hn_eval_pattern(s->eval, HN_TERM_J, &row, &col);
    int open = 0;
    for (int i = 0, k = 0; i < s->nc; i++) {
        double size = fabs(phi_t[i]);
        gap[i] = phi_t[i];
        for (; k < n && row[k] == i; k++) {
            double part = J[k] * v[col[k]];
            gap[i] += part;
            size += fabs(part);
        }
        open |= fabs(gap[i]) > VELOCITY_ROUNDING * size;
    }
    return open;
}

// ---- dense ----

/// T^-1 column by column, nonzeros only.
static hn_status read_map(const hn_assembler *s, rate_problem *p) {
    p->map_start = hn_arena_ints(s->arena, (size_t)s->n + 1);
    for (int pass = 0; pass < 2; pass++) {
        int count = 0;
        if (hn_arena_failed(s->arena)) {
            return HN_ERR_MEMORY;
        }
        for (int k = 0; k < s->n; k++) {
            p->map_start[k] = count;
            for (int i = 0; i < s->n; i++) {
                const double share = hn_rate_tree_share(&s->rates, i, k);
                if (pass == 1 && share != 0) {
                    p->map_row[count] = i;
                    p->map_value[count] = share;
                }
                count += share != 0;
            }
        }

        // counted: room for them
        p->map_start[s->n] = count;
        if (pass == 0) {
            p->map_row = hn_arena_ints(s->arena, (size_t)count);
            p->map_value = hn_arena_doubles(s->arena, (size_t)count);
        }
    }
    return HN_OK;
}

/// x' M y for two columns of T^-1, so that M in user rates costs only what is not zero.
static double user_mass(const hn_assembler *s, const rate_problem *p, int k, int l) {
    const double *M = s->M;
    double sum = 0;
    for (int e = p->map_start[k]; e < p->map_start[k + 1]; e++) {
        for (int d = p->map_start[l]; d < p->map_start[l + 1]; d++) {
            sum +=
                p->map_value[e] * M[(size_t)p->map_row[e] * s->n + p->map_row[d]] * p->map_value[d];
        }
    }
    return sum;
}

static hn_status init_dense(rate_problem *p, hn_assembler *s) {
    size_t n = (size_t)p->n_free, nc = (size_t)s->nc;
    p->J = hn_arena_doubles(s->arena, nc * n);
    p->weight = hn_arena_doubles(s->arena, n * n);
    p->force = hn_arena_doubles(s->arena, n);
    p->ws = hn_saddle_ws_create(s->arena, p->n_free, s->nc);
    double *row = hn_arena_doubles(s->arena, (size_t)s->n);
    if (!p->ws || !row || hn_arena_failed(s->arena)) {
        return HN_ERR_MEMORY;
    }

    // rows of J in these rates
    for (int i = 0; i < s->nc; i++) {
        hn_assemble_user_row(s, i, row);
        for (int k = 0; k < p->n_free; k++) {
            p->J[(size_t)i * p->n_free + k] = row[p->free[k]];
        }
    }
    return read_map(s, p);
}

/// Weight of least change: the mass matrix, or the plain sizes of the coordinates where mass alone
/// decides nothing.
static void fill_weight(const hn_assembler *s, rate_problem *p, int by_mass) {
    int n = p->n_free;
    (void)hn_assemble_dense(s, HN_TERM_M);
    for (int k = 0; k < n; k++) {
        for (int l = 0; l <= k; l++) {
            double reach = s->reach[p->free[k]];
            double w = by_mass ? user_mass(s, p, p->free[k], p->free[l])
                               : (k == l ? 1 / (reach * reach) : 0);
            p->weight[(size_t)k * n + l] = w;
        }
    }
}

static hn_status factor_rates(const hn_assembler *s, rate_problem *p) {
    fill_weight(s, p, 1);
    hn_status status = hn_saddle_factor(p->n_free, s->nc, p->weight, p->J, NULL, NULL, p->ws);
    if (status == HN_ERR_SINGULAR || status == HN_ERR_NOT_SPD) {
        fill_weight(s, p, 0);
        status = hn_saddle_factor(p->n_free, s->nc, p->weight, p->J, NULL, NULL, p->ws);
    }
    return status;
}

// ---- either way ----

static hn_status rate_problem_init(rate_problem *p, hn_assembler *s) {
    *p = (rate_problem){.free = hn_arena_ints(s->arena, (size_t)s->n),
                        .change = hn_arena_doubles(s->arena, (size_t)s->n),
                        .gap = hn_arena_doubles(s->arena, (size_t)s->nc)};
    if (hn_arena_failed(s->arena)) {
        return HN_ERR_MEMORY;
    }

    // rates that may change
    for (int i = 0; i < s->n; i++) {
        if (!user_coordinate(s, i)->v0_pinned) {
            p->free[p->n_free++] = i;
        }
    }

    // sparse where that serves
    if (hn_assemble_is_large(s)) {
        HN_TRY(hn_assemble_least_create(s, p->n_free, p->free, &p->least));
    }
    if (p->least) {
        return HN_OK;
    }
    HN_TRY(init_dense(p, s));
    return factor_rates(s, p);
}

/// The change of the user's rates (n) that closes p->gap, added to user_v.
static hn_status add_change(rate_problem *p, int n, double *user_v) {
    if (p->least) {
        hn_assemble_least_change(p->least, p->gap, p->change);
        hn_axpy(n, 1, p->change, user_v);
        return HN_OK;
    }
    HN_TRY(hn_saddle_apply(p->force, p->gap, p->change, NULL, NULL, p->ws));
    for (int k = 0; k < p->n_free; k++) {
        user_v[p->free[k]] += p->change[k];
    }
    return HN_OK;
}

/// "w1, w3" into text: the rates that are held.
static void list_pinned_rates(const hn_assembler *s, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < s->n && used + 1 < size; i++) {
        const hn_coordinate *c = user_coordinate(s, i);
        if (c->v0_pinned) {
            int wrote =
                snprintf(text + used, size - used, "%s%s = %.6g", used ? ", " : "", c->rate, c->v0);
            used += wrote > 0 ? (size_t)wrote : 0;
        }
    }
}

static hn_status report_contradiction(hn_assembler *s, const double *gap) {
    char pinned[160];
    list_pinned_rates(s, pinned, sizeof pinned);
    const char *pointer = NULL;
    for (int i = 0; i < s->n; i++) {
        pointer = user_coordinate(s, i)->v0_pinned ? user_coordinate(s, i)->v0_pointer : pointer;
    }
    return hn_diags_add(s->diags, HN_ERR_INCONSISTENT, pointer, "leave one of these rates out",
                        "the given rates %s contradict the closed loops: |J v| is at least %.3g "
                        "for any values of the other rates",
                        pinned[0] ? pinned : "(none)", hn_norm2(s->nc, gap));
}

/// Changes the free user rates least so that J v + phi_t = 0; v (n) in system rates, in and out.
static hn_status correct_rates(hn_assembler *s, double *user_v, double *v, rate_problem *p) {
    // the second round takes what rounding left of the first
    for (int round = 0; round < 2; round++) {
        const hn_status status = add_change(p, s->n, user_v);
        if (status == HN_ERR_INCONSISTENT) {
            return round == 0 ? report_contradiction(s, p->gap) : HN_OK;
        }
        if (status != HN_OK) {
            return status;
        }
        hn_system_rates_from_user(s->sys, user_v, v);
        if (!velocity_gap(s, v, p->gap)) {
            break;
        }
    }
    return HN_OK;
}

hn_status hn_assemble_rates(hn_assembler *s, double *v, hn_assembly *report) {
    double *user_v = hn_arena_doubles(s->arena, (size_t)s->n),
           *gap = hn_arena_doubles(s->arena, (size_t)s->nc);
    if (!user_v || !gap) {
        return HN_ERR_MEMORY;
    }

    // the rates asked for, and how far they open the loops
    for (int i = 0; i < s->n; i++) {
        user_v[i] = user_coordinate(s, i)->v0;
    }
    hn_system_rates_from_user(s->sys, user_v, v);
    hn_eval_run(s->eval, s->t, s->q, v);
    int open = velocity_gap(s, v, gap);
    report->velocity_gap_before = report->velocity_gap = hn_norm2(s->nc, gap);
    if (!open) {
        return HN_OK;
    }

    // the smallest change that closes them
    rate_problem p;
    HN_TRY(rate_problem_init(&p, s));
    memcpy(p.gap, gap, (size_t)s->nc * sizeof *gap);
    const hn_status status = correct_rates(s, user_v, v, &p);
    hn_assemble_least_free(p.least);

    (void)velocity_gap(s, v, gap);
    report->velocity_gap = hn_norm2(s->nc, gap);
    return status;
}
