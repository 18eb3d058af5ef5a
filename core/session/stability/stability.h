// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_H
#define HN_SESSION_STABILITY_H
// A map of stability: a grid over two of {a scene's parameters, a method's options, the step size}.
// Each cell is a trial with its class (study/stability/stability.h). The map shows the observed
// boundary and the boundary that the spectrum of the constrained motion predicts. If the
// vertical axis is the step h, the observed boundary of every column is found to 2 %, so that
// prediction and observation can be compared as numbers. Cells are tried in rounds from coarse to
// fine; finished ones are kept in a folder, so that the same request goes on where it was
// interrupted.

#include "session/job/job_request.h"
#include "study/cost/workprecision.h"
#include "study/stability/stability.h"

#include <stdbool.h>

enum { HN_MAP_METHODS = 8, HN_MAP_SIDE = 64, HN_MAP_MODELS = 1024, HN_MAP_CROSSINGS = 4 };
#define HN_MAP_STEPS 2e5 ///< most steps of one trial
#define HN_MAP_REFINED \
    1.02               ///< ratio of the steps between which an observed boundary lies in the end
#define HN_MAP_BELOW 8 ///< steps tried in an octave below a boundary that accuracy sets
#define HN_MAP_ACCURATE_WITHIN 1.1 ///< the same of the largest accurate step
#define HN_MAP_ACCURATE_STEPS 5e4  ///< most steps of a trial for it
#define HN_MAP_TURN 0.2            ///< [rad] in one step: further, no step is accurate
#define HN_MAP_AGREES 0.05         ///< relative difference of boundaries that agree
#define HN_MAP_CELL_SECONDS 5      ///< computing time of one trial

typedef struct hn_map hn_map;

#define HN_MAP_FIRST "limits" ///< the preset of a request that names none; hn_map_run() may go on

/// Axes of a map by name: maker of the axes, name, about, chooses, stabilised, units
/// (hn_job_preset).
#define HN_MAP_PRESETS(X)                                                                          \
    X(param_axes, "stiffness", "the step and a stiffness of the scene", "h", false, "N/m N*m/rad") \
    X(param_axes, "mass-ratio", "the step and a mass of the scene", "h", false, "kg")              \
    X(baumgarte_axes, "baumgarte", "alpha and beta of Baumgarte's method, at one step",            \
      "alpha beta", true, "")                                                                      \
    X(limit_axes, "limits", "the step, doubled until each method fails", "h", false, "")

typedef struct hn_map_axis {
    char name[64]; ///< "h", "alpha", a parameter's; "" of a map with one column
    char unit[24];
    int is_param, is_step, is_log;
    int n;
    double value[HN_MAP_SIDE]; ///< rising
} hn_map_axis;

typedef struct hn_map_cell {
    hn_stability_trial trial;
    double margin; ///< h / predicted limit: above 1 unstable; NaN: nothing is predicted
} hn_map_cell;

/// Boundaries of one column of one method, predicted and observed.
typedef struct hn_map_column {
    int n_predicted;
    double predicted
        [HN_MAP_CROSSINGS]; ///< places on the vertical axis; one of a step may lie outside it
    double turn; ///< step axis: what one step at the first predicted limit moves the mechanism by,
                 ///< largest rate of a coordinate times the limit [rad, or lengths]
    double visible; ///< step axis: growth is seen from here on within a trial [s]
    double stable,
        unstable;    ///< step axis: the boundary observed lies between; NaN: not on the map.
                     ///< Not stiff, one column: `unstable` is the smallest step that failed
    double accurate; ///< map of one column: largest step whose error, and that of every smaller one
                     ///< tried, is at most HN_STABILITY_ACCURATE [s]; 0: none; NaN: not known
    char how[HN_STABILITY_REASON]; ///< how the run at `unstable` ended
    enum {
        HN_MAP_UNTOLD, ///< no prediction, or no observation to compare it with
        HN_MAP_AGREE,
        HN_MAP_UNSEEN,  ///< beyond the predicted limit growth is too slow for the trial
        HN_MAP_EARLIER, ///< observed at a smaller step than predicted
        HN_MAP_LATER
    } verdict;
} hn_map_column;

/// Agreement of prediction and observation of one method: columns where the vertical axis is a
/// step, cells otherwise.
typedef struct hn_map_agreement {
    int by_columns, compared, agree, unseen, earlier, later;
    const char *why; ///< why nothing could be compared; NULL otherwise
} hn_map_agreement;

/// Checks the request and takes up what an interrupted map of the same request left.
///
/// request  in  one model, the scene as it is, and `load` for the scene with other parameters;
///              methods: those that fit the axes where it has none; time: the scene's, shortened
///              where the smallest step would take too many; time limit: 60 s where it has none.
///              Values: "preset" or "over" ("h=1e-4..1e-1,k=1e2..1e8", each with ":lin" or ":log"
///              behind it if wanted), "columns" and "rows" (24).
/// Returns owned in *out. The model and the texts of the request must outlive the map.
/// Fails:   HN_ERR_INPUT, HN_ERR_LIMIT, HN_ERR_MEMORY, HN_ERR_IO. All reported in diags.
HN_MUST_CHECK hn_status hn_map_open(const hn_job_request *request, hn_map **out, hn_diags *diags);
void hn_map_free(hn_map *map); ///< NULL is legal
/// Runs the cells that have no outcome. Returns whether finished; false: stopped, or out of time.
///
/// A request that names neither a preset nor axes gets the map of steps, HN_MAP_FIRST. If that
/// finds a mechanism with loops that is not stiff, the map becomes the one of the preset that is
/// telling for it, hn_map_telling(), and the map of steps stays in hn_map_steps(). Methods that the
/// request names are taken where they have the options of that preset; where none has them, the map
/// of steps is the answer.
///
/// May be called again: it goes on with the cells that are left, and has its whole time limit
/// again.
bool hn_map_run(hn_map *map);
/// Sets the wall time that each later run has [s]; 0: no limit.
void hn_map_set_time_limit(hn_map *map, double time_limit);

/// Borrowed: what the map was computed for, its axes, and how many methods it has.
const hn_model *hn_map_model(const hn_map *map);
const hn_map_axis *hn_map_x(const hn_map *map);
const hn_map_axis *hn_map_y(const hn_map *map);
int hn_map_n_methods(const hn_map *map);
/// Borrowed: the preset of the axes; NULL: they were named one by one.
const char *hn_map_preset(const hn_map *map);
/// Borrowed: the map of steps that chose this one; NULL: the request chose it.
const hn_map *hn_map_steps(const hn_map *map);
/// HN_MAP_STIFF: some column has a predicted limit at which one step moves the mechanism by less
/// than HN_MAP_TURN. HN_MAP_NOT_STIFF: none has, and the error of a step decides and not its
/// stability. HN_MAP_STIFF_UNKNOWN: no column has a limit of the step.
typedef enum hn_map_stiffness {
    HN_MAP_STIFF_UNKNOWN,
    HN_MAP_NOT_STIFF,
    HN_MAP_STIFF
} hn_map_stiffness;
hn_map_stiffness hn_map_is_stiff(const hn_map *map);
/// The preset whose map tells more about a mechanism with loops that is not stiff; NULL: this one.
const char *hn_map_telling(const hn_map *map);
/// Returns the spelling of method m without the options that the axes set.
const char *hn_map_method(const hn_map *map, int m);
const hn_map_cell *hn_map_get(const hn_map *map, int m, int column, int row);
const hn_map_column *hn_map_get_column(const hn_map *map, int m, int column);
double hn_map_time(const hn_map *map);
bool hn_map_lost(const hn_map *map); ///< the journal could not be written
int hn_map_resumed(const hn_map *map);
bool hn_map_stopped(const hn_map *map), hn_map_out_of_time(const hn_map *map);
double hn_map_elapsed(const hn_map *map); ///< wall time of all runs [s]

// documents
#endif
