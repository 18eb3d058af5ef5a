// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_REDUCED_TERMS_H
#define HN_FORMULATIONS_REDUCED_TERMS_H
// The equations of motion left on the free motion, written out at one state:
//
//     v = Phi v_r + s,    M_r a_r + C_r v_r + d_r + g_r = tau_r,    a = Phi a_r + c           (1)
//     M_r = Phi' M Phi,   g_r = Phi' g,   tau_r = Phi' tau,   C_r = Phi' (M Phi_dot + C Phi)  (2)
//
// with v_r the rates of as many scene coordinates as there are freedoms, M, g, tau and C of the
// scene (dynamics/evaluate/force_parts.h says what is g and what is tau). s and d_r belong to
// closures that move with time and vanish without them.
//
// C_r is not unique as a matrix. The one given here is that of Christoffel's symbols, with which
// M_r' - 2 C_r is skew. It needs no derivative: C_r v_r is a quadratic form Q of v_r, known by
// evaluation (Phi_dot v_r from gamma), and
//
//     C_r y = 1/2 [Q(v_r + y) - Q(v_r) - Q(y) + Q(0)]                                         (3)
//
// is exact for it, as the symbols are symmetric in the two speeds. Independent speeds must be rates
// of coordinates for that, so none of a ball's may be among them. Source: Siciliano et al. 2009,
// section 7.2.

#include "dynamics/evaluate/force_parts.h"
#include "formulations/chart/chart.h"

#include <stdbool.h>

typedef enum hn_reduced_choice {
    HN_REDUCED_BY_MOTORS, ///< as many motors as freedoms, and they can serve
    HN_REDUCED_BY_CHART,  ///< the coordinates that the reduced method integrates here
    /// neither can serve as scene coordinates: those that carry the motion best
    HN_REDUCED_BY_PIVOTS
} hn_reduced_choice;
const char *hn_reduced_choice_text(hn_reduced_choice choice);

/// Plain data; read after a successful eval. Everything in scene coordinates (user rates),
/// row-major.
typedef struct hn_reduced_terms {
    hn_chart chart;
    hn_force_parts *parts;
    int nv, r;
    hn_reduced_choice choice;
    int *ind;        ///< r user coordinates, ascending
    double *Phi, *s; ///< nv x r, nv
    double *v_r, *a_r;
    double *M_r, *C_r; ///< r x r
    double *g_r, *tau_r;
    double *d_r;   ///< r: what closures that move with time add
    bool is_moved; ///< a closure moves with time, so that s and d_r need not be zero
    /// largest entry of v - (Phi v_r + s): 0 to rounding where the given speeds fit the loops
    double speed_gap;
    // in system coordinates
    double *basis, *offset;    ///< nv x r, nv
    double *rates, *unit;      ///< nv x r user rates of the chart's basis; nv scratch
    double *v, *x, *y, *force; ///< nv
    double *quadratic[4];      ///< r: Q at four speeds
    double *velocity_part;     ///< r: C_r v_r + d_r
    double *square;            ///< r x r
    int *pivot;
    hn_qr rows;
} hn_reduced_terms;

/// Compiles the terms of the reduced equations; end with hn_reduced_terms_destroy(). Fails:
/// HN_ERR_MEMORY, reported in diag.
HN_MUST_CHECK hn_status hn_reduced_terms_init(hn_reduced_terms *w, const hn_system *sys,
                                              hn_arena *arena, hn_diag *diag);
void hn_reduced_terms_destroy(hn_reduced_terms *w);
/// At (t, q, v), system coordinates; `freedoms` as they are known from elsewhere, -1: unknown.
/// Fails with HN_ERR_CHART or HN_ERR_UNSUPPORTED and hn_reduced_terms_why() where no such
/// coordinates exist, e.g. at a singular pose.
HN_MUST_CHECK hn_status hn_reduced_terms_eval(hn_reduced_terms *w, double t, const double *q,
                                              const double *v, int freedoms);
const char *hn_reduced_terms_why(const hn_reduced_terms *w);

#endif
