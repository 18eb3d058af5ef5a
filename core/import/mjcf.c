// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/mjcf.h"

#include "base/suggest.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

// ---- settings ----

static int one_of(hn_mj *m, const xmlNode *node, const char *attribute, const char *const *words,
                  int n, int otherwise) {
    const char *text = hn_im_attr(m->b, node, attribute);
    for (int k = 0; k < n && text; k++) {
        if (strcmp(text, words[k]) == 0) {
            return k;
        }
    }
    if (text) {
        char hint[HN_DIAG_HINT];
        hn_im_fault(m->b, node, attribute, hn_suggest(hint, text, words, n, NULL),
                    "'%.40s' is not among the words allowed here", text);
    }
    return otherwise;
}

static void read_sequence(hn_mj *m, const xmlNode *node) {
    const char *text = hn_im_attr(m->b, node, "eulerseq");
    if (text && (strlen(text) != 3 || strspn(text, "xyzXYZ") != 3)) {
        hn_im_fault(m->b, node, "eulerseq", "as in xyz", "'%.40s' are not three axes", text);
    } else if (text) {
        memcpy(m->eulerseq, text, 4);
    }
}

static void read_compiler(hn_mj *m, const xmlNode *node) {
    static const char *const angles[] = {"degree", "radian"}, *const places[] = {"local", "global"},
                             *const geoms[] = {"auto", "true", "false"};
    hn_mj_check(m, node);
    int radian = one_of(m, node, "angle", angles, 2, m->per_angle == 1);
    m->per_angle = radian ? 1 : PI / 180;
    if (one_of(m, node, "coordinate", places, 2, 0) == 1) {
        hn_im_fault(m->b, node, "coordinate", "write places in the frame of the body around",
                    "global coordinates are not read (MuJoCo 3 has none either)");
    }
    read_sequence(m, node);
    m->autolimits = hn_im_flag(m->b, node, "autolimits", m->autolimits);
    m->from_geoms =
        (hn_mj_from_geoms)one_of(m, node, "inertiafromgeom", geoms, 3, (int)m->from_geoms);
    (void)hn_im_vector(m->b, node, "boundmass", 1, &m->boundmass);
    (void)hn_im_vector(m->b, node, "settotalmass", 1, &m->settotalmass);
    (void)hn_im_vector(m->b, node, "inertiagrouprange", 2, m->groups);
    for (const xmlNode *c = hn_im_first(node); c; c = hn_im_next(c)) {
        hn_im_skip(m->b, HN_IMPORT_IGNORED, c, "about muscles");
    }
}

static bool is_off(hn_mj *m, const xmlNode *flag, const char *attribute) {
    static const char *const words[] = {"enable", "disable"};
    return one_of(m, flag, attribute, words, 2, 0);
}

static void read_flags(hn_mj *m, const xmlNode *flag) {
    hn_mj_check(m, flag);
    int constraint = is_off(m, flag, "constraint"), passive = is_off(m, flag, "passive");
    m->no_equality |= constraint | is_off(m, flag, "equality");
    m->no_limits |= constraint | is_off(m, flag, "limit");
    m->no_contact |= constraint | is_off(m, flag, "contact");
    m->keep_parents |= is_off(m, flag, "filterparent");
    m->no_springs |= passive | is_off(m, flag, "spring");
    m->no_dampers |= passive | is_off(m, flag, "damper");
    m->no_actuation |= is_off(m, flag, "actuation");
    if (is_off(m, flag, "gravity")) {
        memset(m->b->gravity, 0, sizeof m->b->gravity);
    }
}

static void read_option(hn_mj *m, const xmlNode *node) {
    hn_mj_check(m, node);
    (void)hn_im_vector(m->b, node, "gravity", 3, m->b->gravity);
    (void)hn_im_vector(m->b, node, "timestep", 1, &m->b->step);
    for (const xmlNode *c = hn_im_first(node); c; c = hn_im_next(c)) {
        if (hn_im_is(c, "flag")) {
            read_flags(m, c);
        } else {
            hn_im_skip(m->b, HN_IMPORT_REFUSED, c, "unknown element: not read");
        }
    }
    if (m->b->step < 0) {
        hn_im_fault(m->b, node, "timestep", NULL, "a step of %g s is negative", m->b->step);
    }
}

// ---- start ----

static int count_qpos(const hn_mj *m) {
    int n = 0;
    for (int i = 0; i < m->n_moving; i++) {
        hn_joint_type type = m->b->joints[m->moving[i]].type;
        n += type == HN_JOINT_FREE ? 7 : type == HN_JOINT_SPHERICAL ? 4 : 1;
    }
    return n;
}

static bool turn_from(hn_mj *m, const xmlNode *key, const double *quat, double out[3]) {
    double n = sqrt(quat[0] * quat[0] + quat[1] * quat[1] + quat[2] * quat[2] + quat[3] * quat[3]);
    double R[3][3];
    if (!(n > 1e-10)) {
        return hn_im_fault(m->b, key, "qpos", NULL, "a quaternion of length 0");
    }
    hn_im_from_quaternion((double[]){quat[0] / n, quat[1] / n, quat[2] / n, quat[3] / n}, R);
    hn_im_rotation_vector(R, out);
    return true;
}

static void set_positions(hn_mj *m, const xmlNode *key) {
    const char *text = hn_im_attr(m->b, key, "qpos");
    int n = count_qpos(m), k = 0;
    double *x = text ? hn_arena_doubles(m->b->arena, (size_t)n + 1) : NULL;
    if (!x || hn_im_numbers(m->b, key, "qpos", text, n, n, x) < 0) {
        return;
    }
    for (int i = 0; i < m->n_moving; i++) {
        hn_im_joint *j = &m->b->joints[m->moving[i]];
        int ways = j->type == HN_JOINT_FREE ? 3 : j->type == HN_JOINT_SPHERICAL ? 0 : 1;
        memcpy(j->q0, x + k, (size_t)ways * sizeof *x);
        k += ways;
        if (j->n > 1) {
            turn_from(m, key, x + k, j->q0 + ways);
            k += 4;
        }
    }
}

static void set_rates(hn_mj *m, const xmlNode *key) {
    const char *text = hn_im_attr(m->b, key, "qvel");
    int n = 0, k = 0;
    for (int i = 0; i < m->n_moving; i++) {
        n += m->b->joints[m->moving[i]].n;
    }
    double *x = text ? hn_arena_doubles(m->b->arena, (size_t)n + 1) : NULL;
    if (!x || hn_im_numbers(m->b, key, "qvel", text, n, n, x) < 0) {
        return;
    }
    for (int i = 0; i < m->n_moving; i++) {
        hn_im_joint *j = &m->b->joints[m->moving[i]];
        memcpy(j->v0, x + k, (size_t)j->n * sizeof *x);
        k += j->n;
    }
}

static void set_controls(hn_mj *m, const xmlNode *key) {
    const char *text = hn_im_attr(m->b, key, "ctrl");
    double *x = text ? hn_arena_doubles(m->b->arena, (size_t)m->n_controls + 1) : NULL;
    if (!x || hn_im_numbers(m->b, key, "ctrl", text, m->n_controls, m->n_controls, x) < 0) {
        return;
    }
    for (int i = 0; i < m->n_controls; i++) {
        if (m->controls[i] >= 0) {
            hn_im_param *p = &m->b->params[m->controls[i]];
            p->value = fmin(fmax(x[i], p->min), p->max);
        }
    }
}

static void read_keyframe(hn_mj *m, const xmlNode *section, const char *wanted) {
    int found = 0;
    hn_mj_check(m, section);
    for (const xmlNode *c = hn_im_first(section); c && m->b->status == HN_OK; c = hn_im_next(c)) {
        if (!hn_im_is(c, "key")) {
            hn_im_skip(m->b, HN_IMPORT_REFUSED, c, "unknown element: not read");
            continue;
        }
        const char *name = hn_im_attr(m->b, c, "name");
        if (found || (wanted && (!name || strcmp(name, wanted) != 0))) {
            hn_im_note(m->b, HN_IMPORT_IGNORED, c, NULL, "the start is another keyframe's");
            continue;
        }
        found = 1;
        hn_mj_check(m, c);
        set_positions(m, c);
        set_rates(m, c);
        set_controls(m, c);
    }
}

/// A key that was asked for has to be there.
static void check_key(hn_mj *m, const char *wanted) {
    for (const xmlNode *s = hn_im_first(m->root); s; s = hn_im_next(s)) {
        for (const xmlNode *c = hn_im_is(s, "keyframe") ? hn_im_first(s) : NULL; c;
             c = hn_im_next(c)) {
            const char *name = hn_im_attr(m->b, c, "name");
            if (name && strcmp(name, wanted) == 0) {
                return;
            }
        }
    }
    hn_im_fault(m->b, m->root, NULL, "qpos0 is the pose in which the model is written",
                "there is no keyframe named '%.60s'", wanted);
}

// ---- reading it all ----

typedef void (*section_reader)(hn_mj *m, const xmlNode *section);

/// Reads every section of this name: MJCF allows each several times.
static void each(hn_mj *m, const char *name, section_reader read) {
    for (const xmlNode *c = hn_im_first(m->root); c && m->b->status == HN_OK; c = hn_im_next(c)) {
        if (hn_im_is(c, name)) {
            read(m, c);
        }
    }
}

static const struct {
    const char *name;
    int one_by_one;
    hn_import_outcome outcome;
    const char *why;
} NOT_READ[] = {
    {"size", 0, HN_IMPORT_IGNORED, "sizes of MuJoCo's memory"},
    {"visual", 0, HN_IMPORT_IGNORED, "affects the appearance only"},
    {"statistic", 0, HN_IMPORT_IGNORED, "affects the appearance only"},
    {"custom", 1, HN_IMPORT_IGNORED, "numbers for other programs"},
    {"asset", 1, HN_IMPORT_IGNORED, "affects the appearance only; a mesh gives no mass here"},
    {"sensor", 1, HN_IMPORT_IGNORED, "measures only"},
    {"contact", 1, HN_IMPORT_REFUSED, "contacts are not in the scene"},
    {"tendon", 1, HN_IMPORT_REFUSED, "tendons are not in the scene"},
    {"deformable", 1, HN_IMPORT_REFUSED, "flexible parts are not in the scene"},
    {"extension", 1, HN_IMPORT_REFUSED, "plugins are not in the scene"}};
static const char READ[] = "compiler option default worldbody equality actuator keyframe";

static void skip_section(hn_mj *m, const xmlNode *c) {
    const char *name = (const char *)c->name;
    for (size_t i = 0; i < sizeof NOT_READ / sizeof *NOT_READ; i++) {
        if (strcmp(NOT_READ[i].name, name) == 0) {
            (NOT_READ[i].one_by_one ? hn_im_skip_children : hn_im_skip)(m->b, NOT_READ[i].outcome,
                                                                        c, NOT_READ[i].why);
            return;
        }
    }
    if (!hn_im_lists(READ, name)) {
        hn_im_skip(m->b, HN_IMPORT_REFUSED, c, "unknown element: not read");
    }
}

/// Least mass of every body, then the mass of all together.
static void settle_masses(hn_mj *m) {
    double sum = 0;
    for (int i = 0; i < m->b->n_bodies; i++) {
        hn_im_mass *mass = &m->b->bodies[i].mass;
        if (!m->b->bodies[i].is_carrier && mass->m < m->boundmass) {
            mass->m = m->boundmass;
        }
        sum += mass->m;
    }
    for (int i = 0; i < m->b->n_bodies && m->settotalmass > 0 && sum > 0; i++) {
        hn_im_mass *mass = &m->b->bodies[i].mass;
        mass->m *= m->settotalmass / sum;
        for (int k = 0; k < 6; k++) {
            mass->I[k] *= m->settotalmass / sum;
        }
    }
}

static void read_sections(hn_mj *m, const char *key) {
    bool use_key = !key || strcmp(key, "qpos0") != 0;
    hn_mj_check(m, m->root);

    // in this order, whatever the file's: each section needs those before it
    each(m, "compiler", read_compiler);
    each(m, "option", read_option);
    each(m, "default", hn_mj_defaults);
    each(m, "worldbody", hn_mj_world);
    each(m, "equality", hn_mj_equality);
    each(m, "actuator", hn_mj_actuators);

    // the start, and everything that is not read
    if (key && use_key && m->b->status == HN_OK) {
        check_key(m, key);
    }
    for (const xmlNode *c = hn_im_first(m->root); c && m->b->status == HN_OK; c = hn_im_next(c)) {
        if (hn_im_is(c, "keyframe") && use_key) {
            read_keyframe(m, c, key);
        } else if (hn_im_is(c, "keyframe")) {
            hn_im_skip_children(m->b, HN_IMPORT_IGNORED, c, "the start is the model's own pose");
        } else {
            skip_section(m, c);
        }
    }
}

bool hn_im_read_mjcf(hn_build *b, const xmlNode *root, const hn_import_source *source) {
    hn_mj m = {.b = b,
               .root = root,
               .per_angle = PI / 180,
               .eulerseq = "xyz",
               .autolimits = 1,
               .settotalmass = -1,
               .groups = {-HUGE_VAL, HUGE_VAL}};
    b->gravity[2] = -9.81;

    // defaults first: every element may take attributes from them
    if (!hn_mj_collect_classes(&m)) {
        return false;
    }
    read_sections(&m, source->key);
    if (b->status != HN_OK) {
        return false;
    }
    if (b->n_bodies == 0) {
        return hn_im_fault(b, root, NULL, "as in <worldbody><body> ... </body></worldbody>",
                           "there is no body in this model");
    }

    // what needs the whole model
    settle_masses(&m);
    hn_mj_tell_contacts(&m);
    b->name = source->name ? source->name : hn_im_attr(b, root, "model");
    b->guess = b->n_closing > 0;
    return b->status == HN_OK;
}
