// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/list/formulation_list.h"

#include <string.h>

#define ADDRESS(name) &hn_formulation_##name,
static const hn_formulation *const formulations[] = {HN_FORMULATION_LIST(ADDRESS)};
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

const hn_formulation *hn_formulation_with(unsigned have, unsigned lack) {
    for (int i = 0; i < N_FORMULATIONS; i++) {
        const unsigned traits = formulations[i]->traits;
        if ((traits & have) == have && (traits & lack) == 0) {
            return formulations[i];
        }
    }
    return NULL;
}
