// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/ground/formulation.h"

const char *hn_form_name(hn_dae_form form) {
    static const char *const names[HN_FORM_COUNT] = {
        [HN_FORM_ODE] = "ode",
        [HN_FORM_INDEX3] = "index3",
        [HN_FORM_INDEX2] = "index2",
        [HN_FORM_GGL] = "ggl",
        [HN_FORM_INDEX1] = "index1",
        [HN_FORM_STABILISED] = "stabilised",
        [HN_FORM_AUGMENTED] = "augmented",
    };
    HN_ASSERT((int)form < HN_FORM_COUNT);
    return names[form];
}
