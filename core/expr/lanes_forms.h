// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_LANES_FORMS_H
#define HN_EXPR_LANES_FORMS_H
// Work on blocks of lanes, written once and compiled for each instruction set.
//
// A body is an HN_LANES_BODY function on hn_lane_vector; without an instruction set for a whole
// vector the compiler splits it. HN_LANES_FORMS(name, (parameters), (arguments)) then defines
// name_forms[set], which call name_body. No set has fused operations in these, so that all forms
// round alike.

#include "expr/lanes.h"

typedef double hn_lane_vector __attribute__((vector_size(64)));
enum { HN_LANE_WIDTH = 8 };
/// Half of one, for sums over many slots: compilers keep a split vector in memory. And its bits.
typedef double hn_lane_half __attribute__((vector_size(32)));
typedef long long hn_lane_half_bits __attribute__((vector_size(32)));

/// Lanes whose entry of `below` is negative and whose entry of `zero` is 0; both are what sums over
/// the slots leave, and a number that is not finite leaves NaN in `zero`.
hn_lane_bits hn_lanes_bits(const hn_lane_half_bits *below, const hn_lane_half *zero);

#define HN_LANES_BODY static inline __attribute__((always_inline)) void

#ifdef __x86_64__
#define HN_LANES_TARGET(set) __attribute__((target(set)))
#else
#define HN_LANES_TARGET(set)
#endif

#define HN_LANES_FORMS(name, parameters, arguments)                                     \
    static void name##_plain parameters {                                               \
        name##_body arguments;                                                          \
    }                                                                                   \
    HN_LANES_TARGET("avx2") static void name##_avx2 parameters {                        \
        name##_body arguments;                                                          \
    }                                                                                   \
    HN_LANES_TARGET("avx512f,avx512dq,avx512vl") static void name##_avx512 parameters { \
        name##_body arguments;                                                          \
    }                                                                                   \
    static void(*const name##_forms[HN_LANES_SETS])                                     \
        parameters = {name##_plain, name##_avx2, name##_avx512};
#endif
