// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/explicit/tableau.h"

static const double euler_c[1] = {0}, euler_A[1] = {0}, euler_b[1] = {1};
const hn_tableau hn_tableau_euler = {
    .stages = 1,
    .order = 1,
    .c = euler_c,
    .A = euler_A,
    .b = euler_b,
};

static const double heun_c[2] = {0, 1};
static const double heun_A[4] = {0, 0, /**/ 1, 0};
static const double heun_b[2] = {0.5, 0.5};
const hn_tableau hn_tableau_heun = {
    .stages = 2,
    .order = 2,
    .c = heun_c,
    .A = heun_A,
    .b = heun_b,
};

static const double rk4_c[4] = {0, 0.5, 0.5, 1};
// clang-format off
static const double rk4_A[16] = {
    0,   0,   0, 0,
    0.5, 0,   0, 0,
    0,   0.5, 0, 0,
    0,   0,   1, 0,
};
// clang-format on
static const double rk4_b[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
const hn_tableau hn_tableau_rk4 = {
    .stages = 4,
    .order = 4,
    .c = rk4_c,
    .A = rk4_A,
    .b = rk4_b,
};

// Hairer, Norsett & Wanner 1993, table II.5.2; d from equation (6.13) of section II.6
// clang-format off
static const double dopri5_c[7] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
static const double dopri5_A[49] = {
    0,              0,               0,              0,            0,               0,         0,
    1.0 / 5,        0,               0,              0,            0,               0,         0,
    3.0 / 40,       9.0 / 40,        0,              0,            0,               0,         0,
    44.0 / 45,      -56.0 / 15,      32.0 / 9,       0,            0,               0,         0,
    19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729, 0,               0,         0,
    9017.0 / 3168,  -355.0 / 33,     46732.0 / 5247, 49.0 / 176,   -5103.0 / 18656, 0,         0,
    35.0 / 384,     0,               500.0 / 1113,   125.0 / 192,  -2187.0 / 6784,  11.0 / 84, 0,
};
static const double dopri5_b[7] = {
    35.0 / 384,     0,               500.0 / 1113,   125.0 / 192,  -2187.0 / 6784,  11.0 / 84, 0,
};
static const double dopri5_e[7] = {
    71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40,
};
static const double dopri5_d[7] = {
    -12715105075.0 / 11282082432.0,
    0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
};
// clang-format on
const hn_tableau hn_tableau_dopri5 = {
    .stages = 7,
    .order = 5,
    .embedded_order = 4,
    .fsal = 1,
    .c = dopri5_c,
    .A = dopri5_A,
    .b = dopri5_b,
    .e = dopri5_e,
    .d = dopri5_d,
    .dense_rows = 1,
    .stiff_stage = 5,
};
