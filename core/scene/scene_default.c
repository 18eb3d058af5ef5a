// SPDX-License-Identifier: GPL-3.0-or-later
// The drawing of a scene of bodies and joints that says nothing about it. Each part is made where
// it was left out:
// * a body that draws nothing itself gets bars through its joints and the ends of its rods (to its
//   centre of mass if there is one only; along its principal extents if there is none), unless the
//   scene's "draw" has bars or polygons;
// * joints get their symbols and show their names unless "draw" has any of pivots, ground, sliders,
//   guides;
// * constraints beside the joints get theirs under the same condition;
// * springs, dampers and forces get theirs unless "draw" has any of springs, dampers, arrows.

#include "scene/reader.h"

#include <math.h>
#include <string.h>

static bool draw_has(const cJSON *root, const char *const *keys, int n) {
    const cJSON *draw = hn_rd_get(root, "draw");
    for (int i = 0; i < n; i++) {
        if (hn_rd_get(draw, keys[i])) {
            return true;
        }
    }
    return false;
}

static bool same_place(const hn_quantity *a, const hn_quantity *b) {
    return a[0].value == b[0].value && a[1].value == b[1].value && a[2].value == b[2].value;
}

enum { PLACES = 16 }; ///< of one body, as far as they are drawn

static void add_place(int p[PLACES], int *n, int place) {
    for (int i = 0; i < *n; i++) {
        if (p[i] == place) {
            return;
        }
    }
    if (place >= 0 && *n < PLACES) {
        p[(*n)++] = place;
    }
}

/// Returns where joints and constraints hold a body, in their order. A free joint holds nothing.
static int collect_places(hn_reader *r, int body, int p[PLACES]) {
    const hn_scene *s = r->scene;
    int n = 0;
    for (int k = 0; k < s->n_joints && n < PLACES; k++) {
        const hn_joint *j = &s->joints[k];
        if ((j->parent == body || j->child == body) && j->type != HN_JOINT_FREE) {
            add_place(p, &n, hn_rd_place(r, body, j->parent == body ? j->parent_at : j->child_at));
        }
    }
    for (int k = 0; k < s->n_constraints && n < PLACES; k++) {
        int end[2] = {s->constraints[k].p, s->constraints[k].q};
        for (int i = 0; i < 2; i++) {
            if (end[i] >= 0 && s->points[end[i]].body == body) {
                add_place(p, &n, end[i]);
            }
        }
    }
    return n;
}

/// A body that nothing holds: bars through its centre of mass as long as the edges of the block
/// that has its mass and its moments about the body's axes; a pin for a point mass.
static void draw_extents(hn_reader *r, int body) {
    const hn_body *b = &r->scene->bodies[body];
    double trace = b->inertia[0].value + b->inertia[1].value + b->inertia[2].value;
    int drawn = 0;

    // a bar along each axis that has an extent
    for (int k = 0; k < 3 && b->mass.value > 0; k++) {
        double half = sqrt(fmax(0, 1.5 * (trace - 2 * b->inertia[k].value) / b->mass.value));
        hn_quantity end[2][3];
        memcpy(end[0], b->com, sizeof end[0]);
        memcpy(end[1], b->com, sizeof end[1]);
        for (int i = 0; i < 3; i++) {
            end[0][i].formula = end[1][i].formula = NULL;
        }
        end[0][k].value -= half;
        end[1][k].value += half;
        if (half > 0) {
            int p = hn_rd_place(r, body, end[0]), q = hn_rd_place(r, body, end[1]);
            drawn |= p >= 0 && q >= 0 && hn_rd_add_shape(r, HN_SHAPE_BAR, p, q, body);
        }
    }

    // a point mass is a pin
    int p = drawn ? -1 : hn_rd_place(r, body, b->com);
    if (p >= 0) {
        hn_rd_add_shape(r, HN_SHAPE_PIVOT, p, p, body);
    }
}

/// Bars along the places of a body, closed if there are three or more.
static void draw_body(hn_reader *r, int body) {
    const hn_scene *s = r->scene;
    int p[PLACES], n = collect_places(r, body, p);
    if (n == 1 && !same_place(s->points[p[0]].at, s->bodies[body].com)) {
        p[n++] = hn_rd_place(r, body, s->bodies[body].com);
    }
    for (int i = 0; i + 1 < n && !r->oom; i++) {
        hn_rd_add_shape(r, HN_SHAPE_BAR, p[i], p[i + 1], body);
    }
    if (n > 2) {
        hn_rd_add_shape(r, HN_SHAPE_BAR, p[n - 1], p[0], body);
    }
    if (n == 0) {
        draw_extents(r, body);
    }
}

static void draw_bars(hn_reader *r) {
    hn_scene *s = r->scene;
    char *drawn = hn_arena_get(r->arena, (size_t)s->n_bodies + 1);
    if (!drawn) {
        r->oom = true;
        return;
    }
    for (int i = 0; i < s->n_shapes; i++) {
        if (s->shapes[i].body != HN_GROUND && s->shapes[i].kind != HN_SHAPE_TRACE) {
            drawn[s->shapes[i].body] = 1;
        }
    }
    for (int body = 0; body < s->n_bodies && !hn_rd_stopped(r); body++) {
        if (!drawn[body]) {
            draw_body(r, body);
        }
    }
}

/// The place one metre along `axis` from `at`: the second point of sliders and guides.
static int along(hn_reader *r, int body, const hn_quantity at[3], const double axis[3]) {
    hn_quantity q[3] = {0};
    for (int k = 0; k < 3; k++) {
        q[k].value = at[k].value + axis[k];
    }
    return hn_rd_place(r, body, q);
}

/// More names than this would hide the mechanism.
enum { MAX_NAMED_JOINTS = 12 };

static void draw_pin(hn_reader *r, const hn_joint *j, int parent) {
    bool grounded = j->parent == HN_GROUND || j->child == HN_GROUND;
    int ground = j->child == HN_GROUND ? hn_rd_place(r, j->child, j->child_at) : parent;
    hn_rd_add_shape(r, grounded ? HN_SHAPE_GROUND : HN_SHAPE_PIVOT, ground, ground,
                    grounded ? HN_GROUND : j->parent);
}

static void draw_slide(hn_reader *r, const hn_joint *j, int parent) {
    int far = along(r, j->parent, j->parent_at, j->parent_axis);
    int child = hn_rd_place(r, j->child, j->child_at),
        toward = along(r, j->child, j->child_at, j->child_axis);
    if (far >= 0 && child >= 0 && toward >= 0) {
        hn_rd_add_shape(r, HN_SHAPE_GUIDE, parent, far, j->parent);
        hn_rd_add_shape(r, HN_SHAPE_SLIDER, child, toward, j->child);
    }
}

/// The child's place rides in the plane: its pin.
static void draw_rider(hn_reader *r, const hn_joint *j, int parent) {
    (void)parent;
    int child = hn_rd_place(r, j->child, j->child_at);
    if (child >= 0) {
        hn_rd_add_shape(r, HN_SHAPE_PIVOT, child, child, j->child);
    }
}

/// Drawing function of each type; NULL: not drawn, for nothing moves there, or nothing holds.
static void (*const DRAW_JOINT[HN_JOINT_TYPE_COUNT])(hn_reader *, const hn_joint *, int parent) = {
    [HN_JOINT_REVOLUTE] = draw_pin,      [HN_JOINT_PRISMATIC] = draw_slide,
    [HN_JOINT_CYLINDRICAL] = draw_slide, [HN_JOINT_UNIVERSAL] = draw_pin,
    [HN_JOINT_SPHERICAL] = draw_pin,     [HN_JOINT_PLANAR] = draw_rider,
};

static void draw_joint(hn_reader *r, const hn_joint *j) {
    if (!DRAW_JOINT[j->type] || j->is_formal) {
        return;
    }
    int parent = hn_rd_place(r, j->parent, j->parent_at);
    if (parent < 0) {
        return;
    }
    hn_point *place = &r->scene->points[parent];
    if (!place->name && r->scene->n_joints <= MAX_NAMED_JOINTS) {
        place->name = j->name;
    }
    DRAW_JOINT[j->type](r, j, parent);
}

// ---- constraints ----

static void draw_rod(hn_reader *r, const hn_constraint *c) {
    hn_shape *bar = hn_rd_add_shape(r, HN_SHAPE_BAR, c->p, c->q, HN_GROUND);
    if (bar) {
        bar->width = c->value.value / 50; // thinner than a body's
    }
}

/// The line through c's point q, moved by `offset` along `normal`.
static void draw_guide(hn_reader *r, const hn_constraint *c, const double direction[3],
                       const double normal[3], double offset) {
    const hn_point *q = &r->scene->points[c->q];
    hn_quantity at[3];
    for (int k = 0; k < 3; k++) {
        at[k] = (hn_quantity){.value = q->at[k].value + offset * normal[k]};
    }
    int body = q->body, start = hn_rd_place(r, body, at), far = along(r, body, at, direction);
    if (start >= 0 && far >= 0) {
        hn_rd_add_shape(r, HN_SHAPE_GUIDE, start, far, body);
        hn_rd_add_shape(r, HN_SHAPE_PIVOT, c->p, c->p, r->scene->points[c->p].body);
    }
}

static void draw_line(hn_reader *r, const hn_constraint *c) {
    draw_guide(r, c, c->direction, c->direction, 0);
}

/// Its trace in the plane of the drawing, or any line in it when it is seen from the front.
static void draw_plane(hn_reader *r, const hn_constraint *c) {
    const double *n = c->direction;
    double length = hypot(n[0], n[1]), line[3] = {-n[1] / length, n[0] / length, 0};
    if (!(length > 1e-9)) {
        hn_rd_default_normal(n, line);
    }
    draw_guide(r, c, line, n, c->value.value);
}

/// The line that a wheel rolls on, as a bar beneath it as long as three turns to each side of its
/// point.
static void draw_road(hn_reader *r, const hn_constraint *c) {
    const hn_point line = r->scene->points[c->q];
    double radius = c->value.value, width = radius / 20;
    int end[2];
    for (int i = 0; i < 2; i++) {
        hn_quantity at[3];
        for (int k = 0; k < 3; k++) {
            at[k] = (hn_quantity){.value = line.at[k].value - width / 2 * c->up[k] +
                                           (i ? 20 : -20) * radius * c->direction[k]};
        }
        end[i] = hn_rd_place(r, line.body, at);
    }
    hn_shape *bar = end[0] >= 0 && end[1] >= 0
                        ? hn_rd_add_shape(r, HN_SHAPE_BAR, end[0], end[1], line.body)
                        : NULL;
    if (bar) {
        bar->width = width;
    }
}

/// The wheel's rim about its centre, a spoke that shows how it turns, and the line it rolls on.
static void draw_wheel(hn_reader *r, const hn_constraint *c) {
    enum { CORNERS = 32 };
    const double turn = 2 * acos(-1) / CORNERS;
    const hn_point centre = r->scene->points[c->p];
    int first = -1;

    // corners of the rim
    for (int i = 0; i < CORNERS; i++) {
        hn_quantity at[3];
        for (int k = 0; k < 3; k++) {
            at[k] = (hn_quantity){.value = centre.at[k].value +
                                           c->value.value * (cos(i * turn) * c->direction[k] +
                                                             sin(i * turn) * c->up[k])};
        }
        int p = hn_rd_add_point(r, NULL, centre.body, at);
        if (p < 0) {
            return;
        }
        first = i == 0 ? p : first;
    }

    // rim, spoke and road
    hn_shape *rim = hn_rd_add_shape(r, HN_SHAPE_POLYGON, first, first, centre.body);
    if (rim) {
        rim->n = CORNERS;
        hn_rd_add_shape(r, HN_SHAPE_BAR, c->p, first, centre.body);
        draw_road(r, c);
    }
}

static void (*const DRAW_CONSTRAINT[])(hn_reader *, const hn_constraint *) = {
    [HN_CONSTRAINT_DISTANCE] = draw_rod,  [HN_CONSTRAINT_LINE] = draw_line,
    [HN_CONSTRAINT_PLANE] = draw_plane,   [HN_CONSTRAINT_GEAR] = NULL,
    [HN_CONSTRAINT_ROLLING] = draw_wheel, [HN_CONSTRAINT_FORMULA] = NULL,
};

// ---- loads ----

static void draw_load(hn_reader *r, const hn_load *load) {
    if (load->kind == HN_LOAD_SPRING) {
        if (load->stiffness.value != 0) {
            hn_rd_add_shape(r, HN_SHAPE_SPRING, load->p, load->q, HN_GROUND);
        }
        if (load->damping.value != 0) {
            hn_rd_add_shape(r, HN_SHAPE_DAMPER, load->p, load->q, HN_GROUND);
        }
    } else if (load->kind == HN_LOAD_FORCE) {
        hn_rd_add_shape(r, HN_SHAPE_ARROW, load->p, load->p, r->scene->points[load->p].body);
    }
}

// ---- symbols ----

static bool is_at(const hn_point *point, int body, const hn_quantity at[3]) {
    return point->body == body && same_place(point->at, at);
}

/// Says of each pivot and support whether a ball joint or a universal joint is there, whoever drew
/// it.
static void name_symbols(const hn_reader *r) {
    const hn_scene *s = r->scene;
    for (int i = 0; i < s->n_shapes; i++) {
        hn_shape *shape = &s->shapes[i];
        const bool is_pin = shape->kind == HN_SHAPE_PIVOT || shape->kind == HN_SHAPE_GROUND;
        for (int k = 0; k < s->n_joints && is_pin; k++) {
            const hn_joint *j = &s->joints[k];
            const hn_point *point = &s->points[shape->p];
            const bool turns = j->type == HN_JOINT_SPHERICAL || j->type == HN_JOINT_UNIVERSAL;
            if (turns && !j->is_formal &&
                (is_at(point, j->parent, j->parent_at) || is_at(point, j->child, j->child_at))) {
                shape->joint = j->type;
            }
        }
    }
}

void hn_rd_draw_default(hn_reader *r, const cJSON *root) {
    static const char *const bars[] = {"bars", "polygons"},
                             *const symbols[] = {"pivots", "ground", "sliders", "guides"},
                             *const loads[] = {"springs", "dampers", "arrows"};
    const hn_scene *s = r->scene;
    if (s->is_lagrangian) {
        return;
    }

    // each group is drawn by the scene, or made here
    if (!draw_has(root, bars, 2)) {
        draw_bars(r);
    }
    for (int k = 0; k < s->n_joints && !hn_rd_stopped(r) && !draw_has(root, symbols, 4); k++) {
        draw_joint(r, &s->joints[k]);
    }
    for (int k = 0; k < s->n_constraints && !hn_rd_stopped(r) && !draw_has(root, symbols, 4); k++) {
        if (DRAW_CONSTRAINT[s->constraints[k].kind]) {
            DRAW_CONSTRAINT[s->constraints[k].kind](r, &s->constraints[k]);
        }
    }
    for (int k = 0; k < s->n_loads && !hn_rd_stopped(r) && !draw_has(root, loads, 3); k++) {
        draw_load(r, &s->loads[k]);
    }
    name_symbols(r);
}
