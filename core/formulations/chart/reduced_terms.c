// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/reduced_terms.h"

#include "dynamics/compile/coordinates.h"
#include "formulations/ground/reduced_mass.h"
#include "linalg/dense.h"
#include "linalg/lu.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// of the forces it is the difference of: h and g are derived twice, in different orders of
// summation
#define TAU_BLUR 1e-13

const char *hn_reduced_choice_text(hn_reduced_choice choice) {
    static const char *const texts[] = {"the motors", "the choice of the reduced method here",
                                        "the coordinates that carry the motion best here"};
    return texts[choice];
}

// ---- memory ----

static hn_status allocate(hn_reduced_terms *w, hn_arena *arena) {
    const size_t n = (size_t)w->nv;
    double **const vectors[] = {&w->velocity_part,
                                &w->s,
                                &w->v_r,
                                &w->a_r,
                                &w->g_r,
                                &w->tau_r,
                                &w->d_r,
                                &w->offset,
                                &w->unit,
                                &w->v,
                                &w->x,
                                &w->y,
                                &w->force,
                                w->quadratic,
                                w->quadratic + 1,
                                w->quadratic + 2,
                                w->quadratic + 3};
    double **const matrices[] = {&w->Phi, &w->M_r, &w->C_r, &w->basis, &w->rates, &w->square};

    // one spare entry, so that systems without coordinates get memory too
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        *vectors[i] = hn_arena_doubles(arena, n + 1);
    }
    for (size_t i = 0; i < sizeof matrices / sizeof *matrices; i++) {
        *matrices[i] = hn_arena_doubles(arena, n * n + 1);
    }

    w->ind = hn_arena_ints(arena, n + 1);
    w->pivot = hn_arena_ints(arena, n + 1);
    const int ok = hn_qr_init(&w->rows, arena, w->nv, w->nv);
    return ok && !hn_arena_failed(arena) ? HN_OK : HN_ERR_MEMORY;
}

static bool closures_move(const hn_system *sys) {
    const hn_system_exprs x = hn_system_get_exprs(sys);
    for (int i = 0; i < hn_system_get_info(sys).nc; i++) {
        if (!hn_is_zero(x.phi_t[i])) {
            return true;
        }
    }
    return false;
}

hn_status hn_reduced_terms_init(hn_reduced_terms *w, const hn_system *sys, hn_arena *arena,
                                hn_diag *diag) {
    memset(w, 0, sizeof *w);
    w->nv = hn_system_get_info(sys).nv;
    HN_TRY(hn_chart_init(&w->chart, sys, 1, arena, diag));
    w->chart.plain_only = 1;
    w->is_moved = closures_move(sys);
    hn_status status = hn_force_parts_create(sys, arena, &w->parts);
    HN_THEN(status, allocate(w, arena));
    return status == HN_OK ? HN_OK
                           : hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
}

void hn_reduced_terms_destroy(hn_reduced_terms *w) {
    hn_chart_destroy(&w->chart);
    hn_force_parts_free(w->parts);
    w->parts = NULL;
}

const char *hn_reduced_terms_why(const hn_reduced_terms *w) {
    return w->chart.why[0] ? w->chart.why : NULL;
}

// ---- which coordinates ----

/// The basis of the chart in user rates.
static void make_rates(hn_reduced_terms *w) {
    const hn_chart *chart = &w->chart;
    const int r = w->r;
    for (int j = 0; j < r; j++) {
        for (int i = 0; i < w->nv; i++) {
            w->unit[i] = chart->here.N[i * r + j];
        }
        hn_system_rates_to_user(chart->sys, w->unit, w->x);
        for (int i = 0; i < w->nv; i++) {
            w->rates[i * r + j] = w->x[i];
        }
    }
}

/// Rows of `rates`, in units that can be compared, as columns; a ball's count nothing.
static void put_row(hn_reduced_terms *w, int column, int i) {
    const hn_chart *chart = &w->chart;
    for (int j = 0; j < w->r; j++) {
        w->rows.a[column * w->r + j] =
            chart->at[i] < 0 ? 0 : w->rates[i * w->r + j] / chart->scale[i];
    }
}

static double log_volume(const hn_reduced_terms *w) {
    double sum = 0;
    for (int k = 0; k < w->r; k++) {
        sum += log(fabs(w->rows.a[k * w->r + k]));
    }
    return w->rows.rank == w->r ? sum : -HUGE_VAL;
}

/// Logarithm of the volume that the r user coordinates in `list` span.
static double volume_of(hn_reduced_terms *w, const int *list) {
    for (int k = 0; k < w->r; k++) {
        put_row(w, k, list[k]);
    }
    hn_qr_factor(&w->rows, w->r, w->r, DBL_EPSILON);
    return log_volume(w);
}

/// The motors into `list`; 0 unless there are as many as freedoms, each behind a coordinate of the
/// tree.
static bool list_motors(const hn_reduced_terms *w, int *list) {
    const hn_scene *scene = hn_system_scene(w->chart.sys);
    int n = 0, all = 0;
    for (int i = 0; i < scene->n_coordinates; i++) {
        all += scene->coordinates[i].actuated != 0;
    }
    for (int i = 0; i < w->nv; i++) {
        const int known = scene->coordinates[hn_system_user_coordinate(w->chart.sys, i)].actuated;
        if (known && n < w->r) {
            list[n++] = i;
        }
    }
    return all == w->r && n == w->r;
}

static void sort_ints(int *list, int n) {
    for (int i = 1; i < n; i++) {
        for (int k = i; k > 0 && list[k - 1] > list[k]; k--) {
            const int keep = list[k];
            list[k] = list[k - 1];
            list[k - 1] = keep;
        }
    }
}

/// Motors, then the chart's own, as long as they are not much worse than the best there are.
static bool choose_coordinates(hn_reduced_terms *w) {
    // the largest volume there is
    for (int i = 0; i < w->nv; i++) {
        put_row(w, i, i);
    }
    hn_qr_factor(&w->rows, w->r, w->nv, DBL_EPSILON);
    const double best = log_volume(w);
    if (!isfinite(best) && w->r > 0) {
        return false;
    }

    memcpy(w->pivot, w->rows.perm, (size_t)w->r * sizeof *w->pivot);
    sort_ints(w->pivot, w->r);

    // prefer motors, then the chart's own coordinates, then the best ones
    w->choice = HN_REDUCED_BY_MOTORS;
    if (w->r > 0 && list_motors(w, w->ind) && volume_of(w, w->ind) >= best + log(HN_CHART_TAU)) {
        return true;
    }
    w->choice = HN_REDUCED_BY_CHART;
    memcpy(w->ind, w->chart.ind, (size_t)w->r * sizeof *w->ind);
    if (w->r == 0 || volume_of(w, w->ind) >= best + log(HN_CHART_TAU)) {
        return true;
    }
    w->choice = HN_REDUCED_BY_PIVOTS;
    memcpy(w->ind, w->pivot, (size_t)w->r * sizeof *w->ind);
    return true;
}

/// basis = N R^-1 and offset, so that v = basis v_r + offset with v_r the user rates `ind`: R =
/// rows `ind` of `rates`.
static hn_status rebase(hn_reduced_terms *w) {
    const hn_chart *chart = &w->chart;
    const int r = w->r;
    for (int i = 0; i < r; i++) { // R transposed: the rows of N R^-1 are solved for
        for (int j = 0; j < r; j++) {
            w->square[j * r + i] = w->rates[w->ind[i] * r + j];
        }
    }
    if (hn_lu_factor(r, w->square, w->pivot, w->unit) != HN_OK) {
        return HN_ERR_CHART;
    }
    for (int i = 0; i < w->nv; i++) {
        memcpy(w->basis + i * r, chart->here.N + i * r, (size_t)r * sizeof(double));
        hn_lu_solve(r, w->square, w->pivot, w->basis + i * r);
    }
    return HN_OK;
}

/// x (nv, system) <- x - basis (user rates `ind` of x): what is left moves no independent
/// coordinate.
static void remove_independent(const hn_reduced_terms *w, double *x, double *user) {
    hn_system_rates_to_user(w->chart.sys, x, user);
    for (int j = 0; j < w->r; j++) {
        for (int i = 0; i < w->nv; i++) {
            x[i] -= w->basis[i * w->r + j] * user[w->ind[j]];
        }
    }
}

// ---- what (1) consists of ----

/// x (nv) = basis u
static void expand(const hn_reduced_terms *w, const double *u, double *x) {
    for (int i = 0; i < w->nv; i++) {
        x[i] = hn_dot(w->r, w->basis + i * w->r, u);
    }
}

/// c of (1) at speeds v from gamma, without a part along the independent coordinates; `full` has
/// been run there.
static void calc_c(hn_reduced_terms *w, double *c) {
    hn_chart *chart = &w->chart;
    memset(c, 0, (size_t)w->nv * sizeof *c);
    if (chart->nc > 0) {
        memcpy(chart->z, hn_eval_get(chart->full, HN_TERM_GAMMA),
               (size_t)chart->nc * sizeof(double));
        hn_chart_solve_dependent(chart, &chart->here, chart->z, chart->dq);
        for (int k = 0; k < chart->rank; k++) {
            c[chart->dep[k]] = -chart->dq[k] * chart->scale[chart->dep[k]];
        }
    }
    remove_independent(w, c, w->unit);
}

/// out (r) = Phi' (M c + h) at speeds v: C_r v_r + d_r. Leaves c in chart.c.
static void calc_velocity_part(hn_reduced_terms *w, const double *v, double *out) {
    hn_chart *chart = &w->chart;
    const hn_chart_point *p = &chart->here;
    const hn_mass_entries at = {w->nv, chart->n_M, chart->M_row, chart->M_col};
    hn_eval_run(chart->full, p->t, p->q, v);
    hn_force_parts_run(w->parts, p->t, p->q, v);
    calc_c(w, chart->c);
    hn_mass_multiply(&at, hn_eval_get(chart->full, HN_TERM_M), chart->c, 1, w->force);
    hn_axpy(w->nv, 1, hn_force_parts_h(w->parts), w->force);
    hn_mat_t_vec(w->nv, w->r, w->basis, w->force, out);
}

/// |x| in the units that count as one.
static double size_of(const hn_reduced_terms *w, const double *x) {
    double sum = 0;
    for (int i = 0; i < w->nv; i++) {
        sum = hypot(sum, x[i] / w->chart.scale[i]);
    }
    return sum;
}

/// C_r by (3), column by column; each probing speed is as large as the present one.
static void calc_coriolis(hn_reduced_terms *w) {
    enum { AT_X, AT_Y, AT_BOTH, AT_REST };
    double **Q = w->quadratic;

    // velocity parts at rest and at the present velocity
    memset(w->unit, 0, (size_t)w->nv * sizeof *w->unit);
    memset(w->y, 0, (size_t)w->nv * sizeof *w->y);
    expand(w, w->v_r, w->x);
    calc_velocity_part(w, w->y, Q[AT_REST]);
    calc_velocity_part(w, w->x, Q[AT_X]);
    const double speed = size_of(w, w->x);

    // column j from a probing velocity along coordinate j
    for (int j = 0; j < w->r; j++) {
        for (int i = 0; i < w->nv; i++) {
            w->y[i] = w->basis[i * w->r + j];
        }
        const double length = size_of(w, w->y), k = speed > 0 ? speed / length : 1;
        for (int i = 0; i < w->nv; i++) {
            w->y[i] *= k;
        }
        calc_velocity_part(w, w->y, Q[AT_Y]);
        hn_axpy(w->nv, 1, w->x, w->y);
        calc_velocity_part(w, w->y, Q[AT_BOTH]);
        for (int i = 0; i < w->r; i++) {
            const double twice = Q[AT_BOTH][i] - Q[AT_X][i] - Q[AT_Y][i] + Q[AT_REST][i];
            w->C_r[i * w->r + j] = speed > 0 ? twice / (2 * k) : 0;
        }
    }
}

/// tau = f + h + g, what is rounding of the three taken as 0; `full` and `parts` have been run at
/// w->v.
static void calc_forces(hn_reduced_terms *w) {
    const double *f = hn_eval_get(w->chart.full, HN_TERM_F), *h = hn_force_parts_h(w->parts),
                 *g = hn_force_parts_g(w->parts);
    hn_mat_t_vec(w->nv, w->r, w->basis, g, w->g_r);
    double largest = 0;
    for (int i = 0; i < w->nv; i++) {
        const double scale = w->chart.scale[i];
        largest = fmax(largest, scale * (fabs(f[i]) + fabs(h[i]) + fabs(g[i])));
    }
    for (int i = 0; i < w->nv; i++) {
        const double tau = f[i] + h[i] + g[i];
        w->force[i] = fabs(tau) * w->chart.scale[i] > TAU_BLUR * largest ? tau : 0;
    }
    hn_mat_t_vec(w->nv, w->r, w->basis, w->force, w->tau_r);
}

static void calc_mass(hn_reduced_terms *w) {
    hn_chart *chart = &w->chart;
    const hn_mass_entries at = {w->nv, chart->n_M, chart->M_row, chart->M_col};
    hn_mass_multiply(&at, hn_eval_get(chart->full, HN_TERM_M), w->basis, w->r, chart->Mx);
    hn_mass_project(w->nv, w->r, w->basis, chart->Mx, w->M_r);
    for (int i = 0; i < w->r; i++) {
        for (int j = i + 1; j < w->r; j++) {
            w->M_r[i * w->r + j] = w->M_r[j * w->r + i];
        }
    }
}

/// Speeds that fit the loops with the given independent ones, and how far the given ones were from
/// them.
static void close_speeds(hn_reduced_terms *w, const double *v) {
    const hn_system *sys = w->chart.sys;
    memcpy(w->offset, w->chart.here.s, (size_t)w->nv * sizeof *w->offset);
    remove_independent(w, w->offset, w->unit);
    hn_system_rates_to_user(sys, v, w->unit);
    for (int j = 0; j < w->r; j++) {
        w->v_r[j] = w->unit[w->ind[j]];
    }
    expand(w, w->v_r, w->v);
    hn_axpy(w->nv, 1, w->offset, w->v);
    w->speed_gap = 0;
    for (int i = 0; i < w->nv; i++) {
        w->speed_gap = fmax(w->speed_gap, fabs(v[i] - w->v[i]));
    }
}

/// a_r from M_r a_r = tau_r - g_r - (C_r v_r + d_r)
static hn_status solve(hn_reduced_terms *w) {
    hn_chart *chart = &w->chart;
    for (int i = 0; i < w->r; i++) {
        w->a_r[i] = w->tau_r[i] - w->g_r[i] - w->velocity_part[i];
    }
    memcpy(chart->A, w->M_r, (size_t)w->r * (size_t)w->r * sizeof(double));
    return hn_chart_solve_reduced(chart, chart->here.t, w->a_r);
}

/// d_r: what (3) leaves of the velocity part. It vanishes but for closures that move with time.
static void calc_moved(hn_reduced_terms *w) {
    for (int i = 0; i < w->r; i++) {
        const double square = hn_dot(w->r, w->C_r + i * w->r, w->v_r);
        w->d_r[i] = w->is_moved ? w->velocity_part[i] - square : 0;
    }
}

static void put_user(hn_reduced_terms *w) {
    const hn_system *sys = w->chart.sys;
    const int r = w->r;
    for (int j = 0; j < r; j++) {
        for (int i = 0; i < w->nv; i++) {
            w->unit[i] = w->basis[i * r + j];
        }
        hn_system_rates_to_user(sys, w->unit, w->x);
        for (int i = 0; i < w->nv; i++) {
            w->Phi[i * r + j] = w->x[i] + 0.0; // no zero with a sign
        }
        for (int k = 0; k < r; k++) { // exact, where solving left rounding
            w->Phi[w->ind[k] * r + j] = j == k;
        }
    }
    hn_system_rates_to_user(sys, w->offset, w->s);
}

static hn_status place(hn_reduced_terms *w, double t, const double *q, int freedoms) {
    hn_chart *chart = &w->chart;
    chart->has_first = 0;
    chart->rank = -1;
    chart->why[0] = '\0';

    // a chart with as many degrees of freedom as expected
    hn_status status = hn_chart_choose(chart, t, q, HN_CHART_PREFERRED);
    if (status == HN_OK && freedoms >= 0 && chart->r != freedoms) {
        snprintf(chart->why, sizeof chart->why,
                 "a singular configuration: closure rows depend on each other here, and for a "
                 "moment the mechanism has %d degree%s of freedom instead of %d",
                 chart->r, chart->r == 1 ? "" : "s", freedoms);
        return HN_ERR_CHART;
    }
    HN_THEN(status, hn_chart_locate(chart, &chart->here, t, q));
    if (status != HN_OK) {
        return status;
    }

    // scene coordinates that carry the motion
    w->r = chart->r;
    make_rates(w);
    if (!choose_coordinates(w) || rebase(w) != HN_OK) {
        return hn_chart_fail(chart, HN_ERR_CHART, t, q,
                             "no choice of the scene's coordinates determines the motion here");
    }
    return HN_OK;
}

hn_status hn_reduced_terms_eval(hn_reduced_terms *w, double t, const double *q, const double *v,
                                int freedoms) {
    HN_TRY(place(w, t, q, freedoms));
    close_speeds(w, v);
    calc_coriolis(w);
    calc_velocity_part(w, w->v, w->velocity_part);
    calc_mass(w);
    calc_forces(w);
    calc_moved(w);
    put_user(w);
    return solve(w);
}
