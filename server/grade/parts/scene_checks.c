// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/scene_checks.h"

#include "base/suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 512, MAX_THROUGH = 8 };
static const double STRIDE = 0.02; // [rad]: chords of a curve of 1 m err by 0.05 mm

// ---- names ----

/// Names of the draw: parameters that the draw does not have itself, then coordinates.
static cJSON *make_names(hn_scene_check *c, const hn_setting *settings, int n) {
    cJSON *names = cJSON_CreateObject();
    for (int i = 0; i < n + c->n_coordinates; i++) {
        const char *name = i < n ? settings[i].name : hn_part_coordinate(c->model, i - n)->name;
        bool known = cJSON_GetObjectItemCaseSensitive(names, name) != NULL;
        for (int k = 0; k < c->p->draw->n_names; k++) {
            known |= strcmp(c->p->draw->name[k], name) == 0;
        }
        if (!known) {
            cJSON *source = cJSON_AddObjectToObject(names, name);
            cJSON_AddNumberToObject(source, "value", i < n ? settings[i].value : 0);
        }
    }
    return names;
}

static int find_name(const hn_draw *d, const char *name) {
    for (int i = 0; i < d->n_names; i++) {
        if (strcmp(d->name[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

hn_status hn_scene_check_open(hn_scene_check *c, const hn_setting *settings, int n, hn_diag *diag) {
    c->n_coordinates = hn_system_get_info(hn_model_system(c->model)).n_user;
    c->n_points = hn_system_get_info(hn_model_system(c->model)).n_points;
    cJSON *names = make_names(c, settings, n);
    const hn_status status = hn_draw_init(&c->draw, names, NULL, c->p->draw, 1, 1, diag);

    // the names live as long as the exercise and the model, the object does not
    for (int i = 0; i < n + c->n_coordinates && status == HN_OK; i++) {
        const char *name = i < n ? settings[i].name : hn_part_coordinate(c->model, i - n)->name;
        const int at = find_name(&c->draw, name);
        c->draw.name[at] = name;
        c->draw.unit[at] = at < c->p->draw->n_names ? c->draw.unit[at] : "";
        c->draw.value[0][at] = i < n ? settings[i].value : 0;
    }
    cJSON_Delete(names);
    return status;
}

void hn_scene_check_close(hn_scene_check *c) {
    hn_draw_reset(&c->draw);
    free(c->path);
    free(c->points);
}

// ---- the motion ----

/// Keeps one configuration of the way round.
static void keep(void *user, const double *coordinates, const double *points) {
    hn_scene_check *c = user;
    const size_t n = (size_t)c->n_coordinates, m = 3 * (size_t)c->n_points;
    if (c->n_path == c->cap && !c->failed) {
        const int cap = c->cap ? 2 * c->cap : FIRST_CAPACITY;
        double *path = realloc(c->path, (size_t)cap * (n + 1) * sizeof *path);
        c->path = path ? path : c->path;
        double *drawn = realloc(c->points, (size_t)cap * (m + 1) * sizeof *drawn);
        c->points = drawn ? drawn : c->points;
        c->failed = !path || !drawn;
        c->cap = c->failed ? c->cap : cap;
    }
    if (!c->failed) {
        memcpy(c->path + (size_t)c->n_path * n, coordinates, n * sizeof *coordinates);
        memcpy(c->points + (size_t)c->n_path * m, points, m * sizeof *points);
        c->n_path++;
    }
}

static hn_status walk(hn_scene_check *c) {
    hn_status status = HN_OK;
    if (!c->walked) {
        status = hn_circuit_walk(c->model, STRIDE, keep, c, &c->circuit);
        c->walked = true;
    }
    return c->failed ? HN_ERR_MEMORY : status;
}

/// The way round, which must come back to its start; false after the result has said that it does
/// not.
static hn_status need_circuit(hn_scene_check *c, hn_part_result *r, bool *good) {
    const hn_status status = walk(c);
    *good = status == HN_OK && c->circuit.closed;
    if (status == HN_OK && !*good) {
        hn_part_wrong(r, "stuck", 0, "%s", c->circuit.why);
    }
    return status;
}

static hn_status fault_of(const hn_scene_check *c, hn_diag *diag, const char *what) {
    return hn_diag_set(diag, HN_ERR_INPUT, "/parts/checks", NULL, "part %s: %s", c->p->id, what);
}

/// Makes the result wrong by the check's own id, sentence and share; `detail` follows in brackets.
static void fail_check(const cJSON *node, hn_part_result *r, const char *detail) {
    const char *says = hn_part_text(node, "says");
    hn_part_wrong(r, hn_part_text(node, "id"), hn_part_number(node, "share", 0), "%s%s%s%s",
                  says[0] ? says : "the mechanism does not have this property",
                  detail[0] ? " (" : "", detail, detail[0] ? ")" : "");
}

// ---- tests ----

static hn_status test_positive(hn_scene_check *c, const cJSON *node, hn_part_result *r,
                               hn_diag *diag) {
    double x;
    HN_TRY(hn_draw_value(&c->draw, hn_part_text(node, "of"), &x, diag));
    if (!(x > 0)) {
        fail_check(node, r, "");
    }
    return HN_OK;
}

/// Full turns of a coordinate on the way round. -1: the scene has no such coordinate, and `r` says
/// so.
static int turns_of(hn_scene_check *c, const cJSON *name, hn_part_result *r) {
    hn_diag diag = {0};
    const char *text = cJSON_GetStringValue(name);
    const int i = hn_part_find_coordinate(c->model, text ? text : "", &diag);
    if (i < 0) {
        hn_part_unreadable(r, "%.200s%s%.40s", diag.message, diag.hint[0] ? "; is it " : "",
                           diag.hint);
        return -1;
    }
    return abs(c->circuit.turns[i]);
}

static hn_status test_turns(hn_scene_check *c, const cJSON *node, hn_part_result *r,
                            hn_diag *diag) {
    const cJSON *name;
    bool good;
    char detail[120];
    (void)diag;
    HN_TRY(need_circuit(c, r, &good));
    cJSON_ArrayForEach(name, cJSON_GetObjectItemCaseSensitive(node, "coordinates")) {
        const int turns = good && r->right ? turns_of(c, name, r) : 1;
        if (turns == 0) {
            const int i = hn_part_find_coordinate(c->model, name->valuestring, NULL);
            snprintf(detail, sizeof detail, "%.30s only swings, from %.3g to %.3g rad",
                     name->valuestring, c->circuit.least[i], c->circuit.most[i]);
            fail_check(node, r, detail);
        }
    }
    return HN_OK;
}

static const char *const TYPES[] = {"double-rocker", "crank-rocker", "rocker-crank",
                                    "double-crank"};

/// By Grashof's criterion: which of the two neighbours of the ground turn fully, as bits 1 and 2.
/// links: ground, neighbour, coupler, other neighbour. -1: the links stretch out into one line.
static int grashof_type(const double links[4]) {
    double shortest = HUGE_VAL, longest = 0, sum = 0;
    int where = 0;
    for (int i = 0; i < 4; i++) {
        sum += links[i];
        longest = fmax(longest, links[i]);
        where = links[i] < shortest ? i : where;
        shortest = fmin(shortest, links[i]);
    }
    const double spare = sum - 2 * (shortest + longest);
    if (fabs(spare) <= 1e-9 * sum) {
        return -1;
    }

    // the shortest link turns fully against its neighbours, where any link does
    static const int turning[4] = {3, 1, 0, 2};
    return spare > 0 ? turning[where] : 0;
}

static hn_status grashof_links(hn_scene_check *c, const cJSON *node, double links[4],
                               hn_diag *diag) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(node, "links");
    for (int i = 0; i < 4; i++) {
        const char *formula = cJSON_GetStringValue(cJSON_GetArrayItem(list, i));
        if (!formula) {
            return fault_of(c, diag, "\"links\" takes four formulas");
        }
        HN_TRY(hn_draw_value(&c->draw, formula, &links[i], diag));
    }
    return HN_OK;
}

/// The criterion and the motion must both say what is asked for.
static hn_status test_grashof(hn_scene_check *c, const cJSON *node, hn_part_result *r,
                              hn_diag *diag) {
    const cJSON *neighbours = cJSON_GetObjectItemCaseSensitive(node, "neighbours");
    double links[4];
    int asked = -1, moved = 0;
    bool good;
    char detail[160];
    for (int i = 0; i < 4; i++) {
        asked = strcmp(TYPES[i], hn_part_text(node, "type")) == 0 ? i : asked;
    }
    if (asked < 0 || cJSON_GetArraySize(neighbours) != 2) {
        return fault_of(c, diag, "\"grashof\" needs a type and two neighbours");
    }
    HN_TRY(grashof_links(c, node, links, diag));
    const int type = grashof_type(links);
    if (type < 0) {
        hn_part_wrong(r, "change-point", hn_part_number(node, "share", 0),
                      "shortest and longest link together are as long as the other two: all four "
                      "can lie in one line, and the motion is not determined there");
        return HN_OK;
    }
    HN_TRY(need_circuit(c, r, &good));
    for (int k = 0; k < 2 && good && r->right; k++) {
        const int turns = turns_of(c, cJSON_GetArrayItem(neighbours, k), r);
        moved |= turns > 0 ? 1 << k : 0;
    }
    if (good && r->right && (type != asked || moved != asked)) {
        snprintf(detail, sizeof detail, "by Grashof's criterion a %s, and by its motion a %s",
                 TYPES[type], TYPES[moved]);
        fail_check(node, r, detail);
    }
    return HN_OK;
}

/// The drawn point that leaves the curve: by its label, or the first that the scene traces.
static int find_point(const hn_scene_check *c, const char *label) {
    const hn_drawing d = hn_system_drawing(hn_model_system(c->model));
    for (int i = 0; i < d.n_shapes && strcmp(label, "trace") == 0; i++) {
        if (d.shapes[i].kind == HN_SHAPE_TRACE) {
            return d.shapes[i].p;
        }
    }
    for (int i = 0; i < d.n_points; i++) {
        if (d.labels[i] && strcmp(d.labels[i], label) == 0) {
            return i;
        }
    }
    return -1;
}

/// Distance from (x, y) to the segment between two points.
static double segment_distance(const double *a, const double *b, double x, double y) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], length = dx * dx + dy * dy;
    const double s = length > 0 ? ((x - a[0]) * dx + (y - a[1]) * dy) / length : 0;
    const double at = fmin(fmax(s, 0), 1);
    return hypot(x - a[0] - at * dx, y - a[1] - at * dy);
}

static double curve_distance(const hn_scene_check *c, int point, double x, double y) {
    const size_t stride = 3 * (size_t)c->n_points;
    const double *at = c->points + 3 * point;
    double least = HUGE_VAL;
    for (int k = 0; k + 1 < c->n_path; k++) {
        least = fmin(
            least, segment_distance(at + (size_t)k * stride, at + (size_t)(k + 1) * stride, x, y));
    }
    return least;
}

/// Judges the distances of the curve to the points asked for: k of n earn k/n of the share.
static hn_status judge_curve(hn_scene_check *c, const cJSON *node, int point, hn_part_result *r,
                             hn_diag *diag) {
    const cJSON *m;
    const double within = hn_part_number(node, "within", 0.01);
    char detail[200] = "";
    int n = 0, met = 0;
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(node, "through")) {
        double x, y;
        const char *fx = cJSON_GetStringValue(cJSON_GetArrayItem(m, 0));
        const char *fy = cJSON_GetStringValue(cJSON_GetArrayItem(m, 1));
        if (!fx || !fy || n == MAX_THROUGH) {
            return fault_of(c, diag, "\"through\" takes up to 8 pairs of formulas");
        }
        HN_TRY(hn_draw_value(&c->draw, fx, &x, diag));
        HN_TRY(hn_draw_value(&c->draw, fy, &y, diag));
        const double off = curve_distance(c, point, x, y);
        const size_t used = strlen(detail);
        snprintf(detail + used, sizeof detail - used, "%s%.3g", n ? ", " : "", off);
        met += off <= within;
        n++;
    }
    if (met < n) {
        char words[280];
        snprintf(words, sizeof words, "distances %s m, allowed %.3g m", detail, within);
        fail_check(node, r, words);
        r->alone = hn_part_number(node, "share", 1);
        r->share = r->alone * met / n;
        r->mistake = met ? "some-points" : r->mistake;
    }
    return HN_OK;
}

static hn_status test_curve(hn_scene_check *c, const cJSON *node, hn_part_result *r,
                            hn_diag *diag) {
    bool good;
    const int point = find_point(c, hn_part_text(node, "point"));
    if (point < 0) {
        hn_part_unreadable(r, "the scene draws no point '%.30s'", hn_part_text(node, "point"));
        return HN_OK;
    }

    // a curve that is not closed still has its points
    HN_TRY(need_circuit(c, r, &good));
    return good ? judge_curve(c, node, point, r, diag) : HN_OK;
}

static void add_point(hn_part_view *out, double x, double y, double z) {
    if (out->n_trace < HN_PART_TRACE) {
        double *at = out->trace + 3 * out->n_trace++;
        at[0] = x;
        at[1] = y;
        at[2] = z;
    }
}

/// Two lines that cross at (x, y), each 2 r long.
static void add_cross(hn_part_view *out, double x, double y, double r) {
    const double nan = (double)NAN;
    for (int k = 0; k < 2; k++) {
        add_point(out, nan, nan, nan);
        add_point(out, x - (k ? 0 : r), y - (k ? r : 0), 0);
        add_point(out, x + (k ? 0 : r), y + (k ? r : 0), 0);
    }
}

/// The path of a point in at most `most` points; returns the larger of its two extents.
static double add_path(const hn_scene_check *c, int point, int most, hn_part_view *out) {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int k = 0; k < most && c->n_path > 1; k++) {
        const size_t at = (size_t)k * ((size_t)c->n_path - 1) / ((size_t)most - 1);
        const double *xyz = c->points + 3 * (at * (size_t)c->n_points + (size_t)point);
        add_point(out, xyz[0], xyz[1], xyz[2]);
        for (int i = 0; i < 2; i++) {
            low[i] = fmin(low[i], xyz[i]);
            high[i] = fmax(high[i], xyz[i]);
        }
    }
    return fmax(high[0] - low[0], high[1] - low[1]);
}

void hn_scene_check_draw(hn_scene_check *c, const cJSON *node, hn_part_view *out) {
    enum { LEAST_LEFT = 6 * MAX_THROUGH };
    const int point = find_point(c, hn_part_text(node, "point"));
    const cJSON *m;
    if (strcmp(hn_part_text(node, "test"), "curve") != 0 || point < 0 || walk(c) != HN_OK) {
        return;
    }
    out->n_trace = 0;
    const double size = add_path(c, point, HN_PART_TRACE - LEAST_LEFT, out);
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(node, "through")) {
        double x, y;
        const char *fx = cJSON_GetStringValue(cJSON_GetArrayItem(m, 0));
        const char *fy = cJSON_GetStringValue(cJSON_GetArrayItem(m, 1));
        if (fx && fy && hn_draw_value(&c->draw, fx, &x, NULL) == HN_OK &&
            hn_draw_value(&c->draw, fy, &y, NULL) == HN_OK) {
            add_cross(out, x, y, 0.04 * size);
        }
    }
}

static hn_status test_stays(hn_scene_check *c, const cJSON *node, hn_part_result *r,
                            hn_diag *diag) {
    hn_ex e;
    bool good;
    double least = HUGE_VAL;
    char detail[160];
    HN_TRY(hn_draw_parse(&c->draw, hn_part_text(node, "of"), &e, diag));
    HN_TRY(need_circuit(c, r, &good));
    for (int k = 0; k < c->n_path && good; k++) {
        for (int i = 0; i < c->n_coordinates; i++) {
            const int at = find_name(&c->draw, hn_part_coordinate(c->model, i)->name);
            c->draw.value[0][at] = c->path[(size_t)k * (size_t)c->n_coordinates + (size_t)i];
        }
        least = fmin(least, hn_draw_eval(&c->draw, e, 0));
    }
    if (good && !(least > 0)) {
        snprintf(detail, sizeof detail,
                 "%.80s must stay above 0 on the way round and falls to %.3g",
                 hn_part_text(node, "of"), least);
        fail_check(node, r, detail);
    }
    return HN_OK;
}

static const struct {
    const char *name;
    hn_status (*run)(hn_scene_check *c, const cJSON *node, hn_part_result *r, hn_diag *diag);
} TESTS[] = {{"positive", test_positive},
             {"turns", test_turns},
             {"grashof", test_grashof},
             {"curve", test_curve},
             {"stays", test_stays}};
enum { N_TESTS = sizeof TESTS / sizeof *TESTS };

hn_status hn_scene_check_run(hn_scene_check *c, const cJSON *node, hn_part_result *r,
                             hn_diag *diag) {
    const char *names[N_TESTS], *asked = hn_part_text(node, "test");
    for (int i = 0; i < N_TESTS; i++) {
        names[i] = TESTS[i].name;
        if (strcmp(names[i], asked) == 0) {
            return TESTS[i].run(c, node, r, diag);
        }
    }
    char hint[HN_DIAG_HINT];
    hn_suggest_or_list(hint, asked, names, N_TESTS, "tests: ");
    return hn_diag_set(diag, HN_ERR_INPUT, "/parts/checks", hint,
                       "part %s: there is no test '%.40s'", c->p->id, asked);
}
