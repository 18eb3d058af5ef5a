// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_INTERNAL_H
#define HN_SESSION_STABILITY_INTERNAL_H
// The state of a map, shared by stability.c (opening and running), stability_axes.c (request),
// stability_column.c (boundaries), stability_store.c (journal) and the writers of documents.

#include "session/stability/stability.h"
#include "session/store/journal.h"

#include <stdbool.h>

/// One scene of the map with its motion; made when a cell first needs it.
typedef struct hn_map_scene {
    hn_model *model; ///< owned; NULL: the map's own model, or none
    hn_stability_path *path;
    int tried;
    bool over;                     ///< its motion was cut short by its share of the time limit
    char why[HN_STABILITY_REASON]; ///< why there is no motion to compare with
} hn_map_scene;

struct hn_map {
    const hn_model *model;
    hn_job_request request; ///< time limit filled in
    const char *preset;     ///< NULL: `over`
    const char *over;
    bool names_methods;    ///< the request does
    bool open_question;    ///< the request names neither a preset nor axes
    bool chose;            ///< this is the map of steps that chose another one
    hn_map *steps;         ///< owned: the map of steps that chose this one; NULL: none
    double share;          ///< of the whole job that was done before this map
    int n_columns, n_rows; ///< asked for
    hn_map_axis x, y;
    int n_methods;
    hn_method_spec specs[HN_MAP_METHODS];
    char names[HN_MAP_METHODS][HN_SPEC_MAX];
    double T;
    bool shortens; ///< a preset may shorten T: the request has no end of its own
    int n_scenes;
    hn_map_scene *scenes;
    hn_map_cell *cells; ///< method, row, column
    hn_map_column *columns;
    hn_stability_forecast forecasts[HN_MAP_METHODS]; ///< the last made, for reasons
    int resumed, stopped, out_of_time;
    bool left_out; ///< cells wait for a motion that was cut short: see hn_map_scene
    double elapsed, started;
    hn_journal journal;
};

#endif
