// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/counted_angles.h"

#include "session/export/exam_angles.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_WAYS = 200 };

static bool is_constant(const hn_given_part *p) {
    const int size = p->exam->size[p->part];
    for (int i = 0; i < HN_EXPORT_EXAM_STATES * size; i++) {
        if (fabs(p->given[i] - p->given[i % size]) > p->allowed) {
            return false;
        }
    }
    return true;
}

/// *is: whether the part is what these angles make of it. `values` has room for one state.
static hn_status compare(const hn_given_part *p, const hn_exam_angles *angles, double *values,
                         bool *is) {
    const int size = p->exam->size[p->part];
    *is = true;
    for (int k = 0; k < HN_EXPORT_EXAM_STATES && *is; k++) {
        HN_TRY(hn_exam_angles_apply(p->exam, p->part, angles, k, values));
        for (int i = 0; i < size && *is; i++) {
            *is = fabs(p->given[k * size + i] - values[i]) <= p->allowed;
        }
    }
    return HN_OK;
}

static void say(const hn_given_part *p, const hn_exam_angles *angles, char *out) {
    const char *first = hn_exam_coordinate_name(p->exam, angles->first);
    const char *last = hn_exam_coordinate_name(p->exam, angles->last);
    if (angles->chain) {
        snprintf(out, HN_COUNTED_ANGLES_TEXT, "it takes each angle from %.30s to %.30s for one %s",
                 first, last,
                 angles->included ? "that includes the angle before it"
                                  : "against the angle before it");
    } else if (angles->included) {
        snprintf(out, HN_COUNTED_ANGLES_TEXT,
                 "it takes %.30s for an angle that includes %.30s: %.30s - %.30s stands in its "
                 "place",
                 last, first, last, first);
    } else {
        snprintf(out, HN_COUNTED_ANGLES_TEXT,
                 "it takes %.30s for an angle against %.30s: %.30s + %.30s stands in its place",
                 last, first, first, last);
    }
}

hn_status hn_counted_angles_find(const hn_given_part *p, bool *found,
                                 char out[HN_COUNTED_ANGLES_TEXT]) {
    hn_exam_angles ways[MOST_WAYS];
    const int n = is_constant(p) ? 0 : hn_exam_angles_list(p->exam, ways, MOST_WAYS);
    double *values = malloc(((size_t)p->exam->size[p->part] + 1) * sizeof *values);
    hn_status status = values ? HN_OK : HN_ERR_MEMORY;
    *found = false;
    for (int i = 0; i < n && status == HN_OK && !*found; i++) {
        status = compare(p, &ways[i], values, found);
        if (status == HN_OK && *found) {
            say(p, &ways[i], out);
        }
    }
    free(values);
    return status;
}
