// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/runs/run_samples.h"

#include "base/suggest.h"
#include "http/runs/json_scan.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_COLUMNS = HN_RUN_COLUMNS };

/// Columns of a document, and how far each has been read.
typedef struct reader {
    const hn_run_document *document;
    int n;
    hn_run_column columns[MAX_COLUMNS];
    const char *time; ///< likewise, of the column t
    size_t walked;    ///< bytes of columns that were read so far
} reader;

// ---- columns ----

static hn_status refuse_column(const char *name, const hn_run_document *d, hn_diags *diags) {
    const char *names[MAX_COLUMNS];
    char hint[HN_DIAG_HINT];
    for (int i = 0; i < d->n_columns; i++) {
        names[i] = d->columns[i].name;
    }
    hn_suggest_or_list(hint, name, names, d->n_columns, "columns: ");
    return hn_diags_add(diags, HN_ERR_INPUT, "/fields", hint, "the run has no column '%s'", name);
}

/// The columns that `fields` names, NULL: all.
static hn_status choose_columns(reader *r, const char *fields, hn_diags *diags) {
    const hn_run_document *d = r->document;
    if (!fields) {
        memcpy(r->columns, d->columns, sizeof r->columns);
        r->n = d->n_columns;
        return HN_OK;
    }
    if (!*fields) {
        return refuse_column(fields, d, diags);
    }
    for (const char *at = fields; *at;) {
        const size_t n = strcspn(at, ",");
        char name[HN_RUN_COLUMN_NAME];
        snprintf(name, sizeof name, "%.*s", (int)(n < sizeof name ? n : sizeof name - 1), at);
        const hn_run_column *column = hn_run_document_find_column(d, name);
        if (!column) {
            return refuse_column(name, d, diags);
        }
        for (int i = 0; i < r->n; i++) {
            if (strcmp(r->columns[i].name, name) == 0) {
                return hn_diags_add(diags, HN_ERR_INPUT, "/fields", NULL,
                                    "'fields' names the column '%s' twice", name);
            }
        }
        r->columns[r->n++] = *column;
        at += n + (at[n] == ',');
    }
    return HN_OK;
}

/// Opens the columns for reading. Fails: HN_ERR_INPUT, HN_ERR_INTERNAL (there are no samples).
static hn_status open_columns(reader *r, const hn_run_document *d, const char *fields,
                              hn_diags *diags) {
    *r = (reader){.document = d, .time = d->time};
    return d->time ? choose_columns(r, fields, diags) : HN_ERR_INTERNAL;
}

// ---- rows ----

/// Heads of a column of vectors: the names of what its numbers belong to.
static const char *head_list(const char *name) {
    static const char *const lists[][2] = {{"q", "coordinates"},
                                           {"v", "rates"},
                                           {"lambda", "rows"},
                                           {"raw_lambda", "rows"},
                                           {"effort", "efforts"}};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        if (strcmp(name, lists[i][0]) == 0) {
            return lists[i][1];
        }
    }
    return NULL;
}

/// "th1,a2,th3" for q, "reaction_force[0],..." where numbers have no names of their own.
static void put_heads(hn_strbuf *b, const reader *r, int i) {
    const hn_run_column *c = &r->columns[i];
    const char *list = head_list(c->name), *first = c->at;
    const char *names = list ? hn_json_member(r->document->text, list) : NULL;
    const char *row = hn_json_next(&first);
    hn_strbuf_add(b, i ? "," : "");
    if (!row || *row != '[') {
        hn_strbuf_add(b, c->name);
        return;
    }

    // a vector has a head for each number
    int k = 0;
    for (const char *item = hn_json_next(&row); item; item = hn_json_next(&row), k++) {
        const char *name = names ? hn_json_next(&names) : NULL;
        hn_strbuf_add(b, k ? "," : "");
        if (name) {
            hn_strbuf_add(b, strcmp(c->name, "raw_lambda") == 0 ? "raw " : "");
            hn_strbuf_add_n(b, name, (size_t)(hn_json_skip(name) - name));
        } else {
            hn_strbuf_printf(b, "%s[%d]", c->name, k);
        }
    }
}

/// A value of a row; in CSV without brackets, and nothing for null.
static void put_value(hn_strbuf *b, const char *value, const char *end, int csv) {
    if (!csv) {
        hn_strbuf_add_n(b, value, (size_t)(end - value));
    } else if (*value == '[') {
        for (const char *item = hn_json_next(&value), *first = item; item;
             item = hn_json_next(&value)) {
            hn_strbuf_add(b, item == first ? "" : ",");
            put_value(b, item, hn_json_skip(item), 1);
        }
    } else if (*value != 'n') {
        hn_strbuf_add_n(b, value, (size_t)(end - value));
    }
}

/// Values with their names, as members of an object.
static void put_members(hn_strbuf *b, const reader *r, const char *const *values) {
    for (int i = 0; i < r->n; i++) {
        hn_strbuf_printf(b, "%s\"%s\":", i ? "," : "", r->columns[i].name);
        put_value(b, values[i], hn_json_skip(values[i]), 0);
    }
}

static void put_row(hn_strbuf *b, const reader *r, const char *const *values,
                    hn_samples_form form) {
    if (form == HN_SAMPLES_NDJSON) {
        hn_strbuf_add(b, "{");
        put_members(b, r, values);
        hn_strbuf_add(b, "}\n");
        return;
    }
    const int csv = form == HN_SAMPLES_CSV;
    hn_strbuf_add(b, csv ? "" : "[");
    for (int i = 0; i < r->n; i++) {
        hn_strbuf_add(b, i ? "," : "");
        put_value(b, values[i], hn_json_skip(values[i]), csv);
    }
    hn_strbuf_add(b, csv ? "\n" : "]");
}

/// Steps to the next item of an array, and counts its bytes.
static const char *next_item(reader *r, const char **at) {
    const char *before = *at, *item = hn_json_next(at);
    r->walked += (size_t)(*at - before);
    return item;
}

/// Steps all columns to their next row; 0 at the end.
static bool next_row(reader *r, const char **values, double *t) {
    const char *time = next_item(r, &r->time);
    for (int i = 0; i < r->n; i++) {
        values[i] = next_item(r, &r->columns[i].at);
        if (!values[i]) {
            return false;
        }
    }
    *t = time ? strtod(time, NULL) : 0;
    return time != NULL;
}

static long long put_rows(hn_strbuf *b, reader *r, const hn_samples_request *q) {
    const char *values[MAX_COLUMNS];
    double t;
    long long written = 0;
    for (long long k = 0; next_row(r, values, &t); k++) {
        const int wanted = k >= q->cursor && t >= q->from && t <= q->to && k % q->stride == 0;
        if (wanted && written == q->limit) {
            return k;
        }
        if (wanted) {
            hn_strbuf_add(b, q->form == HN_SAMPLES_JSON && written ? "," : "");
            put_row(b, r, values, q->form);
            written++;
        }
    }
    return -1;
}

hn_status hn_run_samples_write(hn_strbuf *b, const hn_run_document *document,
                               const hn_samples_request *request, long long *next,
                               hn_diags *diags) {
    reader r;
    HN_TRY(open_columns(&r, document, request->fields, diags));

    // heads, rows, and what closes them
    if (request->form == HN_SAMPLES_CSV) {
        for (int i = 0; i < r.n; i++) {
            put_heads(b, &r, i);
        }
        hn_strbuf_add(b, "\n");
    } else if (request->form == HN_SAMPLES_JSON) {
        hn_strbuf_add(b, "{\"fields\":[");
        for (int i = 0; i < r.n; i++) {
            hn_strbuf_printf(b, "%s\"%s\"", i ? "," : "", r.columns[i].name);
        }
        hn_strbuf_add(b, "],\"rows\":[");
    }
    *next = put_rows(b, &r, request);
    if (request->form == HN_SAMPLES_JSON) {
        hn_strbuf_add(b, "],\"next_cursor\":");
        if (*next >= 0) {
            hn_strbuf_printf(b, "%lld}", *next);
        } else {
            hn_strbuf_add(b, "null}");
        }
    }
    return HN_OK;
}

// ---- rows one after the other ----

struct hn_sample_rows {
    reader reader;
    const char *values[MAX_COLUMNS];
};

hn_status hn_sample_rows_open(const hn_run_document *document, const char *fields,
                              hn_sample_rows **out, hn_diags *diags) {
    hn_sample_rows *rows = calloc(1, sizeof *rows);
    hn_status status = rows ? HN_OK : HN_ERR_MEMORY;
    HN_THEN(status, open_columns(&rows->reader, document, fields, diags));
    if (status != HN_OK) {
        hn_sample_rows_free(rows);
        return status;
    }
    *out = rows;
    return HN_OK;
}

void hn_sample_rows_free(hn_sample_rows *rows) {
    free(rows);
}

bool hn_sample_rows_step(hn_sample_rows *rows, double *t) {
    return next_row(&rows->reader, rows->values, t);
}

void hn_sample_rows_put(const hn_sample_rows *rows, hn_strbuf *b) {
    put_members(b, &rows->reader, rows->values);
}

size_t hn_sample_rows_walked(const hn_sample_rows *rows) {
    return rows->reader.walked;
}
