// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_REFERENCE_H
#define HN_SUPPORT_REFERENCE_H
// Published problems with states that can be trusted, read from tests/reference/states/NAME.json:
// which scenes write the problem, how the reference's coordinates follow from a scene's, the
// states, what was published, the methods to run, and to how many digits each has to agree.
// Failures stop the test and say problem, scene, method, time and digits.
//
// Digits: -log10 of the largest error of a component, each divided by the largest value that
// component takes in the list of trusted states (a component that passes through zero keeps its
// scale); 16 at most.

#include "support/motion.h"

typedef enum hn_reference_kind {
    HN_REFERENCE_Q,
    HN_REFERENCE_V,
    HN_REFERENCE_A,
    HN_REFERENCE_LAMBDA,
    HN_REFERENCE_KINDS
} hn_reference_kind;

enum { HN_REFERENCE_MAX = 16 }; ///< components of a state

/// A state in the coordinates of the reference.
typedef struct hn_reference_state {
    int n[HN_REFERENCE_KINDS];
    double x[HN_REFERENCE_KINDS][HN_REFERENCE_MAX];
} hn_reference_state;

typedef struct hn_reference hn_reference;
hn_reference *hn_reference_open(const char *name);
void hn_reference_close(hn_reference *r);
int hn_reference_scenes(const hn_reference *r);
const char *hn_reference_scene(const hn_reference *r, int i);
int hn_reference_methods(const hn_reference *r);
const char *hn_reference_method(const hn_reference *r, int i);

/// The state of `method` on a scene of the problem at time t, after a run of its own.
hn_reference_state hn_reference_run_to(const hn_reference *r, const char *scene, const char *method,
                                       double t);
/// The trusted state at one of its times.
hn_reference_state hn_reference_trusted(const hn_reference *r, double t);
/// Digits of one kind that agree with the trusted state at t.
double hn_reference_digits(const hn_reference *r, hn_reference_kind kind, double t,
                           const hn_reference_state *found);

/// Every scene by every method of the file, at every time: as many digits as the file asks for, and
/// as many of the published ones; where the file says that a method stops, it has to stop for that
/// reason.
void hn_reference_check(const char *name);

#endif
