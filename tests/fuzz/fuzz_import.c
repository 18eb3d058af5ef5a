// SPDX-License-Identifier: GPL-3.0-or-later
// MJCF or URDF; behind a zero byte a loop file; behind another the text of every included file.
#include "fuzz/fuzz.h"

#include "import/import.h"
#include "session/model/model.h"

#include <stdlib.h>
#include <string.h>

typedef struct included {
    const char *text;
    size_t n;
} included;

static hn_status read_included(void *user, const char *name, size_t most, hn_strbuf *text,
                               hn_diag *diag) {
    const included *file = user;
    (void)name;
    (void)diag;
    hn_strbuf_add_n(text, file->text, file->n < most + 1 ? file->n : most + 1);
    return HN_OK;
}

static void use(hn_import *import) {
    size_t n;
    const char *scene = hn_import_scene(import, &n);
    for (int i = 0; i < hn_import_note_count(import); i++) {
        if (!hn_import_note_at(import, i)->what) {
            hn_fuzz_fail("a note says nothing");
        }
    }

    // the loader takes what the importer wrote
    const hn_model_source source = {.text = scene, .n_text = n, .id = "fuzz", .allow_open = 1};
    hn_model *model = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_model_load(NULL, &source, &model, &diags);
    hn_fuzz_check(status, &diags);
    if (status == HN_OK) {
        hn_model_free(model);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = hn_fuzz_text(data, size);
    const size_t n = strlen(text);
    const char *loops = n < size ? text + n + 1 : NULL;
    const size_t n_loops = loops ? strlen(loops) : 0;
    const char *rest = loops && n + 1 + n_loops < size ? loops + n_loops + 1 : "";
    included file = {rest, strlen(rest)};
    const hn_import_source source = {.text = text,
                                     .n = n,
                                     .loops = n_loops ? loops : NULL,
                                     .n_loops = n_loops,
                                     .file = "a.xml",
                                     .read = read_included,
                                     .user = &file};
    hn_import *import = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_import_read(&source, &import, &diags);
    hn_fuzz_check(status, &diags);
    if (status == HN_OK) {
        use(import);
        hn_import_free(import);
    }
    free(text);
    return 0;
}
