// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_WORK_H
#define HN_STUDY_WORK_H
// The work that drives, dampers and loads have done since the start of a run, so that a change of
// energy less that work is the error of the method and nothing else.
//
// The power (dynamics/evaluate/power.h) is integrated over each step by Gauss-Legendre quadrature,
// at states of a Hermite polynomial through q, q', q'' at the ends of the step and of the one
// before it: order 6 to 9 with POINTS = 4, so that methods up to order 8 are measured and not the
// quadrature. A corner of a load on the way divides the interval. It reads the stepping half and
// never changes it. In a scene where nothing does work it is off and costs nothing.

#include "dynamics/evaluate/power.h"
#include "study/stepping/stepping.h"

enum { HN_WORK_NODES = 3 };

/// A state of the motion: q and its two time derivatives, nq each.
typedef struct hn_work_node {
    double t;
    double *q, *rate, *rate2;
    bool has_rate2; ///< the accelerations are known
} hn_work_node;

typedef struct hn_work_record {
    const hn_stepping *run;
    bool on;      ///< something in the scene does work
    double done;  ///< up to the last step [J]; NaN from where the power is not known
    double until; ///< of it, up to the start of the last step
    hn_power *power;
    int n;                            ///< nodes in use, the latest last
    hn_work_node node[HN_WORK_NODES]; ///< ends of the latest steps
    bool at_corner;                   ///< the latest ends at a corner of a load
    hn_work_node sample;              ///< of hn_work_at()
    // scratch
    double *q, *slope, *column_rate; ///< nq
    double *v, *a, *column;          ///< nv
    double *lambda;                  ///< nc
} hn_work_record;

/// Memory from the arena of `run`, which is borrowed. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_work_create(const hn_stepping *run, bool on, hn_work_record *w);
void hn_work_free(hn_work_record *w);
/// Forgets the past; the state of the run is the start.
void hn_work_start(hn_work_record *w);
/// Adds the work of the step that the run has just made.
void hn_work_step(hn_work_record *w);
/// The work up to a state within the last step or less than a step ahead of it [J].
double hn_work_at(hn_work_record *w, const hn_state_at *at);

#endif
