// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/stability_axes.h"

#include "base/word_list.h"
#include "session/stability/stability_internal.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_SIDE = 24, CHOSEN_SIDE = 16 }; // points of an axis; of a map that another chose
enum { UNIT_SIZE = 24 };
static const double DEFAULT_LIMIT = 60; // wall time of a map [s]
static const double LOG_FROM = 15;      // positive ranges of this ratio have a logarithmic axis
static const double PRESET_SPAN = 1e3;  // a preset varies a parameter by this factor up and down
static const double FINEST = 0.3, COARSEST = 12; // h times the fastest rate, for steps of a preset
static const double PRESET_STEPS = 2e4;          // steps of the finest trial of a preset
static const char STEP[] = "step"; // name of the axis of steps, whatever the scene's parameters are

static const char *const STANDARD[] = {"projection@rk4", "projection@dop853:h=1e-3",
                                       "projection@symplectic-euler"};
static const char *const STABILISED[] = {"baumgarte@rk4", "baumgarte@symplectic-euler"};

// axes ----

static void fill_axis(hn_map_axis *a, double low, double high, int n) {
    a->n = n;
    for (int i = 0; i < n; i++) {
        const double share = n > 1 ? (double)i / (n - 1) : 0;
        a->value[i] = i == n - 1 && n > 1 ? high
                      : a->is_log         ? low * pow(high / low, share)
                                          : low + (high - low) * share;
    }
}

/// Returns whether an axis of this name is the step: "step" always is, "h" where no parameter of
/// the scene has that name.
static bool names_step(const hn_map *map, const char *name) {
    return strcmp(name, STEP) == 0 ||
           (strcmp(name, "h") == 0 && hn_scene_find_param(hn_model_scene(map->model), name) < 0);
}

/// A parameter of the scene: the range must lie within its limits, or end at the present value.
static hn_status name_param(const hn_param *param, hn_map_axis *a, double low, double high,
                            hn_diags *diags) {
    a->is_param = 1;
    snprintf(a->unit, sizeof a->unit, "%s", param->unit);
    if (low < fmin(param->min, param->value) || high > fmax(param->max, param->value)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/over", NULL,
                            "%s may be %g to %g %s in this scene, not %g to %g", a->name,
                            param->min, param->max, param->unit, low, high);
    }
    return HN_OK;
}

static hn_status name_axis(hn_map *map, hn_map_axis *a, double low, double high, hn_diags *diags) {
    const hn_scene *scene = hn_model_scene(map->model);
    hn_diag diag = {0};

    // a parameter of the scene, or the step under either of its names
    a->is_step = names_step(map, a->name);
    const int p = a->is_step ? -1 : hn_scene_find_param(scene, a->name);
    if (p >= 0) {
        return name_param(&scene->params[p], a, low, high, diags);
    }
    if (a->is_step) {
        snprintf(a->name, sizeof a->name, "h"); // the option's name
    }

    // an option of the method: every method needs it
    for (int m = 0; m < map->n_methods; m++) {
        const hn_option *info = NULL;

        // the method has an option of this name, and it is a number
        if (!hn_method_find_option(&map->specs[m], a->name, &info) || info->choices) {
            return hn_diags_add(diags, HN_ERR_INPUT, "/over",
                                "name a parameter of the scene, step, or an option of every method",
                                "'%s' is no parameter of the scene and no number that %s takes",
                                a->name, map->names[m]);
        }

        // the method accepts both ends of the range
        if (hn_option_check(info, low, &diag) != HN_OK ||
            hn_option_check(info, high, &diag) != HN_OK) {
            return hn_diags_add(diags, HN_ERR_INPUT, "/over", NULL, "%s", diag.message);
        }
        snprintf(a->unit, sizeof a->unit, "%s", info->unit ? info->unit : "");
    }
    return HN_OK;
}

static hn_status make_axis(hn_map *map, hn_map_axis *a, const char *name, double low, double high,
                           int n, int form, hn_diags *diags) {
    *a = (hn_map_axis){0};
    snprintf(a->name, sizeof a->name, "%s", name);
    if (!(high > low)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/over", NULL,
                            "%s goes from %g to %g: the second has to be larger", name, low, high);
    }
    if (form == 'l' && low <= 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/over", NULL,
                            "%s starts at %g; a logarithmic axis needs values above 0", name, low);
    }
    a->is_log = form ? form == 'l' : low > 0 && high / low >= LOG_FROM;
    fill_axis(a, low, high, n);
    return name_axis(map, a, low, high, diags);
}

// "NAME=LOW..HIGH" with ":lin" or ":log"; form: 'i', 'l', 0
static bool read_axis(char *text, char **name, double *low, double *high, int *form) {
    char *equals = strchr(text, '='), *dots = equals ? strstr(equals, "..") : NULL, *end;
    if (!equals || equals == text || !dots) {
        return false;
    }
    *equals = 0;
    *dots = 0;
    *name = text;
    *low = strtod(equals + 1, &end);
    if (end == equals + 1 || *end) {
        return false;
    }
    *high = strtod(dots + 2, &end);
    *form = strcmp(end, ":lin") == 0 ? 'i' : strcmp(end, ":log") == 0 ? 'l' : 0;
    return end != dots + 2 && (!*end || *form) && isfinite(*low) && isfinite(*high);
}

static hn_status read_over(hn_map *map, hn_diags *diags) {
    char copy[200], *rest = copy;
    hn_map_axis axes[2];
    int n = 0;

    // split at commas, one axis each
    const int fits = snprintf(copy, sizeof copy, "%s", map->over) < (int)sizeof copy;
    for (char *part = strsep(&rest, ","); part; part = strsep(&rest, ",")) {
        char *name;
        double low, high;
        int form;
        if (!fits || n == 2 || !read_axis(part, &name, &low, &high, &form)) {
            return hn_diags_add(diags, HN_ERR_INPUT, "/over", "as in h=1e-4..1e-1,k=1e2..1e8",
                                "'%.80s' does not name one or two axes", map->over);
        }

        // the vertical axis has as many points as the map has rows
        const int vertical = names_step(map, name) || (n == 1 && !axes[0].is_step);
        const int side = vertical ? map->n_rows : map->n_columns;
        const hn_status status = make_axis(map, &axes[n], name, low, high, side, form, diags);
        if (status != HN_OK) {
            return status;
        }
        n++;
    }

    // two axes must differ
    if (n == 2 && axes[0].is_step == axes[1].is_step && strcmp(axes[0].name, axes[1].name) == 0) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/over", NULL, "both axes are %s", axes[0].name);
    }

    // a step size becomes the vertical axis; a single axis is vertical too
    const int swap = n == 1 || axes[0].is_step;
    map->y = axes[swap ? 0 : 1];
    map->x = n == 2 ? axes[swap ? 1 : 0] : (hn_map_axis){.n = 1};
    return HN_OK;
}

// presets ----

// Returns the modulus of the fastest eigenvalue at the start of a model; 0 when it has none.
static double fastest_rate(const hn_model *model) {
    hn_arena *arena = hn_arena_create(0);
    hn_spectrum *s = NULL;
    const hn_eigenvalue *values;
    int n = 0;
    double rate = 0;
    if (arena && hn_spectrum_create(hn_model_system(model), arena, &s) == HN_OK &&
        hn_spectrum_calc(s, 0, hn_model_q(model), hn_model_v(model), &values, &n) == HN_OK &&
        n > 0) {
        rate = hypot(values[0].re, values[0].im);
    }
    hn_spectrum_free(s);
    hn_arena_free(arena);
    return rate;
}

static hn_status rate_with(hn_map *map, const char *name, double value, double *rate,
                           hn_diags *diags) {
    const hn_setting setting = {name, value};
    hn_model *model = NULL;
    HN_TRY(map->request.load(map->request.load_user, &setting, 1, &model, diags));
    *rate = fastest_rate(model);
    hn_model_free(model);
    return HN_OK;
}

/// Returns whether a parameter has one of these units and can go over a range above 0.
static bool has_unit(const hn_param *p, const char *units) {
    char unit[UNIT_SIZE];
    while (hn_word_next(&units, unit, sizeof unit)) {
        if (strcmp(p->unit, unit) == 0 && p->max > 0 && !p->integer) {
            return true;
        }
    }
    return false;
}

static hn_status steps_for(hn_map *map, double slow, double fast, int n, hn_diags *diags) {
    if (!(fast > 0)) {
        return hn_diags_add(
            diags, HN_ERR_UNSUPPORTED, "/preset", "name the axes with --over",
            "nothing vibrates or decays at the start, so no range of steps can be chosen");
    }
    // the present step is on the axis too
    const double present = hn_model_scene(map->model)->step;
    const double low = present > 0 ? fmin(FINEST / fast, present) : FINEST / fast;
    const double high = fmax(present, fmin(100, COARSEST / (slow > 0 ? slow : fast)));
    if (map->shortens) {
        map->T = fmin(map->T, PRESET_STEPS * low);
    }
    return make_axis(map, &map->y, STEP, low, fmax(high, 40 * low), n, 'l', diags);
}

/// "N/m or N*m/rad" of "N/m N*m/rad".
static void put_units(hn_strbuf *b, const char *units) {
    char unit[UNIT_SIZE];
    while (hn_word_next(&units, unit, sizeof unit)) {
        hn_strbuf_printf(b, "%s%s", b->n ? " or " : "", unit);
    }
}

static hn_status refuse_param(const hn_job_preset *preset, hn_diags *diags) {
    hn_strbuf units;
    hn_strbuf_init(&units);
    put_units(&units, preset->units);
    const hn_status status = hn_diags_add(
        diags, HN_ERR_UNSUPPORTED, "/preset", "name the axes with --over",
        "the preset '%s' needs a parameter in %s; this scene has none that can be varied above 0",
        preset->name, hn_strbuf_text(&units));
    hn_strbuf_reset(&units);
    return status;
}

/// Takes a parameter of one of the preset's units over its range, and the step sizes that the
/// spectra at both ends of the range require.
static hn_status param_axes(hn_map *map, const hn_job_preset *preset, hn_diags *diags) {
    const hn_scene *scene = hn_model_scene(map->model);
    const hn_param *found = NULL;

    // the first parameter of a fitting unit
    for (int i = scene->n_params - 1; i >= 0; i--) {
        found = has_unit(&scene->params[i], preset->units) ? &scene->params[i] : found;
    }
    if (!found) {
        return refuse_param(preset, diags);
    }

    // its range: a factor of PRESET_SPAN up and down, within its limits; the present value is on it
    const double middle = found->value > 0 ? found->value : sqrt(found->max);
    const double low = fmin(middle, fmax(found->min, middle / PRESET_SPAN)),
                 high = fmax(middle, fmin(found->max, middle * PRESET_SPAN));

    // the fastest rates at both ends bound the step sizes
    double first, last;
    HN_TRY(make_axis(map, &map->x, found->name, low, high, map->n_columns, 'l', diags));
    HN_TRY(rate_with(map, found->name, low, &first, diags));
    HN_TRY(rate_with(map, found->name, high, &last, diags));
    return steps_for(map, fmin(first, last), fmax(first, last), map->n_rows, diags);
}

/// The axis of alpha or beta: around 1 / h, and the present value is on it.
static hn_status feedback_axis(hn_map *map, hn_map_axis *a, const char *name, int n,
                               hn_diags *diags) {
    const hn_method_spec *spec = &map->specs[0];
    const double h = hn_method_option(spec, "h", 1e-3), low = 0.05 / h, high = 5 / h;
    const double present = hn_method_option(spec, name, low);
    return make_axis(map, a, name, present > 0 ? fmin(low, present) : low, fmax(high, present), n,
                     'l', diags);
}

static hn_status baumgarte_axes(hn_map *map, const hn_job_preset *preset, hn_diags *diags) {
    (void)preset;
    HN_TRY(feedback_axis(map, &map->x, "alpha", map->n_columns, diags));
    return feedback_axis(map, &map->y, "beta", map->n_rows, diags);
}

// One column whose steps double from row to row.
static hn_status limit_axes(hn_map *map, const hn_job_preset *preset, hn_diags *diags) {
    (void)preset;
    const double rate = fastest_rate(map->model);
    HN_TRY(steps_for(map, rate / 40, rate, 2, diags));
    const double low = map->y.value[0], times = floor(log2(map->y.value[1] / low));
    map->x = (hn_map_axis){.n = 1};
    fill_axis(&map->y, low, low * pow(2, times), 1 + (int)times);
    return HN_OK;
}

static const struct {
    hn_job_preset preset;
    hn_status (*make)(hn_map *map, const hn_job_preset *preset, hn_diags *diags);
} PRESETS[] = {
#define ROW(maker, name, about, chooses, stabilised, units) \
    {{name, about, chooses, stabilised, units}, maker},
    HN_MAP_PRESETS(ROW)
#undef ROW
};
enum { N_PRESETS = sizeof PRESETS / sizeof *PRESETS };

const hn_job_preset *hn_map_preset_at(int i) {
    return i >= 0 && i < N_PRESETS ? &PRESETS[i].preset : NULL;
}

/// Returns -1 when there is none of that name.
static int find_preset(const char *name) {
    for (int i = 0; i < N_PRESETS; i++) {
        if (strcmp(PRESETS[i].preset.name, name) == 0) {
            return i;
        }
    }
    return -1;
}

static hn_status take_preset(hn_map *map, hn_diags *diags) {
    const int i = find_preset(map->preset);
    if (i >= 0) {
        return PRESETS[i].make(map, &PRESETS[i].preset, diags);
    }
    const char *names[N_PRESETS];
    hn_strbuf hint;
    hn_strbuf_init(&hint);
    for (int k = 0; k < N_PRESETS; k++) {
        names[k] = PRESETS[k].preset.name;
    }
    hn_strbuf_add(&hint, "the presets are ");
    hn_word_list(&hint, names, N_PRESETS, " and ");
    const hn_status status = hn_diags_add(diags, HN_ERR_INPUT, "/preset", hn_strbuf_text(&hint),
                                          "there is no preset called '%.40s'", map->preset);
    hn_strbuf_reset(&hint);
    return status;
}

// methods ----

/// Takes the methods of the request, or, if it names none, those that fit the axes.
static hn_status take_methods(hn_map *map, hn_diags *diags) {
    hn_job_request *r = &map->request;
    const int preset = map->preset ? find_preset(map->preset) : -1;
    const int stabilised = map->preset ? preset >= 0 && PRESETS[preset].preset.stabilised
                                       : strstr(map->over, "alpha=") || strstr(map->over, "beta=");
    const bool chosen_here = r->n_methods == 0;
    map->names_methods = !chosen_here;
    if (chosen_here) {
        HN_TRY(hn_job_request_set_methods(r, stabilised ? STABILISED : STANDARD, stabilised ? 2 : 3,
                                          diags));
    }
    HN_TRY(hn_job_complete(r, DEFAULT_LIMIT, HN_MAP_METHODS, map->specs, diags));
    map->n_methods = r->n_methods;

    // methods that were chosen here take the scene's step
    const double step = hn_model_scene(map->model)->step;
    for (int m = 0; chosen_here && step > 0 && m < map->n_methods; m++) {
        *hn_method_find_option(&map->specs[m], "h", NULL) = step;
    }
    for (int m = 0; m < map->n_methods; m++) {
        snprintf(map->names[m], HN_SPEC_MAX, "%s@%s", map->specs[m].formulation->name,
                 map->specs[m].stepper->name);
    }
    return HN_OK;
}

// Spells each method without the options that an axis sets.
static void name_methods(hn_map *map) {
    for (int m = 0; m < map->n_methods; m++) {
        if (!map->y.is_step && !map->x.is_step) {
            hn_method_spec spec = map->specs[m];
            hn_method_format(&spec, map->names[m]);
        }
    }
}

static hn_status check_sizes(hn_map *map, hn_diags *diags) {
    // the smallest fixed step of the map
    double h = HUGE_VAL;
    for (int m = 0; m < map->n_methods && !map->y.is_step; m++) {
        const double own = hn_method_option(&map->specs[m], "h", 0);
        if (!(own > 0)) {
            return hn_diags_add(diags, HN_ERR_INPUT, "/methods", "give it one, as in :h=1e-3",
                                "%s has no fixed step", map->names[m]);
        }
        h = fmin(h, own);
    }

    // a trial must not take too many steps
    h = map->y.is_step ? map->y.value[0] : h;
    if (map->T / h > HN_MAP_STEPS) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/time", "take a shorter time or larger steps",
                            "%g s in steps of %.3g s are %.3g steps; a trial has at most %g",
                            map->T, h, map->T / h, HN_MAP_STEPS);
    }

    // each value of a parameter is a scene of its own
    map->n_scenes = (map->x.is_param ? map->x.n : 1) * (map->y.is_param ? map->y.n : 1);
    return map->n_scenes <= HN_MAP_MODELS
               ? HN_OK
               : hn_diags_add(diags, HN_ERR_LIMIT, "/grid", NULL,
                              "this map needs %d different scenes; at most %d are allowed",
                              map->n_scenes, HN_MAP_MODELS);
}

/// Sets the axes and their numbers of points.
static hn_status take_values(hn_map *map, hn_diags *diags) {
    const hn_job_request *r = &map->request;
    map->n_columns = (int)hn_job_number(r, "columns", DEFAULT_SIDE);
    map->n_rows = (int)hn_job_number(r, "rows", DEFAULT_SIDE);
    map->preset = hn_job_text(r, "preset");
    map->over = hn_job_text(r, "over");
    if (map->preset && map->over) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/over", "give one of them",
                            "a map has its axes from 'preset' or from 'over', not from both");
    }
    map->open_question = !map->preset && !map->over;
    if (map->open_question) {
        map->preset = HN_MAP_FIRST;
    }
    if (map->n_columns < 2 || map->n_rows < 2 || map->n_columns > HN_MAP_SIDE ||
        map->n_rows > HN_MAP_SIDE) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/grid", NULL,
                            "the grid is %d by %d; each side can have 2 to %d", map->n_columns,
                            map->n_rows, HN_MAP_SIDE);
    }
    return HN_OK;
}

/// Returns whether a method has every option of a list, separated by blanks.
static bool has_options(const hn_method_spec *spec, const char *names) {
    hn_method_spec copy = *spec;
    char name[32];
    while (hn_word_next(&names, name, sizeof name)) {
        if (!hn_method_find_option(&copy, name, NULL)) {
            return false;
        }
    }
    return true;
}

hn_job_request hn_map_request_for(const hn_map *map, const char *preset) {
    const int k = find_preset(preset);
    hn_job_request r = map->request;
    hn_job_request_set_text(&r, "preset", preset);

    // a map that nobody asked for by name answers soon
    for (int i = 0; i < 2; i++) {
        static const char *const sides[] = {"columns", "rows"};
        if (isnan(hn_job_number(&map->request, sides[i], (double)NAN))) {
            hn_job_request_set(&r, sides[i], CHOSEN_SIDE);
        }
    }

    // the methods of the request that have the options of the preset; its own where none was named
    r.n_methods = 0;
    for (int m = 0; map->names_methods && m < map->n_methods; m++) {
        if (has_options(&map->specs[m], PRESETS[k].preset.chooses)) {
            r.methods[r.n_methods++] = map->request.methods[m];
        }
    }
    return r;
}

hn_status hn_map_set_up(hn_map *map, hn_diags *diags) {
    const bool shortens = isnan(map->request.time);
    HN_TRY(take_values(map, diags));
    HN_TRY(take_methods(map, diags));
    map->T = map->request.time;
    map->shortens = shortens;
    HN_TRY(map->preset ? take_preset(map, diags) : read_over(map, diags));
    name_methods(map);
    return check_sizes(map, diags);
}
