// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

static const hn_figure_topic topics[] = {
    {"Reference four-bar", "two computations without common code", HN_FIGURE_QUICK,
     hn_figures_reference},
    {"Andrews' squeezer", "Hairer & Wanner 1996; Mazzia & Magherini 2008", HN_FIGURE_QUICK,
     hn_figures_squeezer},
    {"Drift without stabilisation", "Hairer & Wanner 1996", HN_FIGURE_TABLE, hn_figures_drift},
    {"Drift and decay from an open start", "Baumgarte 1972", HN_FIGURE_QUICK,
     hn_figures_open_start},
    {"Limits of the step", "Hairer & Wanner 1996", HN_FIGURE_QUICK, hn_figures_limits},
    {"Baumgarte's alpha", "Baumgarte 1972; Ascher, Chin, Petzold & Reich 1995", HN_FIGURE_TABLE,
     hn_figures_alpha},
    {"Projection", "Eich 1993; Ascher, Chin & Reich 1994", HN_FIGURE_QUICK, hn_figures_projection},
    {"Symmetric projection", "Hairer 2000", HN_FIGURE_QUICK, hn_figures_symmetric},
    {"Null-space forms", "Kim & Vanderploeg 1986; Liang & Lance 1987", HN_FIGURE_QUICK,
     hn_figures_nullspace},
    {"Independent coordinates", "Wehage & Haug 1982", HN_FIGURE_QUICK, hn_figures_charts},
    {"Penalty and augmented Lagrangian", "Bayo, Garcia de Jalon & Serna 1988; Bayo & Avello 1994",
     HN_FIGURE_QUICK, hn_figures_penalty},
    {"Index-3 augmented Lagrangian", "Cuadrado, Cardenal & Bayo 1997; Cardona & Geradin 1989",
     HN_FIGURE_QUICK, hn_figures_turns},
    {"Orders of implicit methods", "Hairer, Lubich & Roche 1989; Jay 1993", HN_FIGURE_QUICK,
     hn_figures_implicit_orders},
    {"Multipliers recomputed", "Hairer, Lubich & Roche 1989", HN_FIGURE_QUICK,
     hn_figures_recomputed},
    {"Condition of Newton's matrix", "Bottasso, Dopico & Trainelli 2008", HN_FIGURE_QUICK,
     hn_figures_newton_matrix},
    {"Structural integrators", "Arnold & Bruls 2007; Negrut et al. 2007; Leimkuhler & Skeel 1994",
     HN_FIGURE_QUICK, hn_figures_structural},
    {"Half-explicit Runge-Kutta", "Brasey & Hairer 1993", HN_FIGURE_QUICK,
     hn_figures_half_explicit},
    {"SUNDIALS IDA", "Hindmarsh et al. 2005; Brenan, Campbell & Petzold 1996", HN_FIGURE_TABLE,
     hn_figures_ida},
    {"Ways to solve the saddle-point system", "Benzi, Golub & Liesen 2005; Skeel 1980",
     HN_FIGURE_QUICK, hn_figures_solvers},
    {"Dependent rows and sparse elimination",
     "Udwadia & Kalaba 1992; Carpentier, Budhiraja & Mansard 2021", HN_FIGURE_QUICK,
     hn_figures_rank},
    {"Singular poses", "Fichter 1986; Ma & Angeles 1991; Gonzalez et al. 2006", HN_FIGURE_QUICK,
     hn_figures_singular},
    {"A platform on six rods", "Fichter 1986; Ma & Angeles 1991", HN_FIGURE_QUICK, hn_figures_rods},
    {"The ladder of two four-bars", "Bayo & Avello 1994; Gonzalez et al. 2006", HN_FIGURE_SLOW,
     hn_figures_ladder},
    {"Change points", "Bayo & Avello 1994; Udwadia & Phohomsiri 2006", HN_FIGURE_SLOW,
     hn_figures_change_points},
    {"Sizes, speeds, and speeds that do not fit", "Cardona & Geradin 1989", HN_FIGURE_QUICK,
     hn_figures_extremes},
    {"What lessons get wrong", "Hairer, Norsett & Wanner 1993 for the step control", HN_FIGURE_SLOW,
     hn_figures_lesson},
    {"A million steps", "the figures of ten million, by their laws", HN_FIGURE_SLOW,
     hn_figures_million_steps},
    {"Ten million steps", "Leimkuhler & Skeel 1994; Hairer, Lubich & Wanner 2006", HN_FIGURE_TABLE,
     hn_figures_long_runs},
};

int hn_figure_topic_count(void) {
    return (int)(sizeof topics / sizeof *topics);
}

const hn_figure_topic *hn_figure_topic_at(int i) {
    return &topics[i];
}
