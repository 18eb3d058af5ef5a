// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/analyse/dyads_form.h"

#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { TRIALS = 3 };
// of the terms' size: two expressions agree at a random pose, rounding aside
static const double SAME = 1e-10;

// ---- recognising ----

typedef struct reader {
    const hn_system *sys;
    hn_graph *g;
    hn_dyad_step *step;
    int symbol[2]; ///< of the unknowns
} reader;

static hn_ex diff(const reader *r, hn_ex e, int unknown) {
    hn_ex out;
    hn_diff(r->g, e, &r->symbol[unknown], 1, &out);
    return out;
}

static hn_ex at_zero(const reader *r, hn_ex e) {
    const hn_ex zero[2] = {hn_num(0), hn_num(0)};
    hn_ex out;
    hn_substitute(r->g, &e, 1, r->symbol, zero, r->step->dyad.n, &out);
    return out;
}

static hn_ex phi_of(const reader *r, int i) {
    return hn_system_get_exprs(r->sys).phi[r->step->dyad.row[i]];
}

static bool slides(const reader *r, int unknown) {
    for (int i = 0; i < r->step->dyad.n; i++) {
        if (!hn_is_zero(diff(r, diff(r, phi_of(r, i), unknown), unknown))) {
            return false;
        }
    }
    return true;
}

/// Row i with x the turning unknown, if any turns (the unknowns are in that order).
static void read_row(const reader *r, int i, int n_turn) {
    hn_dyad_form *f = &r->step->form;
    const int two = r->step->dyad.n == 2;
    hn_graph *g = r->g;
    const hn_ex phi = phi_of(r, i), phi_x = diff(r, phi, 0);

    // the first unknown: an angle by its cosine and sine, or a slide by its slope
    hn_ex rest = at_zero(r, phi);
    if (n_turn > 0) {
        const hn_ex phi_xx = diff(r, phi_x, 0);
        f->A.e[i] = hn_neg(at_zero(r, phi_xx));
        f->B.e[i] = at_zero(r, phi_x);
        rest = hn_sub(g, rest, f->A.e[i]);
        if (two && n_turn == 1) {
            f->U.e[i] = hn_neg(at_zero(r, diff(r, phi_xx, 1)));
            f->V.e[i] = at_zero(r, diff(r, phi_x, 1));
            f->W.e[i] = hn_sub(g, at_zero(r, diff(r, phi, 1)), f->U.e[i]);
        }
    } else {
        f->A.e[i] = at_zero(r, phi_x);
        f->W.e[i] = two ? at_zero(r, diff(r, phi, 1)) : hn_num(0);
    }

    // the second unknown, where it is an angle too
    if (n_turn == 2) {
        const hn_ex phi_y = diff(r, phi, 1);
        f->C.e[i] = hn_neg(at_zero(r, diff(r, phi_y, 1)));
        f->D.e[i] = at_zero(r, phi_y);
        rest = hn_sub(g, rest, f->C.e[i]);
    }

    f->E.e[i] = rest;
}

static double noise(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return 2 * (double)(*seed >> 8) / 16777216.0 - 1;
}

/// The form in numbers at a random pose.
typedef struct values {
    double A[2], B[2], C[2], D[2], U[2], V[2], W[2], E[2], phi[2], x, y;
} values;

static void evaluate(const reader *r, double *x, unsigned *seed, values *out) {
    const hn_dyad_form *f = &r->step->form;
    const struct {
        const hn_pair *from;
        double *to;
    } parts[] = {{&f->A, out->A}, {&f->B, out->B}, {&f->C, out->C}, {&f->D, out->D},
                 {&f->U, out->U}, {&f->V, out->V}, {&f->W, out->W}, {&f->E, out->E}};
    const int n_symbols = hn_graph_n_symbols(r->g);
    memset(out, 0, sizeof *out);
    for (int i = 0; i < n_symbols; i++) {
        x[i] = 0.2 + noise(seed);
    }
    out->x = x[r->symbol[0]];
    out->y = r->step->dyad.n == 2 ? x[r->symbol[1]] : 0;
    for (int i = 0; i < r->step->dyad.n; i++) {
        out->phi[i] = hn_graph_eval(r->g, phi_of(r, i), x);
        for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
            parts[k].to[i] = hn_graph_eval(r->g, parts[k].from->e[i], x);
        }
    }
}

/// phi made from the form is phi.
static bool is_form_of_phi(const values *v, int n, int n_turn) {
    const double cx = cos(v->x), sx = sin(v->x), cy = cos(v->y), sy = sin(v->y);
    for (int i = 0; i < n; i++) {
        const double of_x = n_turn > 0 ? v->A[i] * cx + v->B[i] * sx : v->A[i] * v->x;
        const double of_y = v->C[i] * cy + v->D[i] * sy;
        const double along = v->y * (v->U[i] * cx + v->V[i] * sx + v->W[i]);
        const double sum = of_x + of_y + along + v->E[i];
        const double size = fabs(of_x) + fabs(of_y) + fabs(along) + fabs(v->E[i]) + fabs(v->phi[i]);
        if (!(fabs(sum - v->phi[i]) <= SAME * size)) {
            return false;
        }
    }
    return true;
}

static double dot(const double a[2], const double b[2]) {
    return a[0] * b[0] + a[1] * b[1];
}

/// a cos x + b sin x keeps its length: b is a turned by a right angle.
static bool is_rigid(const double a[2], const double b[2]) {
    const double size = dot(a, a) + dot(b, b);
    return fabs(dot(a, a) - dot(b, b)) <= SAME * size && fabs(dot(a, b)) <= SAME * size;
}

static bool is_null(const double a[2], double size) {
    return hypot(a[0], a[1]) <= SAME * size;
}

/// With one turning unknown: the direction y U turns with it, or y W does not, or neither of both.
static hn_dyad_kind kind_of_slide(const values *v) {
    const double turning = hypot(v->U[0], v->U[1]) + hypot(v->V[0], v->V[1]),
                 fixed = hypot(v->W[0], v->W[1]);
    if (is_null(v->U, fixed) && is_null(v->V, fixed)) {
        return HN_DYAD_RRP;
    }
    const double a[2] = {v->A[0] + v->U[0], v->A[1] + v->U[1]},
                 b[2] = {v->B[0] + v->V[0], v->B[1] + v->V[1]};
    return is_null(v->W, turning) && is_rigid(v->A, v->B) && is_rigid(v->U, v->V) && is_rigid(a, b)
               ? HN_DYAD_RPR
               : HN_DYAD_KIND_COUNT;
}

static hn_dyad_kind kind_of(const values *v, int n, int n_turn) {
    if (!is_form_of_phi(v, n, n_turn)) {
        return HN_DYAD_KIND_COUNT;
    }
    if (n == 1) {
        return n_turn ? HN_DYAD_TURN : HN_DYAD_SINGLE;
    }
    if (n_turn == 2) {
        return is_rigid(v->A, v->B) && is_rigid(v->C, v->D) ? HN_DYAD_RRR : HN_DYAD_KIND_COUNT;
    }
    return n_turn ? kind_of_slide(v) : HN_DYAD_PRP;
}

bool hn_dyad_recognise(const hn_system *sys, hn_dyad_step *step, double *x, unsigned *seed) {
    const hn_system_exprs exprs = hn_system_get_exprs(sys);
    reader r = {.sys = sys, .g = hn_system_graph(sys), .step = step};
    hn_dyad *d = &step->dyad;
    int n_turn = 0;
    memset(&step->form, 0, sizeof step->form);

    // how many unknowns turn
    for (int i = 0; i < d->n; i++) {
        r.symbol[i] = exprs.q_symbols[hn_system_position_of(sys, d->unknown[i])];
    }
    for (int i = 0; i < d->n; i++) {
        n_turn += !slides(&r, i);
    }

    // the one that turns comes first
    if (n_turn == 1 && d->n == 2 && slides(&r, 0)) { // what turns comes first
        const int unknown = d->unknown[0], symbol = r.symbol[0];
        d->unknown[0] = d->unknown[1];
        d->unknown[1] = unknown;
        r.symbol[0] = r.symbol[1];
        r.symbol[1] = symbol;
    }

    // coefficients, then the kind, the same at every random pose
    for (int i = 0; i < d->n; i++) {
        read_row(&r, i, n_turn);
    }

    for (int trial = 0; trial < TRIALS; trial++) {
        values v;
        evaluate(&r, x, seed, &v);
        const hn_dyad_kind kind = kind_of(&v, d->n, n_turn);
        if (kind == HN_DYAD_KIND_COUNT || (trial > 0 && kind != d->kind)) {
            return false;
        }
        d->kind = kind;
    }
    return true;
}

// ---- solving ----

// Nodes are numbered as they are made, and sums are sorted by number: two nodes are never made in
// the arguments of one call, whose order each compiler chooses. The last is made first.

/// a b + c d
static hn_ex product_sum(hn_graph *g, hn_ex a, hn_ex b, hn_ex c, hn_ex d) {
    const hn_ex second = hn_mul(g, c, d);
    return hn_add(g, hn_mul(g, a, b), second);
}

/// a b - c d
static hn_ex product_difference(hn_graph *g, hn_ex a, hn_ex b, hn_ex c, hn_ex d) {
    const hn_ex second = hn_mul(g, c, d);
    return hn_sub(g, hn_mul(g, a, b), second);
}

/// a cos x + b sin x
static hn_ex turned(hn_graph *g, hn_ex a, hn_ex b, hn_ex x) {
    const hn_ex second = hn_mul(g, b, hn_sin(g, x));
    return hn_add(g, hn_mul(g, a, hn_cos(g, x)), second);
}

static hn_ex times(hn_graph *g, const hn_pair *a, const hn_pair *b) {
    return product_sum(g, a->e[0], b->e[0], a->e[1], b->e[1]);
}

static hn_ex cross(hn_graph *g, const hn_pair *a, const hn_pair *b) {
    return product_difference(g, a->e[0], b->e[1], a->e[1], b->e[0]);
}

static hn_ex atan2_of(hn_graph *g, hn_ex sine, hn_ex cosine) {
    const hn_ex arguments[2] = {sine, cosine};
    return hn_apply(g, HN_OP_ATAN2, arguments);
}

static hn_ex symbol_of(const hn_system *sys, int coordinate) {
    return hn_graph_symbol_expr(
        hn_system_graph(sys),
        hn_system_get_exprs(sys).q_symbols[hn_system_position_of(sys, coordinate)]);
}

/// A symbol of step k. No name of a scene can be the same: those are ASCII.
static hn_ex step_symbol(hn_graph *g, const char *letter, const char *latex, int k) {
    char name[32], tex[32];
    snprintf(name, sizeof name, "%s%d", letter, k + 1);
    snprintf(tex, sizeof tex, "%s_{%d}", latex, k + 1);
    return hn_symbol(g, name, tex);
}

static hn_ex name_part(hn_dyad_step *s, hn_ex name, hn_ex is) {
    s->part[s->n_parts] = name;
    s->part_is[s->n_parts++] = is;
    return name;
}

/// p cos x + q sin x = k as a circle of radius 1 and a line. With s2 = p^2 + q^2, room = s2 - k^2
/// and w = sign sqrt(room):
///
///     s2 cos x = k p - w q,   s2 sin x = k q + w p,   and w = p sin x - q cos x tells the sign
typedef struct circle {
    hn_ex s2, cosine, sine; ///< the latter two s2 times too long
} circle;

static circle meet(hn_graph *g, hn_dyad_step *step, hn_ex p, hn_ex q, hn_ex k, hn_ex x) {
    circle c;
    c.s2 = product_sum(g, p, p, q, q);
    step->room = hn_sub(g, c.s2, hn_mul(g, k, k));
    const hn_ex w = hn_mul(g, step->sign, hn_sqrt(g, step->room));
    c.cosine = product_difference(g, k, p, w, q);
    c.sine = product_sum(g, k, q, w, p);
    const hn_ex along = hn_mul(g, q, hn_cos(g, x));
    step->branch = hn_sub(g, hn_mul(g, p, hn_sin(g, x)), along);
    step->x[0] = atan2_of(g, c.sine, c.cosine);
    step->is_angle[0] = 1;
    return c;
}

static void solve_turn(hn_graph *g, hn_dyad_step *s, hn_ex x) {
    (void)meet(g, s, s->form.A.e[0], s->form.B.e[0], hn_neg(s->form.E.e[0]), x);
}

/// xi cos x + eta sin x = kappa, and with the other link turned round what is left over.
static void show_rrr(hn_graph *g, hn_dyad_step *s, hn_ex p, hn_ex q, hn_ex k, hn_ex x, int number) {
    const hn_dyad_form *f = &s->form;
    const hn_ex xi = name_part(s, step_symbol(g, "ξ", "\\xi", number), p);
    const hn_ex eta = name_part(s, step_symbol(g, "η", "\\eta", number), q);
    const hn_ex kappa = name_part(s, step_symbol(g, "κ", "\\kappa", number), k);
    const hn_ex kappa2 = hn_mul(g, kappa, kappa);
    const hn_ex room = hn_sub(g, product_sum(g, xi, xi, eta, eta), kappa2);
    const hn_ex root = hn_mul(g, s->sign, hn_sqrt(g, room));
    const hn_ex rho = name_part(s, step_symbol(g, "ρ", "\\rho", number), root);
    const hn_ex cosine = product_difference(g, kappa, xi, rho, eta);
    s->shown[0] = atan2_of(g, product_sum(g, kappa, eta, rho, xi), cosine);

    hn_pair left;
    for (int i = 0; i < 2; i++) {
        const hn_ex first = turned(g, f->A.e[i], f->B.e[i], x);
        left.e[i] = hn_neg(hn_add(g, f->E.e[i], first));
    }
    const hn_ex along = times(g, &f->C, &left);
    s->shown[1] = atan2_of(g, times(g, &f->D, &left), along);
}

/// |E + A cos x + B sin x|^2 = |C|^2 is a line for (cos x, sin x); what is left over is the other
/// link turned round.
static void solve_rrr(hn_graph *g, hn_dyad_step *s, hn_ex x, int number) {
    const hn_dyad_form *f = &s->form;
    const hn_ex a2 = times(g, &f->A, &f->A);
    const hn_ex rest = hn_add(g, times(g, &f->E, &f->E), a2);
    const hn_ex k = hn_scale(0.5, hn_sub(g, times(g, &f->C, &f->C), rest));
    const hn_ex p = times(g, &f->E, &f->A), q = times(g, &f->E, &f->B);
    const circle c = meet(g, s, p, q, k, x);
    hn_pair left;
    for (int i = 0; i < 2; i++) {
        const hn_ex first = product_sum(g, f->A.e[i], c.cosine, f->B.e[i], c.sine);
        left.e[i] = hn_neg(hn_add(g, hn_mul(g, f->E.e[i], c.s2), first));
    }
    const hn_ex along = times(g, &f->C, &left);
    s->x[1] = atan2_of(g, times(g, &f->D, &left), along);
    s->is_angle[1] = 1;
    show_rrr(g, s, p, q, k, x, number);
}

/// Across the line the slide does not count, along it nothing else is unknown.
static void solve_rrp(hn_graph *g, hn_dyad_step *s, hn_ex x) {
    const hn_dyad_form *f = &s->form;
    const hn_ex k = hn_neg(cross(g, &f->W, &f->E));
    const hn_ex q = cross(g, &f->W, &f->B), p = cross(g, &f->W, &f->A);
    const circle c = meet(g, s, p, q, k, x);
    hn_ex along = hn_mul(g, times(g, &f->W, &f->E), c.s2);
    along = hn_add(g, along, hn_mul(g, times(g, &f->W, &f->A), c.cosine));
    along = hn_add(g, along, hn_mul(g, times(g, &f->W, &f->B), c.sine));
    const hn_ex w2 = times(g, &f->W, &f->W);
    s->x[1] = hn_neg(hn_div(g, along, hn_mul(g, w2, c.s2)));
    const hn_ex cosine = hn_cos(g, x), part = hn_mul(g, times(g, &f->W, &f->A), cosine);
    along = hn_add(g, times(g, &f->W, &f->E), part);
    const hn_ex sine = hn_sin(g, x);
    along = hn_add(g, along, hn_mul(g, times(g, &f->W, &f->B), sine));
    s->shown[1] = hn_neg(hn_div(g, along, w2));
}

/// The angle that turns A + y U on -E.
static hn_ex turned_by(hn_graph *g, const hn_dyad_form *f, hn_ex y) {
    hn_pair cosine, sine;
    for (int i = 0; i < 2; i++) {
        cosine.e[i] = hn_add(g, f->A.e[i], hn_mul(g, y, f->U.e[i]));
        sine.e[i] = hn_add(g, f->B.e[i], hn_mul(g, y, f->V.e[i]));
    }
    const hn_ex along = hn_neg(times(g, &cosine, &f->E));
    return atan2_of(g, hn_neg(times(g, &sine, &f->E)), along);
}

/// |A + y U| = |E| for the slide, then the angle from the pieces that it turns.
static void solve_rpr(hn_graph *g, hn_dyad_step *s, hn_ex y) {
    const hn_dyad_form *f = &s->form;
    const hn_ex u2 = times(g, &f->U, &f->U), au = times(g, &f->A, &f->U);
    const hn_ex e2 = times(g, &f->E, &f->E), far = hn_sub(g, times(g, &f->A, &f->A), e2);
    s->room = product_difference(g, au, au, u2, far);
    s->branch = hn_add(g, hn_mul(g, u2, y), au);
    s->x[1] = hn_div(g, hn_sub(g, hn_mul(g, s->sign, hn_sqrt(g, s->room)), au), u2);
    s->x[0] = turned_by(g, f, s->x[1]);
    s->shown[0] = turned_by(g, f, y);
    s->is_angle[0] = 1;
}

static void solve_prp(hn_graph *g, hn_dyad_step *s) {
    const hn_dyad_form *f = &s->form;
    const hn_ex det = cross(g, &f->A, &f->W);
    s->x[0] = hn_neg(hn_div(g, cross(g, &f->E, &f->W), det));
    s->x[1] = hn_neg(hn_div(g, cross(g, &f->A, &f->E), det));
}

void hn_dyad_solve_form(const hn_system *sys, hn_dyad_step *s, int k) {
    hn_graph *g = hn_system_graph(sys);
    const hn_ex x = symbol_of(sys, s->dyad.unknown[0]);

    // what a kind without a choice of branch leaves as it is
    s->sign = step_symbol(g, "σ", "\\sigma", k);
    s->shown[0] = s->shown[1] = hn_num(0);
    s->n_parts = 0;
    s->room = s->branch = hn_num(1);

    switch (s->dyad.kind) {
    case HN_DYAD_SINGLE:
        s->x[0] = hn_neg(hn_div(g, s->form.E.e[0], s->form.A.e[0]));
        break;
    case HN_DYAD_TURN:
        solve_turn(g, s, x);
        break;
    case HN_DYAD_RRR:
        solve_rrr(g, s, x, k);
        break;
    case HN_DYAD_RRP:
        solve_rrp(g, s, x);
        break;
    case HN_DYAD_RPR:
        solve_rpr(g, s, symbol_of(sys, s->dyad.unknown[1]));
        break;
    case HN_DYAD_PRP:
        solve_prp(g, s);
        break;
    case HN_DYAD_KIND_COUNT:
        break;
    }

    // what people read, where it is no shorter than what the tape computes
    for (int i = 0; i < s->dyad.n; i++) {
        s->shown[i] = hn_is_zero(s->shown[i]) ? s->x[i] : s->shown[i];
    }
}
