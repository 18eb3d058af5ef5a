// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/stateless.h"

#include "base/clock.h"
#include "grade/exercise_shelf.h"
#include "grade/exercise_text.h"
#include "grade/grade.h"
#include "grade/variant_text.h"
#include "http/ground/plain_number.h"
#include "http/live/pulls.h"
#include "http/request/context.h"
#include "http/request/request.h"
#include "http/request/scene_request.h"
#include "session/compare/comparison.h"
#include "session/compare/picture.h"
#include "session/compare/run_doc.h"
#include "session/export/export.h"
#include "session/model/drag_json.h"
#include "session/model/equations.h"
#include "session/model/inspect_json.h"
#include "session/model/model_json.h"
#include "session/model/terms_json.h"

#include <stdbool.h>
#include <string.h>

/// Computing time of one drag: a page asks many times a second.
static const double DRAG_SECONDS = 0.05;

/// The hand of the body holds its point at all times.
static hn_status hold(const hn_model *model, const cJSON *body) {
    hn_pull pull = hn_pull_read(body);
    hn_pull_choose_spring(hn_model_system(model), &pull);
    return hn_pull_log_add(hn_system_pulls(hn_model_system(model)), 0, &pull);
}

/// Loads the scene that the body names; NULL with a problem as reply.
static hn_model *load_model(hn_request *r, bool allow_open) {
    hn_scene_request order = {0};
    hn_diags diags = {0};
    hn_model *model = NULL;
    const cJSON *pull = cJSON_GetObjectItemCaseSensitive(r->json, "pull");
    hn_status status = hn_scene_request_read(&order, r->json, &diags);
    if (status == HN_OK && pull) {
        status = hn_scene_request_add_pull(&order, hn_pull_read(pull).point, &diags);
    }
    HN_THEN(status, hn_scene_request_load(&order, r->context->lib, allow_open,
                                          hn_request_interrupt(r), &model, &diags));
    hn_scene_request_reset(&order);
    if (status == HN_OK && pull) {
        status = hold(model, pull);
    }
    if (status != HN_OK) {
        hn_model_free(model);
        hn_reply_diags(r, status, &diags);
        return NULL;
    }
    return model;
}

/// Sends what was written, or the faults, and frees the model.
static void conclude(hn_request *r, hn_model *model, hn_status status, hn_strbuf *b,
                     const hn_diags *diags) {
    hn_model_free(model);
    if (status == HN_OK) {
        hn_reply_json(r, MHD_HTTP_OK, b);
    } else {
        hn_strbuf_reset(b);
        hn_reply_diags(r, status, diags);
    }
}

/// Reads the coordinates and rates that differ from the start; NULL when memory is out.
static hn_state_entry *read_state(const hn_request *r, int *n) {
    const cJSON *state = cJSON_GetObjectItemCaseSensitive(r->json, "state"), *item;
    hn_state_entry *entries = calloc((size_t)cJSON_GetArraySize(state) + 1, sizeof *entries);
    *n = 0;
    if (entries) {
        cJSON_ArrayForEach(item, state) {
            entries[(*n)++] = (hn_state_entry){.name = item->string, .value = item->valuedouble};
        }
    }
    return entries;
}

void hn_handle_terms(hn_request *r) {
    hn_model *model = load_model(r, 0);
    if (!model) {
        return;
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_diags diags = {0};
    int n;
    hn_state_entry *entries = read_state(r, &n);
    hn_status status = entries ? HN_OK : HN_ERR_MEMORY;
    if (entries) {
        const double t = hn_fields_number(r->json, "t", 0);
        status = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(r->json, "reactions"))
                     ? hn_model_terms_json_with_reactions(&b, model, t, entries, n, &diags)
                     : hn_model_terms_json(&b, model, t, entries, n, &diags);
    }
    free(entries);
    conclude(r, model, status, &b, &diags);
}

void hn_handle_assemble(hn_request *r) {
    hn_model *model = load_model(r, 0);
    if (model) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_model_assembly_json(&b, model);
        conclude(r, model, HN_OK, &b, NULL);
    }
}

/// 1 when the body names one thing to drag; else the reply is a problem.
static bool names_one(hn_request *r) {
    const int n =
        cJSON_HasObjectItem(r->json, "point") + cJSON_HasObjectItem(r->json, "coordinate");
    if (n != 1) {
        hn_diags diags = {0};
        const hn_status status = hn_diags_add(
            &diags, HN_ERR_INPUT, "/point", "\"point\": 3, or \"coordinate\": \"th1\"",
            n ? "both a point and a coordinate were named: name one"
              : "neither a point nor a coordinate is named; the request needs one of them");
        hn_reply_diags(r, status, &diags);
    }
    return n == 1;
}

void hn_handle_drag(hn_request *r) {
    hn_model *model = names_one(r) ? load_model(r, 0) : NULL;
    if (!model) {
        return;
    }
    double target[3];
    const cJSON *item;
    hn_drag_request request = {.coordinate = hn_fields_text(r->json, "coordinate"),
                               .point = (int)hn_fields_number(r->json, "point", -1),
                               .target = target,
                               .seconds = DRAG_SECONDS};
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(r->json, "target")) {
        target[request.n_target++] = item->valuedouble;
    }

    // from the state that the body gives
    hn_state_entry *entries = read_state(r, &request.n_from);
    request.from = entries;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_diags diags = {0};
    const hn_status status =
        entries ? hn_model_drag_json(&b, model, &request, &diags) : HN_ERR_MEMORY;
    free(entries);
    conclude(r, model, status, &b, &diags);
}

void hn_handle_inspect(hn_request *r) {
    hn_model *model = load_model(r, 1);
    if (model) {
        hn_strbuf b;
        hn_diags diags = {0};
        hn_strbuf_init(&b);
        hn_status status = hn_model_inspect_json(&b, model, &diags);
        conclude(r, model, status, &b, &diags);
    }
}

void hn_handle_equations(hn_request *r) {
    hn_model *model = load_model(r, 1);
    if (!model) {
        return;
    }
    const char *format = hn_fields_text(r->json, "format");
    format = format ? format : "text";
    hn_equation_form form = strcmp(format, "latex") == 0  ? HN_EQUATIONS_LATEX
                            : strcmp(format, "json") == 0 ? HN_EQUATIONS_JSON
                                                          : HN_EQUATIONS_TEXT;

    // JSON is the document itself, text stands in one
    hn_strbuf text, b;
    hn_diags diags = {0};
    hn_strbuf_init(&text);
    hn_strbuf_init(&b);
    hn_status status = hn_model_equations(&text, model, form, &diags);
    if (form == HN_EQUATIONS_JSON) {
        conclude(r, model, status, &text, &diags);
        return;
    }
    hn_json_object(&b);
    hn_json_put_string(&b, "format", format);
    hn_json_put_string(&b, "text", hn_strbuf_text(&text));
    hn_json_end_object(&b);
    b.failed |= text.failed;
    hn_strbuf_reset(&text);
    conclude(r, model, status, &b, &diags);
}

/// Painting has a time of its own, which begins with its first question.
typedef struct painting_time {
    hn_request *r;
    bool has_begun;
} painting_time;

static bool must_end_painting(void *user) {
    painting_time *p = user;
    if (!p->has_begun) {
        p->has_begun = true;
        hn_request_add_time(p->r);
    }
    const hn_interrupt interrupt = hn_request_interrupt(p->r);
    return hn_interrupt_ask(&interrupt);
}

void hn_handle_snapshot(hn_request *r) {
    hn_model *model = load_model(r, 0);
    if (!model) {
        return;
    }
    hn_request_add_time(r); // the runs have a time of their own
    const char *methods[HN_COMPARISON_MAX_METHODS], *theme = hn_fields_text(r->json, "theme");
    const cJSON *item;
    int n = 0;
    hn_status ended = HN_OK;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(r->json, "methods")) {
        methods[n++] = item->valuestring;
    }

    // what is left out is chosen by the picture
    painting_time time = {.r = r};
    const hn_interrupt interrupt = {must_end_painting, &time};
    hn_picture_request request = {.methods = methods,
                                  .n_methods = n,
                                  .time = hn_fields_number(r->json, "time", 0),
                                  .width = (int)hn_fields_number(r->json, "width", 0),
                                  .height = (int)hn_fields_number(r->json, "height", 0),
                                  .theme = theme && strcmp(theme, "dark") == 0 ? HN_THEME_DARK
                                                                               : HN_THEME_LIGHT,
                                  .view = hn_fields_text(r->json, "view"),
                                  .cpu_limit = r->context->opts.max_run_cpu,
                                  .stop = hn_request_is_unwanted,
                                  .user = r,
                                  .interrupt = &interrupt};

    // drawn, or refused with the reason
    hn_strbuf png;
    hn_diags diags = {0};
    hn_strbuf_init(&png);
    hn_status status = hn_model_picture(&png, NULL, model, &request, &ended, &diags);
    hn_model_free(model);
    if (status != HN_OK) {
        hn_strbuf_reset(&png);
        hn_reply_diags(r, status, &diags);
        return;
    }
    hn_reply_bytes(r, MHD_HTTP_OK, "image/png", &png);
    hn_reply_header_add(r, "Holonom-Status", "%s", hn_status_name(ended));
}

/// The number of the hint that the query asks for; 0 when it asks for none.
static int hint_asked(const hn_request *r, const hn_exercise *problem, hn_diags *diags,
                      hn_status *status) {
    const char *text = hn_request_query(r, "hint");
    double number = 0;
    if (text &&
        (!hn_plain_number(text, true, &number) || number < 1 || number > problem->n_hints)) {
        *status = hn_diags_add(diags, HN_ERR_INPUT, "/hint", "hint=1",
                               "'%.40s' is not the number of a hint; this exercise has %d", text,
                               problem->n_hints);
        return 0;
    }
    return (int)number;
}

/// One hint, with the numbers of this variant.
static void put_hint(hn_strbuf *b, const hn_exercise *problem, hn_variant *x, int number) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_variant_hint(&text, x, number);
    hn_json_object(b);
    hn_json_put_string(b, "id", problem->id);
    hn_json_put_int(b, "hint", number);
    hn_json_put_int(b, "hints", problem->n_hints);
    hn_json_put_string(b, "text", hn_strbuf_text(&text));
    hn_json_end_object(b);
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

void hn_handle_problem(hn_request *r) {
    hn_exercise *problem = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_status status = hn_shelf_exercise_load(r->context->lib, r->parts[0], &problem, &diags);

    // the exercise's own variant, and a hint to it if one is asked for
    hn_diag diag = {0};
    hn_variant x = {0};
    const int hint = status == HN_OK ? hint_asked(r, problem, &diags, &status) : 0;
    if (status == HN_OK && problem->n_parts) {
        status = hn_variant_init(&x, problem, 0, &diag);
        if (status != HN_OK) {
            hn_diags_add(&diags, status, diag.pointer, NULL, "%s", diag.message);
        }
    }

    // the answer, or why there is none
    if (status == HN_OK) {
        if (hint) {
            put_hint(&b, problem, &x, hint);
        } else if (problem->n_parts) {
            hn_variant_json(&b, &x);
        } else {
            hn_exercise_json(&b, problem, 0, NULL);
        }
        hn_variant_reset(&x);
        hn_reply_json(r, MHD_HTTP_OK, &b);
    } else if (!hn_library_problem_path(r->context->lib, r->parts[0])) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, diags.item[0].hint, "%s", diags.item[0].message);
    } else {
        hn_reply_diags(r, status, &diags);
    }

    hn_exercise_free(problem);
}

void hn_handle_grade(hn_request *r) {
    hn_exercise *problem = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_verdict *v = calloc(1, sizeof *v);
    char *submission =
        cJSON_PrintUnformatted(cJSON_GetObjectItemCaseSensitive(r->json, "submission"));
    hn_status status = v && submission ? hn_shelf_exercise_load(r->context->lib,
                                                                hn_fields_text(r->json, "problem"),
                                                                &problem, &diags)
                                       : HN_ERR_MEMORY;

    // the verdict, or the exercise's fault; for nobody, nothing
    if (status == HN_OK) {
        problem->interrupt = hn_request_interrupt(r);
    }
    HN_THEN(status, hn_grade_json(problem, submission, strlen(submission),
                                  (uint64_t)hn_fields_number(r->json, "seed", 0), v));
    if (status == HN_OK) {
        hn_verdict_json(&b, v);
        hn_reply_json(r, MHD_HTTP_OK, &b);
    } else {
        hn_reply_diags(r, status, &diags);
    }
    hn_exercise_free(problem);
    cJSON_free(submission);
    free(v);
}
