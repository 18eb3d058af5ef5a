// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/imported.h"

#include "support/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void open_source(hn_imported *x, const hn_import_source *source) {
    hn_diags diags = {0};
    size_t n;
    *x = (hn_imported){NULL, NULL};
    if (hn_import_read(source, &x->im, &diags) != HN_OK) {
        fail_msg("import: %s", diags.n ? diags.item[0].message : "(no message)");
    }
    const char *text = hn_import_scene(x->im, &n);
    if (hn_scene_load_json(text, n, "imported", NULL, 0, &x->scene, &diags) != HN_OK) {
        fail_msg("load: %s", diags.n ? diags.item[0].message : "(no message)");
    }
}

void imported_open(hn_imported *x, const char *xml, const char *loops) {
    open_source(x, &(hn_import_source){.text = xml,
                                       .n = strlen(xml),
                                       .loops = loops,
                                       .n_loops = loops ? strlen(loops) : 0});
}

char *imported_text(const char *name) {
    enum { ROOM = 1 << 16 };
    char path[256];
    (void)snprintf(path, sizeof path, "tests/import/%s", name);
    FILE *f = fopen(path, "rb");
    char *text = calloc(1, ROOM);
    if (!f || !text || fread(text, 1, ROOM - 1, f) == 0) {
        fail_msg("cannot read %s", path);
    }
    (void)fclose(f);
    return text;
}

void imported_open_file(hn_imported *x, const char *name, const char *loops, const char *key) {
    char *text = imported_text(name), *loop_text = loops ? imported_text(loops) : NULL;
    open_source(x, &(hn_import_source){.text = text,
                                       .n = strlen(text),
                                       .loops = loop_text,
                                       .n_loops = loop_text ? strlen(loop_text) : 0,
                                       .key = key});
    free(text);
    free(loop_text);
}

void imported_close(hn_imported *x) {
    hn_scene_free(x->scene);
    hn_import_free(x->im);
}

int imported_body(const hn_imported *x, const char *name) {
    int i = hn_scene_find_body(x->scene, name);
    if (i < 0) {
        fail_msg("no body %s", name);
    }
    return i;
}

int imported_joint(const hn_imported *x, const char *name) {
    for (int i = 0; i < x->scene->n_joints; i++) {
        if (strcmp(x->scene->joints[i].name, name) == 0) {
            return i;
        }
    }
    fail_msg("no joint %s", name);
    return -1;
}

const hn_import_note *imported_note(const hn_imported *x, const char *where) {
    for (int i = 0; i < hn_import_note_count(x->im); i++) {
        const hn_import_note *note = hn_import_note_at(x->im, i);
        size_t n = strlen(note->where), m = strlen(where);
        if (n >= m && strcmp(note->where + n - m, where) == 0) {
            return note;
        }
    }
    return NULL;
}

const char *imported_fault(const char *xml, const char *loops, hn_status *status) {
    static char message[HN_DIAG_MESSAGE];
    hn_diags diags = {0};
    hn_import *im = NULL;
    hn_import_source source = {
        .text = xml, .n = strlen(xml), .loops = loops, .n_loops = loops ? strlen(loops) : 0};
    *status = hn_import_read(&source, &im, &diags);
    hn_import_free(im);
    (void)snprintf(message, sizeof message, "%s", diags.n ? diags.item[0].message : "");
    return message;
}
