// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands/run_rows.h"

#include "base/clock.h"
#include "base/shortest.h"
#include "cli/shell/document.h"
#include "terminal/cells.h"
#include "terminal/width.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double FLUSH_EVERY = 0.05; // wall time between rows that are shown at once [s]

enum { MOST_COLUMNS = 4096 };

/// The name of a column.
typedef char column[96];

static int add_parts(column *columns, int n, const char *prefix, const cJSON *names) {
    const cJSON *name;
    cJSON_ArrayForEach(name, names) {
        if (n < MOST_COLUMNS) {
            snprintf(columns[n++], sizeof *columns, "%s%s", prefix, name->valuestring);
        }
    }
    return n;
}

/// Three columns for each of the names in run[names], where there are samples of them: "force O1
/// x", "point P x".
static int add_vectors(column *columns, int n, const cJSON *run, const char *key,
                       const char *names_key, const char *what) {
    const cJSON *list = hn_document_get(hn_document_get(run, "samples"), key), *name;
    const cJSON *names = list ? hn_document_get(run, names_key) : NULL;
    cJSON_ArrayForEach(name, names) {
        for (int i = 0; i < 3 && n < MOST_COLUMNS; i++) {
            snprintf(columns[n++], sizeof *columns, "%s %s %c", what, name->valuestring, "xyz"[i]);
        }
    }
    return n;
}

/// One column for each effort: "effort gear along th1 [N m]".
static int add_efforts(column *columns, int n, const cJSON *run) {
    const cJSON *item;
    cJSON_ArrayForEach(item, hn_document_get(run, "efforts")) {
        if (n < MOST_COLUMNS) {
            snprintf(columns[n++], sizeof *columns, "effort %s along %s [%s]",
                     hn_document_text(item, "name"), hn_document_text(item, "coordinate"),
                     hn_document_text(item, "unit"));
        }
    }
    return n;
}

/// One number a sample, where the run has it.
static int add_measure(column *columns, int n, const cJSON *samples, const char *key) {
    if (hn_document_get(samples, key) && n < MOST_COLUMNS) {
        snprintf(columns[n++], sizeof *columns, "%s", key);
    }
    return n;
}

/// The columns in the order of hn_run_request.row: t, coordinates, rates, multipliers by row and
/// their mark, reactions, efforts, points, gaps and energies.
static int find_columns(column *columns, const cJSON *run) {
    static const char *const last[] = {"gap", "velocity_gap", "energy", "work", "energy_change"};
    const cJSON *samples = hn_document_get(run, "samples");
    const cJSON *constraints = hn_document_get(run, "rows");
    int n = add_measure(columns, 0, samples, "t");
    n = add_parts(columns, n, "", hn_document_get(run, "coordinates"));
    n = add_parts(columns, n, "", hn_document_get(run, "rates"));
    n = add_parts(columns, n, "lambda ", constraints);
    if (hn_document_get(samples, "raw_lambda")) {
        n = add_parts(columns, n, "raw lambda ", constraints);
    }
    n = add_measure(columns, n, samples, "lambda_mark");
    n = add_vectors(columns, n, run, "reaction_force", "carriers", "force");
    n = add_vectors(columns, n, run, "reaction_moment", "carriers", "moment");
    n = add_efforts(columns, n, run);
    n = add_vectors(columns, n, run, "points", "points", "point");
    for (size_t i = 0; i < sizeof last / sizeof *last; i++) {
        n = add_measure(columns, n, samples, last[i]);
    }
    return n;
}

/// A field in quotes where it holds a comma or a quote (RFC 4180).
static void put_csv_name(hn_strbuf *b, const char *name) {
    if (!strpbrk(name, ",\"\n")) {
        hn_strbuf_add(b, name);
        return;
    }
    hn_strbuf_add(b, "\"");
    for (; *name; name++) {
        hn_strbuf_add_n(b, name, 1);
        hn_strbuf_add(b, *name == '"' ? "\"" : "");
    }
    hn_strbuf_add(b, "\"");
}

static void put_head(hn_strbuf *b, column *columns, int n, bool ndjson, const cJSON *run) {
    if (!ndjson) {
        for (int c = 0; c < n; c++) {
            hn_strbuf_add(b, c ? "," : "");
            put_csv_name(b, columns[c]);
        }
        hn_strbuf_add(b, "\n");
        return;
    }

    // the first line of NDJSON names the columns
    hn_strbuf line;
    hn_strbuf_init(&line);
    hn_json_object(&line);
    hn_json_put_string(&line, "scene", hn_document_text(run, "scene"));
    hn_json_put_string(&line, "method", hn_document_text(run, "method"));
    hn_json_key(&line, "columns");
    hn_json_array(&line);
    for (int c = 0; c < n; c++) {
        hn_json_string(&line, columns[c]);
    }
    hn_json_end_array(&line);
    hn_json_end_object(&line);
    hn_strbuf_printf(b, "%s\n", hn_strbuf_text(&line));
    b->failed |= line.failed;
    hn_strbuf_reset(&line);
}

// ---- a table for people ----

enum { NUMBER_COLUMNS = 11, GAP_COLUMNS = 2 };

/// Gives a column its width where there is room; *left: columns of the terminal that are free.
static void give_room(hn_run_rows *rows, column *columns, int c, int *left) {
    const int name = hn_text_columns(columns[c]);
    const int wide = (name > NUMBER_COLUMNS ? name : NUMBER_COLUMNS) + GAP_COLUMNS;
    if (rows->width_of[c] == 0 && *left > 0) {
        rows->width_of[c] = wide <= *left ? wide : 0;
        *left = wide <= *left ? *left - wide : 0; // the first without room ends the table
    }
}

/// Chooses the columns that fit the width: the time, what is wrong, the motion, then the rest. They
/// stay in their order.
static void choose_columns(hn_run_rows *rows, column *columns) {
    static const char *const first[] = {"t", "gap", "energy_change"};
    rows->shown = calloc((size_t)rows->n + 1, sizeof *rows->shown);
    rows->width_of = calloc((size_t)rows->n + 1, sizeof *rows->width_of);
    if (!rows->shown || !rows->width_of) {
        rows->failed = true;
        return;
    }
    int left = rows->width;
    for (size_t i = 0; i < sizeof first / sizeof *first; i++) {
        for (int c = 0; c < rows->n; c++) {
            if (strcmp(columns[c], first[i]) == 0) {
                give_room(rows, columns, c, &left);
            }
        }
    }
    for (int c = 0; c < rows->n; c++) {
        give_room(rows, columns, c, &left);
        if (rows->width_of[c] > 0) {
            rows->shown[rows->n_shown++] = c;
        }
    }
}

static void put_table_head(hn_strbuf *b, const hn_run_rows *rows, column *columns) {
    for (int i = 0; i < rows->n_shown; i++) {
        const int c = rows->shown[i];
        hn_strbuf_printf(b, "%*s%s", rows->width_of[c] - hn_text_columns(columns[c]), "",
                         columns[c]);
    }
    hn_strbuf_add(b, "\n");
}

/// A time with three digits of what lies between two rows, five at least behind the point.
static void put_time(hn_strbuf *b, double t, double spacing, int wide) {
    enum { LEAST = 5, MOST = NUMBER_COLUMNS };
    const int digits = spacing > 0 ? 2 - (int)floor(log10(spacing)) : LEAST;
    if (digits > MOST) {
        hn_strbuf_printf(b, "%*.5e", wide, t);
    } else {
        hn_strbuf_printf(b, "%*.*f", wide, digits < LEAST ? LEAST : digits, t);
    }
}

/// Points stand below each other; the time, which rises evenly, needs no power of ten.
static void put_table_row(hn_strbuf *b, const hn_run_rows *rows, const double *values) {
    for (int i = 0; i < rows->n_shown; i++) {
        const int c = rows->shown[i], wide = rows->width_of[c];
        if (!isfinite(values[c])) {
            hn_strbuf_printf(b, "%*s", wide, "-");
        } else if (c == 0) {
            put_time(b, values[c], rows->spacing, wide);
        } else {
            hn_strbuf_printf(b, "%*.4e", wide, values[c]);
        }
    }
    hn_strbuf_add(b, "\n");
}

void hn_run_rows_reset(hn_run_rows *rows) {
    free(rows->shown);
    free(rows->width_of);
    rows->shown = rows->width_of = NULL;
    rows->n_shown = 0;
}

// ---- printing ----

static void print(hn_run_rows *rows, hn_strbuf *text) {
    rows->failed |= text->failed;
    if (!rows->error && fwrite(hn_strbuf_text(text), 1, text->n, stdout) != text->n) {
        rows->error = errno;
    }
    hn_strbuf_reset(text);

    // rows that come quickly are shown together
    const double now = hn_clock_wall();
    if (now - rows->flushed >= FLUSH_EVERY) {
        rows->error = !rows->error && fflush(stdout) != 0 ? errno : rows->error;
        rows->flushed = now;
    }
}

void hn_run_rows_begin(hn_run_rows *rows, const cJSON *run) {
    column *columns = calloc(MOST_COLUMNS, sizeof *columns);
    hn_strbuf text;
    hn_strbuf_init(&text);
    rows->begun = true;
    rows->failed |= !columns;
    if (columns) {
        rows->n = find_columns(columns, run);
        if (rows->width > 0) {
            choose_columns(rows, columns);
            put_table_head(&text, rows, columns);
        } else {
            put_head(&text, columns, rows->n, rows->ndjson, run);
        }
    }
    print(rows, &text);
    free(columns);
}

/// Adds finite numbers as text, others as `none`; a block of the line at a time.
static void put_numbers(hn_strbuf *text, const double *values, int n, const char *none) {
    enum { BLOCK = 1024, ROOM = 1 + HN_SHORTEST_TEXT };
    char block[BLOCK];
    int used = 0;
    for (int c = 0; c < n; c++) {
        if (used > BLOCK - ROOM) {
            hn_strbuf_add_n(text, block, (size_t)used);
            used = 0;
        }
        if (c > 0) {
            block[used++] = ',';
        }
        if (isfinite(values[c])) {
            used += hn_shortest_write(values[c], block + used);
        } else {
            used += (int)strlen(strcpy(block + used, none));
        }
    }
    hn_strbuf_add_n(text, block, (size_t)used);
}

void hn_run_rows_put(hn_run_rows *rows, const double *values, int n) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    if (rows->width > 0) {
        put_table_row(&text, rows, values);
        print(rows, &text);
        return;
    }
    hn_strbuf_add(&text, rows->ndjson ? "[" : "");
    put_numbers(&text, values, n < rows->n ? n : rows->n, rows->ndjson ? "null" : "");
    hn_strbuf_add(&text, rows->ndjson ? "]\n" : "\n");
    print(rows, &text);
}
