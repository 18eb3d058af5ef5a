// SPDX-License-Identifier: GPL-3.0-or-later
// One vector form of sine and cosine, written once for all instruction sets: lanes_sincos.c defines
// the macros below before each inclusion, and there is no include guard. Without them it is the
// form for one pair of doubles.
//
//   FORM(part)       the name of a part of this form; FORM(run) is the whole, an hn_lanes_sincos
//   FORM_TARGET      attribute that switches the instruction set on
//   FORM_WIDTH       doubles in a vector
//   FORM_FMA(a,b,c)  a b + c, rounded once
//   FORM_ROWS(i,row) row[0 .. 3]: the columns of sine_table in the rows that the vector *i names
//   FORM_ANY(mask)   whether any entry of the mask is set
//   FORM_CHOOSE(mask,x,y)  x where all bits of the mask are set, y where none is
//
// Constants and order of operations are those of the GNU C Library where the processor has fused
// multiply-add: IBM's Accurate Mathematical Library, after Gal & Bachelis 1991.

#ifndef FORM
#include <math.h>
extern void sincos(double, double *, double *);
#define FORM(part) pair_##part
#define FORM_TARGET __attribute__((unused))
#define FORM_WIDTH 2
#define FORM_FMA(a, b, c) ((V){fma((a)[0], (b)[0], (c)[0]), fma((a)[1], (b)[1], (c)[1])})
#define FORM_ROWS(i, row) ((void)(i), (row)[2] = 1 + ((row)[0] = (row)[1] = (row)[3] = (V){0}))
#define FORM_ANY(mask) ((mask)[0] | (mask)[1])
#define FORM_CHOOSE(mask, x, y) ((V)(((I)(x) & (mask)) | ((I)(y) & ~(mask))))
#endif

typedef double FORM(v) __attribute__((vector_size(8 * FORM_WIDTH)));
typedef unsigned long long FORM(i) __attribute__((vector_size(8 * FORM_WIDTH)));
#define V FORM(v)
#define I FORM(i)
#define ALL(constant) ((V){0} + (constant))
#define SIGN ((I){0} + (1ull << 63))
#define LESS_PRODUCT(z, x, y) FORM_FMA(-(x), y, z) // z - x y

/// An angle brought to |a + da| < pi/4: its sine is that of a + da, or where `swapped` is set the
/// cosine; the cosine of a + da takes the sign.
typedef struct FORM(angle) {
    V a, da;
    I swapped, sign;
} FORM(angle);

/// From 2.43 on: x = a + da + n pi/2, with pi/2 in four parts.
FORM_TARGET static inline FORM(angle) FORM(reduce)(V x) {
    const V third = ALL(-0x1.cb3b398p-55), fourth = ALL(-0x1.d747f23e32ed7p-83);
    const V t = FORM_FMA(x, ALL(0x1.45f306dc9c883p-1), ALL(0x1.8p52)), turns = t - 0x1.8p52;
    const V first = LESS_PRODUCT(x, turns, ALL(0x1.921fb58p0));
    const V part = LESS_PRODUCT(first, turns, ALL(-0x1.dde973cp-27));
    const V left = LESS_PRODUCT(part, turns, third), a = LESS_PRODUCT(left, turns, fourth);
    const V da = LESS_PRODUCT(part - left, turns, third) + LESS_PRODUCT(left - a, turns, fourth);

    // n mod 4: in the second and third quarter the angle is turned about
    const I quarter = (I)t, turned = ((quarter ^ (quarter >> 1)) & 1) << 63;
    return (FORM(angle)){.a = (V)((I)a ^ turned),
                         .da = (V)((I)da ^ turned),
                         .swapped = -(quarter & 1),
                         .sign = (quarter << 62) & SIGN};
}

/// Those that have to be reduced, and all that is not a number.
FORM_TARGET static inline I FORM(far)(V x) {
    return ~(I)((V)((I)x & ~SIGN) < ALL(0x1.368fdp1));
}

/// Below 0.855 the angle is as it is, up to 2.43 the complement serves.
FORM_TARGET static inline FORM(angle) FORM(bring_near)(V x) {
    const V size = (V)((I)x & ~SIGN), above = 0x1.921fb54442d18p0 - size,
            complement = above + 0x1.1a62633145c07p-54,
            rest = (above - complement) + 0x1.1a62633145c07p-54;
    const I beyond = ~(I)(size < ALL(0x1.b6p-1));
    return (FORM(angle)){.a = FORM_CHOOSE(beyond, complement, x),
                         .da = (V)((I)rest & beyond),
                         .swapped = beyond,
                         .sign = (I)x & SIGN & beyond};
}

/// Angles of every size; those that four parts of pi/2 do not reduce give anything.
FORM_TARGET static inline FORM(angle) FORM(bring_all)(V x) {
    const FORM(angle) far = FORM(reduce)(x), near = FORM(bring_near)(x);
    const I is_far = FORM(far)(x);
    return (FORM(angle)){.a = FORM_CHOOSE(is_far, far.a, near.a),
                         .da = FORM_CHOOSE(is_far, far.da, near.da),
                         .swapped = (I)FORM_CHOOSE(is_far, far.swapped, near.swapped),
                         .sign = (I)FORM_CHOOSE(is_far, far.sign, near.sign)};
}

/// The sine of a small angle by its series.
FORM_TARGET static inline V FORM(series)(V a, V da) {
    const V aa = a * a;
    V sum = FORM_FMA(ALL(-0x1.addffc2fcdf59p-26), aa, ALL(0x1.71de27b9a7ed9p-19));
    sum = FORM_FMA(sum, aa, ALL(-0x1.a01a019db08b8p-13));
    sum = FORM_FMA(sum, aa, ALL(0x1.1111111110ecep-7));
    sum = FORM_FMA(sum, aa, ALL(-0x1.5555555555555p-3));
    return a + FORM_FMA(aa, FORM_FMA(sum, a, -(0.5 * da)), da);
}

/// (sin u - u) / u^3 and (1 - cos u) / u^2 where |u| < 1/256, by uu = u^2.
FORM_TARGET static inline V FORM(sine_part)(V uu) {
    return FORM_FMA(uu, ALL(0x1.11110e829872fp-7), ALL(-0x1.5555555555515p-3));
}
FORM_TARGET static inline V FORM(cosine_part)(V uu) {
    const V tail = FORM_FMA(uu, ALL(0x1.6c16bedd9e239p-10), ALL(-0x1.5555555555535p-5));
    return FORM_FMA(tail, uu, ALL(0.5));
}

/// Sine and cosine of a + da from those of the nearest k / 128 and a rest u + d.
FORM_TARGET static inline void FORM(near)(V a, V da, V *sine, V *cosine) {
    const V size = (V)((I)a & ~SIGN), shifted = size + 0x1.8p45;
    const I index = (I)shifted & 127;
    V row[4];
    FORM_ROWS(&index, row);
    const V sn = row[0], sn_low = row[1], cs = row[2], cs_low = row[3];

    // the sine
    const V d = (V)((I)da ^ ((I)a & SIGN)), u = size - (shifted - 0x1.8p45), uu = u * u;
    const V s = u + FORM_FMA(uu * u, FORM(sine_part)(uu), d);
    const V c = FORM_FMA(u, d, uu * FORM(cosine_part)(uu));
    const V by_rows = sn + FORM_FMA(cs, s, LESS_PRODUCT(FORM_FMA(s, cs_low, sn_low), c, sn));
    *sine = (V)(((I)by_rows & ~SIGN) | ((I)a & SIGN));
    *sine = FORM_CHOOSE((I)(size < ALL(0.126)), FORM(series)(a, da), *sine);
    *sine = FORM_CHOOSE((I)(size == 0), a, *sine); // -0 stays so

    // the cosine
    const V w = u + d, ww = w * w, sw = FORM_FMA(ww * w, FORM(sine_part)(ww), w);
    const V cw = ww * FORM(cosine_part)(ww);
    *cosine = cs + LESS_PRODUCT(LESS_PRODUCT(LESS_PRODUCT(cs_low, sw, sn_low), cs, cw), sw, sn);
}

/// Both of a near angle.
FORM_TARGET static inline void FORM(both)(FORM(angle) near, V *sine, V *cosine) {
    V s, c;
    FORM(near)(near.a, near.da, &s, &c);
    c = (V)((I)c ^ near.sign);
    *sine = FORM_CHOOSE(near.swapped, c, s);
    *cosine = FORM_CHOOSE(near.swapped, s, c);
}

/// Both of any angle.
FORM_TARGET static inline void FORM(any)(V x, V *sine, V *cosine) {
    FORM(both)(FORM(bring_all)(x), sine, cosine);
    const I left_out = ~(I)((V)((I)x & ~SIGN) < ALL(0x1.921fbp26));
    if (FORM_ANY(left_out)) {
        for (int k = 0; k < FORM_WIDTH; k++) {
            if (left_out[k]) {
                double s, c;
                sincos(x[k], &s, &c);
                (*sine)[k] = s;
                (*cosine)[k] = c;
            }
        }
    }
}

FORM_TARGET static void FORM(run)(int n, const double *angle, double *sine, double *cosine) {
    const V *const x = (const V *)(const void *)angle;
    V *const s = (V *)(void *)sine, *const c = (V *)(void *)cosine;
    I far = {0};
    for (int k = 0; k < n / FORM_WIDTH; k++) {
        far |= FORM(far)(x[k]);
    }

    // most blocks hold no angle that has to be reduced: one question for all of a block
    if (FORM_ANY(far)) {
        for (int k = 0; k < n / FORM_WIDTH; k++) {
            FORM(any)(x[k], &s[k], &c[k]);
        }
        return;
    }
    for (int k = 0; k < n / FORM_WIDTH; k++) {
        FORM(both)(FORM(bring_near)(x[k]), &s[k], &c[k]);
    }
}

#undef V
#undef I
#undef ALL
#undef SIGN
#undef LESS_PRODUCT
#undef FORM
#undef FORM_TARGET
#undef FORM_WIDTH
#undef FORM_FMA
#undef FORM_ROWS
#undef FORM_ANY
#undef FORM_CHOOSE
