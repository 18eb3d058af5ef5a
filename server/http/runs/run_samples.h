// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_RUN_SAMPLES_H
#define HN_HTTP_RUN_SAMPLES_H
// Rows of a run: chosen columns, every so many samples, between two times, a page at a time.

#include "base/diag.h"
#include "base/strbuf.h"
#include "http/runs/run_document.h"

#include <stdbool.h>

typedef enum hn_samples_form { HN_SAMPLES_JSON, HN_SAMPLES_NDJSON, HN_SAMPLES_CSV } hn_samples_form;

typedef struct hn_samples_request {
    const char *fields;      ///< names of columns, separated by commas; NULL: all
    double from, to;         ///< [s]; -HUGE_VAL, HUGE_VAL: all
    long long stride;        ///< every so many samples, from 1
    long long cursor, limit; ///< index of the first sample; most rows of a page
    hn_samples_form form;
} hn_samples_request;

/// Writes one page of the document of a run.
///
/// CSV has one column a number, named after its coordinate, rate or constraint; JSON and NDJSON
/// keep vectors. Numbers are copied as text. `next` receives the cursor of the page that follows,
/// -1 when this is the last. Fails: HN_ERR_INPUT (a column that the run does not have).
HN_MUST_CHECK hn_status hn_run_samples_write(hn_strbuf *b, const hn_run_document *document,
                                             const hn_samples_request *request, long long *next,
                                             hn_diags *diags);

/// The rows of a document, one after the other.
typedef struct hn_sample_rows hn_sample_rows;

/// Opens the rows; `fields` as above. The document must outlive them. Fails: HN_ERR_INPUT (a column
/// that the run does not have), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_sample_rows_open(const hn_run_document *document, const char *fields,
                                            hn_sample_rows **out, hn_diags *diags);
void hn_sample_rows_free(hn_sample_rows *rows); ///< NULL is legal
/// Steps to the next row and returns its time [s] in *t; false at the end.
bool hn_sample_rows_step(hn_sample_rows *rows, double *t);
/// Writes the present row as members of an object, without its braces.
void hn_sample_rows_put(const hn_sample_rows *rows, hn_strbuf *b);
/// Returns how many bytes of the document the steps so far have read.
size_t hn_sample_rows_walked(const hn_sample_rows *rows);
#endif
