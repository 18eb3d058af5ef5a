// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/exercise.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/json_line.h"
#include "base/json_text.h"
#include "grade/exam.h"
#include "grade/mistakes.h"
#include "grade/parts/part_list.h"
#include "grade/rubric.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// The exercise being read, and where its faults go.
typedef struct reader {
    hn_exercise *p;
    hn_diags *diags;
    hn_status status;
} reader;

static void fault(reader *r, const char *pointer, const char *what) {
    r->status = hn_diags_add(r->diags, HN_ERR_INPUT, pointer, NULL, "%s", what);
}

static const char *keep(reader *r, const char *text) {
    const char *copy = hn_arena_strdup(r->p->arena, text);
    r->status = copy ? r->status : HN_ERR_MEMORY;
    return copy ? copy : "";
}

static const char *read_text(reader *r, const cJSON *node, const char *key, const char *pointer) {
    const cJSON *m = cJSON_GetObjectItemCaseSensitive(node, key);
    if (!cJSON_IsString(m)) {
        fault(r, pointer, "expected a text");
        return "";
    }
    return keep(r, m->valuestring);
}

static double read_number(reader *r, const cJSON *node, const char *key, const char *pointer,
                          double low, double high) {
    const cJSON *m = cJSON_GetObjectItemCaseSensitive(node, key);
    if (!cJSON_IsNumber(m) || !(m->valuedouble >= low && m->valuedouble <= high)) {
        hn_diags_add(r->diags, HN_ERR_INPUT, pointer, NULL, "expected a number from %g to %g", low,
                     high);
        r->status = HN_ERR_INPUT;
        return low;
    }
    return m->valuedouble;
}

static void read_range(reader *r, const cJSON *node, hn_grade_name *name) {
    const cJSON *low = node ? node->child : NULL, *high = low ? low->next : NULL;
    if (!cJSON_IsArray(node) || !cJSON_IsNumber(low) || !cJSON_IsNumber(high) || high->next ||
        !(low->valuedouble < high->valuedouble)) {
        fault(r, "/parameters", "expected [low, high] for every name");
        return;
    }
    name->low = low->valuedouble;
    name->high = high->valuedouble;
}

/// {"l1": [low, high], "l3": {"formula": .., "open": [low, high]}}
static void read_names(reader *r, const cJSON *node) {
    hn_exercise *p = r->p;
    for (const cJSON *m = cJSON_IsObject(node) ? node->child : NULL; m; m = m->next) {
        if (p->n_names == HN_GRADE_MAX_NAMES) {
            fault(r, "/parameters", "too many names");
            return;
        }
        hn_grade_name *name = &p->names[p->n_names++];
        name->name = keep(r, m->string);
        if (cJSON_IsObject(m)) {
            name->formula = read_text(r, m, "formula", "/parameters");
            read_range(r, cJSON_GetObjectItemCaseSensitive(m, "open"), name);
        } else {
            read_range(r, m, name);
        }
    }
}

static int read_texts(reader *r, const cJSON *node, const char *pointer, const char **out,
                      int room) {
    int n = 0;
    for (const cJSON *m = cJSON_IsArray(node) ? node->child : NULL; m; m = m->next) {
        if (!cJSON_IsString(m) || n == room) {
            fault(r, pointer, "expected a short list of texts");
            return n;
        }
        out[n++] = keep(r, m->valuestring);
    }
    if (n == 0) {
        fault(r, pointer, "expected a list of texts");
    }
    return n;
}

static int read_pairs(reader *r, const cJSON *node, const char *pointer, hn_grade_pair *out,
                      int texts) {
    int n = 0;
    for (const cJSON *m = cJSON_IsObject(node) ? node->child : NULL; m; m = m->next) {
        if (n == HN_GRADE_MAX_NAMES ||
            (texts ? !cJSON_IsString(m)
                   : !(cJSON_IsNumber(m) && m->valuedouble >= 0 && m->valuedouble <= 1))) {
            fault(r, pointer, texts ? "expected names" : "expected shares from 0 to 1");
            return n;
        }
        if (!texts && !hn_grade_is_mistake(m->string)) {
            fault(r, pointer, "a share for a mistake that is not known");
        }
        out[n].key = keep(r, m->string);
        out[n].text = texts ? keep(r, m->valuestring) : NULL;
        out[n++].value = texts ? 0 : m->valuedouble;
    }
    return n;
}

static void read_statement(reader *r, const cJSON *node) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    for (const cJSON *m = cJSON_IsArray(node) ? node->child : NULL; m; m = m->next) {
        hn_strbuf_printf(&b, "%s%s", b.n ? "\n" : "", cJSON_IsString(m) ? m->valuestring : "");
    }
    if (b.failed) {
        r->status = HN_ERR_MEMORY;
    } else if (b.n == 0) {
        fault(r, "/statement", "expected a list of lines");
    }
    r->p->statement = keep(r, hn_strbuf_text(&b));
    hn_strbuf_reset(&b);
}

/// Names, and what is asked.
static void read_question(reader *r, const cJSON *root) {
    hn_exercise *p = r->p;
    const cJSON *answer = cJSON_GetObjectItemCaseSensitive(root, "answer");
    read_names(r, cJSON_GetObjectItemCaseSensitive(root, "parameters"));
    p->n_params = p->n_names;
    read_names(r, cJSON_GetObjectItemCaseSensitive(root, "coordinates"));
    p->n_aliases =
        read_pairs(r, cJSON_GetObjectItemCaseSensitive(root, "aliases"), "/aliases", p->aliases, 1);
    p->n_partial =
        read_pairs(r, cJSON_GetObjectItemCaseSensitive(root, "partial"), "/partial", p->partial, 0);
    p->n_rows = read_texts(r, cJSON_GetObjectItemCaseSensitive(root, "phi"), "/phi", p->phi,
                           HN_GRADE_MAX_ROWS);
    p->answer = read_text(r, answer, "name", "/answer/name");
    p->n_columns = read_texts(r, cJSON_GetObjectItemCaseSensitive(answer, "by"), "/answer/by",
                              p->by, HN_GRADE_MAX_COLUMNS);
    p->points = read_number(r, answer, "points", "/answer/points", 0, 1e6);
}

/// A field that nobody reads is a slip of the author.
static void check_fields(reader *r, const cJSON *root) {
    static const char *const fields[] = {"exercise", "id",         "title",   "lesson", "section",
                                         "scene",    "statement",  "draw",    "parts",  "hints",
                                         "about",    "conditions", "picture", NULL};
    const cJSON *m;
    cJSON_ArrayForEach(m, root) {
        int k = 0;
        while (fields[k] && strcmp(fields[k], m->string) != 0) {
            k++;
        }
        if (!fields[k]) {
            fault(r, m->string, "an exercise has no such field");
        }
    }
    const cJSON *picture = cJSON_GetObjectItemCaseSensitive(root, "picture");
    if (picture && !cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(picture, "scene"))) {
        fault(r, "/picture", "a picture names a scene");
    }
}

/// The pointer of a fault in the part of this index, whose own pointers begin with "/parts".
static void point_into_part(int part, const char *pointer, char out[HN_DIAG_POINTER]) {
    const bool own = strncmp(pointer, "/parts", 6) == 0;
    snprintf(out, HN_DIAG_POINTER, "/parts/%d%.150s", part, own ? pointer + 6 : "");
}

/// Form 2: parts with kinds of answers, and hints.
static void read_parts(reader *r, cJSON *root) {
    hn_exercise *p = r->p;
    const cJSON *m;
    hn_diag diag = {0};
    int index = -1;
    check_fields(r, root);

    // a part that cannot be read is reported, and the next one is tried
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(root, "parts")) {
        index++;
        if (p->n_parts == HN_GRADE_MAX_PARTS) {
            fault(r, "/parts", "too many parts");
        } else if (hn_part_open(&p->parts[p->n_parts], m, &diag) != HN_OK) {
            char pointer[HN_DIAG_POINTER];
            point_into_part(index, diag.pointer, pointer);
            r->status =
                hn_diags_add(r->diags, HN_ERR_INPUT, pointer, diag.hint, "%s", diag.message);
        } else {
            p->points += p->parts[p->n_parts++].points;
        }
    }
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(root, "hints")) {
        if (p->n_hints < HN_GRADE_MAX_HINTS && cJSON_IsString(m)) {
            p->hints[p->n_hints++] = m->valuestring;
        }
    }
    if (p->n_parts == 0) {
        fault(r, "/parts", "an exercise needs a part that can be read");
    }

    // the parts and hints point into the tree, so the exercise keeps it
    p->seed = 1;
    p->root = root;
    hn_contents_read(&p->contents, root);
}

/// Reads the texts for people.
static void read_titles(reader *r, const cJSON *root) {
    hn_exercise *p = r->p;
    p->id = read_text(r, root, "id", "/id");
    p->title = read_text(r, root, "title", "/title");
    p->lesson = read_text(r, root, "lesson", "/lesson");
    p->section = read_text(r, root, "section", "/section");
    p->scene = cJSON_GetObjectItemCaseSensitive(root, "scene")
                   ? read_text(r, root, "scene", "/scene")
                   : "";
    read_statement(r, cJSON_GetObjectItemCaseSensitive(root, "statement"));
}

static void read_problem(reader *r, const cJSON *root) {
    hn_exercise *p = r->p;
    const cJSON *states = cJSON_GetObjectItemCaseSensitive(root, "states"),
                *tolerance = cJSON_GetObjectItemCaseSensitive(root, "tolerance");

    // what is asked, and how answers are compared
    read_question(r, root);
    p->seed = (uint64_t)read_number(r, states, "seed", "/states/seed", 1, 9e15);
    p->n_closed =
        (int)read_number(r, states, "closed", "/states/closed", 20, HN_GRADE_MAX_STATES / 2);
    p->n_open = (int)read_number(r, states, "open", "/states/open", 0, HN_GRADE_MAX_STATES / 2);
    p->relative = read_number(r, tolerance, "relative", "/tolerance/relative", 1e-12, 1e-2);
    p->absolute = read_number(r, tolerance, "absolute", "/tolerance/absolute", 1e-14, 1e-2);
    p->why = read_text(r, tolerance, "why", "/tolerance/why");
}

/// The problem must be able to grade: its formulas read, its answer exists.
static hn_status check_problem(const hn_exercise *p, hn_diags *diags) {
    hn_exam *exam = malloc(sizeof *exam);
    hn_diag diag = {0};
    if (!exam) {
        return HN_ERR_MEMORY;
    }
    hn_status status = hn_exam_init(exam, p, 0, &diag);
    if (status == HN_ERR_INPUT) {
        hn_diags_add(diags, status, diag.pointer, diag.hint, "%s", diag.message);
    }
    hn_exam_reset(exam);
    free(exam);
    return status;
}

/// Puts the line before each fault that says where it is.
static void name_lines(hn_diags *diags, int from, const char *text) {
    for (int i = from; diags && text && i < diags->n; i++) {
        hn_diag *item = &diags->item[i];
        const hn_diag old = *item;
        if (old.pointer[0] == '/') {
            hn_diag_set(item, old.status, old.pointer, old.hint, "line %d: %s",
                        hn_json_line(text, old.pointer), old.message);
        }
    }
}

hn_status hn_exercise_load_json(const char *text, size_t n, hn_exercise **out, hn_diags *diags) {
    HN_ASSERT(out && (text || n == 0));
    *out = NULL;
    hn_diag diag = {0};
    const int n_before = diags ? diags->n : 0;
    hn_status status = hn_json_text_check(text, n, 16, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, "", diag.hint, "%s", diag.message);
    }

    // everything lives in the arena, the exercise itself too
    cJSON *root = cJSON_ParseWithLength(text, n);
    hn_arena *arena = root ? hn_arena_create(0) : NULL;
    hn_exercise *p = arena ? hn_arena_get(arena, sizeof *p) : NULL;
    status = p ? HN_OK : HN_ERR_MEMORY;

    if (p) {
        p->arena = arena;
        p->hash = hn_hash_mix(hn_hash_bytes(HN_HASH_START, text, n));
        char *copy = hn_arena_get(arena, n + 1);
        if (copy) {
            memcpy(copy, text, n);
        }
        p->text = copy;
        reader r = {.p = p, .diags = diags, .status = HN_OK};
        if (!cJSON_IsObject(root)) {
            fault(&r, "", "expected an object");
        } else {
            read_titles(&r, root);
            if (cJSON_GetObjectItemCaseSensitive(root, "exercise")) {
                read_parts(&r, root);
            } else {
                read_problem(&r, root);
                hn_contents_read(&p->contents, root);
            }
        }
        status = r.status != HN_OK ? r.status : p->n_parts ? HN_OK : check_problem(p, diags);
        name_lines(diags, n_before, p->text);
    }
    if (status != HN_OK || !p->root) {
        cJSON_Delete(root);
    }
    if (status != HN_OK) {
        hn_arena_free(arena);
        return status;
    }
    *out = p;
    return HN_OK;
}

hn_status hn_exercise_load_file(const char *path, hn_exercise **out, hn_diags *diags) {
    HN_ASSERT(path && out);
    *out = NULL;
    hn_strbuf text;
    hn_strbuf_init(&text);
    const int n_before = diags ? diags->n : 0;
    hn_status status = hn_file_load(path, HN_GRADE_MAX_BYTES, &text, diags);
    HN_THEN(status, hn_exercise_load_json(hn_strbuf_text(&text), text.n, out, diags));
    hn_diags_name_file(diags, n_before, path);
    hn_strbuf_reset(&text);
    return status;
}

int hn_exercise_line(const hn_exercise *problem, int part, const char *pointer) {
    char own[HN_DIAG_POINTER];
    if (part >= 0) {
        point_into_part(part, pointer, own);
    }
    return problem->text ? hn_json_line(problem->text, part >= 0 ? own : pointer) : 1;
}

void hn_exercise_free(hn_exercise *problem) {
    if (problem) {
        cJSON_Delete(problem->root);
        hn_rubric_free(problem->rubric);
        hn_arena_free(problem->arena); // the problem itself lives in it
    }
}

const char *hn_exercise_id(const hn_exercise *problem) {
    return problem->id;
}

const char *hn_exercise_title(const hn_exercise *problem) {
    return problem->title;
}

const char *hn_exercise_scene(const hn_exercise *problem) {
    return problem->scene;
}

bool hn_exercise_is_hidden(const hn_exercise *problem, const char *name) {
    const cJSON *draw = cJSON_GetObjectItemCaseSensitive(problem->root, "draw");
    const cJSON *node = cJSON_GetObjectItemCaseSensitive(draw, name);
    return cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(node, "hidden"));
}

double hn_exercise_points(const hn_exercise *problem) {
    return problem->n_parts ? problem->points
                            : problem->points * problem->n_rows * problem->n_columns;
}
