// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/pivot_noise.h"
#include "formulations/ground/slopes.h"

#include "dynamics/compile/quaternion.h"
#include "formulations/ground/flops.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

// a basis of the rows fills the matrix with about so many entries; where it would be more, some of
// the rows have to do
#define MOST_COMBINED 50000

const double *hn_unit_positions(const hn_system *sys, const double *q, double *unit) {
    const hn_system_info info = hn_system_get_info(sys);
    if (info.nq == info.nv) {
        return q;
    }
    memcpy(unit, q, (size_t)info.nq * sizeof *unit);
    (void)hn_system_normalise(sys, unit);
    return unit;
}

// ---- life ----

static unsigned terms_of(const hn_accel_jacobian *j) {
    return HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_J | HN_LINEAR_GAMMA_Q |
           HN_LINEAR_GAMMA_V | (j->stabilised ? HN_LINEAR_V : 0u) |
           (j->gives ? HN_LINEAR_F | HN_LINEAR_GAMMA | HN_LINEAR_PHI | HN_LINEAR_SPEED_GAP : 0u);
}

static hn_status create_tapes(hn_accel_jacobian *j, hn_arena *arena) {
    const hn_accel_opts opts = {.baumgarte = j->stabilised, .want_lambda = 1};
    HN_TRY(hn_linear_create_listed(j->sys, terms_of(j), arena, &j->terms));
    HN_TRY(hn_linear_create_listed(j->sys, HN_LINEAR_V, arena, &j->twist));
    if (!j->gives) {
        HN_TRY(hn_accel_create(j->sys, &opts, arena, &j->accel));
    }
    return HN_OK;
}

// entries of q that are not a ball's stand in the order of their speeds
static void list_balls(hn_accel_jacobian *j) {
    int position = 0;
    for (int i = 0; i < j->nv; i++) {
        j->at[i] = hn_system_position_of(j->sys, i);
        j->ball_of[i] = -1;
        if (j->at[i] >= 0) {
            position = j->at[i] + 1;
            continue;
        }
        j->balls[j->n_balls] = (hn_ball_place){position, i};
        for (int k = 0; k < 3; k++) {
            j->at[i + k] = -1;
            j->ball_of[i + k] = j->n_balls;
        }
        j->n_balls++;
        position += 4;
        i += 2;
    }
}

static hn_status create_matrices(hn_accel_jacobian *j, hn_arena *arena) {
    const hn_linear *l = j->terms;
    const int square = hn_linear_entries(l, HN_LINEAR_M) + hn_linear_entries(l, HN_LINEAR_K) +
                       hn_linear_entries(l, HN_LINEAR_C);
    const int rows =
        hn_linear_entries(l, HN_LINEAR_J) + hn_linear_entries(l, HN_LINEAR_GAMMA_Q) +
        hn_linear_entries(l, HN_LINEAR_GAMMA_V) + hn_linear_entries(j->twist, HN_LINEAR_V) +
        (j->stabilised ? hn_linear_entries(l, HN_LINEAR_V) + hn_linear_entries(l, HN_LINEAR_J) : 0);

    // by position an entry of a ball is spread over its three speeds
    const int spread = j->n_balls > 0 ? 3 : 1;
    const int n = j->nv + j->nc;
    j->may_combine = (long long)rows * spread * j->nc <= MOST_COMBINED;
    const int puts = spread * (square + 2 * rows * (j->may_combine ? j->nc + 1 : 1)) + j->nc;
    const int sparse = hn_newton_matrix_wants_sparse(n, (long long)square / 2 + rows);
    j->product_ops = 2.0 * (square + rows);

    // one matrix per kind of system
    for (int k = 0; k < HN_SLOPES_MATRICES; k++) {
        j->matrix[k] = hn_newton_matrix_create(arena, k == HN_SLOPES_COMPLEX ? HN_COMPLEX : HN_REAL,
                                               sparse, n, puts);
        if (!j->matrix[k]) {
            return HN_ERR_MEMORY;
        }
    }
    return HN_OK;
}

static hn_status allocate(hn_accel_jacobian *j, hn_arena *arena) {
    const size_t nv = (size_t)j->nv, nc = (size_t)j->nc, n = nv + nc;
    j->state = hn_arena_doubles(arena, (size_t)j->nq + nv);
    j->unit = hn_arena_doubles(arena, (size_t)j->nq);
    j->a = hn_arena_doubles(arena, nv);
    j->lambda = hn_arena_doubles(arena, nc);
    j->twisted = hn_arena_doubles(arena, (size_t)hn_linear_entries(j->twist, HN_LINEAR_V));
    j->packed = hn_arena_doubles(arena, 2 * n);
    j->kept = hn_arena_ints(arena, nc);
    j->place = hn_arena_ints(arena, nc);
    j->at = hn_arena_ints(arena, nv);
    j->ball_of = hn_arena_ints(arena, nv);
    j->balls = hn_arena_get(arena, (nv / 3 + 1) * sizeof *j->balls);
    for (int k = 0; k < 8; k++) {
        j->work[k / 4][k % 4] = hn_arena_doubles(arena, n);
    }
    j->W = hn_arena_doubles(arena, nc * nc);
    j->whole_M = hn_arena_doubles(arena, nv * nv);
    j->whole_J = hn_arena_doubles(arena, nc * nv);
    const int most = j->nv > j->nc ? j->nv : j->nc;
    const int good = hn_qr_init(&j->qr, arena, most, most);
    return good && !hn_arena_failed(arena) ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_accel_jacobian_create(const hn_system *sys, const hn_accel_law *law, hn_arena *arena,
                                   hn_accel_jacobian **out) {
    const hn_system_info info = hn_system_get_info(sys);
    hn_accel_jacobian *j = hn_arena_get(arena, sizeof *j);
    if (!j) {
        return HN_ERR_MEMORY;
    }
    *j = (hn_accel_jacobian){.sys = sys,
                             .nq = info.nq,
                             .nv = info.nv,
                             .nc = info.nc,
                             .has_time = info.has_time,
                             .stabilised = law->alpha != 0 || law->beta != 0,
                             .gives = law->give > 0};

    // tapes, memory, matrices
    hn_status status = create_tapes(j, arena);
    HN_THEN(status, allocate(j, arena));
    if (status == HN_OK) {
        list_balls(j);
        j->q = j->state;
        j->v = j->state + j->nq;
        status = create_matrices(j, arena);
    }
    if (status != HN_OK) {
        hn_accel_jacobian_free(j);
        return status;
    }
    *out = j;
    return HN_OK;
}

void hn_accel_jacobian_free(hn_accel_jacobian *j) {
    if (!j) {
        return;
    }
    hn_accel_free(j->accel);
    hn_linear_free(j->terms);
    hn_linear_free(j->twist);
    for (int k = 0; k < HN_SLOPES_MATRICES; k++) {
        hn_newton_matrix_free(j->matrix[k]);
        j->matrix[k] = NULL;
    }
    j->accel = NULL;
    j->terms = j->twist = NULL;
}

// ---- products with the rows of (2) ----

// out (nc) -= B_v x
static void subtract_by_speed(const hn_accel_jacobian *j, const double *x, double *out) {
    hn_slopes_add_term(j, HN_LINEAR_GAMMA_V, -1, x, out);
    if (j->stabilised) {
        hn_slopes_add_term(j, HN_LINEAR_J, -2 * j->law.alpha, x, out);
    }
}

// out (nv) += k X' x for a term X
static void add_transposed(const hn_accel_jacobian *j, hn_linear_term term, double k,
                           const double *x, double *out) {
    const double *list = hn_linear_list(j->terms, term);
    const int *rows, *cols, n = hn_linear_pattern(j->terms, term, &rows, &cols);
    for (int e = 0; e < n; e++) {
        out[cols[e]] += k * list[e] * x[rows[e]];
    }
}

// by_position (nv) -= B_q' x, by_speed (nv) -= B_v' x
static void subtract_transposed(const hn_accel_jacobian *j, const double *x, double *by_position,
                                double *by_speed) {
    const int *rows, *cols, n = hn_linear_pattern(j->twist, HN_LINEAR_V, &rows, &cols);
    for (int e = 0; e < n; e++) {
        by_position[cols[e]] -= j->twisted[e] * x[rows[e]];
    }
    add_transposed(j, HN_LINEAR_GAMMA_Q, -1, x, by_position);
    add_transposed(j, HN_LINEAR_GAMMA_V, -1, x, by_speed);
    if (j->stabilised) {
        add_transposed(j, HN_LINEAR_V, -2 * j->law.alpha, x, by_position);
        add_transposed(j, HN_LINEAR_J, -j->law.beta * j->law.beta, x, by_position);
        add_transposed(j, HN_LINEAR_J, -2 * j->law.alpha, x, by_speed);
    }
}

// ---- at a state ----

hn_status hn_accel_jacobian_prepare(hn_accel_jacobian *j) {
    hn_slopes_put_saddle(j, j->matrix[HN_SLOPES_RESTING]);
    return hn_newton_matrix_factor(j->matrix[HN_SLOPES_RESTING]);
}

// entry of J where masses are of size 1, as linalg/saddle.h looks at it
static double weigh_entry(const hn_accel_jacobian *j, int row, int col) {
    const double m = j->whole_M[(size_t)col * (size_t)j->nv + (size_t)col];
    return j->whole_J[(size_t)row * (size_t)j->nv + (size_t)col] / (m > 0 ? sqrt(m) : 1);
}

// one over the length of each row, short ones stretched no more than the accelerations do
// (linalg/saddle.h, row_floor)
static const double *scale_rows(const hn_accel_jacobian *j) {
    double *scale = j->work[0][1], longest = 0;
    hn_linear_copy_whole(j->terms, HN_LINEAR_M, j->whole_M);
    hn_linear_copy_whole(j->terms, HN_LINEAR_J, j->whole_J);
    for (int i = 0; i < j->nc; i++) {
        double sum = 0;
        for (int k = 0; k < j->nv; k++) {
            const double e = weigh_entry(j, i, k);
            sum += e * e;
        }
        scale[i] = sqrt(sum);
        longest = fmax(longest, scale[i] / hn_system_row_unit(j->sys, i));
    }
    for (int i = 0; i < j->nc; i++) {
        const double least = HN_PIVOT_NOISE_ROW_FLOOR * longest * hn_system_row_unit(j->sys, i);
        scale[i] = fmax(scale[i], least);
        scale[i] = scale[i] > 0 ? 1 / scale[i] : 1;
    }
    return scale;
}

// rows in use: pivots of J'
static void choose_rows(hn_accel_jacobian *j, int rank) {
    const int nv = j->nv, nc = j->nc;
    const double *scale = scale_rows(j);
    for (int i = 0; i < nc; i++) {
        for (int k = 0; k < nv; k++) {
            j->qr.a[i * nv + k] = scale[i] * weigh_entry(j, i, k);
        }
    }
    hn_qr_factor(&j->qr, nv, nc, 0);
    j->n_kept = rank < j->qr.rank ? rank : j->qr.rank;
    for (int k = 0; k < j->n_kept; k++) {
        j->kept[k] = j->qr.perm[k];
    }
    j->ops += hn_flops_qr(nv, nc);
}

// Rows in use: an orthonormal basis of what the rows hold. Off the closed set, where rows that
// depend on each other part, the accelerations meet them in the least-squares sense; with the basis
// held that has these derivatives but for the gap times its turning.
static void combine_rows(hn_accel_jacobian *j, int rank) {
    const int nv = j->nv, nc = j->nc;
    double *column = j->work[0][0];
    const double *scale = scale_rows(j);

    // QR of the weighted rows
    for (int i = 0; i < nc; i++) {
        for (int k = 0; k < nv; k++) {
            j->qr.a[k * nc + i] = scale[i] * weigh_entry(j, i, k);
        }
    }
    hn_qr_factor(&j->qr, nc, nv, 0);
    j->combined = 1;
    j->n_kept = rank < j->qr.rank ? rank : j->qr.rank;

    // columns of Q span what the rows hold
    for (int k = 0; k < j->n_kept; k++) {
        memset(column, 0, (size_t)nc * sizeof *column);
        column[k] = 1;
        hn_qr_apply_q(&j->qr, column);
        for (int i = 0; i < nc; i++) {
            j->W[i * j->n_kept + k] = column[i] * scale[i];
        }
    }
    j->ops += hn_flops_qr(nv, nc);
}

static void keep_rows(hn_accel_jacobian *j, int rank) {
    j->combined = 0;
    if (rank == j->nc) {
        j->n_kept = rank;
        for (int k = 0; k < rank; k++) {
            j->kept[k] = k;
        }
    } else if (j->may_combine) {
        combine_rows(j, rank);
    } else {
        choose_rows(j, rank);
    }
    for (int i = 0; i < j->nc; i++) {
        j->place[i] = -1;
    }
    for (int k = 0; k < j->n_kept && !j->combined; k++) {
        j->place[j->kept[k]] = k;
    }
}

// Multipliers of the kept rows alone that push as all of them do: off the closed set, where rows
// part, only these belong to accelerations that the kept rows decide.
static hn_status shift_multipliers(hn_accel_jacobian *j) {
    double *top = j->work[0][0], *rows = j->work[0][1];
    HN_TRY(hn_accel_jacobian_prepare(j));
    memset(rows, 0, (size_t)j->nc * sizeof *rows);
    hn_linear_apply_transposed(j->terms, HN_LINEAR_J, j->lambda, top);
    for (int i = 0; i < j->nv; i++) {
        top[i] = -top[i];
    }
    hn_slopes_pack(j, 1, 0, top, rows);
    hn_newton_matrix_solve(j->matrix[HN_SLOPES_RESTING], j->packed);
    memset(j->lambda, 0, (size_t)j->nc * sizeof *j->lambda);
    for (int k = 0; k < j->n_kept; k++) {
        j->lambda[j->kept[k]] = j->packed[j->nv + k];
    }
    return HN_OK;
}

// (J a)_q = V(a) - V(0), as V is linear in the speeds and V(0) belongs to time
static void find_twist(hn_accel_jacobian *j, double t) {
    const double *V = hn_linear_list(j->twist, HN_LINEAR_V);
    const int *rows, *cols, n = hn_linear_pattern(j->twist, HN_LINEAR_V, &rows, &cols);
    hn_linear_run(j->twist, t, j->pose, j->a, NULL, NULL);
    for (int e = 0; e < n; e++) {
        j->twisted[e] = V[e];
    }
    if (j->has_time) {
        hn_linear_run(j->twist, t, j->pose, NULL, NULL, NULL);
        for (int e = 0; e < n; e++) {
            j->twisted[e] -= V[e];
        }
    }
}

// a and lambda of a penalty, from (1)
static hn_status give_way(hn_accel_jacobian *j, double t) {
    const int nv = j->nv, nc = j->nc;
    double *rows = j->work[0][0];
    hn_linear_run(j->terms, t, j->pose, j->v, NULL, NULL);
    keep_rows(j, nc);
    HN_TRY(hn_accel_jacobian_prepare(j));
    const double *gamma = hn_linear_get(j->terms, HN_LINEAR_GAMMA),
                 *phi = hn_linear_get(j->terms, HN_LINEAR_PHI),
                 *gap = hn_linear_get(j->terms, HN_LINEAR_SPEED_GAP);
    for (int i = 0; i < nc; i++) {
        rows[i] = -gamma[i] - 2 * j->law.alpha * gap[i] - j->law.beta * j->law.beta * phi[i];
    }
    hn_slopes_pack(j, 1, 0, hn_linear_get(j->terms, HN_LINEAR_F), rows);
    hn_newton_matrix_solve(j->matrix[HN_SLOPES_RESTING], j->packed);
    memcpy(j->a, j->packed, (size_t)nv * sizeof *j->a);
    memcpy(j->lambda, j->packed + nv, (size_t)nc * sizeof *j->lambda);
    return HN_OK;
}

hn_status hn_accel_jacobian_at(hn_accel_jacobian *j, double t, const double *q, const double *v,
                               const hn_accel_law *law) {
    hn_accel_info info = {.rank = j->nc};
    hn_status status;

    // copy the state; balls with unit quaternions
    memcpy(j->state, q, (size_t)j->nq * sizeof *q);
    memcpy(j->state + j->nq, v, (size_t)j->nv * sizeof *v);
    j->pose = hn_unit_positions(j->sys, j->q, j->unit);
    j->law = *law;

    // accelerations and multipliers
    if (j->gives) {
        status = give_way(j, t);
    } else {
        status = hn_accel_eval(j->accel, t, j->pose, j->v, law->alpha, law->beta, j->a, j->lambda,
                               &info);
        j->evals++;
    }

    // linearised terms with the rows in use
    if (status == HN_OK) {
        hn_linear_run(j->terms, t, j->pose, j->v, j->a, j->lambda);
        keep_rows(j, info.rank);
        if (j->n_kept < j->nc && !j->combined) {
            status = shift_multipliers(j);
            hn_linear_run(j->terms, t, j->pose, j->v, j->a, j->lambda);
        }
        find_twist(j, t);
    }

    if (status != HN_OK) {
        return status;
    }
    return hn_linear_is_finite(j->terms, HN_LINEAR_K) && hn_linear_is_finite(j->terms, HN_LINEAR_C)
               ? HN_OK
               : HN_ERR_DIVERGED;
}

// ---- derivatives ----

void hn_accel_jacobian_along(hn_accel_jacobian *j, const double *dx, const double *dv, double *da) {
    double *top = j->work[0][0], *rows = j->work[0][1];
    memset(top, 0, (size_t)j->nv * sizeof *top);
    memset(rows, 0, (size_t)j->nc * sizeof *rows);
    if (dx) {
        hn_slopes_add_term(j, HN_LINEAR_K, -1, dx, top);
        hn_slopes_subtract_by_position(j, dx, rows);
    }
    if (dv) {
        hn_slopes_add_term(j, HN_LINEAR_C, -1, dv, top);
        subtract_by_speed(j, dv, rows);
    }
    hn_slopes_pack(j, 1, 0, top, rows);
    hn_newton_matrix_solve(j->matrix[HN_SLOPES_RESTING], j->packed);
    memcpy(da, j->packed, (size_t)j->nv * sizeof *da);
}

// multipliers of the rows in use, as packed, spread over all rows: the transposed of packing
static void unpack_rows(const hn_accel_jacobian *j, const double *packed, double *rows) {
    memset(rows, 0, (size_t)j->nc * sizeof *rows);
    for (int i = 0; i < j->nc && j->combined; i++) {
        rows[i] = hn_dot(j->n_kept, j->W + (size_t)i * (size_t)j->n_kept, packed);
    }
    for (int k = 0; k < j->n_kept && !j->combined; k++) {
        rows[j->kept[k]] = packed[k];
    }
}

void hn_accel_jacobian_back(hn_accel_jacobian *j, const double *w, double *out) {
    const int nv = j->nv;
    double *top = j->work[0][0], *rows = j->work[0][1];

    // the adjoint of (2)
    memcpy(top, w + nv, (size_t)nv * sizeof *top);
    memset(rows, 0, (size_t)j->nc * sizeof *rows);
    hn_slopes_pack(j, 1, 0, top, rows);
    hn_newton_matrix_solve(j->matrix[HN_SLOPES_RESTING], j->packed);
    for (int k = 0; k < j->n_kept; k++) {
        j->packed[nv + k] = -j->packed[nv + k];
    }
    unpack_rows(j, j->packed + nv, rows);

    // products with the derivatives by positions and velocities
    memset(out, 0, (size_t)nv * sizeof *out);
    memcpy(out + nv, w, (size_t)nv * sizeof *out);
    add_transposed(j, HN_LINEAR_K, -1, j->packed, out);
    add_transposed(j, HN_LINEAR_C, -1, j->packed, out + nv);
    subtract_transposed(j, rows, out, out + nv);

    // a displacement along a ball's own axes: dx' = dv - v x dx
    for (int k = 0; k < j->n_balls; k++) {
        const int at = j->balls[k].speed;
        const double *o = j->v + at, *x = w + at;
        out[at] += o[1] * x[2] - o[2] * x[1];
        out[at + 1] += o[2] * x[0] - o[0] * x[2];
        out[at + 2] += o[0] * x[1] - o[1] * x[0];
    }
}

void hn_accel_jacobian_carry(const hn_accel_jacobian *j, const double *dx, double *rows) {
    hn_linear_apply(j->terms, HN_LINEAR_V, dx, rows);
}

// what turning ball k does to q': columns of its four entries and three speeds; and its part of
// dv'/dq from that by turns
static void fill_ball(const hn_accel_jacobian *j, const hn_ball_place *b, double *jac) {
    const int n = j->nq + j->nv;
    const double *q = j->q + b->position, *omega = j->v + b->speed;
    const double back[4] = {q[0], -q[1], -q[2], -q[3]}, size = hn_dot(4, q, q);
    double unit[4], rate[4], dx[4];

    // derivatives by the four entries of the quaternion
    for (int k = 0; k < 4; k++) {
        const int col = b->position + k;
        memset(unit, 0, sizeof unit);
        unit[k] = 1;
        hn_quat_rate(unit, omega, rate);
        hn_quat_mul(back, unit, dx);
        for (int i = 0; i < 4; i++) {
            jac[(b->position + i) * n + col] = rate[i];
        }
        // the turns' columns were left where the speeds' belong: see hn_accel_jacobian_fill
        for (int i = 0; i < j->nv; i++) {
            double *row = jac + (size_t)(j->nq + i) * n;
            row[col] = 0;
            for (int c = 0; c < 3; c++) {
                row[col] += 2 / size * dx[1 + c] * row[j->nq + b->speed + c];
            }
        }
    }

    // derivatives of its rate by the three velocities
    for (int c = 0; c < 3; c++) {
        double along[3] = {0};
        along[c] = 1;
        hn_quat_rate(q, along, rate);
        for (int i = 0; i < 4; i++) {
            jac[(b->position + i) * n + j->nq + b->speed + c] = rate[i];
        }
    }
}

// column of dv'/dy
static void fill_column(hn_accel_jacobian *j, int i, int by_speed, int col, double *jac) {
    const int n = j->nq + j->nv;
    double *unit = j->work[1][0], *da = j->work[1][1];
    memset(unit, 0, (size_t)j->nv * sizeof *unit);
    unit[i] = 1;
    hn_accel_jacobian_along(j, by_speed ? NULL : unit, by_speed ? unit : NULL, da);
    for (int k = 0; k < j->nv; k++) {
        jac[(size_t)(j->nq + k) * n + col] = da[k];
    }
}

hn_status hn_accel_jacobian_fill(hn_accel_jacobian *j, double *jac) {
    const int nq = j->nq, nv = j->nv, n = nq + nv;
    HN_TRY(hn_accel_jacobian_prepare(j));
    memset(jac, 0, (size_t)n * (size_t)n * sizeof *jac);
    for (int i = 0; i < nv; i++) {
        fill_column(j, i, 0, j->at[i] >= 0 ? j->at[i] : nq + i, jac);
        if (j->at[i] >= 0) {
            jac[j->at[i] * n + nq + i] = 1;
        }
    }
    for (int k = 0; k < j->n_balls; k++) {
        fill_ball(j, &j->balls[k], jac);
    }
    for (int i = 0; i < nv; i++) {
        fill_column(j, i, 1, nq + i, jac);
    }
    return HN_OK;
}

long long hn_accel_jacobian_evals(const hn_accel_jacobian *j) {
    return j->evals;
}

double hn_accel_jacobian_ops(const hn_accel_jacobian *j) {
    double ops = j->ops + (double)hn_linear_count(j->terms) * hn_linear_ops(j->terms) +
                 (double)hn_linear_count(j->twist) * hn_linear_ops(j->twist) +
                 (j->accel ? hn_accel_ops(j->accel) : 0);
    for (int k = 0; k < HN_SLOPES_MATRICES; k++) {
        ops += hn_newton_matrix_ops(j->matrix[k]);
    }
    return ops;
}
