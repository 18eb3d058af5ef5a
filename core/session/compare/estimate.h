// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_ESTIMATE_H
#define HN_SESSION_ESTIMATE_H
// The error estimate of a run as data: the same object in runs, frames and summaries of
// comparisons.

#include "base/strbuf.h"
#include "base/units.h"
#include "integrators/method/method_spec.h"
#include "study/run/run.h"
#include "study/truth/accuracy.h"

#define HN_TOLERANCE_KEPT 10.0 ///< an error of so many times rtol is what a tolerance promises

/// Puts the member "error_estimate": {"q","v","reaction","coordinate","off","unit","own","t",
/// "over_rtol","reason"}. q, v, reaction and own are relative errors as in study/truth/errors.h,
/// the largest up to the time t [s]; null each where nothing is known. "coordinate" is the one that
/// is off by q, "off" is that in its "unit" ("rad", "m", or "1"). "over_rtol" is q over the
/// tolerance of a method that has one, null where q is no more than the estimate's own error. The
/// reason says why it is not known, or ended before t_run; else it is "".
void hn_estimate_put_json(hn_strbuf *b, const hn_accuracy *accuracy, const hn_method_spec *spec,
                          const hn_accuracy_track *track, double t_run);

/// Writes how far a coordinate is off for people: "19 rad", "3.1 mm". `unit` as in "unit" above.
void hn_estimate_write_off(double off, const char *unit, char out[HN_SI_TEXT]);

/// Puts the member "verdict": {"is","text"}, what the estimate says of the motion: "wrong" from
/// HN_ACCURACY_WRONG on, "inaccurate" above HN_ACCURACY_WARN, "right" below, "unknown" where there
/// is no estimate, or none up to t_run and nothing wrong before. An incident of the run that calls
/// the motion wrong makes the verdict "inaccurate" at least, and "wrong" where it comes after the
/// end of the estimate. A run that diverged is "wrong", whatever time was asked for and however
/// few of its states were compared. It is not the status of the run, which says only whether it
/// reached its end.
void hn_estimate_put_verdict(hn_strbuf *b, const hn_accuracy *accuracy,
                             const hn_accuracy_track *track, double t_run, const hn_run *run);
#endif
