// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/import.h"

#include "import/loops.h"
#include "import/mjcf.h"
#include "import/urdf.h"
#include "import/write.h"

#include <stdio.h>
#include <string.h>

struct hn_import {
    hn_arena *arena;
    hn_build build;
    hn_strbuf scene;
    hn_import_info info;
};

static const char *const OUTCOMES[HN_IMPORT_OUTCOME_COUNT] = {"ignored", "approximated", "refused"};

const char *hn_import_outcome_name(hn_import_outcome outcome) {
    HN_ASSERT(outcome < HN_IMPORT_OUTCOME_COUNT);
    return OUTCOMES[outcome];
}

static int file_order(const hn_build *b, const hn_import_note *note) {
    int i = note->file ? b->n_files - 1 : 0;
    while (i > 0 && b->files[i].name != note->file) {
        i--;
    }
    return i;
}

static bool comes_after(const hn_build *b, const hn_import_note *x, const hn_import_note *y) {
    const int one = file_order(b, x), two = file_order(b, y);
    return one != two ? one > two : x->line > y->line;
}

/// By file and line; in the order they were met within one.
static void sort_notes(hn_build *b) {
    for (int i = 1; i < b->n_notes; i++) {
        const hn_import_note note = b->notes[i];
        int k = i;
        for (; k > 0 && comes_after(b, &b->notes[k - 1], &note); k--) {
            b->notes[k] = b->notes[k - 1];
        }
        b->notes[k] = note;
    }
}

static void read_root(hn_build *b, xmlDoc *doc, const hn_import_source *source) {
    const xmlNode *root = xmlDocGetRootElement(doc);
    if (hn_im_is(root, "mujoco")) {
        b->format = "MJCF";
        (void)(hn_im_include(b, doc, source) && hn_im_read_mjcf(b, root, source));
    } else if (hn_im_is(root, "robot")) {
        b->format = "URDF";
        (void)hn_im_read_urdf(b, root);
        if (b->status == HN_OK && source->key) {
            hn_im_fault(b, root, NULL, NULL, "a URDF has no keyframes");
        }
    } else {
        hn_im_fault(b, root, NULL, "expected <mujoco> (MJCF) or <robot> (URDF)",
                    "<%.60s> is not the root of a mechanism", (const char *)root->name);
    }
    if (b->status == HN_OK && source->loops) {
        (void)hn_im_read_loops(b, source->loops, source->n_loops);
    }
}

static void name_scene(hn_build *b, const hn_import_source *source) {
    const char *name = source->name ? source->name : b->name;
    b->name = hn_im_label(b, name && *name ? name : "imported");
    b->about = hn_im_text(
        b,
        "Imported from %s. Lengths in m, angles in rad; coordinates are 0 where "
        "they are 0 in that file.%s",
        b->format, b->n_closing ? " The joints that close its loops are marked as cut." : "");
}

static void sum_up(hn_import *im) {
    const hn_build *b = &im->build;
    hn_import_info *info = &im->info;
    hn_im_mass sum = {.m = 0};
    for (int i = 0; i < b->n_bodies; i++) {
        hn_im_mass moved = hn_im_mass_moved(&b->bodies[i].mass, &b->bodies[i].world);
        sum = hn_im_mass_sum(&sum, &moved);
        info->n_carriers += b->bodies[i].is_carrier;
    }
    info->n_bodies = b->n_bodies;
    info->n_joints = b->n_joints + b->closing.n;
    info->n_closing = b->n_closing;
    info->n_constraints = b->constraints.n;
    info->n_loads = b->loads.n;
    info->n_params = b->n_params;
    info->mass = sum.m;
    memcpy(info->com, sum.c, sizeof info->com);
}

/// Reports a fault of the scene's loader at its place in the files that were read.
static void tell_at_source(const hn_build *b, const hn_diag *d) {
    int i = -1;

    // bodies and joints of the model have a line there
    if (sscanf(d->pointer, "/bodies/%d", &i) == 1 && i >= 0 && i < b->n_bodies) {
        (void)hn_diags_add(b->diags, d->status, d->pointer, d->hint, "%s: %s", b->bodies[i].line,
                           d->message);
    } else if (sscanf(d->pointer, "/joints/%d", &i) == 1 && i >= 0 && i < b->n_joints) {
        (void)hn_diags_add(b->diags, d->status, d->pointer, d->hint, "%s: %s", b->joints[i].line,
                           d->message);

        // joints and constraints behind them are from the loop file
    } else if (i >= b->n_joints) {
        const char *rest = strchr(d->pointer + strlen("/joints/"), '/');
        char pointer[HN_DIAG_POINTER + 32];
        (void)snprintf(pointer, sizeof pointer, "/joints/%d%s", i - b->n_joints, rest ? rest : "");
        (void)hn_diags_add(b->diags, d->status, pointer, d->hint, "loop file: %s", d->message);
    } else if (sscanf(d->pointer, "/constraints/%d", &i) == 1 && i >= b->n_own_constraints) {
        const char *rest = strchr(d->pointer + strlen("/constraints/"), '/');
        char pointer[HN_DIAG_POINTER + 32];
        (void)snprintf(pointer, sizeof pointer, "/constraints/%d%s", i - b->n_own_constraints,
                       rest ? rest : "");
        (void)hn_diags_add(b->diags, d->status, pointer, d->hint, "loop file: %s", d->message);
    } else {
        (void)hn_diags_add(b->diags, d->status, d->pointer, d->hint, "%s", d->message);
    }
}

/// Checks that the text written is a scene.
static void check_scene(hn_build *b, const hn_strbuf *text) {
    hn_scene *scene = NULL;
    hn_diags found = {0};
    b->status = hn_scene_load_json(hn_strbuf_text(text), text->n, b->name, NULL, 0, &scene, &found);
    hn_scene_free(scene);
    for (int i = 0; i < found.n; i++) {
        tell_at_source(b, &found.item[i]);
    }
}

static void read_all(hn_import *im, const hn_import_source *source) {
    hn_build *b = &im->build;
    xmlDoc *doc = hn_im_begin_files(b, source->file)
                      ? hn_im_parse(b, &b->files[0], source->text, source->n, NULL)
                      : NULL;
    if (doc) {
        b->n_own_constraints = HN_SCENE_MAX_JOINTS;
        read_root(b, doc, source);
        if (b->status == HN_OK) {
            name_scene(b, source);
            sort_notes(b);
            sum_up(im);
            hn_im_write_scene(b, &im->scene);
        }
    }
    if (b->status == HN_OK) {
        check_scene(b, &im->scene);
    }
    // names that were borrowed from the document went into the scene's text
    xmlFreeDoc(doc);
}

hn_status hn_import_read(const hn_import_source *source, hn_import **out, hn_diags *diags) {
    *out = NULL;
    hn_import *im = calloc(1, sizeof *im);
    hn_arena *arena = im ? hn_arena_create(0) : NULL;
    if (!arena) {
        free(im);
        return HN_ERR_MEMORY;
    }
    im->arena = arena;
    im->build = (hn_build){.arena = arena, .diags = diags, .status = HN_OK};
    hn_strbuf_init(&im->scene);
    read_all(im, source);
    hn_status status = hn_arena_failed(arena) ? HN_ERR_MEMORY : im->build.status;
    if (status != HN_OK) {
        hn_import_free(im);
        return status;
    }
    *out = im;
    return HN_OK;
}

void hn_import_free(hn_import *import) {
    if (import) {
        hn_strbuf_reset(&import->scene);
        hn_arena_free(import->arena);
        free(import);
    }
}

const char *hn_import_format(const hn_import *import) {
    return import->build.format;
}

const char *hn_import_scene(const hn_import *import, size_t *n) {
    *n = import->scene.n;
    return hn_strbuf_text(&import->scene);
}

int hn_import_note_count(const hn_import *import) {
    return import->build.n_notes;
}

const hn_import_note *hn_import_note_at(const hn_import *import, int i) {
    HN_ASSERT(i >= 0 && i < import->build.n_notes);
    return &import->build.notes[i];
}

int hn_import_count(const hn_import *import, hn_import_outcome outcome) {
    int n = 0;
    for (int i = 0; i < import->build.n_notes; i++) {
        n += import->build.notes[i].outcome == outcome;
    }
    return n;
}

void hn_import_put_notes(hn_strbuf *b, const hn_import *import) {
    hn_json_key(b, "notes");
    hn_json_array(b);
    for (int i = 0; i < hn_import_note_count(import); i++) {
        const hn_import_note *note = hn_import_note_at(import, i);
        hn_json_object(b);
        hn_json_put_string(b, "outcome", hn_import_outcome_name(note->outcome));
        if (note->file) {
            hn_json_put_string(b, "file", note->file);
        }
        hn_json_put_int(b, "line", note->line);
        hn_json_put_string(b, "where", note->where);
        hn_json_put_string(b, "what", note->what);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

hn_import_info hn_import_get_info(const hn_import *import) {
    return import->info;
}
