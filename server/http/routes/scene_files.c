// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/scene_files.h"

#include "base/file.h"
#include "http/request/context.h"
#include "http/request/request.h"
#include "import/import.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { MAX_PICTURE = 8 << 20, MAX_PATH_CHARS = 4096 };

/// Replies with a file; one that cannot be read is not found.
static void reply_file(hn_request *r, const char *path, size_t most, const char *media_type) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    if (hn_file_read(path, most, &text, NULL) == HN_OK) {
        hn_reply_bytes(r, MHD_HTTP_OK, media_type, &text);
        return;
    }
    hn_strbuf_reset(&text);
    hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, NULL, "there is no such file");
}

void hn_handle_scene_document(hn_request *r) {
    const char *path = hn_library_scene_path(r->context->lib, r->parts[0]);
    if (!path) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, "GET /api/v1/scenes lists them",
                         "no scene is called '%.80s'", r->parts[0]);
        return;
    }
    reply_file(r, path, HN_SCENE_MAX_BYTES, "application/json");
}

void hn_handle_scene_schema(hn_request *r) {
    char path[MAX_PATH_CHARS];
    snprintf(path, sizeof path, "%s/../core/scene/scene.schema.json",
             hn_library_lessons(r->context->lib));
    reply_file(r, path, HN_SCENE_MAX_BYTES, "application/json");
}

/// Letters, digits, - and _ alone, with one ending: names no other folder.
static int is_file_name(const char *name) {
    const char *dot = strrchr(name, '.');
    for (const char *c = name; *c; c++) {
        if (c != dot && !isalnum((unsigned char)*c) && *c != '-' && *c != '_') {
            return 0;
        }
    }
    return dot && dot != name;
}

void hn_handle_lesson_picture(hn_request *r) {
    const char *lesson = r->parts[0], *name = r->parts[1];
    const char *dot = strrchr(name, '.');
    const char *type = dot && strcmp(dot, ".png") == 0   ? "image/png"
                       : dot && strcmp(dot, ".svg") == 0 ? "image/svg+xml"
                                                         : NULL;
    if (!type || !is_file_name(name) || strchr(lesson, '/') || strchr(lesson, '.')) {
        hn_reply_problem(r, HN_PROBLEM_NOT_FOUND, "pictures/NAME.png or NAME.svg",
                         "no lesson has the picture '%.80s'", name);
        return;
    }
    char path[MAX_PATH_CHARS];
    snprintf(path, sizeof path, "%s/%s/pictures/%s", hn_library_lessons(r->context->lib), lesson,
             name);
    reply_file(r, path, MAX_PICTURE, type);
}

void hn_handle_import(hn_request *r) {
    const char *text = hn_fields_text(r->json, "text"), *loops = hn_fields_text(r->json, "loops");
    const hn_import_source source = {.text = text,
                                     .n = strlen(text),
                                     .name = hn_fields_text(r->json, "name"),
                                     .loops = loops,
                                     .n_loops = loops ? strlen(loops) : 0};
    hn_import *im = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_import_read(&source, &im, &diags);
    if (status != HN_OK) {
        hn_reply_diags(r, status, &diags);
        return;
    }

    // the scene as text: a person goes on writing it
    hn_strbuf b;
    size_t n;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_string(&b, "format", hn_import_format(im));
    hn_json_put_string(&b, "document", hn_import_scene(im, &n));
    hn_import_put_notes(&b, im);
    hn_json_end_object(&b);
    hn_import_free(im);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}
