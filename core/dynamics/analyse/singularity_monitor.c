// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/analyse/singularity_monitor.h"

#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/factor.h"
#include "linalg/dense.h"
#include "linalg/qr.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double LOST = 1e-8;     // ratio below which rows count as lost
static const double RANK_TOL = 1e-8; // of the QR that answers where the factor cannot
static const double PARTED = 0.05;   // pivot, of the largest, of a row that has become independent
// operations a look may cost on average where only the QR answers
static const double DENSE_BUDGET = 2e5;
// prediction: a look becomes an anchor when sigma has fallen this much since the last; the lowest
// value of the parabola must be this small against the present one; nothing is said from farther
// than NEAR of the largest sigma_min so far
static const double ANCHOR = 0.85;
static const double TOUCHES = 0.04;
// a sigma that is bent on its way to zero leaves the parabola's lowest value above zero, but less
// of it with the cube of sigma; where the pose is only passed near, the lowest value stays. It has
// to fall like the square at least, so many times running
static const double BENT = 0.25;
enum { FALLING = 2 };
static const double NEAR = 0.35;
// singular values within this factor of the smallest are lost together
static const double TOGETHER = 5;
static const double CUSP = 1e-6; // discriminant against the squares of the form's entries
enum { ANCHORS = 3, SWEEPS = 2, FIRST_SWEEPS = 30, PROBE_SWEEPS = 8 };

struct hn_singularity {
    const hn_system *sys;
    int nq, nv, nc;
    hn_eval *rows, *gamma; // J and M; gamma
    hn_factor *factor;
    int n_J;
    const int *J_row, *J_col;
    double *d, *r;     // scales: nv, nc
    double *w, *top;   // nc: left vectors of the smallest and the largest singular value
    double *x, *y;     // nv, nc scratch
    double *v, *basis; // nv, 2 nv
    double *kept[3];   // nc: r, w and top of the last look, while a probe uses them
    hn_qr qr;          // nv x nc: (R J D)'
    double *no_speed;
    int first, start_rank, wait;
    double largest, strongest; // sigma_min and sigma_max so far
    double t[ANCHORS], square[ANCHORS];
    int n_anchors;
    double lowest; ///< of the parabola through the last anchors
    int falling;   ///< anchors in a row by which it has fallen so
    hn_singularity_info last;
};

hn_status hn_singularity_create(const hn_system *sys, hn_arena *arena, hn_singularity **out) {
    const hn_system_info info = hn_system_get_info(sys);
    hn_singularity *r = hn_arena_get(arena, sizeof *r);
    *out = NULL;
    if (!r) {
        return HN_ERR_MEMORY;
    }
    *r = (hn_singularity){.sys = sys, .nq = info.nq, .nv = info.nv, .nc = info.nc};

    // memory
    const size_t nv = (size_t)info.nv, nc = (size_t)info.nc;
    double **of_nv[] = {&r->d, &r->x, &r->v, &r->no_speed},
           **of_nc[] = {&r->r, &r->w, &r->top, &r->y, &r->kept[0], &r->kept[1], &r->kept[2]};
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(arena, nv);
    }
    for (size_t i = 0; i < sizeof of_nc / sizeof *of_nc; i++) {
        *of_nc[i] = hn_arena_doubles(arena, nc);
    }
    r->basis = hn_arena_doubles(arena, 2 * nv);
    if (!hn_qr_init(&r->qr, arena, info.nv, info.nc) || hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // evaluators and the factor
    hn_status status = hn_eval_create(sys, HN_TERM_J | HN_TERM_M, arena, &r->rows);
    if (status == HN_OK) {
        r->n_J = hn_eval_pattern(r->rows, HN_TERM_J, &r->J_row, &r->J_col);
        status = hn_eval_create(sys, HN_TERM_GAMMA, arena, &r->gamma);
    }
    if (status == HN_OK) {
        status = hn_factor_create(sys, HN_FACTOR_DIAGONAL, arena, &r->factor);
    }

    if (status != HN_OK) {
        hn_singularity_free(r);
        return status;
    }
    hn_singularity_reset(r);
    *out = r;
    return HN_OK;
}

void hn_singularity_free(hn_singularity *r) {
    if (r) {
        hn_eval_free(r->rows);
        hn_eval_free(r->gamma);
        hn_factor_free(r->factor);
        r->rows = r->gamma = NULL;
        r->factor = NULL;
    }
}

void hn_singularity_reset(hn_singularity *r) {
    r->first = 1;
    r->wait = r->n_anchors = r->falling = 0;
    r->lowest = HUGE_VAL;
    r->largest = r->strongest = 0;
    r->start_rank = r->nc;
    memset(r->r, 0, (size_t)r->nc * sizeof *r->r);
    for (int i = 0; i < r->nc; i++) {
        // no row is favoured or missed
        r->w[i] = r->top[i] = 0.5 + fmod(0.6180339887498949 * (i + 1), 1);
    }
}

static double entry(const hn_singularity *r, int k) {
    return hn_eval_get(r->rows,
                       HN_TERM_J)[(size_t)r->J_row[k] * (size_t)r->nv + (size_t)r->J_col[k]];
}

/// D, and R as the reciprocal of the largest length that each row has had.
static void scale(hn_singularity *r) {
    const double *M = hn_eval_get(r->rows, HN_TERM_M);
    for (int j = 0; j < r->nv; j++) {
        const double m = M[(size_t)j * (size_t)r->nv + (size_t)j];
        r->d[j] = m > 0 ? 1 / sqrt(m) : 1;
    }
    memset(r->y, 0, (size_t)r->nc * sizeof *r->y);
    for (int k = 0; k < r->n_J; k++) {
        const double e = entry(r, k) * r->d[r->J_col[k]];
        r->y[r->J_row[k]] += e * e;
    }
    for (int i = 0; i < r->nc; i++) {
        const double length = sqrt(r->y[i]), before = r->r[i] > 0 ? 1 / r->r[i] : 0;
        r->r[i] = fmax(length, before) > 0 ? 1 / fmax(length, before) : 0;
    }
}

static double normalise(int n, double *x) {
    const double size = hn_norm2(n, x);
    for (int i = 0; i < n && size > 0; i++) {
        x[i] /= size;
    }
    return size;
}

/// top <- R J D^2 J' R top, normalised; the root of its growth tends to sigma_max.
static double sweep_top(hn_singularity *r) {
    memset(r->x, 0, (size_t)r->nv * sizeof *r->x);
    for (int k = 0; k < r->n_J; k++) {
        const int i = r->J_row[k], j = r->J_col[k];
        r->x[j] += entry(r, k) * r->r[i] * r->d[j] * r->top[i];
    }
    memset(r->top, 0, (size_t)r->nc * sizeof *r->top);
    for (int k = 0; k < r->n_J; k++) {
        const int i = r->J_row[k], j = r->J_col[k];
        r->top[i] += entry(r, k) * r->r[i] * r->d[j] * r->x[j];
    }
    return sqrt(normalise(r->nc, r->top));
}

/// w <- (R J D^2 J' R)^-1 w, normalised; one over the root of its growth tends to sigma_min.
static double sweep_bottom(hn_singularity *r) {
    for (int i = 0; i < r->nc; i++) {
        r->y[i] = r->r[i] > 0 ? r->w[i] / r->r[i] : 0;
    }
    hn_factor_solve(r->factor, NULL, r->y, r->x, r->y);
    for (int i = 0; i < r->nc; i++) {
        r->w[i] = r->r[i] > 0 ? r->y[i] / r->r[i] : 0;
    }
    const double growth = normalise(r->nc, r->w);
    return growth > 0 ? 1 / sqrt(growth) : 0;
}

static void fill_qr(hn_singularity *r) {
    memset(r->qr.a, 0, (size_t)r->nv * (size_t)r->nc * sizeof *r->qr.a);
    for (int k = 0; k < r->n_J; k++) {
        const int i = r->J_row[k], j = r->J_col[k];
        r->qr.a[(size_t)i * (size_t)r->nv + (size_t)j] = entry(r, k) * r->r[i] * r->d[j];
    }
}

static double diagonal(const hn_singularity *r, int k) {
    return fabs(r->qr.a[(size_t)k * (size_t)r->nv + (size_t)k]);
}

/// Rows that depended on the others at the first look part from them a little where loops stand
/// open: they count once they stand out by more than any gap that is not told would make them.
static void leave_out_blur(hn_singularity *r) {
    while (r->qr.rank > r->start_rank && diagonal(r, r->qr.rank - 1) < PARTED * diagonal(r, 0)) {
        r->qr.rank--;
    }
    r->start_rank = r->qr.rank > r->start_rank ? r->qr.rank : r->start_rank;
}

static void look_densely(hn_singularity *r, hn_singularity_info *info) {
    fill_qr(r);
    hn_qr_factor(&r->qr, r->nv, r->nc, RANK_TOL);
    if (r->first) {
        r->start_rank = r->qr.rank;
    }
    leave_out_blur(r);
    const int rank = r->qr.rank;
    hn_qr_sigma(&r->qr, &info->sigma_min, &info->sigma_max);
    if (rank < r->start_rank) {
        info->sigma_min = 0;
    }
}

static void look_sparsely(hn_singularity *r, int sweeps, hn_singularity_info *info) {
    for (int i = 0; i < sweeps; i++) {
        info->sigma_max = sweep_top(r);
        info->sigma_min = sweep_bottom(r);
    }
}

/// sigma^2 as a parabola through the anchors, from the last of them on: slope, curve. 0 where it
/// does not fall to a lowest value.
static bool fit(const hn_singularity *r, double *slope, double *curve) {
    if (r->n_anchors < ANCHORS) {
        return false;
    }
    const double a = r->t[1] - r->t[0], b = r->t[2] - r->t[1];
    const double s1 = (r->square[1] - r->square[0]) / a, s2 = (r->square[2] - r->square[1]) / b;
    *curve = (s2 - s1) / (a + b);
    *slope = s2 + *curve * b;
    return *curve > 0 && *slope < 0;
}

/// Seconds from the last anchor until sigma itself, as a parabola through the anchors, is zero.
static double root(const hn_singularity *r) {
    const double s[ANCHORS] = {sqrt(r->square[0]), sqrt(r->square[1]), sqrt(r->square[2])};
    const double a = r->t[1] - r->t[0], b = r->t[2] - r->t[1];
    const double s1 = (s[1] - s[0]) / a, s2 = (s[2] - s[1]) / b;
    const double curve = (s2 - s1) / (a + b), slope = s2 + curve * b;
    const double square = slope * slope - 4 * curve * s[2];
    return slope < 0 && square > 0 ? 2 * s[2] / (sqrt(square) - slope) : HUGE_VAL;
}

/// Seconds from t until sigma is zero if it goes on as it did, HUGE_VAL when it does not get there.
static double predict(const hn_singularity *r, double t, double sigma) {
    double slope = 0, curve = 0, when = HUGE_VAL;
    if (!(sigma < NEAR * r->largest) || !fit(r, &slope, &curve)) {
        return HUGE_VAL;
    }
    if (fabs(r->lowest) <= TOUCHES * r->square[2]) {
        when = r->t[2] - slope / (2 * curve);
    } else if (r->falling >= FALLING && r->lowest <= BENT * r->square[2]) {
        when = r->t[2] + root(r);
    }
    return when > t && when < HUGE_VAL ? when - t : HUGE_VAL;
}

/// What the parabola through the anchors says after one was added.
static void follow_lowest(hn_singularity *r) {
    double slope = 0, curve = 0;
    if (!fit(r, &slope, &curve)) {
        r->falling = 0;
        r->lowest = HUGE_VAL;
        return;
    }
    const double lowest = r->square[2] - slope * slope / (4 * curve);
    const double share = r->square[2] / r->square[1];
    r->falling = lowest > 0 && lowest <= share * r->lowest ? r->falling + 1 : 0;
    r->lowest = lowest;
}

static void remember(hn_singularity *r, double t, double sigma) {
    const double square = sigma * sigma;
    if (r->n_anchors > 0 && square > r->square[r->n_anchors - 1]) {
        r->n_anchors = 0; // rising: no approach
    }
    if (r->n_anchors > 0 && square > ANCHOR * ANCHOR * r->square[r->n_anchors - 1]) {
        return;
    }
    if (r->n_anchors == ANCHORS) {
        memmove(r->t, r->t + 1, (ANCHORS - 1) * sizeof *r->t);
        memmove(r->square, r->square + 1, (ANCHORS - 1) * sizeof *r->square);
        r->n_anchors--;
    }
    r->t[r->n_anchors] = t;
    r->square[r->n_anchors++] = square;
    follow_lowest(r);
}

void hn_singularity_check(hn_singularity *r, double t, const double *q, hn_singularity_info *info) {
    *info = (hn_singularity_info){.ratio = 1, .ahead = HUGE_VAL};
    if (r->nc == 0) {
        return;
    }

    // a dense check that costs much is done now and then only
    if (r->wait > 0) {
        r->wait--;
        *info = r->last;
        return;
    }

    // singular values here, sparse if the factor allows
    hn_eval_run(r->rows, t, q, r->no_speed);
    scale(r);

    const int sparse = hn_factor_update(r->factor, t, q, NULL) == HN_OK;
    if (sparse) {
        look_sparsely(r, r->first ? FIRST_SWEEPS : SWEEPS, info);
    } else {
        look_densely(r, info);
        // a loop that is redundant everywhere is looked at less often when it is large
        r->wait = (int)(2.0 * r->nv * r->nc * r->nc / DENSE_BUDGET);
    }
    // where all rows die away together the largest value dies with the smallest
    r->strongest = fmax(r->strongest, info->sigma_max);
    info->sigma_max = r->strongest;
    info->ratio = info->sigma_max > 0 ? info->sigma_min / info->sigma_max : 0;
    info->lost = info->ratio < LOST;
    r->largest = fmax(r->largest, info->sigma_min);
    remember(r, t, info->sigma_min);
    info->ahead = predict(r, t, info->sigma_min);
    r->first = 0;
    r->last = *info;
    r->last.ahead = HUGE_VAL; // said once
}

/// What the looks know of the rows: kept, or given back.
static void keep(hn_singularity *r, int back) {
    double *const known[] = {r->r, r->w, r->top};
    for (int i = 0; i < 3; i++) {
        memcpy(back ? known[i] : r->kept[i], back ? r->kept[i] : known[i],
               (size_t)r->nc * sizeof **known);
    }
}

double hn_singularity_probe(hn_singularity *r, double t, const double *q) {
    hn_singularity_info info = {0};
    if (r->nc == 0 || r->wait > 0 || r->first) {
        return HUGE_VAL;
    }
    const int rank = r->start_rank;
    keep(r, 0);
    hn_eval_run(r->rows, t, q, r->no_speed);
    scale(r);
    if (hn_factor_update(r->factor, t, q, NULL) == HN_OK) {
        look_sparsely(r, PROBE_SWEEPS, &info);
    } else {
        look_densely(r, &info);
    }
    keep(r, 1);
    r->start_rank = rank;
    return info.sigma_min;
}

const double *hn_singularity_scale(const hn_singularity *r) {
    return r->d;
}

// ---- what waits there ----

/// w' gamma(q, v)
static double form(hn_singularity *r, double t, const double *q, const double *w, const double *v) {
    hn_eval_run(r->gamma, t, q, v);
    return hn_dot(r->nc, w, hn_eval_get(r->gamma, HN_TERM_GAMMA));
}

/// Column k of Q as a direction of velocities.
static void kernel_column(hn_singularity *r, int k, double *v) {
    memset(v, 0, (size_t)r->nv * sizeof *v);
    v[k] = 1;
    hn_qr_apply_q(&r->qr, v);
    for (int j = 0; j < r->nv; j++) {
        v[j] *= r->d[j];
    }
}

static hn_branches count_branches(hn_singularity *r, double t, const double *q, const double *w) {
    double *n1 = r->basis, *n2 = r->basis + r->nv;
    kernel_column(r, r->nv - 2, n1);
    kernel_column(r, r->nv - 1, n2);
    for (int j = 0; j < r->nv; j++) {
        r->v[j] = n1[j] + n2[j];
    }
    const double a = form(r, t, q, w, n1), c = form(r, t, q, w, n2);
    const double b = (form(r, t, q, w, r->v) - a - c) / 2;
    const double disc = b * b - a * c, size = a * a + b * b + c * c;
    if (size == 0 || fabs(disc) <= CUSP * size) {
        return size == 0 ? HN_BRANCHES_UNKNOWN : HN_BRANCHES_CUSP;
    }
    return disc > 0 ? HN_BRANCHES_CROSS : HN_BRANCHES_NONE;
}

/// The rows with the largest parts in the combination in y.
static void find_lost_rows(hn_singularity *r, hn_singularity_pose *pose) {
    for (int k = 0; k < 4 && k < r->nc; k++) {
        int best = -1;
        for (int i = 0; i < r->nc; i++) {
            int taken = 0;
            for (int m = 0; m < k; m++) {
                taken |= pose->rows[m] == i;
            }
            if (!taken && (best < 0 || fabs(r->y[i]) > fabs(r->y[best]))) {
                best = i;
            }
        }
        const double part = r->y[best] * r->y[best];
        if (k > 0 && part < 0.05 * pose->parts[0]) {
            break;
        }
        pose->rows[pose->n_rows] = best;
        pose->parts[pose->n_rows++] = part;
    }
}

/// y (nc), of unit length: the combination of rows that vanishes, from the first column that was
/// dropped.
static void vanishing_combination(hn_singularity *r) {
    const int rank = r->qr.rank;
    memset(r->y, 0, (size_t)r->nc * sizeof *r->y);
    memcpy(r->x, r->qr.a + (size_t)rank * (size_t)r->nv, (size_t)rank * sizeof *r->x);
    hn_qr_solve_r(&r->qr, r->x);
    for (int k = 0; k < rank; k++) {
        r->y[r->qr.perm[k]] = -r->x[k];
    }
    r->y[r->qr.perm[rank]] = 1;
    (void)normalise(r->nc, r->y);
}

void hn_singularity_pose_at(hn_singularity *r, double t, const double *q, double sigma_min,
                            hn_singularity_pose *pose) {
    const double lost = TOGETHER * fmax(sigma_min, RANK_TOL);
    *pose = (hn_singularity_pose){.mobility_before = r->nv - r->start_rank,
                                  .mobility = r->nv - r->start_rank};
    if (r->nc == 0 || lost > 0.5 * r->last.sigma_max) {
        return;
    }

    // rows that are lost together with the weakest direction
    hn_eval_run(r->rows, t, q, r->no_speed);
    scale(r);
    fill_qr(r);
    hn_qr_factor(&r->qr, r->nv, r->nc, 0);
    while (r->qr.rank > 0 && diagonal(r, r->qr.rank - 1) <= lost) {
        r->qr.rank--;
    }

    pose->mobility = r->nv - r->qr.rank;
    if (r->qr.rank == r->nc) {
        return;
    }

    // which rows, and the branches where a single freedom meets another
    vanishing_combination(r);
    find_lost_rows(r, pose);
    const int simple = pose->mobility == 2 && pose->mobility_before == 1 && r->start_rank == r->nc;
    if (simple && !hn_system_get_info(r->sys).has_time) {
        double *w = r->w; // scaled rows: R w belongs to J
        for (int i = 0; i < r->nc; i++) {
            w[i] = r->y[i] * r->r[i];
        }
        pose->branches = count_branches(r, t, q, w);
        memcpy(w, r->y, (size_t)r->nc * sizeof *w);
    }
}
