// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/analyse/singularity_monitor.h"

#include "dynamics/analyse/lookout.h"
#include "dynamics/analyse/round_trip.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/factor.h"
#include "linalg/dense.h"
#include "linalg/qr.h"

#include <math.h>
#include <string.h>

static const double LOST = 1e-8;     // ratio below which rows count as lost
static const double RANK_TOL = 1e-8; // of the QR that answers where the factor cannot
static const double PARTED = 0.05;   // pivot, of the largest, of a row that has become independent
// operations a look may cost on average where only the QR answers
static const double DENSE_BUDGET = 2e5;
// prediction: a pilot run starts when sigma_min falls below this share of the largest so far, and
// reports what it finds below the second share
static const double FALLEN = 0.97;
// that finds what a run reports as nearly dependent: pivots of 1e-4, which are squares
static const double REACHED = 8e-3;
// a motion goes on along a closed curve without looking ahead where sigma_min stays above this
// share of its largest all the way round, and is the same again, but for the second share, where
// the way closes
static const double CLEAR = 0.1, SAME = 0.01;
// singular values within this factor of the smallest are lost together
static const double TOGETHER = 5;
static const double WEAK = 0.02; // and none above this of the largest pivot is
static const double CUSP = 1e-6; // discriminant against the squares of the form's entries
enum { SWEEPS = 2, FIRST_SWEEPS = 30, PROBE_SWEEPS = 8 };

struct hn_singularity {
    const hn_system *sys;
    int nq, nv, nc;
    hn_eval *rows, *gamma; // J and M; gamma
    hn_factor *factor;
    int n_J, n_M;
    const int *J_row, *J_col, *M_row, *M_col;
    const double *J, *M; // entries of `rows`
    double *d, *r;       // scales: nv, nc
    double *w, *top;     // nc: left vectors of the smallest and the largest singular value
    double both, half;   // of two rows: both vectors by their products, where `pending`
    bool pending;        // w and top are still to be found from these
    double *x, *y;       // nv, nc scratch
    double *v, *basis;   // nv, 2 nv
    double *beside;      // nq
    double *kept[3];     // nc: r, w and top of the last look, while a probe uses them
    hn_qr qr;            // nv x nc: (R J D)'
    double *no_speed;
    int first, start_rank, wait;
    double largest, strongest; // sigma_min and sigma_max so far
    hn_lookout *lookout;
    double next_pilot;   // [s] no pilot run before
    double lowest_ahead; // sigma_min where the last one that found something came nearest
    hn_round_trip *round;
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
    r->beside = hn_arena_doubles(arena, (size_t)info.nq);
    if (!hn_qr_init(&r->qr, arena, info.nv, info.nc) || hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // evaluators and the factor
    hn_status status = hn_eval_create_listed(sys, HN_TERM_J | HN_TERM_M, arena, &r->rows);
    if (status == HN_OK) {
        r->n_J = hn_eval_pattern(r->rows, HN_TERM_J, &r->J_row, &r->J_col);
        r->n_M = hn_eval_pattern(r->rows, HN_TERM_M, &r->M_row, &r->M_col);
        r->J = hn_eval_list(r->rows, HN_TERM_J);
        r->M = hn_eval_list(r->rows, HN_TERM_M);
        status = hn_eval_create(sys, HN_TERM_GAMMA, arena, &r->gamma);
    }
    HN_THEN(status, hn_factor_create(sys, HN_FACTOR_DIAGONAL, arena, &r->factor));
    HN_THEN(status, hn_lookout_create(sys, arena, &r->lookout));
    HN_THEN(status, hn_round_trip_create(sys, arena, &r->round));

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
        hn_lookout_free(r->lookout);
        r->lookout = NULL;
        r->rows = r->gamma = NULL;
        r->factor = NULL;
    }
}

void hn_singularity_reset(hn_singularity *r) {
    r->first = 1;
    r->wait = 0;
    r->pending = false;
    r->next_pilot = -HUGE_VAL;
    hn_lookout_reset(r->lookout);
    hn_round_trip_reset(r->round);
    r->last = (hn_singularity_info){.ratio = 1, .ahead = HUGE_VAL, .predicted = -HUGE_VAL};
    r->largest = r->strongest = 0;
    r->start_rank = r->nc;
    memset(r->r, 0, (size_t)r->nc * sizeof *r->r);
    for (int i = 0; i < r->nc; i++) {
        // no row is favoured or missed
        r->w[i] = r->top[i] = 0.5 + fmod(0.6180339887498949 * (i + 1), 1);
    }
}

/// D, and R as the reciprocal of the largest length that each row has had.
static void scale(hn_singularity *r) {
    for (int j = 0; j < r->nv; j++) {
        r->d[j] = 1;
    }
    for (int k = 0; k < r->n_M; k++) {
        if (r->M_row[k] == r->M_col[k]) {
            r->d[r->M_row[k]] = r->M[k] > 0 ? 1 / sqrt(r->M[k]) : 1;
        }
    }
    memset(r->y, 0, (size_t)r->nc * sizeof *r->y);
    for (int k = 0; k < r->n_J; k++) {
        const double e = r->J[k] * r->d[r->J_col[k]];
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
        r->x[j] += r->J[k] * r->r[i] * r->d[j] * r->top[i];
    }
    memset(r->top, 0, (size_t)r->nc * sizeof *r->top);
    for (int k = 0; k < r->n_J; k++) {
        const int i = r->J_row[k], j = r->J_col[k];
        r->top[i] += r->J[k] * r->r[i] * r->d[j] * r->x[j];
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
        r->qr.a[(size_t)i * (size_t)r->nv + (size_t)j] = r->J[k] * r->r[i] * r->d[j];
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

/// The left vectors of two rows, where they are still to be found.
static void find_vectors(hn_singularity *r) {
    if (r->pending) {
        const double phi = 0.5 * atan2(r->both, r->half);
        r->top[0] = r->w[1] = cos(phi);
        r->top[1] = sin(phi);
        r->w[0] = -sin(phi);
        r->pending = false;
    }
}

static void look_sparsely(hn_singularity *r, int sweeps, hn_singularity_info *info) {
    find_vectors(r);
    for (int i = 0; i < sweeps; i++) {
        info->sigma_max = sweep_top(r);
        info->sigma_min = sweep_bottom(r);
    }
}

/// Two rows, as every planar loop has: singular values in closed form, sigma_min from the part of
/// one row across the other, which loses no digits. The left vectors wait until they are asked for.
/// False where the rows are as good as dependent.
static bool look_at_two(hn_singularity *r, hn_singularity_info *info) {
    fill_qr(r);
    const int n = r->nv;
    const double *row[2] = {r->qr.a, r->qr.a + n};
    const double size[2] = {hn_dot(n, row[0], row[0]), hn_dot(n, row[1], row[1])};
    const int base = size[1] > size[0];
    const double both = hn_dot(n, row[0], row[1]);
    if (!(size[base] > 0)) {
        return false;
    }

    // the shorter row less its part along the longer one
    double across = 0;
    for (int j = 0; j < n; j++) {
        const double x = row[!base][j] - both / size[base] * row[base][j];
        across += x * x;
    }

    // the symmetric 2x2 matrix of the products of rows
    const double half = (size[0] - size[1]) / 2;
    const double largest = (size[0] + size[1]) / 2 + sqrt(half * half + both * both);
    info->sigma_max = sqrt(largest);
    info->sigma_min = sqrt(size[base] * across / largest);
    r->both = both;
    r->half = half;
    r->pending = true;
    return info->sigma_min > RANK_TOL * info->sigma_max;
}

/// Singular values at a state whose rows and scales are there; returns false when the dense
/// factorisation had to answer. It alone leaves out rows that always depend on others: the sparse
/// factor takes them for nearly dependent where it keeps some digit of their pivots.
static bool look(hn_singularity *r, double t, const double *q, int sweeps,
                 hn_singularity_info *info) {
    if (r->nc == 2 && r->start_rank == 2 && look_at_two(r, info)) {
        return true;
    }
    const bool all_count = r->first || r->start_rank == r->nc;
    if (all_count && hn_factor_update(r->factor, t, q, NULL) == HN_OK) {
        look_sparsely(r, sweeps, info);
        return true;
    }
    look_densely(r, info);
    return false;
}

static double probe(void *user, double t, const double *q) {
    return hn_singularity_probe(user, t, q);
}

/// Follows the motion round its curve of configurations, where it has one degree of freedom.
static void follow_round(hn_singularity *r, double t, const double *q, const double *v,
                         double sigma) {
    double start = 0;
    if (r->nv - r->start_rank != 1) {
        return;
    }
    const double *back = hn_round_trip_look(r->round, t, q, v, sigma, &start);

    // rows that do not repeat with the angles have another sigma_min there
    if (back && !(fabs(hn_singularity_probe(r, t, back) - start) <= SAME * r->largest)) {
        hn_round_trip_reject(r->round);
    }
}

/// Decides whether a pilot run is due: sigma_min has fallen, or there has been a singular
/// configuration already; and the last run is over or was long ago against how fast the motion is.
static void look_ahead(hn_singularity *r, double t, const double *q, const double *v,
                       hn_singularity_info *info) {
    const double horizon = hn_pilot_half_turn(hn_lookout_pilot(r->lookout), v);
    const bool falls = info->sigma_min < r->last.sigma_min && info->sigma_min < FALLEN * r->largest;
    const bool again = isfinite(r->last.predicted);
    const bool known = !again && hn_round_trip_lowest(r->round) > CLEAR * r->largest;
    if (!(falls || again) || known || r->wait > 0 || t < r->next_pilot || !isfinite(horizon)) {
        return;
    }
    const hn_lookout_aim aim = {probe, r, REACHED * r->largest};
    info->ahead =
        hn_lookout_search(r->lookout, t, q, v, horizon, info->sigma_min, &aim, &r->lowest_ahead);
    info->lowest = r->lowest_ahead;
    info->predicted = isfinite(info->ahead) ? t + info->ahead : info->predicted;
    r->next_pilot = t + (isfinite(info->ahead) ? info->ahead + 0.1 * horizon : 0.25 * horizon);
}

void hn_singularity_check(hn_singularity *r, double t, const double *q, const double *v,
                          hn_singularity_info *info) {
    const double predicted = r->last.predicted;
    *info = (hn_singularity_info){.ratio = 1, .ahead = HUGE_VAL, .predicted = predicted};
    if (r->nc == 0) {
        return;
    }

    // a dense check that costs much is done now and then only
    if (r->wait > 0) {
        r->wait--;
        *info = r->last;
        return;
    }

    // singular values here
    hn_eval_run(r->rows, t, q, r->no_speed);
    scale(r);
    if (!look(r, t, q, r->first ? FIRST_SWEEPS : SWEEPS, info)) {
        // a loop that is redundant everywhere is looked at less often when it is large
        r->wait = (int)(2.0 * r->nv * r->nc * r->nc / DENSE_BUDGET);
    }
    // where all rows die away together the largest value dies with the smallest
    r->strongest = fmax(r->strongest, info->sigma_max);
    info->sigma_max = r->strongest;
    info->ratio = info->sigma_max > 0 ? info->sigma_min / info->sigma_max : 0;
    info->lost = info->ratio < LOST;
    r->largest = fmax(r->largest, info->sigma_min);
    if (r->first) {
        r->last = *info;
        r->first = 0;
    }
    follow_round(r, t, q, v, info->sigma_min);
    look_ahead(r, t, q, v, info);
    r->last = *info;
    r->last.ahead = HUGE_VAL; // said once
}

/// The record of the checks about the rows: kept, or restored.
static void keep(hn_singularity *r, int back) {
    if (back) {
        r->pending = false; // those of the probe
    } else {
        find_vectors(r);
    }
    double *const known[] = {r->r, r->w, r->top};
    for (int i = 0; i < 3; i++) {
        memcpy(back ? known[i] : r->kept[i], back ? r->kept[i] : known[i],
               (size_t)r->nc * sizeof **known);
    }
}

bool hn_singularity_probe_both(hn_singularity *r, double t, const double *q,
                               hn_singularity_info *info) {
    if (r->nc == 0 || r->wait > 0 || r->first) {
        return false;
    }
    const int rank = r->start_rank;
    keep(r, 0);
    hn_eval_run(r->rows, t, q, r->no_speed);
    scale(r);
    (void)look(r, t, q, PROBE_SWEEPS, info);
    keep(r, 1);
    r->start_rank = rank;
    info->sigma_max = fmax(r->strongest, info->sigma_max);
    info->ratio = info->sigma_max > 0 ? info->sigma_min / info->sigma_max : 0;
    return true;
}

const double *hn_singularity_scale(const hn_singularity *r) {
    return r->d;
}

hn_pilot *hn_singularity_pilot(hn_singularity *r) {
    return hn_lookout_pilot(r->lookout);
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

/// A way from a pose [rad, or of the length], and the pivot there of rows that are lost at the pose
/// itself: of the order of the way, and of its square where the rows always depend on each other.
static const double BESIDE = 1e-4, PARTS = 1e-6;
/// Pivots that are lost at a configuration [of the largest], and rows that are nothing there [of
/// the longest]: accelerations lose them where their squares are rounding, and beside the
/// configuration they are about BESIDE.
static const double LOST_HERE = 1e-6;

/// Moves r->beside from q a little along all velocities that J allows at q, none favoured or
/// missed. Returns false where there are none.
static bool move_beside(hn_singularity *r, const double *q) {
    double *way = r->basis, *one = r->basis + r->nv;
    memset(way, 0, (size_t)r->nv * sizeof *way);
    for (int k = r->qr.rank; k < r->nv; k++) {
        kernel_column(r, k, one);
        hn_axpy(r->nv, 0.5 + fmod(0.6180339887498949 * k, 1), one, way);
    }
    const double half_turn = hn_pilot_half_turn(hn_lookout_pilot(r->lookout), way);
    if (!isfinite(half_turn)) {
        return false;
    }
    for (int j = 0; j < r->nv; j++) {
        way[j] *= BESIDE * half_turn / acos(-1);
    }
    memcpy(r->beside, q, (size_t)r->nq * sizeof *q);
    hn_system_move(r->sys, r->beside, way);
    return true;
}

/// As fill_qr(); a row that is nothing here has no scale of its own, and takes that of the longest.
static void fill_by_longest(hn_singularity *r) {
    double shortest = 1;
    for (int i = 0; i < r->nc; i++) {
        shortest = r->r[i] > 0 ? fmin(shortest, r->r[i]) : shortest;
    }
    memcpy(r->y, r->r, (size_t)r->nc * sizeof *r->r);
    for (int i = 0; i < r->nc; i++) {
        r->r[i] = r->r[i] > 0 && r->r[i] * LOST_HERE < shortest ? r->r[i] : shortest;
    }
    fill_qr(r);
    memcpy(r->r, r->y, (size_t)r->nc * sizeof *r->r);
}

bool hn_singularity_is_local(hn_singularity *r, double t, const double *q) {
    if (r->nc == 0 || r->first) {
        return false;
    }
    hn_eval_run(r->rows, t, q, r->no_speed);
    scale(r);
    fill_by_longest(r);
    hn_qr_factor(&r->qr, r->nv, r->nc, LOST_HERE);
    const int rank = r->qr.rank;
    if (rank >= r->nc || !move_beside(r, q)) {
        return false;
    }
    hn_eval_run(r->rows, t, r->beside, r->no_speed);
    fill_by_longest(r);
    hn_qr_factor(&r->qr, r->nv, r->nc, 0);
    return rank < r->nv && diagonal(r, rank) > PARTS * fmax(diagonal(r, 0), BESIDE);
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

/// Rows that are kept at a configuration where the weakest are below `lost`. Near it, rows that are
/// lost together have pivots of different sizes (those of a long chain span two decades), but the
/// kept ones are far above all of them: the widest gap between neighbouring pivots divides the two.
static int count_kept(const hn_singularity *r, double lost) {
    const int rank = r->qr.rank;
    int kept = rank;
    double widest = 0;
    while (kept > 0 && diagonal(r, kept - 1) <= lost) {
        kept--;
    }
    for (int k = 1, surely = kept; k <= surely && k < rank; k++) {
        const double gap = diagonal(r, k - 1) / fmax(diagonal(r, k), RANK_TOL * diagonal(r, 0));
        if (gap > widest && diagonal(r, k) < WEAK * diagonal(r, 0)) {
            widest = gap;
            kept = k;
        }
    }
    return kept;
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
    r->qr.rank = count_kept(r, lost);

    pose->mobility = r->nv - r->qr.rank;
    if (r->qr.rank == r->nc) {
        return;
    }

    // which rows, and the branches where a single freedom meets another
    vanishing_combination(r);
    find_lost_rows(r, pose);
    const int simple = pose->mobility == 2 && pose->mobility_before == 1 && r->start_rank == r->nc;
    if (simple && !hn_system_get_info(r->sys).has_time) {
        find_vectors(r);
        double *w = r->w; // scaled rows: R w belongs to J
        for (int i = 0; i < r->nc; i++) {
            w[i] = r->y[i] * r->r[i];
        }
        pose->branches = count_branches(r, t, q, w);
        memcpy(w, r->y, (size_t)r->nc * sizeof *w);
    }
}
