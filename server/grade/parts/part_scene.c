// SPDX-License-Identifier: GPL-3.0-or-later
// A scene with a property. The student hands in parameters of the scene of the exercise, or a whole
// scene; its motion is followed once round (circuit.h), and every property is tested on it.
//
//     "scene": "four-bar", "set": {...}           parameters that are given
//     "free": ["l1", "l2", "l3", "l4"]            parameters that are asked for
//     "limits": {"l1": [0.1, 3]}                  allowed values of a free parameter
//     "checks": [{"id": "...", "test": "turns", ..., "says": "...", "share": 0.25}, ...]
//
// Tests, each with its fields:
//     positive   "of": formula of the parameters
//     grashof    "type": "double-crank", "crank-rocker", "rocker-crank", "double-rocker"
//                "links": [ground, one neighbour, the coupler, the other neighbour], formulas;
//                "neighbours": the coordinates of the two: Grashof's criterion and the motion
//     turns      "coordinates": those that turn fully on the way round
//     curve      "point": a label, or "trace"; "through": [["x1", "y1"], ...], "within": 0.01 [m]
//     stays      "of": formula of parameters and coordinates, positive all the way round
#include "grade/parts/blank.h"
#include "grade/parts/circuit.h"
#include "grade/parts/part_list.h"
#include "grade/parts/part_model.h"
#include "grade/parts/scene_checks.h"
#include "grade/parts/value_entry.h"

#include "base/clock.h"
#include "base/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_COORDINATES = HN_CIRCUIT_COORDINATES, LARGEST_SCENE = 1 << 20 };
static const double SECONDS = 4; // of computing, for a scene that was handed in

static const cJSON *field(const hn_part *p, const char *name) {
    return cJSON_GetObjectItemCaseSensitive(p->node, name);
}

/// Returns whether the answer is a whole scene.
static bool is_scene(const cJSON *given) {
    return cJSON_GetObjectItemCaseSensitive(given, "holonom") != NULL;
}

// ---- reading ----

/// One free parameter; false after the result has said what is wrong with it.
static bool read_parameter(const hn_part *p, const char *name, const cJSON *given, double *out,
                           hn_part_result *r) {
    hn_value_sheet reader = {.p = p, .draw = p->draw};
    double x[HN_DRAW_STATES];
    hn_ex e;
    hn_part_result own = {.mistake = ""};
    const cJSON *entry = hn_part_member(given, name);
    const cJSON *limits = cJSON_GetObjectItemCaseSensitive(field(p, "limits"), name);
    hn_unit_parse(cJSON_IsString(entry) ? "m" : "", &reader.unit);
    if (!entry) {
        hn_part_unreadable(r, "the parameter %.20s is missing", name);
        return false;
    }
    if (!hn_value_entry_read(&reader, entry, x, &e, &own)) {
        hn_part_unreadable(r, "%.20s: %.300s", name, own.explanation);
        return false;
    }
    *out = x[0];
    const double low = limits ? cJSON_GetNumberValue(cJSON_GetArrayItem(limits, 0)) : -HUGE_VAL,
                 high = limits ? cJSON_GetNumberValue(cJSON_GetArrayItem(limits, 1)) : HUGE_VAL;
    if (!(*out >= low && *out <= high)) {
        hn_part_wrong(r, "out-of-range", 0, "%.20s = %.4g; %.4g to %.4g are allowed", name, *out,
                      low, high);
        return false;
    }
    return true;
}

/// Time for which an answer may compute.
typedef struct time_limit {
    double end; ///< [s] of the thread's computing
    const hn_interrupt *interrupt;
} time_limit;

static time_limit begin_limit(const hn_part *p) {
    return (time_limit){.end = hn_clock_thread() + SECONDS, .interrupt = &p->interrupt};
}

static bool is_over(void *user) {
    const time_limit *l = user;
    return hn_clock_thread() > l->end || hn_interrupt_ask(l->interrupt);
}

/// Makes the model of an answer, which asks for its limit until it is freed.
/// HN_OK with NULL: the result says why there is none.
static hn_status load(const hn_part *p, const hn_setting *settings, int n, const cJSON *given,
                      time_limit *limit, hn_model **model, hn_part_result *r) {
    hn_diags diags = {0};
    char *text = is_scene(given) ? cJSON_PrintUnformatted(given) : NULL;
    const hn_model_source source = {.name = text ? NULL : hn_part_text(p->node, "scene"),
                                    .text = text,
                                    .n_text = text ? strlen(text) : 0,
                                    .settings = settings,
                                    .n_settings = text ? 0 : n,
                                    .hides_changes = true,
                                    .interrupt = {.must_end = is_over, .user = limit}};
    hn_status status =
        is_scene(given) && !text ? HN_ERR_MEMORY : hn_model_load(p->lib, &source, model, &diags);
    free(text);
    if (status != HN_OK && status != HN_ERR_MEMORY) {
        const bool open = status == HN_ERR_UNREACHABLE;
        if (status == HN_ERR_STOPPED) {
            hn_diags_add(&diags, status, NULL, NULL, "it takes more than %g s to compile", SECONDS);
        }
        // the gap of constraints that are formulas has no unit and means nothing to a student
        static const char formulas[] = "the constraints cannot all be met";
        const char *why = diags.item[0].message;
        why = open && strncmp(why, formulas, strlen(formulas)) == 0 ? "no pose has these lengths"
                                                                    : why;
        hn_part_wrong(r, open ? "not-assembled" : "no-scene", 0, "%s: %.250s",
                      open ? "the loop cannot be closed" : "the scene cannot be used", why);
        r->unreadable = !open;
        status = HN_OK;
    }
    return status;
}

/// The parameters of a whole scene, for the formulas of the tests.
static int scene_parameters(const hn_model *model, hn_setting *settings) {
    const hn_scene *scene = hn_model_scene(model);
    int n = 0;
    for (int i = 0; i < scene->n_params && n < HN_PART_SETTINGS; i++) {
        settings[n++] =
            (hn_setting){.name = scene->params[i].name, .value = scene->params[i].value};
    }
    return n;
}

/// The given and the free parameters; false after the result has said what is wrong.
static hn_status read_answer(const hn_part *p, const cJSON *given, hn_setting *settings, int *n,
                             hn_part_result *r, bool *good, hn_diag *diag) {
    const cJSON *m;
    *good = true;
    HN_TRY(hn_part_settings(p, settings, n, diag));
    hn_part_keep_given(r, given);
    cJSON_ArrayForEach(m, field(p, "free")) {
        const char *name = cJSON_GetStringValue(m);
        if (!name || *n == HN_PART_SETTINGS) {
            return hn_diag_set(diag, HN_ERR_INPUT, "/parts/free", NULL,
                               "part %s: \"free\" takes names, at most %d with those of \"set\"",
                               p->id, HN_PART_SETTINGS);
        }
        settings[*n].name = name;
        if (*good) {
            *good = read_parameter(p, name, given, &settings[(*n)++].value, r);
        }
    }
    return HN_OK;
}

// ---- grading ----

static hn_status grade_model(const hn_part *p, const hn_model *model, const hn_setting *settings,
                             int n, hn_part_result *r, hn_diag *diag) {
    hn_scene_check check = {.p = p, .model = model};
    const cJSON *node;
    hn_status status = hn_scene_check_open(&check, settings, n, diag);
    hn_part_right(r);
    node = field(p, "checks") ? field(p, "checks")->child : NULL;
    for (; node && status == HN_OK && r->right; node = node->next) {
        status = hn_scene_check_run(&check, node, r, diag);
    }
    hn_scene_check_close(&check);
    return status;
}

static hn_status grade_object(const hn_part *p, const cJSON *given, hn_part_result *r,
                              hn_diag *diag) {
    hn_setting settings[HN_PART_SETTINGS];
    int n = 0;
    bool good = true;
    hn_model *model = NULL;
    if (!p->lib) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/parts/scene", NULL, "no library of scenes here");
    }
    if (!is_scene(given)) {
        HN_TRY(read_answer(p, given, settings, &n, r, &good, diag));
    }
    time_limit limit = begin_limit(p);
    hn_status status = good ? load(p, settings, n, given, &limit, &model, r) : HN_OK;
    if (status == HN_OK && model) {
        n = is_scene(given) ? scene_parameters(model, settings) : n;
        hn_diag why = {0};
        status = grade_model(p, model, settings, n, r, &why);

        // too large, or without a name that is tested: a scene of the student's own
        if (status == HN_ERR_STOPPED) {
            hn_part_unreadable(r, "following its motion takes more than %g s", SECONDS);
            status = HN_OK;
        } else if (status == HN_ERR_INPUT && is_scene(given)) {
            hn_part_unreadable(r, "your scene lacks what is tested: %.250s", why.message);
            status = HN_OK;
        } else if (status != HN_OK) {
            hn_diag_set(diag, status, why.pointer, why.hint, "%s", why.message);
        }
    }
    hn_model_free(model);
    return status;
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *r, int *n,
                       hn_diag *diag) {
    if (!hn_part_begin(r, n, given, "any mechanism that passes every test")) {
        return HN_OK;
    }
    if (!cJSON_IsObject(given)) {
        hn_part_unreadable(r, "expected an object with the parameters, or a scene");
        return HN_OK;
    }
    return grade_object(p, given, r, diag);
}

/// An answer of the exercise: {"l1": formula or number}, with its values; NULL without memory.
static cJSON *evaluate(const hn_part *p, const cJSON *answer, hn_diag *diag) {
    cJSON *out = cJSON_CreateObject();
    const cJSON *m;
    double value = 0;
    cJSON_ArrayForEach(m, answer) {
        const char *formula = cJSON_GetStringValue(m);
        if (formula && hn_draw_value(p->draw, formula, &value, diag) != HN_OK) {
            cJSON_Delete(out);
            return NULL;
        }
        cJSON_AddNumberToObject(out, m->string, formula ? value : cJSON_GetNumberValue(m));
    }
    return out;
}

static cJSON *right(const hn_part *p, hn_diag *diag) {
    if (!field(p, "answer")) {
        return hn_part_right_answer(p, diag);
    }
    return evaluate(p, field(p, "answer"), diag);
}

/// The scene of the exercise as it is shipped, handed in as a whole; NULL when it cannot be read.
static cJSON *read_shipped(const hn_part *p, hn_diag *diag) {
    const char *path =
        p->lib ? hn_library_scene_path(p->lib, hn_part_text(p->node, "scene")) : NULL;
    cJSON *out = NULL;
    hn_strbuf text;
    hn_strbuf_init(&text);
    if (path && hn_file_read(path, LARGEST_SCENE, &text, diag) == HN_OK) {
        out = cJSON_ParseWithLength(hn_strbuf_text(&text), text.n);
    }
    hn_strbuf_reset(&text);
    return out;
}

/// A listed mistake: parameters, or the text "shipped" for the whole scene as it is.
static cJSON *fault(const hn_part *p, int i, const char **id, hn_diag *diag) {
    const cJSON *node = hn_part_fault_at(p, i);
    const cJSON *answer = cJSON_GetObjectItemCaseSensitive(node, "answer");
    *id = hn_part_text(node, "id");
    if (cJSON_IsString(answer)) {
        return read_shipped(p, diag);
    }
    return node ? evaluate(p, answer, diag) : NULL;
}

static void ask(hn_strbuf *b, const hn_part *p) {
    const cJSON *m;
    hn_strbuf_add(b, "{");
    cJSON_ArrayForEach(m, field(p, "free")) {
        hn_strbuf_printf(b, "%s\"%s\": ...", m == field(p, "free")->child ? "" : ", ",
                         m->valuestring);
    }
    hn_strbuf_printf(b, "}, parameters of the scene %s", hn_part_text(p->node, "scene"));
    hn_part_put_settings(b, p);
    hn_strbuf_add(b, "; or a whole scene: {\"holonom\": 1, ...}");
    cJSON_ArrayForEach(m, field(p, "limits")) {
        hn_strbuf_printf(b, "; %s from %g to %g", m->string,
                         cJSON_GetNumberValue(cJSON_GetArrayItem(m, 0)),
                         cJSON_GetNumberValue(cJSON_GetArrayItem(m, 1)));
    }
}

/// The curve that a test asks about, of the mechanism that was handed in.
static void draw_curves(const hn_part *p, const hn_setting *settings, int n, const cJSON *given,
                        hn_part_view *out) {
    hn_part_result r = {.mistake = ""};
    hn_model *model = NULL;
    time_limit limit = begin_limit(p);
    if (!p->lib || load(p, settings, n, given, &limit, &model, &r) != HN_OK || !model) {
        return;
    }
    hn_scene_check check = {.p = p, .model = model};
    const cJSON *node = field(p, "checks") ? field(p, "checks")->child : NULL;
    if (hn_scene_check_open(&check, settings, n, NULL) == HN_OK) {
        for (; node; node = node->next) {
            hn_scene_check_draw(&check, node, out);
        }
    }
    hn_scene_check_close(&check);
    hn_model_free(model);
}

static void view(const hn_part *p, const cJSON *given, hn_part_view *out) {
    hn_part_result r = {.mistake = ""};
    hn_diag diag = {0};
    hn_setting settings[HN_PART_SETTINGS];
    int n = 0;
    bool good;
    if (cJSON_IsObject(given) && !is_scene(given) &&
        read_answer(p, given, settings, &n, &r, &good, &diag) == HN_OK && good) {
        out->scene = hn_part_text(p->node, "scene");
        out->n_settings = n;
        memcpy(out->settings, settings, (size_t)n * sizeof *settings);
        draw_curves(p, settings, n, given, out);
    }
}

const hn_part_kind hn_part_scene = {
    .name = "scene",
    .fields = "scene set free limits checks answer faults",
    .is_open = true,
    .ask = ask,
    .grade = grade,
    .blank = hn_blank_names,
    .right = right,
    .fault = fault,
    .prove = NULL, // the answer of the exercise goes through the tests like any other
    .view = view,
};
