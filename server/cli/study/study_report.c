// SPDX-License-Identifier: GPL-3.0-or-later
// holonom report SCENE...: the full report over several scenes, as text, JSON or one HTML file, and its plots as files.
#include "build.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/output_file.h"
#include "cli/shell/progress.h"
#include "cli/shell/scene_word.h"
#include "cli/shell/table.h"
#include "cli/study/study.h"
#include "session/report/report.h"

#include <errno.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>

extern char **environ;

#define PNG_ZOOM "2" // pixels a unit of the drawing: sharp in print and on dense screens

static void show_progress(void *user, const char *scene, double share) {
    char what[100];
    snprintf(what, sizeof what, "report, %.60s", scene);
    hn_progress_tell(user, what, share);
}

static int whole(double value) {
    return isnan(value) ? 0 : (int)fmin(value, 1000);
}

// text ---------------------------------------------------------------------------------------------------------------

static void put_answers(hn_strbuf *b, const hn_report *r) {
    static const char *const heads[HN_REPORT_BANDS] = {"1e-3", "1e-6", "1e-9"};
    hn_table t;
    hn_table_init(&t);
    hn_table_column(&t, "cheapest for an error of", 0);
    for (int i = 0; i < HN_REPORT_BANDS; i++) {
        hn_table_column(&t, heads[i], 0);
        hn_table_column(&t, "", 1);
    }
    for (int i = 0; i < hn_report_n_scenes(r); i++) {
        const hn_report_scene *s = hn_report_scene_at(r, i);
        hn_table_cell(&t, "%s", hn_report_scene_id(s));
        for (int k = 0; k < HN_REPORT_BANDS; k++) {
            const hn_report_answer a = s->study
                                           ? hn_report_find_answer(s, hn_report_accuracy[k])
                                           : (hn_report_answer){-1, (double)NAN, HN_COST_OPS, 0};
            hn_table_cell(&t, "%s",
                          a.method < 0 ? "-" : hn_study_wp(s->study)->methods[a.method].spelling);
            hn_table_quantity(&t, a.cost, a.by == HN_COST_TIME ? "s" : "op");
        }
    }
    hn_table_write(b, &t);
    hn_table_reset(&t);
}

/// A line a method, a column a scene; tables are as wide as they may be, the rest is in the files.
static void put_verdicts(hn_strbuf *b, const hn_report *r, const hn_study *any) {
    int left = 0;
    hn_table t;
    hn_table_init(&t);
    hn_table_column(&t, "smallest error of q", 0);
    const int n =
        hn_report_n_scenes(r) < HN_TABLE_COLUMNS - 1 ? hn_report_n_scenes(r) : HN_TABLE_COLUMNS - 1;
    for (int i = 0; i < n; i++) {
        hn_table_column(&t, hn_report_scene_id(hn_report_scene_at(r, i)), 0);
    }
    for (int m = 0; m < hn_study_wp(any)->n_methods; m++) {
        hn_table_cell(&t, "%s", hn_study_wp(any)->methods[m].spelling);
        for (int i = 0; i < n; i++) {
            const hn_report_scene *s = hn_report_scene_at(r, i);
            if (!s->study) {
                hn_table_cell(&t, "-");
                continue;
            }
            const hn_verdict v = hn_report_find_verdict(s, m);
            if (v.skipped > 0 && v.done > 0) {
                hn_table_cell(&t, "%s (%d left)", v.text, v.skipped);
                left = 1;
            } else {
                hn_table_cell(&t, "%s", v.text);
            }
        }
    }
    hn_strbuf_add(b, "\n");
    hn_table_write(b, &t);
    hn_table_reset(&t);
    if (left) {
        hn_strbuf_add(b, "(1 left): so many finer sizes were left out to keep the budget\n");
    }
}

static void put_survival(hn_strbuf *b, const hn_report_scene *s) {
    hn_strbuf_printf(b, "\n%s: step sizes that survive its singular poses\n",
                     hn_report_scene_id(s));
    for (int m = 0; m < hn_study_wp(s->study)->n_methods; m++) {
        hn_strbuf_printf(b, "  %-24s %2d of %d\n", hn_study_wp(s->study)->methods[m].spelling,
                         hn_strip_survived(&s->strips[m]), s->strips[m].n);
    }
}

static void put_tables(hn_strbuf *b, const hn_report *r) {
    const hn_study *any = hn_report_any_study(r);
    hn_report_sentences(b, r);
    hn_strbuf_add(b, any ? "\n" : "");
    put_answers(b, r);
    if (any) {
        put_verdicts(b, r, any);
    }
    for (int i = 0; i < hn_report_n_scenes(r); i++) {
        const hn_report_scene *s = hn_report_scene_at(r, i);
        if (!s->study) {
            hn_strbuf_printf(b, "\n%s: %s\n", hn_report_scene_id(s), s->reason);
        } else if (s->strips) {
            put_survival(b, s);
        }
    }
}

// plots --------------------------------------------------------------------------------------------------------------

/// 1: done; 0: it failed; -1: there is no such program.
static int convert(const char *svg, const char *png) {
    char *const words[] = {"rsvg-convert", "-z", PNG_ZOOM, "-o", (char *)png, (char *)svg, NULL};
    pid_t pid;
    int status = 0;
    const int error = posix_spawnp(&pid, words[0], NULL, NULL, words, environ);
    if (error != 0) {
        return error == ENOENT ? -1 : 0;
    }
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {}
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static hn_exit fail(const hn_args *args, const char *path, const char *why) {
    hn_diag diag = {0};
    hn_diag_set(&diag, HN_ERR_IO, "/plots", NULL, "cannot write '%.200s': %s", path, why);
    return hn_report_diag(args, &diag);
}

/// One plot as SVG, and as PNG while there is a program that makes one.
static hn_exit write_plot(const hn_args *args, const hn_report_plot *plot, int *converts,
                          int *written) {
    char svg[700], png[700];
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (!hn_report_plot_svg(&b, plot)) {
        hn_strbuf_reset(&b);
        return HN_EXIT_DONE;
    }
    if (snprintf(svg, sizeof svg, "%s/%s.svg", args->plots, plot->name) >= (int)sizeof svg ||
        snprintf(png, sizeof png, "%s/%s.png", args->plots, plot->name) >= (int)sizeof png) {
        hn_strbuf_reset(&b);
        return fail(args, args->plots, "the name of the folder is too long");
    }
    const hn_exit done = hn_cli_write_file(args, svg, &b);
    if (done != HN_EXIT_DONE) {
        return done;
    }
    ++*written;
    if (*converts) {
        const int converted = convert(svg, png);
        if (converted == 0) {
            return fail(args, png, "rsvg-convert failed");
        }
        *converts = converted > 0;
    }
    return HN_EXIT_DONE;
}

static hn_exit write_plots(const hn_args *args, const hn_report *r) {
    int converts = 1, written = 0;
    if (mkdir(args->plots, 0777) != 0 && errno != EEXIST) {
        return fail(args, args->plots, strerror(errno));
    }
    for (int i = 0; i < hn_report_n_plots(r); i++) {
        const hn_report_plot plot = hn_report_plot_at(r, i);
        const hn_exit done = write_plot(args, &plot, &converts, &written);
        if (done != HN_EXIT_DONE) {
            return done;
        }
    }
    if (!converts) {
        fprintf(stderr,
                "holonom: %d plots as SVG; PNG too where there is rsvg-convert (Debian: "
                "librsvg2-bin)\n",
                written);
    }
    return HN_EXIT_DONE;
}

// the command --------------------------------------------------------------------------------------------------------

HN_FORM(html, hn_report, hn_report_html)
HN_FORM(json, hn_report, hn_report_json)
HN_FORM(text, hn_report, put_tables)
static const hn_forms FORMS = {{{".html", put_html}, {".json", put_json}}, put_text};

/// Plots come first: they are files too.
static hn_exit write_report(const hn_args *args, const hn_report *r) {
    const hn_exit drawn = args->plots ? write_plots(args, r) : HN_EXIT_DONE;
    return drawn == HN_EXIT_DONE ? hn_forms_write(&FORMS, args, r) : drawn;
}

static hn_status load(const hn_library *lib, const hn_args *args, hn_model **models, int *n,
                      hn_diags *diags) {
    int n_words = args->words.n;
    const char *const *words = n_words > 0 ? args->words.word : hn_report_standard(&n_words);
    hn_status status = hn_forms_check(&FORMS, args, diags);
    for (*n = 0; *n < n_words && status == HN_OK; *n += status == HN_OK) {
        status = hn_args_load_model(lib, args, words[*n], 0, &models[*n], diags);
    }
    return status;
}

static hn_status make(const hn_args *args, hn_model *const *models, int n, hn_report **out,
                      hn_diags *diags) {
    char folder[400];
    hn_progress progress = {0};
    const hn_model *list[HN_REPORT_SCENES];
    hn_report_request q = hn_report_request_default();
    for (int i = 0; i < n; i++) {
        list[i] = models[i];
    }
    q.models = list;
    q.n_models = n;
    q.methods = args->methods.n > 0 ? args->methods.word : NULL;
    q.n_methods = args->methods.n;
    q.budget = args->budget;
    q.levels = whole(args->levels);
    q.samples = isnan(args->samples) ? 0 : args->samples == 0 ? -1 : whole(args->samples);
    q.build = HN_BUILD;
    q.folder = hn_study_folder(args, folder);
    q.stop = hn_is_interrupted;
    q.progress = show_progress;
    q.user = &progress;
    hn_interrupt_begin();
    const hn_status status = hn_report_make(&q, out, diags);
    hn_progress_end(&progress);
    hn_interrupt_end();
    if (status == HN_OK) {
        hn_study_tell_end(hn_report_stopped(*out), 0, args->budget, "", q.folder);
    }
    return status;
}

hn_exit hn_command_report(const hn_library *lib, const hn_args *args) {
    hn_model *models[HN_REPORT_SCENES] = {0};
    hn_report *report = NULL;
    hn_diags diags = {0};
    int n = 0;
    hn_status status = load(lib, args, models, &n, &diags);
    if (status == HN_OK) {
        status = make(args, models, n, &report, &diags);
    }
    hn_exit result =
        status == HN_OK ? write_report(args, report) : hn_report_diags(args, status, &diags);
    if (status == HN_OK && result == HN_EXIT_DONE && hn_report_stopped(report)) {
        result = HN_EXIT_ENDED;
    }
    hn_report_free(report);
    for (int i = 0; i < n; i++) {
        hn_model_free(models[i]);
    }
    return result;
}
