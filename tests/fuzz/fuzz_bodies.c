// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of requests. The first byte chooses the route; the handler gets the request without a
// socket. Routes whose handlers begin threads are entered where their work begins.
#include "fuzz/fuzz.h"

#include "http/request/context.h"
#include "http/request/request.h"
#include "http/routes/routes.h"
#include "http/runs/run_question.h"
#include "http/studies/study_work.h"
#include "session/compare/run_doc.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const PATHS[] = {"terms",     "assemble", "inspect", "equations", "drag",
                                    "snapshots", "grade",    "export",  "runs",      "studies"};
enum { N_PATHS = sizeof PATHS / sizeof *PATHS };

static hn_context context;

static void prepare(void) {
    context.lib = hn_fuzz_library();
    context.routes = hn_routes();
    context.opts = hn_http_opts_default();
    context.opts.max_run_cpu = 0.1;
    context.opts.max_samples = 300;
    context.opts.max_numbers = 100000;
}

static void run(const cJSON *body) {
    hn_run_question q = {0};
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_status status = hn_run_question_read(&q, body, context.lib, &diags), ended;
    if (status == HN_OK) {
        status = hn_scene_request_load(&q.scene, context.lib, 0, (hn_interrupt){NULL, NULL}, &model,
                                       &diags);
    }
    if (status == HN_OK) {
        const hn_run_request request = {.method = q.methods[0],
                                        .time = q.time,
                                        .at = q.at,
                                        .n_at = q.n_at,
                                        .every = q.every,
                                        .max_samples = context.opts.max_samples,
                                        .max_numbers = context.opts.max_numbers,
                                        .max_steps = 200,
                                        .reactions = q.reactions,
                                        .raw_lambda = q.raw_lambda};
        status = hn_model_run_json(&b, model, &request, &ended, &diags);
    }
    hn_fuzz_check(status, &diags);
    if (status == HN_OK) {
        hn_fuzz_take_json(&b);
    }
    hn_strbuf_reset(&b);
    hn_model_free(model);
    hn_run_question_reset(&q);
}

static void study(const cJSON *body) {
    hn_study_work work = {.lib = context.lib, .stopping = &context.stopping};
    hn_diags diags = {0};
    hn_fuzz_check(hn_study_work_read(&work, body, &context.opts, &diags), &diags);
    hn_study_work_reset(&work);
}

static void serve(hn_request *r) {
    if (!hn_request_read_body(r)) {
        return;
    }
    if (strstr(r->route->path, "/runs")) {
        run(r->json);
    } else if (strstr(r->route->path, "/studies")) {
        study(r->json);
    } else {
        r->route->handle(r);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char path[32];
    hn_request *r = size > 1 ? calloc(1, sizeof *r) : NULL;
    if (!r) {
        return 0;
    }
    if (!context.lib) {
        prepare();
    }
    snprintf(path, sizeof path, "/api/v1/%s", PATHS[data[0] % N_PATHS]);
    r->context = &context;
    r->route = hn_route_find(&context.routes, "POST", path, r->parts).route;
    snprintf(r->path, sizeof r->path, "%s", path);
    r->n_body = size - 1;
    r->body = hn_fuzz_text(data + 1, size - 1);
    serve(r);
    if (r->status == MHD_HTTP_INTERNAL_SERVER_ERROR) {
        hn_fuzz_fail("500: %s", hn_strbuf_text(&r->text));
    }
    if (r->media_type && strstr(r->media_type, "json")) {
        hn_fuzz_take_json(&r->text);
    }
    hn_request_free(r);
    return 0;
}
