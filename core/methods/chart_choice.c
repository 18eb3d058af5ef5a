#include "methods/chart.h"

#include "linalg/dense.h"
#include "methods/flops.h"

#include <math.h>
#include <string.h>

// Which columns of J are dependent. Volumes are products of the diagonal of R, kept as logarithms: a mechanism with
// hundreds of rows would overflow a plain determinant. Columns are scaled by 1 / sqrt(M_jj), so metres and radians can
// be compared.

#define RANK_TOL 1e-10
#define DEAD_POINT 1e-6 // of the best volume: the coordinate asked for cannot serve
#define INDEPENDENT_TOL \
    1e-3 // residual of a column, relative to its length, that still counts as a new direction

static void fill_scaled(hn_chart *chart, const double *J) {
    for (int j = 0; j < chart->nv; j++) {
        for (int i = 0; i < chart->nc; i++) {
            chart->columns[j * chart->nc + i] = J[i * chart->nv + j] * chart->scale[j];
        }
    }
}

static double log_volume(const hn_qr *qr, int rank) {
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
    *volume = log_volume(&chart->all, chart->all.rank);
    return chart->all.rank;
}

// last coordinates first, actuated ones after all others, `first` at the very end
static void order_columns(hn_chart *chart, int first) {
    const hn_scene *scene = hn_system_scene(chart->sys);
    const int n_user = hn_system_get_info(chart->sys).n_user;
    int n = 0;
    for (int wanted = 0; wanted <= 1; wanted++) {
        for (int j = chart->nv - 1; j >= 0; j--) {
            const int actuated =
                j < n_user && scene->coordinates[hn_system_user_coordinate(chart->sys, j)].actuated;
            if (j != first && (actuated != 0) == wanted) {
                chart->order[n++] = j;
            }
        }
    }
    if (first >= 0) {
        chart->order[n] = first;
    }
}

// Length of what a column adds to the first k basis vectors; it becomes basis vector k when it is long enough.
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

// the choice by preference: fills dep and gives its log volume, or -HUGE_VAL when too few columns were independent
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
    const double *M = hn_eval_get(chart->full, HN_TERM_M);
    for (int j = 0; j < chart->nv; j++) {
        const double mass = M[j * chart->nv + j];
        chart->scale[j] = mass > 0 ? 1 / sqrt(mass) : 1; // a massless coordinate keeps its own unit
    }
}

hn_status hn_chart_choose(hn_chart *chart, double t, const double *q, int first) {
    const int rank_before = chart->rank;
    double best = 0;
    memset(chart->here.s, 0, (size_t)chart->nv * sizeof(double));
    scale_columns(chart, t, q, chart->here.s);
    hn_eval_run(chart->loop, t, q, chart->here.s);
    fill_scaled(chart, hn_eval_get(chart->loop, HN_TERM_J));
    const int rank = choose_by_pivots(chart, &best);
    if (rank_before >= 0 && rank != rank_before) {
        return hn_chart_fail(chart, HN_ERR_CHART, t, q,
                             "the number of freedoms changed: the pose is singular");
    }
    chart->rank = rank;
    chart->r = chart->nv - rank;
    const double preferred = choose_by_order(chart, first, rank);
    if (first >= 0 && !(preferred > best + log(DEAD_POINT))) {
        chart->ind[0] = first;
        return hn_chart_fail(chart, HN_ERR_CHART, t, q,
                             "a dead point: this coordinate cannot be independent here");
    }
    if (first == HN_CHART_BEST ||
        (first == HN_CHART_PREFERRED && preferred < best + log(HN_CHART_TAU))) {
        memcpy(chart->dep, chart->new_dep, (size_t)rank * sizeof(int));
    }
    sort_choice(chart);
    chart->here.valid = chart->probe.valid = chart->base.valid = 0;
    chart->pivot_start = 0;
    return HN_OK;
}

int hn_chart_is_poor(hn_chart *chart, double tau) {
    double best = 0;
    if (chart->rank == 0 || chart->r == 0) {
        return 0;
    }
    fill_scaled(chart, chart->here.J);
    if (choose_by_pivots(chart, &best) != chart->rank) {
        return 0; // rank lost at this pose: no choice is better than another
    }
    const double present = log_volume(&chart->here.jd, chart->rank);
    return present < best + log(tau) && present < best - log(2);
}
