// SPDX-License-Identifier: GPL-3.0-or-later
// holonom reference SCENE: the reference solution, the two means it comes from, and the digits they share over time.
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/print.h"
#include "cli/shell/progress.h"
#include "cli/shell/scene_word.h"
#include "cli/shell/table.h"
#include "cli/study/study.h"
#include "session/references/references.h"

#include <math.h>
#include <stdio.h>

enum { MOST_COORDINATES = 6, ROWS = 9 };
static const double LEAST_DIGITS = 6; // --hold: to which time a motion is worth keeping

static void put_values(hn_strbuf *b, const hn_model *model, const hn_ref *ref) {
    const hn_system *sys = hn_model_system(model);
    const hn_scene *scene = hn_model_scene(model);
    const int shown = ref->n_user < MOST_COORDINATES ? ref->n_user : MOST_COORDINATES;
    hn_table t;
    hn_table_init(&t);
    hn_table_column(&t, "t [s]", 1);
    hn_table_column(&t, "digits", 1);
    for (int i = 0; i < shown; i++) {
        hn_table_column(&t, scene->coordinates[hn_system_user_coordinate(sys, i)].name, 1);
    }
    for (int r = 0; r < ROWS; r++) {
        const int k = r * ref->n / (ROWS - 1);
        const hn_state_seen at = hn_ref_at(ref, k);
        const double e = ref->between[(size_t)k * HN_ERROR_COUNT + HN_ERROR_Q];
        hn_table_cell(&t, "%.6g", at.t);
        hn_table_cell(&t, "%.1f", fmin(16, -log10(e)));
        for (int i = 0; i < shown; i++) {
            hn_table_cell(&t, "%.15g", at.q[i]);
        }
    }
    hn_table_write(b, &t);
    hn_table_reset(&t);
    if (shown < ref->n_user) {
        hn_strbuf_printf(b, "%d coordinates more, all rates, multipliers and the energy: --json\n",
                         ref->n_user - shown);
    }
}

static void put_text(hn_strbuf *b, const hn_model *model, const hn_ref *ref, hn_ref_source source) {
    const hn_scene *scene = hn_model_scene(model);
    hn_strbuf_printf(b, "%s, to t = %g s (%s)\n", scene->title ? scene->title : scene->id, ref->T,
                     hn_ref_source_name(source));
    if (ref->T < scene->duration && source == HN_REF_SHIPPED) {
        hn_strbuf_printf(b,
                         "The scene's own time is %g s; what is shipped ends where fewer than %g "
                         "digits are sure: the motion is chaotic.\n",
                         scene->duration, LEAST_DIGITS);
    }
    hn_strbuf_printf(b,
                     "1: %s\n2: %s\nThey share nothing but the equations, and agree to %.1f digits "
                     "of the coordinates, %.1e of the rates, %.1e of the reactions, %.1e of the "
                     "energy.\n",
                     ref->means[0], ref->means[1], hn_ref_digits(ref), ref->error[HN_ERROR_V],
                     ref->error[HN_ERROR_REACTION], ref->error[HN_ERROR_ENERGY]);
    if (ref->refused[0]) {
        hn_strbuf_printf(b, "Did not come to the end: %s\n", ref->refused);
    }
    hn_strbuf_add(b, "\n");
    put_values(b, model, ref);
}

/// With --hold: again, to the time where digits hold.
static hn_status shorten(const hn_model *model, hn_ref_request *request, hn_ref **ref,
                         hn_diags *diags) {
    const double hold = hn_reference_horizon(*ref, LEAST_DIGITS);
    if (hold == (*ref)->T) {
        return HN_OK;
    }
    if (hold <= 0) {
        return hn_diags_add(diags, HN_ERR_NO_CONVERGENCE, NULL, "take a shorter --time",
                            "the two computations share fewer than %g digits from the start on",
                            LEAST_DIGITS);
    }
    hn_ref_free(*ref);
    *ref = NULL;
    request->time = hold;
    return hn_reference_get(model, request, ref, NULL, diags);
}

static void show_progress(void *user, double share) {
    hn_progress_tell(user, "reference", share);
}

static hn_status check_time(const hn_args *args, hn_diags *diags) {
    if (!isnan(args->time) && !(args->time > 0 && args->time <= 1e7)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/time", NULL,
                            "the end time is %g s; it must be above 0 and at most 1e7 s",
                            args->time);
    }
    return HN_OK;
}

static hn_exit print(const hn_args *args, const hn_model *model, const hn_ref *ref,
                     hn_ref_source source) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (args->json) {
        hn_reference_json(&b, model, ref, source);
    } else {
        put_text(&b, model, ref, source);
    }
    return hn_cli_print(&b);
}

static hn_exit tell_failure(const hn_args *args, hn_status status, const hn_diags *diags) {
    const hn_exit told = hn_report_diags(args, status, diags);
    return status == HN_ERR_NO_CONVERGENCE || hn_is_interrupted(NULL) ? HN_EXIT_ENDED : told;
}

hn_exit hn_command_reference(const hn_library *lib, const hn_args *args) {
    char folder[400];
    hn_model *model = NULL;
    hn_ref *ref = NULL;
    hn_diags diags = {0};
    hn_diag diag = {0};
    hn_progress progress = {0};
    hn_ref_source source = HN_REF_COMPUTED;
    hn_ref_request request = hn_ref_request_default();
    hn_status status = check_time(args, &diags);
    if (status == HN_OK) {
        status = hn_args_load_model(lib, args, args->words.word[0], 0, &model, &diags);
    }
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    request.time = args->time;
    request.folder = hn_find_cache(folder) ? folder : NULL;
    request.again = args->again;
    request.opts.limits =
        (hn_walk_limits){isnan(args->budget) ? 0 : args->budget, hn_is_interrupted, NULL};
    request.opts.progress = show_progress;
    request.opts.user = &progress;
    hn_interrupt_begin();
    status = hn_reference_get(model, &request, &ref, &source, &diags);
    if (status == HN_OK && args->hold) {
        status = shorten(model, &request, &ref, &diags);
    }
    hn_progress_end(&progress);
    hn_interrupt_end();
    hn_exit result = HN_EXIT_DONE;
    if (status != HN_OK) {
        result = tell_failure(args, status, &diags);
    } else if (args->out && hn_reference_save(args->out, model, ref, &diag) != HN_OK) {
        hn_report_diag(args, &diag);
        result = HN_EXIT_PROGRAM; // the output is at fault, not the scene
    } else {
        result = print(args, model, ref, source);
    }
    hn_ref_free(ref);
    hn_model_free(model);
    return result;
}
