// SPDX-License-Identifier: GPL-3.0-or-later
// holonom study SCENE KIND: the kinds of study, and what they share.
#include "cli/study/study.h"

#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/scene_word.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const hn_study_kind *const KINDS[] = {
    &hn_study_kind_work_precision,
    &hn_study_kind_budget,
    &hn_study_kind_stability,
};
enum { N_KINDS = sizeof KINDS / sizeof *KINDS };

static volatile sig_atomic_t interrupted;
static struct sigaction before;

static void on_interrupt(int signal) {
    (void)signal;
    interrupted = 1;
}

void hn_interrupt_begin(void) {
    struct sigaction action = {.sa_handler = on_interrupt};
    interrupted = 0;
    sigaction(SIGINT, &action, &before);
}

void hn_interrupt_end(void) {
    sigaction(SIGINT, &before, NULL);
}

int hn_is_interrupted(void *unused) {
    (void)unused;
    return interrupted != 0;
}

int hn_find_cache(char out[400]) {
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

const char *hn_study_folder(const hn_args *args, char out[400]) {
    const int found = hn_find_cache(out);
    if (!found && !args->json) {
        fprintf(stderr, "holonom: no folder to keep unfinished work in; HOLONOM_CACHE names one\n");
    }
    return found ? out : NULL;
}

void hn_study_tell_resumed(const hn_args *args, int n, const char *pieces) {
    if (n > 0 && !args->json) {
        fprintf(stderr, "holonom: going on with %d %s from before\n", n, pieces);
    }
}

void hn_study_tell_end(int stopped, int out_of_time, double budget, const char *pieces,
                       const char *folder) {
    const char *kept = folder ? "; the same command goes on from here" : "";
    if (stopped) {
        fprintf(stderr, "holonom: stopped on request%s\n", kept);
    } else if (out_of_time) {
        fprintf(stderr, "holonom: the budget of %g s left %s out%s\n", budget, pieces, kept);
    }
}

static hn_status find_kind(const hn_args *args, const hn_study_kind **out, hn_diags *diags) {
    const char *word = args->words.n > 1 ? args->words.word[1] : KINDS[0]->name;
    char list[160] = "";
    size_t used = 0;
    for (int i = 0; i < N_KINDS; i++) {
        if (strcmp(KINDS[i]->name, word) == 0) {
            *out = KINDS[i];
            return HN_OK;
        }
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "there is ",
                                 KINDS[i]->name);
        used = used < sizeof list ? used : sizeof list - 1;
    }
    return hn_diags_add(diags, HN_ERR_INPUT, "/study", list, "there is no study called '%.60s'",
                        word);
}

static hn_status prepare(const hn_library *lib, const hn_args *args, const hn_study_kind **kind,
                         hn_model **model, hn_diags *diags) {
    hn_status status = find_kind(args, kind, diags);
    if (status == HN_OK) {
        status = hn_args_allow_only(args, (*kind)->options, (*kind)->name, diags);
    }
    if (status == HN_OK && (*kind)->check) {
        status = (*kind)->check(args, diags);
    }
    return status == HN_OK ? hn_args_load_model(lib, args, args->words.word[0], 0, model, diags)
                           : status;
}

hn_exit hn_command_study(const hn_library *lib, const hn_args *args) {
    const hn_study_kind *kind = NULL;
    hn_model *model = NULL;
    hn_diags diags = {0};
    const hn_status status = prepare(lib, args, &kind, &model, &diags);
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    const hn_exit result = kind->run(lib, args, model);
    hn_model_free(model);
    return result;
}
