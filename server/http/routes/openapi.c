// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/openapi.h"

#include "build.h"
#include "http/request/context.h"
#include "http/request/request.h"
#include "http/routes/field_schema.h"
#include "http/routes/openapi_schemas.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// ---- tags ----

static const struct {
    const char *name, *about;
} TAGS[] = {
    {"server", "The server itself: links, limits, health, this description."},
    {"scenes", "Shipped mechanisms, and their reference solutions."},
    {"methods", "Formulations and integrators, with their options."},
    {"look", "Colours, dashes and markers with which methods are drawn."},
    {"lessons", "Lessons with their scenes."},
    {"problems", "Exercises that can be graded."},
    {"grade", "Grading of submissions."},
    {"errors", "The kinds of problem documents."},
    {"terms", "The terms M, f, J, gamma of the equations at one state."},
    {"assemble", "Consistent starting values."},
    {"drag", "Closed configurations near a target."},
    {"languages", "Languages of export."},
    {"export", "Mechanisms as programs."},
    {"inspect", "Sizes, tree, loops and rank of a mechanism."},
    {"equations", "The equations of motion."},
    {"runs", "Runs of one or several methods: the same request has the same id."},
    {"snapshots", "Pictures."},
    {"comparisons", "Several methods side by side, as a stream of frames."},
    {"studies", "Long computations: work-precision, stability, error budget."},
};
enum { N_TAGS = sizeof TAGS / sizeof *TAGS };

/// The tag of a path: its first word behind /api/v1/, or that of the server itself.
static const char *find_tag(const char *path) {
    const char *word = strncmp(path, "/api/v1/", 8) == 0 ? path + 8 : "";
    const size_t n = strcspn(word, "/");
    for (int i = 0; i < N_TAGS; i++) {
        if (strlen(TAGS[i].name) == n && memcmp(TAGS[i].name, word, n) == 0) {
            return TAGS[i].name;
        }
    }
    return TAGS[0].name;
}

static void put_tags(hn_strbuf *b) {
    hn_json_key(b, "tags");
    hn_json_array(b);
    for (int i = 0; i < N_TAGS; i++) {
        hn_json_object(b);
        hn_json_put_string(b, "name", TAGS[i].name);
        hn_json_put_string(b, "description", TAGS[i].about);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

// ---- paths ----

static void put_parameter(hn_strbuf *b, const char *name, size_t n_name, const char *in,
                          const char *type, const char *about) {
    hn_strbuf copy;
    hn_strbuf_init(&copy);
    hn_strbuf_add_n(&copy, name, n_name);
    hn_json_object(b);
    hn_json_put_string(b, "name", hn_strbuf_text(&copy));
    hn_json_put_string(b, "in", in);
    hn_json_put_bool(b, "required", strcmp(in, "path") == 0);
    if (about) {
        hn_json_put_string(b, "description", about);
    }
    hn_json_key(b, "schema");
    hn_json_object(b);
    hn_json_put_string(b, "type", type);
    if (strcmp(type, "array") == 0) {
        hn_json_key(b, "items");
        hn_json_object(b);
        hn_json_put_string(b, "type", "string");
        hn_json_end_object(b);
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
    hn_strbuf_reset(&copy);
}

static void put_parameters(hn_strbuf *b, const hn_route *route) {
    hn_json_key(b, "parameters");
    hn_json_array(b);
    for (const char *at = strchr(route->path, '{'); at; at = strchr(at + 1, '{')) {
        put_parameter(b, at + 1, strcspn(at + 1, "}"), "path", "string", NULL);
    }
    for (const hn_route_query *q = route->query; q && q->name; q++) {
        put_parameter(b, q->name, strlen(q->name), "query", q->type, q->about);
    }
    hn_json_end_array(b);
}

static void put_reference(hn_strbuf *b, const char *schema) {
    char place[96];
    snprintf(place, sizeof place, "#/components/schemas/%s", schema);
    hn_json_object(b);
    hn_json_put_string(b, "$ref", place);
    hn_json_end_object(b);
}

/// Meanings of statuses that say more than that all is well.
static const struct {
    const char *schema, *verb, *status, *about;
} STATUSES[] = {
    {"Run", "POST", "201", "The run is new and has ended: the whole document, with its samples."},
    {"Run", "POST", "200", "The same request was made before: its document, not computed again."},
    {"Run", "POST", "202",
     "The run has not ended within wait (25 s when left out; wait=0 answers at once): its id, "
     "state and progress. It goes on; GET its Location, with wait, until state is finished."},
    {"Run", "GET", "200",
     "Where it has ended the summary, without samples; otherwise its state and progress."},
};

static const char *about_answer(const hn_route *route, const char *status) {
    for (size_t i = 0; route->schema && i < sizeof STATUSES / sizeof *STATUSES; i++) {
        if (strcmp(STATUSES[i].schema, route->schema) == 0 &&
            strcmp(STATUSES[i].verb, route->method) == 0 &&
            strcmp(STATUSES[i].status, status) == 0) {
            return STATUSES[i].about;
        }
    }
    return route->summary;
}

/// One answer that is no problem document.
static void put_answer(hn_strbuf *b, const hn_route *route, const char *status) {
    hn_json_key(b, status);
    hn_json_object(b);
    hn_json_put_string(b, "description", about_answer(route, status));
    if (route->schema) {
        char type[64];
        hn_json_key(b, "content");
        hn_json_object(b);
        for (int i = 0; hn_route_media_type(route, i, type); i++) {
            hn_json_key(b, type);
            hn_json_object(b);
            hn_json_key(b, "schema");
            put_reference(b, i == 0 ? route->schema : "Text");
            hn_json_end_object(b);
        }
        hn_json_end_object(b);
    }
    hn_json_end_object(b);
}

/// Returns whether this route starts a study, or changes one.
static bool takes_study(const hn_route *route) {
    static const char STUDIES[] = "/api/v1/studies";
    return strncmp(route->path, STUDIES, sizeof STUDIES - 1) == 0 && route->fields;
}

/// 1 when a request to this route may be answered so.
static bool may_answer(const hn_route *route, hn_http_problem kind) {
    switch (kind) {
    // the address and the body
    case HN_PROBLEM_NOT_FOUND:
        return strchr(route->path, '{') && strcmp(route->method, "DELETE") != 0;
    case HN_PROBLEM_BAD_JSON:
    case HN_PROBLEM_TOO_LARGE:
    case HN_PROBLEM_MEDIA_TYPE:
        return route->fields != NULL;
    case HN_PROBLEM_INPUT:
        return route->fields != NULL || route->query != NULL;
    case HN_PROBLEM_NOT_ACCEPTABLE:
        return route->schema != NULL;

    // places that are taken, and who may ask
    case HN_PROBLEM_CONFLICT:
        return route->work == HN_WORK_OWN || strstr(route->path, "/samples") != NULL ||
               (route->schema && strcmp(route->schema, "Run") == 0) ||
               (takes_study(route) && strchr(route->path, '{'));
    case HN_PROBLEM_BUSY:
        return route->work != HN_WORK_LIGHT || strstr(route->path, "/events") != NULL;
    case HN_PROBLEM_STUDIES_BUSY:
        return takes_study(route);
    case HN_PROBLEM_TOKEN:
        return strcmp(route->path, "/healthz") != 0;
    case HN_PROBLEM_METHOD:
        return false; // no operation of this document
    default:
        return true;
    }
}

/// Kinds that share a status share the answer of the first.
static int is_answer(const hn_route *route, int kind) {
    const unsigned status = hn_http_problem_get_info((hn_http_problem)kind)->status;
    for (int k = 0; k < kind; k++) {
        if (hn_http_problem_get_info((hn_http_problem)k)->status == status &&
            may_answer(route, (hn_http_problem)k)) {
            return 0;
        }
    }
    return may_answer(route, (hn_http_problem)kind);
}

/// Problem documents by status.
static void put_problems(hn_strbuf *b, const hn_route *route) {
    for (int k = 0; k < HN_PROBLEM_COUNT; k++) {
        const hn_http_problem_info *info = hn_http_problem_get_info((hn_http_problem)k);
        if (!is_answer(route, k)) {
            continue;
        }
        char status[8], place[96];
        snprintf(status, sizeof status, "%u", info->status);
        snprintf(place, sizeof place, "#/components/responses/%s", info->code);
        hn_json_key(b, status);
        hn_json_object(b);
        hn_json_put_string(b, "$ref", place);
        hn_json_end_object(b);
    }
}

static void put_answers(hn_strbuf *b, const hn_route *route) {
    hn_json_key(b, "responses");
    hn_json_object(b);
    for (const char *at = route->status; *at; at += strspn(at, " ")) {
        char status[8];
        const size_t n = strcspn(at, " ");
        snprintf(status, sizeof status, "%.*s", (int)n, at);
        put_answer(b, route, status);
        at += n;
    }
    put_problems(b, route);
    hn_json_key(b, "default");
    hn_json_raw(b, "{\"$ref\":\"#/components/responses/Problem\"}");
    hn_json_end_object(b);
}

/// "post_comparisons_id": the verb and the words of the path.
static void put_operation_id(hn_strbuf *b, const hn_route *route) {
    char id[128];
    size_t n = 0;
    for (const char *p = route->method; *p; p++) {
        id[n++] = (char)(*p | 0x20);
    }
    for (const char *p = route->path; *p && n + 1 < sizeof id; p++) {
        int is_word = (*p >= 'a' && *p <= 'z') || (*p >= '0' && *p <= '9');
        if (is_word || (id[n - 1] != '_')) {
            id[n++] = is_word ? *p : '_';
        }
    }
    n -= id[n - 1] == '_';
    id[n] = 0;
    hn_json_put_string(b, "operationId", id);
}

static void put_request_body(hn_strbuf *b, const hn_route *route) {
    hn_json_key(b, "requestBody");
    hn_json_object(b);
    hn_json_put_bool(b, "required", 1);
    hn_json_key(b, "content");
    hn_json_object(b);
    hn_json_key(b, "application/json");
    hn_json_object(b);
    hn_json_key(b, "schema");
    hn_fields_schema_json(b, route->fields);
    if (route->example) {
        hn_json_key(b, "example");
        hn_json_raw(b, route->example);
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
    hn_json_end_object(b);
}

static void put_operation(hn_strbuf *b, const hn_route *route) {
    char verb[8] = "";
    for (size_t i = 0; route->method[i] && i < sizeof verb - 1; i++) {
        verb[i] = (char)(route->method[i] | 0x20);
    }
    hn_json_key(b, verb);
    hn_json_object(b);
    hn_json_put_string(b, "summary", route->summary);
    hn_json_put_string(b, "description", route->summary);
    hn_json_key(b, "tags");
    hn_json_array(b);
    hn_json_string(b, find_tag(route->path));
    hn_json_end_array(b);
    put_operation_id(b, route);
    put_parameters(b, route);
    if (route->fields) {
        put_request_body(b, route);
    }
    put_answers(b, route);
    hn_json_end_object(b);
}

/// 1 when an earlier row has the same path: its verbs are written together.
static bool is_written(const hn_route_table *table, int i) {
    for (int k = 0; k < i; k++) {
        if (strcmp(table->row[k].path, table->row[i].path) == 0) {
            return true;
        }
    }
    return false;
}

/// A path without a slash at its end; such an address is redirected to the one with it.
static void put_path(hn_strbuf *b, const char *path) {
    char trimmed[HN_HEADER_TEXT];
    const size_t n = strlen(path);
    snprintf(trimmed, sizeof trimmed, "%.*s", (int)(n - (n > 1 && path[n - 1] == '/')), path);
    hn_json_key(b, trimmed);
}

static void put_paths(hn_strbuf *b, const hn_route_table *table) {
    hn_json_key(b, "paths");
    hn_json_object(b);
    for (int i = 0; i < table->n; i++) {
        if (is_written(table, i)) {
            continue;
        }
        put_path(b, table->row[i].path);
        hn_json_object(b);
        for (int k = i; k < table->n; k++) {
            if (strcmp(table->row[k].path, table->row[i].path) == 0) {
                put_operation(b, &table->row[k]);
            }
        }
        hn_json_end_object(b);
    }
    hn_json_end_object(b);
}

/// One answer for each kind of problem document, and one for any.
static void put_problem_answers(hn_strbuf *b, const hn_route_table *table) {
    static const char content[] = "{\"application/problem+json\":{\"schema\":"
                                  "{\"$ref\":\"#/components/schemas/Problem\"}}}";
    hn_json_key(b, "responses");
    hn_json_object(b);
    for (int k = -1; k < HN_PROBLEM_COUNT; k++) {
        const hn_http_problem_info *info =
            k < 0 ? NULL : hn_http_problem_get_info((hn_http_problem)k);
        int used = k < 0;
        for (int i = 0; i < table->n && !used; i++) {
            used = is_answer(&table->row[i], k);
        }
        if (!used) {
            continue;
        }

        // the document says what the kind means
        hn_json_key(b, info ? info->code : "Problem");
        hn_json_object(b);
        hn_json_put_string(b, "description", info ? info->about : "A problem document.");
        hn_json_key(b, "content");
        hn_json_raw(b, content);
        hn_json_end_object(b);
    }
    hn_json_end_object(b);
}

static void put_components(hn_strbuf *b, const hn_route_table *table, int with_token) {
    hn_json_key(b, "components");
    hn_json_object(b);
    hn_json_key(b, "schemas");
    hn_json_object(b);
    hn_openapi_put_schemas(b);
    hn_json_end_object(b);
    put_problem_answers(b, table);
    if (with_token) {
        hn_json_key(b, "securitySchemes");
        hn_json_raw(b, "{\"token\":{\"type\":\"http\",\"scheme\":\"bearer\",\"description\":"
                       "\"The token that the server printed at its start.\"}}");
    }
    hn_json_end_object(b);
}

/// Writes the whole document.
static void put_document(hn_strbuf *b, const hn_context *c) {
    hn_json_object(b);
    hn_json_put_string(b, "openapi", "3.1.0");
    hn_json_key(b, "info");
    hn_json_object(b);
    hn_json_put_string(b, "title", "holonom");
    hn_json_put_string(b, "version", hn_build_name());
    hn_json_put_string(b, "summary",
                       "Mechanisms with closed loops, simulated by several methods at once");
    hn_json_put_string(
        b, "description",
        "Simulates mechanisms with closed loops by several methods at once. Errors are "
        "problem documents (RFC 9457); JSON never holds NaN or Infinity; limits are in "
        "the index, /api/v1/.");
    hn_json_key(b, "license");
    hn_json_raw(b, "{\"name\":\"GPL-3.0-or-later\",\"identifier\":\"GPL-3.0-or-later\"}");
    hn_json_key(b, "contact");
    hn_json_raw(b, "{\"name\":\"the operator of this server\"}");
    hn_json_end_object(b);

    // addresses are relative, so that a prefix of a proxy holds; nothing is asked of who calls
    hn_json_key(b, "servers");
    hn_json_raw(b, "[{\"url\":\"/\",\"description\":\"this server\"}]");
    hn_json_key(b, "security");
    hn_json_raw(b, c->opts.token ? "[{\"token\":[]}]" : "[{}]");
    put_tags(b);
    put_paths(b, &c->routes);
    put_components(b, &c->routes, c->opts.token != NULL);
    hn_json_end_object(b);
}

void hn_handle_openapi(hn_request *r) {
    hn_reply_kept(r, &r->context->openapi, put_document);
}
