// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/wording.h"

#include <stdio.h>
#include <string.h>

bool hn_wording_of_step(double t, const char *message, char *out, size_t size) {
    char name[40], value[40];
    double end;
    int rest = 0;
    const int n = sscanf(message, "%39s = %39s at t = %lf s: %n", name, value, &end, &rest);
    if (n < 3 || rest == 0 || !(end > t)) {
        return false;
    }
    snprintf(out, size, "in the step to t = %.6g s with %s = %s: %s", end, name, value,
             message + rest);
    return true;
}

void hn_wording_behind_time(double t, const char *message, char *out, size_t size) {
    char again[48];
    if (hn_wording_of_step(t, message, out, size)) {
        return;
    }
    const int n = snprintf(again, sizeof again, "at t = %.6g s ", t);
    const bool says_it = strncmp(message, again, (size_t)n) == 0;
    snprintf(out, size, "%s", message + (says_it ? n : 0));
}
