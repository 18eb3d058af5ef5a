// SPDX-License-Identifier: GPL-3.0-or-later
// holonom problem and holonom grade. Exit statuses: 0 graded, however low; 2 a submission that
// cannot be read, or a word that is wrong; 3 an exercise that does not load, an output that cannot
// be written.
#include "base/clock.h"
#include "cli/commands/verdict_names.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "grade/exercise_shelf.h"
#include "grade/grade.h"
#include "grade/variant.h"
#include "grade/verdict_forms.h"
#include "terminal/bars.h"
#include "terminal/width.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// An unknown id is the fault of the command line; an exercise that does not load is the program's.
static hn_exit report_exercise(const hn_library *lib, const hn_args *args, hn_status status,
                               const hn_diags *diags) {
    const hn_exit result = hn_report_diags(args, status, diags);
    return hn_library_problem_path(lib, args->words.word[0]) ? HN_EXIT_PROGRAM : result;
}

/// The forms a verdict can be written in: the name, and the ending of its file in --out.
typedef enum verdict_form {
    FORM_TEXT,
    FORM_JSON,
    FORM_GRADESCOPE,
    FORM_JUNIT,
    FORM_CSV,
    FORM_HTML,
    N_FORMS
} verdict_form;
static const char *const FORM_NAMES[N_FORMS] = {"text",  "json", "gradescope",
                                                "junit", "csv",  "html"};
static const char *const FORM_ENDINGS[N_FORMS] = {"txt", "json", "json", "xml", "csv", "html"};

static hn_status choose_form(const hn_args *args, verdict_form *form, hn_diag *diag) {
    const char *wanted = args->format ? args->format : args->json ? "json" : "text";
    for (int i = 0; i < N_FORMS; i++) {
        if (strcmp(wanted, FORM_NAMES[i]) == 0) {
            *form = (verdict_form)i;
            return HN_OK;
        }
    }
    const char *near = hn_nearest_name(wanted, FORM_NAMES, N_FORMS);
    return hn_diag_set(diag, HN_ERR_INPUT, NULL,
                       near ? near : "text, json, gradescope, junit, csv or html",
                       "'%.40s' is not a form of verdicts", wanted);
}

static const char *ending_of(verdict_form form) {
    return FORM_ENDINGS[form];
}

/// A bar for every entry, and one for the score.
static void write_bars(hn_strbuf *b, const hn_verdict *v) {
    static hn_bar bars[HN_GRADE_MAX_ENTRIES + 1];
    for (int i = 0; i <= v->n_entries; i++) {
        const hn_entry_verdict *e = i < v->n_entries ? &v->entry[i] : NULL;
        const double points = e ? e->points : v->score, most = e ? e->max_points : v->max_score;
        snprintf(bars[i].label, sizeof bars[i].label, "%s", e ? e->name : "score");
        snprintf(bars[i].value, sizeof bars[i].value, "%g of %g%s%s", points, most,
                 e && e->mistake[0] ? "  " : "", e ? e->mistake : "");
        bars[i].share = most > 0 ? points / most : (double)NAN;
        bars[i].colour = e && !e->right ? HN_CELL_ALARM : HN_CELL_INK;
    }
    hn_strbuf_printf(b, "%s: %s\n", v->problem->id, v->summary);
    hn_bars_text(b, bars, v->n_entries + 1, hn_terminal_columns(), hn_terminal_colours());
}

/// `first`: of several verdicts on one output.
static void write_verdict(hn_strbuf *b, const hn_verdict *v, verdict_form form, double seconds,
                          int first) {
    switch (form) {
    case FORM_JSON:
        hn_verdict_json(b, v);
        break;
    case FORM_GRADESCOPE:
        hn_verdict_gradescope(b, v, seconds);
        break;
    case FORM_JUNIT:
        hn_verdict_junit(b, v);
        break;
    case FORM_CSV:
        hn_verdict_csv(b, v, first);
        break;
    case FORM_HTML:
        hn_verdict_html(b, v);
        break;
    default:
        hn_verdict_text(b, v);
    }
}

/// One submission, graded: what all of them share, and where its verdict goes.
typedef struct task {
    const hn_library *lib;
    const hn_args *args;
    const hn_exercise *exercise;
    verdict_form form;
    const char *submission;
    const char *target; ///< path without ending; NULL: standard output
} task;

/// The picture of the state at which a wrong entry shows; without one nothing is written.
static hn_exit write_picture(const task *t, const hn_verdict *v) {
    hn_strbuf png, path;
    hn_strbuf_init(&png);
    hn_strbuf_init(&path);
    hn_diags diags = {0};
    hn_exit result = HN_EXIT_DONE;
    hn_status status = hn_shelf_verdict_png(&png, t->lib, v, &diags);
    if (status == HN_OK) {
        hn_strbuf_printf(&path, "%s.png", t->target);
        result = hn_cli_write_file(t->args, hn_strbuf_text(&path), &png);
    } else if (status != HN_ERR_UNSUPPORTED || diags.n > 0) {
        hn_report_diags(t->args, status, &diags);
        result = HN_EXIT_PROGRAM;
    }
    hn_strbuf_reset(&png);
    hn_strbuf_reset(&path);
    return result;
}

/// The verdict, and under --out the picture and a line on standard output.
static hn_exit write_result(const task *t, const hn_verdict *v, double seconds) {
    hn_strbuf b, path;
    hn_strbuf_init(&b);
    hn_strbuf_init(&path);

    // the verdict, under the name of its submission where there are several
    if (t->args->words.n > 2 && t->form == FORM_TEXT && !t->target) {
        hn_strbuf_printf(&b, "== %s\n", t->submission);
    }
    const int first = t->target || t->submission == t->args->words.word[1];
    if (t->args->plot && t->form == FORM_TEXT && v->kind == HN_VERDICT_GRADED) {
        write_bars(&b, v);
    } else {
        write_verdict(&b, v, t->form, seconds, first);
    }
    if (!t->target) {
        return t->form == FORM_TEXT ? hn_cli_print_text(&b) : hn_cli_print(&b);
    }

    // into files, with one line here
    hn_strbuf_printf(&path, "%s.%s", t->target, ending_of(t->form));
    hn_exit result = hn_cli_write_file(t->args, hn_strbuf_text(&path), &b);
    hn_strbuf_reset(&path);
    if (result == HN_EXIT_DONE && !t->args->no_pictures) {
        result = write_picture(t, v);
    }
    printf("%s: %s\n", t->submission, v->kind == HN_VERDICT_UNGRADABLE ? v->reason : v->summary);
    return result;
}

static hn_exit grade_one(const task *t) {
    const double start = hn_clock_wall();
    hn_verdict *v = calloc(1, sizeof *v);

    // the variant of this student, or of the seed given, or what the file says
    const uint64_t seed = t->args->student       ? hn_variant_seed(t->exercise, t->args->student)
                          : isnan(t->args->seed) ? 0
                                                 : (uint64_t)t->args->seed;
    hn_status status = v ? hn_grade_file(t->exercise, t->submission, seed, v) : HN_ERR_MEMORY;

    // a submission that cannot be graded is the fault of the input
    hn_exit result = HN_EXIT_PROGRAM;
    if (status == HN_OK) {
        snprintf(v->student, sizeof v->student, "%s", t->args->student ? t->args->student : "");
        v->show_expected = t->args->show_expected;
        result = write_result(t, v, hn_clock_wall() - start);
        result =
            result == HN_EXIT_DONE && v->kind == HN_VERDICT_UNGRADABLE ? HN_EXIT_INPUT : result;
    } else {
        hn_diag diag;
        hn_diag_set(&diag, status, NULL, NULL, "the grader failed on '%.200s': %s", t->submission,
                    hn_status_text(status));
        hn_report_diag(t->args, &diag);
    }
    free(v);
    return result;
}

/// One bad submission never stops the rest; the worst outcome is the exit status.
static hn_exit grade_all(task t, const hn_verdict_names *names) {
    hn_exit worst = HN_EXIT_DONE;
    for (int i = 1; i < t.args->words.n; i++) {
        t.submission = t.args->words.word[i];
        t.target = t.args->out ? names->path[i - 1] : NULL;
        const hn_exit one = grade_one(&t);
        worst = one > worst ? one : worst;
    }
    return worst;
}

hn_exit hn_command_grade(const hn_library *lib, const hn_args *args) {
    task t = {.lib = lib, .args = args};
    hn_exercise *exercise = NULL;
    hn_diags diags = {0};
    hn_diag diag = {0};
    if (choose_form(args, &t.form, &diag) != HN_OK) {
        return hn_report_diag(args, &diag);
    }
    hn_status status = hn_shelf_exercise_load(lib, args->words.word[0], &exercise, &diags);
    if (status != HN_OK) {
        return report_exercise(lib, args, status, &diags);
    }

    // every name is chosen, and every folder made, before the first verdict is written
    hn_verdict_names names = {0};
    if (args->out) {
        status = hn_verdict_names_choose(&names, args->out, args->words.word + 1, args->words.n - 1,
                                         ending_of(t.form), t.form == FORM_GRADESCOPE, &diags);
    }
    t.exercise = exercise;
    const hn_exit result =
        status == HN_OK ? grade_all(t, &names) : hn_report_diags(args, status, &diags);
    hn_verdict_names_reset(&names);
    hn_exercise_free(exercise);
    return result;
}
