// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/step/stepper.h"

bool hn_stepper_serves(const hn_stepper *stepper, hn_dae_form form) {
    return stepper->forms ? (stepper->forms >> form & 1u) != 0 : form == HN_FORM_ODE;
}
