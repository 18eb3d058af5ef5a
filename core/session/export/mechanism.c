// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/mechanism.h"

#include "session/export/xml_attribute.h"

#include "export/language.h"
#include "linalg/small3.h"
#include "session/export/mjcf_writer.h"
#include "session/export/urdf_writer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double ALIGNED = 1e-9; // sine of the angle between axes that count as parallel [-]

// ---- formats ----

static hn_status write_mjcf(hn_strbuf *out, hn_strbuf *loops, hn_strbuf *left_out,
                            const hn_model *model, hn_arena *arena, hn_diags *diags);

typedef struct model_format {
    const char *name, *suffix, *called; ///< `called`: in messages
    hn_status (*write)(hn_strbuf *out, hn_strbuf *loops, hn_strbuf *left_out, const hn_model *model,
                       hn_arena *arena, hn_diags *diags);
    bool has_loop_file;
} model_format;

static const model_format FORMATS[] = {{"mjcf", ".xml", "MJCF", write_mjcf, false},
                                       {"urdf", ".urdf", "URDF", hn_urdf_write, true}};
enum { N_FORMATS = sizeof FORMATS / sizeof *FORMATS };

static const model_format *find_format(const char *name) {
    for (int i = 0; i < N_FORMATS; i++) {
        if (strcmp(FORMATS[i].name, name) == 0) {
            return &FORMATS[i];
        }
    }
    return NULL;
}

bool hn_mechanism_is_format(const char *name) {
    return find_format(name) != NULL;
}

const char *hn_mechanism_suffix(const char *format) {
    return find_format(format)->suffix;
}

static hn_status check_format(const char *name, bool wants_loops, hn_diags *diags) {
    const model_format *found = find_format(name);
    if (!found) {
        char hint[HN_DIAG_HINT] = "--format mjcf or --format urdf";
        if (hn_language_find(name)) {
            snprintf(hint, sizeof hint,
                     "--format mjcf or --format urdf; --language %s writes a program with the "
                     "equations",
                     name);
        }
        return hn_diags_add(diags, HN_ERR_INPUT, "/format", hint,
                            "'%.40s' is not a format of export", name);
    }
    return wants_loops && !found->has_loop_file
               ? hn_diags_add(diags, HN_ERR_INPUT, "/loops", "leave it out",
                              "%s describes closed loops itself and needs no loop file",
                              found->called)
               : HN_OK;
}

static hn_status check_scene(const hn_scene *scene, const model_format *f, hn_diags *diags) {
    const int world = hn_scene_find_body(scene, "world");
    if (world >= 0) {
        return hn_diags_add(
            diags, HN_ERR_INPUT, scene->bodies[world].pointer, "give the body another name",
            "a body cannot be called 'world': %s gives this name to the ground", f->called);
    }
    if (!scene->is_lagrangian) {
        return HN_OK;
    }
    return hn_diags_add(diags, HN_ERR_INPUT, "/lagrangian",
                        "--language writes it as a program instead",
                        "the scene '%.60s' consists of formulas and has no bodies or joints, so %s "
                        "cannot describe it",
                        scene->name, f->called);
}

// ---- planar or not ----

static bool is_parallel(const double a[3], const double b[3]) {
    double c[3];
    hn_num3_cross(a, b, c);
    return hn_num3_norm(c) < ALIGNED;
}

/// The axis of a hinge, of whichever body; NULL: there is none.
static const double *find_hinge(const hn_mjcf *m) {
    for (int i = 0; i < m->scene->n_bodies; i++) {
        for (int k = 0; k < m->poses.body[i].n; k++) {
            if (m->poses.body[i].part[k].kind == HN_POSE_HINGE) {
                return m->poses.body[i].part[k].axis;
            }
        }
    }
    return NULL;
}

/// Returns whether everything moves across one direction: hinges along it, slides across it.
static bool is_planar(const hn_mjcf *m) {
    const double *normal = find_hinge(m);
    for (int i = 0; i < m->scene->n_bodies && normal; i++) {
        for (int k = 0; k < m->poses.body[i].n; k++) {
            const hn_pose_part *p = &m->poses.body[i].part[k];
            const bool fits = p->kind == HN_POSE_HINGE ? is_parallel(p->axis, normal)
                              : p->kind == HN_POSE_SLIDE
                                  ? fabs(hn_num3_dot(p->axis, normal)) < ALIGNED
                                  : false;
            if (!fits) {
                return false;
            }
        }
    }
    return normal != NULL;
}

// ---- what acts along coordinates ----

/// Returns whether a coordinate is a hinge or slide of its own in the model.
static bool is_single(const hn_mjcf *m, int coordinate) {
    const int joint = m->scene->coordinates[coordinate].joint;
    const hn_joint_type type = joint < 0 ? HN_JOINT_FREE : m->scene->joints[joint].type;
    return type != HN_JOINT_FREE && type != HN_JOINT_SPHERICAL &&
           !hn_system_joint_is_cut(hn_model_system(m->model), joint);
}

/// Adds a spring to its joint; false where a joint of MJCF cannot hold it.
static bool gather_spring(hn_mjcf *m, const hn_load *l) {
    const bool varies = l->stiffness.varies || l->rest.varies || l->damping.varies;
    if (varies || !is_single(m, l->coordinate) || l->stiffness.value < 0 || l->damping.value < 0) {
        return false;
    }
    hn_mjcf_spring *s = &m->springs[l->coordinate];
    s->stiffness += l->stiffness.value;
    s->pull += l->stiffness.value * l->rest.value;
    s->damping += l->damping.value;
    return true;
}

static bool has_drive(const hn_mjcf *m, const hn_load *l) {
    const bool follows = l->kind == HN_LOAD_FOLLOW;
    if (!follows && l->kind != HN_LOAD_COORDINATE) {
        return false;
    }
    return is_single(m, l->coordinate) && !l->value[0].varies && !l->value[1].varies &&
           (!follows || (!l->stiffness.varies && !l->damping.varies && l->stiffness.value > 0 &&
                         l->damping.value >= 0));
}

/// Springs to their joints; the other loads that MJCF holds are drives. The rest is named.
static void gather_loads(hn_mjcf *m) {
    static const char *const kinds[] = {
        [HN_LOAD_SPRING] = "a spring between two points",
        [HN_LOAD_JOINT_SPRING] =
            "a spring of a ball, of a cut joint or with a formula of the state",
        [HN_LOAD_COORDINATE] = "a force or torque that is not constant along a hinge or slide",
        [HN_LOAD_FORCE] = "a force at a point",
        [HN_LOAD_MOMENT] = "a moment on a body",
        [HN_LOAD_FOLLOW] = "a drive whose target is not constant along a hinge or slide",
        [HN_LOAD_TABLE] = "a load given as a table",
        [HN_LOAD_PULL] = "a hand that pulls"};
    for (int i = 0; i < m->scene->n_loads; i++) {
        const hn_load *l = &m->scene->loads[i];
        const bool held = l->kind == HN_LOAD_JOINT_SPRING ? gather_spring(m, l) : has_drive(m, l);
        m->is_drive[i] = held && l->kind != HN_LOAD_JOINT_SPRING;
        if (!held) {
            hn_xml_leave_out(m->left_out, "load", l->name, kinds[l->kind]);
        }
    }
}

// ---- what else is left out ----

static void name_constraints(hn_mjcf *m) {
    static const char *const kinds[] = {
        [HN_CONSTRAINT_DISTANCE] = "a rod without mass",
        [HN_CONSTRAINT_LINE] = "a point on a line",
        [HN_CONSTRAINT_PLANE] = "a point in a plane",
        [HN_CONSTRAINT_GEAR] = "a gear between coordinates that are not hinges or slides",
        [HN_CONSTRAINT_ROLLING] = "a rolling wheel",
        [HN_CONSTRAINT_FORMULA] = "a prescribed motion or formula"};
    for (int i = 0; i < m->scene->n_constraints; i++) {
        const hn_constraint *c = &m->scene->constraints[i];
        m->is_gear[i] = c->kind == HN_CONSTRAINT_GEAR && is_single(m, c->coordinate[0]) &&
                        is_single(m, c->coordinate[1]);
        if (!m->is_gear[i]) {
            hn_xml_leave_out(m->left_out, "constraint", c->name, kinds[c->kind]);
        }
    }
}

static void name_the_rest(hn_mjcf *m) {
    for (int i = 0; i < m->scene->n_joints; i++) {
        const hn_joint *j = &m->scene->joints[i];
        const bool holds = j->type == HN_JOINT_REVOLUTE || j->type == HN_JOINT_SPHERICAL ||
                           j->type == HN_JOINT_FIXED;
        if (hn_system_joint_is_cut(hn_model_system(m->model), i) && !holds) {
            hn_xml_leave_out(m->left_out, "joint", j->name,
                             "it closes a loop; only hinges, balls and fixed joints can");
        }
    }
    if (m->scene->has_formulas) {
        hn_xml_leave_out(m->left_out, "lagrangian", NULL, "energies written as formulas");
    }
    for (int i = 0; i < m->scene->n_bodies; i++) {
        if (!(m->scene->bodies[i].mass.value > 0)) {
            hn_xml_leave_out(
                m->left_out, "mass of body", m->scene->bodies[i].name,
                "the mass is 0, and MuJoCo cannot move a body without mass: give it a small mass");
        }
    }
}

static hn_status prepare(hn_mjcf *m, hn_arena *arena, hn_diags *diags) {
    m->springs = hn_arena_get(arena, ((size_t)m->scene->n_coordinates + 1) * sizeof *m->springs);
    m->is_drive = hn_arena_get(arena, (size_t)m->scene->n_loads + 1);
    m->is_gear = hn_arena_get(arena, (size_t)m->scene->n_constraints + 1);
    const hn_status status = hn_start_poses_find(m->model, arena, &m->poses);
    if (status == HN_ERR_UNSUPPORTED) {
        return hn_diags_add(diags, status, "/joints", "let the free joint begin at the ground",
                            "a free joint in MJCF always begins at the world");
    }
    HN_TRY(status);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    memset(m->springs, 0, ((size_t)m->scene->n_coordinates + 1) * sizeof *m->springs);
    m->is_planar = is_planar(m);
    gather_loads(m);
    name_constraints(m);
    name_the_rest(m);
    return HN_OK;
}

static hn_status write_mjcf(hn_strbuf *out, hn_strbuf *loops, hn_strbuf *left_out,
                            const hn_model *model, hn_arena *arena, hn_diags *diags) {
    (void)loops;
    hn_mjcf m = {.model = model, .scene = hn_model_scene(model), .out = out, .left_out = left_out};
    HN_TRY(prepare(&m, arena, diags));
    hn_mjcf_write(&m);
    return HN_OK;
}

hn_status hn_model_export_mechanism(hn_strbuf *b, hn_strbuf *loops, hn_strbuf *left_out,
                                    const hn_model *model, const char *format, hn_diags *diags) {
    HN_TRY(check_format(format, loops != NULL, diags));
    HN_TRY(check_scene(hn_model_scene(model), find_format(format), diags));
    hn_arena *arena = hn_arena_create(0);
    hn_status status =
        arena ? find_format(format)->write(b, loops, left_out, model, arena, diags) : HN_ERR_MEMORY;
    if (status == HN_OK && (b->failed || left_out->failed)) {
        status = HN_ERR_MEMORY;
    }
    hn_arena_free(arena);
    return status;
}
