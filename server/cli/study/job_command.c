// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/job_command.h"

#include "build.h"
#include "cli/shell/cache_folder.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/forms.h"
#include "cli/shell/notes.h"
#include "cli/shell/output_file.h"
#include "cli/shell/progress.h"
#include "cli/shell/scene_word.h"
#include "cli/study/budget_text.h"
#include "cli/study/extreme_text.h"
#include "cli/study/interrupt.h"
#include "cli/study/reference_text.h"
#include "cli/study/report_plots.h"
#include "cli/study/report_text.h"
#include "cli/study/stability_text.h"
#include "cli/study/study_part.h"
#include "cli/study/work_precision_text.h"

#include "base/processors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- what each kind prints for people ----

HN_JOB_FORM(work_precision, hn_study, hn_study_text)
HN_JOB_FORM(stability, hn_map, hn_map_text)
HN_JOB_FORM(budget, hn_budgets, hn_budgets_text)
HN_JOB_FORM(work_precision_plot, hn_study, hn_study_plot_text)
HN_JOB_FORM(stability_plot, hn_map, hn_map_plots_text)
HN_JOB_FORM(budget_plot, hn_budgets, hn_budgets_bars_text)
HN_JOB_FORM(report, hn_report, hn_report_text)
HN_JOB_FORM(extreme, hn_extreme, hn_extreme_text)
HN_JOB_FORM(reference, hn_reference_work, hn_reference_text)

/// The terminal's part of a kind's row. It stands here because core prints nothing and knows no
/// terminal; the kinds themselves are listed in session/kinds/job.c alone, and one without an entry
/// here prints its JSON.
static const struct {
    const char *kind;
    void (*put)(hn_strbuf *b, const void *work);
    void (*plot)(hn_strbuf *b, const void *work); ///< NULL: none
} TEXTS[] = {
    {"work-precision", put_work_precision, put_work_precision_plot},
    {"stability", put_stability, put_stability_plot},
    {"budget", put_budget, put_budget_plot},
    {"report", put_report, NULL},
    {"extreme", put_extreme, NULL},
    {"reference", put_reference, NULL},
};

/// Returns NULL where a kind has no text of its own: its JSON is printed. With --plot: the plots
/// alone.
static hn_text_writer text_of(const hn_job_kind *kind, const hn_args *args) {
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        if (strcmp(TEXTS[i].kind, kind->name) == 0) {
            return args->plot && TEXTS[i].plot ? TEXTS[i].plot : TEXTS[i].put;
        }
    }
    return NULL;
}

// ---- one command ----

typedef struct command {
    const hn_library *lib;
    const hn_args *args;
    const hn_job_kind *kind;
    hn_model *models[HN_JOB_SCENES]; ///< owned
    cJSON *body;                     ///< owned: the values of the kind's fields
    char folder[400];
    hn_job_request request;
    hn_progress progress;
    double share; ///< done of the whole, as far as was told
} command;

static void show_progress(void *user, const char *part, double share) {
    command *c = user;
    char what[100];
    snprintf(what, sizeof what, "%s%s%.60s", c->kind->name, part[0] ? " " : "", part);
    c->share = share;
    hn_progress_tell(&c->progress, what, share);
}

/// Loads the scene of the command line with these parameters in addition to those of --set.
static hn_status load_with(void *user, const hn_setting *parameters, int n, hn_model **out,
                           hn_diags *diags) {
    const command *c = user;
    const char *const word = c->args->words.word[0];
    char text[2][120];

    // standard input cannot be read a second time
    if (strcmp(word, "-") == 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/over", "write it into a file first",
                            "a map over a parameter reads the scene for every value, and standard "
                            "input can be read only once");
    }

    // the options are large: the copy lives on the heap
    hn_args *args = malloc(sizeof *args);
    if (!args) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *args = *c->args;

    // add the parameters of this map cell to those of --set
    for (int i = 0; i < n; i++) {
        snprintf(text[i], sizeof text[i], "%s=%.17g", parameters[i].name, parameters[i].value);
        args->set_over_set.word[args->set_over_set.n++] = text[i];
    }

    const hn_status status = hn_args_load_model(c->lib, args, word, 0, out, diags);
    free(args);
    return status;
}

/// Reads "24x16" into the fields columns and rows.
static hn_status read_grid(const char *text, cJSON *body, hn_diags *diags) {
    char *end = NULL, *last = NULL;
    const long columns = strtol(text, &end, 10);
    const long rows = end != text && *end == 'x' ? strtol(end + 1, &last, 10) : 0;
    if (!last || last == end + 1 || *last || columns < 1 || rows < 1) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/grid", "as in 24x16",
                            "'%.40s' is not a grid of columns and rows", text);
    }
    cJSON_AddNumberToObject(body, "columns", (double)columns);
    cJSON_AddNumberToObject(body, "rows", (double)rows);
    return HN_OK;
}

/// Collects the values of all fields in one object and checks it as the server checks a body.
static hn_status read_body(command *c, hn_diags *diags) {
    const hn_args *args = c->args;
    c->body = args->fields ? cJSON_Duplicate(args->fields, 1) : cJSON_CreateObject();
    if (args->methods.n > 0) {
        cJSON_AddItemToObject(c->body, "methods",
                              cJSON_CreateStringArray(args->methods.word, args->methods.n));
    }
    if (!isnan(args->time)) {
        cJSON_AddNumberToObject(c->body, "time", args->time);
    }
    if (args->grid) {
        HN_TRY(read_grid(args->grid, c->body, diags));
    }
    HN_TRY(hn_job_check(c->kind, c->body, false, diags));
    return hn_job_request_read(&c->request, c->body, c->kind->fields, diags);
}

/// Loads the scenes that the words name; for the extreme matrix the words are names of cases.
static hn_status load_words(command *c, hn_diags *diags) {
    int n = c->kind->words == HN_JOB_WORDS_SCENE ? 1 : c->args->words.n;
    const char *const *words = c->args->words.word;
    if (c->kind->words == HN_JOB_WORDS_IDS) {
        c->request.ids = words;
        c->request.n_ids = n;
        return HN_OK;
    }
    if (n == 0) {
        words = hn_report_standard(&n);
    }
    for (int i = 0; i < n; i++) {
        HN_TRY(hn_args_load_model(c->lib, c->args, words[i], 0, &c->models[i], diags));
        c->request.models[i] = c->models[i];
        c->request.n_models = i + 1;
    }
    return HN_OK;
}

static hn_status check_output(const command *c, hn_diags *diags) {
    if (c->kind->save) {
        return HN_OK; // any name will do
    }
    HN_TRY(hn_forms_check(c->kind->forms, c->args, diags));
    return hn_job_text(&c->request, "shard") ? hn_part_check(c->args, diags) : HN_OK;
}

/// Checks everything that can be refused before the computation.
static hn_status prepare(command *c, hn_diags *diags) {
    c->request = hn_job_request_default(NULL);
    HN_TRY(read_body(c, diags));
    HN_TRY(check_output(c, diags));
    HN_TRY(load_words(c, diags));
    c->request.lib = c->lib;
    c->request.load = load_with;
    c->request.load_user = c;
    c->request.build = hn_build_name();
    c->request.limits.folder = hn_cache_folder(c->args, c->folder);
    c->request.limits.stop = hn_is_interrupted;
    c->request.limits.threads = hn_processors();
    c->request.limits.progress = show_progress;
    c->request.limits.user = c;
    return HN_OK;
}

static void report_resumed(const command *c, const hn_job *job) {
    if (hn_job_resumed(job) > 0 && !c->args->json) {
        hn_cli_note("holonom: continuing with %d %s of an earlier run\n", hn_job_resumed(job),
                    c->kind->pieces);
    }
}

static void report_end(const command *c, const hn_job_end *end) {
    const char *kept = !c->request.limits.folder ? ""
                       : end->lost ? "; not all that is finished could be kept: the same command "
                                     "computes the rest of it again"
                                   : "; the same command continues from here";
    if (end->stopped) {
        hn_cli_note("holonom: stopped on request%s%s\n", kept,
                    c->share > 0 ? "" : " (nothing was finished yet)");
    } else if (end->out_of_time) {
        const double limit = c->request.limits.time_limit;
        char which[64] = " (--time-limit)";
        if (isfinite(limit)) {
            snprintf(which, sizeof which, " of %.4g s", limit);
        }
        hn_cli_note("holonom: the time limit%s left %s out%s\n", which, c->kind->pieces, kept);
    }
}

/// Writes what a kind has besides its forms (a part of a study, the plots of a report, a file of
/// its own), then the forms.
static hn_exit write_job(const command *c, const hn_job *job) {
    const hn_args *args = c->args;
    const void *work = hn_job_work(job);

    // a part of a study is written for a later merge
    if (hn_job_text(&c->request, "shard")) {
        return hn_write_part(args, work);
    }

    // plots go to files beside the other output
    if (args->plots) {
        const hn_exit drawn = hn_write_plots(args, work);
        if (drawn != HN_EXIT_DONE) {
            return drawn;
        }
    }

    // a kind with a file of its own, whatever the name ends in
    if (args->out && c->kind->save) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        c->kind->save(&b, work);
        const hn_exit saved = hn_cli_write_file(args, args->out, &b);
        if (saved != HN_EXIT_DONE) {
            return saved;
        }
        return hn_forms_print(c->kind->forms, text_of(c->kind, args), args, work);
    }
    return hn_forms_write(c->kind->forms, text_of(c->kind, args), args, work);
}

static hn_exit run_prepared(command *c) {
    hn_diags diags = {0};
    hn_job *job = NULL;
    hn_job_end end = {0};

    // from here on Ctrl-C asks the job to stop
    hn_interrupt_begin();
    hn_status status = hn_job_open(c->kind, &c->request, &job, &diags);
    if (status == HN_OK) {
        report_resumed(c, job);
        status = hn_job_run(job, &end, &diags);
    }
    hn_progress_end(&c->progress);
    hn_interrupt_end();

    // without a document there is only the reason
    if (status != HN_OK) {
        const hn_exit said = hn_report_diags(c->args, status, &diags);
        if (hn_is_interrupted(NULL) && !c->args->json) {
            hn_cli_note("holonom: nothing was finished yet, so nothing is kept\n");
        }
        hn_job_free(job);
        return status == HN_ERR_NO_CONVERGENCE || hn_is_interrupted(NULL) ? HN_EXIT_ENDED : said;
    }
    report_end(c, &end);
    const hn_exit written = write_job(c, job);
    hn_job_free(job);
    return written == HN_EXIT_DONE && (end.stopped || end.differs) ? HN_EXIT_ENDED : written;
}

/// Runs a job of this kind as the arguments say, with its words as scenes or cases, and writes its
/// documents. Returns the exit status.
static hn_exit run_job(const hn_library *lib, const hn_args *args, const hn_job_kind *kind) {
    command c = {.lib = lib, .args = args, .kind = kind};
    hn_diags diags = {0};
    const hn_status status = prepare(&c, &diags);
    const hn_exit result =
        status == HN_OK ? run_prepared(&c) : hn_report_diags(args, status, &diags);
    for (int i = 0; i < HN_JOB_SCENES; i++) {
        hn_model_free(c.models[i]);
    }
    cJSON_Delete(c.body);
    return result;
}

// ---- the commands ----

/// "did you mean 'stability'?", or all kinds of `holonom study`.
static void hint_kinds(const char *word, char *out, size_t size) {
    enum { MOST_KINDS = 16 };
    const char *names[MOST_KINDS];
    const hn_job_kind *kind;
    size_t used = 0;
    int n = 0;
    for (int i = 0; (kind = hn_job_kind_at(i)) != NULL && n < MOST_KINDS && used < size; i++) {
        if (kind->words == HN_JOB_WORDS_SCENE) {
            used += (size_t)snprintf(out + used, size - used, "%s%s", used ? ", " : "there is ",
                                     kind->name);
            names[n++] = kind->name;
        }
    }
    const char *near = hn_nearest_name(word, names, n);
    if (near) {
        snprintf(out, size, "did you mean '%s'?", near);
    }
}

hn_exit hn_command_study(const hn_library *lib, const hn_args *args) {
    const char *word = args->words.n > 1 ? args->words.word[1] : hn_job_kind_at(0)->name;
    const hn_job_kind *kind = hn_job_kind_find(word);
    if (kind && kind->words == HN_JOB_WORDS_SCENE) {
        return run_job(lib, args, kind);
    }
    hn_diag diag = {0};
    char list[HN_DIAG_HINT];
    hint_kinds(word, list, sizeof list);
    hn_diag_set(&diag, HN_ERR_INPUT, "/study", list, "there is no study called '%.60s'", word);
    return hn_report_diag(args, &diag);
}

hn_exit hn_command_report(const hn_library *lib, const hn_args *args) {
    return run_job(lib, args, hn_job_kind_find("report"));
}

hn_exit hn_command_extreme(const hn_library *lib, const hn_args *args) {
    return run_job(lib, args, hn_job_kind_find("extreme"));
}

hn_exit hn_command_reference(const hn_library *lib, const hn_args *args) {
    return run_job(lib, args, hn_job_kind_find("reference"));
}
