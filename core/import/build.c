// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/build.h"

#include "expr/ops.h"
#include "linalg/small3.h"
#include "scene/joint_freedoms.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NAME = 60, MAX_IDENTIFIER = 50, MAX_TEXT = 400 };

// ---- files ----

bool hn_im_begin_files(hn_build *b, const char *name) {
    b->files = hn_arena_get(b->arena, HN_IMPORT_MAX_FILES * sizeof *b->files);
    if (!b->files) {
        return hn_im_out_of_memory(b);
    }
    b->files[0] = (hn_im_file){.name = name ? name : ""};
    b->n_files = 1;
    return true;
}

hn_im_file *hn_im_file_of(const hn_build *b, const xmlNode *node) {
    return node->_private ? node->_private : &b->files[0];
}

const char *hn_im_line(hn_build *b, const hn_im_file *file, long line) {
    const char *text = file->order > 0 ? hn_im_text(b, "%.100s, line %ld", file->name, line)
                                       : hn_im_text(b, "line %ld", line);
    return text ? text : "";
}

const char *hn_im_line_of(hn_build *b, const xmlNode *node) {
    return hn_im_line(b, hn_im_file_of(b, node), xmlGetLineNo(node));
}

// ---- faults and notes ----

bool hn_im_out_of_memory(hn_build *b) {
    b->status = HN_ERR_MEMORY;
    return false;
}

const char *hn_im_text(hn_build *b, const char *format, ...) {
    char text[MAX_TEXT];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    const char *copy = hn_arena_strdup(b->arena, text);
    if (!copy) {
        hn_im_out_of_memory(b);
    }
    return copy;
}

/// "/mujoco/worldbody/body[2]/@pos"
static void put_path(const xmlNode *node, const char *attribute, char *out, size_t size) {
    xmlChar *path = xmlGetNodePath(node);
    (void)snprintf(out, size, "%s%s%s", path ? (const char *)path : "", attribute ? "/@" : "",
                   attribute ? attribute : "");
    xmlFree(path);
}

bool hn_im_fault(hn_build *b, const xmlNode *node, const char *attribute, const char *hint,
                 const char *format, ...) {
    char text[MAX_TEXT], path[HN_DIAG_POINTER];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    put_path(node, attribute, path, sizeof path);
    b->status = b->status == HN_OK ? HN_ERR_INPUT : b->status;
    (void)hn_diags_add(b->diags, b->status, path, hint, "%s: %s", hn_im_line_of(b, node), text);
    return false;
}

void *hn_im_grow(hn_build *b, void *list, int n, int *cap, size_t size) {
    if (n < *cap) {
        return list;
    }
    int larger = *cap ? 2 * *cap : 16;
    void *moved = hn_arena_get(b->arena, (size_t)larger * size);
    if (!moved) {
        hn_im_out_of_memory(b);
        return NULL;
    }
    if (n > 0) {
        memcpy(moved, list, (size_t)n * size);
    }
    *cap = larger;
    return moved;
}

void hn_im_note(hn_build *b, hn_import_outcome outcome, const xmlNode *node, const char *attribute,
                const char *format, ...) {
    char text[MAX_TEXT], path[MAX_TEXT];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);

    // so many notes say that the model is of another kind
    if (b->n_notes == HN_IMPORT_MAX_NOTES) {
        b->status = HN_ERR_LIMIT;
        (void)hn_diags_add(b->diags, HN_ERR_LIMIT, NULL, NULL,
                           "%s: more than %d parts of this model are not in the scene",
                           hn_im_line_of(b, node), HN_IMPORT_MAX_NOTES);
    }

    // one note, with place and line
    hn_import_note *notes = b->n_notes < HN_IMPORT_MAX_NOTES
                                ? hn_im_grow(b, b->notes, b->n_notes, &b->cap_notes, sizeof *notes)
                                : NULL;
    if (notes) {
        put_path(node, attribute, path, sizeof path);
        b->notes = notes;
        const hn_im_file *file = hn_im_file_of(b, node);
        notes[b->n_notes++] = (hn_import_note){.outcome = outcome,
                                               .file = file->order > 0 ? file->name : NULL,
                                               .line = (int)xmlGetLineNo(node),
                                               .where = hn_im_text(b, "%s", path),
                                               .what = hn_im_text(b, "%s", text)};
    }
}

// ---- names ----

static bool is_used(const hn_build *b, const char *name) {
    static const char *const fixed[] = {"t", "pi", "e"};
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++) {
        if (strcmp(fixed[i], name) == 0) {
            return true;
        }
    }
    for (int i = 0; i < b->n_used; i++) {
        if (strcmp(b->used[i], name) == 0) {
            return true;
        }
    }
    return hn_op_find(name) != HN_OP_COUNT;
}

/// From one number behind a name that is taken to the next to try: small ones first, then far from
/// all that are.
static int next_step(const hn_build *b, int k) {
    return k < 8 ? 1 : b->n_bodies + b->n_joints + b->n_params;
}

static void use(hn_build *b, const char *name) {
    const char **used = hn_im_grow(b, b->used, b->n_used, &b->cap_used, sizeof *used);
    if (used && name) {
        b->used = used;
        used[b->n_used++] = name;
    }
}

/// A name that formulas may use, as near to `wanted` as can be, and free together with its rate's.
static const char *identifier(hn_build *b, const char *wanted) {
    char base[MAX_IDENTIFIER + 1], name[MAX_NAME + 1], rate[MAX_NAME + 3];
    size_t n = 0;
    if (!isalpha((unsigned char)wanted[0]) && wanted[0] != '_') {
        base[n++] = '_';
    }

    // letters, digits and _; anything else becomes _
    for (const char *c = wanted; *c && n < MAX_IDENTIFIER; c++) {
        int plain =
            (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9');
        base[n++] = plain ? *c : '_';
    }
    base[n] = '\0';

    // a number behind it, until neither it nor its rate is taken
    (void)snprintf(name, sizeof name, "%s", base);
    for (int k = 1;;) {
        (void)snprintf(rate, sizeof rate, "d_%s", name);
        if (!is_used(b, name) && !is_used(b, rate)) {
            break;
        }
        k += next_step(b, k);
        (void)snprintf(name, sizeof name, "%s_%d", base, k);
    }

    // both are taken now
    const char *copy = hn_im_text(b, "%s", name);
    use(b, copy);
    use(b, hn_im_text(b, "%s", rate));
    return copy;
}

static bool body_has(const hn_build *b, const char *name) {
    for (int i = 0; i < b->n_bodies; i++) {
        if (strcmp(b->bodies[i].name, name) == 0) {
            return true;
        }
    }
    return strcmp(name, "ground") == 0;
}

static bool joint_has(const hn_build *b, const char *name) {
    for (int i = 0; i < b->n_joints; i++) {
        if (strcmp(b->joints[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

/// A name for people: braces mean something in a scene, and 60 characters are the most.
static const char *label(hn_build *b, const char *wanted,
                         bool (*has)(const hn_build *, const char *)) {
    char base[MAX_IDENTIFIER + 1], name[MAX_NAME + 1];
    size_t n = 0;
    for (const unsigned char *c = (const unsigned char *)wanted; *c; c++) {
        // characters of several bytes are kept whole or not at all
        size_t bytes = *c < 0x80 ? 1 : *c < 0xe0 ? 2 : *c < 0xf0 ? 3 : 4;
        if ((*c & 0xc0) != 0x80 && n + bytes > MAX_IDENTIFIER) {
            break;
        }
        base[n++] = *c == '{' || *c == '}' || *c < 0x20 ? '_' : (char)*c;
    }
    base[n] = '\0';
    (void)snprintf(name, sizeof name, "%s", n ? base : "_");
    for (int k = 1; has(b, name);) {
        k += next_step(b, k);
        (void)snprintf(name, sizeof name, "%s_%d", base, k);
    }
    return hn_im_text(b, "%s", name);
}

// ---- building ----

static bool has_none(const hn_build *b, const char *name) {
    (void)b;
    (void)name;
    return false;
}

const char *hn_im_label(hn_build *b, const char *wanted) {
    return label(b, wanted, has_none);
}

int hn_im_add_body(hn_build *b, const xmlNode *node, const char *source, const hn_im_frame *world) {
    if (b->n_bodies == HN_SCENE_MAX_BODIES) {
        hn_im_fault(b, node, NULL, NULL, "more than %d bodies", HN_SCENE_MAX_BODIES);
        return -1;
    }
    hn_im_body *bodies = hn_im_grow(b, b->bodies, b->n_bodies, &b->cap_bodies, sizeof *bodies);
    const char *wanted = source ? source : hn_im_text(b, "body%d", b->n_bodies + 1);
    const char *name = wanted ? label(b, wanted, body_has) : NULL;
    if (!bodies || !name) {
        return -1;
    }
    b->bodies = bodies;
    bodies[b->n_bodies] = (hn_im_body){
        .source = source, .name = name, .world = *world, .line = hn_im_line_of(b, node)};
    return b->n_bodies++;
}

static void name_coordinates(hn_build *b, hn_im_joint *j) {
    const hn_freedom *freedoms = hn_joint_freedoms(j->type, &j->n);

    // each name is made unique
    char wanted[MAX_NAME + 16];
    for (int k = 0; k < j->n; k++) {
        (void)snprintf(wanted, sizeof wanted, "%.40s%s", j->name, freedoms[k].suffix);
        j->coordinate[k] = identifier(b, wanted);
        j->rate[k] = j->coordinate[k] ? hn_im_text(b, "d_%s", j->coordinate[k]) : NULL;
    }
}

int hn_im_add_joint(hn_build *b, const xmlNode *node, const hn_im_joint *joint,
                    const char *wanted) {
    if (b->n_joints == HN_SCENE_MAX_JOINTS) {
        hn_im_fault(b, node, NULL, NULL, "more than %d joints", HN_SCENE_MAX_JOINTS);
        return -1;
    }
    hn_im_joint *joints = hn_im_grow(b, b->joints, b->n_joints, &b->cap_joints, sizeof *joints);
    const char *name = wanted && joints ? label(b, wanted, joint_has) : NULL;
    if (!joints || !name) {
        return -1;
    }
    b->joints = joints;
    hn_im_joint *j = &joints[b->n_joints++];
    *j = *joint;
    j->name = name;
    j->line = hn_im_line_of(b, node);
    name_coordinates(b, j);
    b->n_closing += j->cut;
    return b->n_joints - 1;
}

int hn_im_add_param(hn_build *b, const xmlNode *node, const hn_im_param *param,
                    const char *wanted) {
    if (b->n_params == HN_SCENE_MAX_PARAMS) {
        hn_im_fault(b, node, NULL, "a scene has no more parameters than that",
                    "more than %d actuators", HN_SCENE_MAX_PARAMS);
        return -1;
    }
    hn_im_param *params = hn_im_grow(b, b->params, b->n_params, &b->cap_params, sizeof *params);
    const char *name = params && wanted ? identifier(b, wanted) : NULL;
    if (!name) {
        return -1;
    }
    b->params = params;
    params[b->n_params] = *param;
    params[b->n_params].name = name;
    return b->n_params++;
}

bool hn_im_add_text(hn_build *b, hn_im_texts *list, hn_strbuf *text) {
    const char **item = hn_im_grow(b, list->item, list->n, &list->cap, sizeof *item);
    const char *copy =
        item && !text->failed ? hn_arena_strdup(b->arena, hn_strbuf_text(text)) : NULL;
    hn_strbuf_reset(text);
    if (!copy) {
        return hn_im_out_of_memory(b);
    }
    list->item = item;
    item[list->n++] = copy;
    return true;
}

int hn_im_find_body(const hn_build *b, const char *source) {
    for (int i = 0; i < b->n_bodies; i++) {
        if (b->bodies[i].source && strcmp(b->bodies[i].source, source) == 0) {
            return i;
        }
    }
    return -2;
}

int hn_im_find_joint(const hn_build *b, const char *source) {
    for (int i = 0; i < b->n_joints; i++) {
        if (b->joints[i].source && strcmp(b->joints[i].source, source) == 0) {
            return i;
        }
    }
    return -1;
}

hn_im_frame hn_im_axis_frame(const double at[3], const double axis[3]) {
    double x[3], y[3];
    hn_im_frame out;
    hn_im_across(axis, x);
    hn_num3_cross(axis, x, y);
    for (int i = 0; i < 3; i++) {
        out.R[i][0] = x[i];
        out.R[i][1] = y[i] + 0.0;
        out.R[i][2] = axis[i];
        out.p[i] = at[i];
    }
    hn_im_snap(out.R);
    return out;
}

void hn_im_set_sides(hn_im_joint *joint, const hn_im_frame *in_parent,
                     const hn_im_frame *in_child) {
    for (int i = 0; i < 3; i++) {
        joint->parent_at[i] = in_parent->p[i];
        joint->parent_axis[i] = in_parent->R[i][2];
        joint->parent_ref[i] = in_parent->R[i][0];
        joint->child_at[i] = in_child->p[i];
        joint->child_axis[i] = in_child->R[i][2];
        joint->child_ref[i] = in_child->R[i][0];
    }
}

const char *hn_im_number(hn_build *b, double x) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_json_number(&text, x);
    const char *copy = text.failed ? NULL : hn_im_text(b, "(%s)", hn_strbuf_text(&text));
    hn_strbuf_reset(&text);
    if (!copy) {
        hn_im_out_of_memory(b);
    }
    return copy ? copy : "0";
}
