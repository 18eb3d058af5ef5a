#include "methods/registry.h"

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
};
enum { N_FORMULATIONS = sizeof formulations / sizeof formulations[0] };

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
