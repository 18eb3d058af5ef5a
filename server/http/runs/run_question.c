// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/run_question.h"

#include "base/file.h"
#include "base/hash.h"
#include "build.h"
#include "http/ground/sha256.h"
#include "session/job/field.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_SAMPLES = 200 }; // as POST /runs promises

void hn_run_question_reset(hn_run_question *q) {
    hn_scene_request_reset(&q->scene);
    free(q->at);
    *q = (hn_run_question){0};
}

// ---- reading ----

static hn_status read_method(hn_run_question *q, const char *text, const char *pointer,
                             hn_diags *diags) {
    hn_method_spec spec;
    hn_diag diag = {0};
    const hn_status status = hn_method_parse(text, &spec, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, pointer, diag.hint, "%s", diag.message);
    }
    hn_method_format(&spec, q->methods[q->n_methods++]);
    return HN_OK;
}

static hn_status read_methods(hn_run_question *q, const cJSON *body, hn_diags *diags) {
    const cJSON *many = cJSON_GetObjectItemCaseSensitive(body, "methods"), *item;
    const char *one = hn_fields_text(body, "method");
    if ((one != NULL) == (many != NULL)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/method", "\"method\": \"projection@rk4:h=1e-3\"",
                            one ? "'method' and 'methods' are both given"
                                : "'method' is missing: FORMULATION[:key=value,...]@INTEGRATOR");
    }
    if (one) {
        return read_method(q, one, "/method", diags);
    }
    cJSON_ArrayForEach(item, many) {
        char pointer[32];
        snprintf(pointer, sizeof pointer, "/methods/%d", q->n_methods);
        HN_TRY(read_method(q, item->valuestring, pointer, diags));
    }
    return HN_OK;
}

static hn_status read_times(hn_run_question *q, const cJSON *body) {
    const cJSON *at = cJSON_GetObjectItemCaseSensitive(body, "at"), *item;
    q->time = hn_fields_number(body, "time", 0);
    q->every = at ? 0 : hn_fields_number(body, "every", q->time / DEFAULT_SAMPLES);
    if (!at) {
        return HN_OK;
    }
    q->at = calloc((size_t)cJSON_GetArraySize(at) + 1, sizeof *q->at);
    if (!q->at) {
        return HN_ERR_MEMORY;
    }
    cJSON_ArrayForEach(item, at) {
        q->at[q->n_at++] = item->valuedouble;
    }
    return HN_OK;
}

// ---- naming ----

static int compare_names(const void *a, const void *b) {
    return strcmp((*(const hn_setting *const *)a)->name, (*(const hn_setting *const *)b)->name);
}

/// Parameters by name, so that their order in the body does not matter.
static void put_parameters(hn_strbuf *b, const hn_scene_request *scene) {
    const hn_setting *sorted[HN_SCENE_MAX_PARAMS];
    for (int i = 0; i < scene->n; i++) {
        sorted[i] = &scene->settings[i];
    }
    qsort(sorted, (size_t)scene->n, sizeof *sorted, compare_names);
    hn_json_key(b, "parameters");
    hn_json_object(b);
    for (int i = 0; i < scene->n; i++) {
        hn_json_put_number(b, sorted[i]->name, sorted[i]->value);
    }
    hn_json_end_object(b);
}

/// The scene by its content: a shipped one may have changed since.
static void put_scene(hn_strbuf *b, const hn_scene_request *scene, const hn_library *lib) {
    const char *path = scene->name ? hn_library_scene_path(lib, scene->name) : NULL;
    hn_strbuf text;
    hn_strbuf_init(&text);
    if (path && hn_file_read(path, HN_SCENE_MAX_BYTES, &text, NULL) == HN_OK) {
        hn_json_put_string(b, "scene", hn_strbuf_text(&text));
    } else {
        hn_json_put_string(b, "scene", scene->name ? scene->name : scene->text);
    }
    hn_strbuf_reset(&text);
}

/// The hash in the alphabet of URLs; 132 of its bits.
static void name_text(const hn_strbuf *text, char id[HN_RUN_ID]) {
    char base64[HN_SHA256_BASE64];
    hn_sha256_base64(hn_strbuf_text(text), text->n, base64);
    for (int i = 0; i < HN_RUN_ID - 1; i++) {
        id[i] = base64[i] == '+' ? '-' : base64[i] == '/' ? '_' : base64[i];
    }
    id[HN_RUN_ID - 1] = 0;
}

static void put_methods(hn_strbuf *b, const hn_run_question *q) {
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int i = 0; i < q->n_methods; i++) {
        hn_json_string(b, q->methods[i]);
    }
    hn_json_end_array(b);
}

void hn_run_question_json(hn_strbuf *b, const hn_run_question *q) {
    hn_json_object(b);
    hn_json_key(b, "scene");
    if (q->scene.name) {
        hn_json_string(b, q->scene.name);
    } else {
        hn_json_raw(b, q->scene.text);
    }
    put_parameters(b, &q->scene);
    put_methods(b, q);
    hn_json_put_number(b, "time", q->time);
    if (q->at) {
        hn_json_put_numbers(b, "at", q->at, (size_t)q->n_at);
    } else {
        hn_json_put_number(b, "every", q->every);
    }
    hn_json_put_bool(b, "reactions", q->reactions);
    hn_json_put_bool(b, "raw_lambda", q->raw_lambda);
    hn_json_end_object(b);
}

static hn_status name_question(hn_run_question *q, const hn_library *lib) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_string(&b, "build", hn_build_name());
    put_scene(&b, &q->scene, lib);
    put_parameters(&b, &q->scene);
    put_methods(&b, q);

    // times and columns
    hn_json_put_number(&b, "time", q->time);
    hn_json_put_number(&b, "every", q->every);
    hn_json_put_numbers(&b, "at", q->at, (size_t)q->n_at);
    hn_json_put_bool(&b, "reactions", q->reactions);
    hn_json_put_bool(&b, "raw_lambda", q->raw_lambda);
    hn_json_end_object(&b);
    const hn_status status = b.failed ? HN_ERR_MEMORY : HN_OK;
    if (status == HN_OK) {
        name_text(&b, q->id);
    }
    hn_strbuf_reset(&b);
    return status;
}

hn_status hn_run_question_read(hn_run_question *q, const cJSON *body, const hn_library *lib,
                               hn_diags *diags) {
    HN_TRY(hn_scene_request_read(&q->scene, body, diags));
    HN_TRY(read_methods(q, body, diags));
    HN_TRY(read_times(q, body));
    q->reactions = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(body, "reactions"));
    q->raw_lambda = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(body, "raw_lambda"));
    return name_question(q, lib);
}
