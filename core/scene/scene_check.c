// SPDX-License-Identifier: GPL-3.0-or-later
// Facts about the scene as a whole: names that clash, inertia that no body has, bodies that hang in
// the air.

#include "scene/reader.h"

#include "expr/ops.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the tree ----

static int compare_names(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static void check_keys(hn_reader *r, const cJSON *node) {
    int n = cJSON_GetArraySize(node), i = 0;
    const char **keys = n > 1 ? malloc((size_t)n * sizeof *keys) : NULL;
    if (!keys) {
        r->oom |= n > 1;
        return;
    }
    for (const cJSON *m = node->child; m; m = m->next) {
        keys[i++] = m->string;
    }
    qsort(keys, (size_t)n, sizeof *keys, compare_names);
    for (i = 1; i < n && !hn_rd_stopped(r); i++) {
        if (strcmp(keys[i - 1], keys[i]) == 0) {
            hn_rd_fault_at(r, keys[i], NULL, "the field '%.60s' is given twice in this object",
                           keys[i]);
        }
    }
    free(keys);
}

void hn_rd_check_tree(hn_reader *r, const cJSON *node) {
    int index = 0;
    if (cJSON_IsObject(node)) {
        check_keys(r, node);
    }
    for (const cJSON *m = node->child; m && !hn_rd_stopped(r); m = m->next, index++) {
        if (!m->child) {
            continue;
        }
        size_t mark =
            cJSON_IsObject(node) ? hn_rd_enter(r, m->string) : hn_rd_enter_index(r, index);
        hn_rd_check_tree(r, m);
        hn_rd_leave(r, mark);
    }
}

// ---- names ----

static const char *taken(const hn_reader *r, const char *name) {
    static const char *const by[] = {NULL, "a parameter", "a coordinate", "a rate"};
    int index;
    if (strcmp(name, "t") == 0) {
        return "the time";
    }
    return hn_op_find(name) != HN_OP_COUNT ? "a function" : by[hn_rd_find_name(r, name, &index)];
}

bool hn_rd_check_identifier(hn_reader *r, const char *name) {
    bool ok = isalpha((unsigned char)name[0]) || name[0] == '_';
    for (const char *c = name; *c && ok; c++) {
        ok = isalnum((unsigned char)*c) || *c == '_';
    }
    if (!ok || strlen(name) > HN_RD_MAX_NAME) {
        return hn_rd_fault(
            r, "letters, digits and _, not starting with a digit; at most 60 characters",
            "'%.60s' cannot be a name in formulas", name);
    }
    const char *by = taken(r, name);
    return by ? hn_rd_fault(r, NULL, "the name '%s' is taken already (%s)", name, by) : 1;
}

bool hn_rd_check_no_turn(hn_reader *r, int coordinate) {
    const hn_coordinate *c = &r->scene->coordinates[coordinate];
    return c->turn < 0 ||
           hn_rd_fault(r,
                       "its rate can be used; a universal joint has angles that formulas can use",
                       "'%s' is an entry of the rotation vector of the joint '%s': it can be given "
                       "at the start, but no formula and no load can use it",
                       c->name, r->scene->joints[c->joint].name);
}

// ---- inertia ----

/// A tensor belongs to a body of positive mass exactly when S = (trace I / 2) 1 - I, the second
/// moments of its mass, has no negative eigenvalue: that contains both I >= 0 and the triangle
/// inequality of the principal moments. All principal minors of S are checked, with room for
/// rounding.
void hn_rd_check_inertia(hn_reader *r, const hn_body *b) {
    const hn_quantity *I = b->inertia;
    double xx = I[0].value, yy = I[1].value, zz = I[2].value, half = (xx + yy + zz) / 2;
    double size =
        fabs(xx) + fabs(yy) + fabs(zz) + fabs(I[3].value) + fabs(I[4].value) + fabs(I[5].value);
    if (size == 0) {
        return;
    }

    // inertia without mass and a negative moment have plainer messages of their own
    if (b->mass.value == 0) {
        hn_rd_fault_at(r, "inertia", "give it a mass, or leave 'inertia' out",
                       "the body '%s' has inertia but no mass", b->name);
        return;
    }
    static const char *const names[] = {"xx", "yy", "zz"};
    for (int k = 0; k < 3; k++) {
        if (I[k].value < 0) {
            hn_rd_fault_at(r, "inertia", NULL,
                           "the moment of inertia %s = %g kg m^2 of '%s' is negative", names[k],
                           I[k].value, b->name);
            return;
        }
    }

    // the entries of S in units of the tensor, and its principal minors
    double a = (half - xx) / size, e = (half - yy) / size, c = (half - zz) / size;
    double d = -I[3].value / size, f = -I[4].value / size, g = -I[5].value / size;
    const double tol = 1e-9; // [-] of the tensor's size: formulas written with 10 digits pass
    if (a < -tol || e < -tol || c < -tol) {
        hn_rd_fault_at(r, "inertia", "each moment is at most the sum of the other two",
                       "no body has the moments xx = %g, yy = %g, zz = %g kg m^2 ('%s')", xx, yy,
                       zz, b->name);
    } else if (a * e - d * d < -tol || a * c - f * f < -tol || e * c - g * g < -tol ||
               a * (e * c - g * g) - d * (d * c - g * f) + f * (d * g - e * f) < -tol) {
        hn_rd_fault_at(
            r, "inertia", "the products xy, xz, yz are too large for the moments",
            "no body has this tensor of inertia ('%s'): its mass would be negative somewhere",
            b->name);
    }
}

// ---- connection ----

static int find_root(int *up, int i) {
    while (up[i] != i) {
        up[i] = up[up[i]];
        i = up[i];
    }
    return i;
}

/// Finds the bodies that are connected through the joints (only those that may carry a coordinate,
/// or all); node 0 is ground.
static void join(const hn_scene *s, int with_cut, int *up) {
    for (int i = 0; i <= s->n_bodies; i++) {
        up[i] = i;
    }
    for (int k = 0; k < s->n_joints; k++) {
        if (with_cut || !s->joints[k].cut) {
            int a = find_root(up, s->joints[k].parent + 1),
                b = find_root(up, s->joints[k].child + 1);
            up[a > b ? a : b] = a > b ? b : a;
        }
    }
}

void hn_rd_check_connected(hn_reader *r) {
    const hn_scene *s = r->scene;
    int *up = hn_arena_ints(r->arena, 2 * (size_t)(s->n_bodies + 1)),
        *all = up ? up + s->n_bodies + 1 : NULL;
    if (!up) {
        r->oom = true;
        return;
    }

    // connected by joints that carry coordinates, and by any joint at all
    join(s, 0, up);
    join(s, 1, all);
    for (int i = 0; i < s->n_bodies && !hn_rd_stopped(r); i++) {
        if (find_root(up, i + 1) == 0) {
            continue;
        }
        r->path[0] = '\0';
        snprintf(r->path, sizeof r->path, "%s", s->bodies[i].pointer);

        // two different faults: all joints are cut, or there is none
        if (find_root(all, i + 1) == 0) {
            hn_rd_fault(r, "let one of these joints keep its coordinate (\"cut\": false)",
                        "the body '%s' is joined to ground by cut joints alone", s->bodies[i].name);
        } else {
            hn_rd_fault(r,
                        "add a joint whose other side is 'ground' or a body that is joined to it",
                        "the body '%s' is not connected to ground by any joint", s->bodies[i].name);
        }
        r->path[0] = '\0';
    }
}
