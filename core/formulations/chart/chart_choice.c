// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/chart_choice.h"

#include "formulations/chart/chart_dependent.h"

#include "formulations/ground/flops.h"
#include "formulations/ground/unit_scales.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// Chooses the dependent columns of J. Volumes are products of the diagonal of R, kept as
// logarithms: a mechanism with hundreds of rows would overflow a plain determinant. Columns are
// scaled by 1 / sqrt(M_jj), so metres and radians can be compared.

#define RANK_TOL 1e-10
#define SINGULAR_TOL \
    1e-3 // smallest pivot of J against its largest: below, the pose is to blame and not the choice
#define DEAD_POINT 1e-6 // of the best volume: the coordinate asked for cannot serve
#define GAIN 1.01       // a change of columns that gains less is not worth it
#define BETTER 1.2      // a chart near its end is left for one better by this factor
#define STEPS_AHEAD \
    2 // |det J_d| is nearly linear in t there; twice the step leaves room for its bend
#define INDEPENDENT_TOL \
    1e-3 // residual of a column, relative to its length, that still counts as a new direction

static void fill_scaled(hn_chart *chart) {
    const double *J = hn_eval_list(chart->loop, HN_TERM_J);
    const size_t nv = (size_t)chart->nv, nc = (size_t)chart->nc;
    memset(chart->columns, 0, nv * nc * sizeof *chart->columns);
    for (int e = 0; e < chart->n_J; e++) {
        const size_t i = (size_t)chart->J_row[e], j = (size_t)chart->J_col[e];
        chart->columns[j * nc + i] = J[e] * chart->scale[j];
    }
}

static double log_of_diagonal(const hn_qr *qr, int rank) {
    double sum = 0;
    for (int k = 0; k < rank; k++) {
        sum += log(fabs(qr->a[k * qr->m + k]));
    }
    return sum;
}

// the best choice by pivoting: its rank, log volume and columns (new_dep)
static int choose_by_pivots(hn_chart *chart, double *volume) {
    memcpy(chart->all.a, chart->columns, (size_t)chart->nc * (size_t)chart->nv * sizeof(double));
    hn_qr_factor(&chart->all, chart->nc, chart->nv, RANK_TOL);
    chart->cost.factorisations++;
    chart->cost.ops += hn_flops_qr(chart->nc, chart->nv);
    memcpy(chart->new_dep, chart->all.perm, (size_t)chart->all.rank * sizeof(int));
    *volume = log_of_diagonal(&chart->all, chart->all.rank);
    return chart->all.rank;
}

enum { TURN_BALL, TURN_PASSIVE, TURN_ACTUATED, N_TURNS };

static int turn_of(const hn_chart *chart, int j) {
    const hn_scene *scene = hn_system_scene(chart->sys);
    if (chart->at[j] < 0) {
        return TURN_BALL;
    }
    const int known = j < hn_system_get_info(chart->sys).n_user;
    return known && scene->coordinates[hn_system_user_coordinate(chart->sys, j)].actuated
               ? TURN_ACTUATED
               : TURN_PASSIVE;
}

// speeds of balls first, then last coordinates first, actuated ones after all others, `first` at
// the very end
static void order_columns(hn_chart *chart, int first) {
    int n = 0;
    for (int turn = 0; turn < N_TURNS; turn++) {
        for (int j = chart->nv - 1; j >= 0; j--) {
            if (j != first && turn_of(chart, j) == turn) {
                chart->order[n++] = j;
            }
        }
    }
    if (first >= 0) {
        chart->order[n] = first;
    }
}

// Length of what a column adds to the first k basis vectors; it becomes basis vector k when it is
// long enough.
static double try_column(hn_chart *chart, int column, int k) {
    const int nc = chart->nc;
    double *next = chart->basis + k * nc;
    memcpy(next, chart->columns + column * nc, (size_t)nc * sizeof(double));
    const double length = hn_norm2(nc, next);
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < k; i++) {
            const double *b = chart->basis + i * nc;
            hn_axpy(nc, -hn_dot(nc, b, next), b, next);
        }
    }
    const double rest = hn_norm2(nc, next);
    chart->cost.ops += 8.0 * nc * k;
    if (!(rest > INDEPENDENT_TOL * length) || rest == 0) {
        return 0;
    }
    for (int i = 0; i < nc; i++) {
        next[i] /= rest;
    }
    return rest;
}

// the choice by preference: fills dep and gives its log volume, or -HUGE_VAL when too few columns
// were independent
static double choose_by_order(hn_chart *chart, int first, int rank) {
    int n = 0;
    double volume = 0;
    order_columns(chart, first);
    for (int k = 0; k < chart->nv - (first >= 0) && n < rank; k++) {
        const double length = try_column(chart, chart->order[k], n);
        if (length > 0) {
            chart->dep[n++] = chart->order[k];
            volume += log(length);
        }
    }
    return n == rank ? volume : -HUGE_VAL;
}

static void sort_choice(hn_chart *chart) {
    int n_dep = 0, n_ind = 0;
    for (int j = 0; j < chart->nv; j++) {
        chart->order[j] = 0;
    }
    for (int k = 0; k < chart->rank; k++) {
        chart->order[chart->dep[k]] = 1;
    }
    for (int j = 0; j < chart->nv; j++) {
        if (chart->order[j]) {
            chart->dep[n_dep++] = j;
        } else {
            chart->ind[n_ind++] = j;
        }
    }
}

static void scale_columns(hn_chart *chart, double t, const double *q, const double *no_speed) {
    hn_eval_run(chart->full, t, q, no_speed);
    hn_unit_scales(chart->sys, hn_eval_get(chart->full, HN_TERM_M), chart->nv + 1, chart->scale);
}

// 1 when all speeds of balls are dependent, or may be independent
static bool serves(const hn_chart *chart) {
    for (int j = 0; j < chart->r && chart->plain_only; j++) {
        if (chart->at[chart->ind[j]] < 0) {
            return false;
        }
    }
    return true;
}

static hn_status fail_ball(hn_chart *chart, double t, int column) {
    const hn_scene *scene = hn_system_scene(chart->sys);
    const hn_coordinate *c = &scene->coordinates[hn_system_user_coordinate(chart->sys, column)];
    snprintf(chart->why, sizeof chart->why,
             "no set of independent coordinates at t = %.6g s: the rotation of %s would have to be "
             "independent, and the entries of an orientation cannot be; nullspace and projection "
             "can be used",
             t, c->joint >= 0 ? scene->joints[c->joint].name : c->name);
    return HN_ERR_UNSUPPORTED;
}

static hn_status refuse_ball(hn_chart *chart, double t) {
    int j = 0;
    while (j < chart->r && chart->at[chart->ind[j]] >= 0) {
        j++;
    }
    return fail_ball(chart, t, chart->ind[j]);
}

static void eval_here(hn_chart *chart, double t, const double *q) {
    memset(chart->here.s, 0, (size_t)chart->nv * sizeof(double));
    scale_columns(chart, t, q, chart->here.s);
    hn_eval_run(chart->loop, t, q, chart->here.s);
}

static void begin(hn_chart *chart) {
    sort_choice(chart);
    hn_chart_set_columns(chart);
    chart->here.valid = chart->probe.valid = chart->base.valid = 0;
    chart->is_measured = 0;
    chart->has_rate = false;
}

// the pair of columns whose exchange makes |det J_d| largest, and by how much
static double best_exchange(const hn_chart *chart, const hn_chart_point *at, int *dep, int *ind) {
    double best = 0;
    for (int k = 0; k < chart->rank; k++) {
        for (int j = 0; j < chart->r && !(chart->plain_only && chart->at[chart->dep[k]] < 0); j++) {
            const double gain = hn_chart_exchange(chart, at, k, j);
            if (gain > best) {
                best = gain;
                *dep = k;
                *ind = j;
            }
        }
    }
    return best;
}

// from the present choice, one exchange after the other while the volume grows
static hn_status improve(hn_chart *chart, double t, const double *q) {
    for (int turn = 0; turn <= chart->nv; turn++) {
        int k = 0, j = 0;
        if (!hn_chart_factor(chart, &chart->here)) {
            break;
        }
        hn_chart_make_basis(chart, &chart->here);
        if (!(best_exchange(chart, &chart->here, &k, &j) > GAIN)) {
            begin(chart);
            return HN_OK;
        }
        const int column = chart->dep[k];
        chart->dep[k] = chart->ind[j];
        chart->ind[j] = column;
        begin(chart);
    }
    const int full = hn_chart_has_full_rank(chart, t, q);
    return hn_chart_fail(
        chart, HN_ERR_CHART, t, q,
        full ? "no choice of coordinates is regular enough here"
             : "a singular configuration: no choice of coordinates is regular there");
}

bool hn_chart_has_full_rank(hn_chart *chart, double t, const double *q) {
    double volume;
    eval_here(chart, t, q);
    fill_scaled(chart);
    memcpy(chart->all.a, chart->columns, (size_t)chart->nc * (size_t)chart->nv * sizeof(double));
    hn_qr_factor(&chart->all, chart->nc, chart->nv, 0);
    chart->here.valid = 0;
    volume = chart->all.rank == chart->rank && chart->rank > 0 ? hn_qr_pivot_ratio(&chart->all) : 0;
    return volume > SINGULAR_TOL;
}

// The first choice of an instance is made from all of J, densely; later ones begin with the same
// columns and exchange some where those have become poor. So a choice depends on the first state
// and on the present one, not on what was between.
static hn_status choose_from(hn_chart *chart, const int *dep, double t, const double *q,
                             int first) {
    int k, j;
    const double limit = first >= 0 ? 1 / DEAD_POINT : 1 / HN_CHART_TAU;
    memcpy(chart->dep, dep, (size_t)chart->rank * sizeof *chart->dep);
    begin(chart);
    chart->pivot_start = 0;
    if (hn_chart_factor(chart, &chart->here)) {
        hn_chart_make_basis(chart, &chart->here);
        if (best_exchange(chart, &chart->here, &k, &j) <= limit) {
            begin(chart);
            return HN_OK;
        }
    }
    if (first >= 0) {
        return hn_chart_fail(chart, HN_ERR_CHART, t, q,
                             "a dead point: this coordinate cannot be independent here");
    }
    return improve(chart, t, q);
}

/// The first choice of a large mechanism whose rows stand well apart: by preference, and then
/// exchanges while that one is poor. *found = false: the dense choice decides.
static hn_status choose_sparsely(hn_chart *chart, double t, const double *q, int first,
                                 bool *found) {
    *found =
        chart->choice && (chart->rank < 0 || chart->rank == chart->nc) &&
        hn_row_check_run_list(chart->check, hn_eval_list(chart->loop, HN_TERM_J), chart->scale);
    if (!*found) {
        return HN_OK;
    }

    // the preferred columns
    for (int e = 0; e < chart->n_J; e++) {
        chart->entry[e] = hn_eval_list(chart->loop, HN_TERM_J)[e] * chart->scale[chart->J_col[e]];
    }
    order_columns(chart, first);
    const int n = hn_column_choice_run(chart->choice, chart->entry, chart->order,
                                       chart->nv - (first >= 0), INDEPENDENT_TOL, chart->new_dep);
    *found = n == chart->nc;
    if (!*found) {
        return HN_OK;
    }

    // better ones where these are poor
    chart->rank = chart->nc;
    chart->r = chart->nv - chart->nc;
    HN_TRY(choose_from(chart, chart->new_dep, t, q, first));
    if (first == HN_CHART_BEST) {
        HN_TRY(improve(chart, t, q));
    }
    return serves(chart) ? HN_OK : refuse_ball(chart, t);
}

static hn_status choose_first(hn_chart *chart, double t, const double *q, int first) {
    double best = 0;
    bool found;
    const int rank_before = chart->rank;
    const hn_status status = choose_sparsely(chart, t, q, first, &found);
    if (found) {
        return status;
    }

    // the rank, and the best choice by pivoting
    fill_scaled(chart);
    const int rank = choose_by_pivots(chart, &best);
    if (rank_before >= 0 && rank != rank_before) {
        return hn_chart_fail(
            chart, HN_ERR_CHART, t, q,
            "the number of degrees of freedom changed: the configuration is singular");
    }
    chart->rank = rank;
    chart->r = chart->nv - rank;

    // the choice by preference, and whether the coordinate asked for can serve
    const double preferred = choose_by_order(chart, first, rank);
    if (first >= 0 && !(preferred > best + log(DEAD_POINT))) {
        chart->ind[0] = first;
        return hn_chart_fail(chart, HN_ERR_CHART, t, q,
                             "a dead point: this coordinate cannot be independent here");
    }

    // pivots decide where the preferred choice is poor
    sort_choice(chart);
    const int preferred_serves = preferred > -HUGE_VAL && serves(chart);
    if (first == HN_CHART_BEST ||
        (first == HN_CHART_PREFERRED && preferred < best + log(HN_CHART_TAU))) {
        memcpy(chart->dep, chart->new_dep, (size_t)rank * sizeof(int));
        sort_choice(chart);
        if (!serves(chart) && preferred_serves) {
            (void)choose_by_order(chart, first, rank);
        }
    }

    begin(chart);
    chart->pivot_start = 0;
    return serves(chart) ? HN_OK : refuse_ball(chart, t);
}

hn_status hn_chart_choose(hn_chart *chart, double t, const double *q, int first) {
    eval_here(chart, t, q);
    if (!chart->has_first || chart->rank < chart->nc) {
        const hn_status status = choose_first(chart, t, q, first);
        if (status == HN_OK && !chart->has_first) {
            memcpy(chart->first_dep, chart->dep, (size_t)chart->rank * sizeof *chart->dep);
            chart->has_first = 1;
        }
        return status;
    }
    return first == HN_CHART_BEST ? improve(chart, t, q)
                                  : choose_from(chart, chart->first_dep, t, q, first);
}

// the column of a ball that would have been a much better independent coordinate at `base` than
// those that are, -1: none, or a plain coordinate would have been too
static int find_holding_ball(const hn_chart *chart) {
    int held_by = -1;
    double best = 1 / HN_CHART_TAU;
    for (int k = 0; k < chart->rank && chart->plain_only && chart->base.valid; k++) {
        for (int j = 0; j < chart->r; j++) {
            const double gain = hn_chart_exchange(chart, &chart->base, k, j);
            if (gain > 1 / HN_CHART_TAU && chart->at[chart->dep[k]] >= 0) {
                return -1;
            }
            held_by = gain > best ? chart->dep[k] : held_by;
            best = fmax(best, gain);
        }
    }
    return held_by;
}

hn_status hn_chart_choose_other(hn_chart *chart) {
    int k = 0, j = 0;
    if (!chart->base.valid || !(best_exchange(chart, &chart->base, &k, &j) > GAIN)) {
        return HN_ERR_CHART;
    }
    return hn_chart_choose(chart, chart->base.t, chart->base.q, HN_CHART_BEST);
}

// the coordinate that would have been the better independent one at `base`, for a user who chose
static void add_advice(hn_chart *chart) {
    int k = 0, j = 0;
    if (!chart->base.valid || !(best_exchange(chart, &chart->base, &k, &j) > GAIN)) {
        return;
    }
    const int column = chart->dep[k];
    const size_t used = strlen(chart->why);
    const char *name = column < hn_system_get_info(chart->sys).n_user
                           ? hn_system_scene(chart->sys)
                                 ->coordinates[hn_system_user_coordinate(chart->sys, column)]
                                 .name
                           : "of a joint";
    snprintf(chart->why + used, sizeof chart->why - used,
             "; coordinate=%d (%.30s) passes this configuration", column + 1, name);
}

hn_status hn_chart_fail_end(hn_chart *chart, double t, const double *q, const char *what) {
    const int ball = find_holding_ball(chart);
    if (ball >= 0) {
        return fail_ball(chart, t, ball);
    }
    (void)hn_chart_fail(chart, HN_ERR_CHART, t, q, what);
    if (chart->advises) {
        add_advice(chart);
    }
    return HN_ERR_CHART;
}

bool hn_chart_nears_end(const hn_chart *chart, double h) {
    return chart->has_rate && chart->volume + STEPS_AHEAD * h * chart->volume_rate < 0;
}

bool hn_chart_is_poor(hn_chart *chart, double h, double tau) {
    int k, j;
    if (chart->rank <= 0 || chart->r == 0) {
        return false;
    }
    const double gain = best_exchange(chart, &chart->here, &k, &j);
    chart->cost.ops += 3.0 * chart->rank * chart->r;
    return (gain * tau > 1 && gain > 2) ||
           (tau > 0 && gain > BETTER && hn_chart_nears_end(chart, h));
}
