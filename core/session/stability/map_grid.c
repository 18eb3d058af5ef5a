// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/map_grid.h"

#include "base/clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

// The motion of a scene may take this share of the time limit: a small one where there are other
// scenes, unless it was cut short before. Without a limit it may take PATH_SECONDS [s] of computing
// time.
static const double PATH_SHARE = 0.1, ONLY_SHARE = 0.5, PATH_SECONDS = 5;

hn_map_cell *hn_map_cell_at(const hn_map *map, int m, int column, int row) {
    return &map->cells[(m * map->y.n + row) * map->x.n + column];
}

hn_map_column *hn_map_column_at(const hn_map *map, int m, int column) {
    return &map->columns[m * map->x.n + column];
}

static int ask_to_stop(void *user) {
    return hn_map_must_end(user);
}

static hn_status load_scene(hn_map *map, hn_map_scene *s, int column, int row, hn_diags *diags) {
    hn_setting settings[2];
    int n = 0;
    if (s->model) {
        return HN_OK; // since a run that was stopped
    }
    if (map->x.is_param) {
        settings[n++] = (hn_setting){map->x.name, map->x.value[column]};
    }
    if (map->y.is_param) {
        settings[n++] = (hn_setting){map->y.name, map->y.value[row]};
    }
    return n ? map->request.load(map->request.load_user, settings, n, &s->model, diags) : HN_OK;
}

static double path_seconds(const hn_map *map, const hn_map_scene *s) {
    const double limit = map->request.limits.time_limit;
    const double share = map->n_scenes == 1 || s->over ? ONLY_SHARE : PATH_SHARE;
    return limit > 0 ? share * limit : PATH_SECONDS;
}

static void make_scene(hn_map *map, hn_map_scene *s, int column, int row) {
    hn_diags diags = {0};
    hn_diag diag = {0};
    const hn_walk_limits limits = {path_seconds(map, s), ask_to_stop, map};
    const hn_status loaded = load_scene(map, s, column, row, &diags);
    hn_status status = loaded;
    if (status != HN_OK && diags.n > 0) {
        diag = diags.item[0];
    }
    if (status == HN_OK) {
        const hn_model *model = s->model ? s->model : map->model;
        status = hn_stability_path_create(hn_model_system(model), hn_model_q(model),
                                          hn_model_v(model), map->T, &limits, &s->path, &diag);
    }
    if (status != HN_OK) {
        snprintf(s->why, sizeof s->why, "no motion to compare with: %.200s",
                 diag.message[0] ? diag.message : hn_status_text(status));
    }

    // equations that were not made to the end say nothing of the motion
    map->stopped |= loaded == HN_ERR_STOPPED ||
                    hn_system_was_stopped(hn_model_system(s->model ? s->model : map->model));
    s->tried = !map->stopped && !map->out_of_time;

    // a motion that was cut short leaves its cells for a run that goes on
    s->over = s->tried && status == HN_ERR_STOPPED;
    map->left_out |= s->over;
}

hn_map_scene *hn_map_scene_of(hn_map *map, int column, int row) {
    const int at = (map->y.is_param ? row : 0) * (map->x.is_param ? map->x.n : 1) +
                   (map->x.is_param ? column : 0);
    hn_map_scene *s = &map->scenes[at];
    // a map that was stopped begins no new motion
    if (!s->tried && !s->path && !map->stopped && !map->out_of_time) {
        make_scene(map, s, column, row);
    }
    return s;
}

hn_method_spec hn_map_spec_at(const hn_map *map, int m, int column, double y) {
    hn_method_spec spec = map->specs[m];
    if (map->x.name[0] && !map->x.is_param) {
        *hn_method_find_option(&spec, map->x.name, NULL) = map->x.value[column];
    }
    if (!map->y.is_param) {
        *hn_method_find_option(&spec, map->y.name, NULL) = y;
    }
    return spec;
}

bool hn_map_must_end(hn_map *map) {
    const double limit = map->request.limits.time_limit;
    map->stopped |= hn_job_must_stop(&map->request.limits);
    map->out_of_time |= limit > 0 && hn_clock_wall() - map->started > limit;
    return map->stopped || map->out_of_time;
}

bool hn_map_try(hn_map *map, hn_map_scene *scene, const hn_method_spec *spec,
                hn_stability_trial *out) {
    const hn_walk_limits limits = {HN_MAP_CELL_SECONDS, ask_to_stop, map};
    if (!scene->path) {
        *out = scene->over ? (hn_stability_trial){.kind = HN_STABILITY_PENDING}
                           : (hn_stability_trial){.kind = HN_STABILITY_REFUSED,
                                                  .status = HN_ERR_UNSUPPORTED};
        snprintf(out->reason, sizeof out->reason, "%s", scene->why);
        return scene->tried;
    }
    return hn_stability_try(scene->path, spec, &limits, out);
}
