// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/lists.h"

#include "base/file.h"
#include "base/folder.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_TEXT = 1 << 20, MAX_TITLE = 256 };

/// The first heading of a lesson's text, or its id.
static void find_title(const char *folder, const char *id, char title[MAX_TITLE]) {
    hn_strbuf path, text;
    hn_strbuf_init(&path);
    hn_strbuf_init(&text);
    hn_strbuf_printf(&path, "%s/text.md", folder);
    const bool was_read =
        !path.failed && hn_file_read(hn_strbuf_text(&path), MAX_TEXT, &text, NULL) == HN_OK;

    const char *heading = was_read ? strstr(hn_strbuf_text(&text), "# ") : NULL;
    if (heading) {
        snprintf(title, MAX_TITLE, "%.*s", (int)strcspn(heading + 2, "\r\n"), heading + 2);
    } else {
        snprintf(title, MAX_TITLE, "%s", id);
    }
    hn_strbuf_reset(&path);
    hn_strbuf_reset(&text);
}

static bool lies_in(const char *path, const char *folder) {
    size_t n = strlen(folder);
    return path && strncmp(path, folder, n) == 0 && path[n] == '/';
}

static void put_lesson(hn_strbuf *b, const hn_library *lib, const char *id) {
    char title[MAX_TITLE];
    hn_strbuf place;
    hn_strbuf_init(&place);
    hn_strbuf_printf(&place, "%s/%s", hn_library_lessons(lib), id);
    const char *folder = hn_strbuf_text(&place);
    find_title(folder, id, title);

    // name of the lesson
    hn_json_object(b);
    hn_json_put_string(b, "id", id);
    hn_json_put_string(b, "title", title);

    // its scenes
    hn_json_key(b, "scenes");
    hn_json_array(b);
    for (int i = 0; i < hn_library_n_scenes(lib); i++) {
        const char *scene = hn_library_scene_id(lib, i);
        if (lies_in(hn_library_scene_path(lib, scene), folder)) {
            hn_json_string(b, scene);
        }
    }
    hn_json_end_array(b);

    // its problems
    hn_json_key(b, "problems");
    hn_json_array(b);
    for (int i = 0; i < hn_library_n_problems(lib); i++) {
        const char *problem = hn_library_problem_id(lib, i);
        if (lies_in(hn_library_problem_path(lib, problem), folder)) {
            hn_json_string(b, problem);
        }
    }
    hn_json_end_array(b);
    hn_json_end_object(b);

    // out of memory for the path is a failure of the document
    b->failed |= place.failed;
    hn_strbuf_reset(&place);
}

void hn_lessons_json(hn_strbuf *b, const hn_library *lib) {
    hn_folder lessons;
    const hn_status status = hn_folder_read(hn_library_lessons(lib), &lessons);
    b->failed |= status == HN_ERR_MEMORY;
    hn_json_object(b);
    hn_json_key(b, "lessons");
    hn_json_array(b);
    for (int i = 0; status == HN_OK && i < lessons.n; i++) {
        if (lessons.names[i][0] >= '0' && lessons.names[i][0] <= '9') {
            put_lesson(b, lib, lessons.names[i]);
        }
    }
    hn_folder_reset(&lessons);
    hn_json_end_array(b);
    hn_json_end_object(b);
}
