// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/export.h"

#include "base/clock.h"
#include "base/file.h"
#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "export/code.h"
#include "expr/construct.h"
#include "integrators/method/method_spec.h"
#include "study/run/run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LARGEST_TEXT = 1 << 20, LONGEST_PATH = 4096, LONGEST_PLACE = 24 };

static const double LATER = 0.5;             // [s] of the later state, or the scene's duration
static const long long MOST_STEPS = 2000000; // on the way to it

/// Methods for the way to the later state, tried in this order: explicit, then for stiff scenes.
static const char *const PRECISE[] = {"projection@dop853:rtol=1e-12", "ggl@radau5:rtol=1e-10"};

/// A state with its accelerations, in system coordinates.
typedef struct state {
    double t, *q, *v, *a;
} state;

typedef struct exporter {
    hn_arena *arena;
    const hn_model *model;
    hn_system *sys; ///< with parameters as symbols, where that can be compiled
    hn_system_info info;
    hn_system_exprs x;
    const hn_language *language;
    hn_walk_limits limits;
    double started; ///< hn_clock_thread()
    state start, later;
    double energy;
} exporter;

// ---- numbers for the self-check ----

/// Room for a state.
static hn_status make_state(exporter *e, state *s) {
    s->q = hn_arena_doubles(e->arena, (size_t)e->info.nq + 1);
    s->v = hn_arena_doubles(e->arena, (size_t)e->info.nv + 1);
    s->a = hn_arena_doubles(e->arena, (size_t)e->info.nv + 1);
    return hn_arena_failed(e->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// Fills a state from the coordinates of the scene, which both systems share.
static void set_state(const exporter *e, const double *user_q, const double *user_v, state *s) {
    hn_system_from_user(e->sys, user_q, s->q);
    hn_system_rates_from_user(e->sys, user_v, s->v);
}

/// Steps to the later state within the limits.
static hn_status advance(const exporter *e, hn_run *run) {
    hn_walk_limits left = e->limits;
    if (left.seconds > 0) {
        left.seconds = fmax(left.seconds - (hn_clock_thread() - e->started), 1e-9);
    }
    switch (hn_walk(run, e->later.t, 1, &left, NULL, NULL)) {
    case HN_WALK_DONE:
        return HN_OK;
    case HN_WALK_FAILED:
        return hn_run_get_summary(run).status;
    case HN_WALK_OVER:
    case HN_WALK_STOPPED:
        return HN_ERR_BUDGET;
    }
    return HN_ERR_INTERNAL;
}

/// Runs to the later state by one method; HN_OK with the state, or why not.
static hn_status run_to(exporter *e, const char *method, hn_diag *why) {
    hn_method_spec spec;
    hn_run_opts opts = hn_run_opts_default();
    hn_run *run = NULL;
    hn_sample sample;
    opts.max_steps = MOST_STEPS;

    // a run of its own, to one sample
    HN_TRY(hn_method_parse(method, &spec, why));
    HN_TRY(hn_run_create(hn_model_system(e->model), &spec, hn_model_q(e->model),
                         hn_model_v(e->model), &opts, &run, why));
    hn_status status = advance(e, run);
    HN_THEN(status, hn_run_sample(run, e->later.t, &sample));

    // behind a singular configuration solvers may part
    double singular;
    if (status == HN_OK && hn_run_passed_singular(run, &singular) && singular > 0) {
        status = hn_diag_set(why, HN_ERR_SINGULAR, NULL, NULL,
                             "the motion passes a singular configuration at t = %.4g s", singular);
    }
    if (status == HN_OK) {
        set_state(e, sample.q, sample.v, &e->later);
        hn_system_rates_from_user(e->sys, sample.a, e->later.a);
    } else if (status != HN_ERR_SINGULAR) {
        const char *reason = hn_run_get_summary(run).reason;
        (void)hn_diag_set(why, status, "/method", NULL, "%s: %s", method,
                          *reason ? reason : hn_status_text(status));
    }
    hn_run_free(run);
    return status;
}

/// The later state: before the first singular configuration, where solvers may part.
static hn_status find_later(exporter *e, hn_diags *diags) {
    hn_diag why = {0};
    e->later.t = fmin(hn_model_scene(e->model)->duration, LATER);
    for (int half = 0; half < 5; half++, e->later.t /= 2) {
        for (size_t i = 0; i < sizeof PRECISE / sizeof *PRECISE; i++) {
            if (run_to(e, PRECISE[i], &why) == HN_OK) {
                return HN_OK;
            }
            if (hn_walk_ask(&e->limits, e->started) != HN_WALK_DONE) {
                return hn_diags_add(diags, HN_ERR_BUDGET, NULL, NULL,
                                    "the later state for the self-check took more computing time "
                                    "than is allowed");
            }
        }
    }
    return hn_diags_add(diags, why.status, why.pointer, why.hint, "%s", why.message);
}

/// The start in the coordinates of the scene, with its accelerations.
static hn_status read_start(const exporter *e, double *q, double *v, double *a) {
    const hn_system *sys = hn_model_system(e->model);
    double *own = hn_arena_doubles(e->arena, (size_t)e->info.nv + 1);
    hn_accel *accel = NULL;
    hn_accel_info info;
    if (!own) {
        return HN_ERR_MEMORY;
    }
    hn_system_to_user(sys, hn_model_q(e->model), q);
    hn_system_rates_to_user(sys, hn_model_v(e->model), v);
    HN_TRY(hn_accel_create(sys, &(hn_accel_opts){.want_lambda = 0}, e->arena, &accel));
    const hn_status status =
        hn_accel_eval(accel, 0, hn_model_q(e->model), hn_model_v(e->model), 0, 0, own, NULL, &info);
    hn_accel_free(accel);
    hn_system_rates_to_user(sys, own, a);
    return status;
}

static hn_status find_states(exporter *e, hn_diags *diags) {
    state user = {0};
    HN_TRY(make_state(e, &user));
    HN_TRY(make_state(e, &e->start));
    HN_TRY(make_state(e, &e->later));
    HN_TRY(read_start(e, user.q, user.v, user.a));
    set_state(e, user.q, user.v, &e->start);
    hn_system_rates_from_user(e->sys, user.a, e->start.a);
    e->energy = hn_model_assembly(e->model)->energy;
    return find_later(e, diags);
}

// ---- what is put in the places ----

static const char *symbol_name(const exporter *e, int symbol) {
    return hn_graph_symbol_name(hn_system_graph(e->sys), symbol);
}

/// One assignment `name = value` in a line of its own.
static void put_constant(hn_strbuf *b, const exporter *e, int indent, const char *name,
                         const char *value) {
    hn_strbuf kept;
    hn_strbuf_init(&kept);
    hn_code_name(&kept, e->language, name);
    hn_strbuf_printf(b, "%*s", indent, "");
    hn_code_fill(b, e->language->constant, (const char *[]){hn_strbuf_text(&kept), value});
    b->failed |= kept.failed;
    hn_strbuf_reset(&kept);
}

/// Whether any of the terms depends on the symbol: a variable that nobody reads is a warning in C.
static bool is_read(const exporter *e, int symbol) {
    const hn_graph *g = hn_system_graph(e->sys);
    const int nv = e->info.nv, nc = e->info.nc;
    const hn_ex *const lists[] = {e->x.M, e->x.f,     e->x.phi,      e->x.phi_t,
                                  e->x.J, e->x.gamma, &e->x.kinetic, &e->x.potential};
    const int sizes[] = {nv * nv, nv, nc, nc, nc * nv, nc, 1, 1};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        for (int i = 0; i < sizes[k]; i++) {
            if (hn_depends_on(g, lists[k][i], symbol)) {
                return true;
            }
        }
    }
    return false;
}

static void put_parameters(hn_strbuf *b, const exporter *e, int indent) {
    const hn_scene *scene = hn_model_scene(e->model);
    for (int i = 0; i < scene->n_params; i++) {
        const hn_param *p = &scene->params[i];
        const int symbol = hn_graph_find_symbol(hn_system_graph(e->sys), p->name);
        if (symbol < 0 || !is_read(e, symbol)) {
            continue; // it only shapes the start
        }
        hn_strbuf value;
        hn_strbuf_init(&value);
        hn_code_number(&value, e->language, p->value);
        put_constant(b, e, indent, p->name, hn_strbuf_text(&value));
        hn_strbuf_printf(b, " %s %s%s%s\n", e->language->comment, p->unit,
                         p->unit[0] && p->about[0] ? ", " : "", p->about);
        b->failed |= value.failed;
        hn_strbuf_reset(&value);
    }
}

static void put_names(hn_strbuf *b, const exporter *e, int indent) {
    const int first = e->language->first;
    for (int i = 0; i < e->info.nq; i++) {
        hn_strbuf_printf(b, "%*s%s q[%d] %s\n", indent, "", e->language->comment, i + first,
                         symbol_name(e, e->x.q_symbols[i]));
    }
    for (int i = 0; i < e->info.nv; i++) {
        hn_strbuf_printf(b, "%*s%s v[%d] %s\n", indent, "", e->language->comment, i + first,
                         symbol_name(e, e->x.v_symbols[i]));
    }
}

/// Entry i of q or v, as the language reads it.
static void entry_text(const exporter *e, const char *array, int i, char out[32]) {
    hn_strbuf text;
    char index[16];
    hn_strbuf_init(&text);
    snprintf(index, sizeof index, "%d", i + e->language->first);
    hn_code_fill(&text, e->language->entry, (const char *[]){array, index});
    snprintf(out, 32, "%s", hn_strbuf_text(&text));
    hn_strbuf_reset(&text);
}

static void put_unpack(hn_strbuf *b, const exporter *e, int indent) {
    for (int i = 0; i < e->info.nq + e->info.nv; i++) {
        const bool is_v = i >= e->info.nq;
        const int k = is_v ? i - e->info.nq : i;
        const int symbol = is_v ? e->x.v_symbols[k] : e->x.q_symbols[k];
        char entry[32];
        if (is_read(e, symbol)) {
            entry_text(e, is_v ? "v" : "q", k, entry);
            put_constant(b, e, indent, symbol_name(e, symbol), entry);
            hn_strbuf_add(b, "\n");
        }
    }
}

/// Adds the entries of a term that are not zero; columns 0: a vector. Returns the new count.
static int add_entries(hn_code_entry *list, int n, const char *array, const hn_ex *value, int rows,
                       int columns) {
    for (int i = 0; i < rows * (columns ? columns : 1); i++) {
        if (!hn_is_zero(value[i])) {
            list[n++] = (hn_code_entry){.array = array,
                                        .row = columns ? i / columns : i,
                                        .column = columns ? i % columns : -1,
                                        .value = value[i]};
        }
    }
    return n;
}

static hn_status put_terms(hn_strbuf *b, const exporter *e, int indent) {
    const int nv = e->info.nv, nc = e->info.nc;
    const size_t most = (size_t)nv * (size_t)nv + (size_t)nv + (size_t)nc * ((size_t)nv + 3) + 1;
    hn_code_entry *list = hn_arena_get(e->arena, most * sizeof *list);
    if (!list) {
        return HN_ERR_MEMORY;
    }

    // the order of the arrays is that of the texts
    hn_graph *g = hn_system_graph(e->sys);
    const hn_ex energy = hn_add(g, e->x.kinetic, e->x.potential);
    int n = add_entries(list, 0, "mass", e->x.M, nv, nv);
    n = add_entries(list, n, "force", e->x.f, nv, 0);
    n = add_entries(list, n, "jacobian", e->x.J, nc, nv);
    n = add_entries(list, n, "bias", e->x.gamma, nc, 0);
    n = add_entries(list, n, "closure", e->x.phi, nc, 0);
    n = add_entries(list, n, "closure_rate", e->x.phi_t, nc, 0);
    n = add_entries(list, n, "energy", &energy, 1, 0);
    return hn_code_write(b, g, e->language, list, n, indent);
}

/// The time derivative of a unit quaternion e whose angular velocity w is given in the body's axes:
/// e' = e w / 2, row by row as signs and places of w.
static void put_quaternion_rates(hn_strbuf *b, const exporter *e, int indent, int q, int v) {
    static const int place[4][3] = {{1, 2, 3}, {0, 3, 2}, {3, 0, 1}, {2, 1, 0}};
    static const char *const sign[4][3] = {
        {"-", " - ", " - "}, {"", " - ", " + "}, {"", " + ", " - "}, {"-", " + ", " + "}};
    for (int row = 0; row < 4; row++) {
        hn_strbuf value;
        char index[16];
        hn_strbuf_init(&value);

        // the right-hand side
        hn_strbuf_add(&value, "0.5*(");
        for (int k = 0; k < 3; k++) {
            char e_text[32], w_text[32];
            entry_text(e, "q", q + place[row][k], e_text);
            entry_text(e, "v", v + k, w_text);
            hn_strbuf_printf(&value, "%s%s*%s", sign[row][k], e_text, w_text);
        }
        hn_strbuf_add(&value, ")");

        // the assignment in the language
        snprintf(index, sizeof index, "%d", q + row + e->language->first);
        hn_strbuf_printf(b, "%*s", indent, "");
        hn_code_fill(b, e->language->vector,
                     (const char *[]){"rate", index, hn_strbuf_text(&value)});
        hn_strbuf_add(b, "\n");
        hn_strbuf_reset(&value);
    }
}

static void put_rates(hn_strbuf *b, const exporter *e, int indent) {
    int q = 0;
    for (int v = 0; v < e->info.nv; v++) {
        char index[16], entry[32];
        if (hn_system_position_of(e->sys, v) < 0) {
            put_quaternion_rates(b, e, indent, q, v);
            q += 4;
            v += 2;
            continue;
        }
        entry_text(e, "v", v, entry);
        snprintf(index, sizeof index, "%d", q++ + e->language->first);
        hn_strbuf_printf(b, "%*s", indent, "");
        hn_code_fill(b, e->language->vector, (const char *[]){"rate", index, entry});
        hn_strbuf_add(b, "\n");
    }
}

static void put_numbers(hn_strbuf *b, const exporter *e, const double *x, int n) {
    for (int i = 0; i < n; i++) {
        hn_strbuf_add(b, i ? ", " : "");
        hn_code_number(b, e->language, x[i]);
    }
}

// ---- places ----

/// Fills a place that takes lines of its own; *done says whether it is one.
static hn_status fill_block(hn_strbuf *b, const exporter *e, const char *place, int indent,
                            bool *done) {
    static const struct {
        const char *name;
        void (*put)(hn_strbuf *, const exporter *, int);
    } blocks[] = {{"PARAMETERS", put_parameters},
                  {"NAMES", put_names},
                  {"UNPACK", put_unpack},
                  {"RATES", put_rates}};
    *done = true;
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        if (strcmp(blocks[i].name, place) == 0) {
            blocks[i].put(b, e, indent);
            return HN_OK;
        }
    }
    if (strcmp(place, "TERMS") == 0) {
        return put_terms(b, e, indent);
    }
    *done = false;
    return HN_OK;
}

/// Fills a place inside a line.
static void fill_place(hn_strbuf *b, const exporter *e, const char *place) {
    const hn_scene *scene = hn_model_scene(e->model);
    const hn_system_info *info = &e->info;
    const struct {
        const char *name;
        const double *x;
        int n;
    } lists[] = {{"START_Q", e->start.q, info->nq},
                 {"START_V", e->start.v, info->nv},
                 {"START_A", e->start.a, info->nv},
                 {"Q1", e->later.q, info->nq},
                 {"V1", e->later.v, info->nv},
                 {"A1", e->later.a, info->nv},
                 {"T1", &e->later.t, 1},
                 {"ENERGY", &e->energy, 1}};
    const struct {
        const char *name;
        int value;
    } counts[] = {{"NQ", info->nq}, {"NV", info->nv}, {"NC", info->nc}};

    // numbers in a list, counts, words
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        if (strcmp(lists[i].name, place) == 0) {
            put_numbers(b, e, lists[i].x, lists[i].n);
            return;
        }
    }
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        if (strcmp(counts[i].name, place) == 0) {
            hn_strbuf_printf(b, "%d", counts[i].value);
            return;
        }
    }
    const bool is_scene = strcmp(place, "SCENE") == 0;
    HN_ASSERT(is_scene || strcmp(place, "TITLE") == 0);
    hn_strbuf_add(b, is_scene ? scene->id : scene->title);
}

/// The name of the place that begins at `at`, "@NAME@"; returns its length in the text, 0: none.
static size_t read_place(const char *at, size_t n, char out[LONGEST_PLACE]) {
    const size_t length =
        n > 2 && at[0] == '@' ? strspn(at + 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789") : 0;
    if (length == 0 || length >= LONGEST_PLACE || length + 2 > n || at[length + 1] != '@') {
        return 0;
    }
    snprintf(out, LONGEST_PLACE, "%.*s", (int)length, at + 1);
    return length + 2;
}

/// Copies a line of n characters, with its places filled.
static hn_status fill_line(hn_strbuf *b, const exporter *e, const char *line, size_t n) {
    const size_t indent = strspn(line, " ");
    char place[LONGEST_PLACE];
    if (indent < n && read_place(line + indent, n - indent, place) == n - indent) {
        bool done;
        HN_TRY(fill_block(b, e, place, (int)indent, &done));
        if (done) {
            return HN_OK;
        }
    }

    // places inside the line
    for (size_t i = 0; i < n;) {
        const size_t length = read_place(line + i, n - i, place);
        if (length > 0) {
            fill_place(b, e, place);
            i += length;
        } else {
            hn_strbuf_add_n(b, line + i++, 1);
        }
    }
    hn_strbuf_add(b, "\n");
    return HN_OK;
}

static hn_status fill_text(hn_strbuf *b, const exporter *e, const char *text) {
    while (*text) {
        const size_t n = strcspn(text, "\n");
        HN_TRY(fill_line(b, e, text, n));
        text += n + (text[n] == '\n');
    }
    return b->failed ? HN_ERR_MEMORY : HN_OK;
}

// ---- the whole ----

static hn_status read_text(const hn_library *lib, const hn_language *language, hn_strbuf *text,
                           hn_diags *diags) {
    char path[LONGEST_PATH];
    snprintf(path, sizeof path, "%s/../core/export/%s.txt", hn_library_lessons(lib),
             language->name);
    return hn_file_load(path, LARGEST_TEXT, text, diags);
}

static hn_status choose_language(exporter *e, const char *name, hn_diags *diags) {
    int n;
    const hn_language *all = hn_languages(&n);
    const char *names[32];
    char hint[HN_DIAG_HINT] = "";
    e->language = hn_language_find(name);
    if (e->language) {
        return HN_OK;
    }
    for (int i = 0; i < n && i < 32; i++) {
        names[i] = all[i].name;
        const size_t at = strlen(hint);
        snprintf(hint + at, sizeof hint - at, "%s%s", i ? ", " : "", names[i]);
    }
    const char *near = hn_nearest_name(name, names, n);
    return hn_diags_add(diags, HN_ERR_INPUT, "/language", near ? near : hint,
                        "'%.40s' is not a language of export", name);
}

static hn_status export_to(hn_strbuf *b, exporter *e, const hn_library *lib, hn_diags *diags) {
    hn_system_opts opts = hn_system_opts_default();
    opts.symbolic_params = 1;
    hn_diags ignored = {0};
    if (hn_system_compile(hn_model_scene(e->model), &opts, &e->sys, &ignored) != HN_OK) {
        // rows that vanish only for these numbers: parameters are folded in
        HN_TRY(hn_system_compile(hn_model_scene(e->model), NULL, &e->sys, diags));
    }
    e->info = hn_system_get_info(e->sys);
    e->x = hn_system_get_exprs(e->sys);
    HN_TRY(find_states(e, diags));

    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_status status = read_text(lib, e->language, &text, diags);
    HN_THEN(status, fill_text(b, e, hn_strbuf_text(&text)));
    hn_strbuf_reset(&text);
    return status;
}

hn_status hn_model_export(hn_strbuf *b, const hn_model *model, const hn_library *lib,
                          hn_export_request *request, hn_diags *diags) {
    exporter e = {.model = model,
                  .arena = hn_arena_create(0),
                  .limits = request->limits,
                  .started = hn_clock_thread()};
    if (!e.arena) {
        return HN_ERR_MEMORY;
    }
    hn_status status = choose_language(&e, request->language, diags);
    HN_THEN(status, export_to(b, &e, lib, diags));
    if (status == HN_OK) {
        request->suffix = e.language->suffix;
        request->comment = e.language->comment;
    }
    hn_system_free(e.sys);
    hn_arena_free(e.arena);
    return status;
}

void hn_export_languages_json(hn_strbuf *b) {
    int n;
    const hn_language *all = hn_languages(&n);
    hn_json_object(b);
    hn_json_key(b, "languages");
    hn_json_array(b);
    for (int i = 0; i < n; i++) {
        hn_json_object(b);
        hn_json_put_string(b, "name", all[i].name);
        hn_json_put_string(b, "suffix", all[i].suffix);
        hn_json_put_string(b, "about", all[i].about);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}
