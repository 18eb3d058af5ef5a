// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/studies/study_fields.h"

#include "session/kinds/job.h"

#include <string.h>

hn_field hn_study_fields[HN_STUDY_FIELDS];

static const char *kind_names[HN_STUDY_FIELDS];

static double bound_of(const hn_field *f) {
    return f->served_max > 0 ? f->served_max : f->max;
}

/// Adds a field, or widens the bound of the one that another kind has under the same name.
static void add_field(const hn_field *f, int *n) {
    hn_field *known = NULL;
    for (int i = 0; i < *n && !known; i++) {
        known = strcmp(hn_study_fields[i].name, f->name) == 0 ? &hn_study_fields[i] : NULL;
    }
    if (known) {
        known->max = bound_of(f) > known->max ? bound_of(f) : known->max;
        return;
    }
    HN_ASSERT(*n + 1 < HN_STUDY_FIELDS);
    hn_study_fields[*n] = *f;
    hn_study_fields[*n].max = bound_of(f);
    hn_study_fields[(*n)++].served_max = 0;
}

void hn_study_fields_fill(void) {
    static const hn_field own[] = {
        {.name = "scene",
         .type = HN_FIELD_SCENE,
         .required = 1,
         .about = "a shipped scene's id or a scene object"},
        {.name = "parameters",
         .type = HN_FIELD_BY_NAME,
         .about = "parameters that differ from the scene's"},
        {.name = "kind",
         .type = HN_FIELD_CHOICE,
         .required = 1,
         .choices = kind_names,
         .about = "what is studied; the index of the API lists the kinds with their fields"},
    };
    const hn_job_kind *kind;
    int n = 0, n_kinds = 0;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        add_field(&own[i], &n);
    }

    // the fields of every kind that is served
    for (int i = 0; (kind = hn_job_kind_at(i)) != NULL; i++) {
        if (!kind->served) {
            continue;
        }
        kind_names[n_kinds++] = kind->name;
        for (const hn_field *f = kind->fields; f->name; f++) {
            if (f->served_max >= 0) {
                add_field(f, &n);
            }
        }
    }
    kind_names[n_kinds] = NULL;
    hn_study_fields[n] = (hn_field){.name = NULL};
}
