// SPDX-License-Identifier: GPL-3.0-or-later
// The journal of an interrupted job, with these bytes behind the first, which chooses the kind. The
// job is opened from it, stopped at once, and written out.
#include "fuzz/fuzz.h"

#include "session/kinds/job.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const KINDS[] = {"work-precision", "stability", "budget"};
enum { N_KINDS = sizeof KINDS / sizeof *KINDS };
static const double SHORT = 1e-3; // of computing, of which opening takes a share [s]

static hn_model *model;
static char paths[N_KINDS][512];
static int is_open; // the job, whose journal is there from then on

static int at_once(void *user) {
    (void)user;
    return is_open;
}

/// A small job, to the time of the shipped reference: an input costs its reading and little else.
static hn_job_request make_request(void) {
    hn_job_request request = hn_job_request_default(model);
    request.methods[0] = "baumgarte@rk4";
    request.n_methods = 1;
    hn_job_request_set(&request, "levels", 2);
    hn_job_request_set(&request, "samples", 0);
    hn_job_request_set(&request, "columns", 2);
    hn_job_request_set(&request, "rows", 2);
    request.limits.folder = hn_fuzz_folder();
    request.limits.stop = at_once;
    request.limits.time_limit = SHORT;
    return request;
}

/// Opens the job and stops it, so that its journal is there.
static void use(const char *kind_name) {
    const hn_job_kind *kind = hn_job_kind_find(kind_name);
    const hn_job_request request = make_request();
    hn_job *job = NULL;
    hn_job_end end = {0};
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    is_open = 0;
    hn_status status = kind ? hn_job_open(kind, &request, &job, &diags) : HN_ERR_INTERNAL;
    if (status == HN_OK) {
        is_open = 1;
        status = hn_job_run(job, &end, &diags);
    }
    hn_fuzz_check(status, &diags);
    if (status == HN_OK && hn_job_write(&b, job, ".json")) {
        hn_fuzz_take_json(&b);
    }
    hn_strbuf_reset(&b);
    hn_job_free(job);
}

/// The newest file of the folder that is no reference.
static void find_journal(char out[512], const char (*known)[512]) {
    DIR *folder = opendir(hn_fuzz_folder());
    for (struct dirent *e; folder && (e = readdir(folder)) != NULL;) {
        char path[512];
        int is_new = strstr(e->d_name, ".ndjson") != NULL;
        snprintf(path, sizeof path, "%s/%s", hn_fuzz_folder(), e->d_name);
        for (int i = 0; i < N_KINDS; i++) {
            is_new = is_new && strcmp(known[i], path) != 0;
        }
        if (is_new) {
            memcpy(out, path, sizeof path);
        }
    }
    closedir(folder);
}

static void prepare(void) {
    const hn_model_source source = {.name = "pendulum"};
    hn_diags diags = {0};
    if (hn_model_load(hn_fuzz_library(), &source, &model, &diags) != HN_OK) {
        hn_fuzz_fail("%s", diags.item[0].message);
    }
    for (int i = 0; i < N_KINDS; i++) {
        use(KINDS[i]);
        find_journal(paths[i], (const char(*)[512])paths);
        if (!paths[i][0]) {
            hn_fuzz_fail("%s leaves no journal", KINDS[i]);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (!model) {
        prepare();
    }
    if (size > 1) {
        const int kind = data[0] % N_KINDS;
        hn_fuzz_write(paths[kind], data + 1, size - 1);
        use(KINDS[kind]);
    }
    return 0;
}
