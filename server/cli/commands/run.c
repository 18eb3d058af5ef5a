// SPDX-License-Identifier: GPL-3.0-or-later
// holonom run: one method, its samples as CSV, NDJSON or JSON.
#include "cli/commands/error_advice.h"
#include "cli/commands/incident_list.h"
#include "cli/commands/run_rows.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/document.h"
#include "cli/shell/notes.h"
#include "cli/shell/print.h"
#include "cli/shell/progress.h"
#include "cli/shell/scene_word.h"
#include "session/compare/comparison.h"
#include "session/compare/estimate.h"
#include "session/compare/run_doc.h"
#include "terminal/motion_plot.h"
#include "terminal/width.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/// NDJSON closes with everything but the samples.
static void put_tail(hn_strbuf *b, cJSON *run) {
    cJSON_DeleteItemFromObjectCaseSensitive(run, "samples");
    char *text = cJSON_PrintUnformatted(run);
    hn_strbuf_add(b, text ? text : "");
    hn_strbuf_add(b, "\n");
    b->failed |= text == NULL;
    cJSON_free(text);
}

/// A row that the run has just made.
static void take_row(void *user, const hn_strbuf *names, const double *values, int n) {
    hn_run_rows *rows = user;
    if (names) {
        cJSON *document = cJSON_Parse(hn_strbuf_text(names));
        hn_run_rows_begin(rows, document);
        cJSON_Delete(document);
    }
    hn_run_rows_put(rows, values, n);
}

/// Meaning of a mark of multipliers, as the end of a sentence.
static const char *const marked[HN_N_MULTIPLIER_MARKS] = {
    [HN_MULTIPLIERS_ONE_OF_MANY] = "are one of many possible sets",
    [HN_MULTIPLIERS_LOST] = "have no correct digit",
    [HN_MULTIPLIERS_NONE] = "do not exist",
    [HN_MULTIPLIERS_OPEN] = "are those of open loops",
};

/// Says how many samples have multipliers that are not determined, by mark.
static void tell_marks(const cJSON *run) {
    const cJSON *marks = hn_document_get(hn_document_get(run, "samples"), "lambda_mark"), *entry;
    for (int mark = 1; mark < HN_N_MULTIPLIER_MARKS; mark++) {
        int n = 0;
        cJSON_ArrayForEach(entry, marks) {
            n += (int)cJSON_GetNumberValue(entry) == mark;
        }
        if (n > 0) {
            hn_cli_note("holonom: in %d of %d samples the multipliers, and the joint forces "
                        "computed from them, %s (lambda_mark %d)\n",
                        n, cJSON_GetArraySize(marks), marked[mark], mark);
        }
    }
}

enum { MOST = 5 }; // incidents that are told one by one

/// Says what an incident's first remedy does, where it was tried.
static void tell_remedy(const cJSON *incident) {
    const char *remedy = hn_incident_remedy(incident);
    if (remedy) {
        hn_cli_note("holonom:     try %s (%s)\n", remedy,
                    hn_document_get(incident, "tried")->child->valuestring);
    }
}

/// Returns whether the remedy of item k is told later too: of another of the first n, or of the
/// end.
static bool is_repeated(const hn_incident_list *list, int n, int k) {
    const char *own = hn_incident_remedy(list->item[k]);
    for (int j = k + 1; own && j <= n; j++) {
        const char *other = hn_incident_remedy(j < n ? list->item[j] : list->end);
        if (other && strcmp(own, other) == 0) {
            return true;
        }
    }
    return false;
}

/// Says what was noticed on the way, errors before warnings; samples alone would hide it. A remedy
/// of several incidents is said once, after the last of them.
static void tell_incidents(const hn_incident_list *list) {
    const int told = list->n < MOST ? list->n : MOST;
    for (int k = 0; k < told; k++) {
        char line[HN_INCIDENT_LINE];
        hn_incident_line(list->item[k], line, sizeof line);
        hn_cli_note("holonom: %s\n", line);
        if (!is_repeated(list, told, k)) {
            tell_remedy(list->item[k]);
        }
    }
    if (list->n > told) {
        hn_strbuf more;
        hn_strbuf_init(&more);
        hn_incident_more(&more, list, told);
        hn_cli_note("holonom: %s\n", hn_strbuf_text(&more));
        hn_strbuf_reset(&more);
    }
}

/// Says whether the motion is right, by its error estimate, and what the scene shows on purpose: on
/// standard error wherever that leads, because samples show no error.
static void tell_verdict(const cJSON *run, const char *exhibit) {
    const cJSON *verdict = hn_document_get(run, "verdict");
    const char *is = hn_document_text(verdict, "is");
    const bool unknown = strcmp(is, "unknown") == 0, right = strcmp(is, "right") == 0;
    const double times = hn_document_number(hn_document_get(run, "error_estimate"), "over_rtol");
    const double until = hn_document_number(hn_document_get(run, "error_estimate"), "t");
    const bool in_part = unknown && until > 0;
    char factor[96] = "";
    if (times > HN_TOLERANCE_KEPT) {
        snprintf(factor, sizeof factor,
                 "; that is %.0f times rtol, which limits the error of one step only", times);
    }
    hn_cli_note("holonom: the motion is %s: %s%s%s\n",
                in_part   ? "right as far as it was judged"
                : unknown ? "not judged"
                          : is,
                hn_document_text(verdict, "text"), factor,
                right || unknown ? ""
                                 : hn_error_advice(run, hn_document_get(run, "incidents"), -1));
    if (!right && !unknown && exhibit[0]) {
        hn_cli_note("holonom: this is intended: %s\n", exhibit);
    }
}

static int tell_progress(void *user, double share) {
    hn_progress_tell(user, "running", share);
    return 1;
}

/// Takes the exhibit of the scene's own methods: what is meant to go wrong, in a run by one of
/// them.
static void take_exhibit(const hn_model *model, const char *method, hn_strbuf *exhibit) {
    int n = 0;
    const char *const *own = hn_model_methods(model, &n);
    for (int i = 0; i < n; i++) {
        if (strcmp(own[i], method) == 0) {
            hn_strbuf_add(exhibit, hn_model_scene(model)->exhibit);
            return;
        }
    }
}

/// The least time between two samples of a request [s].
static double spacing_of(const hn_run_request *r) {
    enum { SAMPLES = 200 }; // where no times are asked for
    double least = r->every > 0 ? r->every : r->time / SAMPLES;
    for (int i = 0; r->at && i < r->n_at; i++) {
        const double step = r->at[i] - (i > 0 ? r->at[i - 1] : 0);
        least = i == 0 ? (step > 0 ? step : least) : step > 0 ? fmin(least, step) : least;
    }
    return least;
}

/// `rows`: prints them as they are made; NULL: the document alone.
static hn_status run_scene(const hn_library *lib, const hn_args *args, hn_run_rows *rows,
                           hn_strbuf *b, hn_strbuf *exhibit, hn_status *ended, hn_diags *diags) {
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
                                  .to_the_end = true,
                                  .raw_lambda = args->raw_lambda,
                                  .reactions = args->reactions,
                                  .row = rows ? take_row : NULL,
                                  .row_user = rows,
                                  .user = &progress};
        if (rows) {
            rows->spacing = spacing_of(&request);
        }

        // rows on a terminal are progress enough
        request.progress = rows && isatty(STDOUT_FILENO) ? NULL : tell_progress;

        // an interval of 0 would mean the default
        if (!isnan(args->every) && !(args->every > 0)) {
            status = hn_diags_add(diags, HN_ERR_INPUT, "/every", NULL,
                                  "the output interval is %g s; it must be above 0", args->every);
        } else {
            status = hn_model_run_json(b, model, &request, ended, diags);
        }
        hn_progress_end(&progress);
        if (args->set.n == 0) { // of another mechanism the scene says nothing
            take_exhibit(model, request.method, exhibit);
        }

        // the method that was chosen, once the question has turned out to be one
        if (status == HN_OK && !args->method && !args->json) {
            hn_cli_note("holonom: method %s; --method chooses another\n", request.method);
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

/// Says why a run ended early, and what goes past that.
static void tell_ending(const cJSON *run, const hn_incident_list *incidents) {
    char ending[HN_INCIDENT_LINE];
    hn_incident_ending(incidents, hn_document_number(run, "t_reached"),
                       hn_document_text(run, "reason"), ending, sizeof ending);
    hn_cli_note("holonom: the run ended early%s\n", ending);
    tell_remedy(incidents->end);
}

/// Says that a table for people has not all columns, and how to get them.
static void tell_left_out(const hn_args *args, const hn_run_rows *rows) {
    if (rows->width > 0 && rows->n_shown < rows->n) {
        hn_cli_note("holonom: %d of %d columns have no room here; all of them, with all digits: "
                    "holonom run %s --format csv > FILE\n",
                    rows->n - rows->n_shown, rows->n, args->words.word[0]);
    }
}

/// Tells people what was noticed, and leaves in `b` what goes to standard output after the rows: a
/// plot, or the end of NDJSON.
static void tell_run(const hn_args *args, cJSON *run, const hn_incident_list *incidents,
                     const hn_run_rows *rows, const char *exhibit, hn_strbuf *b) {
    tell_left_out(args, rows);
    tell_marks(run);
    tell_incidents(incidents);
    tell_verdict(run, exhibit);
    if (args->plot) {
        put_plot(b, run);
    } else if (rows->ndjson) {
        put_tail(b, run);
    }
    b->failed |= rows->failed;
    if (hn_document_text(run, "warning")[0]) {
        hn_cli_note("holonom: %s\n", hn_document_text(run, "warning"));
    }
}

hn_exit hn_command_run(const hn_library *lib, const hn_args *args) {
    hn_diags diags = {0};
    hn_status ended = HN_OK;
    hn_strbuf b, exhibit;
    hn_strbuf_init(&b);
    hn_strbuf_init(&exhibit);
    const char *format = choose_format(args, &diags);
    hn_run_rows rows = {.ndjson = format && strcmp(format, "ndjson") == 0};
    // a terminal gets a table that fits it, unless a format is asked for
    if (!args->format && !args->json && isatty(STDOUT_FILENO)) {
        rows.width = args->wide ? INT_MAX : hn_terminal_limit();
    }
    const bool streams = format && strcmp(format, "json") != 0 && !args->plot;
    hn_status status =
        format ? run_scene(lib, args, streams ? &rows : NULL, &b, &exhibit, &ended, &diags)
               : HN_ERR_INPUT;
    if (status != HN_OK) {
        hn_run_rows_reset(&rows);
        hn_strbuf_reset(&b);
        hn_strbuf_reset(&exhibit);
        return hn_report_diags(args, status, &diags);
    }

    // people get a table or a plot, and what was noticed
    cJSON *run = NULL;
    hn_incident_list incidents = {0};
    if (strcmp(format, "json") != 0) {
        run = hn_document_parse(&b);
        hn_incident_list_take(&incidents, hn_document_get(run, "incidents"), -1,
                              hn_document_text(run, "reason"));
        if (streams && !rows.begun) {
            hn_run_rows_begin(&rows, run); // no sample was made
        }
        tell_run(args, run, &incidents, &rows, hn_strbuf_text(&exhibit), &b);
    }

    // a run that ended early has an exit status of its own
    hn_exit result = args->plot ? hn_cli_print_text(&b) : hn_cli_print(&b);
    if (result == HN_EXIT_DONE && rows.error) {
        hn_cli_note("holonom: cannot write to standard output: %s\n", strerror(rows.error));
        result = HN_EXIT_PROGRAM;
    }
    if (ended != HN_OK && run) {
        tell_ending(run, &incidents);
    }
    cJSON_Delete(run);
    hn_run_rows_reset(&rows);
    hn_strbuf_reset(&exhibit);
    return result == HN_EXIT_DONE && ended != HN_OK ? HN_EXIT_ENDED : result;
}
