// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/exercise_shelf.h"

#include "session/compare/picture.h"

#include <stdio.h>
#include <string.h>

enum { MAX_PROBLEMS = 512 };

hn_status hn_shelf_exercise_load(const hn_library *lib, const char *id, hn_exercise **out,
                                 hn_diags *diags) {
    const char *path = hn_library_problem_path(lib, id);
    if (path) {
        const hn_status status = hn_exercise_load_file(path, out, diags);
        if (status != HN_OK) {
            return hn_diags_add(diags, status, NULL, NULL,
                                "the file of the exercise '%.80s' cannot be used", id);
        }
        (*out)->lib = lib;
        return HN_OK;
    }
    const char *names[MAX_PROBLEMS];
    int n = hn_library_n_problems(lib) < MAX_PROBLEMS ? hn_library_n_problems(lib) : MAX_PROBLEMS;
    for (int i = 0; i < n; i++) {
        names[i] = hn_library_problem_id(lib, i);
    }
    const char *near = hn_nearest_name(id, names, n);
    char hint[HN_DIAG_HINT];
    snprintf(hint, sizeof hint, near ? "did you mean '%s'?" : "'holonom list problems'%s",
             near ? near : " names them all");
    return hn_diags_add(diags, HN_ERR_INPUT, "/problem", hint, "there is no problem '%.80s'", id);
}

/// The names whose numbers differ from variant to variant, in one text.
static void put_varied(hn_strbuf *b, const hn_exercise *problem) {
    hn_strbuf names;
    hn_strbuf_init(&names);
    const cJSON *m;
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(problem->root, "draw")) {
        if (!cJSON_GetObjectItemCaseSensitive(m, "value")) {
            hn_strbuf_printf(&names, "%s%s", names.n ? " " : "", m->string);
        }
    }
    hn_json_put_string(b, "varied", hn_strbuf_text(&names));
    b->failed |= names.failed;
    hn_strbuf_reset(&names);
}

void hn_shelf_exercises_json(hn_strbuf *b, const hn_library *lib) {
    hn_json_object(b);
    hn_json_key(b, "problems");
    hn_json_array(b);
    for (int i = 0; i < hn_library_n_problems(lib); i++) {
        hn_exercise *problem = NULL;
        hn_diags diags = {0};

        // one that does not load is listed with its faults
        hn_json_object(b);
        hn_json_put_string(b, "id", hn_library_problem_id(lib, i));
        if (hn_exercise_load_file(hn_library_problem_path(lib, hn_library_problem_id(lib, i)),
                                  &problem, &diags) == HN_OK) {
            hn_json_put_string(b, "title", hn_exercise_title(problem));
            hn_json_put_string(b, "lesson", problem->lesson);
            hn_json_put_string(b, "section", problem->section);
            hn_json_put_int(b, "parts", problem->n_parts ? problem->n_parts : 1);
            put_varied(b, problem);
            hn_json_put_string(b, "scene", hn_exercise_scene(problem));
            hn_json_put_number(b, "points", hn_exercise_points(problem));
        } else {
            hn_json_key(b, "errors");
            hn_json_diags(b, &diags);
        }
        hn_json_end_object(b);
        hn_exercise_free(problem);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

/// Lengths as settings of the scene, angles as its state.
static hn_status load_state(const hn_library *lib, const hn_verdict *v, hn_model **model,
                            hn_state_entry *entries, int *n_entries, hn_diags *diags) {
    hn_setting settings[HN_GRADE_MAX_NAMES];
    for (int i = 0; i < v->n_params; i++) {
        settings[i] = (hn_setting){.name = v->names[i], .value = v->values[i]};
    }
    for (int i = v->n_params; i < v->n_names; i++) {
        entries[(*n_entries)++] = (hn_state_entry){.name = v->names[i], .value = v->values[i]};
    }
    hn_model_source source = {.name = hn_exercise_scene(v->problem),
                              .settings = settings,
                              .n_settings = v->n_params,
                              .allow_open = 1};
    return hn_model_load(lib, &source, model, diags);
}

hn_status hn_shelf_verdict_png(hn_strbuf *png, const hn_library *lib, const hn_verdict *v,
                               hn_diags *diags) {
    if (v->shown_entry < 0 || !hn_exercise_scene(v->problem)[0]) {
        return HN_ERR_UNSUPPORTED;
    }
    hn_model *model = NULL;
    hn_state_entry entries[HN_GRADE_MAX_NAMES];
    int n = 0;
    hn_status status = load_state(lib, v, &model, entries, &n, diags);
    if (status == HN_OK) {
        const hn_entry_verdict *e = &v->entry[v->shown_entry];
        char caption[160];
        const int n_text =
            snprintf(caption, sizeof caption, "%s is %.6g here", e->name, e->given_value);
        if (v->show_expected) {
            snprintf(caption + n_text, sizeof caption - (size_t)n_text, ", expected %.6g",
                     e->expected_value);
        }
        hn_picture_request request = {.entries = entries, .n_entries = n, .caption = caption};
        status = hn_model_picture(png, NULL, model, &request, NULL, diags);
    }
    hn_model_free(model);
    return status;
}
