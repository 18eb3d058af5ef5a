// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/map_grid.h"
#include "session/stability/map_team.h"
#include "session/stability/stability_axes.h"
#include "session/stability/stability_column.h"
#include "session/stability/stability_internal.h"
#include "session/stability/stability_store.h"

#include "base/clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { COARSEST_STRIDE = 8 };
static const double FIRST_SHARE = 0.2; // of the whole progress: a map of steps that may choose one
static const double LEAST_LEFT = 1;    // time limit of the map that it chooses, at least [s]

static void blank(hn_map *map) {
    for (int m = 0; m < map->n_methods; m++) {
        for (int i = 0; i < map->x.n; i++) {
            hn_map_column *c = hn_map_column_at(map, m, i);
            c->stable = c->unstable = c->visible = c->accurate = (double)NAN;
            for (int j = 0; j < map->y.n; j++) {
                hn_map_cell_at(map, m, i, j)->margin = (double)NAN;
            }
        }
    }
}

hn_status hn_map_open(const hn_job_request *request, hn_map **out, hn_diags *diags) {
    hn_map *map = calloc(1, sizeof *map);
    *out = NULL;
    if (!map) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }

    // choose methods, axes and scenes
    map->model = request->models[0];
    map->request = *request;
    hn_status status = hn_map_set_up(map, diags);

    // make room for every cell and column
    if (status == HN_OK) {
        const size_t columns = (size_t)map->n_methods * (size_t)map->x.n;
        map->scenes = calloc((size_t)map->n_scenes, sizeof *map->scenes);
        map->cells = calloc(columns * (size_t)map->y.n, sizeof *map->cells);
        map->columns = calloc(columns, sizeof *map->columns);
        if (!map->scenes || !map->cells || !map->columns) {
            status = hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
        }
    }

    // mark all as not run, then take what an earlier run left in the journal
    if (status == HN_OK) {
        blank(map);
        status = request->limits.folder ? hn_map_open_journal(map, diags) : HN_OK;
    }
    if (status != HN_OK) {
        hn_map_free(map);
        return status;
    }
    *out = map;
    return HN_OK;
}

void hn_map_free(hn_map *map) {
    if (map) {
        hn_journal_end(&map->journal, 0);
        for (int i = 0; map->scenes && i < map->n_scenes; i++) {
            hn_stability_path_free(map->scenes[i].path);
            hn_model_free(map->scenes[i].model);
        }
        free(map->scenes);
        free(map->cells);
        free(map->columns);
        hn_map_free(map->steps);
        free(map);
    }
}

static bool try_cell(hn_map *map, int m, int column, int row) {
    hn_map_cell *cell = hn_map_cell_at(map, m, column, row);
    const hn_method_spec spec = hn_map_spec_at(map, m, column, map->y.value[row]);
    hn_stability_trial trial;
    if (!hn_map_try(map, hn_map_scene_of(map, column, row), &spec, &trial)) {
        return false;
    }
    cell->trial = trial;
    if (trial.kind != HN_STABILITY_PENDING) {
        hn_map_keep_cell(map, m, column, row);
    }
    return true;
}

// rounds ----

// Reports the share of this map's work; a map that another one chose begins where that one ended.
static void report(const hn_map *map, double share) {
    const double whole = map->open_question ? FIRST_SHARE : 1;
    hn_job_progress(&map->request.limits, "", map->share + (whole - map->share) * share);
}

static int count_pending(const hn_map *map) {
    int n = 0;
    for (int k = 0; k < map->n_methods * map->x.n * map->y.n; k++) {
        n += map->cells[k].trial.kind == HN_STABILITY_PENDING;
    }
    return n;
}

static void report_cells(hn_map *map) {
    const double all = (double)map->n_methods * map->x.n * map->y.n;
    report(map, 0.85 * (1 - count_pending(map) / all));
}

// Lists the cells on the grid of this stride that have no outcome yet; returns their number.
static int list_pending(const hn_map *map, int stride, int *cells) {
    int n = 0;
    for (int row = 0; row < map->y.n; row += stride) {
        for (int column = 0; column < map->x.n; column += stride) {
            for (int m = 0; m < map->n_methods; m++) {
                const hn_map_cell *cell = hn_map_cell_at(map, m, column, row);
                if (cell->trial.kind == HN_STABILITY_PENDING) {
                    cells[n++] = (int)(cell - map->cells);
                }
            }
        }
    }
    return n;
}

// Tries these cells, by the team if there is one. Returns 0 when the map must end.
static bool try_cells(hn_map *map, hn_map_team *team, const int *cells, int n) {
    if (team) {
        return hn_map_team_try(team, cells, n, report_cells);
    }
    for (int k = 0; k < n; k++) {
        const int column = cells[k] % map->x.n, row = cells[k] / map->x.n % map->y.n;
        if (hn_map_must_end(map) || !try_cell(map, cells[k] / map->x.n / map->y.n, column, row)) {
            return false;
        }
        report_cells(map);
    }
    return true;
}

// Tries all cells, on coarse grids first. Returns 0 when the map must end.
static bool try_rounds(hn_map *map) {
    int *cells = malloc(((size_t)count_pending(map) + 1) * sizeof *cells);
    hn_map_team *team = cells ? hn_map_team_create(map) : NULL;
    bool going = cells != NULL;
    for (int stride = COARSEST_STRIDE; stride >= 1 && going; stride /= 2) {
        going = try_cells(map, team, cells, list_pending(map, stride, cells));
    }
    hn_map_team_free(team);
    free(cells);
    return going;
}

static bool observe(hn_map *map) {
    for (int i = 0; map->y.is_step && i < map->x.n; i++) {
        for (int m = 0; m < map->n_methods; m++) {
            if (hn_map_must_end(map) || !hn_map_observe_column(map, m, i) ||
                (map->x.n == 1 && !hn_map_observe_accuracy(map, m))) {
                return false;
            }
        }
        report(map, 0.85 + 0.15 * (i + 1) / map->x.n);
    }
    return true;
}

static bool run_one(hn_map *map) {
    map->started = hn_clock_wall();
    map->stopped = map->out_of_time = 0;
    map->left_out = false;
    for (int i = 0; i < map->n_scenes; i++) {
        map->scenes[i].tried &= !map->scenes[i].over;
        if (map->scenes[i].model) {
            hn_graph_go_on(hn_system_graph(hn_model_system(map->scenes[i].model)));
        }
    }
    const bool ended = try_rounds(map) && observe(map);
    map->out_of_time |= ended && map->left_out;
    const bool finished = ended && !map->left_out;
    for (int m = 0; m < map->n_methods; m++) {
        for (int i = 0; i < map->x.n; i++) {
            hn_map_predict_column(map, m, i);
            hn_map_judge_column(map, m, i);
        }
    }
    map->stopped |= !finished && !map->out_of_time;
    map->elapsed += hn_clock_wall() - map->started;
    hn_journal_end(&map->journal, finished);
    return finished;
}

// Opens the map of a preset that the map of steps has chosen, within what is left of its time.
// Returns NULL where none of the methods of the request fits it, or it cannot be opened.
static hn_map *open_telling(const hn_map *map, const char *preset) {
    hn_job_request r = hn_map_request_for(map, preset);
    hn_diags ignored = {0}; // the map of steps is the answer then, and names the preset
    hn_map *telling = NULL;
    if (map->names_methods && r.n_methods == 0) {
        return NULL;
    }
    if (r.limits.time_limit > 0) {
        const double used = hn_clock_wall() - map->started;
        r.limits.time_limit = fmax(r.limits.time_limit - used, LEAST_LEFT);
    }
    return hn_map_open(&r, &telling, &ignored) == HN_OK ? telling : NULL;
}

bool hn_map_run(hn_map *map) {
    // a telling map that goes on has all of the time, not what the map of steps had left
    if (map->steps) {
        map->request.limits.time_limit = map->steps->request.limits.time_limit;
    }

    // the map itself, which may choose another one
    const bool finished = run_one(map);
    const char *preset = finished && map->open_question ? hn_map_telling(map) : NULL;
    hn_map *telling = preset ? open_telling(map, preset) : NULL;
    if (!telling) {
        return finished;
    }

    // the caller's map becomes the telling one, which owns the map of steps
    const hn_map steps = *map;
    *map = *telling;
    *telling = steps;
    map->steps = telling;
    map->steps->chose = true;
    map->share = FIRST_SHARE;
    const bool done = run_one(map);
    map->elapsed += map->steps->elapsed;
    return done;
}

void hn_map_set_time_limit(hn_map *map, double time_limit) {
    hn_map *const first = map->steps ? map->steps : map; // see hn_map_run()
    first->request.limits.time_limit = time_limit;
}

// reading ----

const hn_model *hn_map_model(const hn_map *map) {
    return map->model;
}

const hn_map_axis *hn_map_x(const hn_map *map) {
    return &map->x;
}

const hn_map_axis *hn_map_y(const hn_map *map) {
    return &map->y;
}

const char *hn_map_preset(const hn_map *map) {
    return map->preset;
}

const hn_map *hn_map_steps(const hn_map *map) {
    return map->steps;
}

int hn_map_n_methods(const hn_map *map) {
    return map->n_methods;
}

const char *hn_map_method(const hn_map *map, int m) {
    return map->names[m];
}

const hn_map_cell *hn_map_get(const hn_map *map, int m, int column, int row) {
    return hn_map_cell_at(map, m, column, row);
}

const hn_map_column *hn_map_get_column(const hn_map *map, int m, int column) {
    return hn_map_column_at(map, m, column);
}

double hn_map_time(const hn_map *map) {
    return map->T;
}

bool hn_map_lost(const hn_map *map) {
    return map->journal.failed;
}

int hn_map_resumed(const hn_map *map) {
    return map->resumed;
}

bool hn_map_stopped(const hn_map *map) {
    return map->stopped;
}

bool hn_map_out_of_time(const hn_map *map) {
    return map->out_of_time;
}

double hn_map_elapsed(const hn_map *map) {
    return map->elapsed;
}
