// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/run_document.h"

#include "http/runs/json_scan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_key(const char *key, size_t n, const char *name) {
    return strlen(name) == n && memcmp(key, name, n) == 0;
}

/// The columns of the samples, and how many rows they have. Returns false where no run has such
/// columns.
static bool list_columns(hn_run_document *d) {
    const char *at = d->samples, *key;
    size_t n;
    for (const char *value; (value = hn_json_next_member(&at, &key, &n)) != NULL;) {
        if (d->n_columns == HN_RUN_COLUMNS || n >= HN_RUN_COLUMN_NAME) {
            return false;
        }
        hn_run_column *c = &d->columns[d->n_columns++];
        snprintf(c->name, sizeof c->name, "%.*s", (int)n, key);
        c->at = value;
        d->time = is_key(key, n, "t") ? value : d->time;
    }
    const char *row = d->time;
    while (row && hn_json_next(&row)) {
        d->n_rows++;
    }
    return true;
}

bool hn_run_document_take(hn_run_document *d, hn_strbuf *text) {
    *d = (hn_run_document){.n = text->n};
    d->text = hn_strbuf_take(text);
    if (!d->text) {
        return false;
    }
    const char *at = d->text, *key;
    size_t n;
    for (const char *value; (value = hn_json_next_member(&at, &key, &n)) != NULL;) {
        if (is_key(key, n, "samples") && *value == '{') {
            d->samples = value;
            d->samples_end = at;
        } else if (is_key(key, n, "incidents") && *value == '[') {
            d->incidents = value;
        }
    }
    return !d->samples || list_columns(d);
}

void hn_run_document_reset(hn_run_document *d) {
    free(d->text);
    *d = (hn_run_document){0};
}

const hn_run_column *hn_run_document_find_column(const hn_run_document *d, const char *name) {
    for (int i = 0; i < d->n_columns; i++) {
        if (strcmp(d->columns[i].name, name) == 0) {
            return &d->columns[i];
        }
    }
    return NULL;
}
