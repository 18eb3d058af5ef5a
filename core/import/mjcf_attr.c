// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes of MJCF elements: defaults by class, angles, orientations in five spellings.
#include "import/mjcf.h"

#include "base/suggest.h"
#include "linalg/small3.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// ---- default classes ----

static const char *class_name(hn_mj *m, const xmlNode *node) {
    const char *name = hn_im_attr(m->b, node, "class");
    return name ? name : "main";
}

static bool is_top(const hn_mj *m, const xmlNode *cls) {
    return cls->parent == m->root;
}

static const xmlNode *find_class(hn_mj *m, const char *name) {
    for (int i = 0; i < m->n_classes; i++) {
        if (strcmp(class_name(m, m->classes[i]), name) == 0) {
            return m->classes[i];
        }
    }
    return NULL;
}

enum { MAX_CLASSES = 1000, MAX_ELEMENTS = 64 };

/// Attributes are searched in every surrounding class; both bounds keep that short.
static bool check_size(hn_mj *m, const xmlNode *cls) {
    int n = 0;
    for (const xmlNode *c = hn_im_first(cls); c; c = hn_im_next(c)) {
        n += !hn_im_is(c, "default");
    }
    return (n <= MAX_ELEMENTS && m->n_classes < MAX_CLASSES) ||
           hn_im_fault(m->b, cls, NULL, NULL, "more than %d default classes, or %d elements in one",
                       MAX_CLASSES, MAX_ELEMENTS);
}

static bool collect(hn_mj *m, const xmlNode *cls) {
    const xmlNode *other = find_class(m, class_name(m, cls));

    // the top class may appear several times, any other once
    if (!is_top(m, cls) && !hn_im_attr(m->b, cls, "class")) {
        return hn_im_fault(m->b, cls, NULL, NULL, "a default inside a default needs its 'class'");
    }
    if (other && !(is_top(m, cls) && is_top(m, other))) {
        return hn_im_fault(m->b, cls, "class", "a class is defined once and cannot contain itself",
                           "the default class '%.60s' is defined in %s already", class_name(m, cls),
                           hn_im_line_of(m->b, other));
    }
    if (!check_size(m, cls)) {
        return false;
    }

    // the class, then those inside it
    const xmlNode **classes =
        hn_im_grow(m->b, m->classes, m->n_classes, &m->cap_classes, sizeof *classes);
    if (!classes) {
        return false;
    }
    m->classes = classes;
    classes[m->n_classes++] = cls;
    for (const xmlNode *c = hn_im_first(cls); c; c = hn_im_next(c)) {
        if (hn_im_is(c, "default") && !collect(m, c)) {
            return false;
        }
    }
    return true;
}

bool hn_mj_collect_classes(hn_mj *m) {
    for (const xmlNode *c = hn_im_first(m->root); c; c = hn_im_next(c)) {
        if (hn_im_is(c, "default") && !collect(m, c)) {
            return false;
        }
    }
    return true;
}

const xmlNode *hn_mj_class(hn_mj *m, const xmlNode *node, const char *attribute,
                           const xmlNode *otherwise, bool *ok) {
    const char *name = hn_im_attr(m->b, node, attribute);
    const xmlNode *cls = name ? find_class(m, name) : otherwise;
    if (name && !cls && strcmp(name, "main") != 0) {
        const char *names[64];
        int n = m->n_classes < 64 ? m->n_classes : 64;
        for (int i = 0; i < n; i++) {
            names[i] = class_name(m, m->classes[i]);
        }
        char hint[HN_DIAG_HINT];
        *ok = hn_im_fault(m->b, node, attribute, hn_suggest(hint, name, names, n, NULL),
                          "there is no default class '%.60s'", name);
    }
    return cls;
}

hn_mj_element hn_mj_look(hn_mj *m, const xmlNode *node, const xmlNode *childclass) {
    bool ok = 1;
    const xmlNode *cls = hn_mj_class(m, node, "class", childclass, &ok);
    return (hn_mj_element){.node = ok ? node : NULL, .defaults = cls};
}

/// All actuators share one set of defaults, whatever their spelling.
static bool same_defaults(const char *a, const char *b) {
    static const char actuators[] =
        "general motor position velocity intvelocity damper cylinder muscle adhesion";
    return strcmp(a, b) == 0 || (hn_im_lists(actuators, a) && hn_im_lists(actuators, b));
}

static const char *attr_of_class(hn_mj *m, const xmlNode *cls, const char *element,
                                 const char *name) {
    const char *found = NULL;
    for (const xmlNode *c = hn_im_first(cls); c; c = hn_im_next(c)) {
        if (same_defaults((const char *)c->name, element)) {
            const char *text = hn_im_attr(m->b, c, name);
            found = text ? text : found;
        }
    }
    return found;
}

const char *hn_mj_attr(hn_mj *m, const hn_mj_element *e, const char *name) {
    const char *element = (const char *)e->node->name;
    const char *text = hn_im_attr(m->b, e->node, name);
    for (const xmlNode *cls = e->defaults; cls && !text && !is_top(m, cls); cls = cls->parent) {
        text = attr_of_class(m, cls, element, name);
    }
    // sections of the main class add up; the last word counts
    for (int i = m->n_classes - 1; i >= 0 && !text; i--) {
        text = is_top(m, m->classes[i]) ? attr_of_class(m, m->classes[i], element, name) : NULL;
    }
    return text;
}

// ---- values ----

int hn_mj_numbers(hn_mj *m, const hn_mj_element *e, const char *name, int least, int most,
                  double *out) {
    const char *text = hn_mj_attr(m, e, name);
    return text ? hn_im_numbers(m->b, e->node, name, text, least, most, out) : 0;
}

bool hn_mj_number(hn_mj *m, const hn_mj_element *e, const char *name, double otherwise,
                  double *out) {
    *out = otherwise;
    return hn_mj_numbers(m, e, name, 1, 1, out) >= 0;
}

bool hn_mj_flag(hn_mj *m, const hn_mj_element *e, const char *name, int otherwise) {
    const char *text = hn_mj_attr(m, e, name);
    if (!text || strcmp(text, "auto") == 0) {
        return otherwise;
    }
    int yes = strcmp(text, "true") == 0;
    if (!yes && strcmp(text, "false") != 0) {
        hn_im_fault(m->b, e->node, name, "true or false", "'%.40s' is neither true nor false",
                    text);
    }
    return yes;
}

bool hn_mj_is_limited(hn_mj *m, const hn_mj_element *e, const char *limited, const char *range) {
    return hn_mj_flag(m, e, limited, m->autolimits && hn_mj_attr(m, e, range) != NULL);
}

// ---- orientations ----

static bool fault_no_direction(hn_mj *m, const hn_mj_element *e, const char *name) {
    return hn_im_fault(m->b, e->node, name, NULL, "a direction of length 0");
}

static bool from_quaternion(hn_mj *m, const hn_mj_element *e, const double *x, double R[3][3]) {
    double n = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
    if (!(n > 1e-10) || !isfinite(n)) {
        return fault_no_direction(m, e, "quat");
    }
    hn_im_from_quaternion((double[]){x[0] / n, x[1] / n, x[2] / n, x[3] / n}, R);
    return true;
}

static bool from_axis_angle(hn_mj *m, const hn_mj_element *e, const double *x, double R[3][3]) {
    double axis[3] = {x[0], x[1], x[2]};
    if (!hn_im_normalise(axis)) {
        return fault_no_direction(m, e, "axisangle");
    }
    hn_im_rotation(axis, x[3] * m->per_angle, R);
    return true;
}

/// x as given, y made perpendicular to it.
static bool from_xy_axes(hn_mj *m, const hn_mj_element *e, const double *v, double R[3][3]) {
    double x[3] = {v[0], v[1], v[2]}, y[3] = {v[3], v[4], v[5]}, z[3];
    if (!hn_im_normalise(x)) {
        return fault_no_direction(m, e, "xyaxes");
    }
    double along = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    for (int i = 0; i < 3; i++) {
        y[i] -= along * x[i];
    }
    if (!hn_im_normalise(y)) {
        return fault_no_direction(m, e, "xyaxes");
    }
    hn_num3_cross(x, y, z);
    for (int i = 0; i < 3; i++) {
        R[i][0] = x[i];
        R[i][1] = y[i];
        R[i][2] = z[i];
    }
    hn_im_snap(R);
    return true;
}

/// The shortest turn of z into the direction; about x where that is not one.
static bool from_z_axis(hn_mj *m, const hn_mj_element *e, const double *v, double R[3][3]) {
    double z[3] = {v[0], v[1], v[2]};
    if (!hn_im_normalise(z)) {
        return fault_no_direction(m, e, "zaxis");
    }
    double axis[3] = {-z[1], z[0], 0}, angle = atan2(hn_num3_norm(axis), z[2]);
    if (!hn_im_normalise(axis)) {
        axis[0] = 1;
    }
    hn_im_rotation(axis, angle, R);
    return true;
}

/// Small letters turn about the axes as they are by then, capitals about those of the frame around.
static bool from_euler(hn_mj *m, const hn_mj_element *e, const double *x, double R[3][3]) {
    hn_im_frame out = hn_im_frame_unit();
    (void)e;
    for (int k = 0; k < 3; k++) {
        char c = m->eulerseq[k];
        int capital = c >= 'X' && c <= 'Z';
        double axis[3] = {0, 0, 0}, turn[3][3];
        axis[c - (capital ? 'X' : 'x')] = 1;
        hn_im_rotation(axis, x[k] * m->per_angle, turn);
        if (capital) {
            hn_num3_mul(turn, out.R, out.R);
        } else {
            hn_num3_mul(out.R, turn, out.R);
        }
    }
    hn_im_snap(out.R);
    memcpy(R, out.R, sizeof out.R);
    return true;
}

static bool read_orientation(hn_mj *m, const hn_mj_element *e, double R[3][3]) {
    static const struct {
        const char *name;
        int n;
        bool (*read)(hn_mj *, const hn_mj_element *, const double *, double[3][3]);
    } forms[] = {{"quat", 4, from_quaternion},
                 {"axisangle", 4, from_axis_angle},
                 {"xyaxes", 6, from_xy_axes},
                 {"zaxis", 3, from_z_axis},
                 {"euler", 3, from_euler}};
    enum { N_FORMS = sizeof forms / sizeof *forms };
    hn_im_frame unit = hn_im_frame_unit();
    double x[6];
    int found = -1;
    memcpy(R, unit.R, sizeof unit.R);

    // its own orientation, given once
    for (int k = 0; k < N_FORMS; k++) {
        if (hn_im_attr(m->b, e->node, forms[k].name)) {
            if (found >= 0) {
                return hn_im_fault(m->b, e->node, forms[k].name, "keep one of them",
                                   "the orientation is given twice, as '%s' and as '%s'",
                                   forms[found].name, forms[k].name);
            }
            found = k;
        }
    }

    // else that of its default class
    for (int k = 0; k < N_FORMS && found < 0; k++) {
        found = hn_mj_attr(m, e, forms[k].name) ? k : -1;
    }
    if (found < 0) {
        return true;
    }
    int n = forms[found].n;
    return hn_mj_numbers(m, e, forms[found].name, n, n, x) == n && forms[found].read(m, e, x, R);
}

bool hn_mj_frame(hn_mj *m, const hn_mj_element *e, hn_im_frame *out) {
    *out = hn_im_frame_unit();
    return hn_mj_numbers(m, e, "pos", 3, 3, out->p) >= 0 && read_orientation(m, e, out->R);
}
