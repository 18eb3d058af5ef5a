// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/exports.h"

#include "http/request/context.h"
#include "http/request/request.h"
#include "http/request/scene_request.h"
#include "http/routes/catalogue.h"
#include "http/runs/runs.h"
#include "integrators/method/method_spec.h"
#include "session/export/export.h"
#include "session/export/mechanism.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

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

/// Wishes of a request, as words of its body or its query; NULL: left out.
typedef struct wanted {
    const char *language, *method, *style, *solver, *format;
    bool blanks;
} wanted;

/// Returns whether a program can hold its loops as the method does; a reader is told its name in
/// any case.
static bool is_held_by_programs(const char *spelling) {
    static const char *const names[] = {"index1@", "baumgarte@", "baumgarte:"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strncmp(spelling, names[i], strlen(names[i])) == 0) {
            return true;
        }
    }
    return false;
}

/// Fails: HN_ERR_INPUT for a word that is no style.
static hn_status check_style(const char *style, hn_diags *diags) {
    return !style || strcmp(style, "full") == 0 || strcmp(style, "skeleton") == 0
               ? HN_OK
               : hn_diags_add(diags, HN_ERR_INPUT, "/style", "full or skeleton",
                              "'%.40s' is not a style of export", style);
}

static hn_status write_program(hn_request *r, const hn_model *model, const wanted *w, hn_strbuf *b,
                               const char **suffix, hn_diags *diags) {
    char spelling[HN_SPEC_MAX];
    HN_TRY(check_style(w->style, diags));
    HN_TRY(read_method(w->method, spelling, diags));
    hn_export_request request = {
        .language = w->language ? w->language : "python",
        .method = is_held_by_programs(spelling) ? spelling : NULL,
        .solver = w->solver,
        .blanks = w->blanks,
        .skeleton = w->style && strcmp(w->style, "skeleton") == 0,
        .limits = {r->context->opts.max_run_cpu, hn_request_is_unwanted, r}};
    HN_TRY(hn_model_export(b, model, r->context->lib, &request, diags));
    *suffix = request.suffix;

    // the method of the workbench is for the reader: the program has a solver of its own
    if (spelling[0]) {
        const bool is_document =
            strcmp(request.suffix, ".tex") == 0; // what is behind its end is not read
        hn_strbuf_printf(b, "\n%s in the workbench: %s%s\n", is_document ? "%" : request.comment,
                         spelling, is_document ? "" : request.comment_end);
    }
    return HN_OK;
}

/// The lines about what a model does not hold, as a comment behind it.
static void add_left_out(hn_strbuf *b, const hn_strbuf *left_out) {
    if (left_out->n == 0) {
        return;
    }
    hn_strbuf_add(b, "<!--\n");
    for (const char *c = hn_strbuf_text(left_out); *c; c++) {
        // two dashes would end the comment
        hn_strbuf_add_n(b, c[0] == '-' && c[1] == '-' ? "_" : c, 1);
    }
    hn_strbuf_add(b, "-->\n");
}

static hn_status write_mechanism(const hn_model *model, const wanted *w, hn_strbuf *b,
                                 const char **suffix, hn_diags *diags) {
    if (w->language || w->method || w->style || w->solver || w->blanks) {
        return hn_diags_add(
            diags, HN_ERR_INPUT, "/format", "leave out language, method, style, solver and blanks",
            "'format' asks for the mechanism as a model, but the other fields ask for a program");
    }
    hn_strbuf left_out;
    hn_strbuf_init(&left_out);
    const hn_status status = hn_model_export_mechanism(b, NULL, &left_out, model, w->format, diags);
    if (status == HN_OK) {
        add_left_out(b, &left_out);
        *suffix = hn_mechanism_suffix(w->format);
    }
    hn_strbuf_reset(&left_out);
    return status;
}

/// Sends the program or the model, or why there is none; frees the model.
static void reply_export(hn_request *r, hn_model *model, const wanted *w) {
    const char *suffix = "";
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    const hn_status status = w->format ? write_mechanism(model, w, &b, &suffix, &diags)
                                       : write_program(r, model, w, &b, &suffix, &diags);
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        hn_reply_diags(r, status, &diags);
    } else {
        hn_reply_bytes(r, MHD_HTTP_OK, "text/plain; charset=utf-8", &b);
        name_file(r, model, suffix);
    }
    hn_model_free(model);
}

/// Reads the query `blanks`; false: with a problem as reply.
static bool read_blanks(hn_request *r, bool *blanks) {
    const char *text = hn_request_query(r, "blanks");
    *blanks = text && strcmp(text, "true") == 0;
    if (!text || *blanks || strcmp(text, "false") == 0) {
        return true;
    }
    hn_diags diags = {0};
    hn_diags_add(&diags, HN_ERR_INPUT, "/blanks", "blanks=true",
                 "'%.40s' is neither true nor false", text);
    hn_reply_diags(r, HN_ERR_INPUT, &diags);
    return false;
}

void hn_handle_scene_export(hn_request *r) {
    bool blanks;
    if (!read_blanks(r, &blanks)) {
        return;
    }
    hn_model *model = hn_catalogue_load_scene(r, 0);
    if (model) {
        const wanted w = {.language = hn_request_query(r, "language"),
                          .method = hn_request_query(r, "method"),
                          .style = hn_request_query(r, "style"),
                          .solver = hn_request_query(r, "solver"),
                          .format = hn_request_query(r, "format"),
                          .blanks = blanks};
        reply_export(r, model, &w);
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
        const wanted w = {.language = hn_fields_text(r->json, "language"),
                          .method = hn_fields_text(r->json, "method"),
                          .style = hn_fields_text(r->json, "style"),
                          .solver = hn_fields_text(r->json, "solver"),
                          .format = hn_fields_text(r->json, "format"),
                          .blanks =
                              cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(r->json, "blanks"))};
        reply_export(r, model, &w);
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
            const wanted w = {.language = hn_request_query(r, "language"), .method = spelling};
            reply_export(r, model, &w);
        }
    }
}
