// SPDX-License-Identifier: GPL-3.0-or-later
// The mechanism as scene JSON, a body, joint or load a line.
#include "import/write.h"

#include <math.h>
#include <string.h>

static bool is_zero(const double *x, int n) {
    for (int i = 0; i < n; i++) {
        if (x[i] != 0) {
            return false;
        }
    }
    return true;
}

static void put_vector(hn_strbuf *o, const char *key, const double x[3]) {
    hn_json_put_numbers(o, key, x, 3);
}

static void write_params(const hn_build *b, hn_strbuf *o) {
    if (b->n_params == 0) {
        return;
    }

    // each with its unit and its range as far as they are known
    hn_json_key(o, "parameters");
    hn_json_object(o);
    for (int i = 0; i < b->n_params; i++) {
        const hn_im_param *p = &b->params[i];
        hn_json_key(o, p->name);
        hn_json_object(o);
        hn_json_put_number(o, "value", p->value);
        if (p->unit) {
            hn_json_put_string(o, "unit", p->unit);
        }
        if (isfinite(p->min)) {
            hn_json_put_number(o, "min", p->min);
        }
        if (isfinite(p->max)) {
            hn_json_put_number(o, "max", p->max);
        }
        hn_json_put_string(o, "about", p->about);
        hn_json_end_object(o);
    }
    hn_json_end_object(o);
}

static void write_body(const hn_im_body *body, hn_strbuf *o) {
    static const char *const names[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
    hn_json_object(o);
    hn_json_put_string(o, "name", body->name);
    if (body->about) {
        hn_json_put_string(o, "about", body->about);
    }

    // zeros are left out
    hn_json_put_number(o, "mass", body->mass.m);
    if (!is_zero(body->mass.c, 3)) {
        put_vector(o, "com", body->mass.c);
    }
    if (!is_zero(body->mass.I, 6)) {
        hn_json_key(o, "inertia");
        hn_json_object(o);
        for (int k = 0; k < 6; k++) {
            if (k < 3 || body->mass.I[k] != 0) {
                hn_json_put_number(o, names[k], body->mass.I[k]);
            }
        }
        hn_json_end_object(o);
    }
    hn_json_end_object(o);
}

static const char *body_name(const hn_build *b, int body) {
    return body == HN_GROUND ? "ground" : b->bodies[body].name;
}

static void write_side(const hn_build *b, hn_strbuf *o, const char *key, int body,
                       const double at[3]) {
    hn_json_key(o, key);
    hn_json_object(o);
    hn_json_put_string(o, "body", body_name(b, body));
    if (!is_zero(at, 3)) {
        put_vector(o, "at", at);
    }
}

static void write_names(const hn_im_joint *j, hn_strbuf *o) {
    if (j->n == 1) {
        hn_json_put_string(o, "coordinate", j->coordinate[0]);
    } else if (j->n > 1) {
        hn_json_key(o, "coordinates");
        hn_json_strings(o, j->coordinate, (size_t)j->n);
    }
    if (j->n == 1 && j->limited) {
        hn_json_key(o, "limits");
        hn_json_numbers(o, (double[]){j->min, j->max}, 2);
    }
}

/// Directions in the child are written only where their numbers differ from the parent's.
static void write_joint(const hn_build *b, const hn_im_joint *j, hn_strbuf *o) {
    hn_json_object(o);
    hn_json_put_string(o, "name", j->name);
    if (j->about) {
        hn_json_put_string(o, "about", j->about);
    }

    // parent first; the child says its directions only where they differ
    hn_json_put_string(o, "type", hn_joint_type_name(j->type));
    write_side(b, o, "parent", j->parent, j->parent_at);
    hn_json_end_object(o);
    write_side(b, o, "child", j->child, j->child_at);
    if (memcmp(j->child_axis, j->parent_axis, sizeof j->child_axis) != 0 ||
        memcmp(j->child_ref, j->parent_ref, sizeof j->child_ref) != 0) {
        put_vector(o, "axis", j->child_axis);
        put_vector(o, "ref", j->child_ref);
    }
    hn_json_end_object(o);
    put_vector(o, "axis", j->parent_axis);
    put_vector(o, "ref", j->parent_ref);

    // names of coordinates, and how the joint is used
    write_names(j, o);
    if (j->cut) {
        hn_json_put_bool(o, "cut", 1);
    }
    if (j->actuated) {
        hn_json_put_bool(o, "actuated", 1);
    }
    hn_json_end_object(o);
}

static void write_texts(const char *key, const hn_im_texts *list, hn_strbuf *o) {
    if (list->n == 0) {
        return;
    }
    hn_json_key(o, key);
    hn_json_array(o);
    for (int i = 0; i < list->n; i++) {
        hn_json_raw(o, list->item[i]);
    }
    hn_json_end_array(o);
}

static void write_values(const hn_build *b, hn_strbuf *o, const char *key, int rates) {
    hn_json_key(o, key);
    hn_json_object(o);
    for (int i = 0; i < b->n_joints; i++) {
        const hn_im_joint *j = &b->joints[i];
        const double *x = rates ? j->v0 : j->q0;
        for (int k = 0; k < j->n && !j->cut; k++) {
            hn_json_key(o, j->coordinate[k]);
            if (b->guess) {
                hn_json_object(o);
                hn_json_put_number(o, "guess", x[k]);
                hn_json_end_object(o);
            } else {
                hn_json_number(o, x[k]);
            }
        }
    }
    hn_json_end_object(o);
}

static void write_document(const hn_build *b, hn_strbuf *o) {
    hn_json_object(o);
    hn_json_put_int(o, "holonom", 1);
    hn_json_put_string(o, "name", b->name);
    hn_json_put_string(o, "about", b->about);

    // what moves
    write_params(b, o);
    if (!is_zero(b->gravity, 3)) {
        put_vector(o, "gravity", b->gravity);
    }

    // the tree, then the joints that close its loops
    hn_json_key(o, "bodies");
    hn_json_array(o);
    for (int i = 0; i < b->n_bodies; i++) {
        write_body(&b->bodies[i], o);
    }
    hn_json_end_array(o);
    hn_json_key(o, "joints");
    hn_json_array(o);
    for (int i = 0; i < b->n_joints; i++) {
        write_joint(b, &b->joints[i], o);
    }
    for (int i = 0; i < b->closing.n; i++) {
        hn_json_raw(o, b->closing.item[i]);
    }
    hn_json_end_array(o);

    // what holds and pushes it
    write_texts("constraints", &b->constraints, o);
    write_texts("loads", &b->loads, o);

    // where it starts
    hn_json_key(o, "start");
    hn_json_object(o);
    write_values(b, o, "positions", 0);
    write_values(b, o, "rates", 1);
    hn_json_end_object(o);
    if (b->step > 0) {
        hn_json_put_number(o, "step", b->step);
    }
    hn_json_end_object(o);
}

static void break_line(hn_strbuf *out, int depth) {
    hn_strbuf_printf(out, "\n%*s", 2 * depth, "");
}

/// Lines where the first two levels open, close and go on; lists of numbers and what is deeper stay
/// in their line.
static void lay_out(const char *json, hn_strbuf *out) {
    enum { LEVELS = 2 };
    int depth = 0, in_string = 0,
        numbers = 0; // numbers: the depth of the list of numbers that is open

    // character by character: spaces and line breaks depend on depth and kind
    for (const char *c = json; *c; c++) {
        const int opens = !in_string && (*c == '{' || *c == '[');
        const int closes = !in_string && (*c == '}' || *c == ']');
        numbers = opens && !numbers && (c[1] == '-' || (c[1] >= '0' && c[1] <= '9')) ? depth + 1
                                                                                     : numbers;
        if (closes && depth-- <= LEVELS && !numbers && c[-1] != '{' && c[-1] != '[') {
            break_line(out, depth);
        }
        hn_strbuf_add_n(out, c, 1);
        if (in_string && *c == '\\' && c[1]) {
            hn_strbuf_add_n(out, ++c, 1);
        } else if (*c == '"') {
            in_string = !in_string;
        } else if (!in_string && (*c == ':' || (*c == ',' && (depth > LEVELS || numbers)))) {
            hn_strbuf_add(out, " ");
        } else if (!in_string && *c == ',') {
            break_line(out, depth);
        } else if (opens && ++depth <= LEVELS && !numbers && c[1] != '}' && c[1] != ']') {
            break_line(out, depth);
        }
        numbers = closes && depth < numbers ? 0 : numbers;
    }
    hn_strbuf_add(out, "\n");
}

void hn_im_write_scene(hn_build *b, hn_strbuf *out) {
    hn_strbuf compact;
    hn_strbuf_init(&compact);
    write_document(b, &compact);
    if (compact.failed) {
        hn_im_out_of_memory(b);
    } else {
        lay_out(hn_strbuf_text(&compact), out);
    }
    hn_strbuf_reset(&compact);
    if (out->failed) {
        hn_im_out_of_memory(b);
    }
}
