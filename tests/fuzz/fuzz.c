// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz/fuzz.h"

#include "base/json_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DEPTH = 64 };

void hn_fuzz_fail(const char *format, ...) {
    va_list args;
    va_start(args, format);
    vfprintf(stderr, format, args);
    va_end(args);
    fputc('\n', stderr);
    abort();
}

char *hn_fuzz_text(const uint8_t *data, size_t size) {
    char *text = malloc(size + 1);
    if (!text) {
        hn_fuzz_fail("no memory");
    }
    memcpy(text, data, size);
    text[size] = 0;
    return text;
}

void hn_fuzz_take_json(hn_strbuf *b) {
    size_t offset = 0;
    hn_diag diag = {0};
    const char *text = hn_strbuf_text(b);
    if (!b->failed && hn_json_text_locate(text, b->n, DEPTH, &offset, &diag) != HN_OK) {
        hn_fuzz_fail("not JSON at byte %zu: %s\n%.200s", offset, diag.message,
                     text + (offset > 100 ? offset - 100 : 0));
    }
    hn_strbuf_reset(b);
}

void hn_fuzz_check(hn_status status, const hn_diags *diags) {
    if (status == HN_ERR_INTERNAL) {
        hn_fuzz_fail("internal: %s", diags->n > 0 ? diags->item[0].message : "");
    }
}

const hn_library *hn_fuzz_library(void) {
    static hn_library *lib;
    hn_diag diag = {0};
    if (!lib && hn_library_open(".", &lib, &diag) != HN_OK) {
        hn_fuzz_fail("run it from the project's root: %s", diag.message);
    }
    return lib;
}

static char folder[64];

static void remove_folder(void) {
    char command[96];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (system(command) != 0) {
        fprintf(stderr, "%s is left\n", folder);
    }
}

const char *hn_fuzz_folder(void) {
    if (!folder[0]) {
        snprintf(folder, sizeof folder, "%s/holonom-fuzz-XXXXXX",
                 access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
        if (!mkdtemp(folder) || atexit(remove_folder) != 0) {
            hn_fuzz_fail("no folder for files");
        }
    }
    return folder;
}

void hn_fuzz_write(const char *path, const void *bytes, size_t n) {
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(bytes, 1, n, f) != n || fclose(f) != 0) {
        hn_fuzz_fail("cannot write %s", path);
    }
}
