// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/exports.h"

#include "http/request/context.h"
#include "http/request/request.h"
#include "http/request/scene_request.h"
#include "http/routes/catalogue.h"
#include "http/runs/runs.h"
#include "integrators/method/method_spec.h"
#include "session/export/export.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static int is_stopping(void *user) {
    const hn_context *context = user;
    return atomic_load(&context->stopping);
}

void hn_handle_languages(hn_request *r) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_export_languages_json(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

/// The spelling of a method as it is written out; "" when none was given.
static hn_status read_method(const char *text, char spelling[HN_SPEC_MAX], hn_diags *diags) {
    hn_method_spec spec;
    hn_diag diag = {0};
    spelling[0] = 0;
    if (!text) {
        return HN_OK;
    }
    const hn_status status = hn_method_parse(text, &spec, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, "/method", diag.hint, "%s", diag.message);
    }
    hn_method_format(&spec, spelling);
    return HN_OK;
}

/// The name of a file: letters, digits, dashes of the scene's id, and the ending of the language.
static void name_file(hn_request *r, const hn_model *model, const char *suffix) {
    const char *id = hn_model_scene(model)->id;
    char name[64];
    size_t n = 0;
    for (; id && id[n] && n < sizeof name - 1; n++) {
        const char c = id[n];
        const int is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                             (c >= '0' && c <= '9') || c == '-' || c == '_';
        name[n] = (char)(is_plain ? c : '-');
    }
    name[n] = 0;
    hn_reply_header_add(r, "Content-Disposition", "attachment; filename=\"%s%s\"",
                        n ? name : "mechanism", suffix);
}

/// Sends the program, or why there is none; frees the model.
static void reply_program(hn_request *r, hn_model *model, const char *language, bool blanks,
                          const char *method) {
    hn_export_request request = {.language = language ? language : "python",
                                 .blanks = blanks,
                                 .limits = {r->context->opts.max_run_cpu, is_stopping, r->context}};
    char spelling[HN_SPEC_MAX];
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_status status = read_method(method, spelling, &diags);
    if (status == HN_OK) {
        status = hn_model_export(&b, model, r->context->lib, &request, &diags);
    }
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        hn_model_free(model);
        hn_reply_diags(r, status, &diags);
        return;
    }

    // the method of the workbench is for the reader: the program has a solver of its own
    if (spelling[0]) {
        const bool is_document =
            strcmp(request.suffix, ".tex") == 0; // what is behind its end is not read
        hn_strbuf_printf(&b, "\n%s in the workbench: %s%s\n", is_document ? "%" : request.comment,
                         spelling, is_document ? "" : request.comment_end);
    }
    hn_reply_bytes(r, MHD_HTTP_OK, "text/plain; charset=utf-8", &b);
    name_file(r, model, request.suffix);
    hn_model_free(model);
}

void hn_handle_scene_export(hn_request *r) {
    hn_model *model = hn_catalogue_load_scene(r, 0);
    if (model) {
        const char *blanks = hn_request_query(r, "blanks");
        reply_program(r, model, hn_request_query(r, "language"),
                      blanks && strcmp(blanks, "true") == 0, hn_request_query(r, "method"));
    }
}

void hn_handle_export(hn_request *r) {
    hn_scene_request order = {0};
    hn_diags diags = {0};
    hn_model *model = NULL;
    hn_status status = hn_scene_request_read(&order, r->json, &diags);
    if (status == HN_OK) {
        status = hn_scene_request_load(&order, r->context->lib, 0, hn_request_interrupt(r), &model,
                                       &diags);
    }
    hn_scene_request_reset(&order);
    if (status == HN_OK) {
        reply_program(r, model, hn_fields_text(r->json, "language"),
                      cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(r->json, "blanks")),
                      hn_fields_text(r->json, "method"));
    } else {
        hn_reply_diags(r, status, &diags);
    }
}

/// The scene of a run, with its parameters, and the spelling of the method that the query names by
/// its index; NULL with a problem as reply.
static hn_model *load_run(hn_request *r, const char *question, char spelling[HN_SPEC_MAX]) {
    cJSON *body = cJSON_Parse(question);
    const cJSON *methods = cJSON_GetObjectItemCaseSensitive(body, "methods");
    hn_scene_request order = {0};
    hn_diags diags = {0};
    hn_model *model = NULL;
    double method = 0;
    if (!methods) {
        cJSON_Delete(body);
        hn_reply_problem(r, HN_PROBLEM_INTERNAL, NULL, "%s", hn_status_text(HN_ERR_MEMORY));
        return NULL;
    }
    if (hn_request_query_number(r, "method", 0, cJSON_GetArraySize(methods) - 1, true, &method)) {
        snprintf(spelling, HN_SPEC_MAX, "%s",
                 cJSON_GetArrayItem(methods, (int)method)->valuestring);
        hn_status status = hn_scene_request_read(&order, body, &diags);
        HN_THEN(status, hn_scene_request_load(&order, r->context->lib, 0, hn_request_interrupt(r),
                                              &model, &diags));
        if (status != HN_OK) {
            hn_reply_diags(r, status, &diags);
        }
    }
    hn_scene_request_reset(&order);
    cJSON_Delete(body);
    return model;
}

void hn_handle_run_export(hn_request *r) {
    hn_kept_run *run = hn_run_find(r);
    if (run) {
        char spelling[HN_SPEC_MAX];
        hn_model *model = load_run(r, run->request, spelling);
        hn_runs_release(r->context->runs, run);
        if (model) {
            reply_program(r, model, hn_request_query(r, "language"), false, spelling);
        }
    }
}
