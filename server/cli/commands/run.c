// SPDX-License-Identifier: GPL-3.0-or-later
// holonom run: one method, its samples as CSV, NDJSON or JSON.
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/document.h"
#include "cli/shell/print.h"
#include "cli/shell/progress.h"
#include "cli/shell/scene_word.h"
#include "session/compare/comparison.h"
#include "session/compare/run_doc.h"
#include "study/truth/accuracy.h"
#include "terminal/motion_plot.h"
#include "terminal/width.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/// A column of the output: a name, and where its values are.
typedef struct column {
    char name[96];
    const cJSON *list; ///< of samples
    int part;          ///< index within each entry; -1: the entry itself
} column;

enum { MAX_RUN_COLUMNS = 4096 };

static int add_parts(column *columns, int n, const cJSON *samples, const char *key,
                     const char *prefix, const cJSON *names) {
    int part = 0;
    const cJSON *name;
    cJSON_ArrayForEach(name, names) {
        if (n == MAX_RUN_COLUMNS) {
            return n;
        }
        column *c = &columns[n++];
        snprintf(c->name, sizeof c->name, "%s%s", prefix, name->valuestring);
        c->list = hn_document_get(samples, key);
        c->part = part++;
    }
    return n;
}

/// Three columns for each of the names in run[names]: "force O1 x", "point P x".
static int add_vectors(column *columns, int n, const cJSON *run, const char *key,
                       const char *names_key, const char *what) {
    const cJSON *list = hn_document_get(hn_document_get(run, "samples"), key), *name;
    const cJSON *names = list ? hn_document_get(run, names_key) : NULL;
    int part = 0;
    cJSON_ArrayForEach(name, names) {
        for (int i = 0; i < 3 && n < MAX_RUN_COLUMNS; i++) {
            column *c = &columns[n++];
            snprintf(c->name, sizeof c->name, "%s %s %c", what, name->valuestring, "xyz"[i]);
            c->list = list;
            c->part = part++;
        }
    }
    return n;
}

/// One column for each effort: "effort gear along th1 [N m]".
static int add_efforts(column *columns, int n, const cJSON *run) {
    const cJSON *list = hn_document_get(hn_document_get(run, "samples"), "effort"), *item;
    int part = 0;
    cJSON_ArrayForEach(item, hn_document_get(run, "efforts")) {
        if (n == MAX_RUN_COLUMNS) {
            return n;
        }
        column *c = &columns[n++];
        snprintf(c->name, sizeof c->name, "effort %s along %s [%s]", hn_document_text(item, "name"),
                 hn_document_text(item, "coordinate"), hn_document_text(item, "unit"));
        c->list = list;
        c->part = part++;
    }
    return n;
}

/// One number a sample, where the run has it.
static int add_measure(column *columns, int n, const cJSON *samples, const char *key) {
    const cJSON *list = hn_document_get(samples, key);
    if (list && n < MAX_RUN_COLUMNS) {
        columns[n] = (column){.list = list, .part = -1};
        snprintf(columns[n++].name, sizeof columns[0].name, "%s", key);
    }
    return n;
}

/// t, coordinates, rates, multipliers by row and their mark, reactions, efforts, points, gaps and
/// energies.
static int find_columns(column *columns, const cJSON *run) {
    static const char *const last[] = {"gap", "velocity_gap", "energy", "work", "energy_change"};
    const cJSON *samples = hn_document_get(run, "samples");
    columns[0] = (column){.name = "t", .list = hn_document_get(samples, "t"), .part = -1};
    int n = add_parts(columns, 1, samples, "q", "", hn_document_get(run, "coordinates"));
    n = add_parts(columns, n, samples, "v", "", hn_document_get(run, "rates"));
    n = add_parts(columns, n, samples, "lambda", "lambda ", hn_document_get(run, "rows"));
    if (hn_document_get(samples, "raw_lambda")) {
        n = add_parts(columns, n, samples, "raw_lambda", "raw lambda ",
                      hn_document_get(run, "rows"));
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

/// Entries of the lists are walked, not indexed: a list of a parsed document is a chain.
typedef struct cursor {
    const cJSON *entry;
} cursor;

static void put_row(hn_strbuf *b, const column *columns, cursor *cursors, int n) {
    for (int c = 0; c < n; c++) {
        const cJSON *entry = cursors[c].entry;
        hn_strbuf_add(b, c ? "," : "");
        const cJSON *value =
            columns[c].part < 0 ? entry : cJSON_GetArrayItem(entry, columns[c].part);
        hn_document_put_number(b, value);
        cursors[c].entry = entry ? entry->next : NULL;
    }
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

static void put_head(hn_strbuf *b, const column *columns, int n, int ndjson, const cJSON *run) {
    if (!ndjson) {
        for (int c = 0; c < n; c++) {
            hn_strbuf_add(b, c ? "," : "");
            put_csv_name(b, columns[c].name);
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
        hn_json_string(&line, columns[c].name);
    }
    hn_json_end_array(&line);
    hn_json_end_object(&line);
    hn_strbuf_printf(b, "%s\n", hn_strbuf_text(&line));
    b->failed |= line.failed;
    hn_strbuf_reset(&line);
}

/// NDJSON closes with everything but the samples.
static void put_tail(hn_strbuf *b, cJSON *run) {
    cJSON_DeleteItemFromObjectCaseSensitive(run, "samples");
    char *text = cJSON_PrintUnformatted(run);
    hn_strbuf_add(b, text ? text : "");
    hn_strbuf_add(b, "\n");
    b->failed |= text == NULL;
    cJSON_free(text);
}

static void put_samples(hn_strbuf *b, cJSON *run, int ndjson) {
    column *columns = calloc(MAX_RUN_COLUMNS, sizeof *columns);
    cursor *cursors = calloc(MAX_RUN_COLUMNS, sizeof *cursors);
    if (!columns || !cursors) {
        b->failed = 1;
    } else {
        int n = find_columns(columns, run);
        for (int c = 0; c < n; c++) {
            cursors[c].entry = columns[c].list ? columns[c].list->child : NULL;
        }

        // row by row, all columns at once
        put_head(b, columns, n, ndjson, run);
        while (cursors[0].entry) {
            hn_strbuf_add(b, ndjson ? "[" : "");
            put_row(b, columns, cursors, n);
            hn_strbuf_add(b, ndjson ? "]\n" : "\n");
        }
        if (ndjson) {
            put_tail(b, run);
        }
    }
    free(columns);
    free(cursors);
}

/// Says how many samples have multipliers that are not determined, by mark.
static void tell_marks(const cJSON *run) {
    const cJSON *marks = hn_document_get(hn_document_get(run, "samples"), "lambda_mark"), *entry;
    const cJSON *word = hn_document_get(run, "lambda_marks");
    word = word && word->child ? word->child->next : NULL; // the first is as it should be
    for (int mark = 1; word; mark++, word = word->next) {
        int n = 0;
        cJSON_ArrayForEach(entry, marks) {
            n += (int)cJSON_GetNumberValue(entry) == mark;
        }
        if (n > 0) {
            fprintf(stderr,
                    "holonom: multipliers, and reactions that rest on them: %s in %d of %d samples "
                    "(lambda_mark %d)\n",
                    word->valuestring, n, cJSON_GetArraySize(marks), mark);
        }
    }
}

/// Says what was noticed on the way; samples alone would hide it.
/// The first remedy that was tried and removes the incident.
static void tell_remedies(const cJSON *incident) {
    const cJSON *remedy = hn_document_get(incident, "remedies")->child;
    const cJSON *tried = hn_document_get(incident, "tried")->child;
    if (remedy && tried && tried->valuestring[0]) {
        fprintf(stderr, "holonom:     try %s (%s)\n", remedy->valuestring, tried->valuestring);
    }
}

static void tell_incidents(const cJSON *run) {
    enum { MOST = 5 };
    const cJSON *incidents = hn_document_get(run, "incidents"), *incident;
    int n = 0;
    cJSON_ArrayForEach(incident, incidents) {
        if (n++ < MOST) {
            fprintf(stderr, "holonom: t = %.4g s: %s\n", hn_document_number(incident, "t"),
                    hn_document_text(incident, "message"));
            tell_remedies(incident);
        }
    }
    if (n > MOST) {
        fprintf(stderr, "holonom: %d incidents more (--json lists them all)\n", n - MOST);
    }
}

/// Says how far the motion may be from the true one, and up to when that is known: to people, and
/// in any case where it is far.
static void tell_estimate(const cJSON *run) {
    const cJSON *e = hn_document_get(run, "error_estimate");
    const double q = hn_document_number(e, "q"), reaction = hn_document_number(e, "reaction");
    const char *reason = hn_document_text(e, "reason");
    const bool far = fmax(q, reaction) > HN_ACCURACY_WARN;
    if (!far && !isatty(STDERR_FILENO)) {
        return;
    }
    if (isfinite(q)) {
        fprintf(stderr,
                "holonom: error estimate up to t = %.4g s: coordinates %.1e, reactions %.1e of "
                "their largest%s\n",
                hn_document_number(e, "t"), q, reaction, far ? "; a smaller step is needed" : "");
    }
    if (reason[0]) {
        fprintf(stderr, "holonom: no error estimate%s: %s\n", isfinite(q) ? " beyond that" : "",
                reason);
    }
}

static int tell_progress(void *user, double share) {
    hn_progress_tell(user, "running", share);
    return 1;
}

static hn_status run_scene(const hn_library *lib, const hn_args *args, hn_strbuf *b,
                           hn_status *ended, hn_diags *diags) {
    hn_model *model = NULL;
    hn_progress progress = {0};
    hn_status status = hn_args_load_model(lib, args, args->words.word[0], 0, &model, diags);
    if (status == HN_OK) {
        const hn_scene *scene = hn_model_scene(model);
        hn_run_request request = {.method = args->method ? args->method : hn_model_method(model),
                                  .time = isnan(args->time) ? scene->duration : args->time,
                                  .at = args->at.n > 0 ? args->at.value : NULL,
                                  .n_at = args->at.n,
                                  .every = isnan(args->every) ? 0 : args->every,
                                  .raw_lambda = args->raw_lambda,
                                  .reactions = args->reactions,
                                  .progress = tell_progress,
                                  .user = &progress};

        // an interval of 0 would mean the default
        if (!isnan(args->every) && !(args->every > 0)) {
            status = hn_diags_add(diags, HN_ERR_INPUT, "/every", NULL,
                                  "the output interval is %g s; it must be above 0", args->every);
        } else {
            status = hn_model_run_json(b, model, &request, ended, diags);
        }
        hn_progress_end(&progress);

        // the method that was chosen, once the question has turned out to be one
        if (status == HN_OK && !args->method && !args->json) {
            fprintf(stderr, "holonom: method %s; --method chooses another\n", request.method);
        }
    }
    hn_model_free(model);
    return status;
}

/// Gap and energy change of the samples, drawn over the index of the sample: they are taken at
/// equal intervals.
static void put_plot(hn_strbuf *b, const cJSON *run) {
    const cJSON *samples = hn_document_get(run, "samples");
    const cJSON *t = hn_document_get(samples, "t"),
                *last = t ? cJSON_GetArrayItem(t, cJSON_GetArraySize(t) - 1) : NULL;
    const cJSON *gap = hn_document_get(samples, "gap"),
                *energy = hn_document_get(samples, "energy_change");
    hn_motion_plot plot = {.gap_unit = "m", .n_tracks = 1};
    plot.tracks[0] = (hn_motion_track){.name = hn_document_text(run, "method")};
    plot.dt =
        last ? last->valuedouble / (cJSON_GetArraySize(t) > 1 ? cJSON_GetArraySize(t) - 1 : 1) : 1;

    // one point a sample; a gap that is null is left out
    const cJSON *g = gap ? gap->child : NULL;
    for (const cJSON *e = energy ? energy->child : NULL; e && hn_motion_plot_next(&plot);
         e = e->next) {
        if (cJSON_IsNumber(e)) {
            plot.tracks[0].energy[plot.n - 1] = e->valuedouble;
        }
        if (cJSON_IsNumber(g)) {
            plot.tracks[0].gap[plot.n - 1] = g->valuedouble;
        }
        g = g ? g->next : NULL;
    }
    hn_strbuf_clear(b);
    hn_motion_plot_text(b, &plot, hn_terminal_columns(), hn_terminal_colours());
    hn_motion_plot_free(&plot);
}

/// "csv", "ndjson" or "json"; NULL with the fault reported.
static const char *choose_format(const hn_args *args, hn_diags *diags) {
    static const char *const formats[] = {"csv", "ndjson", "json"};
    const char *wanted = args->json ? "json" : args->format ? args->format : "csv";
    for (int i = 0; i < 3; i++) {
        if (strcmp(wanted, formats[i]) == 0) {
            return formats[i];
        }
    }
    hn_diags_add(diags, HN_ERR_INPUT, NULL, "csv, ndjson or json",
                 "'%.40s' is not a form of samples", wanted);
    return NULL;
}

hn_exit hn_command_run(const hn_library *lib, const hn_args *args) {
    hn_diags diags = {0};
    hn_status ended = HN_OK;
    hn_strbuf b;
    hn_strbuf_init(&b);
    const char *format = choose_format(args, &diags);
    hn_status status = format ? run_scene(lib, args, &b, &ended, &diags) : HN_ERR_INPUT;
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        return hn_report_diags(args, status, &diags);
    }

    // people get a table or a plot, and what was noticed
    cJSON *run = NULL;
    char reason[560] = "";
    if (strcmp(format, "json") != 0) {
        run = hn_document_parse(&b);
        snprintf(reason, sizeof reason, "at t = %.6g s: %.480s",
                 hn_document_number(run, "t_reached"), hn_document_text(run, "reason"));
        tell_marks(run);
        tell_incidents(run);
        tell_estimate(run);
        if (args->plot) {
            put_plot(&b, run);
        } else {
            put_samples(&b, run, strcmp(format, "ndjson") == 0);
        }
        if (hn_document_text(run, "warning")[0]) {
            fprintf(stderr, "holonom: %s\n", hn_document_text(run, "warning"));
        }
        cJSON_Delete(run);
    }

    // a run that ended early has an exit status of its own
    hn_exit result = args->plot ? hn_cli_print_text(&b) : hn_cli_print(&b);
    if (ended != HN_OK && reason[0]) {
        fprintf(stderr, "holonom: the run ended early %s\n", reason);
    }
    return result == HN_EXIT_DONE && ended != HN_OK ? HN_EXIT_ENDED : result;
}
