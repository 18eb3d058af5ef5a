// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/kept_run.h"

#include "base/clock.h"

#include <stdio.h>
#include <stdlib.h>

hn_kept_run *hn_kept_run_create(const char *id, hn_client client) {
    hn_kept_run *run = calloc(1, sizeof *run);
    if (run) {
        snprintf(run->id, sizeof run->id, "%s", id);
        run->refs = 1;
        run->client = client;
        run->touched = hn_clock_wall();
    }
    return run;
}

void hn_kept_run_free(hn_kept_run *run) {
    if (!run) {
        return;
    }
    for (int i = 0; i < run->n; i++) {
        hn_run_document_reset(&run->documents[i]);
    }
    hn_run_question_reset(&run->question);
    free(run->request);
    free(run);
}

bool hn_kept_run_add_document(hn_kept_run *run, hn_strbuf *text) {
    hn_run_document *document = &run->documents[run->n];
    if (!hn_run_document_take(document, text)) {
        hn_run_document_reset(document);
        return false;
    }
    run->bytes += document->n;
    run->n++;
    return true;
}
