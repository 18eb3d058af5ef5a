// The drawing of a scene of bodies and joints that says nothing about it. Each part is made where it was left out:
// * a body that draws nothing itself gets bars through its joints (to its centre of mass if it has one joint only),
//   unless the scene's "draw" has bars or polygons;
// * joints get their symbols and show their names unless "draw" has any of pivots, ground, sliders, guides;
// * springs, dampers and forces get theirs unless "draw" has any of springs, dampers, arrows.

#include "scene/reader.h"

#include <string.h>

static int draw_has(const cJSON *root, const char *const *keys, int n) {
    const cJSON *draw = hn_rd_get(root, "draw");
    for (int i = 0; i < n; i++) {
        if (hn_rd_get(draw, keys[i])) {
            return 1;
        }
    }
    return 0;
}

static int same_place(const hn_quantity *a, const hn_quantity *b) {
    return a[0].value == b[0].value && a[1].value == b[1].value && a[2].value == b[2].value;
}

/// Bars along the places of a body's joints, in the order of the joints; closed if there are three or more.
static void draw_body(hn_reader *r, int body) {
    enum { PLACES = 16 };
    const hn_scene *s = r->scene;
    int p[PLACES], n = 0;
    for (int k = 0; k < s->n_joints && n < PLACES; k++) {
        const hn_joint *j = &s->joints[k];
        if (j->parent != body && j->child != body) {
            continue;
        }
        int place = hn_rd_place(r, body, j->parent == body ? j->parent_at : j->child_at), known = 0;
        for (int i = 0; i < n; i++) {
            known |= p[i] == place;
        }
        if (place >= 0 && !known) {
            p[n++] = place;
        }
    }
    if (n == 1 && !same_place(s->points[p[0]].at, s->bodies[body].com)) {
        p[n++] = hn_rd_place(r, body, s->bodies[body].com);
    }
    for (int i = 0; i + 1 < n && !r->oom; i++) {
        hn_rd_add_shape(r, HN_SHAPE_BAR, p[i], p[i + 1], body);
    }
    if (n > 2) {
        hn_rd_add_shape(r, HN_SHAPE_BAR, p[n - 1], p[0], body);
    }
}

static void draw_bars(hn_reader *r) {
    hn_scene *s = r->scene;
    char *drawn = hn_arena_get(r->arena, (size_t)s->n_bodies + 1);
    if (!drawn) {
        r->oom = 1;
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

static void draw_joint(hn_reader *r, const hn_joint *j) {
    int parent = hn_rd_place(r, j->parent, j->parent_at);
    if (parent < 0) {
        return;
    }
    hn_point *place = &r->scene->points[parent];
    if (!place->name && r->scene->n_joints <= MAX_NAMED_JOINTS) {
        place->name = j->name;
    }
    if (j->type == HN_JOINT_REVOLUTE) {
        int grounded = j->parent == HN_GROUND || j->child == HN_GROUND;
        int ground = j->child == HN_GROUND ? hn_rd_place(r, j->child, j->child_at) : parent;
        hn_rd_add_shape(r, grounded ? HN_SHAPE_GROUND : HN_SHAPE_PIVOT, ground, ground,
                        grounded ? HN_GROUND : j->parent);
        return;
    }
    int far = along(r, j->parent, j->parent_at, j->parent_axis);
    int child = hn_rd_place(r, j->child, j->child_at),
        toward = along(r, j->child, j->child_at, j->child_axis);
    if (far >= 0 && child >= 0 && toward >= 0) {
        hn_rd_add_shape(r, HN_SHAPE_GUIDE, parent, far, j->parent);
        hn_rd_add_shape(r, HN_SHAPE_SLIDER, child, toward, j->child);
    }
}

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

void hn_rd_draw_default(hn_reader *r, const cJSON *root) {
    static const char *const bars[] = {"bars", "polygons"},
                             *const symbols[] = {"pivots", "ground", "sliders", "guides"},
                             *const loads[] = {"springs", "dampers", "arrows"};
    const hn_scene *s = r->scene;
    if (s->is_lagrangian) {
        return;
    }
    if (!draw_has(root, bars, 2)) {
        draw_bars(r);
    }
    for (int k = 0; k < s->n_joints && !hn_rd_stopped(r) && !draw_has(root, symbols, 4); k++) {
        draw_joint(r, &s->joints[k]);
    }
    for (int k = 0; k < s->n_loads && !hn_rd_stopped(r) && !draw_has(root, loads, 3); k++) {
        draw_load(r, &s->loads[k]);
    }
}
