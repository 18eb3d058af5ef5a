// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_FIGURES_H
#define HN_SUPPORT_FIGURES_H
// Figures that programs written by hand for one mechanism at a time printed for these methods, each
// measured again. A figure is kept as text, as it was printed: its digits say how exactly it is
// known. What is found must agree with it to the last printed digit; where it cannot, the row
// carries a wider bound, or what is found instead, and the reason.
//
// `make figures` prints all of them (tests/tables/figures.c); unit tests measure those that take
// little time.

#include "support/motion.h"

typedef enum hn_figure_cost {
    HN_FIGURE_QUICK, ///< in the quick unit tests: well under a second
    HN_FIGURE_SLOW,  ///< in the slow unit tests: seconds
    HN_FIGURE_TABLE  ///< in the table alone: minutes, or tested elsewhere already
} hn_figure_cost;

/// Describes what was printed, and what may differ.
typedef struct hn_figure {
    const char *what, *how; ///< the quantity; scene, method and time
    /// a number, "<1e-14" or ">1" (a bound), or words that have to be the same
    const char *printed;
    const char *note; ///< why it may differ, or NULL
    /// of the last printed digit that it may be off; 0: one, or half where only one digit was
    /// printed
    double units;
    double factor; ///< or this factor either way; 0: none
    /// what is found where the printed figure is not right: has to be met likewise
    const char *instead;
} hn_figure;

typedef struct hn_figures hn_figures;

/// Figures of one kind.
typedef struct hn_figure_topic {
    const char *name;   ///< "Baumgarte: step and alpha"
    const char *source; ///< literature of the method
    hn_figure_cost cost;
    void (*measure)(hn_figures *f);
} hn_figure_topic;

int hn_figure_topic_count(void);
const hn_figure_topic *hn_figure_topic_at(int i);

// ---- for those who measure ----
/// A figure and what was found for it; NaN: nothing, the measurement failed.
void hn_figure_add(hn_figures *f, const hn_figure *figure, double found);
/// The same for a figure that needs no more than its number; and for one in words, which have to be
/// the same.
void hn_figure_put(hn_figures *f, const char *what, const char *how, const char *printed,
                   double found);
void hn_figure_put_words(hn_figures *f, const char *what, const char *how, const char *printed,
                         const char *found);

/// Describes what a run is asked for.
typedef enum hn_figure_quantity {
    HN_FIGURE_ERROR,        ///< largest error of a coordinate at the end
    HN_FIGURE_ROW,          ///< largest |phi_i| at any step
    HN_FIGURE_ROW_END,      ///< largest |phi_i| at the end
    HN_FIGURE_SPEED_END,    ///< largest |(J v)_i| at the end
    HN_FIGURE_ENERGY_END,   ///< change of the energy at the end, with its sign
    HN_FIGURE_ENERGY_WORST, ///< largest size of the change on the way
    HN_FIGURE_STOP,         ///< time at which the run ended early; NaN when it did not
    HN_FIGURE_NEWTON        ///< Newton iterations a step
} hn_figure_quantity;

/// A run on a scene (tests or lessons; NULL: the model given) and what it is asked for.
typedef struct hn_figure_run {
    const char *method;
    double t;
    hn_figure_quantity quantity;
    hn_figure figure; ///< `how` is made of method and time
} hn_figure_run;

/// Measures one after the other on the model; exact motions for errors are computed once a time.
void hn_figure_runs(hn_figures *f, const hn_model *m, const char *scene, const hn_figure_run *runs,
                    int n);
/// The quantity alone.
double hn_figure_measure(const hn_model *m, const char *method, double t,
                         hn_figure_quantity quantity);
/// Order fitted over n halvings of h; the method has "%h" where the step stands; errors at t.
double hn_figure_order(const hn_model *m, const char *method, double h, int n, double t);

// ---- for those who show ----
typedef struct hn_figure_result {
    char what[160], how[200], printed[64], found[64];
    char verdict[400];
    int good;
} hn_figure_result;

/// Measures a topic and hands over each result as it comes.
void hn_figure_topic_run(const hn_figure_topic *topic,
                         void (*show)(void *user, const hn_figure_result *result), void *user);
/// Every topic of this cost as a unit test; returns how many failed.
int hn_figures_test(hn_figure_cost cost);

#endif
