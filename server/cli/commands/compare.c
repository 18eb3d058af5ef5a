// SPDX-License-Identifier: GPL-3.0-or-later
// holonom compare: several methods at the same times, and a table of which are right.
#include "base/units.h"
#include "cli/commands/error_advice.h"
#include "cli/commands/incident_list.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/document.h"
#include "cli/shell/notes.h"
#include "cli/shell/print.h"
#include "cli/shell/progress.h"
#include "cli/shell/scene_word.h"
#include "session/compare/comparison_doc.h"
#include "session/compare/estimate.h"
#include "study/truth/accuracy.h"
#include "terminal/motion_plot.h"
#include "terminal/width.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_INCIDENTS = 3 };
static const double LONGEST_FRAME = 0.1; // [s]

static hn_status create(const hn_args *args, const hn_model *model, hn_comparison **out,
                        hn_diags *diags) {
    const hn_scene *scene = hn_model_scene(model);
    hn_comparison_opts opts = hn_comparison_opts_default();
    int n = args->methods.n;
    const char *const *methods = n > 0 ? args->methods.word : hn_model_methods(model, &n);
    if (!isnan(args->time) && !(args->time > 0)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/time", NULL,
                            "the end time is %g s; it must be above 0", args->time);
    }
    opts.duration = isnan(args->time) ? scene->duration : args->time;
    // whole frames up to the end, so that the clock stops exactly there
    opts.frame_dt = isnan(args->frame_dt) ? opts.duration / ceil(opts.duration / LONGEST_FRAME)
                                          : args->frame_dt;
    return hn_comparison_create(model, methods, n, &opts, out, diags);
}

/// Keeps gap and energy change of every method at the present frame; a method that has ended leaves
/// a hole.
static void keep_frame(hn_motion_plot *plot, hn_comparison *c) {
    if (!hn_motion_plot_next(plot)) {
        return;
    }
    for (int i = 0; i < plot->n_tracks; i++) {
        hn_sample sample = {0};
        if (hn_comparison_sample(c, i, &sample) && sample.q) {
            plot->tracks[i].gap[plot->n - 1] = sample.gap;
            plot->tracks[i].energy[plot->n - 1] = sample.energy_change;
        }
    }
}

/// The frame in which the clock arrives at the end; `plot` (may be NULL) keeps every frame.
static void run_to_the_end(hn_comparison *c, hn_motion_plot *plot) {
    hn_progress progress = {0};
    if (plot) {
        keep_frame(plot, c);
    }
    while (!hn_comparison_finished(c)) {
        hn_comparison_next(c);
        if (plot) {
            keep_frame(plot, c);
        }
        double t = (double)hn_comparison_frame(c) * hn_comparison_frame_dt(c);
        hn_progress_tell(&progress, "comparing", fmin(1, t / hn_comparison_duration(c)));
    }
    hn_progress_end(&progress);
}

/// "m" when every row of the loops is a length; a mixture has no unit.
static const char *gap_unit(const hn_model *model) {
    const hn_system *sys = hn_model_system(model);
    for (int i = 0; i < hn_system_get_info(sys).nc; i++) {
        if (!hn_system_row_is_length(sys, i)) {
            return "";
        }
    }
    return "m";
}

static bool has_failed(const cJSON *method) {
    return strcmp(hn_document_text(method, "state"), "failed") == 0;
}

/// Returns whether the coordinates are so far from the true motion that they say nothing of it, or
/// an incident calls the motion wrong after the end of the estimate.
static bool is_wrong(const cJSON *method) {
    return strcmp(hn_document_text(hn_document_get(method, "verdict"), "is"), "wrong") == 0;
}

/// The verdict on the motion, where the run came to its end.
static const char *status_of(const cJSON *method) {
    const char *is = hn_document_text(hn_document_get(method, "verdict"), "is");
    return has_failed(method)           ? "ENDED EARLY"
           : is_wrong(method)           ? "WRONG"
           : strcmp(is, "unknown") == 0 ? "not judged"
                                        : is;
}

/// The estimated errors of coordinates and of reactions: the first with the time where it ends
/// before the run, or with how many times the tolerance it is.
static void put_estimate(hn_table *t, const cJSON *e) {
    const double q = hn_document_number(e, "q"), times = hn_document_number(e, "over_rtol");
    if (!isfinite(q)) {
        hn_table_cell(t, "-");
        hn_table_cell(t, "-");
        return;
    }
    if (hn_document_text(e, "reason")[0]) {
        hn_table_cell(t, "%.1e up to %.3g s", q, hn_document_number(e, "t"));
    } else if (times > HN_TOLERANCE_KEPT) {
        hn_table_cell(t, "%.1e, %.0f rtol", q, times);
    } else {
        hn_table_cell(t, "%.1e", q);
    }
    const double reaction = hn_document_number(e, "reaction");
    hn_table_cell(t, isfinite(reaction) ? "%.1e" : "-", reaction);
}

static void put_row(hn_table *t, const cJSON *m, const char *unit) {
    double steps = hn_document_number(m, "steps");
    char rate[8];
    snprintf(rate, sizeof rate, "%s%s", unit, unit[0] ? "/s" : "");

    // how the run went
    hn_table_cell(t, "%s", hn_document_text(m, "method"));
    hn_table_cell(t, "%s", status_of(m));
    if (has_failed(m) || is_wrong(m)) {
        hn_table_bad(t);
    }
    hn_table_quantity(t, hn_document_number(m, "t_reached"), "s");
    hn_table_quantity(t, hn_document_number(m, "worst_gap"), unit);
    hn_table_quantity(t, hn_document_number(m, "worst_velocity_gap"), rate);
    hn_table_quantity(t, hn_document_number(m, "worst_energy_change"), "J");

    // what it cost
    put_estimate(t, hn_document_get(m, "error_estimate"));
    hn_table_cell(t, "%.0f", steps);
    hn_table_cell(t, "%.0f", hn_document_number(m, "evals"));
    const double ops = hn_document_number(m, "ops");
    hn_table_quantity(t, ops, "op");
    hn_table_quantity(t, steps > 0 ? ops / steps : (double)NAN, "op");

    // the time of a step, with its quartiles where it was measured
    const cJSON *cost = hn_document_get(m, "step_cpu");
    hn_table_quantity(t, hn_document_number(cost, "median"), "s");
    if (!isfinite(hn_document_number(cost, "median"))) {
        hn_table_cell(t, "-");
        return;
    }
    char low[HN_SI_TEXT], high[HN_SI_TEXT];
    hn_si_format(hn_document_number(cost, "low"), "s", 2, low);
    hn_si_format(hn_document_number(cost, "high"), "s", 2, high);
    hn_table_cell(t, "%s to %s", low, high);
}

/// Says what WRONG stands for; i: number of the method in the summary.
static void put_wrong(hn_strbuf *b, const cJSON *summary, const cJSON *m, int i) {
    const cJSON *e = hn_document_get(m, "error_estimate");
    hn_strbuf_printf(b, "! %s is wrong: ", hn_document_text(m, "method"));
    if (hn_document_number(e, "q") >= HN_ACCURACY_WRONG) {
        char off[HN_SI_TEXT];
        hn_estimate_write_off(hn_document_number(e, "off"), hn_document_text(e, "unit"), off);
        hn_strbuf_printf(b, "%s is off by up to %s", hn_document_text(e, "coordinate"), off);
    } else {
        hn_strbuf_add(b, hn_document_text(hn_document_get(m, "verdict"), "text"));
    }
    hn_strbuf_printf(b, "%s\n", hn_error_advice(m, hn_document_get(summary, "incidents"), i));
}

/// The first incidents of one method, errors before warnings; the rest are counted.
static void put_incidents(hn_strbuf *b, const cJSON *summary, const cJSON *m, int i) {
    const char *name = hn_document_text(m, "method");
    hn_incident_list list;
    hn_incident_list_take(&list, hn_document_get(summary, "incidents"), i,
                          hn_document_text(m, "reason"));
    for (int k = 0; k < list.n && k < MAX_INCIDENTS; k++) {
        char line[HN_INCIDENT_LINE];
        hn_incident_line(list.item[k], line, sizeof line);
        hn_strbuf_printf(b, "! %s: %s\n", name, line);
    }
    if (list.n > MAX_INCIDENTS) {
        hn_strbuf_printf(b, "! %s: ", name);
        hn_incident_more(b, &list, MAX_INCIDENTS);
        hn_strbuf_add(b, "\n");
    }
}

/// Writes the remarks on each method: on its spelling, its motion and its incidents. Why it
/// ended is said after the table.
static void put_remarks(hn_strbuf *b, const cJSON *summary) {
    const cJSON *m;
    int i = 0;
    cJSON_ArrayForEach(m, hn_document_get(summary, "methods")) {
        if (hn_document_text(m, "warning")[0]) {
            hn_strbuf_printf(b, "! %s: %s\n", hn_document_text(m, "method"),
                             hn_document_text(m, "warning"));
        }
        if (!has_failed(m) && is_wrong(m)) {
            put_wrong(b, summary, m, i);
        }
        put_incidents(b, summary, m, i);
        i++;
    }
}

/// The scene and the time of the end; where every method ended before, the time that was asked for.
static void put_head(hn_strbuf *b, const hn_scene *scene, const cJSON *summary, double duration) {
    bool goes_on = false;
    const cJSON *m;
    cJSON_ArrayForEach(m, hn_document_get(summary, "methods")) {
        goes_on |= !has_failed(m);
    }
    hn_strbuf_printf(b, goes_on ? "%s to t = %g s\n" : "%s: every method ended before t = %g s\n",
                     scene->title ? scene->title : scene->id, duration);
}

/// Returns whether the status finds fault with a motion that came to its end.
static bool is_at_fault(const cJSON *summary) {
    const cJSON *m;
    cJSON_ArrayForEach(m, hn_document_get(summary, "methods")) {
        const char *is = hn_document_text(hn_document_get(m, "verdict"), "is");
        if (!has_failed(m) && (strcmp(is, "wrong") == 0 || strcmp(is, "inaccurate") == 0)) {
            return true;
        }
    }
    return false;
}

/// Says by which measure the status judges, where it finds fault: the workbench has another.
static void put_measure(hn_strbuf *b, const cJSON *summary) {
    if (is_at_fault(summary)) {
        hn_strbuf_printf(
            b,
            "status: by the estimated errors of motion and reactions: right up to %g, "
            "WRONG from a motion error of %g on, inaccurate between; no motion is right that an "
            "incident calls wrong. The workbench "
            "and the page judge by another measure: the distance of drawn points from "
            "the reference solution, and the energy ('holonom help right')\n",
            HN_ACCURACY_WARN, HN_ACCURACY_WRONG);
    }
}

/// `own`: methods and parameters are those of the scene.
static void put_table(hn_strbuf *b, const hn_model *model, const cJSON *summary, double duration,
                      bool own) {
    // the order in which columns are left out: what can be computed from others goes first
    static const struct {
        const char *head;
        int to_right, spare;
    } columns[] = {{"method", 0, 0},
                   {"status", 0, 0},
                   {"t", 1, 5},
                   {"worst gap", 1, 0},
                   {"velocity gap", 1, 6},
                   {"energy change", 1, 0},
                   {"motion error", 1, 10},
                   {"reaction error", 1, 9},
                   {"steps", 1, 7},
                   {"evals", 1, 4},
                   {"ops", 1, 3},
                   {"ops/step", 1, 2},
                   {"CPU/step", 1, 8},
                   {"quartiles", 0, 1}};

    // a row for each method
    const hn_scene *scene = hn_model_scene(model);
    hn_table t;
    hn_table_init(&t);
    for (size_t c = 0; c < sizeof columns / sizeof *columns; c++) {
        hn_table_column(&t, columns[c].head, columns[c].to_right);
        hn_table_spare(&t, columns[c].spare);
    }
    const cJSON *m;
    cJSON_ArrayForEach(m, hn_document_get(summary, "methods")) {
        put_row(&t, m, gap_unit(model));
    }

    // title, table, and what happened on the way
    put_head(b, scene, summary, duration);
    hn_table_write(b, &t);
    put_measure(b, summary);
    if (own && scene->exhibit[0] && is_at_fault(summary)) {
        hn_strbuf_printf(b, "this is intended: %s\n", scene->exhibit);
    }
    put_remarks(b, summary);
    hn_table_reset(&t);
}

/// Says which methods ended early and why; 1 if any did.
static int tell_failures(const cJSON *summary, int aloud) {
    int failed = 0, i = 0;
    const cJSON *m;
    cJSON_ArrayForEach(m, hn_document_get(summary, "methods")) {
        if (has_failed(m)) {
            failed = 1;
        }
        if (has_failed(m) && aloud) {
            hn_incident_list list;
            char ending[HN_INCIDENT_LINE];
            const char *reason = hn_document_text(m, "reason");
            hn_incident_list_take(&list, hn_document_get(summary, "incidents"), i, reason);
            hn_incident_ending(&list, hn_document_number(m, "t_reached"), reason, ending,
                               sizeof ending);
            hn_cli_note("holonom: %s ended early%s\n", hn_document_text(m, "method"), ending);
        }
        i++;
    }
    return failed;
}

/// Tracks named by the spelling of their method.
static void begin_plot(hn_motion_plot *plot, const hn_comparison *c, const char *unit,
                       char names[][HN_SPEC_MAX]) {
    *plot = (hn_motion_plot){.dt = hn_comparison_frame_dt(c), .gap_unit = unit};
    plot->n_tracks = hn_comparison_n_methods(c);
    for (int i = 0; i < plot->n_tracks; i++) {
        hn_method_format(hn_run_spec(hn_comparison_run(c, i)), names[i]);
        plot->tracks[i].name = names[i];
        plot->tracks[i].slot = hn_comparison_slot(c, i);
    }
}

hn_exit hn_command_compare(const hn_library *lib, const hn_args *args) {
    hn_model *model = NULL;
    hn_comparison *c = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_status status = hn_args_load_model(lib, args, args->words.word[0], 0, &model, &diags);
    HN_THEN(status, create(args, model, &c, &diags));
    if (status != HN_OK) {
        hn_model_free(model);
        return hn_report_diags(args, status, &diags);
    }

    // to the end, the plot on the way
    char names[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    hn_motion_plot plot;
    begin_plot(&plot, c, gap_unit(model), names);
    run_to_the_end(c, args->plot ? &plot : NULL);
    hn_comparison_summary_json(&b, c);
    cJSON *summary = cJSON_Parse(hn_strbuf_text(&b));
    if (!args->json) {
        hn_strbuf_clear(&b);
        put_table(&b, model, summary, hn_comparison_duration(c),
                  args->methods.n == 0 && args->set.n == 0);
        if (args->plot) {
            hn_motion_plot_text(&b, &plot, hn_terminal_columns(), hn_terminal_colours());
        }
    }
    hn_motion_plot_free(&plot);

    // a method that ended early is no fault of the program
    hn_exit result = args->json ? hn_cli_print(&b) : hn_cli_print_text(&b);
    int failed = tell_failures(summary, !args->json);
    cJSON_Delete(summary);
    hn_comparison_free(c);
    hn_model_free(model);
    return result == HN_EXIT_DONE && failed ? HN_EXIT_ENDED : result;
}
