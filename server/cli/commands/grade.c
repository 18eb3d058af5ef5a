<<<<<<< HEAD
// holonom problem and holonom grade. A wrong answer graded low is done (0); a submission that cannot be read is 2.
#include "base/clock.h"
=======
// SPDX-License-Identifier: GPL-3.0-or-later
// holonom problem and holonom grade. A wrong answer graded low is done (0); a submission that
// cannot be read is 2.
>>>>>>> 6b1bd2d (Server: comments within 100 columns, one style of ruler, licence lines; the check of circles knows rooms in rooms)
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "grade/exercise_shelf.h"
#include "grade/grade.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

hn_exit hn_command_problem(const hn_library *lib, const hn_args *args) {
    hn_exercise *problem = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_status status = hn_shelf_exercise_load(lib, args->words.word[0], &problem, &diags);
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    if (args->json) {
        hn_exercise_json(&b, problem);
    } else {
        hn_exercise_text(&b, problem);
    }
    hn_exercise_free(problem);
    return hn_cli_print(&b);
}

/// The forms a verdict can be written in.
typedef enum verdict_form { FORM_TEXT, FORM_JSON, FORM_GRADESCOPE } verdict_form;

static hn_status choose_form(const hn_args *args, verdict_form *form, hn_diag *diag) {
    static const char *const names[] = {"text", "json", "gradescope"};
    const char *wanted = args->format ? args->format : args->json ? "json" : "text";
    for (int i = 0; i < 3; i++) {
        if (strcmp(wanted, names[i]) == 0) {
            *form = (verdict_form)i;
            return HN_OK;
        }
    }
    const char *near = hn_nearest_name(wanted, names, 3);
    return hn_diag_set(diag, HN_ERR_INPUT, NULL, near ? near : "text, json or gradescope",
                       "'%.40s' is not a form of verdicts", wanted);
}

static void write_verdict(hn_strbuf *b, const hn_verdict *v, verdict_form form, double seconds) {
    switch (form) {
    case FORM_TEXT:
        hn_verdict_text(b, v);
        break;
    case FORM_JSON:
        hn_verdict_json(b, v);
        break;
    case FORM_GRADESCOPE:
        hn_verdict_gradescope(b, v, seconds);
        break;
    }
}

/// Makes the folder and those above it.
static hn_status make_folder(const char *path, hn_diag *diag) {
    char part[1024];
    size_t n = strlen(path);
    for (size_t i = 1; i <= n && n < sizeof part; i++) {
        if (path[i] == '/' || path[i] == 0) {
            snprintf(part, sizeof part, "%.*s", (int)i, path);
            if (mkdir(part, 0777) != 0 && errno != EEXIST) {
                return hn_diag_set(diag, HN_ERR_IO, NULL, NULL,
                                   "cannot make the folder '%.200s': %s", part, strerror(errno));
            }
        }
    }
    return HN_OK;
}

/// DIR/results.json for one submission to Gradescope, otherwise DIR/NAME.json or .txt after the
/// submission's file.
static void name_file(char *out, size_t size, const hn_args *args, verdict_form form,
                      const char *submission, const char *ending) {
    const char *slash = strrchr(submission, '/'), *name = slash ? slash + 1 : submission;
    const char *dot = strrchr(name, '.');
    int n = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
    if (form == FORM_GRADESCOPE && args->words.n == 2) {
        snprintf(out, size, "%s/results.%s", args->out, ending);
    } else {
        snprintf(out, size, "%s/%.*s.%s", args->out, n, name, ending);
    }
}

/// The picture of the state at which a wrong entry shows; without one nothing is written.
static hn_exit write_picture(const hn_library *lib, const hn_args *args, verdict_form form,
                             const char *submission, const hn_verdict *v) {
    hn_strbuf png;
    hn_strbuf_init(&png);
    hn_diags diags = {0};
    hn_status status = hn_shelf_verdict_png(&png, lib, v, &diags);
    if (status == HN_OK) {
        char path[2048];
        name_file(path, sizeof path, args, form, submission, "png");
        return hn_cli_write_file(args, path, &png);
    }
    hn_strbuf_reset(&png);
    if (status == HN_ERR_UNSUPPORTED && diags.n == 0) {
        return HN_EXIT_DONE;
    }
    hn_report_diags(args, status, &diags);
    return HN_EXIT_PROGRAM;
}

static hn_exit grade_one(const hn_library *lib, const hn_args *args, const hn_exercise *problem,
                         verdict_form form, const char *submission) {
    double start = hn_clock_wall();
    hn_verdict *v = calloc(1, sizeof *v);
    hn_diag diag = {0};
    uint64_t seed = isnan(args->seed) ? 0 : (uint64_t)args->seed;
    hn_status status = v ? hn_grade_file(problem, submission, seed, v) : HN_ERR_MEMORY;
    if (status != HN_OK) {
        free(v);
        hn_diag_set(&diag, status, NULL, NULL, "the grader failed on '%.200s': %s", submission,
                    hn_status_text(status));
        hn_report_diag(args, &diag);
        return HN_EXIT_PROGRAM;
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (args->words.n > 2 && form == FORM_TEXT && !args->out) {
        hn_strbuf_printf(&b, "== %s\n", submission);
    }
    write_verdict(&b, v, form, hn_clock_wall() - start);
    hn_exit result;
    if (args->out) {
        char path[2048];
        name_file(path, sizeof path, args, form, submission, form == FORM_TEXT ? "txt" : "json");
        result = hn_cli_write_file(args, path, &b);
        if (result == HN_EXIT_DONE) {
            result = write_picture(lib, args, form, submission, v);
        }
        printf("%s: %s\n", submission, v->kind == HN_VERDICT_UNGRADABLE ? v->reason : v->summary);
    } else {
        result = hn_cli_print(&b);
    }
    int ungradable = v->kind == HN_VERDICT_UNGRADABLE;
    free(v);
    return result == HN_EXIT_DONE && ungradable ? HN_EXIT_INPUT : result;
}

hn_exit hn_command_grade(const hn_library *lib, const hn_args *args) {
    hn_exercise *problem = NULL;
    hn_diags diags = {0};
    hn_diag diag = {0};
    verdict_form form = FORM_TEXT;
    hn_status status = choose_form(args, &form, &diag);
    if (status == HN_OK && args->out) {
        status = make_folder(args->out, &diag);
    }
    if (status != HN_OK) {
        return hn_report_diag(args, &diag);
    }
    status = hn_shelf_exercise_load(lib, args->words.word[0], &problem, &diags);
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    // one bad submission never stops the rest; the worst outcome is the exit status
    hn_exit worst = HN_EXIT_DONE;
    for (int i = 1; i < args->words.n; i++) {
        hn_exit one = grade_one(lib, args, problem, form, args->words.word[i]);
        worst = one > worst ? one : worst;
    }
    hn_exercise_free(problem);
    return worst;
}
