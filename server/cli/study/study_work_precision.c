// SPDX-License-Identifier: GPL-3.0-or-later
// holonom study SCENE work-precision: what accuracy costs, method by method.
#include "build.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "cli/shell/progress.h"
#include "cli/study/study.h"
#include "cli/study/study_text.h"
#include "session/precision/study.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void show_progress(void *user, double share) {
    hn_progress_tell(user, "work-precision", share);
}

HN_FORM(html, hn_study, hn_study_html)
HN_FORM(json, hn_study, hn_study_json)
HN_FORM(csv, hn_study, hn_study_csv)
HN_FORM(text, hn_study, hn_study_text)
const hn_forms hn_study_forms = {{{".html", put_html}, {".json", put_json}, {".csv", put_csv}},
                                 put_text};

/// "2/4" to 2 and 4. Bounds are the study's own.
static int read_shard(const char *text, int *shard, int *n) {
    char end;
    const size_t digits = strspn(text, "0123456789");
    return digits > 0 && digits <= 4 && text[digits] == '/' && strlen(text + digits) <= 5 &&
           strspn(text + digits + 1, "0123456789") == strlen(text + digits + 1) &&
           sscanf(text, "%d/%d%c", shard, n, &end) == 2 && *shard > 0 && *n > 0;
}

static hn_status check_args(const hn_args *args, hn_diags *diags) {
    int shard, n;
    const hn_status status = hn_forms_check(&hn_study_forms, args, diags);
    if (status != HN_OK || !args->shard) {
        return status;
    }
    if (!read_shard(args->shard, &shard, &n)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/shard", "as 2/4: the second of four",
                            "'%.40s' is no part of a study", args->shard);
    }
    if (args->csv || (args->out && !hn_path_ends_in(args->out, ".json"))) {
        return hn_diags_add(
            diags, HN_ERR_INPUT, "/out", "take --out FILE.json, then holonom merge FILE.json...",
            "a part of a study is JSON; the whole of it becomes a table or a report");
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
    if (args->shard) {
        read_shard(args->shard, &r.shard, &r.n_shards);
    }
    r.build = HN_BUILD;
    r.folder = folder;
    r.hooks = (hn_wp_hooks){.user = progress, .stop = hn_is_interrupted, .progress = show_progress};
    return r;
}

/// The points of a part, counted, for people.
static void tell_part(hn_strbuf *b, const hn_args *args, const hn_study *study) {
    const hn_wp *wp = hn_study_wp(study);
    int n[HN_WP_STATES] = {0}, mine = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            if (hn_wp_is_mine(wp, m, k)) {
                n[wp->methods[m].point[k].state]++;
                mine++;
            }
        }
    }
    hn_strbuf_printf(b, "Part %d of %d: %d points of %d", wp->opts.shard, wp->opts.n_shards, mine,
                     wp->n_methods * wp->n_levels);
    for (int state = 0; state < HN_WP_STATES; state++) {
        if (n[state] > 0) {
            hn_strbuf_printf(b, ", %d %s", n[state], hn_wp_state_name((hn_wp_state)state));
        }
    }
    hn_strbuf_printf(b, "; in %s\n", args->out);
}

/// A part of a study: to its file, or to standard output.
static hn_exit write_part(const hn_args *args, const hn_study *study) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_study_part(&b, study);
    hn_exit written = hn_cli_write_file(args, args->out, &b);
    if (args->out && written == HN_EXIT_DONE) {
        if (args->json) {
            hn_study_part(&b, study);
        } else {
            tell_part(&b, args, study);
        }
        written = hn_cli_print(&b);
    }
    return written;
}

static hn_exit study_model(const hn_library *lib, const hn_args *args, const hn_model *model) {
    (void)lib;
    char folder[400];
    hn_diags diags = {0};
    hn_study *study = NULL;
    hn_progress progress = {0};
    const hn_study_request request = request_of(args, hn_study_folder(args, folder), &progress);
    hn_interrupt_begin();
    const hn_status status = hn_study_open(model, &request, &study, &diags);
    if (status == HN_OK) {
        hn_study_tell_resumed(args, hn_study_resumed(study), "points");
        hn_study_run(study);
    }
    hn_progress_end(&progress);
    hn_interrupt_end();
    if (status != HN_OK) {
        const hn_exit told = hn_report_diags(args, status, &diags);
        return hn_is_interrupted(NULL) ? HN_EXIT_ENDED : told;
    }
    const hn_wp *wp = hn_study_wp(study);
    hn_study_tell_end(wp->stopped, wp->out_of_time, wp->opts.budget, "points or samples",
                      request.folder);
    hn_exit result =
        args->shard ? write_part(args, study) : hn_forms_write(&hn_study_forms, args, study);
    if (result == HN_EXIT_DONE && wp->stopped) {
        result = HN_EXIT_ENDED;
    }
    hn_study_free(study);
    return result;
}

const hn_study_kind hn_study_kind_work_precision = {
    .name = "work-precision",
    .about =
        "error against cost; --out FILE.html, .json or .csv; steps and tolerances are laddered",
    .options = "--set --methods --time --budget --levels --samples --csv --out -o --shard",
    .check = check_args,
    .run = study_model,
};
