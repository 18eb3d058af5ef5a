// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/export.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/suggest.h"
#include "dynamics/compile/compile.h"
#include "integrators/method/method_spec.h"
#include "session/export/calls.h"
#include "session/export/mechanism.h"
#include "session/export/own_steps.h"
#include "session/export/places.h"
#include "session/export/states.h"

#include <stdio.h>
#include <string.h>

enum { LARGEST_TEXT = 1 << 20, LONGEST_PATH = 4096 };

static hn_status read_text(const hn_library *lib, const hn_language *language, hn_strbuf *text,
                           hn_diags *diags) {
    char path[LONGEST_PATH];
    snprintf(path, sizeof path, "%s/../core/export/%s.txt", hn_library_lessons(lib),
             language->name);
    return hn_file_load(path, LARGEST_TEXT, text, diags);
}

static hn_status choose_language(hn_exporter *e, const char *name, hn_diags *diags) {
    int n;
    const hn_language *all = hn_languages(&n);
    const char *names[32];
    char hint[HN_DIAG_HINT];
    e->language = hn_language_find(name);
    if (e->language) {
        return HN_OK;
    }
    for (int i = 0; i < n && i < 32; i++) {
        names[i] = all[i].name;
    }
    if (hn_mechanism_is_format(name)) {
        snprintf(hint, sizeof hint, "--format %s writes the mechanism itself", name);
    } else {
        hn_suggest_or_list(hint, name, names, n, "languages: ");
    }
    return hn_diags_add(diags, HN_ERR_INPUT, "/language", hint,
                        "'%.40s' is not a language of export", name);
}

/// The solver of this name among those of the language; its first when none is named.
static hn_status choose_solver(hn_exporter *e, const char *name, hn_diags *diags) {
    const hn_language_solver *all = e->language->solvers;
    const char *names[8];
    int n = 0;
    e->solver = all;
    for (; all && all[n].name && n < 8; n++) {
        names[n] = all[n].name;
        e->solver = name && strcmp(name, names[n]) == 0 ? &all[n] : e->solver;
    }
    if (!name || (e->solver && strcmp(name, e->solver->name) == 0)) {
        return HN_OK;
    }
    if (n == 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/solver", "leave it out",
                            "programs in %s have only one solver, and no choice of it",
                            e->language->name);
    }

    // the nearest, or all of them
    char hint[HN_DIAG_HINT];
    hn_suggest_or_list(hint, name, names, n, "solvers: ");
    return hn_diags_add(diags, HN_ERR_INPUT, "/solver", hint,
                        "'%.40s' is not a solver of programs in %s", name, e->language->name);
}

/// Fails: HN_ERR_INPUT for blanks together with what grade does not run.
static hn_status check_blanks(const hn_exporter *e, hn_diags *diags) {
    if (e->blanks && e->skeleton) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/style", "leave one of them out",
                            "--blanks and --style skeleton exclude each other: 'grade' needs the "
                            "functions that a skeleton leaves out");
    }
    if (e->blanks && e->solver != e->language->solvers) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/solver", "leave one of them out",
                            "a program with --blanks cannot use another solver: 'grade' runs it "
                            "without further libraries");
    }
    return HN_OK;
}

/// Reads how the loops are held from a method's spelling.
static hn_status choose_stabilisation(hn_exporter *e, const char *method, hn_method_spec *out,
                                      hn_diags *diags) {
    static const double USUAL = 10; // [1/s]
    hn_diag diag = {0};
    e->alpha = e->beta = USUAL;
    if (!method) {
        return HN_OK;
    }
    const hn_status status = hn_method_parse(method, out, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, "/method", diag.hint, "%s", diag.message);
    }

    const hn_method_spec spec = *out;
    // the two that are an ordinary differential equation in the scene's own coordinates
    const bool is_plain = strcmp(spec.formulation->name, "index1") == 0;
    if (!is_plain && strcmp(spec.formulation->name, "baumgarte") != 0) {
        return hn_diags_add(
            diags, HN_ERR_INPUT, "/method", "index1@rk4, or baumgarte:alpha=5,beta=5@rk4",
            "exported programs do not have the formulation '%s'", spec.formulation->name);
    }
    for (int i = 0; i < spec.formulation->n_options; i++) {
        const char *key = spec.formulation->options[i].key;
        double *const place = strcmp(key, "alpha") == 0  ? &e->alpha
                              : strcmp(key, "beta") == 0 ? &e->beta
                                                         : NULL;
        if (place) {
            *place = spec.formulation_set[i];
        }
    }
    e->alpha = is_plain ? 0 : e->alpha;
    e->beta = is_plain ? 0 : e->beta;
    return HN_OK;
}

static hn_status export_to(hn_strbuf *b, hn_exporter *e, const hn_library *lib,
                           const hn_method_spec *method, hn_diags *diags) {
    HN_TRY(hn_export_states_find(e, diags));
    if (method) {
        HN_TRY(hn_export_own_steps_find(e, method, diags));
    }
    e->calls = hn_export_calls(e);

    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_status status = read_text(lib, e->language, &text, diags);
    if (status == HN_OK && e->skeleton && !strstr(hn_strbuf_text(&text), "@IF SKELETON@")) {
        status = hn_diags_add(diags, HN_ERR_INPUT, "/style",
                              "every language except modelica and latex has one",
                              "there is no skeleton in %s", e->language->name);
    }
    HN_THEN(status, hn_export_fill(b, e, hn_strbuf_text(&text)));
    hn_strbuf_reset(&text);
    return status;
}

hn_status hn_model_export(hn_strbuf *b, const hn_model *model, const hn_library *lib,
                          hn_export_request *request, hn_diags *diags) {
    hn_exporter e = {.model = model,
                     .arena = hn_arena_create(0),
                     .blanks = request->blanks,
                     .skeleton = request->skeleton,
                     .limits = request->limits,
                     .started = hn_clock_thread()};
    if (!e.arena) {
        return HN_ERR_MEMORY;
    }
    hn_method_spec method;
    hn_status status = choose_language(&e, request->language, diags);
    HN_THEN(status, choose_solver(&e, request->solver, diags));
    HN_THEN(status, check_blanks(&e, diags));
    HN_THEN(status, choose_stabilisation(&e, request->method, &method, diags));
    HN_THEN(status, export_to(b, &e, lib, request->method ? &method : NULL, diags));
    if (status == HN_OK) {
        request->suffix = e.language->suffix;
        snprintf(request->remark, sizeof request->remark, "%.160s", e.steps.why);
        request->comment = e.language->comment;
        request->comment_end = e.language->comment_end ? e.language->comment_end : "";
    }
    hn_system_free(e.sys);
    hn_arena_free(e.arena);
    return status;
}

static void put_solvers(hn_strbuf *b, const hn_language_solver *solver) {
    hn_json_key(b, "solvers");
    hn_json_array(b);
    for (; solver && solver->name; solver++) {
        hn_json_object(b);
        hn_json_put_string(b, "name", solver->name);
        hn_json_put_string(b, "about", solver->about);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
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
        put_solvers(b, all[i].solvers);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}
