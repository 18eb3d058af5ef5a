// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_MOTION_H
#define HN_SUPPORT_MOTION_H
// A method run on a model, for tests of whole runs. Failures stop the test with the method and its
// reason.

#include "study/run/run.h"
#include "support/model.h"

/// A run of `method` ("projection@rk4:h=1e-3") from the model's assembled state; free with
/// hn_run_free().
hn_run *hn_motion_start(const hn_model *m, const char *method);
/// The same from another state, in system coordinates.
hn_run *hn_motion_start_at(const hn_model *m, const char *method, const double *q, const double *v);
/// Advances to t and samples there; the sample's arrays live until the run is used again.
hn_sample hn_motion_at(hn_run *run, double t);
/// Runs to t_end and gives the summary; the run is freed.
hn_run_summary hn_motion_summary(const hn_model *m, const char *method, double t_end);
/// Largest difference of the accelerations that a formulation finds at the assembled state from
/// those in `a` (nv); `settings` are its own, in its order. Of formulations that make an ordinary
/// differential equation of (q, v).
double hn_motion_acceleration_error(const hn_model *m, const char *formulation,
                                    const double *settings, const double *a);

#endif
