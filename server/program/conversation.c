// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/conversation.h"

#include "dynamics/compile/coordinates.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { VERSION = 1 };

static const char *const SERVICES[HN_PROGRAM_SERVICES] = {"accelerations", "step", "solve"};
/// Terms that a program may ask for.
static const struct {
    const char *name;
    hn_term term;
} TERMS[] = {{"M", HN_TERM_M},     {"f", HN_TERM_F},         {"J", HN_TERM_J},
             {"phi", HN_TERM_PHI}, {"phi_t", HN_TERM_PHI_T}, {"gamma", HN_TERM_GAMMA}};
enum { N_TERMS = sizeof TERMS / sizeof *TERMS };

// ---- failures ----

/// The first failure is the one that counts; the process is not asked again.
static hn_status fail(hn_conversation *c, hn_status status) {
    c->failed = true;
    c->why.status = status;
    hn_guest_process_end(&c->process);
    return status;
}

#define REFUSE(c, ...) fail((c), hn_diag_set(&(c)->why, HN_ERR_INPUT, NULL, NULL, __VA_ARGS__))

/// The beginning of a line as a person can read it.
static void quote(const char *text, char out[64]) {
    int n = 0;
    for (; text[n] && n < 60; n++) {
        const unsigned char ch = (unsigned char)text[n];
        out[n] = ch >= 32 && ch < 127 ? (char)ch : '?';
    }
    snprintf(out + n, (size_t)(64 - n), "%s", text[n] ? "..." : "");
}

/// Names the number of a line that JSON does not have, as Python and others write it: "a[2] is
/// NaN", "q[0][2] is Infinity". Returns whether there is one.
static bool name_nan(const char *line, char out[64]) {
    const char *nan = strstr(line, "NaN"), *infinity = strstr(line, "Infinity");
    const char *bad = !nan || (infinity && infinity < nan) ? infinity : nan;
    if (!bad) {
        return false;
    }

    // back to the name: the commas of the list, then the rows before it
    int place[2] = {0, 0}, depth = 0, inside = 0;
    const char *at = bad;
    while (at > line && *at != ':') {
        at--;
        place[0] += *at == ',' && depth == 0;
        place[1] += *at == ']';
        inside += *at == ']';
        if (*at == '[') {
            depth += inside == 0;
            inside -= inside > 0;
        }
    }
    const char *end = at;
    while (end > line && *end != '"') {
        end--;
    }
    const char *name = end;
    while (name > line && name[-1] != '"') {
        name--;
    }

    // from outside to inside
    const char *kind = bad == nan ? "NaN" : "Infinity";
    const int n = (int)(end - name);
    if (n <= 0 || n > 20 || n != (int)strspn(name, "abcdefghijklmnopqrstuvwxyz")) {
        snprintf(out, 64, "it holds %s", kind);
    } else if (depth == 0) {
        snprintf(out, 64, "%.*s is %s", n, name, kind);
    } else if (depth == 1) {
        snprintf(out, 64, "%.*s[%d] is %s", n, name, place[0], kind);
    } else {
        snprintf(out, 64, "%.*s[%d][%d] is %s", n, name, place[1], place[0], kind);
    }
    return true;
}

// ---- asking ----

/// Sends what is in c->text and reads the answer's object. Returns NULL after a failure.
static cJSON *ask(hn_conversation *c, double seconds) {
    hn_strbuf_add(&c->text, "\n");
    if (c->text.failed) {
        fail(c, HN_ERR_MEMORY);
        return NULL;
    }
    const double mark = hn_guest_process_clock_start(&c->process);
    const hn_status status = hn_guest_process_ask(&c->process, hn_strbuf_text(&c->text), c->text.n,
                                                  seconds, &c->line, &c->why);
    c->cpu += hn_guest_process_clock_stop(&c->process, mark);
    if (status != HN_OK) {
        fail(c, status);
        return NULL;
    }

    // one object, and text
    const char *line = hn_strbuf_text(&c->line);
    char begin[64];
    quote(line, begin);
    if (strlen(line) != c->line.n) {
        REFUSE(c, "answer %lld holds a zero byte: JSON is text", c->id);
        return NULL;
    }
    cJSON *answer = cJSON_Parse(line);
    if (!cJSON_IsObject(answer)) {
        cJSON_Delete(answer);
        char wrong[64];
        if (name_nan(line, wrong)) {
            REFUSE(c, "answer %lld: %s; every number must be finite", c->id, wrong);
        } else {
            REFUSE(c, "answer %lld is no JSON object: '%s'", c->id, begin);
        }
        return NULL;
    }
    return answer;
}

/// Reads n finite numbers. `where` names them in the refusal.
static hn_status read_numbers(hn_conversation *c, const cJSON *list, const char *where, int n,
                              double *out) {
    if (!cJSON_IsArray(list) || cJSON_GetArraySize(list) != n) {
        return cJSON_IsArray(list)
                   ? REFUSE(c, "answer %lld: %s has %d numbers, %d are needed", c->id, where,
                            cJSON_GetArraySize(list), n)
                   : REFUSE(c, "answer %lld has no list %s of %d numbers", c->id, where, n);
    }
    int i = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, list) {
        if (!cJSON_IsNumber(item) || !isfinite(item->valuedouble)) {
            return REFUSE(c, "answer %lld: %s[%d] is not a finite number", c->id, where, i);
        }
        out[i++] = item->valuedouble;
    }
    return HN_OK;
}

/// The answer to the question that was asked last, and nothing behind it.
static hn_status check_order(hn_conversation *c, const cJSON *answer) {
    const cJSON *id = cJSON_GetObjectItemCaseSensitive(answer, "id");
    if (!cJSON_IsNumber(id) || id->valuedouble != (double)c->id) {
        return cJSON_IsNumber(id) ? REFUSE(c, "the answer has the id %.0f; question %lld was asked",
                                           id->valuedouble, c->id)
                                  : REFUSE(c, "the answer to question %lld has no id", c->id);
    }
    return hn_guest_process_has_more(&c->process)
               ? REFUSE(c, "it wrote more than one line in answer to question %lld", c->id)
               : HN_OK;
}

// ---- the greeting ----

static void put_names(hn_conversation *c) {
    const hn_scene *scene = hn_system_scene(c->sys);
    hn_json_key(&c->text, "coordinates");
    hn_json_array(&c->text);
    for (int i = 0; i < c->nu; i++) {
        hn_json_string(&c->text, scene->coordinates[hn_system_user_coordinate(c->sys, i)].name);
    }
    hn_json_end_array(&c->text);
    hn_json_key(&c->text, "rows");
    hn_json_array(&c->text);
    for (int i = 0; i < c->nc; i++) {
        hn_json_string(&c->text, hn_system_row_name(c->sys, i));
    }
    hn_json_end_array(&c->text);
    hn_json_key(&c->text, "parameters");
    hn_json_object(&c->text);
    for (int i = 0; i < scene->n_params; i++) {
        hn_json_put_number(&c->text, scene->params[i].name, scene->params[i].value);
    }
    hn_json_end_object(&c->text);
}

static void put_greeting(hn_conversation *c) {
    const hn_scene *scene = hn_system_scene(c->sys);
    const hn_program_limits *limits = &c->process.limits;
    hn_json_object(&c->text);
    hn_json_put_int(&c->text, "holonom", VERSION);
    hn_json_put_string(&c->text, "scene", scene->id);
    hn_json_put_string(&c->text, "title", scene->title ? scene->title : scene->id);
    put_names(c);
    hn_json_key(&c->text, "limits");
    hn_json_object(&c->text);
    hn_json_put_number(&c->text, "answer", limits->answer);
    hn_json_put_number(&c->text, "cpu", limits->cpu);
    hn_json_put_number(&c->text, "memory", (double)limits->memory);
    hn_json_end_object(&c->text);
    hn_json_end_object(&c->text);
}

static hn_status read_service(hn_conversation *c, const cJSON *greeting) {
    const cJSON *version = cJSON_GetObjectItemCaseSensitive(greeting, "holonom");
    const cJSON *provides = cJSON_GetObjectItemCaseSensitive(greeting, "provides");
    if (!cJSON_IsNumber(version) || version->valuedouble != VERSION) {
        return REFUSE(c, "its greeting must say \"holonom\": %d", VERSION);
    }
    for (int i = 0; i < HN_PROGRAM_SERVICES; i++) {
        if (cJSON_IsString(provides) && strcmp(provides->valuestring, SERVICES[i]) == 0) {
            c->service = (hn_program_service)i;
            return HN_OK;
        }
    }
    return REFUSE(c, "its greeting must say what it provides: accelerations, step or solve");
}

static hn_status read_wants(hn_conversation *c, const cJSON *greeting) {
    const cJSON *word;
    cJSON_ArrayForEach(word, cJSON_GetObjectItemCaseSensitive(greeting, "wants")) {
        int i = 0;
        while (i < N_TERMS &&
               !(cJSON_IsString(word) && strcmp(word->valuestring, TERMS[i].name) == 0)) {
            i++;
        }
        if (i == N_TERMS) {
            return REFUSE(c, "its greeting wants '%.40s'; there are M, f, J, phi, phi_t and gamma",
                          cJSON_IsString(word) ? word->valuestring : "what is no text");
        }
        c->wants |= TERMS[i].term;
    }
    return HN_OK;
}

static hn_status greet(hn_conversation *c) {
    hn_strbuf_clear(&c->text);
    put_greeting(c);
    cJSON *greeting = ask(c, c->process.limits.start);
    c->process.n_clocks = 0; // an interpreter may have started since
    c->cpu = 0;
    if (!greeting) {
        return c->why.status;
    }
    hn_status status = read_service(c, greeting);
    HN_THEN(status, read_wants(c, greeting));
    if (status == HN_OK && hn_guest_process_has_more(&c->process)) {
        status = REFUSE(c, "it wrote more than its greeting before it was asked");
    }
    cJSON_Delete(greeting);
    return status;
}

static hn_status take_memory(hn_conversation *c, hn_arena *arena) {
    const size_t nu = (size_t)c->nu, nv = (size_t)c->nv, nc = (size_t)c->nc;
    double **const places[] = {&c->uq, &c->uv, &c->ua,      &c->P,       &c->scratch, &c->M,
                               &c->J,  &c->f,  &c->ahead_q, &c->ahead_v, &c->answer};
    const size_t sizes[] = {nu,
                            nu,
                            nv,
                            nv * nu,
                            nv * nu,
                            nu * nu,
                            nc * nu,
                            nu,
                            nu * HN_CONVERSATION_AHEAD,
                            nu * HN_CONVERSATION_AHEAD,
                            nu};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        *places[i] = hn_arena_doubles(arena, sizes[i] + 1);
    }
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

hn_status hn_conversation_begin(hn_conversation *c, const hn_system *sys, char *const *argv,
                                const char *file, const hn_program_limits *limits,
                                hn_arena *arena) {
    const hn_system_info info = hn_system_get_info(sys);
    *c = (hn_conversation){
        .sys = sys, .nu = info.n_user, .nv = info.nv, .nq = info.nq, .nc = info.nc};
    hn_strbuf_init(&c->text);
    hn_strbuf_init(&c->line);

    // the process, its greeting, the terms that it wants
    HN_TRY(take_memory(c, arena));
    HN_TRY(hn_repeated_question_init(&c->repeated, c->nq, c->nv, c->nu, arena));
    hn_status status = hn_guest_process_start(&c->process, argv, file, limits, &c->why);
    HN_THEN(status, greet(c));
    if (status == HN_OK && c->wants) {
        status = hn_eval_create(sys, c->wants, arena, &c->eval);
    }

    // whoever asks next gets the reason
    if (status != HN_OK && status != HN_ERR_MEMORY) {
        fail(c, status);
        status = HN_OK;
    }
    return status;
}

hn_status hn_conversation_check(const hn_conversation *c, bool own, hn_diag *diag) {
    const bool provides_steps = c->service != HN_PROGRAM_ACCELERATIONS;
    return c->failed || own == provides_steps
               ? HN_OK
               : hn_diag_set(diag, HN_ERR_INPUT, NULL,
                             own ? "spell it with an integrator, as program:FILE@rk4:h=1e-3"
                                 : "spell it with @own: it makes its own steps",
                             "the program provides %s", SERVICES[c->service]);
}

// ---- questions ----

static void begin_question(hn_conversation *c, double t, const double *q, const double *v) {
    hn_system_to_user(c->sys, q, c->uq);
    hn_system_rates_to_user(c->sys, v, c->uv);
    hn_strbuf_clear(&c->text);
    hn_json_object(&c->text);
    hn_json_put_int(&c->text, "id", ++c->id);
    hn_json_put_number(&c->text, "t", t);
    hn_json_put_numbers(&c->text, "q", c->uq, (size_t)c->nu);
    hn_json_put_numbers(&c->text, "v", c->uv, (size_t)c->nu);
}

static void put_matrix(hn_strbuf *b, const char *name, const double *A, int rows, int columns) {
    hn_json_key(b, name);
    hn_json_array(b);
    for (int i = 0; i < rows; i++) {
        hn_json_numbers(b, A + (size_t)i * (size_t)columns, (size_t)columns);
    }
    hn_json_end_array(b);
}

/// Fills P (nv x nu): v = P v_user. Constant but for orientations.
static void calc_P(hn_conversation *c) {
    for (int j = 0; j < c->nu; j++) {
        memset(c->f, 0, (size_t)c->nu * sizeof *c->f);
        c->f[j] = 1;
        hn_system_rates_from_user(c->sys, c->f, c->ua);
        for (int k = 0; k < c->nv; k++) {
            c->P[k * c->nu + j] = c->ua[k];
        }
    }
}

/// out (rows x nu) = A (rows x nv) P
static void times_P(const hn_conversation *c, const double *A, int rows, double *out) {
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < c->nu; j++) {
            double sum = 0;
            for (int k = 0; k < c->nv; k++) {
                sum += A[i * c->nv + k] * c->P[k * c->nu + j];
            }
            out[i * c->nu + j] = sum;
        }
    }
}

/// The terms in the scene's coordinates: P' M P, J P, P' f; rows as they are.
static void put_terms(hn_conversation *c, double t, const double *q, const double *v) {
    hn_strbuf *b = &c->text;
    if (!c->eval) {
        return;
    }

    calc_P(c);
    hn_eval_run(c->eval, t, q, v);

    // the matrices
    if (c->wants & HN_TERM_M) {
        times_P(c, hn_eval_get(c->eval, HN_TERM_M), c->nv, c->scratch);
        for (int i = 0; i < c->nu; i++) {
            for (int j = 0; j < c->nu; j++) {
                double sum = 0;
                for (int k = 0; k < c->nv; k++) {
                    sum += c->P[k * c->nu + i] * c->scratch[k * c->nu + j];
                }
                c->M[i * c->nu + j] = sum;
            }
        }
        put_matrix(b, "M", c->M, c->nu, c->nu);
    }
    if (c->wants & HN_TERM_J) {
        times_P(c, hn_eval_get(c->eval, HN_TERM_J), c->nc, c->J);
        put_matrix(b, "J", c->J, c->nc, c->nu);
    }

    // the vectors
    if (c->wants & HN_TERM_F) {
        hn_system_forces_to_user(c->sys, hn_eval_get(c->eval, HN_TERM_F), c->f);
        hn_json_put_numbers(b, "f", c->f, (size_t)c->nu);
    }
    for (int i = 0; i < N_TERMS; i++) {
        const hn_term term = TERMS[i].term;
        const bool vector = term == HN_TERM_PHI || term == HN_TERM_PHI_T || term == HN_TERM_GAMMA;
        if (vector && (c->wants & term)) {
            hn_json_put_numbers(b, TERMS[i].name, hn_eval_get(c->eval, term), (size_t)c->nc);
        }
    }
}

static cJSON *end_question(hn_conversation *c) {
    hn_json_end_object(&c->text);
    cJSON *answer = ask(c, c->process.limits.answer);
    if (answer && check_order(c, answer) != HN_OK) {
        cJSON_Delete(answer);
        return NULL;
    }
    return answer;
}

/// Asks for the accelerations in the scene's coordinates, into c->uv.
static hn_status ask_accelerations(hn_conversation *c, double t, const double *q, const double *v) {
    begin_question(c, t, q, v);
    put_terms(c, t, q, v);
    cJSON *answer = end_question(c);
    if (!answer) {
        return c->why.status;
    }
    const hn_status status =
        read_numbers(c, cJSON_GetObjectItemCaseSensitive(answer, "a"), "a", c->nu, c->uv);
    cJSON_Delete(answer);
    return status;
}

/// Asks an earlier question again.
static hn_status ask_again(hn_conversation *c) {
    const hn_repeated_question *r = &c->repeated;
    HN_TRY(ask_accelerations(c, r->t, r->q, r->v));
    const int i = hn_repeated_question_compare(r, c->uv);
    return i < 0 ? HN_OK
                 : REFUSE(c,
                          "question %lld (t = %.4g s) was asked again as question %lld: a[%d] was "
                          "%.10g and is %.10g now; an answer may depend on t, q and v alone",
                          r->id, r->t, c->id, i, r->a[i], c->uv[i]);
}

hn_status hn_conversation_accelerations(hn_conversation *c, double t, const double *q,
                                        const double *v, double *a) {
    if (c->failed) {
        return c->why.status;
    }
    HN_TRY(ask_accelerations(c, t, q, v));
    hn_system_rates_from_user(c->sys, c->uv, a);

    // the question that is kept comes once more, then this one is kept
    const bool is_due = hn_repeated_question_is_due(c->id);
    if (c->repeated.id == 0 || is_due) {
        const long long id = c->id;
        memcpy(c->answer, c->uv, (size_t)c->nu * sizeof *c->uv);
        if (is_due) {
            HN_TRY(ask_again(c));
        }
        hn_repeated_question_keep(&c->repeated, id, t, q, v, c->answer);
    }
    return HN_OK;
}

static hn_status ask_step(hn_conversation *c, double t, double h, const double *q,
                          const double *v) {
    begin_question(c, t, q, v);
    hn_json_put_number(&c->text, "h", h);
    put_terms(c, t, q, v);
    cJSON *answer = end_question(c);
    if (!answer) {
        return c->why.status;
    }
    hn_status status =
        read_numbers(c, cJSON_GetObjectItemCaseSensitive(answer, "q"), "q", c->nu, c->uq);
    HN_THEN(status,
            read_numbers(c, cJSON_GetObjectItemCaseSensitive(answer, "v"), "v", c->nu, c->uv));
    cJSON_Delete(answer);
    return status;
}

static hn_status read_rows(hn_conversation *c, const cJSON *answer, const char *name, double *out) {
    const cJSON *rows = cJSON_GetObjectItemCaseSensitive(answer, name), *row;
    if (cJSON_GetArraySize(rows) != c->n_ahead) {
        return REFUSE(c, "answer %lld: %s has %d rows, %d times were asked for", c->id, name,
                      cJSON_GetArraySize(rows), c->n_ahead);
    }
    int i = 0;
    cJSON_ArrayForEach(row, rows) {
        HN_TRY(read_numbers(c, row, name, c->nu, out + (size_t)i++ * (size_t)c->nu));
    }
    return HN_OK;
}

static hn_status ask_solve(hn_conversation *c, double t, double h, const double *q, const double *v,
                           int n) {
    double times[HN_CONVERSATION_AHEAD];
    for (int k = 0; k < n; k++) {
        times[k] = t + (k + 1) * h;
    }
    c->n_ahead = n;
    c->next_ahead = 0;
    c->ahead_t = t;
    c->ahead_h = h;
    begin_question(c, t, q, v);
    hn_json_put_numbers(&c->text, "times", times, (size_t)n);
    put_terms(c, t, q, v);
    cJSON *answer = end_question(c);
    if (!answer) {
        return c->why.status;
    }
    hn_status status = read_rows(c, answer, "q", c->ahead_q);
    HN_THEN(status, read_rows(c, answer, "v", c->ahead_v));
    cJSON_Delete(answer);
    return status;
}

/// The next row that was computed ahead, if this is the step that it is for.
static bool is_ahead(const hn_conversation *c, double t, double h) {
    const double expected = c->ahead_t + c->next_ahead * c->ahead_h;
    return c->next_ahead < c->n_ahead && h == c->ahead_h && fabs(t - expected) <= 1e-9 * h;
}

hn_status hn_conversation_step(hn_conversation *c, double t, double h, const double *q,
                               const double *v, double *q_new, double *v_new) {
    if (c->failed) {
        return c->why.status;
    }
    if (c->service == HN_PROGRAM_STEP) {
        HN_TRY(ask_step(c, t, h, q, v));
    } else {
        // one question for many steps; a step of another size stands alone
        if (!is_ahead(c, t, h)) {
            const bool regular = h == c->ahead_h || c->id == 0;
            const double before = c->cpu;
            HN_TRY(ask_solve(c, t, h, q, v, regular ? HN_CONVERSATION_AHEAD : 1));
            c->ahead_cpu = (c->cpu - before) / c->n_ahead;
            c->cpu = before;
        }
        c->cpu += c->ahead_cpu;
        const size_t row = (size_t)c->next_ahead++ * (size_t)c->nu;
        memcpy(c->uq, c->ahead_q + row, (size_t)c->nu * sizeof *c->uq);
        memcpy(c->uv, c->ahead_v + row, (size_t)c->nu * sizeof *c->uv);
    }
    hn_system_from_user(c->sys, c->uq, q_new);
    hn_system_rates_from_user(c->sys, c->uv, v_new);
    return HN_OK;
}

void hn_conversation_end(hn_conversation *c) {
    hn_guest_process_end(&c->process);
    hn_eval_free(c->eval);
    c->eval = NULL;
    hn_strbuf_reset(&c->text);
    hn_strbuf_reset(&c->line);
}
