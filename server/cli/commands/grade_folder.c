// SPDX-License-Identifier: GPL-3.0-or-later
// The submissions of a class, one line each as it is graded, then a summary.
#include "cli/commands/grade_folder.h"

#include "base/file.h"
#include "base/visible.h"
#include "class/class_copies.h"
#include "class/class_grading.h"
#include "class/class_summary.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/document.h"
#include "cli/shell/forms.h"
#include "cli/shell/notes.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "grade/exercise_shelf.h"

#include <cjson/cJSON.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_BYTES = 256 << 20 };

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
    hn_strbuf words, visible;
    hn_strbuf_init(&words);
    hn_strbuf_init(&visible);
    hn_strbuf_printf(&words, "%s: ", hn_document_text(o, "student"));
    if (is_graded(o)) {
        hn_strbuf_printf(&words, "%g of %g, %s", hn_document_number(o, "score"),
                         hn_document_number(o, "max_score"), hn_document_text(o, "summary"));
    } else {
        hn_strbuf_printf(&words, "%s, %s", hn_document_text(o, "status"),
                         hn_document_text(o, "reason"));
    }
    hn_strbuf_printf(&words, "%s%s", remark[0] ? "; " : "", remark);

    // a student's file, and what is quoted of it, commands no terminal
    hn_visible_add(&visible, hn_strbuf_text(&words), true);
    puts(hn_strbuf_text(&visible));
    fflush(stdout);
    hn_strbuf_reset(&visible);
    hn_strbuf_reset(&words);
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

/// Writes what a line remarks, and who handed in the same.
static void put_remark(hn_strbuf *b, const char *remark, const hn_class_copies *copies, int i) {
    hn_strbuf all;
    hn_strbuf_init(&all);
    hn_strbuf_add(&all, remark);
    hn_class_copies_put(&all, copies, i);
    put_field(b, hn_strbuf_text(&all));
    b->failed |= all.failed;
    hn_strbuf_reset(&all);
}

/// "sign in a; degrees in b.2": one field.
static void put_mistakes(hn_strbuf *b, const cJSON *line) {
    const cJSON *m;
    hn_strbuf all;
    hn_strbuf_init(&all);
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(line, "mistakes")) {
        hn_strbuf_printf(&all, "%s%s", all.n ? "; " : "", cJSON_IsString(m) ? m->valuestring : "");
    }
    put_field(b, hn_strbuf_text(&all));
    b->failed |= all.failed;
    hn_strbuf_reset(&all);
}

static void put_csv(hn_strbuf *b, const hn_class_result *r, bool programs) {
    hn_class_copies copies;
    hn_class_copies_find(&copies, r, programs);
    hn_strbuf_add(b, "student,status,score,max_score,says,mistakes,file,remark\n");
    for (int i = 0; i < r->n; i++) {
        cJSON *o = r->line[i] ? cJSON_Parse(r->line[i]) : NULL;
        if (!o) {
            continue; // of another shard
        }
        put_field(b, hn_document_text(o, "student"));
        hn_strbuf_printf(b, ",%s,%.10g,%.10g,", hn_document_text(o, "status"),
                         hn_document_number(o, "score"), hn_document_number(o, "max_score"));
        put_field(b, hn_document_text(o, is_graded(o) ? "summary" : "reason"));
        hn_strbuf_add(b, ",");
        put_mistakes(b, o);
        hn_strbuf_add(b, ",");
        put_field(b, hn_document_text(o, "file"));
        hn_strbuf_add(b, ",");
        put_remark(b, hn_document_text(o, "remark"), &copies, i);
        hn_strbuf_add(b, "\n");
        cJSON_Delete(o);
    }
    hn_class_copies_reset(&copies);
}

/// The whole result into --out: CSV by its ending, else one JSON object a line.
static hn_exit write_result(const hn_args *args, const hn_class_result *r, bool programs) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (hn_path_ends_in(args->out, ".csv")) {
        put_csv(&b, r, programs);
    } else {
        for (int i = 0; i < r->n; i++) {
            hn_strbuf_add(&b, r->line[i] ? r->line[i] : "");
            hn_strbuf_add(&b, r->line[i] ? "\n" : "");
        }
    }
    return hn_cli_write_file(args, args->out, &b);
}

/// Reports the cause once where the exercise is at fault, whose class is then not graded.
static hn_exit report_exercise_fault(const hn_args *args, const hn_class_result *r) {
    hn_diag diag = {0};
    const size_t n = strlen(HN_CLASS_EXERCISE_FAULT);
    for (int i = 0; i < r->n && !diag.message[0]; i++) {
        cJSON *o = r->line[i] ? cJSON_Parse(r->line[i]) : NULL;
        const char *reason = hn_document_text(o, "reason");
        if (strcmp(hn_document_text(o, "status"), "failed") == 0 &&
            strncmp(reason, HN_CLASS_EXERCISE_FAULT, n) == 0) {
            hn_diag_set(&diag, HN_ERR_INTERNAL, NULL, "problem EXERCISE --check tries each variant",
                        "%s", reason);
        }
        cJSON_Delete(o);
    }
    if (diag.message[0]) {
        hn_report_diag(args, &diag);
        return HN_EXIT_PROGRAM;
    }
    return HN_EXIT_DONE;
}

/// The result into --out, and its summary to the terminal.
static hn_exit finish(const hn_args *args, const hn_class_result *result, bool programs) {
    hn_exit exit = args->out ? write_result(args, result, programs) : HN_EXIT_DONE;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_class_summary(&b, result, programs);
    fputs(hn_strbuf_text(&b), args->json ? stderr : stdout);
    hn_strbuf_reset(&b);

    // lines that nobody could read are no result
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "holonom: standard output takes no more: the verdicts are not all there\n");
        exit = HN_EXIT_PROGRAM;
    }
    return exit;
}

/// "2/4": the second of four parts.
static hn_status read_shard(const char *text, hn_class_shard *out, hn_diag *diag) {
    char behind;
    if (!text) {
        return HN_OK;
    }
    if (sscanf(text, "%d/%d%c", &out->i, &out->n, &behind) != 2 || out->i < 1 || out->n < 1 ||
        out->i > out->n) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/shard", "as 2/4: the second of four",
                           "'%.40s' is no part of a class", text);
    }
    return HN_OK;
}

static hn_exit grade_roster(const hn_args *args, const hn_grade_subject *subject,
                            const hn_roster *roster) {
    char journal[1100] = "";
    hn_class_result result;
    hn_diag diag = {0};
    hn_class_opts opts = {.jobs = isnan(args->jobs) ? (int)sysconf(_SC_NPROCESSORS_ONLN)
                                                    : (int)fmin(args->jobs, 1000),
                          .programs = subject->programs,
                          .blanks = subject->blanks,
                          .time_limit = HN_GRADE_TIME_LIMIT,
                          .seed = isnan(args->seed) ? 0 : (uint64_t)args->seed,
                          .tell = tell,
                          .user = (void *)args};
    if (read_shard(args->shard, &opts.shard, &diag) != HN_OK) {
        return hn_report_diag(args, &diag);
    }

    // the journal from which an interrupted run goes on
    if (args->out) {
        snprintf(journal, sizeof journal, "%.1000s.part", args->out);
        opts.journal = journal;
        opts.finished = hn_path_ends_in(args->out, ".csv") ? NULL : args->out;
    }

    // verdicts to the file, the summary to the terminal
    const hn_status status = hn_class_grade(roster, subject->exercise, &opts, &result, &diag);
    hn_exit exit = HN_EXIT_PROGRAM;
    if (status != HN_OK) {
        if (!diag.message[0]) {
            (void)hn_diag_set(&diag, status, NULL, NULL, "%s", hn_status_text(status));
        }
        hn_report_diag(args, &diag);
    } else {
        if (result.resumed > 0) {
            hn_cli_note("holonom: %d of %d submissions were graded before\n", result.resumed,
                        result.n - result.others);
        }
        exit = finish(args, &result, subject->programs != NULL);
        if (exit == HN_EXIT_DONE && journal[0]) {
            unlink(journal); // all of it is in the result
        }
        const hn_exit fault = report_exercise_fault(args, &result);
        exit = fault > exit ? fault : exit;
    }

    hn_class_result_reset(&result);
    return exit;
}

/// Returns whether a file would lie in the folder or in one below it; links are followed.
static bool lies_in(const char *file, const char *folder) {
    char parent[PATH_MAX], inside[PATH_MAX], outside[PATH_MAX];
    const char *slash = strrchr(file, '/');
    const int n = slash == file ? 1 : slash ? (int)(slash - file) : 1;
    snprintf(parent, sizeof parent, "%.*s", n, slash ? file : ".");
    if (!realpath(parent, inside) || !realpath(folder, outside)) {
        return false;
    }
    const size_t length = strlen(outside);
    return strncmp(inside, outside, length) == 0 &&
           (inside[length] == '/' || inside[length] == '\0' || length == 1);
}

/// The ending of --out chooses the form; a file among the submissions would be graded next time.
static hn_status check_out(const char *out, const char *folder, hn_diags *diags) {
    if (!out) {
        return HN_OK;
    }
    if (strcmp(out, "-") == 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/out",
                            "--json prints the lines on standard output",
                            "--out of a class is a file");
    }
    if (!hn_path_ends_in(out, ".csv") && !hn_path_ends_in(out, ".ndjson") &&
        !hn_path_ends_in(out, ".jsonl")) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/out", "--out scores.csv, or scores.ndjson",
                            "the ending of '%.200s' says no form of scores: .csv, or .ndjson and "
                            ".jsonl, are allowed",
                            out);
    }
    if (folder && lies_in(out, folder)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/out", "choose a place outside the folder",
                            "'%.200s' lies among the submissions in '%.200s': it would be graded "
                            "as one",
                            out, folder);
    }
    return HN_OK;
}

hn_exit hn_grade_folder(const hn_args *args, const hn_grade_subject *subject) {
    hn_roster roster = {0};
    hn_diags diags = {0};
    hn_diag diag = {0};
    const bool many = args->words.n > 2 || args->format || args->student;
    if (many) {
        hn_diag_set(&diag, HN_ERR_INPUT, NULL, "--out FILE.ndjson or FILE.csv chooses the form",
                    args->words.n > 2
                        ? "'%.200s' is a folder: a class is graded alone"
                        : "'%.200s' is a folder: --format and --student are for files",
                    args->words.word[1]);
        return hn_report_diag(args, &diag);
    }
    const hn_status status = check_out(args->out, args->words.word[1], &diags);
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    const hn_exit exit = hn_roster_read(&roster, args->words.word[1], &diag) == HN_OK
                             ? grade_roster(args, subject, &roster)
                             : hn_report_diag(args, &diag);
    hn_roster_reset(&roster);
    return exit;
}

// ---- parts of a class, put together ----

/// The parts read so far: their lines, and by which rules the first of them was graded.
typedef struct merging {
    const char *exercise; ///< the id that the command names
    char first[200];      ///< file of the first part
    char marking[20];     ///< of the first part: hash of its exercise, its rubric and its --seed
    hn_class_result result;
} merging;

/// A copy of a line as a run of the whole class writes it: without what only a part has.
static char *without_place(const char *line, size_t n, const char *marking) {
    char last[40];
    char *own = strndup(line, n);
    char *from = own ? strstr(own, "\"place\":") : NULL;
    snprintf(last, sizeof last, "\"marking\":\"%s\",", marking);
    const char *to = from ? strstr(from, last) : NULL;
    if (to) {
        to += strlen(last);
        memmove(from, to, strlen(to) + 1);
    }
    return own;
}

/// Returns whether a line has its place in a class of the size that the lines before it have.
static bool has_place(const merging *m, const cJSON *o) {
    const cJSON *place = cJSON_GetObjectItem(o, "place"), *of = cJSON_GetObjectItem(o, "of");
    const int n = m->result.n;
    return cJSON_IsNumber(place) && cJSON_IsNumber(of) && of->valueint > 0 &&
           of->valueint <= 1000000 && place->valueint >= 0 && place->valueint < of->valueint &&
           (n == 0 || n == of->valueint) && hn_document_text(o, "marking")[0];
}

/// Refuses a line of another class, of another exercise, or one that was graded by other rules.
static hn_status check_line(const merging *m, const char *file, const cJSON *o, hn_diag *diag) {
    const char *exercise = hn_document_text(o, "exercise");
    if (!has_place(m, o)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL,
                           "holonom grade ID FOLDER --shard i/n --out FILE.ndjson makes one",
                           "'%.200s' is not a part of this class", file);
    }
    if (strcmp(exercise, m->exercise) != 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/merge", "name the exercise that was graded",
                           "'%.200s' is a part of exercise '%.60s', not of '%.60s'", file, exercise,
                           m->exercise);
    }
    if (m->first[0] && strcmp(hn_document_text(o, "marking"), m->marking) != 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/merge",
                           "grade one of them again with the --rubric and --seed of the other",
                           "'%.150s' was graded with another rubric, another --seed or another "
                           "version of exercise '%.60s' than '%.150s'",
                           file, exercise, m->first);
    }
    return HN_OK;
}

/// Room for the lines of the class, whose size the first line of the first part says.
static hn_status begin_merging(merging *m, const char *file, const cJSON *o) {
    m->result.n = cJSON_GetObjectItem(o, "of")->valueint;
    m->result.line = calloc((size_t)m->result.n + 1, sizeof *m->result.line);
    snprintf(m->first, sizeof m->first, "%s", file);
    snprintf(m->marking, sizeof m->marking, "%s", hn_document_text(o, "marking"));
    return m->result.line ? HN_OK : HN_ERR_MEMORY;
}

/// Takes one line of a part into its place.
static hn_status take_line(merging *m, const char *file, const char *line, size_t n,
                           hn_diag *diag) {
    cJSON *o = cJSON_ParseWithLength(line, n);
    hn_status status = check_line(m, file, o, diag);
    if (status == HN_OK && !m->result.line) {
        status = begin_merging(m, file, o);
    }
    char *own = status == HN_OK ? without_place(line, n, m->marking) : NULL;
    char **kept =
        status == HN_OK ? &m->result.line[cJSON_GetObjectItem(o, "place")->valueint] : NULL;
    if (status == HN_OK && !own) {
        status = HN_ERR_MEMORY;
    } else if (status == HN_OK && *kept && strcmp(*kept, own) != 0) {
        status = hn_diag_set(diag, HN_ERR_INPUT, NULL, "grade one of the parts again",
                             "'%.200s' and a part before it differ about %.80s", file,
                             hn_document_text(o, "student"));
    }
    if (status == HN_OK && !*kept) {
        *kept = own;
        own = NULL;
    }
    free(own);
    cJSON_Delete(o);
    return status;
}

static hn_status take_part(merging *m, const char *file, hn_diag *diag) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_status status = hn_file_read(file, MOST_BYTES, &text, diag);
    for (const char *at = hn_strbuf_text(&text); status == HN_OK && *at;) {
        const size_t n = strcspn(at, "\n");
        status = take_line(m, file, at, n, diag);
        at += n + (at[n] == '\n');
    }
    hn_strbuf_reset(&text);
    return status;
}

/// Every place must be filled, else some part is missing.
static hn_status check_whole(const hn_class_result *r, hn_diag *diag) {
    int missing = 0;
    for (int i = 0; i < r->n; i++) {
        missing += !r->line[i];
    }
    return missing == 0 && r->n > 0
               ? HN_OK
               : hn_diag_set(diag, HN_ERR_INPUT, "/merge", "name all parts of the class",
                             "%d of %d submissions are in none of these parts", missing, r->n);
}

hn_exit hn_grade_merge(const hn_args *args, const hn_grade_subject *subject) {
    merging m = {.exercise = hn_exercise_id(subject->exercise)};
    hn_diag diag = {0};
    hn_diags diags = {0};
    hn_status status = check_out(args->out, NULL, &diags);
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    for (int i = 1; i < args->words.n && status == HN_OK; i++) {
        status = take_part(&m, args->words.word[i], &diag);
    }
    HN_THEN(status, check_whole(&m.result, &diag));
    const hn_exit exit = status == HN_OK ? finish(args, &m.result, subject->programs != NULL)
                                         : hn_report_diag(args, &diag);
    hn_class_result_reset(&m.result);
    return exit;
}
