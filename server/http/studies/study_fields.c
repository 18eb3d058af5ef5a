// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/studies/study_fields.h"

#include "session/kinds/job.h"

#include <stdio.h>
#include <string.h>

static const double LEAST_SECONDS = 1e-3;

hn_field hn_study_fields[HN_STUDY_FIELDS];

static const char *const STATES[] = {"stopped", "running", NULL};
hn_field hn_study_change[3] = {
    {.name = "state",
     .type = HN_FIELD_CHOICE,
     .required = 1,
     .choices = STATES,
     .about = "stopped: ends the computation and keeps the results; running: continues a study "
              "that was stopped, or that reached its time limit"},
    {.name = "time_limit",
     .type = HN_FIELD_NUMBER,
     .about = "time limit of the continued run [s], at most what is left of the study's computing "
              "time; all that is left when left out"},
    {.name = NULL},
};

static const char TIME_LIMIT[] = "time_limit";
static char about_time_limit[80];

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

/// The table's row of this name, which is there.
static hn_field *find_field(const char *name) {
    hn_field *f = hn_study_fields;
    while (strcmp(f->name, name) != 0) {
        f++;
    }
    return f;
}

const hn_field *hn_study_fields_time_limit(void) {
    return find_field(TIME_LIMIT);
}

/// The bounds of this server.
static void bound_time_limit(double most_seconds) {
    hn_field *f = find_field(TIME_LIMIT);
    f->min = LEAST_SECONDS;
    f->max = most_seconds;
    snprintf(about_time_limit, sizeof about_time_limit,
             "wall time of the computation [s]; %g when left out", most_seconds);
    f->about = about_time_limit;

    // going on has the same bounds
    hn_study_change[1].min = f->min;
    hn_study_change[1].max = f->max;
}

void hn_study_fields_fill(double most_seconds) {
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
         .about = "kind of the study; the index of the API lists the kinds with their fields"},
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
    bound_time_limit(most_seconds);
}
