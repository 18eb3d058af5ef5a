// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/run_folder.h"

#include "base/file.h"
#include "http/ground/sha256.h"
#include "http/runs/json_scan.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char ENDING[] = ".json";
static const size_t MAX_FILE = (size_t)1 << 30; // of one file

static bool is_id(const char *id) {
    return strlen(id) == HN_RUN_ID - 1 &&
           strspn(id, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_") ==
               HN_RUN_ID - 1;
}

static bool file_path(const char *folder, const char *id, char out[1024]) {
    return folder && is_id(id) && snprintf(out, 1024, "%s/%s%s", folder, id, ENDING) < 1024;
}

void hn_run_folder_keep(const char *folder, const hn_kept_run *run) {
    char path[1024], hash[HN_SHA256_BASE64];
    hn_strbuf body, file;
    if (!file_path(folder, run->id, path)) {
        return;
    }
    hn_strbuf_init(&body);
    hn_strbuf_init(&file);
    hn_strbuf_printf(&body, "{\"request\":%s,\"documents\":", run->request);
    for (int i = 0; i < run->n; i++) {
        hn_strbuf_add(&body, i ? "," : "[");
        hn_strbuf_add(&body, run->documents[i].text);
    }
    hn_strbuf_add(&body, "]}\n");
    hn_sha256_base64(hn_strbuf_text(&body), body.n, hash);
    hn_strbuf_printf(&file, "%s\n", hash);
    hn_strbuf_add_n(&file, hn_strbuf_text(&body), body.n);

    // a folder that is full costs the next server the time of computing, no more
    hn_diag diag = {0};
    if (body.failed || file.failed ||
        hn_file_keep(path, hn_strbuf_text(&file), file.n, &diag) != HN_OK) {
        fprintf(stderr, "holonom: a run could not be kept: %s\n", diag.message);
    }
    hn_strbuf_reset(&body);
    hn_strbuf_reset(&file);
}

/// The documents of a file; 0 when it is not whole.
static bool split_file(hn_kept_run *run, const char *text, size_t n) {
    char hash[HN_SHA256_BASE64];
    const size_t head = HN_SHA256_BASE64; // the hash and the end of its line
    if (n < head + 2 || text[head - 1] != '\n' || text[head] != '{') {
        return false;
    }
    hn_sha256_base64(text + head, n - head, hash);
    if (memcmp(hash, text, head - 1) != 0) {
        return false;
    }

    // the question, then the documents, one after the other
    const char *request = hn_json_member(text + head, "request");
    const char *at = hn_json_member(text + head, "documents");
    run->request = request ? strndup(request, (size_t)(hn_json_skip(request) - request)) : NULL;
    if (!run->request || !at) {
        return false;
    }
    for (const char *item = hn_json_next(&at); item && run->n < HN_COMPARISON_MAX_METHODS;
         item = hn_json_next(&at)) {
        hn_strbuf document;
        hn_strbuf_init(&document);
        hn_strbuf_add_n(&document, item, (size_t)(at - item));
        if (!hn_kept_run_add_document(run, &document)) {
            return false;
        }
    }
    return run->n > 0;
}

hn_kept_run *hn_run_folder_read(const char *folder, const char *id) {
    char path[1024];
    hn_strbuf text;
    hn_kept_run *run = NULL;
    hn_strbuf_init(&text);
    if (file_path(folder, id, path) && hn_file_read_own(path, MAX_FILE, &text, NULL) == HN_OK) {
        run = hn_kept_run_create(id, 0);
    }
    if (run && split_file(run, hn_strbuf_text(&text), text.n)) {
        run->phase = HN_RUN_DONE;
    } else if (run) {
        hn_kept_run_free(run);
        run = NULL;
    }
    hn_strbuf_reset(&text);
    return run;
}

bool hn_run_folder_stamp(const char *folder, const char *id, hn_run_stamp *out) {
    char path[1024];
    struct stat st;
    if (!file_path(folder, id, path) || lstat(path, &st) != 0) {
        return false;
    }
    *out = (hn_run_stamp){.size = st.st_size,
                          .seconds = st.st_mtim.tv_sec,
                          .ns = st.st_mtim.tv_nsec,
                          .inode = st.st_ino};
    return true;
}

void hn_run_folder_each(const char *folder, void (*see)(void *user, const char *id), void *user) {
    DIR *files = folder ? opendir(folder) : NULL;
    for (struct dirent *e; files && (e = readdir(files)) != NULL;) {
        char id[HN_RUN_ID];
        if (strlen(e->d_name) == HN_RUN_ID - 1 + strlen(ENDING) &&
            strcmp(e->d_name + HN_RUN_ID - 1, ENDING) == 0) {
            snprintf(id, sizeof id, "%.*s", HN_RUN_ID - 1, e->d_name);
            if (is_id(id)) {
                see(user, id);
            }
        }
    }
    if (files) {
        closedir(files);
    }
}

void hn_run_folder_delete(const char *folder, const char *id) {
    char path[1024];
    if (file_path(folder, id, path)) {
        unlink(path);
    }
}
