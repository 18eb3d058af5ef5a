// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/vec3.h"

#include "expr/construct.h"

#include <math.h>
#include <stdbool.h>

hn_vec3 hn_vec3_zero(void) {
    return (hn_vec3){{hn_num(0), hn_num(0), hn_num(0)}};
}

hn_vec3 hn_vec3_num(const double v[3]) {
    return (hn_vec3){{hn_num(v[0]), hn_num(v[1]), hn_num(v[2])}};
}

static hn_ex add(hn_graph *g, hn_ex a, hn_ex b) {
    if (hn_is_zero(a)) {
        return b;
    }
    return hn_is_zero(b) ? a : hn_add(g, a, b);
}

static hn_ex mul(hn_graph *g, hn_ex a, hn_ex b) {
    if (hn_is_zero(a) || hn_is_zero(b)) {
        return hn_num(0);
    }
    return hn_mul(g, a, b);
}

/// a b + c d + e f
static hn_ex sum_of_products(hn_graph *g, hn_ex a, hn_ex b, hn_ex c, hn_ex d, hn_ex e, hn_ex f) {
    // made one after the other: nodes are numbered as they are made, and sums are sorted by number
    hn_ex terms[3];
    terms[0] = mul(g, a, b);
    terms[1] = mul(g, c, d);
    terms[2] = mul(g, e, f);
    int n = 0;
    for (int i = 0; i < 3; i++) {
        if (!hn_is_zero(terms[i])) {
            terms[n++] = terms[i];
        }
    }
    return n == 0 ? hn_num(0) : n == 1 ? terms[0] : hn_sum(g, terms, n);
}

hn_vec3 hn_vec3_add(hn_graph *g, hn_vec3 a, hn_vec3 b) {
    for (int i = 0; i < 3; i++) {
        a.x[i] = add(g, a.x[i], b.x[i]);
    }
    return a;
}

hn_vec3 hn_vec3_sub(hn_graph *g, hn_vec3 a, hn_vec3 b) {
    for (int i = 0; i < 3; i++) {
        a.x[i] = add(g, a.x[i], hn_neg(b.x[i]));
    }
    return a;
}

hn_vec3 hn_vec3_scale(hn_graph *g, hn_ex k, hn_vec3 a) {
    for (int i = 0; i < 3; i++) {
        a.x[i] = mul(g, k, a.x[i]);
    }
    return a;
}

/// a b - c d, the second product made first. The order of arguments of a call is the compiler's,
/// and with it the numbers of the nodes; a temporary settles it.
static hn_ex difference(hn_graph *g, hn_ex a, hn_ex b, hn_ex c, hn_ex d) {
    const hn_ex second = hn_neg(mul(g, c, d));
    const hn_ex first = mul(g, a, b);
    return add(g, first, second);
}

/// a b + c d, likewise.
static hn_ex sum_of_two(hn_graph *g, hn_ex a, hn_ex b, hn_ex c, hn_ex d) {
    const hn_ex second = mul(g, c, d);
    const hn_ex first = mul(g, a, b);
    return add(g, first, second);
}

hn_vec3 hn_vec3_cross(hn_graph *g, hn_vec3 a, hn_vec3 b) {
    hn_vec3 out;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out.x[i] = difference(g, a.x[j], b.x[k], a.x[k], b.x[j]);
    }
    return out;
}

hn_ex hn_vec3_cross_z(hn_graph *g, hn_vec3 a, hn_vec3 b) {
    return difference(g, a.x[0], b.x[1], a.x[1], b.x[0]);
}

hn_ex hn_vec3_dot(hn_graph *g, hn_vec3 a, hn_vec3 b) {
    return sum_of_products(g, a.x[0], b.x[0], a.x[1], b.x[1], a.x[2], b.x[2]);
}

hn_mat3 hn_mat3_identity(void) {
    return hn_mat3_turn_z(hn_num(1), hn_num(0));
}

hn_mat3 hn_mat3_num(double m[3][3]) {
    hn_mat3 out;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out.x[i][j] = hn_num(m[i][j]);
        }
    }
    return out;
}

hn_vec3 hn_mat3_apply(hn_graph *g, const hn_mat3 *m, hn_vec3 a) {
    hn_vec3 out;
    for (int i = 0; i < 3; i++) {
        out.x[i] = hn_vec3_dot(g, (hn_vec3){{m->x[i][0], m->x[i][1], m->x[i][2]}}, a);
    }
    return out;
}

hn_vec3 hn_mat3_apply_transposed(hn_graph *g, const hn_mat3 *m, hn_vec3 a) {
    hn_vec3 out;
    for (int i = 0; i < 3; i++) {
        out.x[i] = hn_vec3_dot(g, hn_mat3_column(m, i), a);
    }
    return out;
}

hn_mat3 hn_mat3_mul(hn_graph *g, const hn_mat3 *a, const hn_mat3 *b) {
    hn_mat3 out;
    for (int j = 0; j < 3; j++) {
        hn_vec3 column = hn_mat3_apply(g, a, hn_mat3_column(b, j));
        for (int i = 0; i < 3; i++) {
            out.x[i][j] = column.x[i];
        }
    }
    return out;
}

hn_vec3 hn_mat3_column(const hn_mat3 *m, int j) {
    return (hn_vec3){{m->x[0][j], m->x[1][j], m->x[2][j]}};
}

hn_mat3 hn_mat3_turn_z(hn_ex c, hn_ex s) {
    hn_ex zero = hn_num(0), one = hn_num(1);
    return (hn_mat3){{{c, hn_neg(s), zero}, {s, c, zero}, {zero, zero, one}}};
}

void hn_mat3_snap(hn_mat3 *m) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double value;
            if (hn_is_number(m->x[i][j], &value) && fabs(value - round(value)) < HN_NUM3_SNAP) {
                m->x[i][j] = hn_num(round(value));
            }
        }
    }
}

/// Row i of the symmetric matrix.
static hn_vec3 sym3_row(const hn_sym3 *m, int i) {
    static const int at[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    return (hn_vec3){{m->x[at[i][0]], m->x[at[i][1]], m->x[at[i][2]]}};
}

hn_vec3 hn_sym3_apply(hn_graph *g, const hn_sym3 *m, hn_vec3 a) {
    hn_vec3 out;
    for (int i = 0; i < 3; i++) {
        out.x[i] = hn_vec3_dot(g, sym3_row(m, i), a);
    }
    return out;
}

hn_sym3 hn_sym3_add(hn_graph *g, const hn_sym3 *a, const hn_sym3 *b) {
    hn_sym3 out;
    for (int i = 0; i < 6; i++) {
        out.x[i] = add(g, a->x[i], b->x[i]);
    }
    return out;
}

hn_sym3 hn_sym3_rotate(hn_graph *g, const hn_mat3 *R, const hn_sym3 *m) {
    static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    hn_vec3 half[3]; // rows of R m
    hn_vec3 r[3];
    for (int i = 0; i < 3; i++) {
        r[i] = (hn_vec3){{R->x[i][0], R->x[i][1], R->x[i][2]}};
        half[i] = hn_sym3_apply(g, m, r[i]);
    }
    hn_sym3 out;
    for (int k = 0; k < 6; k++) {
        out.x[k] = hn_vec3_dot(g, half[row[k]], r[column[k]]);
    }
    return out;
}

hn_sym3 hn_sym3_turn_z(hn_graph *g, hn_ex c, hn_ex s, const hn_sym3 *m) {
    // with k = c (xx - yy) - 2 s xy:  xx' = yy + c k,  xy' = xy + s k,  yy' = xx - c k
    const hn_ex twice = mul(g, s, hn_scale(-2, m->x[3]));
    const hn_ex apart = add(g, m->x[0], hn_neg(m->x[1]));
    const hn_ex k = add(g, mul(g, c, apart), twice);
    hn_ex ck = mul(g, c, k);
    hn_sym3 out;
    out.x[0] = add(g, m->x[1], ck);
    out.x[1] = add(g, m->x[0], hn_neg(ck));
    out.x[2] = m->x[2];
    out.x[3] = add(g, m->x[3], mul(g, s, k));
    out.x[4] = difference(g, c, m->x[4], s, m->x[5]);
    out.x[5] = sum_of_two(g, s, m->x[4], c, m->x[5]);
    return out;
}

hn_sym3 hn_sym3_shift(hn_graph *g, hn_ex m, hn_vec3 s, hn_vec3 r, int only_zz) {
    // with t = 2 s + m r: diagonal entries are sums of r_j t_j, the others -(r_i t_j + t_i r_j) / 2
    const hn_vec3 mr = hn_vec3_scale(g, m, r);
    const hn_vec3 t = hn_vec3_add(g, hn_vec3_scale(g, hn_num(2), s), mr);
    hn_ex rt[3];
    for (int i = 0; i < 3; i++) {
        rt[i] = mul(g, r.x[i], t.x[i]);
    }

    hn_ex zero = hn_num(0);
    hn_sym3 out = {{zero, zero, add(g, rt[0], rt[1]), zero, zero, zero}};
    if (only_zz) {
        return out;
    }

    // the other two diagonal entries, then the products
    out.x[0] = add(g, rt[1], rt[2]);
    out.x[1] = add(g, rt[2], rt[0]);
    static const int first[3] = {0, 0, 1}, second[3] = {1, 2, 2};
    for (int k = 0; k < 3; k++) {
        int i = first[k], j = second[k];
        hn_ex both = sum_of_two(g, r.x[i], t.x[j], t.x[i], r.x[j]);
        out.x[3 + k] = hn_scale(-0.5, both);
    }
    return out;
}

hn_mat3 hn_mat3_accel(hn_graph *g, hn_vec3 w, hn_vec3 al) {
    hn_ex sq[3];
    for (int i = 0; i < 3; i++) {
        sq[i] = mul(g, w.x[i], w.x[i]);
    }
    hn_mat3 out;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out.x[i][i] = hn_neg(add(g, sq[j], sq[k]));
        hn_ex product = mul(g, w.x[i], w.x[j]);
        out.x[i][j] = add(g, product, hn_neg(al.x[k]));
        out.x[j][i] = add(g, product, al.x[k]);
    }
    return out;
}
