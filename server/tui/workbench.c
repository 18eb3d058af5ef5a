// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/workbench.h"

#include "cli/shell/command.h"
#include "cli/shell/plain.h"
#include "render/look.h"
#include "tui/preview.h"
#include "tui/versions.h"
#include "tui/view_box.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { AHEAD = 60 }; // [frames] recorded before they are shown

/// Said until the reference is there, or cannot be.
static const char COMPUTING[] = "no reference is stored for these values: it is being computed, "
                                "and errors are unknown until then";

// ---- opening ----

hn_model_source hn_workbench_source(const hn_workbench *w) {
    // a name that is no shipped one and looks like a path is one
    const bool shipped =
        hn_library_scene_path(w->library, w->scene) != NULL || !strpbrk(w->scene, "./");
    return (hn_model_source){.name = shipped ? w->scene : NULL,
                             .path = shipped ? NULL : w->scene,
                             .settings = w->settings,
                             .n_settings = w->n_settings};
}

static hn_status load(hn_workbench *w, hn_diags *diags) {
    const hn_model_source source = hn_workbench_source(w);
    HN_TRY(hn_model_load(w->library, &source, &w->model, diags));
    hn_model_envelope(w->model, NULL, &w->envelope);
    return HN_OK;
}

/// The scene's own methods, or where it names none the two that tell drift from its cure.
static void choose_methods(hn_workbench *w, const char *const *methods, int n_methods) {
    static const char *const plain[] = {"index1@rk4", "projection@rk4"};
    const hn_scene *scene = hn_model_scene(w->model);
    if (n_methods == 0) {
        methods = scene->n_methods > 0 ? scene->methods : plain;
        n_methods = scene->n_methods > 0 ? scene->n_methods : 2;
    }
    w->n_methods = n_methods < HN_COMPARISON_MAX_METHODS ? n_methods : HN_COMPARISON_MAX_METHODS;
    for (int i = 0; i < w->n_methods; i++) {
        snprintf(w->methods[i], sizeof w->methods[i], "%s", methods[i]);
    }
}

hn_status hn_workbench_record(hn_workbench *w, hn_diags *diags) {
    const char *methods[HN_COMPARISON_MAX_METHODS];
    for (int i = 0; i < w->n_methods; i++) {
        methods[i] = w->methods[i];
    }
    hn_recording *fresh = NULL;
    HN_TRY(hn_recording_create(w->model, methods, w->n_methods, 0, &fresh, diags));
    // the same moment in frames of another length
    if (w->recording) {
        w->moment = hn_workbench_moment(w);
        w->clock = w->moment / hn_recording_frame_dt(fresh);
        w->clock = w->playing ? w->clock : round(w->clock);
    }
    hn_recording_free(w->recording);
    w->recording = fresh;
    hn_step_trial_free(w->step_trial);
    w->step_trial = NULL;
    w->untried[0] = '\0';
    w->cheapest.time = 0;
    hn_view_box_begin(w);
    w->clock = fmin(w->clock, hn_recording_last(fresh));
    w->selected = w->selected < w->n_methods ? w->selected : 0;
    hn_recording_want(fresh, (int)w->clock + AHEAD);
    return HN_OK;
}

static void keep_settings(hn_workbench *w, const hn_setting *settings, int n) {
    w->n_settings = n < HN_TUI_SETTINGS ? n : HN_TUI_SETTINGS;
    for (int i = 0; i < w->n_settings; i++) {
        snprintf(w->setting_names[i], sizeof w->setting_names[i], "%s", settings[i].name);
        w->settings[i] = (hn_setting){w->setting_names[i], settings[i].value};
    }
}

hn_status hn_workbench_open(hn_workbench *w, const hn_library *library, const char *scene,
                            const hn_setting *settings, int n_settings, const char *const *methods,
                            int n_methods, hn_diags *diags) {

    // what is not given comes from the scene
    *w = (hn_workbench){.library = library,
                        .speed = 1,
                        .wanted = "1 mm",
                        .pictures = hn_pictures_start(HN_PIXELS_OFF, HN_THEME_DARK)};
    hn_strbuf_init(&w->text);
    hn_strbuf_init(&w->link);
    w->columns = 80;
    w->rows = 24;
    snprintf(w->scene, sizeof w->scene, "%s", scene);
    keep_settings(w, settings, n_settings);
    w->items = calloc(HN_TUI_ITEMS, sizeof *w->items);
    hn_status status =
        w->items ? load(w, diags) : hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    if (status == HN_OK) {
        choose_methods(w, methods, n_methods);
        status = hn_workbench_record(w, diags);
    }
    if (status == HN_OK) {
        w->versions = hn_versions_create();
        status =
            w->versions ? HN_OK : hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
        hn_versions_keep(w);
    }
    if (status != HN_OK) {
        hn_workbench_close(w);
    }
    return status;
}

void hn_workbench_close(hn_workbench *w) {
    hn_child_stop(&w->child);
    hn_tui_study_free(w->study);
    hn_tui_study_free(w->longer);
    hn_step_trial_free(w->step_trial);
    hn_recording_free(w->recording);
    hn_view_box_free(w);
    hn_model_free(w->model);
    hn_model_free(w->preview.model);
    hn_versions_free(w->versions);
    hn_joint_forces_free(w->forces);
    hn_tui_exercise_free(w->exercise);
    w->exercise = NULL;
    w->forces = NULL;
    hn_strbuf_reset(&w->text);
    hn_strbuf_reset(&w->link);
    free(w->preview.points);
    free(w->drag.points);
    free(w->items);
    cJSON_Delete(w->scenes);
    w->scenes = NULL;
    w->study = w->longer = NULL;
    w->step_trial = NULL;
    w->versions = NULL;
    w->preview = (hn_preview){0};
    w->drag = (hn_tui_drag){0};
    w->recording = NULL;
    w->model = NULL;
    w->items = NULL;
}

void hn_workbench_ask(hn_workbench *w, hn_prompt_kind kind, const char *initial) {
    w->prompt = kind;
    w->n_input = snprintf(w->input, sizeof w->input, "%s", initial);
    w->replaces = w->n_input > 0;
}

void hn_workbench_say(hn_workbench *w, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(w->message, sizeof w->message, format, list);
    va_end(list);
    if (w->form == HN_DOTS_ASCII) {
        hn_strbuf plain;
        hn_strbuf_init(&plain);
        hn_plain_text(&plain, w->message);
        snprintf(w->message, sizeof w->message, "%s", hn_strbuf_text(&plain));
        hn_strbuf_reset(&plain);
    }
}

void hn_workbench_say_fault(hn_workbench *w, const hn_diags *diags) {
    const hn_diag *d = &diags->item[0];
    hn_workbench_say(w, "%s%s%s", diags->n > 0 ? d->message : "that failed, and nothing says why",
                     diags->n > 0 && d->hint[0] ? "; " : "", diags->n > 0 ? d->hint : "");
}

/// Carries over what outlives a change of the scene: how it is shown, the panel, what can be
/// undone.
static void carry_over(hn_workbench *to, hn_workbench *from) {
    to->form = from->form;
    to->pictures = from->pictures;
    to->plot = from->plot;
    to->computes = from->computes;
    to->reactions = from->reactions;
    to->speed = from->speed;
    to->columns = from->columns;
    to->rows = from->rows;
    to->versions = from->versions;
    from->versions = NULL;
    to->exercise = from->exercise;
    from->exercise = NULL;
}

// what was open stays open when the change fails
bool hn_workbench_reopen(hn_workbench *w, const char *scene, const hn_setting *settings,
                         int n_settings, const char *const *methods, int n_methods) {
    hn_workbench fresh;
    hn_diags diags = {0};
    if (hn_workbench_open(&fresh, w->library, scene, settings, n_settings, methods, n_methods,
                          &diags) != HN_OK) {
        hn_workbench_say_fault(w, &diags);
        return false;
    }
    hn_versions_free(fresh.versions);
    fresh.playing = w->playing;
    if (strcmp(scene, w->scene) == 0) {
        memcpy(fresh.study_time, w->study_time, sizeof fresh.study_time);
    }
    carry_over(&fresh, w);
    hn_workbench_close(w);
    *w = fresh;
    // the names moved with the structure
    for (int i = 0; i < w->n_settings; i++) {
        w->settings[i].name = w->setting_names[i];
    }
    hn_versions_keep(w);
    return true;
}

bool hn_workbench_set(hn_workbench *w, const hn_setting *settings, int n_settings) {
    const char *methods[HN_COMPARISON_MAX_METHODS];
    for (int i = 0; i < w->n_methods; i++) {
        methods[i] = w->methods[i];
    }
    return hn_workbench_reopen(w, w->scene, settings, n_settings, methods, w->n_methods);
}

// ---- time ----

int hn_workbench_frame(const hn_workbench *w) {
    const int ready = hn_recording_frames(w->recording) - 1, now = (int)w->clock;
    return now < 0 ? 0 : now > ready ? (ready < 0 ? 0 : ready) : now;
}

/// Opens the joint forces; if they cannot be computed, closes their view and reports the fault.
static void open_forces(hn_workbench *w) {
    const hn_model_source source = hn_workbench_source(w);
    hn_diags diags = {0};
    const hn_status status = hn_joint_forces_create(w->library, &source, &w->forces, &diags);
    if (status != HN_OK) {
        w->reactions = false;
        hn_workbench_say(w, "joint forces: %.200s",
                         diags.n > 0 ? diags.item[0].message : hn_status_text(status));
    }
}

/// Has a reference computed where none is stored: every changed length asks for another one.
static void compute_reference(hn_workbench *w) {
    const hn_model_source source = hn_workbench_source(w);
    hn_diags diags = {0};
    hn_model *model = NULL;
    w->computes = hn_model_load(w->library, &source, &model, &diags) == HN_OK &&
                  hn_recording_compute_reference(w->recording, model);
    if (w->computes && !w->message[0]) {
        hn_workbench_say(w, "%s", COMPUTING);
    }
}

/// Returns whether the trial is that of the selected method.
static bool is_tried(const hn_workbench *w) {
    return w->step_trial &&
           strcmp(hn_step_trial_spelling(w->step_trial), w->methods[w->selected]) == 0;
}

bool hn_workbench_step_report(const hn_workbench *w, hn_step_report *out) {
    if (!is_tried(w)) {
        return false;
    }
    hn_step_trial_judge(w->step_trial, out);
    return out->finding != HN_STEP_UNKNOWN;
}

// the rule of the card says so, and incidents offer what closes the loop
bool hn_workbench_only_drifts(const hn_workbench *w, const char *spelling) {
    static const unsigned cares =
        HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY | HN_TRAIT_PULLS_GAP;
    hn_method_spec spec;
    hn_diag diag = {0};
    return hn_system_get_info(hn_model_system(w->model)).nc > 0 &&
           hn_method_parse(spelling, &spec, &diag) == HN_OK && spec.formulation &&
           !(spec.formulation->traits & cares);
}

/// When the selected method, which is wrong now, went wrong first [s]: what it did stays worst.
static double wrong_since(const hn_workbench *w) {
    int right = 0, wrong = hn_workbench_frame(w);
    while (wrong - right > 1) {
        const int middle = (right + wrong) / 2;
        const bool bad =
            hn_recording_verdict(w->recording, w->selected, middle).tone == HN_TONE_BAD;
        *(bad ? &wrong : &right) = middle;
    }
    return hn_recording_time(w->recording, wrong);
}

/// While the card of a method is open that went on and is wrong: has shorter steps tried.
static void try_steps(hn_workbench *w) {
    const char *spelling = w->methods[w->selected];
    const hn_track *track = hn_recording_track(w->recording, w->selected);
    const int frame = hn_workbench_frame(w);
    if (!w->why || track->model_error || is_tried(w) || strcmp(w->untried, spelling) == 0 ||
        hn_recording_end(w->recording, w->selected).failed || !isfinite(track->error[frame]) ||
        hn_recording_verdict(w->recording, w->selected, frame).tone != HN_TONE_BAD) {
        return;
    }
    if (hn_workbench_only_drifts(w, spelling)) {
        return;
    }
    const hn_model_source source = hn_workbench_source(w);
    hn_diags diags = {0};
    hn_step_trial_free(w->step_trial);
    w->step_trial = NULL;
    const hn_step_trial_request request = {.spelling = spelling, .wrong_at = wrong_since(w)};
    if (hn_step_trial_start(w->library, &source, &request, &w->step_trial, &diags) != HN_OK) {
        memcpy(w->untried, spelling, sizeof w->untried);
    }
}

/// Says how a command ended, and how large the file is that it was to write.
static void end_command(hn_workbench *w) {
    struct stat file;
    // a run that ended early has its reason in the text; a file is then not there
    const bool ended = w->child.status == HN_EXIT_ENDED && !w->writes[0];
    if (w->child.status != HN_EXIT_DONE && !ended) {
        hn_workbench_say(w, "the command failed; its reason is above");
        hn_strbuf_add(&w->text, "\n(failed; Esc goes back)\n");
        return;
    }
    if (w->writes[0] && stat(w->writes, &file) == 0) {
        hn_workbench_say(w, "%.200s: written, %lld bytes", w->writes, (long long)file.st_size);
    }
    hn_strbuf_add(&w->text, "\n(done; Esc goes back)\n");
}

double hn_workbench_moment(const hn_workbench *w) {
    const double dt = hn_recording_frame_dt(w->recording);
    return w->clock == round(w->moment / dt) ? w->moment : w->clock * dt;
}

void hn_workbench_go_to(hn_workbench *w, double t) {
    w->moment = t;
    const double frame = round(t / hn_recording_frame_dt(w->recording));
    w->clock = fmax(0, fmin(frame, hn_recording_last(w->recording)));
    hn_recording_want(w->recording, (int)w->clock + AHEAD);
}

void hn_workbench_tick(hn_workbench *w, double seconds) {
    const int last = hn_recording_last(w->recording);
    if (w->playing && w->panel == HN_PANEL_MAIN) {
        const double ready = hn_recording_frames(w->recording) - 1;
        const double next = w->clock + seconds * w->speed / hn_recording_frame_dt(w->recording);
        // it waits for frames, and does not go back to those that are there
        w->clock = fmin(fmin(next, fmax(w->clock, ready + 0.999)), last);
        w->late = next > w->clock && w->clock < last ? w->late + seconds : 0;
        if (w->clock >= last) {
            w->playing = false;
        }
    }
    // the card of the reasons has remedies tried, which is done at the end of the motion
    hn_recording_want(w->recording, w->why ? last : (int)w->clock + AHEAD);
    hn_recording_update(w->recording);
    hn_view_box_update(w);
    if (strcmp(w->message, COMPUTING) == 0 && !hn_recording_is_asking(w->recording)) {
        w->message[0] = '\0';
    }
    if (w->computes && hn_recording_needs_reference(w->recording)) {
        compute_reference(w);
    }
    if (w->reactions && !w->forces) {
        open_forces(w);
    }
    try_steps(w);
    if (w->child.pid != 0 && !hn_child_read(&w->child, &w->text)) {
        end_command(w);
    }
    if (w->panel == HN_PANEL_LIST && w->list == HN_LIST_SCENES) {
        hn_preview_load(w, w->n_items > 0 ? w->items[w->cursor].name : "");
    }
}
