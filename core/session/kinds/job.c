// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/kinds/job.h"

#include "base/word_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the registry ----

extern const hn_job_kind hn_kind_work_precision, hn_kind_stability, hn_kind_budget, hn_kind_report,
    hn_kind_extreme, hn_kind_reference;

static const hn_job_kind *const KINDS[] = {
    &hn_kind_work_precision, &hn_kind_stability, &hn_kind_budget,
    &hn_kind_report,         &hn_kind_extreme,   &hn_kind_reference,
};
enum { N_KINDS = sizeof KINDS / sizeof *KINDS };

const hn_job_kind *hn_job_kind_at(int i) {
    return i >= 0 && i < N_KINDS ? KINDS[i] : NULL;
}

const hn_job_kind *hn_job_kind_find(const char *name) {
    for (int i = 0; i < N_KINDS; i++) {
        if (strcmp(KINDS[i]->name, name) == 0) {
            return KINDS[i];
        }
    }
    return NULL;
}

static bool any_kind_has(const char *name) {
    for (int i = 0; i < N_KINDS; i++) {
        if (hn_fields_find(KINDS[i]->fields, name)) {
            return true;
        }
    }
    return false;
}

hn_status hn_job_check(const hn_job_kind *kind, const cJSON *object, bool served, hn_diags *diags) {
    const cJSON *item;
    cJSON_ArrayForEach(item, object) {
        if (!hn_fields_find(kind->fields, item->string) && any_kind_has(item->string)) {
            char pointer[HN_DIAG_POINTER];
            snprintf(pointer, sizeof pointer, "/%.40s", item->string);
            return hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL, "a job of kind %s has no '%s'",
                                kind->name, item->string);
        }
    }
    return hn_fields_check(object, kind->fields, "", served, diags);
}

// ---- one job ----

struct hn_job {
    const hn_job_kind *kind;
    hn_job_request request;
    void *work; ///< of the kind
};

/// Equations whose making was interrupted may be made again.
static void go_on(const hn_job_request *r) {
    for (int i = 0; i < r->n_models; i++) {
        hn_graph_go_on(hn_system_graph(hn_model_system(r->models[i])));
    }
}

/// HN_ERR_STOPPED in place of what the making of equations failed with when it was interrupted.
static hn_status told(const hn_job_request *r, hn_status status, hn_diags *diags) {
    bool interrupted = false;
    for (int i = 0; i < r->n_models; i++) {
        interrupted |= hn_graph_was_interrupted(hn_system_graph(hn_model_system(r->models[i])));
    }
    return status == HN_OK || status == HN_ERR_STOPPED || !interrupted
               ? status
               : hn_diags_add(diags, HN_ERR_STOPPED, NULL, NULL, "stopped on request");
}

hn_status hn_job_open(const hn_job_kind *kind, const hn_job_request *request, hn_job **out,
                      hn_diags *diags) {
    hn_job *job = calloc(1, sizeof *job);
    if (!job) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    job->kind = kind;
    job->request = *request;
    go_on(request);
    const hn_status status = told(request, kind->open(&job->request, &job->work, diags), diags);
    if (status != HN_OK) {
        free(job);
        return status;
    }
    *out = job;
    return HN_OK;
}

int hn_job_resumed(const hn_job *job) {
    return job->kind->resumed ? job->kind->resumed(job->work) : 0;
}

hn_status hn_job_run(hn_job *job, hn_job_end *end, hn_diags *diags) {
    *end = (hn_job_end){0};
    go_on(&job->request);
    return told(&job->request, job->kind->run(job->work, &job->request, end, diags), diags);
}

void hn_job_set_time_limit(hn_job *job, double time_limit) {
    HN_ASSERT(job->kind->set_time_limit);
    job->request.limits.time_limit = time_limit;
    job->kind->set_time_limit(job->work, time_limit);
}

bool hn_job_write(hn_strbuf *b, const hn_job *job, const char *suffix) {
    for (int i = 0; i < HN_JOB_FORMS && job->kind->forms[i].suffix; i++) {
        if (strcmp(job->kind->forms[i].suffix, suffix) == 0) {
            job->kind->forms[i].put(b, job->work);
            return true;
        }
    }
    return false;
}

const void *hn_job_work(const hn_job *job) {
    return job->work;
}

void hn_job_free(hn_job *job) {
    if (job) {
        job->kind->release(job->work);
        free(job);
    }
}

// ---- the list for the index ----

static const char *type_name(hn_field_type type) {
    switch (type) {
    case HN_FIELD_NUMBER:
        return "number";
    case HN_FIELD_INTEGER:
        return "integer";
    case HN_FIELD_BOOL:
        return "boolean";
    case HN_FIELD_TEXTS:
        return "texts";
    case HN_FIELD_CHOICE:
        return "choice";
    default:
        return "text";
    }
}

static void put_field(hn_strbuf *b, const hn_field *f) {
    hn_json_object(b);
    hn_json_put_string(b, "name", f->name);
    hn_json_put_string(b, "type", type_name(f->type));
    if (f->max > 0) {
        hn_json_put_number(b, "min", f->min);
        hn_json_put_number(b, "max", f->served_max > 0 ? f->served_max : f->max);
    }
    if (f->choices) {
        hn_json_key(b, "choices");
        hn_json_array(b);
        for (int i = 0; f->choices[i]; i++) {
            hn_json_string(b, f->choices[i]);
        }
        hn_json_end_array(b);
    }
    hn_json_put_string(b, "about", f->about);
    hn_json_end_object(b);
}

/// Words separated by blanks, as a list.
static void put_words(hn_strbuf *b, const char *key, const char *words) {
    hn_json_key(b, key);
    hn_json_array(b);
    char word[32];
    while (hn_word_next(&words, word, sizeof word)) {
        hn_json_string(b, word);
    }
    hn_json_end_array(b);
}

static void put_presets(hn_strbuf *b, const hn_job_kind *kind) {
    const hn_job_preset *preset;
    hn_json_key(b, "presets");
    hn_json_array(b);
    for (int i = 0; kind->preset && (preset = kind->preset(i)) != NULL; i++) {
        hn_json_object(b);
        hn_json_put_string(b, "name", preset->name);
        hn_json_put_string(b, "about", preset->about);
        put_words(b, "chooses", preset->chooses);
        hn_json_put_bool(b, "stabilised", preset->stabilised);
        put_words(b, "units", preset->units);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

void hn_job_kinds_json(hn_strbuf *b, const hn_field *time_limit) {
    hn_json_array(b);
    for (int i = 0; i < N_KINDS; i++) {
        // kinds that run on the command line only are not listed
        if (!KINDS[i]->served) {
            continue;
        }

        // what the kind computes
        hn_json_object(b);
        hn_json_put_string(b, "name", KINDS[i]->name);
        hn_json_put_string(b, "title", KINDS[i]->title);
        hn_json_put_string(b, "about", KINDS[i]->about);
        put_words(b, "chooses", KINDS[i]->chooses);

        // the fields that a request to the server may have
        hn_json_key(b, "fields");
        hn_json_array(b);
        for (const hn_field *f = KINDS[i]->fields; f->name; f++) {
            if (f->served_max >= 0) {
                put_field(b, strcmp(f->name, time_limit->name) == 0 ? time_limit : f);
            }
        }
        hn_json_end_array(b);

        put_presets(b, KINDS[i]);
        if (KINDS[i]->put_parts) {
            hn_json_key(b, "parts");
            KINDS[i]->put_parts(b);
        }
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}
