// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/stability_column.h"

#include "session/stability/map_grid.h"
#include "session/stability/stability_internal.h"
#include "session/stability/stability_store.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double WITHIN =
    0.95; // of a margin of 1: cells closer to the boundary are not compared

// a trial of fewer steps does not show whether they are stable
enum { LEAST_IN_TRIAL = 10 };

// the prediction ----

// Returns log(h / limit), bounded, so that limits of 0 and infinity can be interpolated.
static double log_margin(double margin) {
    return margin > 0 ? fmax(-40, fmin(40, log(margin))) : -40;
}

static double steps_of(const hn_map *map, double h) {
    return fmax(HN_STABILITY_LEAST_STEPS, map->T / h);
}

static void predict_steps(hn_map *map, int m, int column) {
    hn_map_column *c = hn_map_column_at(map, m, column);
    const hn_map_scene *scene = hn_map_scene_of(map, column, 0);
    if (!scene->path) {
        return;
    }

    // a first forecast for the limit, then one over the steps of a run at it
    const hn_method_spec spec = hn_map_spec_at(map, m, column, map->y.value[0]);
    hn_stability_forecast f = hn_stability_predict(scene->path, &spec, 1);
    if (isfinite(f.limit) && f.limit > 0) {
        f = hn_stability_predict(scene->path, &spec, (long long)steps_of(map, f.limit));
    }

    // what is drawn: the limit, and where it lies beside each step
    map->forecasts[m] = f;
    c->visible = f.visible;
    c->turn = f.limit * hn_stability_path_rate(scene->path);
    if (isfinite(f.limit)) {
        c->predicted[c->n_predicted++] = f.limit;
    }

    for (int j = 0; j < map->y.n; j++) {
        hn_map_cell_at(map, m, column, j)->margin =
            f.limit > 0 ? map->y.value[j] / f.limit : HUGE_VAL;
    }
}

// where the margin passes 1 between two rows, in the axis' own scale
static void find_crossings(hn_map *map, int m, int column) {
    hn_map_column *c = hn_map_column_at(map, m, column);
    for (int j = 0; j + 1 < map->y.n; j++) {
        const double a = hn_map_cell_at(map, m, column, j)->margin,
                     b = hn_map_cell_at(map, m, column, j + 1)->margin;
        const double low = log_margin(a), high = log_margin(b);
        if (isnan(a) || isnan(b) || (low > 0) == (high > 0) || c->n_predicted == HN_MAP_CROSSINGS) {
            continue;
        }
        const double share = low / (low - high), y0 = map->y.value[j], y1 = map->y.value[j + 1];
        c->predicted[c->n_predicted++] =
            map->y.is_log ? y0 * pow(y1 / y0, share) : y0 + (y1 - y0) * share;
    }
}

static void predict_cells(hn_map *map, int m, int column) {
    for (int j = 0; j < map->y.n; j++) {
        const hn_map_scene *scene = hn_map_scene_of(map, column, j);
        if (!scene->path) {
            continue;
        }
        const hn_method_spec spec = hn_map_spec_at(map, m, column, map->y.value[j]);
        const hn_stability_forecast f = hn_stability_predict(scene->path, &spec, 1);
        const double h = hn_method_option(&spec, "h", (double)NAN);
        map->forecasts[m] = f;
        hn_map_cell_at(map, m, column, j)->margin = f.limit > 0 ? h / f.limit
                                                    : f.why     ? (double)NAN
                                                                : HUGE_VAL;
    }
    find_crossings(map, m, column);
}

void hn_map_predict_column(hn_map *map, int m, int column) {
    hn_map_column_at(map, m, column)->n_predicted = 0;
    hn_map_column_at(map, m, column)->turn = (double)NAN;
    if (map->y.is_step) {
        predict_steps(map, m, column);
    } else {
        predict_cells(map, m, column);
    }
}

// the observation ----

static bool is_over(hn_stability_class kind) {
    return kind == HN_STABILITY_GREW || kind == HN_STABILITY_STOPPED;
}

/// Tries one step size of a column. Returns 0 when stopped. `over`: 1 unstable, 0 stable, -1 no
/// observation.
static bool try_step(hn_map *map, int m, int column, int row, double h, int *over,
                     hn_map_column *c) {
    hn_stability_trial trial;
    const hn_method_spec spec = hn_map_spec_at(map, m, column, h);
    if (!hn_map_try(map, hn_map_scene_of(map, column, row), &spec, &trial)) {
        return false;
    }
    *over = hn_stability_is_stable(trial.kind) ? 0 : is_over(trial.kind) ? 1 : -1;
    if (*over == 1) {
        snprintf(c->how, sizeof c->how, "%s", trial.reason);
    }
    return true;
}

/// Searches beyond the ends of a single column: halves or doubles the step until the boundary lies
/// between two steps, or a trial would take too many or too few. Returns 0 when stopped.
static bool search_beyond(hn_map *map, int m, double *low, double *high, hn_map_column *c) {
    int over = isinf(*high) ? 0 : 1;
    while (over == 1 && *low == 0 && map->T / (*high / 2) <= HN_MAP_STEPS) {
        const double h = *high / 2;
        if (!try_step(map, m, 0, 0, h, &over, c)) {
            return false;
        }
        *(over == 1 ? high : low) = over >= 0 ? h : *low;
    }
    while (over == 0 && isinf(*high) && 2 * *low <= map->T / LEAST_IN_TRIAL) {
        const double h = 2 * *low;
        if (!try_step(map, m, 0, map->y.n - 1, h, &over, c)) {
            return false;
        }
        *(over == 1 ? high : low) = over >= 0 ? h : *low;
    }
    return true;
}

/// Halves the interval between a stable and an unstable step until it is narrow, or a trial there
/// observes nothing. Returns false when stopped.
static bool narrow(hn_map *map, int m, int column, int row, double *low, double *high,
                   hn_map_column *c) {
    while (*low > 0 && *high / *low > HN_MAP_REFINED) {
        const double middle = sqrt(*low * *high);
        int over;
        if (!try_step(map, m, column, row, middle, &over, c)) {
            return false;
        }
        if (over < 0) {
            break; // no observation there
        }
        *(over ? high : low) = middle;
    }
    return true;
}

/// Looks below a boundary that accuracy sets, and not stability: there, some steps fail and larger
/// ones do not. Tries smaller and smaller steps until an octave of them in a row is stable, and
/// moves the boundary below the smallest that failed. Returns false when stopped.
static bool search_below(hn_map *map, int m, int column, double *low, double *high,
                         hn_map_column *c) {
    hn_map_predict_column(map, m, column);
    const double limit = c->n_predicted ? c->predicted[0] : (double)NAN;
    const bool is_accuracy = map->x.n == 1 && c->turn >= HN_MAP_TURN && *low > 0 &&
                             fabs(sqrt(*low * *high) / limit - 1) > HN_MAP_AGREES;
    const double finer = pow(2, -1.0 / HN_MAP_BELOW);
    double last = *low;
    for (int stable = 0; is_accuracy && stable < HN_MAP_BELOW; stable++) {
        const double h = last * finer;
        int over;
        if (map->T / h > HN_MAP_STEPS) {
            break;
        }
        if (!try_step(map, m, column, 0, h, &over, c)) {
            return false;
        }
        if (over < 0) {
            break; // no observation there
        }
        if (over) {
            *high = h;
            stable = -1;
        }
        *low = over ? 0 : *low > 0 ? *low : h;
        last = h;
    }
    return narrow(map, m, column, 0, low, high, c);
}

bool hn_map_observe_column(hn_map *map, int m, int column) {
    hn_map_column *c = hn_map_column_at(map, m, column);
    if (!isnan(c->unstable)) {
        return true; // found by an earlier run
    }

    // the boundary lies between two rows, or beyond an end of the column
    int j = 0;
    while (j < map->y.n && hn_stability_is_stable(hn_map_cell_at(map, m, column, j)->trial.kind)) {
        j++;
    }
    if (j < map->y.n && !is_over(hn_map_cell_at(map, m, column, j)->trial.kind)) {
        return true; // no observation there
    }
    double low = j > 0 ? map->y.value[j - 1] : 0, high = j < map->y.n ? map->y.value[j] : HUGE_VAL;
    if (j < map->y.n) {
        snprintf(c->how, sizeof c->how, "%s", hn_map_cell_at(map, m, column, j)->trial.reason);
    }
    if (map->x.n == 1 && !search_beyond(map, m, &low, &high, c)) {
        return false;
    }
    if (isinf(high)) {
        return true; // stable throughout
    }

    // halve the interval until it is narrow
    const int row = j < map->y.n ? j : map->y.n - 1;
    if (!narrow(map, m, column, row, &low, &high, c) ||
        !search_below(map, m, column, &low, &high, c)) {
        return false;
    }
    c->stable = low;
    c->unstable = high;
    hn_map_keep_column(map, m, column);
    return true;
}

/// Tries one step of method m; `accurate`: 1 its error is small, 0 it is not, -1 no observation.
/// Returns false when stopped.
static bool try_accuracy(hn_map *map, int m, double h, int *accurate) {
    hn_stability_trial trial;
    const hn_method_spec spec = hn_map_spec_at(map, m, 0, h);
    if (!hn_map_try(map, hn_map_scene_of(map, 0, 0), &spec, &trial)) {
        return false;
    }
    *accurate = trial.kind == HN_STABILITY_FINE                             ? 1
                : hn_stability_is_stable(trial.kind) || is_over(trial.kind) ? 0
                                                                            : -1;
    return true;
}

/// The steps of the axis between which accuracy ends: `low` 0 where it ends below the axis, `high`
/// its last step where it does not end. Returns false where the first cell that is not accurate
/// tells nothing.
static bool find_accuracy(hn_map *map, int m, double *low, double *high) {
    int j = 0;
    while (j < map->y.n && hn_map_cell_at(map, m, 0, j)->trial.kind == HN_STABILITY_FINE) {
        j++;
    }
    const int end = j < map->y.n ? j : map->y.n - 1;
    const hn_stability_class kind = hn_map_cell_at(map, m, 0, end)->trial.kind;
    *low = j > 0 ? map->y.value[j - 1] : 0;
    *high = map->y.value[end];
    return hn_stability_is_stable(kind) || is_over(kind);
}

bool hn_map_observe_accuracy(hn_map *map, int m) {
    hn_map_column *c = hn_map_column_at(map, m, 0);
    double low, high;
    int accurate = 0;
    if (!isnan(c->accurate) || !find_accuracy(map, m, &low, &high)) {
        return true; // found by an earlier run, or no observation
    }

    // below the axis, as long as a trial takes no more than its steps
    while (low == 0 && accurate == 0 && 2 * map->T / high <= HN_MAP_ACCURATE_STEPS) {
        const double h = high / 2;
        if (!try_accuracy(map, m, h, &accurate)) {
            return false;
        }
        *(accurate == 1 ? &low : &high) = h;
    }

    // halve the interval until it is narrow
    while (low > 0 && accurate >= 0 && high / low > HN_MAP_ACCURATE_WITHIN) {
        const double middle = sqrt(low * high);
        if (!try_accuracy(map, m, middle, &accurate)) {
            return false;
        }
        *(accurate == 1 ? &low : &high) = middle;
    }
    c->accurate = low;
    hn_map_keep_accuracy(map, m);
    return true;
}

void hn_map_judge_column(hn_map *map, int m, int column) {
    hn_map_column *c = hn_map_column_at(map, m, column);
    const double limit = c->n_predicted ? c->predicted[0] : (double)NAN;
    c->verdict = HN_MAP_UNTOLD;

    // compare only where the limit is on the axis, or the search found a boundary
    const bool inside = limit >= map->y.value[0] && limit <= map->y.value[map->y.n - 1];
    const bool found = c->stable > 0 && isfinite(c->unstable); // wherever the search ended
    if (!map->y.is_step || !(limit > 0) || (!inside && !found)) {
        return;
    }

    // where the boundary was measured; unstable is NaN where none was found
    const double seen = isnan(c->unstable) ? HUGE_VAL : sqrt(c->stable * c->unstable);
    const int never =
        isnan(c->unstable) &&
        !hn_stability_is_stable(hn_map_cell_at(map, m, column, map->y.n - 1)->trial.kind);
    if (never) {
        return; // the column has cells that were not tried
    }

    // compare it with the prediction
    if (fabs(seen / limit - 1) <= HN_MAP_AGREES) {
        c->verdict = HN_MAP_AGREE;
    } else if (seen < limit) {
        c->verdict = HN_MAP_EARLIER;
    } else {
        c->verdict =
            c->visible > limit * (1 + HN_MAP_AGREES) && seen <= c->visible * (1 + HN_MAP_AGREES)
                ? HN_MAP_UNSEEN
                : HN_MAP_LATER;
    }
}

// agreement ----

static void count_columns(const hn_map *map, int m, hn_map_agreement *a) {
    for (int i = 0; i < map->x.n; i++) {
        const hn_map_column *c = hn_map_column_at(map, m, i);
        a->compared += c->verdict != HN_MAP_UNTOLD;
        a->agree += c->verdict == HN_MAP_AGREE;
        a->unseen += c->verdict == HN_MAP_UNSEEN;
        a->earlier += c->verdict == HN_MAP_EARLIER;
        a->later += c->verdict == HN_MAP_LATER;
    }
}

static void count_cells(const hn_map *map, int m, hn_map_agreement *a) {
    for (int i = 0; i < map->x.n; i++) {
        for (int j = 0; j < map->y.n; j++) {
            const hn_map_cell *cell = hn_map_cell_at(map, m, i, j);
            const int over = is_over(cell->trial.kind),
                      stable = hn_stability_is_stable(cell->trial.kind);
            const int beyond = cell->margin > 1 / WITHIN, below = cell->margin < WITHIN;
            if ((!over && !stable) || (!beyond && !below)) {
                continue;
            }
            a->compared++;
            a->agree += over == beyond;
            a->earlier += over && below;
            a->later += stable && beyond;
        }
    }
}

hn_map_agreement hn_map_agrees(const hn_map *map, int m) {
    hn_map_agreement a = {.by_columns = map->y.is_step, .why = map->forecasts[m].why};
    if (a.by_columns) {
        count_columns(map, m, &a);
    } else {
        count_cells(map, m, &a);
    }
    if (a.compared == 0 && !a.why && map->n_scenes == 1 && !map->scenes[0].path &&
        map->scenes[0].why[0]) {
        a.why =
            map->out_of_time
                ? "the time limit ended the study before the motion to compare with was computed"
                : map->scenes[0].why;
    }
    if (a.compared == 0 && !a.why) {
        const hn_map_column *c = hn_map_column_at(map, m, 0);
        a.why = map->x.n == 1 && c->stable == 0
                    ? "no step was stable, down to the smallest that a trial may take"
                    : "this map contains no boundary that was both predicted and tried";
    }
    a.why = a.compared ? NULL : a.why;
    return a;
}

/// The first cell that ended though its margin is below the boundary.
static void put_first_earlier_cell(hn_strbuf *b, const hn_map *map, int m) {
    for (int j = 0; j < map->y.n; j++) {
        for (int i = 0; i < map->x.n; i++) {
            const hn_map_cell *cell = hn_map_cell_at(map, m, i, j);
            if (is_over(cell->trial.kind) && cell->margin < WITHIN) {
                hn_strbuf_printf(b, ", as at %s = %.4g, %s = %.4g", map->x.name, map->x.value[i],
                                 map->y.name, map->y.value[j]);
                return;
            }
        }
    }
}

/// Writes how the first column ended that became unstable before the prediction.
static void put_first_earlier(hn_strbuf *b, const hn_map *map, int m) {
    for (int i = 0; i < map->x.n; i++) {
        const hn_map_column *c = hn_map_column_at(map, m, i);
        if (c->verdict == HN_MAP_EARLIER) {
            hn_strbuf_add(b, ", as ");
            if (map->x.name[0]) {
                hn_strbuf_printf(b, "at %s = %.4g ", map->x.name, map->x.value[i]);
            }
            hn_strbuf_printf(b, "from h = %.3g s on, %.2g times the predicted limit: %s",
                             c->unstable, c->unstable / c->predicted[0], c->how);
            return;
        }
    }
}

hn_map_stiffness hn_map_is_stiff(const hn_map *map) {
    if (map->steps) {
        return hn_map_is_stiff(map->steps);
    }
    hn_map_stiffness found = HN_MAP_STIFF_UNKNOWN;
    for (int m = 0; map->y.is_step && m < map->n_methods; m++) {
        for (int i = 0; i < map->x.n; i++) {
            const double turn = hn_map_column_at(map, m, i)->turn;
            if (turn < HN_MAP_TURN) {
                return HN_MAP_STIFF;
            }
            found = turn >= HN_MAP_TURN ? HN_MAP_NOT_STIFF : found;
        }
    }
    return found;
}

const char *hn_map_telling(const hn_map *map) {
    const hn_system_info info = hn_system_get_info(hn_model_system(map->model));
    const bool loops = info.nc > 0 && map->y.is_step;
    return loops && hn_map_is_stiff(map) == HN_MAP_NOT_STIFF ? "baumgarte" : NULL;
}

/// Reason for a column without stiffness: the error of steps ends it, and no prediction of
/// stability applies.
static void put_no_stiffness(hn_strbuf *b, const hn_map *map, const hn_map_column *c) {
    hn_strbuf_printf(b,
                     "not stiff: accuracy limits the step, not stability; at the predicted limit, "
                     "%.3g s, one step moves the mechanism by %.2g rad",
                     c->predicted[0], c->turn);
    if (c->accurate > 0) {
        hn_strbuf_printf(b, "; over %.4g s, the velocities are right to %g %% up to h = %.3g s",
                         map->T, 100 * HN_STABILITY_ACCURATE, c->accurate);
    }
    if (c->stable > 0) {
        char span[64] = "";
        if (map->T < HN_STABILITY_LEAST_STEPS * c->unstable) {
            snprintf(span, sizeof span, "over %d steps", HN_STABILITY_LEAST_STEPS);
        } else {
            snprintf(span, sizeof span, "over %.4g s", map->T);
        }
        hn_strbuf_printf(b, "; %s, the smallest step that failed is h = %.3g s", span, c->unstable);
    }
    if (hn_map_telling(map) && !map->chose) {
        hn_strbuf_printf(b, "; the preset %s maps error and gap over alpha and beta",
                         hn_map_telling(map));
    }
}

/// Reason for a column whose limit was not found where it was predicted.
static void put_disagreement(hn_strbuf *b, const hn_map *map, int m, const hn_map_agreement *a) {
    const double predicted = hn_map_column_at(map, m, 0)->predicted[0];
    if (a->unseen) {
        hn_strbuf_printf(b,
                         "beyond the predicted limit, h = %.3g s, the error grows too slowly to "
                         "be seen",
                         predicted);
    } else if (a->earlier) {
        hn_strbuf_add(b, "the runs end earlier than predicted");
        put_first_earlier(b, map, m);
    } else {
        hn_strbuf_printf(b, "the runs stay stable beyond the predicted limit, h = %.3g s",
                         predicted);
    }
}

void hn_map_steps_text(hn_strbuf *b, const hn_map *map, int m) {
    hn_strbuf_printf(b, "%s: ", map->steps->names[m]);
    hn_map_agreement_text(b, map->steps, m);
}

void hn_map_agreement_text(hn_strbuf *b, const hn_map *map, int m) {
    const hn_map_agreement a = hn_map_agrees(map, m);
    if (a.why) {
        hn_strbuf_printf(b, "prediction not tested: %s", a.why);
        return;
    }

    // one column, and nothing in it is faster than the motion
    const hn_map_column *c = hn_map_column_at(map, m, 0);
    if (a.by_columns && map->x.n == 1 && a.agree == 0 && c->turn >= HN_MAP_TURN) {
        put_no_stiffness(b, map, c);
        return;
    }

    // one column says it without counts
    if (a.by_columns && map->x.n == 1) {
        if (a.agree == 1) {
            hn_strbuf_printf(b, "prediction within %.0f %%", 100 * HN_MAP_AGREES);
        } else {
            put_disagreement(b, map, m, &a);
        }
        return;
    }

    // how many columns or cells agree
    if (a.by_columns) {
        hn_strbuf_printf(b, "prediction within %.0f %% in %d of %d columns", 100 * HN_MAP_AGREES,
                         a.agree, a.compared);
    } else {
        hn_strbuf_printf(b,
                         "prediction right in %d of the %d cells that lie %.0f %% or more from the "
                         "boundary",
                         a.agree, a.compared, 100 * HN_MAP_AGREES);
    }

    // the others, by the kind of disagreement
    if (a.unseen) {
        hn_strbuf_printf(b, "; in %d the error grows too slowly beyond the limit to be seen",
                         a.unseen);
    }
    if (a.earlier) {
        hn_strbuf_printf(b, "; %d run%s ended earlier than predicted", a.earlier,
                         a.earlier == 1 ? "" : "s");
        (a.by_columns ? put_first_earlier : put_first_earlier_cell)(b, map, m);
    }
    if (a.later) {
        hn_strbuf_printf(b, "; %d run%s stable beyond the prediction", a.later,
                         a.later == 1 ? " was" : "s were");
    }
}
