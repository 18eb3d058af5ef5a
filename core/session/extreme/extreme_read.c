// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_read.h"

#include "base/suggest.h"
#include "session/extreme/extreme_measure.h"
#include "session/extreme/extreme_quantity.h"
#include "session/extreme/extreme_read_expect.h"
#include "session/extreme/extreme_reader.h"
#include "session/extreme/extreme_solve.h"

#include <stdio.h>
#include <string.h>

// scenes ----

static void read_scenes(hn_xr *r, const cJSON *root) {
    const cJSON *node = hn_xr_get(root, "scenes"), *m;
    hn_extreme_case *c = r->c;

    // a case may do without scenes of its own
    if (!node) {
        return;
    }

    const size_t mark = hn_xr_enter(r, "scenes", -1);
    if (!cJSON_IsObject(node) || cJSON_GetArraySize(node) > HN_XR_SCENES) {
        hn_xr_fault(r, NULL, NULL, "expected an object of at most %d scenes", HN_XR_SCENES);
        hn_xr_leave(r, mark);
        return;
    }

    // keep the text of each scene under its name
    cJSON_ArrayForEach(m, node) {
        char *text = cJSON_IsObject(m) ? cJSON_PrintUnformatted(m) : NULL;
        if (!text && !cJSON_IsString(m)) {
            hn_xr_fault(r, m->string, NULL,
                        "expected a scene: an object, or a string with the text of a scene that is "
                        "not JSON");
            continue;
        }
        c->scenes[c->n_scenes].name = hn_xr_keep(r, m->string);
        c->scenes[c->n_scenes++].text = hn_xr_keep(r, text ? text : m->valuestring);
        cJSON_free(text);
    }
    hn_xr_leave(r, mark);
}

static const hn_extreme_scene *find_scene(hn_xr *r, const char *key, const char *name) {
    // a scene of this file
    for (int i = 0; i < r->c->n_scenes; i++) {
        if (strcmp(r->c->scenes[i].name, name) == 0) {
            return &r->c->scenes[i];
        }
    }

    // otherwise a shipped scene, by name
    hn_extreme_scene *scene = hn_arena_get(r->arena, sizeof *scene);
    if (!scene) {
        r->status = HN_ERR_MEMORY;
        return NULL;
    }
    *scene = (hn_extreme_scene){.name = name, .shipped = name};

    // suggest the nearest name for an unknown one
    if (!hn_library_scene_path(r->lib, name)) {
        char hint[HN_DIAG_HINT];
        hn_suggest(hint, name, hn_library_scene_ids(r->lib), hn_library_n_scenes(r->lib),
                   "'holonom list scenes' names them");
        hn_xr_fault(r, key, hint, "neither this file nor the lessons have a scene '%.60s'", name);
    }
    return scene;
}

static void read_trial_scenes(hn_xr *r, const cJSON *node, const cJSON *root, hn_extreme_trial *t) {
    const char *names[HN_EXTREME_RUNS];
    t->n_scenes = hn_xr_texts(r, node, "scene", "scenes", names);
    if (t->n_scenes == 0 && hn_xr_get(root, "scene")) {
        t->n_scenes = hn_xr_texts(r, root, "scene", "", names);
    }
    for (int i = 0; i < t->n_scenes; i++) {
        t->scenes[i] = find_scene(r, "scene", names[i]);
    }
    if (t->n_scenes == 0) {
        hn_xr_fault(r, "scene", NULL, "no scene is named");
    }
}

// trials ----

static void read_measure(hn_xr *r, const cJSON *node, hn_extreme_trial *t) {
    const char *names[32];
    const char *word = hn_xr_text(r, node, "measure", 1);
    for (int i = 0; i < hn_extreme_n_measures; i++) {
        names[i] = hn_extreme_measures[i].name;
        if (strcmp(names[i], word) == 0) {
            t->measure = &hn_extreme_measures[i];
        }
    }
    if (!t->measure) {
        char hint[HN_DIAG_HINT] = "";
        hn_xr_suggest(hint, word, names, hn_extreme_n_measures);
        hn_xr_fault(r, "measure", hint, "there is no measure '%.60s'", word);
    }
}

static void read_quantity(hn_xr *r, const cJSON *node, hn_extreme_trial *t) {
    const char *names[64];
    const char *word = hn_xr_text(r, node, "of", 0);
    for (int i = 0; word && i < hn_extreme_n_quantities; i++) {
        names[i] = hn_extreme_quantities[i].name;
        if (strcmp(names[i], word) == 0) {
            t->of = &hn_extreme_quantities[i];
        }
    }
    if (word && !t->of) {
        char hint[HN_DIAG_HINT] = "";
        hn_xr_suggest(hint, word, names, hn_extreme_n_quantities);
        hn_xr_fault(r, "of", hint, "there is no quantity '%.60s'", word);
    }
    if (t->measure && (word != NULL) != t->measure->takes_quantity) {
        hn_xr_fault(r, "of", NULL, word ? "'%s' takes no quantity" : "'%s' needs a quantity",
                    t->measure->name);
    }
}

static void read_sweep(hn_xr *r, const cJSON *root, hn_extreme_trial *t) {
    const cJSON *node = hn_xr_get(root, "sweep"), *m;

    // the measure decides whether there must be a sweep
    if (t->measure && t->measure->takes_sweep >= 0 && (node != NULL) != t->measure->takes_sweep) {
        hn_xr_fault(r, "sweep", NULL, node ? "'%s' takes no sweep" : "'%s' needs a sweep",
                    t->measure->name);
    }
    if (!node) {
        return;
    }

    // the swept name and its values
    const size_t mark = hn_xr_enter(r, "sweep", -1);
    if (hn_xr_object(r, node, HN_XR_FIELDS("name", "values"))) {
        const cJSON *values = hn_xr_get(node, "values");
        const int n = cJSON_IsArray(values) ? cJSON_GetArraySize(values) : 0;
        t->sweep = hn_xr_text(r, node, "name", 1);
        if (n < 1 || n > HN_EXTREME_SWEEP) {
            hn_xr_fault(r, "values", NULL, "expected 1 to %d numbers", HN_EXTREME_SWEEP);
        } else {
            cJSON_ArrayForEach(m, values) {
                t->values[t->n_sweep++] =
                    hn_xr_check_number(r, m, "values", -HN_XR_NUMBER, HN_XR_NUMBER);
            }
        }
    }
    hn_xr_leave(r, mark);
}

static void read_open(hn_xr *r, const cJSON *root, hn_extreme_trial *t) {
    const cJSON *node = hn_xr_get(root, "open");
    if (!node) {
        return;
    }
    const size_t mark = hn_xr_enter(r, "open", -1);
    if (hn_xr_object(r, node, HN_XR_FIELDS("row", "gap", "speed"))) {
        t->is_open = 1;
        t->row = (int)hn_xr_number(r, node, "row", 0, 1000, 0);
        t->gap = hn_xr_number(r, node, "gap", -1, 1, 0);
        t->speed = hn_xr_number(r, node, "speed", -1e3, 1e3, 0);
    }
    hn_xr_leave(r, mark);
}

static void read_truth(hn_xr *r, const cJSON *root, hn_extreme_trial *t) {
    const cJSON *node = hn_xr_get(root, "truth");
    if (cJSON_IsString(node)) {
        t->truth_method = hn_xr_text(r, root, "truth", 1);
    } else {
        t->n_truth = hn_xr_assigns(r, root, "truth", t, t->truth);
    }
    if (t->of && (t->of->needs & HN_EXTREME_TRUTH) && !node) {
        hn_xr_fault(r, "truth", NULL,
                    "an error needs a true solution: a method, or an object of numbers");
    }
}

static void read_methods(hn_xr *r, const cJSON *node, hn_extreme_trial *t) {
    // either methods or solvers of the saddle system
    const int solvers = hn_xr_get(node, "solvers") != NULL;
    const int of_model = t->of && (t->of->needs & HN_EXTREME_MODEL);
    t->solvers = solvers;
    t->n_methods = solvers ? hn_xr_texts(r, node, "solver", "solvers", t->methods)
                           : hn_xr_texts(r, node, "method", "methods", t->methods);
    if (solvers && (hn_xr_get(node, "method") || hn_xr_get(node, "methods"))) {
        hn_xr_fault(r, "solvers", NULL,
                    "both methods and solvers are given; a trial has one of them");
    }

    // solvers must exist and fit the quantity
    for (int i = 0; solvers && i < t->n_methods; i++) {
        if (!hn_extreme_is_solver(t->methods[i])) {
            hn_xr_fault(r, "solvers", NULL, "there is no solver '%.60s'", t->methods[i]);
        }
    }
    if (t->of && solvers != !!(t->of->needs & HN_EXTREME_SOLVE)) {
        hn_xr_fault(r, "of", NULL, "'%s' is a quantity of %s", t->of->name,
                    solvers ? "a run" : "a solver's answer");
    }

    // no method at all: a quantity of the model alone, or a measure that gives a word
    if (t->n_methods == 0) {
        if (!of_model && !(t->measure && t->measure->gives_word)) {
            hn_xr_fault(r, "methods", NULL, "no method is named");
        }
        t->methods[t->n_methods++] = "";
    }

    // bound the number of runs
    if (t->n_methods * (t->n_scenes > 0 ? t->n_scenes : 1) > HN_EXTREME_RUNS) {
        hn_xr_fault(r, "methods", NULL, "methods times scenes are more than %d runs",
                    HN_EXTREME_RUNS);
    }
}

static void read_rest(hn_xr *r, const cJSON *node, hn_extreme_trial *t) {
    const cJSON *time = hn_xr_get(node, "time"), *limit = hn_xr_get(node, "limit");

    // time, settings and start
    if (time) {
        t->time = hn_xr_formula(r, time, "time", t, 0, HN_XR_TIME);
    }
    t->n_set = hn_xr_assigns(r, node, "set", t, t->set);
    t->n_state = hn_xr_assigns(r, node, "state", t, t->state);

    // options of the quantity and of the run
    t->coordinate = hn_xr_text(r, node, "coordinate", 0);
    t->incident = hn_xr_text(r, node, "incident", 0);
    t->scale = hn_xr_number(r, node, "scale", 1e-30, 1e30, 1);
    t->refine = (int)hn_xr_number(r, node, "refine", 0, 20, 4);
    t->steps = hn_xr_number(r, node, "steps", 100, 1e6, 4000);
    t->max_steps = hn_xr_number(r, node, "max_steps", 1, 1e9, 0);
    t->is_long = hn_xr_flag(r, node, "long");

    // the interval in which to search for the largest stable step
    if (cJSON_IsArray(limit) && cJSON_GetArraySize(limit) == 2) {
        t->limit[0] = hn_xr_check_number(r, cJSON_GetArrayItem(limit, 0), "limit", 1e-12, 100);
        t->limit[1] = hn_xr_check_number(r, cJSON_GetArrayItem(limit, 1), "limit", 1e-12, 100);
    } else if (limit) {
        hn_xr_fault(r, "limit", NULL,
                    "expected two steps [s], between which the limit is searched");
    }

    // what the quantity needs must be named
    if (t->of && (t->of->needs & HN_EXTREME_COORDINATE) && !t->coordinate) {
        hn_xr_fault(r, "coordinate", NULL, "'%s' needs the name of a coordinate", t->of->name);
    }
    if (t->of && (t->of->needs & HN_EXTREME_INCIDENT) && !t->incident) {
        hn_xr_fault(r, "incident", NULL, "'%s' needs the name of an incident", t->of->name);
    }

    // the incident must be one that runs report
    int known = !t->incident;
    for (int i = 0; i < HN_INCIDENT_COUNT && !known; i++) {
        known = strcmp(hn_incident_spelling((hn_incident_code)i), t->incident) == 0;
    }
    if (!known) {
        hn_xr_fault(r, "incident", NULL, "there is no incident '%.60s'", t->incident);
    }
}

static void read_trial(hn_xr *r, const cJSON *node, const cJSON *root, hn_extreme_trial *t) {
    if (!hn_xr_object(r, node,
                      HN_XR_FIELDS("what", "measure", "of", "scene", "scenes", "method", "methods",
                                   "solvers", "refine", "set", "state", "truth", "open", "sweep",
                                   "time", "coordinate", "incident", "scale", "limit", "steps",
                                   "max_steps", "long", "predicted", "corrected"))) {
        return;
    }
    t->what = hn_xr_text(r, node, "what", 1);
    t->verdict = HN_EXTREME_NOT_RUN;
    read_measure(r, node, t);
    read_quantity(r, node, t);
    read_sweep(r, node, t);
    read_trial_scenes(r, node, root, t);
    read_methods(r, node, t);
    read_open(r, node, t);
    read_truth(r, node, t);
    read_rest(r, node, t);
    hn_xr_expect(r, node, t);
    hn_xr_corrected(r, node, &t->expect);
}

void hn_xr_case(hn_xr *r, const cJSON *root) {
    hn_extreme_case *c = r->c;
    const cJSON *list = hn_xr_get(root, "trials"), *m;
    if (!hn_xr_object(r, root,
                      HN_XR_FIELDS("id", "title", "why", "about", "scene", "scenes", "trials"))) {
        return;
    }

    // the head of the case; a faulty case read before may have left values here
    memset(c, 0, sizeof *c);
    c->id = hn_xr_text(r, root, "id", 1);
    c->title = hn_xr_text(r, root, "title", 1);
    c->why = hn_xr_text(r, root, "why", 1);
    c->about = hn_xr_text(r, root, "about", 0);
    c->verdict = HN_EXTREME_NOT_RUN;

    // the number of trials
    const int n = cJSON_IsArray(list) ? cJSON_GetArraySize(list) : 0;
    if (n < 1 || n > HN_EXTREME_TRIALS) {
        hn_xr_fault(r, "trials", NULL, "expected a list of 1 to %d trials", HN_EXTREME_TRIALS);
        return;
    }

    // make room for scenes and trials
    c->scenes = hn_arena_get(r->arena, HN_XR_SCENES * sizeof *c->scenes);
    c->trials = hn_arena_get(r->arena, (size_t)n * sizeof *c->trials);
    if (hn_arena_failed(r->arena)) {
        r->status = HN_ERR_MEMORY;
        return;
    }
    memset(c->scenes, 0, HN_XR_SCENES * sizeof *c->scenes);
    memset(c->trials, 0, (size_t)n * sizeof *c->trials);

    // scenes first: trials refer to them
    read_scenes(r, root);
    cJSON_ArrayForEach(m, list) {
        const size_t mark = hn_xr_enter(r, "trials", c->n_trials);
        read_trial(r, m, root, &c->trials[c->n_trials++]);
        hn_xr_leave(r, mark);
    }
}
