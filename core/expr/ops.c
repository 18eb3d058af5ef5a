// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/ops.h"

#include "expr/construct.h"
#include "expr/graph.h"

#include <string.h>
#include <tgmath.h> // one expression gives a value in double and one in long double

// ---- values ----

#define VALUE_1(fn, expression)                          \
    static double fn(const double *x) {                  \
        return expression;                               \
    }                                                    \
    static long double fn##_long(const long double *x) { \
        return expression;                               \
    }

VALUE_1(value_recip, 1 / x[0])
VALUE_1(value_sqrt, sqrt(x[0]))
VALUE_1(value_sin, sin(x[0]))
VALUE_1(value_cos, cos(x[0]))
VALUE_1(value_tan, tan(x[0]))
VALUE_1(value_asin, asin(x[0]))
VALUE_1(value_acos, acos(x[0]))
VALUE_1(value_atan, atan(x[0]))
VALUE_1(value_sinh, sinh(x[0]))
VALUE_1(value_cosh, cosh(x[0]))
VALUE_1(value_tanh, tanh(x[0]))
VALUE_1(value_exp, exp(x[0]))
VALUE_1(value_log, log(x[0]))
VALUE_1(value_abs, fabs(x[0]))
VALUE_1(value_sign, isnan(x[0]) ? x[0] : (x[0] > 0) - (x[0] < 0))
VALUE_1(value_step, isnan(x[0]) ? x[0] : x[0] >= 0)
VALUE_1(value_mul, x[0] * x[1])
VALUE_1(value_atan2, atan2(x[0], x[1]))
VALUE_1(value_pow, pow(x[0], x[1]))
VALUE_1(value_min, isnan(x[0]) || x[0] <= x[1] ? x[0] : x[1])
VALUE_1(value_max, isnan(x[0]) || x[0] >= x[1] ? x[0] : x[1])

// ---- partial derivatives: d[i] = d f / d a[i], f = *self ----

#define PARTIALS(fn) static void fn(hn_graph *g, const hn_ex *self, const hn_ex *a, hn_ex *d)
#define UNUSED(x) ((void)(x))

static hn_ex square(hn_graph *g, hn_ex a) {
    return hn_mul(g, a, a);
}

static hn_ex recip_of(hn_graph *g, hn_ex a) {
    return hn_apply(g, HN_OP_RECIP, &a);
}

PARTIALS(partials_mul) {
    UNUSED(g), UNUSED(self);
    d[0] = a[1];
    d[1] = a[0];
}
PARTIALS(partials_recip) { // -(1/x)^2
    UNUSED(a);
    d[0] = hn_neg(square(g, *self));
}
PARTIALS(partials_sqrt) { // 1 / (2 sqrt x)
    UNUSED(a);
    d[0] = hn_scale(0.5, recip_of(g, *self));
}
PARTIALS(partials_sin) {
    UNUSED(self);
    d[0] = hn_cos(g, a[0]);
}
PARTIALS(partials_cos) {
    UNUSED(self);
    d[0] = hn_neg(hn_sin(g, a[0]));
}
PARTIALS(partials_tan) { // 1 + tan^2
    UNUSED(a);
    d[0] = hn_add(g, hn_num(1), square(g, *self));
}
PARTIALS(partials_asin) { // 1 / sqrt(1 - x^2)
    UNUSED(self);
    d[0] = recip_of(g, hn_sqrt(g, hn_sub(g, hn_num(1), square(g, a[0]))));
}
PARTIALS(partials_acos) {
    partials_asin(g, self, a, d);
    d[0] = hn_neg(d[0]);
}
PARTIALS(partials_atan) { // 1 / (1 + x^2)
    UNUSED(self);
    d[0] = recip_of(g, hn_add(g, hn_num(1), square(g, a[0])));
}
PARTIALS(partials_atan2) { // y' x / r2 - x' y / r2 for atan2(y, x)
    UNUSED(self);
    const hn_ex r2 = recip_of(g, hn_add(g, square(g, a[0]), square(g, a[1])));
    d[0] = hn_mul(g, a[1], r2);
    d[1] = hn_neg(hn_mul(g, a[0], r2));
}
PARTIALS(partials_sinh) {
    UNUSED(self);
    d[0] = hn_apply(g, HN_OP_COSH, a);
}
PARTIALS(partials_cosh) {
    UNUSED(self);
    d[0] = hn_apply(g, HN_OP_SINH, a);
}
PARTIALS(partials_tanh) { // 1 - tanh^2
    UNUSED(a);
    d[0] = hn_sub(g, hn_num(1), square(g, *self));
}
PARTIALS(partials_exp) {
    UNUSED(g), UNUSED(a);
    d[0] = *self;
}
PARTIALS(partials_log) {
    UNUSED(self);
    d[0] = recip_of(g, a[0]);
}
PARTIALS(partials_pow) { // y x^(y-1); x^y log x, asked for only where the exponent varies
    d[0] = hn_mul(g, a[1], hn_apply(g, HN_OP_POW, (hn_ex[2]){a[0], hn_sub(g, a[1], hn_num(1))}));
    d[1] = hn_is_number(a[1], NULL) ? hn_num(0) : hn_mul(g, *self, hn_apply(g, HN_OP_LOG, a));
}
PARTIALS(partials_abs) {
    UNUSED(self);
    d[0] = hn_apply(g, HN_OP_SIGN, a);
}
PARTIALS(partials_flat) {
    UNUSED(g), UNUSED(self), UNUSED(a);
    d[0] = hn_num(0);
}
PARTIALS(partials_min) { // the first where b - a >= 0
    UNUSED(self);
    const hn_ex gap = hn_sub(g, a[1], a[0]);
    d[0] = hn_apply(g, HN_OP_STEP, &gap);
    d[1] = hn_sub(g, hn_num(1), d[0]);
}
PARTIALS(partials_max) { // the first where a - b >= 0
    UNUSED(self);
    const hn_ex gap = hn_sub(g, a[0], a[1]);
    d[0] = hn_apply(g, HN_OP_STEP, &gap);
    d[1] = hn_sub(g, hn_num(1), d[0]);
}

// ---- the table ----

#define value_none NULL
#define value_none_long NULL
#define partials_none NULL
#define partials_sign partials_flat
#define partials_step partials_flat

static const hn_op_info infos[HN_OP_COUNT] = {
#define INFO(code, name, arity, typed, parity, fn, latex, c_form)                             \
    [code] = {name,          arity, typed, HN_PARITY_##parity, value_##fn, value_##fn##_long, \
              partials_##fn, latex, c_form},
    HN_OP_LIST(INFO)
#undef INFO
};

const hn_op_info *hn_op_get_info(hn_op op) {
    HN_ASSERT(op >= 0 && op < HN_OP_COUNT);
    return &infos[op];
}

hn_op hn_op_find(const char *name) {
    for (int op = 0; op < HN_OP_COUNT; op++) {
        if (infos[op].typed && strcmp(infos[op].name, name) == 0) {
            return (hn_op)op;
        }
    }
    return HN_OP_COUNT;
}
