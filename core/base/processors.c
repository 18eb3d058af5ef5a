// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // sched_getaffinity
#include "base/processors.h"

#include <sched.h>
#include <unistd.h>

int hn_processors(void) {
    cpu_set_t mine;
    if (sched_getaffinity(0, sizeof mine, &mine) == 0 && CPU_COUNT(&mine) > 0) {
        return CPU_COUNT(&mine);
    }
    const long online = sysconf(_SC_NPROCESSORS_ONLN); // more processors than the set has room for
    return online > 0 ? (int)online : 1;
}
