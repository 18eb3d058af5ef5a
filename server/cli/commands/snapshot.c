// SPDX-License-Identifier: GPL-3.0-or-later
// holonom snapshot: a picture of where several methods have taken a scene.
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/forms.h"
#include "cli/shell/notes.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "cli/shell/scene_word.h"
#include "render/canvas.h"
#include "session/compare/picture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Where it goes, and as what: by the ending.
static hn_status choose_form(const hn_args *args, hn_picture_request *request, hn_diags *diags) {
    if (!args->out) {
        return hn_diags_add(diags, HN_ERR_INPUT, NULL, "-o FILE.png, or -o - for standard output",
                            "where should the picture go?");
    }
    const bool svg = hn_path_ends_in(args->out, ".svg");
    const bool png = strcmp(args->out, "-") == 0 || hn_path_ends_in(args->out, ".png") ||
                     hn_path_ends_in(args->out, ".apng");
    if (!svg && !png) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/out", "end it in .png or .svg",
                            "'%.200s' is no name for a picture: snapshots are PNG or SVG",
                            args->out);
    }
    if (!isnan(args->animate) &&
        (svg || args->at.n < 2 || args->ghosts || args->animate < 1 || args->animate > 65535)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/animate", "--at 0,0.1,0.2 --animate 100",
                            "an animation is a PNG of several times, each for 1 to 65535 ms");
    }
    request->form = svg ? HN_PICTURE_SVG : isnan(args->animate) ? HN_PICTURE_PNG : HN_PICTURE_APNG;
    request->delay = isnan(args->animate) ? 0 : (int)args->animate;
    return HN_OK;
}

/// Moments of one motion follow each other.
static hn_status check_times(const hn_args *args, hn_diags *diags) {
    for (int i = 1; i < args->at.n; i++) {
        if (!(args->at.value[i] > args->at.value[i - 1])) {
            return hn_diags_add(diags, HN_ERR_INPUT, "/at",
                                "put them in rising order: --at 0,0.2,0.5",
                                "%g s stands after %g s; the times of one motion must rise",
                                args->at.value[i], args->at.value[i - 1]);
        }
    }
    return HN_OK;
}

static hn_status read_opts(const hn_args *args, hn_picture_request *request, hn_diags *diags) {
    if (!isnan(args->width)) {
        request->width = (int)fmin(fmax(1, args->width), 1e6);
    }
    if (!isnan(args->height)) {
        request->height = (int)fmin(fmax(1, args->height), 1e6);
    }
    if (args->theme && strcmp(args->theme, "dark") == 0) {
        request->theme = HN_THEME_DARK;
    } else if (args->theme && strcmp(args->theme, "light") != 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, NULL, "light or dark", "'%.40s' is not a theme",
                            args->theme);
    }
    request->view = args->view;
    request->times = args->at.value;
    request->n_times = args->at.n;
    request->ghosts = args->ghosts;
    request->dimensions = args->dimensions;
    request->forces = args->forces;
    request->traces = args->traces.word;
    request->n_traces = args->traces.n;
    HN_TRY(check_times(args, diags));

    return choose_form(args, request, diags);
}

/// The methods asked for, or the scene's own.
static void choose_methods(const hn_args *args, const hn_scene *scene,
                           hn_picture_request *request) {
    if (args->method) {
        request->methods = &args->method;
        request->n_methods = 1;
    } else {
        request->methods = args->methods.n > 0 ? args->methods.word : scene->methods;
        request->n_methods = args->methods.n > 0 ? args->methods.n : scene->n_methods;
    }
    request->time = isnan(args->time) ? 0 : args->time;
}

hn_exit hn_command_snapshot(const hn_library *lib, const hn_args *args) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_picture_request request = {0};
    hn_status ended = HN_OK;
    hn_strbuf png, description;
    hn_strbuf_init(&png);
    hn_strbuf_init(&description);
    hn_status status = read_opts(args, &request, &diags);
    HN_THEN(status, hn_args_load_model(lib, args, args->words.word[0], 0, &model, &diags));
    if (status == HN_OK) {
        choose_methods(args, hn_model_scene(model), &request);
        status = hn_model_picture(&png, &description, model, &request, &ended, &diags);
    }
    hn_model_free(model);

    // the picture, then what it shows
    if (status != HN_OK) {
        hn_strbuf_reset(&png);
        hn_strbuf_reset(&description);
        return hn_report_diags(args, status, &diags);
    }
    hn_exit result = hn_cli_write_file(args, args->out, &png);
    if (result == HN_EXIT_DONE && (args->json || args->describe) && strcmp(args->out, "-") != 0) {
        result = hn_cli_print(&description);
    }
    if (result == HN_EXIT_DONE && request.form != HN_PICTURE_SVG &&
        strcmp(hn_canvas_renderer(), "OSMesa") != 0) {
        fprintf(stderr, "holonom: drawn by the built-in renderer\n");
    }
    hn_strbuf_reset(&description);
    if (result == HN_EXIT_DONE && ended != HN_OK) {
        hn_cli_note("holonom: a method ended early (%s); the picture says which and where\n",
                    hn_status_text(ended));
        result = HN_EXIT_ENDED;
    }
    return result;
}
