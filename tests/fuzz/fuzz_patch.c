// SPDX-License-Identifier: GPL-3.0-or-later
// A comparison made from a body, or the shipped one changed by PATCH after PATCH (a zero byte
// between them), without its thread: this one does what it would do.
#include "fuzz/fuzz.h"

#include "http/live/patch.h"
#include "http/live/session_state.h"
#include "http/request/context.h"
#include "http/routes/routes.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CHANGES = 4, FRAMES = 2, MOST_STEPS = 5 };

// the linker puts these in the place of the library's (--wrap)
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr, void *(*start)(void *),
                          void *arg);
int __wrap_pthread_detach(pthread_t thread);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr, void *(*start)(void *),
                          void *arg) {
    (void)attr;
    (void)start;
    (void)arg;
    memset(thread, 0, sizeof *thread);
    return 0;
}

int __wrap_pthread_detach(pthread_t thread) {
    (void)thread;
    return 0;
}

static hn_context context;

static void prepare(void) {
    context.lib = hn_fuzz_library();
    context.routes = hn_routes();
    context.opts = hn_http_opts_default();
    context.opts.max_events = 100;
    context.opts.max_event_bytes = 1 << 20;
    context.opts.frame_cpu = 0.02;
}

static void nothing(void *user) {
    (void)user;
}

static hn_request *make_request(const char *verb, const char *path, const char *text, size_t n) {
    hn_request *r = calloc(1, sizeof *r);
    if (!r) {
        hn_fuzz_fail("no memory");
    }
    r->context = &context;
    r->route = hn_route_find(&context.routes, verb, path, r->parts).route;
    r->n_body = n;
    r->body = hn_fuzz_text((const uint8_t *)text, n);
    return r;
}

static void check_reply(hn_request *r) {
    if (r->status == MHD_HTTP_INTERNAL_SERVER_ERROR) {
        hn_fuzz_fail("500: %s", hn_strbuf_text(&r->text));
    }
    if (r->text.n > 0) {
        hn_fuzz_take_json(&r->text);
    }
    hn_request_free(r);
}

static hn_session *make_session(const cJSON *body, hn_scene_request *scene, const char **methods,
                                int n) {
    const hn_session_request order = {.scene = scene,
                                      .methods = methods,
                                      .n_methods = n,
                                      .frame_dt = hn_fields_number(body, "frame_dt", 0),
                                      .duration = hn_fields_number(body, "duration", 0),
                                      .speed = hn_fields_number(body, "speed", 1),
                                      .stopping = &context.stopping};
    hn_session *session = NULL;
    hn_diags diags = {0};
    hn_fuzz_check(
        hn_session_create(&context.opts, context.lib, &order, nothing, NULL, &session, &diags),
        &diags);
    return session;
}

static void end_session(hn_session *session) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    for (int k = 0; k < FRAMES && session->state != HN_SESSION_FINISHED; k++) {
        hn_session_advance(session);
    }
    hn_session_json(&b, session);
    hn_fuzz_take_json(&b);
    session->refs = 1; // its thread's is given up with ours
    hn_session_release(session);
}

static void make_from_body(const char *text, size_t n) {
    hn_request *r = make_request("POST", "/api/v1/comparisons", text, n);
    hn_scene_request scene = {0};
    hn_diags diags = {0};
    if (hn_request_read_body(r) && hn_scene_request_read(&scene, r->json, &diags) == HN_OK) {
        const char *methods[HN_COMPARISON_MAX_METHODS];
        int n_methods = 0;
        const cJSON *item;
        cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(r->json, "methods")) {
            methods[n_methods++] = item->valuestring;
        }
        hn_session *session = make_session(r->json, &scene, methods, n_methods);
        if (session) {
            end_session(session);
        }
    }
    hn_scene_request_reset(&scene);
    check_reply(r);
}

/// A request for many steps would only cost time.
static void apply(hn_session *session, const char *text, size_t n) {
    hn_request *r = make_request("PATCH", "/api/v1/comparisons/x", text, n);
    cJSON *body = cJSON_ParseWithLength(text, n);
    const double steps = hn_fields_number(body, "step", 0);
    cJSON_Delete(body);
    if (steps <= MOST_STEPS) {
        hn_session_apply(session, r);
    }
    check_reply(r);
}

/// Returns whether one of the changes passes the checks of its body. The others reach nothing of
/// the comparison, which costs most of the time of an input.
static bool has_sound_change(const char *text, const char *end) {
    bool found = false;
    for (const char *at = text; at < end && !found; at += strlen(at) + 1) {
        hn_request *r = make_request("PATCH", "/api/v1/comparisons/x", at, strlen(at));
        found = hn_request_read_body(r);
        check_reply(r);
    }
    return found;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2) {
        return 0;
    }
    if (!context.lib) {
        prepare();
    }
    char *text = hn_fuzz_text(data + 1, size - 1);
    if (data[0] % 2) {
        make_from_body(text, size - 1);
        free(text);
        return 0;
    }

    // changes, one after the other
    if (!has_sound_change(text, text + size - 1)) {
        free(text);
        return 0;
    }
    const char *methods[] = {"baumgarte@rk4:h=1e-2", "index1@rk4:h=1e-2"};
    char name[] = "pendulum"; // an input costs the compiling of its scene
    hn_scene_request scene = {.name = name};
    hn_session *session = make_session(NULL, &scene, methods, 2);
    const char *at = text, *end = text + size - 1;
    for (int i = 0; session && i < MOST_CHANGES && at < end; i++) {
        const size_t n = strlen(at);
        apply(session, at, n);
        at += n + 1;
    }
    end_session(session);
    free(text);
    return 0;
}
