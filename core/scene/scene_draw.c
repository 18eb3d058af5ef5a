// SPDX-License-Identifier: GPL-3.0-or-later
// Points and shapes: what to draw, as the scene says it. What it leaves open is made in
// scene_default.c.

#include "scene/reader.h"

#include <stdio.h>
#include <string.h>

/// Spelling of a shape: on a body ("draw": [{"bar": [..]}]) and in the scene's
/// "draw" block, and its points.
typedef struct shape_row {
    const char *one, *many;
    int min, max; ///< number of points
} shape_row;

static const shape_row ROWS[] = {
    [HN_SHAPE_BAR] = {"bar", "bars", 2, 2},
    [HN_SHAPE_PIVOT] = {"pivot", "pivots", 1, 1},
    [HN_SHAPE_GROUND] = {"ground", "ground", 1, 1},
    [HN_SHAPE_SLIDER] = {"slider", "sliders", 2, 2},
    [HN_SHAPE_GUIDE] = {"guide", "guides", 2, 2},
    [HN_SHAPE_SPRING] = {"spring", "springs", 2, 2},
    [HN_SHAPE_DAMPER] = {"damper", "dampers", 2, 2},
    [HN_SHAPE_ARROW] = {"arrow", "arrows", 1, 1},
    [HN_SHAPE_POLYGON] = {"polygon", "polygons", 3, 1000},
    [HN_SHAPE_TRACE] = {"trace", "traces", 1, 1},
};
enum { N_ROWS = sizeof ROWS / sizeof ROWS[0] };

const char *hn_shape_kind_name(hn_shape_kind kind) {
    HN_ASSERT((int)kind >= 0 && (int)kind < (int)N_ROWS);
    return ROWS[kind].one;
}

// ---- points ----

int hn_rd_add_point(hn_reader *r, const char *name, int body, const hn_quantity at[3]) {
    hn_scene *s = r->scene;
    hn_point *points =
        hn_rd_grow(r, s->points, s->n_points, sizeof *points, HN_RD_MAX_POINTS, "points");
    if (!points) {
        return -1;
    }
    s->points = points;
    points[s->n_points] = (hn_point){.name = name, .body = body};
    memcpy(points[s->n_points].at, at, sizeof points->at);
    return s->n_points++;
}

int hn_rd_place(hn_reader *r, int body, const hn_quantity at[3]) {
    const hn_scene *s = r->scene;
    bool varies = at[0].varies || at[1].varies || at[2].varies;
    for (int i = 0; i < s->n_points && !varies; i++) {
        const hn_point *p = &s->points[i];
        if (p->body == body && p->at[0].value == at[0].value && p->at[1].value == at[1].value &&
            p->at[2].value == at[2].value && !p->at[0].varies && !p->at[1].varies &&
            !p->at[2].varies) {
            return i;
        }
    }
    return hn_rd_add_point(r, NULL, body, at);
}

static int find_point(const hn_scene *s, const char *name) {
    for (int i = 0; i < s->n_points; i++) {
        if (s->points[i].name && strcmp(s->points[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

static int named_point(hn_reader *r, const char *raw) {
    enum { ROOM = 512 };
    const char *names[ROOM], *name = hn_rd_fill(r, raw);
    int n = 0, p = name ? find_point(r->scene, name) : -1;
    if (!name || p >= 0) {
        return p;
    }
    for (int i = 0; i < r->scene->n_points && n < ROOM; i++) {
        if (r->scene->points[i].name) {
            names[n++] = r->scene->points[i].name;
        }
    }
    char hint[HN_DIAG_HINT];
    hn_rd_suggest(hint, sizeof hint, name, names, n);
    hn_rd_fault(r, hint, "there is no point named '%.60s' in draw.points", name);
    return -1;
}

/// {"body": .., "at": [..]} -> body and place; 0 after a fault.
static bool read_on_body(hn_reader *r, const cJSON *node, int *body, hn_quantity at[3]) {
    static const char *const fields[] = {"body", "at", "for"};
    if (r->scene->is_lagrangian) {
        return hn_rd_fault(r, "as in [\"l1*cos(th1)\", \"l1*sin(th1)\"]",
                           "a Lagrangian scene has no bodies: its points are lists of formulas");
    }
    if (!hn_rd_object(r, node, "a point", fields, 3)) {
        return false;
    }
    *body = hn_rd_body(r, node, "body");
    const cJSON *where = hn_rd_get(node, "at");
    size_t mark = hn_rd_enter(r, "at");
    int ok = where ? hn_rd_vector(r, where, at, HN_RD_CONST)
                   : hn_rd_fault(r, NULL, "the field 'at' is missing");
    hn_rd_leave(r, mark);
    return ok && *body != -2;
}

int hn_rd_point(hn_reader *r, const cJSON *node, int body) {
    hn_quantity at[3] = {0};
    if (cJSON_IsString(node)) {
        return named_point(r, node->valuestring);
    }
    if (cJSON_IsObject(node)) {
        return read_on_body(r, node, &body, at) ? hn_rd_place(r, body, at) : -1;
    }
    if (!cJSON_IsArray(node)) {
        hn_rd_fault(r, NULL, "expected a point (a name, [x, y, z] or {\"body\", \"at\"}), found %s",
                    hn_rd_kind(node));
        return -1;
    }
    return hn_rd_vector(r, node, at, r->scene->is_lagrangian ? HN_RD_POSE : HN_RD_CONST)
               ? hn_rd_place(r, body, at)
               : -1;
}

/// Member of draw.points.
static void read_named(hn_reader *r, const cJSON *node, const char *key) {
    static const char *const fields[] = {"at", "for"};
    const char *name = hn_rd_fill(r, key);
    hn_quantity at[3] = {0};
    int body = HN_GROUND, ok;
    const cJSON *list = node;

    // on a body, or in world axes (of a Lagrangian: with formulas in coordinates)
    if (cJSON_IsObject(node) && (hn_rd_get(node, "body") || !hn_rd_get(node, "for"))) {
        ok = read_on_body(r, node, &body, at);
    } else {
        if (cJSON_IsObject(node)) {
            hn_rd_object(r, node, "a point", fields, 2);
            list = hn_rd_get(node, "at");
        }
        ok = hn_rd_vector(r, list, at, r->scene->is_lagrangian ? HN_RD_POSE : HN_RD_CONST);
    }

    // a fault above was reported there
    if (!name || !ok) {
        return;
    }
    if (name[0] == '\0' || strlen(name) > HN_RD_MAX_NAME) {
        hn_rd_fault(r, NULL, "expected a name of 1 to %d characters", HN_RD_MAX_NAME);
    } else if (find_point(r->scene, name) >= 0) {
        hn_rd_fault(r, NULL, "the point '%s' is given twice", name);
    } else {
        hn_rd_add_point(r, name, body, at);
    }
}

void hn_rd_points(hn_reader *r, const cJSON *root) {
    const cJSON *draw = hn_rd_get(root, "draw"), *points = hn_rd_get(draw, "points");
    size_t mark = hn_rd_enter(r, "draw");
    size_t inner = hn_rd_enter(r, "points");
    if (points && !cJSON_IsObject(points)) {
        hn_rd_fault(r, "as in {\"A\": [1, 0]}", "expected an object of named points, found %s",
                    hn_rd_kind(points));
    } else {
        hn_rd_each(r, points, read_named);
    }
    hn_rd_leave(r, inner);
    hn_rd_leave(r, mark);
}

// ---- shapes ----

hn_shape *hn_rd_add_shape(hn_reader *r, hn_shape_kind kind, int p, int q, int body) {
    hn_scene *s = r->scene;
    hn_shape *shapes =
        hn_rd_grow(r, s->shapes, s->n_shapes, sizeof *shapes, HN_RD_MAX_SHAPES, "shapes");
    if (!shapes) {
        return NULL;
    }
    s->shapes = shapes;
    shapes[s->n_shapes] =
        (hn_shape){.kind = kind, .p = p, .q = q, .n = ROWS[kind].min, .body = body};
    return &shapes[s->n_shapes++];
}

/// The body all points of a shape belong to, or ground.
static int common_body(const hn_scene *s, const int *points, int n) {
    int body = n > 0 ? s->points[points[0]].body : HN_GROUND;
    for (int i = 1; i < n; i++) {
        body = s->points[points[i]].body == body ? body : HN_GROUND;
    }
    return body;
}

/// Copies the points of a polygon one behind the other. The first, or
/// -1.
static int line_up(hn_reader *r, const int *points, int n) {
    int first = r->scene->n_points;
    for (int i = 0; i < n; i++) {
        hn_point copy = r->scene->points[points[i]];
        if (hn_rd_add_point(r, NULL, copy.body, copy.at) < 0) {
            return -1;
        }
    }
    return first;
}

/// Resolves the points of one shape (one: the node itself; more: a list) and adds it. `body`: lists
/// are places on it.
static void read_one(hn_reader *r, const cJSON *node, hn_shape_kind kind, int body, double width) {
    const shape_row *row = &ROWS[kind];
    int n = row->max == 1 ? 1 : cJSON_IsArray(node) ? cJSON_GetArraySize(node) : 0;
    if (n < row->min || n > row->max) {
        hn_rd_fault(r, NULL, "a %s is a list of %d%s points, found %s%s", row->one, row->min,
                    row->max > row->min ? " or more" : "", hn_rd_kind(node),
                    cJSON_IsArray(node) ? " of another length" : "");
        return;
    }

    // the points, each found or made
    int *p = hn_arena_ints(r->arena, (size_t)n);
    if (!p) {
        r->oom = true;
        return;
    }
    const cJSON *item = row->max == 1 ? node : node->child;
    for (int i = 0; i < n; i++, item = item->next) {
        size_t mark = row->max == 1 ? strlen(r->path) : hn_rd_enter_index(r, i);
        p[i] = hn_rd_point(r, item, body);
        hn_rd_leave(r, mark);
        if (p[i] < 0) {
            return;
        }
    }

    // the body that owns them gives the colour
    int owner = body != HN_GROUND ? body : common_body(r->scene, p, n);
    int first = kind == HN_SHAPE_POLYGON ? line_up(r, p, n) : p[0];
    hn_shape *shape = first >= 0
                          ? hn_rd_add_shape(r, kind, first,
                                            n > 1 && kind != HN_SHAPE_POLYGON ? p[1] : first, owner)
                          : NULL;
    if (shape) {
        shape->n = n;
        shape->width = width;
    }
}

static double read_width(hn_reader *r, const cJSON *node) {
    hn_quantity width;
    if (hn_rd_member(r, node, "width", 0, 0, &width, HN_RD_CONST) && width.value < 0) {
        hn_rd_fault_at(r, "width", NULL, "a width of %g m is negative", width.value);
    }
    return width.value;
}

/// An entry of a body's "draw": {"bar": [p, q], "width": w}. The body is `body_at`.
static void read_on_own_body(hn_reader *r, const cJSON *node, const char *key) {
    const char *fields[N_ROWS + 2] = {"width", "for"};
    int kind = -1, n = 0;
    (void)key;

    // the member that names the kind, and how many there are
    for (int k = 0; k < N_ROWS; k++) {
        fields[k + 2] = ROWS[k].one;
        if (hn_rd_get(node, ROWS[k].one)) {
            kind = k;
            n++;
        }
    }
    int faults = r->n_faults;
    hn_rd_object(r, node, "a shape", fields, N_ROWS + 2);

    // no kind, or two at once
    if (n != 1 || r->n_faults > faults) {
        if (r->n_faults == faults) {
            hn_rd_fault(r, "as in {\"bar\": [[0, 0], [\"l1\", 0]]}",
                        "expected one kind of shape, found %d", n);
        }
        return;
    }

    // the kind reads its points
    double width = read_width(r, node);
    size_t mark = hn_rd_enter(r, ROWS[kind].one);
    read_one(r, hn_rd_get(node, ROWS[kind].one), (hn_shape_kind)kind, r->body_at, width);
    hn_rd_leave(r, mark);
}

/// A body a second time, when all points and bodies are known: its own drawing.
static void read_body_draw(hn_reader *r, const cJSON *node, const char *key) {
    const cJSON *draw = hn_rd_get(node, "draw");
    (void)key;
    size_t mark = hn_rd_enter(r, "draw");
    if (draw && !cJSON_IsArray(draw)) {
        hn_rd_fault(r, "as in [{\"bar\": [[0, 0], [\"l1\", 0]]}]",
                    "expected a list of shapes, found %s", hn_rd_kind(draw));
    } else {
        int index = 0;
        for (const cJSON *m = draw ? draw->child : NULL; m && !hn_rd_stopped(r);
             m = m->next, index++) {
            size_t inner = hn_rd_enter_index(r, index);
            read_on_own_body(r, m, NULL);
            hn_rd_leave(r, inner);
        }
    }
    hn_rd_leave(r, mark);
    r->body_at++;
}

/// An entry of a list of the scene's "draw": the point(s), or {"points": .., "width": .., "for":
/// ..}.
static void read_listed(hn_reader *r, const cJSON *node, const char *key) {
    static const char *const fields[] = {"points", "width", "for"};
    hn_shape_kind kind = (hn_shape_kind)r->shape_kind;
    (void)key;
    if (!cJSON_IsObject(node) || hn_rd_get(node, "body")) {
        read_one(r, node, kind, HN_GROUND, 0);
        return;
    }
    hn_rd_object(r, node, "a shape", fields, 3);
    double width = read_width(r, node);
    const cJSON *points = hn_rd_get(node, "points");
    size_t mark = hn_rd_enter(r, "points");
    read_one(r, points, kind, HN_GROUND, width);
    hn_rd_leave(r, mark);
}

/// A pair of points that coincide when the loop is closed (Lagrangian scenes).
static void read_tear(hn_reader *r, const cJSON *node, const char *key) {
    hn_scene *s = r->scene;
    int ends[2];
    (void)key;
    if (!cJSON_IsArray(node) || cJSON_GetArraySize(node) != 2) {
        hn_rd_fault(r, "as in [\"P\", \"Q\"]", "a tear is a list of two points, found %s",
                    hn_rd_kind(node));
        return;
    }
    for (int i = 0; i < 2; i++) {
        size_t mark = hn_rd_enter_index(r, i);
        ends[i] = hn_rd_point(r, cJSON_GetArrayItem(node, i), HN_GROUND);
        hn_rd_leave(r, mark);
    }
    int(*tears)[2] =
        hn_rd_grow(r, s->tears, s->n_tears, sizeof *tears, HN_SCENE_MAX_JOINTS, "tears");
    if (tears && ends[0] >= 0 && ends[1] >= 0) {
        s->tears = tears;
        memcpy(tears[s->n_tears++], ends, sizeof ends);
    }
}

static void read_list(hn_reader *r, const cJSON *draw, const char *key, hn_rd_item item) {
    const cJSON *list = hn_rd_get(draw, key);
    size_t mark = hn_rd_enter(r, key);
    if (list && !cJSON_IsArray(list)) {
        hn_rd_fault(r, NULL, "expected a list, found %s", hn_rd_kind(list));
    } else {
        hn_rd_each(r, list, item);
    }
    hn_rd_leave(r, mark);
}

void hn_rd_shapes(hn_reader *r, const cJSON *root) {
    const char *fields[N_ROWS + 2] = {"points", "tears"};
    const cJSON *bodies = hn_rd_get(root, "bodies"), *draw = hn_rd_get(root, "draw");

    // what bodies draw themselves
    size_t mark = hn_rd_enter(r, "bodies");
    r->body_at = 0;
    if (cJSON_IsArray(bodies)) {
        hn_rd_each(r, bodies, read_body_draw);
    }
    hn_rd_leave(r, mark);

    // what the scene draws
    mark = hn_rd_enter(r, "draw");
    for (int k = 0; k < N_ROWS; k++) {
        fields[k + 2] = ROWS[k].many;
    }
    if (draw && hn_rd_object(r, draw, "a drawing", fields, N_ROWS + 2)) {
        for (r->shape_kind = 0; r->shape_kind < N_ROWS; r->shape_kind++) {
            read_list(r, draw, ROWS[r->shape_kind].many, read_listed);
        }
        if (hn_rd_get(draw, "tears") && !r->scene->is_lagrangian) {
            hn_rd_fault_at(r, "tears", "leave it out",
                           "the tears of bodies and joints follow from the joints that are cut");
        } else {
            read_list(r, draw, "tears", read_tear);
        }
    }
    hn_rd_leave(r, mark);
}
