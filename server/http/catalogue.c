#include "http/catalogue.h"

#include "build.h"
#include "http/server_internal.h"
#include "integrators/spec.h"
#include "problem_shelf.h"
#include "render/look.h"
#include "session/comparison.h"
#include "session/lists.h"
#include "session/model.h"

#include <stdio.h>
#include <string.h>

/// A bound with what it bounds, for the index.
static void put_limits(hn_strbuf *b, const hn_http_opts *o) {
    const struct {
        const char *name;
        double value;
    } rows[] = {{"body_bytes", (double)o->max_body},
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
                {"long_requests_at_once", o->pool},
                {"long_requests_waiting", o->queue},
                {"pause_without_reader_s", o->idle_pause},
                {"expiry_untouched_s", o->expiry},
                {"connection_timeout_s", o->connection_timeout},
                {"json_depth", 64}};
    hn_json_key(b, "limits");
    hn_json_object(b);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_json_put_number(b, rows[i].name, rows[i].value);
    }
    hn_json_end_object(b);
}

static void put_routes(hn_strbuf *b) {
    hn_json_key(b, "routes");
    hn_json_array(b);
    for (int i = 0; i < hn_route_count(); i++) {
        const hn_route *route = hn_route_at(i);
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
                                           {"comparisons", "/api/v1/comparisons"},
                                           {"errors", "/api/v1/errors"},
                                           {"page", "/"}};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_string(&b, "name", "holonom");
    hn_json_put_string(&b, "version", HN_VERSION);
    hn_json_put_string(&b, "build", HN_BUILD);
    hn_json_key(&b, "links");
    hn_json_object(&b);
    for (size_t i = 0; i < sizeof links / sizeof *links; i++) {
        hn_json_put_string(&b, links[i][0], links[i][1]);
    }
    hn_json_end_object(&b);
    put_limits(&b, &r->server->opts);
    put_routes(&b);
    hn_json_end_object(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_health(hn_request *r) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_string(&b, "status", "ok");
    hn_json_put_string(&b, "version", HN_VERSION);
    hn_json_put_string(&b, "build", HN_BUILD);
    hn_json_end_object(&b);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_scenes(hn_request *r) {
    hn_kept_text *kept = &r->server->scenes;
    hn_strbuf b;
    hn_strbuf_init(&b);
    pthread_mutex_lock(&kept->lock);
    if (!kept->text) {
        hn_scenes_json(&b, r->server->lib);
        kept->text = hn_strbuf_take(&b);
    }
    if (kept->text) {
        hn_strbuf_add(&b, kept->text);
    } else {
        b.failed = 1;
    }
    pthread_mutex_unlock(&kept->lock);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

typedef struct query_settings {
    hn_scene_order *order;
    hn_diags *diags;
} query_settings;

/// One argument set=l1:1.2 (or l1=1.2).
static hn_status see_setting(void *user, const char *value) {
    query_settings *q = user;
    size_t n = strcspn(value, ":=");
    char *end;
    double x = value[n] ? strtod(value + n + 1, &end) : 0;
    if (!value[n] || n == 0 || end == value + n + 1 || *end) {
        return hn_diags_add(q->diags, HN_ERR_INPUT, "/settings", "set=l1:1.2",
                            "'%.80s' is not a parameter and a number", value);
    }
    return hn_scene_order_add(q->order, value, n, x, q->diags);
}

void hn_handle_scene(hn_request *r) {
    hn_diags diags = {0};
    hn_scene_order order = {.name = strdup(r->parts[0])};
    hn_model *model = NULL;
    query_settings settings = {&order, &diags};
    if (order.name && !hn_library_scene_path(r->server->lib, order.name)) {
        const char *near = hn_nearest_name(order.name, hn_library_scene_ids(r->server->lib),
                                           hn_library_n_scenes(r->server->lib));
        char hint[HN_DIAG_HINT];
        snprintf(hint, sizeof hint, near ? "did you mean '%s'?" : "GET /api/v1/scenes%s",
                 near ? near : " lists them");
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, hint, "no scene is called '%.80s'", order.name);
        hn_scene_order_reset(&order);
        return;
    }
    hn_status status =
        order.name ? hn_request_each_query(r, "set", see_setting, &settings) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        status = hn_scene_order_load(&order, r->server->lib, 1, &model, &diags);
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (status == HN_OK) {
        hn_model_json(&b, model);
        hn_reply_json(r, MHD_HTTP_OK, &b);
    } else {
        hn_reply_diags(r, status, &diags);
    }
    hn_model_free(model);
    hn_scene_order_reset(&order);
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
    write(&b, r->server->lib);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}

void hn_handle_lessons(hn_request *r) {
    reply_list(r, hn_lessons_json);
}

void hn_handle_problems(hn_request *r) {
    reply_list(r, hn_shelf_problems_json);
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
