// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_model.h"

#include "dynamics/compile/coordinates.h"
#include "expr/construct.h"
#include "session/extreme/extreme_internal.h"
#include "session/model/state.h"

#include "dynamics/evaluate/eval.h"
#include "expr/parse.h"
#include "linalg/dense.h"
#include "linalg/saddle.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// formulas ----

typedef struct swept {
    const char *name;
    double value;
} swept;

static int look_up(void *user, const char *name, hn_ex *out) {
    const swept *s = user;
    if (!s->name || strcmp(name, s->name) != 0) {
        return 0;
    }
    *out = hn_num(s->value);
    return 1;
}

static hn_status eval_text(const char *text, const char *name, double value, double *out,
                           hn_diags *diags) {
    swept s = {name, value};
    const char *known[1] = {name};
    const hn_parse_opts opts = {
        .lookup = look_up, .user = &s, .known = known, .n_known = name ? 1 : 0, .max_depth = 20};
    hn_graph *graph = hn_graph_create();
    hn_ex ex;
    hn_diag diag = {0};
    if (!graph) {
        return HN_ERR_MEMORY;
    }
    const hn_status status = hn_parse(graph, text, &opts, &ex, &diag);
    const int has = status == HN_OK && hn_is_number(ex, out) && isfinite(*out);
    hn_graph_free(graph);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, "", diag.hint, "'%.80s': %s", text, diag.message);
    }
    return has ? HN_OK
               : hn_diags_add(diags, HN_ERR_INPUT, "", NULL, "'%.80s' has no finite value", text);
}

hn_status hn_extreme_value(const hn_extreme_number *number, const char *name, double value,
                           double *out, hn_diags *diags) {
    if (!number->formula) {
        *out = number->value;
        return HN_OK;
    }
    return eval_text(number->formula, name, value, out, diags);
}

hn_status hn_extreme_spell(const hn_extreme_point *point, char out[256], hn_diags *diags) {
    size_t n = 0;
    for (const char *p = point->method; *p;) {
        // a formula in braces is replaced by its value; other characters are copied
        char formula[128], number[40] = "";
        const char *end = *p == '{' ? strchr(p, '}') : NULL;
        if (end && (size_t)(end - p) <= sizeof formula) {
            double value;
            snprintf(formula, sizeof formula, "%.*s", (int)(end - p - 1), p + 1);
            const hn_status status =
                eval_text(formula, point->trial->sweep, point->value, &value, diags);
            if (status != HN_OK) {
                return status;
            }
            snprintf(number, sizeof number, "%.17g", value);
            p = end + 1;
        } else {
            number[0] = *p++;
        }

        // append, within the length of a spelling
        const int more = snprintf(out + n, 256 - n, "%s", number);
        n += more > 0 ? (size_t)more : 0;
        if (n >= 256) {
            return hn_diags_add(diags, HN_ERR_INPUT, "", NULL, "the method's spelling is too long");
        }
    }
    out[n] = 0;
    return HN_OK;
}

// scenes ----

void hn_extreme_bench_clear(hn_extreme_bench *bench) {
    hn_model_free(bench->model);
    hn_arena_free(bench->truth_arena);
    bench->model = NULL;
    bench->truth_arena = NULL;
    bench->truth_trial = NULL;
    bench->scene = NULL;
}

/// Returns 1 when the trial can use a scene whose loops cannot be closed.
static bool may_be_open(const hn_extreme_trial *t) {
    return t->of && (t->of->needs & HN_EXTREME_MODEL);
}

/// Returns 1 when the loaded model already has these settings.
static bool is_loaded(const hn_extreme_bench *bench, const hn_extreme_point *point,
                      const hn_setting *settings) {
    const hn_extreme_trial *t = point->trial;
    if (!bench->model || bench->scene != point->scene || bench->n_set != t->n_set ||
        bench->is_open != may_be_open(t)) {
        return false;
    }
    for (int i = 0; i < t->n_set; i++) {
        if (bench->settings[i].name != settings[i].name ||
            memcmp(&bench->settings[i].value, &settings[i].value, sizeof(double)) != 0) {
            return false;
        }
    }
    return true;
}

const hn_model *hn_extreme_model(hn_extreme_bench *bench, const hn_extreme_point *point) {
    const hn_extreme_trial *t = point->trial;
    hn_setting settings[HN_EXTREME_SETTINGS];

    // the values of the settings at this point of the sweep
    memset(&bench->diags, 0, sizeof bench->diags);
    bench->load_status = HN_OK;
    for (int i = 0; i < t->n_set; i++) {
        settings[i].name = t->set[i].name;
        bench->load_status = hn_extreme_value(&t->set[i].number, t->sweep, point->value,
                                              &settings[i].value, &bench->diags);
        if (bench->load_status != HN_OK) {
            return NULL;
        }
    }

    // the model of the last point may be the same
    if (is_loaded(bench, point, settings)) {
        return bench->model;
    }

    // load the scene with these settings
    hn_extreme_bench_clear(bench);
    const hn_extreme_scene *scene = point->scene;
    const hn_model_source source = {.name = scene->shipped,
                                    .text = scene->text,
                                    .n_text = scene->text ? strlen(scene->text) : 0,
                                    .settings = settings,
                                    .n_settings = t->n_set,
                                    .allow_open = may_be_open(t)};
    bench->load_status = hn_model_load(bench->lib, &source, &bench->model, &bench->diags);
    if (bench->load_status != HN_OK) {
        bench->model = NULL;
        return NULL;
    }

    // remember what was loaded, for the next point
    bench->scene = scene;
    bench->n_set = t->n_set;
    bench->is_open = may_be_open(t);
    memcpy(bench->settings, settings, sizeof settings);
    return bench->model;
}

// starts ----

/// Moves (q, v) by the least change in the mass metric that takes constraint `row` to `gap` and its
/// rate to `speed`.
static hn_status open_row(const hn_system *sys, const hn_extreme_trial *t, hn_arena *arena,
                          double *q, double *v) {
    enum { ROUNDS = 6 }; // enough for Newton's method: the start is closed and the gap small

    // work arrays, the saddle solver, and the evaluator of the constraint terms
    const hn_system_info info = hn_system_get_info(sys);
    const unsigned terms = HN_TERM_M | HN_TERM_J | HN_TERM_PHI | HN_TERM_PHI_T;
    const size_t nv = (size_t)info.nv, nc = (size_t)info.nc;
    double *zero = hn_arena_doubles(arena, nv), *step = hn_arena_doubles(arena, nv),
           *left = hn_arena_doubles(arena, nc);
    hn_saddle_ws *ws = hn_saddle_ws_create(arena, info.nv, info.nc);
    hn_eval *e = NULL;
    hn_status status = t->row < info.nc ? hn_eval_create(sys, terms, arena, &e) : HN_ERR_INPUT;
    if (status == HN_OK && (hn_arena_failed(arena) || !ws)) {
        status = HN_ERR_MEMORY;
    }

    // rounds of Newton on the positions; the last round corrects the velocities
    for (int k = 0; k <= ROUNDS && status == HN_OK; k++) {
        const double *J = hn_eval_get(e, HN_TERM_J), *M = hn_eval_get(e, HN_TERM_M);
        memset(zero, 0, nv * sizeof *zero);
        hn_eval_run(e, 0, q, v);
        const int of_speed = k == ROUNDS;
        if (of_speed) {
            // the residual: constraint values, or their rates
            hn_mat_vec(info.nc, info.nv, J, v, left);
            hn_axpy(info.nc, 1, hn_eval_get(e, HN_TERM_PHI_T), left);
        } else {
            memcpy(left, hn_eval_get(e, HN_TERM_PHI), nc * sizeof *left);
        }
        left[t->row] -= of_speed ? t->speed : t->gap;

        // the smallest change that removes the residual, in the metric of the mass matrix
        status = hn_saddle_solve(info.nv, info.nc, M, J, zero, left, step, NULL, NULL, NULL, ws);
        if (status == HN_OK && of_speed) {
            hn_axpy(info.nv, 1, step, v);
        } else if (status == HN_OK) {
            hn_system_move(sys, q, step);
        }
    }
    hn_eval_free(e);
    return status;
}

hn_status hn_extreme_start(hn_extreme_bench *bench, const hn_model *model,
                           const hn_extreme_trial *t, hn_arena *arena, double **q, double **v) {
    const hn_system *sys = hn_model_system(model);
    const hn_system_info info = hn_system_get_info(sys);
    hn_state_entry entries[HN_EXTREME_SETTINGS];

    // the values of the state entries
    for (int i = 0; i < t->n_state; i++) {
        entries[i].name = t->state[i].name;
        const hn_status status =
            hn_extreme_value(&t->state[i].number, NULL, 0, &entries[i].value, &bench->diags);
        if (status != HN_OK) {
            return status;
        }
    }

    *q = hn_arena_doubles(arena, (size_t)info.nq);
    *v = hn_arena_doubles(arena, (size_t)info.nv);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // the assembled state, then moved off the constraints if the trial asks for it
    hn_status status = hn_model_state(model, entries, t->n_state, *q, *v, &bench->diags);
    if (status == HN_OK && t->is_open) {
        status = open_row(sys, t, arena, *q, *v);
    }
    return status;
}
