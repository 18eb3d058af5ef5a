// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_FIGURES_SETS_H
#define HN_SUPPORT_FIGURES_SETS_H
// The measurements of each topic, for the list in figures_topics.c, and scenes that several of them
// share.

#include "support/figures.h"

void hn_figures_reference(hn_figures *f);
void hn_figures_squeezer(hn_figures *f);
void hn_figures_drift(hn_figures *f);
void hn_figures_open_start(hn_figures *f);
void hn_figures_limits(hn_figures *f);
void hn_figures_alpha(hn_figures *f);
void hn_figures_projection(hn_figures *f);
void hn_figures_symmetric(hn_figures *f);
void hn_figures_nullspace(hn_figures *f);
void hn_figures_charts(hn_figures *f);
void hn_figures_penalty(hn_figures *f);
void hn_figures_turns(hn_figures *f);
void hn_figures_implicit_orders(hn_figures *f);
void hn_figures_recomputed(hn_figures *f);
void hn_figures_newton_matrix(hn_figures *f);
void hn_figures_ida(hn_figures *f);
void hn_figures_structural(hn_figures *f);
void hn_figures_half_explicit(hn_figures *f);
void hn_figures_solvers(hn_figures *f);
void hn_figures_rank(hn_figures *f);
void hn_figures_singular(hn_figures *f);
void hn_figures_rods(hn_figures *f);
void hn_figures_ladder(hn_figures *f);
void hn_figures_change_points(hn_figures *f);
void hn_figures_extremes(hn_figures *f);
void hn_figures_million_steps(hn_figures *f);
void hn_figures_long_runs(hn_figures *f);
void hn_figures_lesson(hn_figures *f);

/// A bob of 1 kg on a rod of 1 m, level at the start, in Cartesian coordinates; the constraint is
/// (x^2 + y^2 - 1) / 2.
extern const char hn_figure_bob[];

/// A four-bar of uniform bars in absolute angles; th2 and th3 are guesses.
typedef struct hn_figure_links {
    double l1, l2, l3, d; ///< crank, coupler, rocker, ground [m]
    double m1, m2, m3, g; ///< [kg], [m/s^2]
    double th1, w1;       ///< start of the crank [rad], [rad/s]
    double th2, th3;      ///< guesses [rad]
    int coupler_drives;   ///< 1: the coupler's angle is the actuated one
    int pinned;           ///< 1: th2 and th3 are no guesses, and w2, w3 belong to the start
    double w2, w3;        ///< [rad/s]
} hn_figure_links;
hn_figure_links hn_figure_fb0(void);
/// The assembly may fail: see m->status.
void hn_figure_open_links(hn_model *m, const hn_figure_links *links);
/// Ten points of 1 kg on massless rods of 1 m, a bow to the right, the last point of `tip` kg, at
/// rest.
void hn_figure_open_chain(hn_model *m, double tip);

#endif
