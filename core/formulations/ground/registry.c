#include "formulations/ground/registry.h"

#include <string.h>

static const hn_formulation *const formulations[] = {
    &hn_formulation_index1,
    &hn_formulation_baumgarte,
    &hn_formulation_projection,
    &hn_formulation_nullspace,
    &hn_formulation_nullspace_as_printed,
    &hn_formulation_partitioning,
    &hn_formulation_reduced,
    &hn_formulation_penalty,
    &hn_formulation_augmented_lagrangian,
    &hn_formulation_udwadia_kalaba,
    &hn_formulation_ggl,
    &hn_formulation_index2,
    &hn_formulation_index3,
    &hn_formulation_ali3p,
    &hn_formulation_symmetric_projection,
    &hn_formulation_nullspace_solver,
    &hn_formulation_nullspace_tangent,
    &hn_formulation_nullspace_untracked,
};
enum { N_FORMULATIONS = sizeof formulations / sizeof formulations[0] };

const char *hn_form_name(hn_dae_form form) {
    static const char *const names[HN_FORM_COUNT] = {"ode",    "index3",     "index2",   "ggl",
                                                     "index1", "stabilised", "augmented"};
    HN_ASSERT((int)form < HN_FORM_COUNT);
    return names[form];
}

int hn_formulation_count(void) {
    return N_FORMULATIONS;
}

const hn_formulation *hn_formulation_at(int i) {
    HN_ASSERT(i >= 0 && i < N_FORMULATIONS);
    return formulations[i];
}

const hn_formulation *hn_formulation_find(const char *name) {
    for (int i = 0; i < N_FORMULATIONS; i++) {
        if (strcmp(formulations[i]->name, name) == 0) {
            return formulations[i];
        }
    }
    return NULL;
}

const hn_formulation *hn_formulation_with(unsigned have, unsigned lack) {
    for (int i = 0; i < N_FORMULATIONS; i++) {
        const unsigned traits = formulations[i]->traits;
        if ((traits & have) == have && (traits & lack) == 0) {
            return formulations[i];
        }
    }
    return NULL;
}
