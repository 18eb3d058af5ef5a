// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_STABILITY_H
#define HN_STUDY_STABILITY_H
// The largest stable step of a method along a motion: predicted from the eigenvalues of the motion
// on the loops (study/spectrum/spectrum.h), and observed by trial runs.
//
// A path is a motion computed once with small steps. It records the state, the energy and the
// eigenvalues at equal times. A trial run of a method is classed by its distance from the path. The
// prediction is the smallest of the step limits along the path.

#include "integrators/method/method_spec.h"
#include "study/run/walk.h"
#include "study/spectrum/spectrum.h"

#include <stdbool.h>

enum { HN_STABILITY_LOOKS = 48, HN_STABILITY_REASON = 256, HN_STABILITY_LEAST_STEPS = 500 };

#define HN_STABILITY_ACCURATE 1e-2 ///< largest error of what counts as accurate
#define HN_STABILITY_GROWN \
    1.0 ///< energy above the path's, in its scale, that counts as growth if it still rises:
#define HN_STABILITY_RISING \
    3.0 ///< the highest in the last third of a trial is so many times that in the first
#define HN_STABILITY_RUNAWAY 100.0 ///< energy above the path's that always counts as growth
#define HN_STABILITY_OPEN 0.1      ///< loop gap / characteristic length that counts as growth
#define HN_STABILITY_SLOW 10.0     ///< growth over a whole trial that is visible

#define HN_STABILITY_CLASS_LIST(X)           \
    X(HN_STABILITY_PENDING, "pending")       \
    X(HN_STABILITY_FINE, "stable")           \
    X(HN_STABILITY_INACCURATE, "inaccurate") \
    X(HN_STABILITY_GREW, "grew")             \
    X(HN_STABILITY_STOPPED, "stopped")       \
    X(HN_STABILITY_REFUSED, "refused")       \
    X(HN_STABILITY_SKIPPED, "skipped")
typedef enum hn_stability_class {
#define HN_STABILITY_ENUM(code, name) code,
    HN_STABILITY_CLASS_LIST(HN_STABILITY_ENUM)
#undef HN_STABILITY_ENUM
        HN_STABILITY_CLASS_COUNT
} hn_stability_class;
/// The word of the documents.
const char *hn_stability_class_name(hn_stability_class kind);
/// 1: it came to its end without growth (accurate or not).
bool hn_stability_is_stable(hn_stability_class kind);

/// Outcome of one trial.
typedef struct hn_stability_trial {
    hn_stability_class kind;
    hn_status status;
    char reason[HN_STABILITY_REASON]; ///< why it is not stable, in words and numbers; "" when it is
    double t_reached;                 ///< [s]
    double error;  ///< largest speed difference from the path, in the energy norm and its scale [-]
    double energy; ///< largest energy above the path's, in its scale [-]
    double gap;    ///< largest loop gap seen [of the characteristic length]
    long long steps;
} hn_stability_trial;

typedef struct hn_stability_path hn_stability_path;

/// The motion from (q, v), system coordinates, to T, by explicit and failing that implicit
/// high-order integration within `limits`, of which the explicit one may use a third; the system
/// must outlive it. Fails: HN_ERR_STOPPED (on request, or out of computing time), what the
/// integration ended with, HN_ERR_INPUT (nothing moves: there is no scale of growth),
/// HN_ERR_MEMORY; reason in diag.
HN_MUST_CHECK hn_status hn_stability_path_create(const hn_system *sys, const double *q,
                                                 const double *v, double T,
                                                 const hn_walk_limits *limits,
                                                 hn_stability_path **out, hn_diag *diag);
/// The largest rate of a coordinate along the motion, lengths over the characteristic length [1/s].
double hn_stability_path_rate(const hn_stability_path *p);
void hn_stability_path_free(hn_stability_path *p); ///< NULL is legal

/// A predicted limit of the step of one method.
typedef struct hn_stability_forecast {
    double limit; ///< strictest over the path [s]; HUGE_VAL: none; NaN: nothing can be said
    double start; ///< at the start [s]
    int look;     ///< where it is strictest
    /// the smallest step beyond which a trial of `steps` steps grows by HN_STABILITY_SLOW [s]
    double visible;
    const char *why; ///< why nothing can be said (static text), NULL otherwise
} hn_stability_forecast;
/// With Baumgarte's terms the roots they add count too. A setting h in the spec plays no part.
hn_stability_forecast hn_stability_predict(const hn_stability_path *p, const hn_method_spec *spec,
                                           long long steps);
/// Runs the method from the path's start to its end, at least HN_STABILITY_LEAST_STEPS steps, and
/// classes it. Returns 0 when stopped on request, the trial then being pending.
int hn_stability_try(const hn_stability_path *p, const hn_method_spec *spec,
                     const hn_walk_limits *limits, hn_stability_trial *out);
#endif
