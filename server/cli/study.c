// holonom study SCENE work-precision: what accuracy costs, method by method.
#include "cli/cli.h"
#include "cli/study_text.h"
#include "session/study.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static volatile sig_atomic_t interrupted;

static void on_interrupt(int signal) {
    (void)signal;
    interrupted = 1;
}

static int is_interrupted(void *user) {
    (void)user;
    return interrupted != 0;
}

static void show_progress(void *user, double share) {
    hn_progress_tell(user, "work-precision", share);
}

/// HOLONOM_CACHE, or holonom in the user's folder for what can be computed again. 0 when there is none.
static int find_folder(char out[400]) {
    const char *own = getenv("HOLONOM_CACHE"), *xdg = getenv("XDG_CACHE_HOME"),
               *home = getenv("HOME");
    char base[360] = "";
    if (own && own[0]) {
        return snprintf(out, 400, "%s", own) < 400 && (mkdir(out, 0777) == 0 || errno == EEXIST);
    }
    if (xdg && xdg[0] == '/') {
        snprintf(base, sizeof base, "%s", xdg);
    } else if (home && home[0]) {
        snprintf(base, sizeof base, "%s/.cache", home);
    }
    if (!base[0] || (mkdir(base, 0700) != 0 && errno != EEXIST)) {
        return 0;
    }
    snprintf(out, 400, "%s/holonom", base);
    return mkdir(out, 0700) == 0 || errno == EEXIST;
}

static int ends_in(const char *path, const char *suffix) {
    const size_t n = strlen(path), m = strlen(suffix);
    return n > m && strcmp(path + n - m, suffix) == 0;
}

/// What a file of this name holds; NULL: nothing this command writes.
static void (*writer_of(const char *path))(hn_strbuf *, const hn_study *) {
    return ends_in(path, ".html")   ? hn_study_html
           : ends_in(path, ".json") ? hn_study_json
           : ends_in(path, ".csv")  ? hn_study_csv
                                    : NULL;
}

static hn_status check_args(const hn_args *args, hn_diags *diags) {
    if (args->words.n > 1 && strcmp(args->words.word[1], "work-precision") != 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/study", "work-precision is the one there is",
                            "there is no study called '%.60s'", args->words.word[1]);
    }
    if (args->out && !writer_of(args->out)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/out", "end it in .html, .json or .csv",
                            "what to write into '%.200s' cannot be told from its name", args->out);
    }
    if (args->json && args->csv) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/csv", "take --out FILE.csv beside --json",
                            "standard output cannot be JSON and CSV at once");
    }
    return HN_OK;
}

static int whole(double value) {
    return isnan(value) ? 0 : (int)fmin(value, 1000);
}

static hn_study_request request_of(const hn_args *args, const char *folder, hn_progress *progress) {
    hn_study_request r = hn_study_request_default();
    r.methods = args->methods.n > 0 ? args->methods.word : NULL;
    r.n_methods = args->methods.n;
    r.time = args->time;
    r.budget = args->budget;
    r.levels = whole(args->levels);
    r.samples = isnan(args->samples) ? 0 : args->samples == 0 ? -1 : whole(args->samples);
    r.folder = folder;
    r.hooks = (hn_wp_hooks){.user = progress, .stop = is_interrupted, .progress = show_progress};
    return r;
}

/// What a person should know of how it ended.
static void tell_end(const hn_study *study, const char *folder) {
    const hn_wp *wp = hn_study_wp(study);
    const char *kept = folder ? "; the same command goes on from here" : "";
    if (wp->stopped) {
        fprintf(stderr, "holonom: stopped on request after %.3g s%s\n", wp->elapsed, kept);
    } else if (wp->out_of_time) {
        fprintf(stderr, "holonom: the budget of %g s left points or samples out%s\n",
                wp->opts.budget, kept);
    }
}

/// Into the file first, so that a broken pipe does not cost it.
static hn_exit write_results(const hn_args *args, const hn_study *study) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (args->out) {
        writer_of(args->out)(&b, study);
        const hn_exit written = hn_cli_write_file(args, args->out, &b);
        if (written != HN_EXIT_DONE) {
            return written;
        }
    }
    if (args->json) {
        hn_study_json(&b, study);
    } else if (args->csv) {
        hn_study_csv(&b, study);
    } else {
        hn_study_text(&b, study);
    }
    return hn_cli_print(&b);
}

static hn_exit study_model(const hn_args *args, const hn_model *model) {
    char folder[400];
    hn_diags diags = {0};
    hn_study *study = NULL;
    hn_progress progress = {0};
    struct sigaction action = {.sa_handler = on_interrupt}, before;
    const int keeps = find_folder(folder);
    if (!keeps && !args->json) {
        fprintf(stderr, "holonom: no folder to keep unfinished work in; HOLONOM_CACHE names one\n");
    }
    sigaction(SIGINT, &action, &before);
    const hn_study_request request = request_of(args, keeps ? folder : NULL, &progress);
    const hn_status status = hn_study_open(model, &request, &study, &diags);
    if (status == HN_OK) {
        if (hn_study_resumed(study) > 0 && !args->json) {
            fprintf(stderr, "holonom: going on with %d points from before\n",
                    hn_study_resumed(study));
        }
        hn_study_run(study);
    }
    hn_progress_end(&progress);
    sigaction(SIGINT, &before, NULL);
    if (status != HN_OK) {
        const hn_exit told = hn_report_diags(args, status, &diags);
        return interrupted ? HN_EXIT_ENDED : told;
    }
    tell_end(study, keeps ? folder : NULL);
    hn_exit result = write_results(args, study);
    if (result == HN_EXIT_DONE && hn_study_wp(study)->stopped) {
        result = HN_EXIT_ENDED;
    }
    hn_study_free(study);
    return result;
}

hn_exit hn_command_study(const hn_library *lib, const hn_args *args) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_status status = check_args(args, &diags);
    if (status == HN_OK) {
        status = hn_args_load_model(lib, args, args->words.word[0], 0, &model, &diags);
    }
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    const hn_exit result = study_model(args, model);
    hn_model_free(model);
    return result;
}
