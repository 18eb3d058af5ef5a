// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/drawing.h"

#include "dynamics/compile/system_impl.h"

/// The scene's own point at a half-joint, so that the bars that end there are known to; else the
/// point added for it.
static int half_joint_point(const hn_system *sys, int loop, int half) {
    const hn_scene *scene = sys->scene;
    const hn_joint *joint = &scene->joints[sys->tree.cut[loop]];
    const int body = half ? joint->child : joint->parent;
    const hn_quantity *at = half ? joint->child_at : joint->parent_at;
    for (int i = 0; i < scene->n_points; i++) {
        const hn_point *p = &scene->points[i];
        if (p->body == body && p->at[0].value == at[0].value && p->at[1].value == at[1].value &&
            p->at[2].value == at[2].value) {
            return i;
        }
    }
    return scene->n_points + 2 * loop + half;
}

/// The pair of points that part when a loop of bodies does not close; coordinates that part have
/// none.
static void name_tear(const hn_system *sys, int k, int (*tears)[2], const char **names) {
    const hn_loop *loop = &sys->loops[k];
    if (loop->tear < 0) {
        return;
    }
    names[loop->tear] = loop->name;
    if (loop->constraint >= 0) {
        tears[loop->tear][0] = sys->scene->constraints[loop->constraint].p;
        tears[loop->tear][1] = sys->scene->n_points + sys->tree.n_cut + loop->tear;
        return;
    }
    for (int half = 0; half < 2; half++) {
        tears[loop->tear][half] = half_joint_point(sys, k, half);
    }
}

/// Bodies and joints: points of the scene, then the two half-joints of every cut joint, then where
/// the points of constraints should be. Lagrangian: the scene's own tears.
hn_status hn_system_make_drawing(hn_system *sys, int n_tears) {
    const hn_scene *scene = sys->scene;
    size_t n = (size_t)n_tears + 1;
    const char **labels =
        hn_arena_get(sys->arena, ((size_t)sys->info.n_points + 1) * sizeof *labels);
    int(*tears)[2] = hn_arena_get(sys->arena, n * sizeof *tears);
    const char **names = hn_arena_get(sys->arena, n * sizeof *names);
    if (!labels || !tears || !names) {
        return HN_ERR_MEMORY;
    }

    // labels, and the pairs of points that part
    for (int i = 0; i < scene->n_points; i++) {
        labels[i] = scene->points[i].name;
    }
    for (int i = 0; i < n_tears && scene->is_lagrangian; i++) {
        tears[i][0] = scene->tears[i][0];
        tears[i][1] = scene->tears[i][1];
        names[i] = "loop"; // formulas do not say which tear is theirs
    }
    for (int k = 0; k < sys->n_loops && !scene->is_lagrangian; k++) {
        name_tear(sys, k, tears, names);
    }

    sys->drawing = (hn_drawing){.n_points = sys->info.n_points,
                                .labels = labels,
                                .n_shapes = scene->n_shapes,
                                .shapes = scene->shapes,
                                .n_tears = n_tears,
                                .tears = (const int(*)[2])tears,
                                .tear_names = names};
    return HN_OK;
}

hn_drawing hn_system_drawing(const hn_system *sys) {
    return sys->drawing;
}

static void write_shape(hn_strbuf *b, const hn_shape *shape) {
    hn_json_object(b);
    hn_json_put_string(b, "kind", hn_shape_kind_name(shape->kind));
    hn_json_put_int(b, "p", shape->p);
    hn_json_put_int(b, "q", shape->q);
    hn_json_put_int(b, "n", shape->n);
    hn_json_put_number(b, "width", shape->width);
    hn_json_put_int(b, "body", shape->body);
    hn_json_end_object(b);
}

void hn_drawing_json(hn_strbuf *b, const hn_system *sys) {
    const hn_drawing *d = &sys->drawing;
    hn_json_object(b);
    hn_json_put_int(b, "points", d->n_points);
    hn_json_key(b, "labels");
    hn_json_strings(b, d->labels, (size_t)d->n_points);

    // what to draw
    hn_json_key(b, "shapes");
    hn_json_array(b);
    for (int i = 0; i < d->n_shapes; i++) {
        write_shape(b, &d->shapes[i]);
    }
    hn_json_end_array(b);

    // the pairs of points that part when a loop opens
    hn_json_key(b, "tears");
    hn_json_array(b);
    for (int i = 0; i < d->n_tears; i++) {
        hn_json_object(b);
        hn_json_put_int(b, "p", d->tears[i][0]);
        hn_json_put_int(b, "q", d->tears[i][1]);
        hn_json_put_string(b, "name", d->tear_names[i]);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}
