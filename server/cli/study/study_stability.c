// SPDX-License-Identifier: GPL-3.0-or-later
// holonom study SCENE stability: where steps are stable, predicted and tried.
#include "cli/study/study_stability.h"

#include "cli/shell/diagnostics.h"
#include "cli/shell/progress.h"
#include "cli/shell/scene_word.h"
#include "cli/study/study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void write_png(hn_strbuf *b, const hn_map *map) {
    hn_diag diag = {0};
    b->failed |= hn_map_png(b, map, &diag) != HN_OK;
}

HN_FORM(html, hn_map, hn_map_html)
HN_FORM(json, hn_map, hn_map_json)
HN_FORM(csv, hn_map, hn_map_csv)
HN_FORM(svg, hn_map, hn_map_svg)
HN_FORM(png, hn_map, write_png)
HN_FORM(text, hn_map, hn_map_text)
static const hn_forms FORMS = {{{".html", put_html},
                                {".json", put_json},
                                {".csv", put_csv},
                                {".svg", put_svg},
                                {".png", put_png}},
                               put_text};

/// "24x16"; 0 when it is not that.
static int read_grid(const char *text, int *columns, int *rows) {
    char *end;
    const long n = strtol(text, &end, 10);
    if (end == text || *end != 'x' || n < 1 || n > 1000) {
        return 0;
    }
    const char *second = end + 1;
    const long m = strtol(second, &end, 10);
    *columns = (int)n;
    *rows = (int)m;
    return end != second && !*end && m >= 1 && m <= 1000;
}

static hn_status check_args(const hn_args *args, hn_diags *diags) {
    int columns, rows;
    const hn_status status = hn_forms_check(&FORMS, args, diags);
    if (status != HN_OK) {
        return status;
    }
    if (args->grid && !read_grid(args->grid, &columns, &rows)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/grid", "as in 24x16",
                            "'%.40s' is not a grid of columns and rows", args->grid);
    }
    return HN_OK;
}

/// Where scenes with other parameters come from.
typedef struct source {
    const hn_library *lib;
    const hn_args *args;
} source;

static hn_status load(void *user, const hn_setting *settings, int n, hn_model **out,
                      hn_diags *diags) {
    const source *s = user;
    const char *const word = s->args->words.word[0];
    char text[2][120];
    if (strcmp(word, "-") == 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/over", "write it into a file first",
                            "a scene from standard input can be read once only, and a map over a "
                            "parameter reads it for every value");
    }
    hn_args *args = malloc(sizeof *args);
    if (!args) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *args = *s->args;
    for (int i = 0; i < n && args->set.n < HN_CLI_MAX_WORDS; i++) {
        snprintf(text[i], sizeof text[i], "%s=%.17g", settings[i].name, settings[i].value);
        args->set.word[args->set.n++] = text[i];
    }
    const hn_status status = hn_args_load_model(s->lib, args, word, 0, out, diags);
    free(args);
    return status;
}

static void show_progress(void *user, double share) {
    hn_progress_tell(user, "stability", share);
}

static hn_map_request request_of(const hn_args *args, source *from, const char *folder,
                                 hn_progress *progress) {
    hn_map_request r = hn_map_request_default();
    r.preset = args->preset;
    r.over = args->over;
    if (!args->preset && !args->over) {
        r.preset = "limits";
    }
    if (args->grid) {
        read_grid(args->grid, &r.columns, &r.rows);
    }
    r.methods = args->methods.n > 0 ? args->methods.word : NULL;
    r.n_methods = args->methods.n;
    r.time = args->time;
    r.budget = args->budget;
    r.folder = folder;
    r.load = load;
    r.load_user = from;
    r.stop = hn_is_interrupted;
    r.progress = show_progress;
    r.user = progress;
    return r;
}

static hn_exit study_model(const hn_library *lib, const hn_args *args, const hn_model *model) {
    char folder[400];
    source from = {lib, args};
    hn_diags diags = {0};
    hn_map *map = NULL;
    hn_progress progress = {0};
    const hn_map_request request =
        request_of(args, &from, hn_study_folder(args, folder), &progress);
    hn_interrupt_begin();
    const hn_status status = hn_map_open(model, &request, &map, &diags);
    if (status == HN_OK) {
        hn_study_tell_resumed(args, hn_map_resumed(map), "cells");
        hn_map_run(map);
    }
    hn_progress_end(&progress);
    hn_interrupt_end();
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    hn_study_tell_end(hn_map_stopped(map), hn_map_out_of_time(map), args->budget, "cells",
                      request.folder);
    hn_exit result = hn_forms_write(&FORMS, args, map);
    if (result == HN_EXIT_DONE && hn_map_stopped(map)) {
        result = HN_EXIT_ENDED;
    }
    hn_map_free(map);
    return result;
}

const hn_study_kind hn_study_kind_stability = {
    .name = "stability",
    .about = "where steps are stable: maps over the step, parameters and settings, with the limit "
             "predicted from the spectrum",
    .options = "--set --methods --time --budget --over --preset --grid --csv --out -o",
    .check = check_args,
    .run = study_model,
};
