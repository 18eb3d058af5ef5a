// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/list/stepper_list.h"

#include <string.h>

#define ADDRESS(name) &hn_stepper_##name,
static const hn_stepper *const steppers[] = {HN_STEPPER_LIST(ADDRESS)};
enum { N_STEPPERS = sizeof steppers / sizeof steppers[0] };

int hn_stepper_count(void) {
    return N_STEPPERS;
}

const hn_stepper *hn_stepper_at(int i) {
    HN_ASSERT(i >= 0 && i < N_STEPPERS);
    return steppers[i];
}

const hn_stepper *hn_stepper_find(const char *name) {
    for (int i = 0; i < N_STEPPERS; i++) {
        if (strcmp(steppers[i]->name, name) == 0) {
            return steppers[i];
        }
    }
    return NULL;
}
