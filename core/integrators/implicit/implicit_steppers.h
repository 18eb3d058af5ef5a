// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_IMPLICIT_STEPPERS_H
#define HN_INTEGRATORS_IMPLICIT_STEPPERS_H
// Common part of the collocation methods' cards. The nodes of a method are data, so that its
// functions are three lines each.

#include "integrators/implicit/implicit_dae.h"
#include "integrators/implicit/implicit_ode.h"
#include "integrators/step/options.h"

/// Slots of both engines that need nothing of the method itself.
#define HN_IMPLICIT_ODE_SLOTS                                                \
    .prepare = hn_implicit_ode_prepare, .step = hn_implicit_ode_step,        \
    .on_accepted = hn_implicit_ode_accepted, .dense = hn_implicit_ode_dense, \
    .add_cost = hn_implicit_ode_add_cost, .why = hn_implicit_ode_why

#define HN_IMPLICIT_DAE_SLOTS                                                 \
    .destroy = hn_implicit_dae_destroy, .start = hn_implicit_dae_start,       \
    .step = hn_implicit_dae_step, .on_accepted = hn_implicit_dae_accepted,    \
    .dense = hn_implicit_dae_dense, .raw_lambda = hn_implicit_dae_raw_lambda, \
    .add_cost = hn_implicit_dae_add_cost, .why = hn_implicit_dae_why

/// forms: bit per hn_dae_form
#define HN_FORM_BIT(form) (1u << (form))
#define HN_FORMS_STIFFLY_ACCURATE                                                           \
    (HN_FORM_BIT(HN_FORM_ODE) | HN_FORM_BIT(HN_FORM_INDEX3) | HN_FORM_BIT(HN_FORM_INDEX2) | \
     HN_FORM_BIT(HN_FORM_GGL))

#endif
