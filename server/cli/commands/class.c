// SPDX-License-Identifier: GPL-3.0-or-later
// holonom class: the submissions of a class, one line each as it is graded, then a summary.
#include "class/class_grading.h"
#include "class/class_summary.h"
#include "cli/commands/rubric_file.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/document.h"
#include "cli/shell/forms.h"
#include "cli/shell/notes.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "grade/exercise_shelf.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double TIME_LIMIT = 60; // [s] for one submission

static bool is_graded(const cJSON *o) {
    return strcmp(hn_document_text(o, "status"), "graded") == 0;
}

/// One line on standard output as it is finished: JSON, or words.
static void tell(void *user, const char *line) {
    const hn_args *args = user;
    if (args->json) {
        printf("%s\n", line);
        fflush(stdout);
        return;
    }
    cJSON *o = cJSON_Parse(line);
    const char *remark = hn_document_text(o, "remark");
    if (is_graded(o)) {
        printf("%s: %g of %g, %s", hn_document_text(o, "student"), hn_document_number(o, "score"),
               hn_document_number(o, "max_score"), hn_document_text(o, "summary"));
    } else {
        printf("%s: %s, %s", hn_document_text(o, "student"), hn_document_text(o, "status"),
               hn_document_text(o, "reason"));
    }
    printf("%s%s\n", remark[0] ? "; " : "", remark);
    fflush(stdout);
    cJSON_Delete(o);
}

/// A field in quotes where it holds a comma or a quote; a formula for a spreadsheet it never is.
static void put_field(hn_strbuf *b, const char *text) {
    const char *guard = text[0] && strchr("=+-@", text[0]) ? "'" : "";
    hn_strbuf_printf(b, "\"%s", guard);
    for (; *text; text++) {
        hn_strbuf_add_n(b, text, 1);
        hn_strbuf_add(b, *text == '"' ? "\"" : "");
    }
    hn_strbuf_add(b, "\"");
}

static void put_csv(hn_strbuf *b, const hn_class_result *r) {
    hn_strbuf_add(b, "student,status,score,max_score,says,file,remark\n");
    for (int i = 0; i < r->n; i++) {
        cJSON *o = cJSON_Parse(r->line[i] ? r->line[i] : "{}");
        put_field(b, hn_document_text(o, "student"));
        hn_strbuf_printf(b, ",%s,%.10g,%.10g,", hn_document_text(o, "status"),
                         hn_document_number(o, "score"), hn_document_number(o, "max_score"));
        put_field(b, hn_document_text(o, is_graded(o) ? "summary" : "reason"));
        hn_strbuf_add(b, ",");
        put_field(b, hn_document_text(o, "file"));
        hn_strbuf_add(b, ",");
        put_field(b, hn_document_text(o, "remark"));
        hn_strbuf_add(b, "\n");
        cJSON_Delete(o);
    }
}

/// The whole result into --out: CSV by its ending, else one JSON object a line.
static hn_exit write_result(const hn_args *args, const hn_class_result *r) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (hn_path_ends_in(args->out, ".csv")) {
        put_csv(&b, r);
    } else {
        for (int i = 0; i < r->n; i++) {
            hn_strbuf_printf(&b, "%s\n", r->line[i] ? r->line[i] : "{}");
        }
    }
    return hn_cli_write_file(args, args->out, &b);
}

static hn_exit grade_roster(const hn_args *args, const hn_exercise *exercise,
                            const hn_roster *roster) {
    char journal[1100] = "";
    hn_class_result result;
    hn_diag diag = {0};
    hn_class_opts opts = {.jobs = isnan(args->jobs) ? (int)sysconf(_SC_NPROCESSORS_ONLN)
                                                    : (int)fmin(args->jobs, 1000),
                          .time_limit = TIME_LIMIT,
                          .seed = isnan(args->seed) ? 0 : (uint64_t)args->seed,
                          .tell = tell,
                          .user = (void *)args};

    // the journal from which an interrupted run goes on
    if (args->out) {
        snprintf(journal, sizeof journal, "%.1000s.part", args->out);
        opts.journal = journal;
    }

    // verdicts to the file, the summary to the terminal
    const hn_status status = hn_class_grade(roster, exercise, &opts, &result, &diag);
    hn_exit exit = status == HN_OK ? HN_EXIT_DONE : HN_EXIT_PROGRAM;
    if (status != HN_OK) {
        hn_report_diag(args, &diag);
    } else {
        if (result.resumed > 0) {
            hn_cli_note("holonom: %d of %d submissions were graded before\n", result.resumed,
                        result.n);
        }
        exit = args->out ? write_result(args, &result) : HN_EXIT_DONE;
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_class_summary(&b, &result);
        fputs(hn_strbuf_text(&b), args->json ? stderr : stdout);
        hn_strbuf_reset(&b);
    }

    hn_class_result_reset(&result);
    return exit;
}

hn_exit hn_command_class(const hn_library *lib, const hn_args *args) {
    hn_exercise *exercise = NULL;
    hn_roster roster = {0};
    hn_diags diags = {0};
    hn_diag diag = {0};
    hn_status status = hn_cli_check_folder(args->out, &diags);
    HN_THEN(status, hn_shelf_exercise_load(lib, args->words.word[0], &exercise, &diags));
    HN_THEN(status, hn_cli_apply_rubric(args, exercise, &diags));
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    status = hn_roster_read(&roster, args->words.word[1], &diag);
    const hn_exit exit =
        status == HN_OK ? grade_roster(args, exercise, &roster) : hn_report_diag(args, &diag);
    hn_roster_reset(&roster);
    hn_exercise_free(exercise);
    return exit;
}
