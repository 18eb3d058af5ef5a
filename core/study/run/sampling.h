// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_SAMPLING_H
#define HN_STUDY_SAMPLING_H
// The sampling half of a run: states at times between its steps, made by an engine of its own, so
// that a sample never touches charts, warm starts or kept slopes of the run itself.

#include "study/incidents/watch.h"

/// State at one time, in USER coordinates; arrays borrowed from the run, valid until its next call.
typedef struct hn_sample {
    double t;
    const double *q, *v; ///< n_user
    const double *a;     ///< n_user accelerations
    /// nc, recomputed from the saddle system at this state; a and lambda are NaN where it has no
    /// solution
    const double *lambda;
    /// nc: the multipliers that the scheme itself found at the end of its step, which converge with
    /// a lower order or not at all; NULL: none, or not asked for
    const double *raw_lambda;
    const double *points;              ///< 3 n_points
    double gap, velocity_gap;          ///< ||phi||, ||J v + phi_t||
    double kinetic, potential, energy; ///< [J]
    /// work of drives, dampers and loads since the start, and the change of energy since the start
    /// less that work [J]: the method's error. NaN where the work is not known, or steps are not
    /// checked.
    double work, energy_change;
    /// see hn_accel_info, times the square of the shortest row of J against the largest it has been
    double pivot_ratio;
    int rank;
} hn_sample;

typedef struct hn_sampling {
    hn_stepping *run;
    hn_watch *watch;
    bool raw_lambda; ///< samples carry the scheme's own multipliers too, where it has some
    hn_engine side;
    hn_eval *points_eval;
    hn_eval *rows_eval;
    hn_closure_rows rows;
    long long inside; ///< samples between steps that were checked
    // the state of the last sample, what the solve there said, and the scheme's own multipliers
    // there
    double t, *q, *v, *a;
    hn_accel_info info;
    hn_status status;
    double gap;
    const double *raw;
    // what a sample hands out, in user coordinates
    double *user_q, *user_v, *user_a, *lambda, *points, *raw_copy;
} hn_sampling;

/// A second engine of the same method, for samples inside a step. Fails: as hn_engine_create(),
/// HN_ERR_MEMORY, reported in diag.
HN_MUST_CHECK hn_status hn_sampling_create(hn_stepping *run, hn_watch *watch, bool raw_lambda,
                                           hn_sampling *s, hn_diag *diag);
/// Frees what is outside the arena.
void hn_sampling_free(hn_sampling *s);
/// The sample at time t: the present time, a time within the last step, or one less than a step
/// ahead (fixed steps, `failed` false). Fails with HN_ERR_INPUT for other times, or as a step of
/// the method does.
HN_MUST_CHECK hn_status hn_sampling_at(hn_sampling *s, double t, bool failed, hn_sample *out);

#endif
