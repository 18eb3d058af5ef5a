// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/catalogue.h"

#include "base/suggest.h"
#include "integrators/method/catalogue.h"

#include "build.h"
#include "grade/exercise_shelf.h"
#include "http/ground/plain_number.h"
#include "http/live/comparisons.h"
#include "http/request/context.h"
#include "http/request/request.h"
#include "http/request/scene_request.h"
#include "http/studies/studies.h"
#include "http/studies/study_fields.h"
#include "integrators/method/method_spec.h"
#include "lesson/lesson.h"
#include "render/look.h"
#include "session/compare/comparison.h"
#include "session/kinds/job.h"
#include "session/model/lists.h"
#include "session/model/model.h"
#include "session/model/model_json.h"
#include "session/references/reference_doc.h"
#include "session/references/reference_store.h"
#include "session/references/references.h"
#include "study/incidents/kinds.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// A bound with what it bounds, for the index.
static void put_limits(hn_strbuf *b, const hn_http_opts *o) {
    const struct {
        const char *name;
        double value;
    } rows[] = {{"body_bytes", (double)o->max_body},
                {"address_bytes", HN_MAX_ADDRESS},
                {"address_parameters", HN_MAX_PARAMETERS},
                {"connections", o->max_connections},
                {"comparisons", o->max_comparisons},
                {"streams", o->max_streams},
                {"events_kept", o->max_events},
                {"event_bytes_kept", (double)o->max_event_bytes},
                {"methods", HN_COMPARISON_MAX_METHODS},
                {"comparison_duration_s", o->max_duration},
                {"run_samples", (double)o->max_samples},
                {"run_cpu_s", o->max_run_cpu},
                {"frame_cpu_s", o->frame_cpu},
                {"studies_at_once", o->max_studies},
                {"studies_kept", HN_STUDIES_KEPT},
                {"long_requests_at_once", o->pool},
                {"long_requests_waiting", o->queue},
                {"long_requests_set_aside", o->aside},
                {"quick_requests_at_once", o->quick_pool},
                {"quick_requests_waiting", o->quick_queue},
                {"share_of_one_client", o->client_share},
                {"unread_bytes", (double)o->max_unread},
                {"answer_numbers", (double)o->max_numbers},
                {"pause_without_reader_s", o->idle_pause},
                {"expiry_untouched_s", o->expiry},
                {"expiry_readers_left_s", o->orphan_expiry},
                {"head_deadline_s", o->head_deadline},
                {"request_deadline_s", o->request_deadline},
                {"connection_timeout_s", o->connection_timeout},
                {"json_depth", 64}};

    // as members, for scripts
    hn_json_key(b, "limits");
    hn_json_object(b);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_json_put_number(b, rows[i].name, rows[i].value);
    }
    hn_json_end_object(b);
}

static void put_routes(hn_strbuf *b, const hn_route_table *table) {
    hn_json_key(b, "routes");
    hn_json_array(b);
    for (int i = 0; i < table->n; i++) {
        const hn_route *route = &table->row[i];
        hn_json_object(b);
        hn_json_put_string(b, "method", route->method);
        hn_json_put_string(b, "path", route->path);
        hn_json_put_string(b, "summary", route->summary);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

void hn_handle_index(hn_request *r) {
    static const char *const links[][2] = {{"self", "/api/v1/"},
                                           {"openapi", "/api/v1/openapi.json"},
                                           {"scenes", "/api/v1/scenes"},
                                           {"methods", "/api/v1/methods"},
                                           {"lessons", "/api/v1/lessons"},
                                           {"problems", "/api/v1/problems"},
                                           {"runs", "/api/v1/runs"},
                                           {"comparisons", "/api/v1/comparisons"},
                                           {"studies", "/api/v1/studies"},
                                           {"errors", "/api/v1/errors"},
                                           {"page", "/"}};

    // who answers, and where everything is
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_string(&b, "name", "holonom");
    hn_json_put_string(&b, "version", HN_VERSION);
    hn_json_put_string(&b, "build", hn_build_name());
    hn_json_key(&b, "links");
    hn_json_object(&b);
    for (size_t i = 0; i < sizeof links / sizeof *links; i++) {
        hn_json_put_string(&b, links[i][0], links[i][1]);
    }
    hn_json_end_object(&b);

    // what a page would otherwise copy: limits, kinds of studies, incidents
    put_limits(&b, &r->context->opts);
    hn_json_key(&b, "studies");
    hn_job_kinds_json(&b, hn_study_fields_time_limit());
    put_routes(&b, &r->context->routes);
    hn_json_key(&b, "incidents");
    hn_incident_kinds_json(&b);
    hn_json_end_object(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_health(hn_request *r) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_string(&b, "status", "ok");
    hn_json_put_string(&b, "version", HN_VERSION);
    hn_json_put_string(&b, "build", hn_build_name());
    hn_json_end_object(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

static void put_scenes(hn_strbuf *b, const hn_context *c) {
    hn_scenes_json(b, c->lib);
}

void hn_handle_scenes(hn_request *r) {
    hn_reply_kept(r, &r->context->scenes, put_scenes);
}

typedef struct query_settings {
    hn_scene_request *order;
    hn_diags *diags;
} query_settings;

/// One argument set=l1:1.2 (or l1=1.2).
static hn_status see_setting(void *user, const char *value) {
    query_settings *q = user;
    size_t n = strcspn(value, ":=");
    double x = 0;
    if (!value[n] || n == 0 || !hn_plain_number(value + n + 1, false, &x)) {
        return hn_diags_add(q->diags, HN_ERR_INPUT, "/parameters", "set=l1:1.2",
                            "'%.80s' is not of the form parameter:number", value);
    }
    return hn_scene_request_add(q->order, value, n, x, q->diags);
}

hn_model *hn_catalogue_load_scene(hn_request *r, bool allow_open) {
    hn_diags diags = {0};
    hn_scene_request order = {.name = strdup(r->parts[0])};
    hn_model *model = NULL;
    query_settings settings = {&order, &diags};
    if (order.name && !hn_library_scene_path(r->context->lib, order.name)) {
        char hint[HN_DIAG_HINT];
        hn_suggest(hint, order.name, hn_library_scene_ids(r->context->lib),
                   hn_library_n_scenes(r->context->lib), "GET /api/v1/scenes lists them");
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, hint, "no scene is called '%.80s'", order.name);
        hn_scene_request_reset(&order);
        return NULL;
    }

    // with the parameters of the query
    hn_status status =
        order.name ? hn_request_each_query(r, "set", see_setting, &settings) : HN_ERR_MEMORY;
    HN_THEN(status, hn_scene_request_load(&order, r->context->lib, allow_open,
                                          hn_request_interrupt(r), &model, &diags));
    hn_scene_request_reset(&order);
    if (status != HN_OK) {
        hn_reply_diags(r, status, &diags);
        return NULL;
    }
    return model;
}

void hn_handle_scene(hn_request *r) {
    hn_model *model = hn_catalogue_load_scene(r, 1);
    if (model) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_model_json(&b, model);
        hn_reply_json(r, MHD_HTTP_OK, &b);
        hn_model_free(model);
    }
}

// ---- reference solutions ----

/// A reference is tried by up to three means; each gets its part of the time of one request.
enum { MEANS = 3 };

/// A number of the query above 0 and at most `most`, NaN when it was not given.
static hn_status read_number(const hn_request *r, const char *name, double most, double *out,
                             hn_diags *diags) {
    const char *text = hn_request_query(r, name);
    char pointer[32];
    *out = (double)NAN;
    if (text && (!hn_plain_number(text, false, out) || !(*out > 0) || !(*out <= most))) {
        snprintf(pointer, sizeof pointer, "/%s", name);
        return hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL,
                            "'%.40s' is not a time above 0 and at most %g s", text, most);
    }
    return HN_OK;
}

typedef struct reference_order {
    hn_ref_request request;
    double every; ///< NaN: no motion between
    hn_walk_limits limits;
} reference_order;

static hn_status read_reference_order(hn_request *r, reference_order *o, hn_diags *diags) {
    const char *compute = hn_request_query(r, "compute");
    o->limits = (hn_walk_limits){r->context->opts.max_run_cpu / MEANS, hn_request_is_unwanted, r};
    o->request = hn_ref_request_default();
    o->request.opts.limits = o->limits;
    o->request.only_stored = !compute || strcmp(compute, "true") != 0;
    if (compute && strcmp(compute, "true") != 0 && strcmp(compute, "false") != 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/compute", "compute=true",
                            "'%.40s' is neither true nor false", compute);
    }
    const hn_status status =
        read_number(r, "time", r->context->opts.max_duration, &o->request.time, diags);
    return status == HN_OK
               ? read_number(r, "every", r->context->opts.max_duration, &o->every, diags)
               : status;
}

static hn_status write_reference(hn_strbuf *b, const hn_model *model, const reference_order *o,
                                 hn_diags *diags) {
    hn_ref *ref = NULL;
    hn_ref_source source;
    hn_status status = hn_reference_get(model, &o->request, &ref, &source, diags);
    if (status == HN_OK && isnan(o->every)) {
        hn_reference_json(b, model, ref, source);
    } else if (status == HN_OK) {
        status = hn_reference_motion_json(b, model, ref, source, o->every, &o->limits, diags);
    }
    hn_ref_free(ref);
    return status;
}

void hn_handle_reference(hn_request *r) {
    hn_model *model = hn_catalogue_load_scene(r, 0);
    reference_order order;
    hn_diags diags = {0};
    hn_strbuf b;
    if (!model) {
        return;
    }
    hn_strbuf_init(&b);
    hn_status status = read_reference_order(r, &order, &diags);
    HN_THEN(status, write_reference(&b, model, &order, &diags));
    hn_model_free(model);
    if (status == HN_OK) {
        hn_reply_json(r, MHD_HTTP_OK, &b);
        return;
    }

    // one that is not stored is not found; it may be computed
    hn_strbuf_reset(&b);
    if (status == HN_ERR_UNSUPPORTED && order.request.only_stored) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, "compute=true computes it, within run_cpu_s",
                         "%s", diags.item[0].message);
        return;
    }
    hn_reply_diags(r, status, &diags);
}

/// Handlers whose whole work is one document.
static void reply_document(hn_request *r, void (*write)(hn_strbuf *b)) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    write(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_methods(hn_request *r) {
    reply_document(r, hn_methods_json);
}

void hn_handle_look(hn_request *r) {
    reply_document(r, hn_look_json);
}

static void reply_list(hn_request *r, void (*write)(hn_strbuf *b, const hn_library *lib)) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    write(&b, r->context->lib);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_lessons(hn_request *r) {
    reply_list(r, hn_lessons_json);
}

void hn_handle_lesson(hn_request *r) {
    cJSON *lesson = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_lesson_load(r->context->lib, r->parts[0], &lesson, &diags);
    if (status == HN_ERR_INPUT && strcmp(diags.item[0].pointer, "/lesson") == 0) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, diags.item[0].hint, "%s", diags.item[0].message);
        return;
    }
    if (status != HN_OK) {
        hn_reply_diags(r, status, &diags);
        return;
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_lesson_json(&b, lesson);
    cJSON_Delete(lesson);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_problems(hn_request *r) {
    reply_list(r, hn_shelf_exercises_json);
}

static void put_error(hn_strbuf *b, const hn_http_problem_info *info) {
    hn_json_object(b);
    hn_json_put_string(b, "code", info->code);
    hn_json_put_int(b, "status", info->status);
    hn_json_put_string(b, "title", info->title);
    hn_json_put_string(b, "about", info->about);
    hn_json_end_object(b);
}

void hn_handle_errors(hn_request *r) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_key(&b, "errors");
    hn_json_array(&b);
    for (int i = 0; i < HN_PROBLEM_COUNT; i++) {
        put_error(&b, hn_http_problem_get_info((hn_http_problem)i));
    }
    hn_json_end_array(&b);
    hn_json_end_object(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_error(hn_request *r) {
    for (int i = 0; i < HN_PROBLEM_COUNT; i++) {
        const hn_http_problem_info *info = hn_http_problem_get_info((hn_http_problem)i);
        if (strcmp(info->code, r->parts[0]) == 0) {
            hn_strbuf b;
            hn_strbuf_init(&b);
            put_error(&b, info);
            hn_reply_json(r, MHD_HTTP_OK, &b);
            return;
        }
    }
    hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, "GET /api/v1/errors lists them",
                     "no kind of error is called '%.80s'", r->parts[0]);
}
