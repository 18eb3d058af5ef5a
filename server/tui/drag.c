// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/drag.h"

#include "session/model/drag_json.h"
#include "tui/mechanism_view.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Cells between the mouse and a point that is still taken hold of.
static const double REACH = 2.5;
static const double SECONDS = 0.02; // of computing, for one move of the mouse

/// The middle of a cell in the plane of the view [m].
static void plane_of(const hn_workbench *w, hn_area area, int x, int y, double out[2]) {
    const hn_placing p = hn_mechanism_place(w, area);
    out[0] = ((x - area.x + 0.5) * HN_DOTS_ACROSS - p.x) / p.across;
    out[1] = (p.y - (y - area.y + 0.5) * HN_DOTS_DOWN) / p.down;
}

/// The points of the selected method now, or of the mechanism that is dragged.
static const double *points_now(const hn_workbench *w) {
    const size_t n = 3 * (size_t)hn_system_get_info(hn_model_system(w->model)).n_points;
    return w->drag.points ? w->drag.points
                          : hn_recording_track(w->recording, w->selected)->points +
                                (size_t)hn_workbench_frame(w) * n;
}

/// The point nearest to a place in the plane; -1: none within reach.
static int point_near(const hn_workbench *w, hn_area area, const double at[2]) {
    const hn_placing p = hn_mechanism_place(w, area);
    const int n = hn_system_get_info(hn_model_system(w->model)).n_points;
    const double *points = points_now(w);
    double best = REACH * HN_DOTS_DOWN / p.down;
    int nearest = -1;
    for (int i = 0; i < n; i++) {
        double plane[2];
        hn_view_project(&w->envelope.look, points + 3 * i, plane);
        const double d = hypot(plane[0] - at[0], plane[1] - at[1]);
        if (d < best) {
            best = d;
            nearest = i;
        }
    }
    return nearest;
}

static void forget(hn_workbench *w) {
    free(w->drag.points);
    w->drag = (hn_tui_drag){0};
}

void hn_drag_begin(hn_workbench *w, hn_area area, int x, int y) {
    double at[2];
    forget(w);
    plane_of(w, area, x, y, at);
    const int point = point_near(w, area, at);
    if (point >= 0) {
        w->drag.on = true;
        w->drag.point = point;
        w->playing = false;
    }
}

// ---- the way ----

/// Finds where the held point should be: it moves in the plane of the view.
static void target_of(const hn_workbench *w, const double at[2], double out[3]) {
    const hn_view *look = &w->envelope.look;
    const double *from = points_now(w) + 3 * w->drag.point;
    double plane[2];
    hn_view_project(look, from, plane);
    for (int i = 0; i < 3; i++) {
        out[i] = from[i] + (at[0] - plane[0]) * look->right[i] + (at[1] - plane[1]) * look->up[i];
    }
}

static void take_state(hn_tui_drag *d, const cJSON *state) {
    const cJSON *one;
    d->n_state = 0;
    cJSON_ArrayForEach(one, state) {
        if (d->n_state < HN_TUI_SETTINGS) {
            snprintf(d->names[d->n_state], sizeof d->names[0], "%s", one->string);
            d->state[d->n_state++] = one->valuedouble;
        }
    }
}

static void take_points(hn_tui_drag *d, const cJSON *points) {
    const cJSON *one;
    double *fresh = calloc((size_t)cJSON_GetArraySize(points) + 1, sizeof *fresh);
    int n = 0;
    cJSON_ArrayForEach(one, points) {
        if (fresh) {
            fresh[n++] = one->valuedouble;
        }
    }
    if (fresh) {
        free(d->points);
        d->points = fresh;
    }
}

/// Takes the answer: a point is held back only from a few cells on: nobody hits a circle within
/// one.
static void take_answer(hn_workbench *w, hn_area area, const char *text) {
    const hn_placing p = hn_mechanism_place(w, area);
    cJSON *answer = cJSON_Parse(text);
    const char *reason = cJSON_GetStringValue(cJSON_GetObjectItem(answer, "reason"));
    take_state(&w->drag, cJSON_GetObjectItem(answer, "state"));
    take_points(&w->drag, cJSON_GetObjectItem(answer, "points"));
    const cJSON *distance = cJSON_GetObjectItem(answer, "distance");
    const bool far = distance && distance->valuedouble > REACH * HN_DOTS_DOWN / p.down;
    snprintf(w->drag.held, sizeof w->drag.held, "%s", reason && far ? reason : "");
    w->drag.moved = true;
    cJSON_Delete(answer);
}

void hn_drag_move(hn_workbench *w, hn_area area, int x, int y) {
    hn_state_entry from[HN_TUI_SETTINGS];
    double at[2], target[3];
    if (!w->drag.on) {
        return;
    }
    plane_of(w, area, x, y, at);
    target_of(w, at, target);
    for (int i = 0; i < w->drag.n_state; i++) {
        from[i] = (hn_state_entry){w->drag.names[i], w->drag.state[i]};
    }
    const hn_drag_request request = {.from = from,
                                     .n_from = w->drag.n_state,
                                     .point = w->drag.point,
                                     .target = target,
                                     .n_target = w->envelope.spatial ? 3 : 2,
                                     .seconds = SECONDS};

    // the last closed configuration stays where there is none nearer
    hn_strbuf answer;
    hn_diags diags = {0};
    hn_strbuf_init(&answer);
    if (hn_model_drag_json(&answer, w->model, &request, &diags) == HN_OK) {
        take_answer(w, area, hn_strbuf_text(&answer));
    } else if (diags.n > 0) {
        snprintf(w->drag.held, sizeof w->drag.held, "%s", diags.item[0].message);
    }
    hn_strbuf_reset(&answer);
    hn_workbench_say(w, "%s", w->drag.held[0] ? w->drag.held : "let go: the methods start here");
}

/// The settings without their start, then the start of the drag.
static int settings_with_start(const hn_workbench *w, hn_setting *out, char (*names)[80]) {
    int n = 0;
    for (int i = 0; i < w->n_settings; i++) {
        if (strncmp(w->settings[i].name, "start.", 6) != 0) {
            out[n++] = w->settings[i];
        }
    }
    for (int i = 0; i < w->drag.n_state; i++) {
        snprintf(names[i], sizeof names[i], "start.%s", w->drag.names[i]);
        out[n++] = (hn_setting){names[i], w->drag.state[i]};
    }
    return n;
}

void hn_drag_end(hn_workbench *w) {
    hn_setting settings[2 * HN_TUI_SETTINGS];
    char names[HN_TUI_SETTINGS][80];
    if (!w->drag.on) {
        return;
    }
    const bool moved = w->drag.moved;
    const int n = moved ? settings_with_start(w, settings, names) : 0;
    if (n > HN_TUI_SETTINGS) {
        hn_workbench_say(w, "this scene has %d starts and changed parameters; %d can be kept", n,
                         HN_TUI_SETTINGS);
    } else if (moved && hn_workbench_set(w, settings, n)) {
        w->playing = false;
        hn_workbench_say(w, "all methods start here now; Space runs, z takes it back");
    }
    forget(w);
}
