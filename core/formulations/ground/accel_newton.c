// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/accel_newton.h"

#include "dynamics/compile/quaternion.h"
#include "formulations/ground/slopes.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

/// dx = P dv + g of one ball: (s w + 1/2 w x omega) / size, w = dv + what is on the right.
typedef struct turn {
    hn_complex s, over; ///< over: 1 / (s^2 + |omega|^2 / 4)
    double omega[3];
} turn;

// ---- complex numbers ----

static hn_complex times(hn_complex a, hn_complex b) {
    return (hn_complex){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static hn_complex inverse(hn_complex a) {
    const double size = a.re * a.re + a.im * a.im;
    return (hn_complex){a.re / size, -a.im / size};
}

static hn_complex plus(hn_complex a, hn_complex b) {
    return (hn_complex){a.re + b.re, a.im + b.im};
}

static hn_complex scaled(double k, hn_complex a) {
    return (hn_complex){k * a.re, k * a.im};
}

static hn_complex load(int parts, double *const *x, int i) {
    return (hn_complex){x[0][i], parts == 2 ? x[1][i] : 0};
}

static void store(int parts, double *const *x, int i, hn_complex value) {
    x[0][i] = value.re;
    if (parts == 2) {
        x[1][i] = value.im;
    }
}

// ---- matrices ----

static turn turn_of(const hn_accel_jacobian *j, int which, hn_complex s) {
    const double *omega = j->v + j->balls[which].speed;
    const double square = hn_dot(3, omega, omega) / 4;
    return (turn){
        s, inverse(plus(times(s, s), (hn_complex){square, 0})), {omega[0], omega[1], omega[2]}};
}

// entry (row, col) of P: column `col` of s w + 1/2 w x omega, over the size
static hn_complex turn_entry(const turn *p, int row, int col) {
    if (row == col) {
        return times(p->s, p->over);
    }
    // (e_col x omega)_row is omega of the third axis, positive where (col, third, row) is cyclic
    const int third = 3 - row - col;
    const double sign = (col + 1) % 3 == third ? 1 : -1;
    return scaled(sign * p->omega[third] / 2, p->over);
}

// k x P at an entry (row, col) of X whose columns are displacements
static void put_displaced(const hn_accel_jacobian *j, const hn_slopes_target *at, int row, int col,
                          hn_complex s, hn_complex k, double x) {
    const int which = j->ball_of[col];
    if (which < 0) {
        hn_slopes_put_entry(j, at, row, col, scaled(x, times(k, inverse(s))));
        return;
    }
    const turn p = turn_of(j, which, s);
    const int first = j->balls[which].speed;
    for (int c = 0; c < 3; c++) {
        hn_slopes_put_entry(j, at, row, first + c,
                            scaled(x, times(k, turn_entry(&p, col - first, c))));
    }
}

static void put_term_displaced(const hn_accel_jacobian *j, const hn_slopes_target *at,
                               hn_linear_term term, hn_complex s, hn_complex k) {
    const double *list = hn_linear_list(j->terms, term);
    const int *rows, *cols, n = hn_linear_pattern(j->terms, term, &rows, &cols);
    for (int e = 0; e < n; e++) {
        put_displaced(j, at, rows[e], cols[e], s, k, list[e]);
    }
}

static void put_rows_by_position(const hn_accel_jacobian *j, const hn_slopes_target *at,
                                 hn_complex s) {
    const hn_complex one = inverse(s);
    const int *rows, *cols, n = hn_linear_pattern(j->twist, HN_LINEAR_V, &rows, &cols);
    for (int e = 0; e < n; e++) {
        put_displaced(j, at, rows[e], cols[e], s, one, j->twisted[e]);
    }
    put_term_displaced(j, at, HN_LINEAR_GAMMA_Q, s, one);
    if (j->stabilised) {
        put_term_displaced(j, at, HN_LINEAR_V, s, scaled(2 * j->law.alpha, one));
        put_term_displaced(j, at, HN_LINEAR_J, s, scaled(j->law.beta * j->law.beta, one));
    }
}

hn_status hn_accel_jacobian_factor(hn_accel_jacobian *j, int which, double re, double im) {
    const hn_complex s = {re, which == HN_SLOPES_REAL ? 0 : im}, one = inverse(s);
    hn_newton_matrix *to = j->matrix[which];
    const hn_slopes_target square = {to, 0, 0}, rows = {to, j->nv, 1};
    j->s[which] = s;
    hn_slopes_put_saddle(j, to);
    hn_slopes_put_term(j, &square, HN_LINEAR_C, one);
    put_term_displaced(j, &square, HN_LINEAR_K, s, one);
    hn_slopes_put_term(j, &rows, HN_LINEAR_GAMMA_V, one);
    if (j->stabilised) {
        hn_slopes_put_term(j, &rows, HN_LINEAR_J, scaled(2 * j->law.alpha, one));
    }
    put_rows_by_position(j, &rows, s);
    return hn_newton_matrix_factor(to);
}

// ---- Newton's systems ----

/// The kinematics of one ball with its right side r1: p = (p0, dx) with dq = 1/2 q o p solves s p -
/// 1/2 p o omega = rho + (0, dv), rho = 2 q^-1 o r1.
static void turn_ball(const hn_accel_jacobian *j, const hn_ball_place *b, const turn *p, int parts,
                      double *const *r, const hn_complex *dv, hn_complex out[4]) {
    const double *q = j->q + b->position, size = hn_dot(4, q, q);
    const double back[4] = {q[0], -q[1], -q[2], -q[3]};
    const double spin[4] = {0, p->omega[0], p->omega[1], p->omega[2]};
    double rho[2][4] = {{0}}, turned[2][4] = {{0}};
    for (int part = 0; part < parts; part++) {
        hn_quat_mul(back, r[part] + b->position, rho[part]);
        for (int i = 0; i < 4; i++) {
            const double speed = i == 0 || !dv ? 0 : part ? dv[i - 1].im : dv[i - 1].re;
            rho[part][i] = 2 / size * rho[part][i] + speed;
        }
        hn_quat_mul(rho[part], spin, turned[part]);
    }
    for (int i = 0; i < 4; i++) {
        const hn_complex w = {rho[0][i], rho[1][i]}, t = {turned[0][i], turned[1][i]};
        out[i] = times(p->over, plus(times(p->s, w), scaled(0.5, t)));
    }
}

// g of (3)
static void find_offset(const hn_accel_jacobian *j, hn_complex s, int parts, double *const *r,
                        double *const *g) {
    for (int i = 0; i < j->nv; i++) {
        if (j->at[i] >= 0) {
            store(parts, g, i, times(inverse(s), load(parts, r, j->at[i])));
        }
    }
    for (int k = 0; k < j->n_balls; k++) {
        const turn p = turn_of(j, k, s);
        hn_complex out[4];
        turn_ball(j, &j->balls[k], &p, parts, r, NULL, out);
        for (int c = 0; c < 3; c++) {
            store(parts, g, j->balls[k].speed + c, out[1 + c]);
        }
    }
}

// positions of the solution from its speeds, in place of r1
static void find_positions(const hn_accel_jacobian *j, hn_complex s, int parts, double *const *r) {
    // plain coordinates
    for (int i = 0; i < j->nv; i++) {
        if (j->at[i] >= 0) {
            const hn_complex sum = plus(load(parts, r, j->at[i]), load(parts, r, j->nq + i));
            store(parts, r, j->at[i], times(inverse(s), sum));
        }
    }

    // balls
    for (int k = 0; k < j->n_balls; k++) {
        const hn_ball_place *b = &j->balls[k];
        const turn p = turn_of(j, k, s);
        hn_complex dv[3], out[4];
        for (int c = 0; c < 3; c++) {
            dv[c] = load(parts, r, j->nq + b->speed + c);
        }
        turn_ball(j, b, &p, parts, r, dv, out);
        for (int part = 0; part < parts; part++) {
            double half[4];
            for (int i = 0; i < 4; i++) {
                half[i] = (part ? out[i].im : out[i].re) / 2;
            }
            hn_quat_mul(j->q + b->position, half, r[part] + b->position);
        }
    }
}

void hn_accel_jacobian_solve(hn_accel_jacobian *j, int parts, double *const *x) {
    const int nq = j->nq, nv = j->nv, which = parts - 1;
    const hn_complex s = j->s[which], one = inverse(s);
    double *const g[2] = {j->work[0][2], j->work[1][2]};
    find_offset(j, s, parts, x, g);

    // right side of (3)
    for (int part = 0; part < parts; part++) {
        double *top = j->work[part][0], *rows = j->work[part][1];
        memset(top, 0, (size_t)nv * sizeof *top);
        memset(rows, 0, (size_t)j->nc * sizeof *rows);
        hn_slopes_add_term(j, HN_LINEAR_M, 1, x[part] + nq, top);
        hn_slopes_add_term(j, HN_LINEAR_K, -1, g[part], top);
        hn_slopes_add_term(j, HN_LINEAR_J, 1, x[part] + nq, rows);
        hn_slopes_subtract_by_position(j, g[part], rows);
        hn_slopes_pack(j, parts, part, top, rows);
    }

    // divided by s, then solved
    for (int i = 0; i < nv + j->n_kept; i++) {
        const hn_complex value = {j->packed[parts * i], parts == 2 ? j->packed[2 * i + 1] : 0};
        const hn_complex over = times(one, value);
        j->packed[parts * i] = over.re;
        if (parts == 2) {
            j->packed[2 * i + 1] = over.im;
        }
    }
    hn_newton_matrix_solve(j->matrix[which], j->packed);

    // velocities of the solution, and positions from them
    for (int i = 0; i < nv; i++) {
        for (int part = 0; part < parts; part++) {
            x[part][nq + i] = j->packed[parts * i + part];
        }
    }
    find_positions(j, s, parts, x);
    j->ops += parts * j->product_ops;
}
