// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/exercise_shelf.h"

#include "base/suggest.h"
#include "grade/exam.h"
#include "grade/exercise_text.h"
#include "grade/parts/part_list.h"
#include "grade/parts/part_model.h"
#include "grade/variant.h"
#include "session/compare/picture.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_PROBLEMS = 512, SHORTEST_WORD = 3 };

/// Returns whether a title has a word that begins with `word`, in capitals or not.
static bool has_word(const char *title, const char *word) {
    const size_t n = strlen(word);
    for (const char *at = title; *at; at++) {
        const bool begins = at == title || !isalnum((unsigned char)at[-1]);
        if (begins && strncasecmp(at, word, n) == 0) {
            return true;
        }
    }
    return false;
}

/// Writes which of the first n exercises have a word in their title that begins with `word`; ""
/// where none has, or where the word is short.
static void list_titled(const hn_library *lib, const char *word, int n, char hint[HN_DIAG_HINT]) {
    size_t used = 0;
    int listed = 0;
    hint[0] = '\0';
    for (int i = 0; i < n && strlen(word) >= SHORTEST_WORD && used + 60 < HN_DIAG_HINT; i++) {
        hn_exercise *e = NULL;
        const char *id = hn_library_problem_id(lib, i);
        if (hn_exercise_load_file(hn_library_problem_path(lib, id), &e, NULL) == HN_OK &&
            has_word(hn_exercise_title(e), word)) {
            used += used ? 0
                         : (size_t)snprintf(hint, HN_DIAG_HINT,
                                            "exercises with '%.20s' in their title:", word);
            used += (size_t)snprintf(hint + used, HN_DIAG_HINT - used, "%s %.40s",
                                     listed++ ? "," : "", id);
        }
        hn_exercise_free(e);
    }
}

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
    char hint[HN_DIAG_HINT], titled[HN_DIAG_HINT];
    list_titled(lib, id, n, titled);
    hn_suggest(hint, id, names, n, titled[0] ? titled : "'holonom list problems' names them all");
    return hn_diags_add(diags, HN_ERR_INPUT, "/problem", hint, "there is no problem '%.80s'", id);
}

/// Writes where it belongs, short: "1, sections 2 and 6" of lesson 01-closed-loops.
static void put_place(hn_strbuf *b, const hn_exercise *problem) {
    char place[120];
    snprintf(place, sizeof place, "%d, %.100s", atoi(problem->lesson), problem->section);
    hn_json_put_string(b, "place", place);
}

/// Returns whether a part asks for a choice, whose letters are dealt anew for every seed.
static bool has_options(const hn_exercise *problem) {
    for (int i = 0; i < problem->n_parts; i++) {
        if (problem->parts[i].kind == &hn_part_choice) {
            return true;
        }
    }
    return false;
}

/// The names whose numbers differ from variant to variant, in one text.
static void put_varied(hn_strbuf *b, const hn_exercise *problem) {
    hn_strbuf names;
    hn_strbuf_init(&names);
    const cJSON *m;
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(problem->root, "draw")) {
        if (!cJSON_GetObjectItemCaseSensitive(m, "value") &&
            !hn_exercise_is_hidden(problem, m->string)) {
            hn_strbuf_printf(&names, "%s%s", names.n ? " " : "", m->string);
        }
    }
    for (int i = 0; !problem->n_parts && i < problem->n_names; i++) {
        hn_strbuf_printf(&names, "%s%s", i ? " " : "", problem->names[i].name);
    }
    hn_json_put_string(b, "varied", hn_strbuf_text(&names));
    const char *drawn = names.n                ? hn_strbuf_text(&names)
                        : has_options(problem) ? "the order of the options"
                                               : "nothing: the same for all";
    hn_json_put_string(b, "drawn", drawn);
    hn_strbuf ranges;
    hn_strbuf_init(&ranges);
    hn_exercise_put_drawn(&ranges, problem, "", "");
    hn_json_put_string(b, "drawn_from", ranges.n ? hn_strbuf_text(&ranges) : drawn);
    b->failed |= names.failed || ranges.failed;
    hn_strbuf_reset(&ranges);
    hn_strbuf_reset(&names);
}

/// The estimate for all parts, or for the entries of a matrix, rounded up to five minutes.
static int count_minutes(const hn_exercise *problem) {
    const double an_entry = 1.5;
    double minutes = problem->n_parts ? 0 : an_entry * problem->n_rows * problem->n_columns;
    const cJSON *part;
    cJSON_ArrayForEach(part, cJSON_GetObjectItemCaseSensitive(problem->root, "parts")) {
        minutes += hn_part_minutes(hn_part_text(part, "kind"));
    }
    return 5 * (int)ceil(minutes / 5);
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
            put_place(b, problem);
            hn_json_put_int(b, "parts", problem->n_parts ? problem->n_parts : 1);
            put_varied(b, problem);
            hn_exercise_put_ranges(b, problem);
            hn_json_put_string(b, "scene", hn_exercise_scene(problem));
            hn_json_put_number(b, "points", hn_exercise_points(problem));
            hn_json_put_int(b, "minutes", count_minutes(problem));
            hn_json_put_int(b, "time_limit", HN_GRADE_TIME_LIMIT);
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

/// The view of a matrix of formulas: lengths as settings of the scene, angles as its state.
static hn_part_view view_of_matrix(const hn_verdict *v) {
    hn_part_view view = {.scene = hn_exercise_scene(v->problem), .n_settings = v->n_params};
    for (int i = 0; i < v->n_params; i++) {
        view.settings[i] = (hn_setting){.name = v->names[i], .value = v->values[i]};
    }
    for (int i = v->n_params; i < v->n_names; i++) {
        snprintf(view.names[view.n_entries], sizeof view.names[0], "%.31s", v->names[i]);
        view.given[view.n_entries++] = v->values[i];
    }
    return view;
}

/// The first state of a matrix exercise.
static hn_status view_state(const hn_exercise *e, uint64_t seed, hn_part_view *out, hn_diag *diag) {
    hn_exam *exam = malloc(sizeof *exam);
    hn_status status = exam ? hn_exam_init(exam, e, seed, diag) : HN_ERR_MEMORY;
    for (int i = 0; i < e->n_names && status == HN_OK; i++) {
        const double x = exam->state[0][i];
        if (i < e->n_params) {
            out->settings[out->n_settings++] = (hn_setting){.name = e->names[i].name, .value = x};
        } else {
            snprintf(out->names[out->n_entries], sizeof out->names[0], "%.31s", e->names[i].name);
            out->given[out->n_entries++] = x;
        }
    }
    if (exam) {
        hn_exam_reset(exam);
    }
    free(exam);
    return status;
}

/// The first part that is about a scene, with the numbers of the variant.
static hn_status view_part(const hn_exercise *e, uint64_t seed, hn_part_view *out, hn_diag *diag) {
    hn_variant x;
    hn_status status = hn_variant_init(&x, e, seed, diag);
    for (int i = 0; i < x.n_parts && status == HN_OK && !out->scene[0]; i++) {
        out->scene = hn_part_text(x.part[i].node, "scene");
        if (out->scene[0]) {
            status = hn_part_settings(&x.part[i], out->settings, &out->n_settings, diag);
        }
    }
    hn_variant_reset(&x);
    return status;
}

const char *hn_shelf_picture_scene(const hn_exercise *exercise) {
    return hn_part_text(cJSON_GetObjectItemCaseSensitive(exercise->root, "picture"), "scene");
}

/// The scene of the field "picture", with the numbers of the variant as its parameters.
static hn_status view_picture(const hn_exercise *e, uint64_t seed, hn_part_view *out,
                              hn_diag *diag) {
    const cJSON *picture = cJSON_GetObjectItemCaseSensitive(e->root, "picture"), *m;
    hn_variant x;
    hn_status status = hn_variant_init(&x, e, seed, diag);
    out->scene = hn_shelf_picture_scene(e);
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(picture, "set")) {
        const char *formula = cJSON_GetStringValue(m);
        if (status == HN_OK && (!formula || out->n_settings == HN_PART_ENTRIES)) {
            status = hn_diag_set(diag, HN_ERR_INPUT, "/picture/set", NULL,
                                 "\"set\" takes at most %d formulas under names", HN_PART_ENTRIES);
        }
        if (status == HN_OK) {
            hn_setting *setting = &out->settings[out->n_settings++];
            setting->name = m->string;
            status = hn_draw_value(&x.draw, formula, &setting->value, diag);
        }
    }
    hn_variant_reset(&x);
    return status;
}

hn_status hn_shelf_exercise_view(const hn_exercise *exercise, uint64_t seed, hn_part_view *out,
                                 hn_diag *diag) {
    *out = (hn_part_view){.scene = hn_exercise_scene(exercise)};
    if (exercise->n_parts) {
        HN_TRY(view_part(exercise, seed, out, diag));
    }
    if (exercise->n_parts && !out->scene[0]) {
        HN_TRY(view_picture(exercise, seed, out, diag));
    }
    if (!out->scene[0]) {
        return hn_diag_set(
            diag, HN_ERR_INPUT, NULL, NULL,
            "exercise '%.40s' has no picture: neither it nor a part of it names a scene",
            hn_exercise_id(exercise));
    }
    return exercise->n_parts ? HN_OK : view_state(exercise, seed, out, diag);
}

static int take_entries(const hn_part_view *view, const double *values, hn_state_entry *entries) {
    for (int i = 0; i < view->n_entries; i++) {
        entries[i] = (hn_state_entry){.name = view->names[i], .value = values[i]};
    }
    return view->n_entries;
}

/// The sentence below the title: which answer is drawn, and its value where it has one.
static void write_caption(const hn_verdict *v, char *caption, size_t size) {
    const hn_entry_verdict *e = &v->entry[v->shown_entry];
    if (v->problem->n_parts) {
        snprintf(caption, size, "your answer to %s%s", e->name,
                 v->view.overlay && v->show_expected ? ", and the configuration expected" : "");
        return;
    }
    const int n = snprintf(caption, size, "your %s is %.6g here", e->name, e->given_value);
    if (v->show_expected) {
        snprintf(caption + n, size - (size_t)n, "; expected %.6g", e->expected_value);
    }
}

hn_status hn_shelf_verdict_png(hn_strbuf *png, const hn_library *lib, const hn_verdict *v,
                               hn_diags *diags) {
    const hn_part_view view = v->problem->n_parts ? v->view : view_of_matrix(v);
    if (v->shown_entry < 0 || !view.scene || !view.scene[0]) {
        return HN_ERR_UNSUPPORTED;
    }
    hn_model *model = NULL;
    hn_state_entry given[HN_PART_ENTRIES], expected[HN_PART_ENTRIES];
    char caption[160];
    const hn_model_source source = {.name = view.scene,
                                    .settings = view.settings,
                                    .n_settings = view.n_settings,
                                    .allow_open = 1};
    hn_status status = hn_model_load(lib, &source, &model, diags);
    if (status == HN_OK) {
        write_caption(v, caption, sizeof caption);
        hn_picture_request request = {.entries = given,
                                      .n_entries = take_entries(&view, view.given, given),
                                      .caption = caption};
        request.lines = view.trace;
        request.n_lines = view.n_trace;
        if (view.overlay && v->show_expected) {
            request.expected = expected;
            request.n_expected = take_entries(&view, view.expected, expected);
        }
        status = hn_model_picture(png, NULL, model, &request, NULL, diags);
    }
    hn_model_free(model);
    return status;
}
