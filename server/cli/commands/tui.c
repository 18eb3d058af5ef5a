// SPDX-License-Identifier: GPL-3.0-or-later
// holonom tui: the workbench in a terminal, or one frame of it as text.
#include "tui/tui.h"

#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/notes.h"
#include "cli/shell/plain.h"
#include "cli/shell/print.h"
#include "cli/shell/scene_word.h"
#include "render/look.h"
#include "terminal/keys.h"
#include "terminal/width.h"
#include "tui/foreground.h"
#include "tui/link.h"
#include "tui/views.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static hn_status see_setting(void *user, const char *name, double value) {
    hn_tui_link *o = user;
    if (o->n_settings < HN_TUI_SETTINGS) {
        snprintf(o->names[o->n_settings], sizeof *o->names, "%s", name);
        o->settings[o->n_settings] = (hn_setting){o->names[o->n_settings], value};
        o->n_settings++;
    }
    return HN_OK;
}

/// Finds what is to be opened, from words and options, or from a link of the page; `methods` are
/// those of the options in place of those of the link.
static hn_status read_opening(const hn_args *args, hn_tui_link *o, const char **methods,
                              hn_diags *diags) {
    const char *word = args->words.n > 0 ? args->words.word[0] : "four-bar";
    if (!hn_workbench_read_link(word, o)) {
        snprintf(o->scene, sizeof o->scene, "%s", word);
    }
    HN_TRY(hn_assignments_read(&args->set, "--set", see_setting, o, diags));
    for (int i = 0; i < o->n_methods; i++) {
        methods[i] = o->methods[i];
    }
    if (args->methods.n > HN_COMPARISON_MAX_METHODS || args->set.n > HN_TUI_SETTINGS) {
        return hn_diags_add(diags, HN_ERR_LIMIT,
                            args->methods.n > HN_COMPARISON_MAX_METHODS ? "/methods" : "/set", NULL,
                            "the workbench compares %d methods with %d changed parameters at most",
                            HN_COMPARISON_MAX_METHODS, HN_TUI_SETTINGS);
    }
    for (int i = 0; i < args->methods.n; i++) {
        methods[i] = args->methods.word[i];
        o->n_methods = i + 1;
    }
    return HN_OK;
}

/// "100x30"; left at 0 x 0 where nothing is given.
static hn_status read_size(const char *text, hn_tui_opts *opts, hn_diags *diags) {
    char behind;
    if (text && (sscanf(text, "%dx%d%c", &opts->columns, &opts->rows, &behind) != 2 ||
                 opts->columns < HN_TUI_LEAST_COLUMNS || opts->rows < HN_TUI_LEAST_ROWS ||
                 opts->columns > 1000 || opts->rows > 500)) {
        return hn_diags_add(
            diags, HN_ERR_INPUT, "/size", NULL,
            "--size is '%.40s'; COLUMNSxROWS from 20x8 to 1000x500 is needed, as 100x30", text);
    }
    return HN_OK;
}

static hn_status read_pictures(const char *text, hn_tui_opts *opts, hn_diags *diags) {
    if (text && !hn_pixels_parse(text, &opts->pictures)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/pictures",
                            "auto asks the terminal, off draws in characters",
                            "--pictures is '%.40s'; auto, kitty, sixel and off are allowed", text);
    }
    return HN_OK;
}

/// Every key of --keys must be one.
static hn_status check_keys(const char *text, hn_diags *diags) {
    const char *rest = text ? text : "";
    while (hn_tui_key_read(&rest) != 0) {}
    if (*rest) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/keys",
                            "as in 'g', 'b<Right><Enter>'; also <Esc>, <Backspace>, <PageDown>",
                            "--keys: '%.40s' does not begin with a key", rest);
    }
    return HN_OK;
}

/// --t is a time of the motion.
static hn_status check_time(double t, const hn_workbench *w, hn_diags *diags) {
    const double end = hn_recording_duration(w->recording);
    if (t < 0 || t > end) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/t", NULL,
                            "--t is %g s; the motion of %.60s allows 0 to %g s", t, w->scene, end);
    }
    return HN_OK;
}

/// A frame as text needs room for all its views.
static hn_status check_size(const hn_args *args, const hn_workbench *w, const hn_tui_opts *opts,
                            hn_diags *diags) {
    int columns, rows;
    hn_views_least_size(w, &columns, &rows);
    if (args->size && (opts->columns < columns || opts->rows < rows)) {
        return hn_diags_add(
            diags, HN_ERR_INPUT, "/size", NULL,
            "--size is '%.40s', which is too small for %d method%s; %dx%d is needed", args->size,
            w->n_methods, w->n_methods == 1 ? "" : "s", columns, rows);
    }
    return HN_OK;
}

/// The frames as text: one, at the end of the motion unless a time is given, or with --frames as
/// many as a terminal would show from the start on.
static void add_frames(hn_strbuf *b, const hn_args *args, hn_workbench *w, hn_tui_opts *opts,
                       bool paused) {
    const double end = hn_recording_duration(w->recording);
    const int n = args->once || opts->frames == 0 ? 1 : opts->frames;
    double t = !isnan(args->t) ? args->t
               : paused        ? w->clock * hn_recording_frame_dt(w->recording)
               : n > 1         ? 0
                               : end;
    for (int i = 0; i < n; i++) {
        hn_strbuf_add(b, i > 0 ? "\n" : "");
        opts->t = t;
        hn_tui_frame(b, w, opts);
        opts->keys = NULL; // they were typed
        t = fmin(t + HN_TUI_FRAME * w->speed, end);
    }
}

/// A frame without --size is no wider than the terminal in which it is printed.
static void fit_frame(const hn_args *args, const hn_workbench *w, hn_tui_opts *opts) {
    int least_columns, least_rows;
    hn_views_least_size(w, &least_columns, &least_rows);
    const int columns = hn_terminal_columns();
    if (!args->size && isatty(STDOUT_FILENO) && columns >= least_columns &&
        columns < HN_TUI_COLUMNS) {
        opts->columns = columns;
        opts->rows = HN_TUI_ROWS > least_rows ? HN_TUI_ROWS : least_rows;
    }
}

/// `paused`: a link names the frame, which --t alone changes.
static hn_exit show(const hn_args *args, hn_workbench *w, hn_tui_opts *opts, bool paused,
                    hn_diags *diags) {
    const bool terminal = isatty(STDOUT_FILENO) && isatty(STDIN_FILENO);
    opts->colours = hn_terminal_colours();
    if (terminal && !args->once && (args->keys || args->size)) {
        const char *name = args->keys ? "--keys" : "--size";
        hn_diags_add(diags, HN_ERR_INPUT, args->keys ? "/keys" : "/size",
                     "with --once the frame is printed as text",
                     "%s is about a frame as text, and this terminal shows the workbench", name);
        return hn_report_diags(args, HN_ERR_INPUT, diags);
    }
    if (terminal && !args->once) {
        // a terminal that cannot place its cursor would show a heap of lines
        const char *name = getenv("TERM");
        if (!hn_foreground_wait()) {
            hn_cli_note("holonom: tui was started in the background, where it can neither draw nor "
                        "read keys; start it without &, or use --once for one frame as text\n");
            return HN_EXIT_INPUT;
        }
        if (!isnan(args->t)) {
            hn_workbench_go_to(w, args->t);
        }
        if (name && strcmp(name, "dumb") != 0 && hn_tui_run(w, opts)) {
            return HN_EXIT_DONE;
        }
        hn_cli_note("holonom: the terminal '%s' cannot show the workbench; this is one frame of it "
                    "as text\n",
                    getenv("TERM") ? getenv("TERM") : "");
    }

    // no terminal, or one frame was asked for
    fit_frame(args, w, opts);
    const hn_status status = check_size(args, w, opts, diags);
    if (status != HN_OK) {
        return hn_report_diags(args, status, diags);
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    add_frames(&b, args, w, opts, paused);
    if (opts->ascii) {
        hn_strbuf plain;
        hn_strbuf_init(&plain);
        hn_plain_add(&plain, hn_strbuf_text(&b));
        hn_strbuf_reset(&b);
        return hn_cli_print(&plain);
    }
    return hn_cli_print(&b);
}

/// Leaves out of a link what the first fault is about: one method, or all changed parameters.
/// Returns false where nothing can be left out. said: what was found, and what is shown instead.
static bool leave_out(hn_tui_link *o, const char **methods, const hn_diags *diags,
                      char said[HN_TUI_MESSAGE]) {
    const hn_diag *d = &diags->item[0];
    const char *instead = NULL;
    int at;
    if (sscanf(d->pointer, "/methods/%d", &at) == 1 && at < o->n_methods) {
        memmove(methods + at, methods + at + 1, (size_t)(o->n_methods - at - 1) * sizeof *methods);
        o->n_methods--;
        instead =
            o->n_methods > 0 ? "this method is left out" : "the methods are those of the scene";
    } else if (strncmp(d->pointer, "/parameters", 11) == 0 && o->n_settings > 0) {
        o->n_settings = 0;
        instead = "all parameters have the scene's values";
    } else {
        return false;
    }
    const size_t n = strlen(said);
    snprintf(said + n, HN_TUI_MESSAGE - n, "%s%.*s%s%s; %s",
             n > 0 ? "; " : "the link: ", (int)strcspn(d->message, ";"), d->message,
             d->hint[0] ? "; " : "", d->hint, instead);
    return true;
}

/// Opens the workbench; of a link, what can be opened, with the rest said.
static hn_status open_workbench(hn_workbench *w, const hn_library *lib, const hn_args *args,
                                hn_tui_link *o, const char **methods, hn_diags *diags) {
    const bool is_link = args->methods.n == 0 && args->set.n == 0 && args->words.n > 0 &&
                         strcmp(args->words.word[0], o->scene) != 0;
    char said[HN_TUI_MESSAGE] = "";
    if (o->faults[0]) {
        snprintf(said, sizeof said, "the link: %.*s", HN_TUI_MESSAGE - 16, o->faults);
    }
    for (;;) {
        const hn_status status = hn_workbench_open(w, lib, o->scene, o->settings, o->n_settings,
                                                   methods, o->n_methods, diags);
        if (status == HN_OK && said[0]) {
            hn_workbench_say(w, "%s", said);
        }
        if (status == HN_OK || !is_link || !leave_out(o, methods, diags, said)) {
            return status;
        }
        *diags = (hn_diags){0};
    }
}

hn_exit hn_command_tui(const hn_library *lib, const hn_args *args) {
    hn_tui_link o;
    const char *methods[HN_COMPARISON_MAX_METHODS];
    hn_diags diags = {0};
    hn_workbench w;
    hn_tui_opts opts = {.theme = !args->theme                        ? -1
                                 : strcmp(args->theme, "light") == 0 ? HN_THEME_LIGHT
                                                                     : HN_THEME_DARK,
                        .frames = isnan(args->frames) ? 0 : (int)args->frames,
                        .keys = args->keys,
                        .blocks = args->blocks};
    opts.ascii =
        args->ascii || hn_plain_wanted(getenv("LC_ALL"), getenv("LC_CTYPE"), getenv("LANG"));

    if (args->json) {
        hn_diags_add(&diags, HN_ERR_INPUT, "/json",
                     "the numbers of a run as JSON: holonom compare SCENE --json",
                     "tui draws text and has no --json");
        return hn_report_diags(args, HN_ERR_INPUT, &diags);
    }

    // everything is read before anything is opened
    hn_status status = read_size(args->size, &opts, &diags);
    HN_THEN(status, read_pictures(args->pictures, &opts, &diags));
    HN_THEN(status, check_keys(args->keys, &diags));
    status = status == HN_OK ? read_opening(args, &o, methods, &diags) : status;
    HN_THEN(status, open_workbench(&w, lib, args, &o, methods, &diags));
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    hn_workbench_go_to_link(&w, &o);
    status = check_time(args->t, &w, &diags);
    const hn_exit result = status == HN_OK ? show(args, &w, &opts, o.frame >= 0, &diags)
                                           : hn_report_diags(args, status, &diags);
    hn_workbench_close(&w);
    return result;
}
