// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/job/job_request.h"

#include "session/model/run_time.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

hn_job_request hn_job_request_default(const hn_model *model) {
    return (hn_job_request){.models = {model},
                            .n_models = model != NULL,
                            .time = (double)NAN,
                            .limits.time_limit = (double)NAN};
}

hn_status hn_job_request_set_methods(hn_job_request *r, const char *const *methods, int n,
                                     hn_diags *diags) {
    if (n > HN_JOB_METHODS) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/methods", NULL,
                            "%d methods were given; at most %d are allowed", n, HN_JOB_METHODS);
    }
    for (int i = 0; i < n; i++) {
        r->methods[i] = methods[i];
    }
    r->n_methods = n;
    return HN_OK;
}

static hn_job_value *add_value(hn_job_request *r, const char *name) {
    HN_ASSERT(r->n_values < HN_JOB_VALUES);
    hn_job_value *v = &r->values[r->n_values++];
    *v = (hn_job_value){.name = name, .number = (double)NAN};
    return v;
}

void hn_job_request_set(hn_job_request *r, const char *name, double number) {
    add_value(r, name)->number = number;
}

void hn_job_request_set_text(hn_job_request *r, const char *name, const char *text) {
    add_value(r, name)->text = text;
}

/// Takes one member of the body into the request: common ones to their own places.
static hn_status take_member(hn_job_request *r, const cJSON *item, hn_diags *diags) {
    // the methods, as many as are allowed and one more, so that too many are reported
    if (strcmp(item->string, "methods") == 0) {
        const char *methods[HN_JOB_METHODS + 1];
        const cJSON *one;
        int n = 0;
        cJSON_ArrayForEach(one, item) {
            if (n <= HN_JOB_METHODS) {
                methods[n++] = one->valuestring;
            }
        }
        return hn_job_request_set_methods(r, methods, n, diags);
    }

    // the times; other members are fields of the kind
    if (strcmp(item->string, "time") == 0) {
        r->time = item->valuedouble;
    } else if (strcmp(item->string, "time_limit") == 0) {
        r->limits.time_limit = item->valuedouble;
    } else if (cJSON_IsString(item)) {
        hn_job_request_set_text(r, item->string, item->valuestring);
    } else {
        hn_job_request_set(r, item->string,
                           cJSON_IsBool(item) ? cJSON_IsTrue(item) : item->valuedouble);
    }
    return HN_OK;
}

hn_status hn_job_request_read(hn_job_request *r, const cJSON *object, const hn_field *fields,
                              hn_diags *diags) {
    for (const hn_field *f = fields; f->name; f++) {
        const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, f->name);
        if (item) {
            HN_TRY(take_member(r, item, diags));
        }
    }
    return HN_OK;
}

static const hn_job_value *find_value(const hn_job_request *r, const char *name) {
    for (int i = 0; i < r->n_values; i++) {
        if (strcmp(r->values[i].name, name) == 0) {
            return &r->values[i];
        }
    }
    return NULL;
}

double hn_job_number(const hn_job_request *r, const char *name, double otherwise) {
    const hn_job_value *v = find_value(r, name);
    return v && !v->text ? v->number : otherwise;
}

const char *hn_job_text(const hn_job_request *r, const char *name) {
    const hn_job_value *v = find_value(r, name);
    return v ? v->text : NULL;
}

static hn_status check_times(const hn_job_request *r, hn_diags *diags) {
    const double limit = r->limits.time_limit;
    if (r->n_models == 1) {
        HN_TRY(hn_run_time_check(r->time, false, "end time", "/time", diags));
    }
    if (!(limit >= 0) || !isfinite(limit)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/time_limit", NULL,
                            "the time limit is %g s; it must be above 0, or 0 for none", limit);
    }
    return HN_OK;
}

hn_status hn_job_complete(hn_job_request *r, double time_limit, int most, hn_method_spec *specs,
                          hn_diags *diags) {
    if (isnan(r->time) && r->n_models == 1) {
        r->time = hn_model_scene(r->models[0])->duration;
    }
    if (isnan(r->limits.time_limit)) {
        r->limits.time_limit = time_limit;
    }
    HN_TRY(check_times(r, diags));
    if (r->n_methods > most) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/methods", NULL,
                            "%d methods were given; 1 to %d are allowed", r->n_methods, most);
    }

    // every spelling, up to the first that is wrong
    for (int i = 0; i < r->n_methods; i++) {
        char pointer[32];
        hn_diag diag = {0};
        snprintf(pointer, sizeof pointer, "/methods/%d", i);
        const hn_status status = hn_method_parse(r->methods[i], &specs[i], &diag);
        if (status != HN_OK) {
            return hn_diags_add(diags, status, pointer, diag.hint, "%s", diag.message);
        }
    }
    return HN_OK;
}

bool hn_job_must_stop(const hn_job_limits *limits) {
    return limits->stop && limits->stop(limits->user);
}

void hn_job_progress(const hn_job_limits *limits, const char *part, double share) {
    if (limits->progress) {
        limits->progress(limits->user, part, share);
    }
}
