// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/implicit_linear_solve.h"

#include "linalg/dense.h"

#include <string.h>

// vectors in parts: x *= (re, im)
static void multiply(int parts, int n, double *const *x, double re, double im) {
    for (int i = 0; i < n; i++) {
        const double a = x[0][i];
        x[0][i] = re * a;
        if (parts == 2) {
            x[0][i] -= im * x[1][i];
            x[1][i] = im * a + re * x[1][i];
        }
    }
}

// x += sign * y
static void add(int parts, int n, double sign, double *const *y, double *const *x) {
    for (int p = 0; p < parts; p++) {
        hn_axpy(n, sign, y[p], x[p]);
    }
}

// x (n) into the packed right side from its entry `first` on
static void pack(hn_implicit_linear *l, int parts, int first, int n, const int *of,
                 double *const *x) {
    for (int i = 0; i < n; i++) {
        for (int p = 0; p < parts; p++) {
            l->packed[parts * (first + i) + p] = x[p][of ? of[i] : i];
        }
    }
}

// the reverse; rows that are left out become 0
static void unpack(const hn_implicit_linear *l, int parts, int first, int n, const int *of,
                   double *const *x) {
    for (int p = 0; p < parts; p++) {
        if (of) {
            memset(x[p], 0, (size_t)l->nc * sizeof *x[p]);
        }
        for (int i = 0; i < n; i++) {
            x[p][of ? of[i] : i] = l->packed[parts * (first + i) + p];
        }
    }
}

static void solve_saddle(hn_implicit_linear *l, int parts, double *const *top,
                         double *const *bottom) {
    const int nv = l->nv, nk = l->n_kept;
    pack(l, parts, 0, nv, NULL, top);
    pack(l, parts, nv, nk, l->kept, bottom);
    hn_newton_matrix_solve(l->matrix[parts - 1], l->packed);
    unpack(l, parts, 0, nv, NULL, top);
    unpack(l, parts, nv, nk, l->kept, bottom);
}

// system (3): along is -s times its last right side on entry; p and m on return
static void solve_extended(hn_implicit_linear *l, int parts, const double *s, double *const *top,
                           double *const *bottom, double *const *along, double *const *pushed) {
    const int nv = l->nv, nk = l->n_kept, n = nv + nk;
    const hn_complex one = hn_complex_reciprocal(s[0], s[1]);
    multiply(parts, l->nc, along, -one.re, -one.im);
    memset(l->packed, 0, (size_t)(2 * parts * n) * sizeof *l->packed);
    pack(l, parts, 0, nv, NULL, top);
    pack(l, parts, nv, nk, l->kept, bottom);
    pack(l, parts, n + nv, nk, l->kept, along);
    hn_newton_matrix_solve(l->matrix[parts - 1], l->packed);
    unpack(l, parts, 0, nv, NULL, top);
    unpack(l, parts, nv, nk, l->kept, bottom);
    unpack(l, parts, n, nv, NULL, pushed);
    unpack(l, parts, n + nv, nk, l->kept, along);
    multiply(parts, nv, pushed, s[0], s[1]);
    multiply(parts, l->nc, along, s[0], s[1]);
}

// rows <- S^-1 rows, those that were left out become 0
static void solve_stabiliser(hn_implicit_linear *l, double *rows) {
    double *packed = l->packed_rows;
    for (int k = 0; k < l->n_kept; k++) {
        packed[k] = rows[l->kept[k]];
    }
    hn_cholesky_solve(l->n_kept, l->S, l->n_kept, packed);
    memset(rows, 0, (size_t)l->nc * sizeof *rows);
    for (int k = 0; k < l->n_kept; k++) {
        rows[l->kept[k]] = packed[k];
    }
}

// top += C Y S^-1 e
static void push_stabiliser(hn_implicit_linear *l, const double *e, double *top, double *rows,
                            double *moved) {
    memcpy(rows, e, (size_t)l->nc * sizeof *rows);
    solve_stabiliser(l, rows);
    hn_mat_vec(l->nv, l->nc, l->Y, rows, moved);
    for (int i = 0; i < l->nv; i++) {
        top[i] += hn_dot(l->nv, l->C + (size_t)i * (size_t)l->nv, moved);
    }
}

// -(r2 + C r1) - s M r1 into top; J r1 into along
static void start_right_side(hn_implicit_linear *l, int parts, double *const *r1, double *const *r2,
                             const double *s, double *const *top, double *const *along,
                             double *const *scratch) {
    for (int p = 0; p < parts; p++) {
        hn_linear_apply(l->terms, HN_LINEAR_M, r1[p], top[p]);
        hn_linear_apply(l->terms, HN_LINEAR_J, r1[p], along[p]);
    }
    multiply(parts, l->nv, top, s[0], s[1]);
    for (int p = 0; p < parts; p++) {
        if (l->has_damping) {
            hn_linear_apply(l->terms, HN_LINEAR_C, r1[p], scratch[p]);
            hn_axpy(l->nv, 1, scratch[p], top[p]);
        }
        hn_axpy(l->nv, 1, r2[p], top[p]);
    }
    multiply(parts, l->nv, top, -1, 0);
}

// J's rows as (2) wants them, from r3 and J r1
static void constraint_side(const hn_implicit_linear *l, int parts, const double *s,
                            double *const *r3, double *const *along, double *const *bottom) {
    const hn_complex one = hn_complex_reciprocal(s[0], s[1]);
    for (int p = 0; p < parts; p++) {
        for (int i = 0; i < l->nc; i++) {
            bottom[p][i] = -r3[p][i] - (l->form == HN_FORM_INDEX2 ? along[p][i] : 0);
        }
    }
    if (l->form == HN_FORM_INDEX2) {
        multiply(parts, l->nc, bottom, one.re, one.im);
    }
}

/// The parts of a right side by rows of the system, and what is made of them, in one or two parts.
typedef struct sides {
    int parts;
    const double *s;
    double *r1[2], *r2[2], *r3[2], *r4[2]; ///< r4: GGL only
    double *top[2], *along[2], *bottom[2], *rows[2], *scratch[2];
} sides;

static sides split_sides(const hn_implicit_linear *l, hn_parts r) {
    sides b = {.parts = r.n, .s = l->s[r.n - 1]};
    for (int p = 0; p < 2; p++) {
        if (p < r.n) {
            b.r1[p] = r.at[p];
            b.r2[p] = b.r1[p] + l->nv;
            b.r3[p] = b.r2[p] + l->nv;
            b.r4[p] = b.r3[p] + l->nc;
        }
        b.top[p] = l->work[p][0];
        b.along[p] = l->work[p][1];
        b.bottom[p] = l->work[p][2];
        b.rows[p] = l->work[p][3];
        b.scratch[p] = l->work[p][4];
    }
    return b;
}

// e = r3' + J r1 - s r3, and what it pushes
static void add_stabiliser(hn_implicit_linear *l, const sides *b) {
    multiply(b->parts, l->nc, b->r3, b->s[0], b->s[1]);
    add(b->parts, l->nc, -1, b->r3, b->along);
    add(b->parts, l->nc, 1, b->r4, b->along);
    for (int p = 0; p < b->parts && l->has_damping && !l->sparse; p++) {
        push_stabiliser(l, b->along[p], b->top[p], b->rows[p], b->scratch[p]);
    }
}

// m into r4, w -= Y m, l' -= s m
static void take_stabiliser(hn_implicit_linear *l, const sides *b) {
    for (int p = 0; p < b->parts; p++) {
        if (l->sparse) {
            memcpy(b->r4[p], b->along[p], (size_t)l->nc * sizeof *b->r4[p]);
        } else {
            hn_linear_apply(l->terms, HN_LINEAR_V, b->top[p], b->r4[p]);
            hn_axpy(l->nc, 1, b->along[p], b->r4[p]);
            solve_stabiliser(l, b->r4[p]);
            hn_mat_vec(l->nv, l->nc, l->Y, b->r4[p], b->scratch[p]);
            l->ops += 2.0 * l->nv * l->nc;
        }
        hn_axpy(l->nv, -1, b->scratch[p], b->r2[p]);
        memcpy(b->rows[p], b->r4[p], (size_t)l->nc * sizeof *b->rows[p]);
    }
    multiply(b->parts, l->nc, b->rows, b->s[0], b->s[1]);
    add(b->parts, l->nc, -1, b->rows, b->r3);
}

// l' = s^2 times what was solved for; w = s x + r1 (- Y m)
static void take_solution(hn_implicit_linear *l, const sides *b) {
    const int nv = l->nv, nc = l->nc, parts = b->parts;
    const double *s = b->s, square[2] = {s[0] * s[0] - s[1] * s[1], 2 * s[0] * s[1]};
    multiply(parts, nc, b->bottom, square[0], square[1]);
    for (int p = 0; p < parts; p++) {
        memcpy(b->r2[p], b->top[p], (size_t)nv * sizeof *b->top[p]);
        memcpy(b->r3[p], b->bottom[p], (size_t)nc * sizeof *b->bottom[p]);
    }
    multiply(parts, nv, b->r2, s[0], s[1]);
    add(parts, nv, 1, b->r1, b->r2);
    if (l->stabilised) {
        take_stabiliser(l, b);
    }
    for (int p = 0; p < parts; p++) {
        memcpy(b->r1[p], b->top[p], (size_t)nv * sizeof *b->top[p]);
    }
}

void hn_implicit_linear_solve(hn_implicit_linear *l, hn_parts r) {
    sides b = split_sides(l, r);
    const hn_complex one = hn_complex_reciprocal(b.s[0], b.s[1]);
    const double two[2] = {one.re * one.re - one.im * one.im, 2 * one.re * one.im};
    l->ops += 2.0 * b.parts *
              (hn_linear_entries(l->terms, HN_LINEAR_M) + hn_linear_entries(l->terms, HN_LINEAR_J) +
               hn_linear_entries(l->terms, HN_LINEAR_C));
    start_right_side(l, b.parts, b.r1, b.r2, b.s, b.top, b.along, b.scratch);
    constraint_side(l, b.parts, b.s, b.r3, b.along, b.bottom);
    if (l->stabilised) {
        add_stabiliser(l, &b);
    }
    multiply(b.parts, l->nv, b.top, two[0], two[1]);
    if (l->stabilised && l->sparse) {
        solve_extended(l, b.parts, b.s, b.top, b.bottom, b.along, b.scratch);
    } else {
        solve_saddle(l, b.parts, b.top, b.bottom);
    }
    take_solution(l, &b);
}
