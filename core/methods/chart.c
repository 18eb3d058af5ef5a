#include "methods/chart.h"

#include "linalg/dense.h"
#include "methods/flops.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PIVOT_TOL 1e-13 // of the largest pivot: J_d is singular to rounding
enum { MAX_NEWTON = 25 };

static void init_point(hn_chart_point *p, int nv, int nc, hn_arena *arena, int *ok) {
    p->q = hn_arena_doubles(arena, (size_t)nv);
    p->J = hn_arena_doubles(arena, (size_t)nc * (size_t)nv);
    p->N = hn_arena_doubles(arena, (size_t)nv * (size_t)nv);
    p->s = hn_arena_doubles(arena, (size_t)nv);
    *ok = hn_qr_init(&p->jd, arena, nc, nv) && *ok;
}

static int init_memory(hn_chart *chart, hn_arena *arena) {
    const size_t nv = (size_t)chart->nv, nc = (size_t)chart->nc;
    int ok = hn_qr_init(&chart->all, arena, chart->nc, chart->nv);
    init_point(&chart->here, chart->nv, chart->nc, arena, &ok);
    init_point(&chart->probe, chart->nv, chart->nc, arena, &ok);
    init_point(&chart->base, chart->nv, chart->nc, arena, &ok);
    chart->dep = hn_arena_ints(arena, nv);
    chart->ind = hn_arena_ints(arena, nv);
    chart->order = hn_arena_ints(arena, nv);
    chart->new_dep = hn_arena_ints(arena, nv);
    chart->scale = hn_arena_doubles(arena, nv);
    chart->c = hn_arena_doubles(arena, nv);
    chart->Mx = hn_arena_doubles(arena, nv * nv);
    chart->A = hn_arena_doubles(arena, nv * nv);
    chart->z = hn_arena_doubles(arena, nv + nc);
    chart->dq = hn_arena_doubles(arena, nv + nc);
    chart->basis = hn_arena_doubles(arena, nc * nv);
    chart->columns = hn_arena_doubles(arena, nc * nv);
    return ok && !hn_arena_failed(arena);
}

hn_status hn_chart_init(hn_chart *chart, const hn_system *sys, int with_rate, hn_arena *arena,
                        hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    memset(chart, 0, sizeof *chart);
    if (info.nq != info.nv) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "use index1, baumgarte or projection",
                           "independent speeds need one coordinate per speed; this scene has %d "
                           "coordinates and %d speeds",
                           info.nq, info.nv);
    }
    chart->sys = sys;
    chart->nv = info.nv;
    chart->nc = info.nc;
    chart->rank = chart->r = -1;
    chart->with_rate = with_rate;
    chart->length = hn_system_length(sys);
    hn_status status = init_memory(chart, arena) ? HN_OK : HN_ERR_MEMORY;
    if (status == HN_OK) {
        status = hn_eval_create(sys, HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J, arena, &chart->loop);
    }
    if (status == HN_OK) {
        status = hn_eval_create(sys, HN_TERM_M | HN_TERM_F | (with_rate ? HN_TERM_GAMMA : 0), arena,
                                &chart->full);
    }
    return status == HN_OK ? HN_OK
                           : hn_diag_set(diag, status, NULL, NULL, "%s", hn_status_text(status));
}

void hn_chart_destroy(hn_chart *chart) {
    hn_eval_free(chart->loop);
    hn_eval_free(chart->full);
    chart->loop = chart->full = NULL;
}

hn_status hn_chart_fail(hn_chart *chart, hn_status status, double t, const double *q,
                        const char *what) {
    const hn_scene *scene = hn_system_scene(chart->sys);
    const int i = chart->r > 0 ? chart->ind[0] : 0;
    const char *name = "?";
    if (i < hn_system_get_info(chart->sys).n_user) {
        name = scene->coordinates[hn_system_user_coordinate(chart->sys, i)].name;
    }
    snprintf(chart->why, sizeof chart->why, "%s = %.6g at t = %.6g s: %s", name, q[i], t, what);
    return status;
}

// --- one configuration ------------------------------------------------------------------------------------

// Householder reflections have determinant -1, a column permutation its parity
static int sign_of_det(const hn_qr *qr, int n) {
    int sign = 1;
    for (int k = 0; k < n; k++) {
        if (qr->tau[k] != 0) {
            sign = -sign;
        }
        if (qr->a[k * qr->m + k] < 0) {
            sign = -sign;
        }
        for (int j = k + 1; j < n; j++) {
            if (qr->perm[j] < qr->perm[k]) {
                sign = -sign;
            }
        }
    }
    return sign;
}

// x_d (rank) <- J_d^-1 b, b (nc) overwritten
static void solve_dependent(hn_chart *chart, const hn_chart_point *p, double *b, double *x_d) {
    hn_qr_apply_qt(&p->jd, b);
    hn_qr_solve_r(&p->jd, b);
    for (int k = 0; k < chart->rank; k++) {
        x_d[p->jd.perm[k]] = b[k];
    }
    chart->cost.solves++;
    chart->cost.ops += hn_flops_qr_solve(chart->nc, chart->rank);
}

static double smallest_pivot(const hn_chart_point *p, int rank) {
    double smallest = HUGE_VAL;
    for (int k = 0; k < rank; k++) {
        smallest = fmin(smallest, fabs(p->jd.a[k * p->jd.m + k]));
    }
    return smallest;
}

static double log_volume(const hn_chart_point *p, int rank) {
    double sum = 0;
    for (int k = 0; k < rank; k++) {
        sum += log(fabs(p->jd.a[k * p->jd.m + k]));
    }
    return sum;
}

double hn_chart_volume(const hn_chart *chart) {
    return exp(log_volume(&chart->here, chart->rank) - chart->volume_start);
}

// copies phi's neighbourhood from the tape and factors J_d; 0 when det J_d has vanished
static int factor_dependent(hn_chart *chart, hn_chart_point *p) {
    const int nv = chart->nv, nc = chart->nc, rank = chart->rank;
    memcpy(p->J, hn_eval_get(chart->loop, HN_TERM_J), (size_t)nc * (size_t)nv * sizeof(double));
    for (int k = 0; k < rank; k++) {
        const int column = chart->dep[k];
        for (int i = 0; i < nc; i++) {
            p->jd.a[k * nc + i] = p->J[i * nv + column] * chart->scale[column];
        }
    }
    hn_qr_factor(&p->jd, nc, rank, PIVOT_TOL);
    chart->cost.factorisations++;
    chart->cost.ops += hn_flops_qr(nc, rank);
    p->sign = nc == rank && p->jd.rank == rank ? sign_of_det(&p->jd, rank) : 0;
    return rank == 0 ||
           (p->jd.rank == rank && smallest_pivot(p, rank) > HN_CHART_FOLD * chart->pivot_start);
}

static void make_basis(hn_chart *chart, hn_chart_point *p) {
    const int nv = chart->nv, nc = chart->nc, rank = chart->rank, r = chart->r;
    double *b = chart->z, *x = chart->dq;
    memset(p->N, 0, (size_t)nv * (size_t)r * sizeof(double));
    for (int j = 0; j < r; j++) {
        p->N[chart->ind[j] * r + j] = 1;
        for (int i = 0; i < nc; i++) {
            b[i] = -p->J[i * nv + chart->ind[j]];
        }
        solve_dependent(chart, p, b, x);
        for (int k = 0; k < rank; k++) {
            p->N[chart->dep[k] * r + j] = x[k] * chart->scale[chart->dep[k]];
        }
    }
    memset(p->s, 0, (size_t)nv * sizeof(double));
    const double *phi_t = hn_eval_get(chart->loop, HN_TERM_PHI_T);
    if (hn_norm_max(nc, phi_t) > 0) {
        for (int i = 0; i < nc; i++) {
            b[i] = -phi_t[i];
        }
        solve_dependent(chart, p, b, x);
        for (int k = 0; k < rank; k++) {
            p->s[chart->dep[k]] = x[k] * chart->scale[chart->dep[k]];
        }
    }
}

static void eval_loop(hn_chart *chart, hn_chart_point *p, double t) {
    hn_eval_run(chart->loop, t, p->q, p->s);
    p->gap = hn_norm2(chart->nc, hn_eval_get(chart->loop, HN_TERM_PHI));
    p->t = t;
}

static const char FOLD[] = "its dead point: the other coordinates no longer follow from it";

hn_status hn_chart_locate(hn_chart *chart, hn_chart_point *p, double t, const double *q) {
    p->valid = 0;
    memmove(p->q, q, (size_t)chart->nv * sizeof *q);
    if (!hn_all_finite(chart->nv, p->q)) {
        return hn_chart_fail(chart, HN_ERR_DIVERGED, t, q, "the state is not finite");
    }
    eval_loop(chart, p, t);
    if (!factor_dependent(chart, p)) {
        return hn_chart_fail(chart, HN_ERR_CHART, t, q, FOLD);
    }
    make_basis(chart, p);
    p->tol = HUGE_VAL;
    p->valid = 1;
    return HN_OK;
}

int hn_chart_is_at(const hn_chart *chart, const hn_chart_point *p, double t, const double *q) {
    return p->valid && p->t == t && memcmp(p->q, q, (size_t)chart->nv * sizeof *q) == 0;
}

hn_status hn_chart_check_mode(hn_chart *chart) {
    if (chart->base.valid && chart->base.sign * chart->here.sign < 0) {
        chart->here.valid = 0;
        return hn_chart_fail(
            chart, HN_ERR_CHART, chart->here.t, chart->here.q,
            "the loop went over to its other assembly mode: a dead point was passed, or "
            "the step is too long");
    }
    return HN_OK;
}

hn_status hn_chart_settle(hn_chart *chart) {
    const size_t nv = (size_t)chart->nv, r = (size_t)chart->r;
    const hn_chart_point *from = &chart->here;
    hn_chart_point *to = &chart->base;
    const hn_status status = hn_chart_check_mode(chart);
    if (status != HN_OK) {
        return status;
    }
    memcpy(to->q, from->q, nv * sizeof(double));
    memcpy(to->s, from->s, nv * sizeof(double));
    memcpy(to->N, from->N, nv * r * sizeof(double));
    to->t = from->t;
    to->sign = from->sign;
    to->valid = 1;
    if (chart->pivot_start == 0) {
        chart->pivot_start = smallest_pivot(from, chart->rank);
        chart->volume_start = log_volume(from, chart->rank);
    }
    return HN_OK;
}

// one Newton step of the dependent coordinates from the factor at the point
static void newton_step(hn_chart *chart, hn_chart_point *p) {
    double *b = chart->z, *x = chart->dq;
    memcpy(b, hn_eval_get(chart->loop, HN_TERM_PHI), (size_t)chart->nc * sizeof *b);
    solve_dependent(chart, p, b, x);
    for (int k = 0; k < chart->rank; k++) {
        p->q[chart->dep[k]] -= x[k] * chart->scale[chart->dep[k]];
    }
    chart->cost.newton++;
}

hn_status hn_chart_close(hn_chart *chart, hn_chart_point *p, double t, double *q, double tol) {
    double last = HUGE_VAL;
    p->valid = 0;
    memmove(p->q, q, (size_t)chart->nv * sizeof *q);
    for (int i = 0; i < MAX_NEWTON; i++) {
        eval_loop(chart, p, t);
        if (!isfinite(p->gap)) {
            return hn_chart_fail(chart, HN_ERR_DIVERGED, t, q, "the loop gap is not finite");
        }
        if (!factor_dependent(chart, p)) {
            return hn_chart_fail(chart, HN_ERR_CHART, t, q, FOLD);
        }
        // a gap that stopped falling at rounding level is as closed as it gets
        const int at_floor = p->gap <= 1e-11 * chart->length && p->gap >= 0.5 * last;
        if (p->gap <= tol * chart->length || at_floor) {
            make_basis(chart, p);
            memmove(q, p->q, (size_t)chart->nv * sizeof *q);
            p->tol = tol;
            p->valid = 1;
            return HN_OK;
        }
        last = p->gap;
        newton_step(chart, p);
    }
    return hn_chart_fail(
        chart, HN_ERR_CHART, t, q,
        "no pose closes the loops with this value: the end of its range was passed");
}

void hn_chart_predict(const hn_chart *chart, double t, const double *q_ind, double *q) {
    const hn_chart_point *from = &chart->base;
    const int r = chart->r;
    for (int i = 0; i < chart->nv; i++) {
        double step = from->s[i] * (t - from->t);
        for (int j = 0; j < r; j++) {
            step += from->N[i * r + j] * (q_ind[j] - from->q[chart->ind[j]]);
        }
        q[i] = from->q[i] + step;
    }
    for (int j = 0; j < r; j++) {
        q[chart->ind[j]] = q_ind[j];
    }
}

void hn_chart_speeds(const hn_chart *chart, const hn_chart_point *p, const double *u, double *v) {
    const int r = chart->r;
    for (int i = 0; i < chart->nv; i++) {
        double sum = p->s[i];
        for (int j = 0; j < r; j++) {
            sum += p->N[i * r + j] * u[j];
        }
        v[i] = sum;
    }
}

// A (r x r) = N' M N, with MN left in Mx
static void project_mass(hn_chart *chart, const double *M) {
    const int nv = chart->nv, r = chart->r;
    const double *N = chart->here.N;
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < r; j++) {
            double sum = 0;
            for (int k = 0; k < nv; k++) {
                sum += M[i * nv + k] * N[k * r + j];
            }
            chart->Mx[i * r + j] = sum;
        }
    }
    for (int i = 0; i < r; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = 0;
            for (int k = 0; k < nv; k++) {
                sum += N[k * r + i] * chart->Mx[k * r + j];
            }
            chart->A[i * r + j] = sum;
        }
    }
    chart->cost.ops += hn_flops_product(nv, nv, r) + hn_flops_product(r, nv, r) / 2;
}

hn_status hn_chart_accel(hn_chart *chart, const double *v, double *u_dot) {
    const int nv = chart->nv, nc = chart->nc, r = chart->r;
    const hn_chart_point *p = &chart->here;
    HN_ASSERT(p->valid);
    hn_eval_run(chart->full, p->t, p->q, v);
    const double *M = hn_eval_get(chart->full, HN_TERM_M), *f = hn_eval_get(chart->full, HN_TERM_F);
    memset(chart->c, 0, (size_t)nv * sizeof(double));
    if (nc > 0 && chart->with_rate) {
        memcpy(chart->z, hn_eval_get(chart->full, HN_TERM_GAMMA), (size_t)nc * sizeof(double));
        solve_dependent(chart, p, chart->z, chart->dq);
        for (int k = 0; k < chart->rank; k++) {
            chart->c[chart->dep[k]] = -chart->dq[k] * chart->scale[chart->dep[k]];
        }
    }
    // N' (f - M c)
    double *force = chart->dq;
    for (int i = 0; i < nv; i++) {
        force[i] = f[i] - hn_dot(nv, M + i * nv, chart->c);
    }
    project_mass(chart, M);
    hn_mat_t_vec(nv, r, p->N, force, u_dot);
    chart->cost.ops += hn_flops_product(nv, nv, 1) + hn_flops_product(r, nv, 1);
    return hn_chart_solve_reduced(chart, p->t, u_dot);
}

hn_status hn_chart_solve_reduced(hn_chart *chart, double t, double *x) {
    const int r = chart->r;
    double largest = 0;
    for (int i = 0; i < r; i++) {
        largest = fmax(largest, fabs(chart->A[i * r + i]));
    }
    chart->cost.factorisations++;
    chart->cost.ops += hn_flops_cholesky(r) + hn_flops_cholesky_solve(r);
    const hn_status status = hn_cholesky(r, chart->A, r, 1e-14 * largest);
    if (status != HN_OK || !isfinite(largest)) {
        const hn_status told = isfinite(largest) ? status : HN_ERR_DIVERGED;
        return hn_chart_fail(chart, told, t, chart->here.q,
                             "the mass left on the free motion is not positive");
    }
    hn_cholesky_solve(r, chart->A, r, x);
    return hn_all_finite(r, x) ? HN_OK
                               : hn_chart_fail(chart, HN_ERR_DIVERGED, t, chart->here.q,
                                               "the acceleration is not finite");
}

void hn_chart_add_cost(const hn_chart *chart, hn_cost *cost) {
    hn_cost_add(cost, &chart->cost);
    cost->ops += (double)hn_eval_count(chart->loop) * hn_eval_info(chart->loop).ops +
                 (double)hn_eval_count(chart->full) * hn_eval_info(chart->full).ops;
}
