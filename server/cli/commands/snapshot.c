// SPDX-License-Identifier: GPL-3.0-or-later
// holonom snapshot: a picture of where several methods have taken a scene.
#include "cli/commands/exercise_word.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/forms.h"
#include "cli/shell/notes.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "cli/shell/scene_word.h"
#include "render/canvas.h"
#include "session/compare/picture.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double SMALL = 120; // [px] texts of a smaller mechanism have no room

/// Chooses the form of the picture by the ending of its file.
static hn_status choose_form(const hn_args *args, hn_picture_request *request, hn_diags *diags) {
    if (!args->out) {
        return hn_diags_add(diags, HN_ERR_INPUT, NULL, "-o FILE.png, or -o - for standard output",
                            "the file for the picture is not given");
    }
    const bool svg = hn_path_ends_in(args->out, ".svg");
    const bool png = strcmp(args->out, "-") == 0 || hn_path_ends_in(args->out, ".png") ||
                     hn_path_ends_in(args->out, ".apng");
    if (!svg && !png) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/out", "end it in .png or .svg",
                            "'%.200s' is no name for a picture: snapshots are PNG or SVG",
                            args->out);
    }
    if (args->ghosts && args->at.n < 2) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/ghosts", "--at 0,0.2,0.4 --ghosts",
                            "--ghosts draws earlier poses beneath the last one; --at names their "
                            "times, two or more");
    }
    if (!isnan(args->animate) && args->ghosts) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/animate", "leave one of them out",
                            "--ghosts draws all times into one picture, --animate one after the "
                            "other");
    }
    if (!isnan(args->animate) &&
        (svg || args->at.n < 2 || args->animate < 1 || args->animate > 65535)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/animate", "--at 0,0.1,0.2 --animate 100",
                            "an animation is a PNG of several times, each for 1 to 65535 ms");
    }
    request->form = svg ? HN_PICTURE_SVG : isnan(args->animate) ? HN_PICTURE_PNG : HN_PICTURE_APNG;
    request->delay = isnan(args->animate) ? 0 : (int)args->animate;
    return HN_OK;
}

/// The time asked for: --time, or --t; NaN where neither is given.
static double time_of(const hn_args *args) {
    return isnan(args->time) ? args->t : args->time;
}

/// Moments of one motion follow each other.
static hn_status check_times(const hn_args *args, hn_diags *diags) {
    if (!isnan(args->t) && !isnan(args->time)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/t", "leave one of them out",
                            "--t and --time are the same option, and both are given");
    }
    if (args->at.n > 0 && !isnan(time_of(args))) {
        return hn_diags_add(
            diags, HN_ERR_INPUT, "/time", "leave one of them out",
            "--time %g and --at both choose the time of the picture; give one of them",
            time_of(args));
    }
    for (int i = 1; i < args->at.n; i++) {
        if (!(args->at.value[i] > args->at.value[i - 1])) {
            return hn_diags_add(diags, HN_ERR_INPUT, "/at", "as in --at 0,0.2,0.5",
                                "the times of --at must increase: %g s comes after %g s",
                                args->at.value[i], args->at.value[i - 1]);
        }
    }
    return HN_OK;
}

static hn_status read_size(const char *option, double given, int *size, hn_diags *diags) {
    if (given < HN_CANVAS_MIN || given > HN_CANVAS_MAX) {
        return hn_diags_add(diags, HN_ERR_INPUT, NULL, NULL,
                            "%s is %.15g; %d to %d pixels are allowed", option, given,
                            HN_CANVAS_MIN, HN_CANVAS_MAX);
    }
    *size = (int)given;
    return HN_OK;
}

/// The renderer asked for, for the whole program.
static hn_status choose_renderer(const hn_args *args, hn_diags *diags) {
    static const char *const names[] = {"auto", "osmesa", "built-in"};
    hn_renderer wanted = HN_RENDERER_AUTO;
    if (!args->renderer) {
        return HN_OK;
    }
    while (strcmp(args->renderer, names[wanted]) != 0) {
        if (++wanted == HN_RENDERER_COUNT) {
            return hn_diags_add(diags, HN_ERR_INPUT, "/renderer", "auto, osmesa or built-in",
                                "'%.40s' is not a renderer", args->renderer);
        }
    }
    hn_canvas_choose_renderer(wanted);
    if (wanted == HN_RENDERER_OSMESA && strcmp(hn_canvas_renderer(), "OSMesa") != 0) {
        return hn_diags_add(diags, HN_ERR_UNSUPPORTED, "/renderer",
                            "install libosmesa6, or take --renderer built-in",
                            "OSMesa is not installed");
    }
    return HN_OK;
}

static hn_status read_opts(const hn_args *args, hn_picture_request *request, hn_diags *diags) {
    if (!isnan(args->width)) {
        HN_TRY(read_size("--width", args->width, &request->width, diags));
    }
    if (!isnan(args->height)) {
        HN_TRY(read_size("--height", args->height, &request->height, diags));
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
    HN_TRY(choose_renderer(args, diags));

    return choose_form(args, request, diags);
}

/// The methods asked for, or the scene's own: its first alone for an exercise, whose picture
/// compares nothing.
static void choose_methods(const hn_args *args, const hn_scene *scene, bool is_exercise,
                           hn_picture_request *request) {
    if (args->method) {
        request->methods = &args->method;
        request->n_methods = 1;
    } else {
        request->methods = args->methods.n > 0 ? args->methods.word : scene->methods;
        request->n_methods = args->methods.n > 0 ? args->methods.n
                             : is_exercise       ? 1
                                                 : scene->n_methods;
    }
    request->time = isnan(time_of(args)) ? 0 : time_of(args);
}

/// Subject that a word names: a scene, or an exercise with the numbers of a variant.
typedef struct subject {
    hn_model *model;
    hn_exercise *exercise;
    hn_part_view view;
    hn_state_entry entries[HN_PART_ENTRIES];
} subject;

/// The scene of an exercise, with the numbers of the variant.
static hn_status load_exercise(const hn_library *lib, const hn_args *args, subject *s,
                               hn_diags *diags) {
    hn_diag diag = {0};
    HN_TRY(hn_cli_load_exercise(lib, args->words.word[0], &s->exercise, diags));
    hn_status status = hn_shelf_exercise_view(s->exercise, hn_cli_variant_seed(args, s->exercise),
                                              &s->view, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, diag.pointer, diag.hint, "%s", diag.message);
    }
    const hn_model_source source = {.name = s->view.scene,
                                    .settings = s->view.settings,
                                    .n_settings = s->view.n_settings,
                                    .allow_open = s->view.n_entries > 0};
    for (int i = 0; i < s->view.n_entries; i++) {
        s->entries[i] = (hn_state_entry){.name = s->view.names[i], .value = s->view.given[i]};
    }
    return hn_model_load(lib, &source, &s->model, diags);
}

/// The start of the scene is drawn where a part asks for the configuration: the answer is not.
static void note_start(const hn_exercise *e) {
    bool asked = false;
    for (int i = 0; i < e->n_parts; i++) {
        asked |= strcmp(hn_part_text(e->parts[i].node, "kind"), "configuration") == 0;
    }
    if (hn_shelf_picture_scene(e)[0]) {
        hn_cli_note("holonom: lengths are those of the variant; angles are those of the scene's "
                    "start, not those of exercise '%s'\n",
                    e->id);
    } else if (asked) {
        hn_cli_note("holonom: lengths are those of the variant; angles are those of the scene's "
                    "start, because finding the variant's angles is the task of '%s'\n",
                    e->id);
    }
}

static hn_status load_subject(const hn_library *lib, const hn_args *args, subject *s,
                              hn_diags *diags) {
    const char *word = args->words.word[0];
    if (!hn_library_scene_path(lib, word) && hn_library_problem_path(lib, word)) {
        return load_exercise(lib, args, s, diags);
    }
    if (args->student || !isnan(args->seed)) {
        return hn_diags_add(diags, HN_ERR_INPUT, NULL,
                            "name an exercise, or leave --seed and --student out",
                            "--seed and --student choose a variant, and a scene has none");
    }
    return hn_args_load_model(lib, args, word, 0, &s->model, diags);
}

/// A picture that is drawn, with what is said about it.
typedef struct drawn {
    hn_strbuf png, description;
    hn_strbuf ending; ///< which method ended early, when and why
    hn_status ended;
    double mechanism; ///< its size [px]
} drawn;

/// Says by which renderer the picture was painted, where that is asked for or not the usual one.
static void note_renderer(const hn_args *args, const hn_picture_request *request) {
    const char *renderer = hn_canvas_renderer();
    const bool usual = strcmp(renderer, "OSMesa") == 0;
    if (request->form != HN_PICTURE_SVG && (!usual || args->renderer)) {
        fprintf(stderr, "holonom: drawn by %s\n", usual ? renderer : "the built-in renderer");
    }
}

/// Prints what a picture shows: at a terminal over lines, to a program in one.
static hn_exit print_description(hn_strbuf *description) {
    cJSON *document = isatty(STDOUT_FILENO) ? cJSON_Parse(hn_strbuf_text(description)) : NULL;
    char *lines = document ? cJSON_Print(document) : NULL;
    hn_strbuf shown;
    hn_strbuf_init(&shown);
    if (lines) {
        hn_strbuf_printf(&shown, "%s\n", lines);
    }
    const hn_exit result = hn_cli_print(lines ? &shown : description);
    hn_strbuf_reset(&shown);
    cJSON_free(lines);
    cJSON_Delete(document);
    return result;
}

/// Writes the picture, then what it shows.
static hn_exit deliver(const hn_args *args, const hn_picture_request *request, drawn *d) {
    hn_exit result = hn_cli_write_picture(args, args->out, &d->png);
    if (result == HN_EXIT_DONE && d->mechanism < SMALL) {
        hn_cli_note("holonom: the mechanism is only %.0f pixels large in this picture; --width 600 "
                    "--height 400 or more gives it and its texts room\n",
                    d->mechanism);
    }
    if (result == HN_EXIT_DONE && (args->json || args->describe) && strcmp(args->out, "-") != 0) {
        result = print_description(&d->description);
    }
    if (result == HN_EXIT_DONE) {
        note_renderer(args, request);
    }
    if (result == HN_EXIT_DONE && d->ended != HN_OK) {
        hn_cli_note("holonom: %s; the picture shows its last pose\n", hn_strbuf_text(&d->ending));
        result = HN_EXIT_ENDED;
    }
    return result;
}

/// Says what of an exercise the picture does not show.
static void note_exercise(const hn_args *args, const subject *s) {
    note_start(s->exercise);
    if (s->view.n_entries > 0 && (args->at.n > 0 || !isnan(time_of(args)))) {
        hn_cli_note("holonom: exercise '%s' has one configuration and no motion; --time and "
                    "--at are not used; 'holonom snapshot %s' draws its scene at any time\n",
                    hn_exercise_id(s->exercise), s->view.scene);
    }
}

hn_exit hn_command_snapshot(const hn_library *lib, const hn_args *args) {
    subject s = {0};
    drawn d = {.ended = HN_OK};
    hn_diags diags = {0};
    hn_strbuf_init(&d.png);
    hn_strbuf_init(&d.description);
    hn_strbuf_init(&d.ending);
    hn_picture_request request = {.ending = &d.ending, .mechanism = &d.mechanism};
    hn_status status = read_opts(args, &request, &diags);
    HN_THEN(status, load_subject(lib, args, &s, &diags));
    if (status == HN_OK && s.view.n_entries > 0) {
        request.entries = s.entries;
        request.n_entries = s.view.n_entries;
        request.n_times = 0; // one configuration has no other moments
        request.ghosts = false;
    } else if (status == HN_OK) {
        choose_methods(args, hn_model_scene(s.model), s.exercise != NULL, &request);
    }
    HN_THEN(status, hn_model_picture(&d.png, &d.description, s.model, &request, &d.ended, &diags));
    hn_model_free(s.model);
    if (status == HN_OK && s.exercise) {
        note_exercise(args, &s);
    }
    hn_exercise_free(s.exercise);
    const hn_exit result =
        status == HN_OK ? deliver(args, &request, &d) : hn_report_diags(args, status, &diags);
    if (status != HN_OK) {
        hn_strbuf_reset(&d.png);
    }
    hn_strbuf_reset(&d.description);
    hn_strbuf_reset(&d.ending);
    return result;
}
