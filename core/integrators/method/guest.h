// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_GUEST_H
#define HN_INTEGRATORS_GUEST_H
// Methods that are in no list: a student's own program, spelled program:FILE[@INTEGRATOR].
//
// The core starts no programs. Their owner registers a finder, which makes a formulation (and an
// integrator of its own, "own") for a file; without a finder such a spelling is refused.

#include "base/diag.h"
#include "base/strbuf.h"
#include "formulations/ground/formulation.h"
#include "integrators/step/stepper.h"

#define HN_GUEST_PREFIX "program:"
#define HN_GUEST_STEPPER "own"

/// Both live as long as the process; the formulation's name is the whole spelling,
/// "program:./mine.py".
typedef struct hn_guest {
    const hn_formulation *formulation;
    const hn_stepper *stepper;
} hn_guest;

/// Finds the guest of a name that begins with HN_GUEST_PREFIX; called from any thread. Fails:
/// HN_ERR_INPUT with the reason in diag.
typedef hn_status (*hn_guest_finder)(const char *name, hn_guest *out, hn_diag *diag);

/// Adds the names of the guests that there are to a JSON array; called from any thread.
typedef void (*hn_guest_lister)(hn_strbuf *b);

/// Serves guests from now on. Call it once, before other threads exist.
void hn_guest_serve(hn_guest_finder finder, hn_guest_lister lister);
/// Adds the names of all guests to a JSON array; none where nobody serves them.
void hn_guest_list(hn_strbuf *b);
/// Fails as the finder does; HN_ERR_INPUT where there is none.
HN_MUST_CHECK hn_status hn_guest_find(const char *name, hn_guest *out, hn_diag *diag);
/// Returns whether a method's spelling names a guest.
bool hn_guest_is_named(const char *spelling);

#endif
