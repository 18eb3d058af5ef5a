// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/face/holonom.h"

#include "base/suggest.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "integrators/method/method_spec.h"
#include "session/model/model.h"
#include "study/ensemble/ensemble.h"
#include "study/run/run.h"

#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// A model that mechanism and runs share; the last of them frees it.
typedef struct shared_model {
    hn_model *model;
    atomic_int holders;
} shared_model;

struct holonom_mechanism {
    shared_model *shared;
    hn_library *library;  ///< NULL: no shipped scenes were asked for
    char *text;           ///< the scene, with the values of its file
    const char *id;       ///< its name, in the arena
    hn_arena *arena;      ///< names of parameters
    hn_setting *settings; ///< parameters that were set, each once
    int n_settings;
    // made at the first call of holonom_accelerations()
    hn_arena *scratch;
    hn_accel *accel;
    double *q, *v, *a, *lambda;
};

struct holonom_run {
    shared_model *shared;
    hn_run *run;
    hn_sample sample;
};

// ---- faults ----

static holonom_status status_of(hn_status status) {
    switch (status) {
    case HN_OK:
        return HOLONOM_OK;
    case HN_ERR_INPUT:
    case HN_ERR_LIMIT:
    case HN_ERR_IO:
    case HN_ERR_UNREACHABLE:
    case HN_ERR_UNSUPPORTED:
        return HOLONOM_INPUT;
    case HN_ERR_MEMORY:
    case HN_ERR_INTERNAL:
        return HOLONOM_PROGRAM;
    default:
        return HOLONOM_ENDED;
    }
}

/// Copies the first fault; one that says nothing gets the sentence of its status.
static holonom_status fail(holonom_fault *fault, hn_status status, const hn_diag *diag) {
    if (fault) {
        const char *message = diag && diag->message[0] ? diag->message : hn_status_text(status);
        snprintf(fault->where, sizeof fault->where, "%s", diag ? diag->pointer : "");
        snprintf(fault->message, sizeof fault->message, "%s", message);
        snprintf(fault->hint, sizeof fault->hint, "%s", diag ? diag->hint : "");
    }
    return status_of(status);
}

static holonom_status fail_first(holonom_fault *fault, hn_status status, const hn_diags *diags) {
    return fail(fault, status, diags->n > 0 ? &diags->item[0] : NULL);
}

// ---- mechanisms ----

static shared_model *hold(shared_model *s) {
    atomic_fetch_add(&s->holders, 1);
    return s;
}

static void release(shared_model *s) {
    if (s && atomic_fetch_sub(&s->holders, 1) == 1) {
        hn_model_free(s->model);
        free(s);
    }
}

/// Loads the model with the present settings into `out`.
static hn_status load_model(const holonom_mechanism *m, const hn_setting *settings, int n,
                            shared_model **out, hn_diags *diags) {
    shared_model *s = calloc(1, sizeof *s);
    if (!s) {
        return HN_ERR_MEMORY;
    }
    const hn_model_source source = {.text = m->text,
                                    .n_text = strlen(m->text),
                                    .id = m->id,
                                    .settings = settings,
                                    .n_settings = n};
    const hn_status status = hn_model_load(m->library, &source, &s->model, diags);
    if (status != HN_OK) {
        free(s);
        return status;
    }
    atomic_init(&s->holders, 1);
    *out = s;
    return HN_OK;
}

/// Keeps the text of a scene that has been read, without what the file's reader changed.
static hn_status adopt_scene(holonom_mechanism *m, hn_scene *scene, hn_diags *diags) {
    m->id = hn_arena_strdup(m->arena, scene->id);
    m->text = strdup(scene->text);
    hn_scene_free(scene);
    if (!m->id || !m->text) {
        return HN_ERR_MEMORY;
    }
    return load_model(m, NULL, 0, &m->shared, diags);
}

static bool is_path(const char *scene) {
    const size_t n = strlen(scene);
    return strchr(scene, '/') != NULL || (n > 5 && strcmp(scene + n - 5, ".json") == 0);
}

/// The path of a shipped scene, or of the file itself.
static hn_status find_scene(holonom_mechanism *m, const char *scene, const char **path,
                            hn_diags *diags) {
    *path = scene;
    if (is_path(scene)) {
        return HN_OK;
    }
    hn_diag diag = {0};
    const hn_status status = hn_library_open(NULL, &m->library, &diag);
    if (status != HN_OK) {
        return hn_diags_add(diags, status, diag.pointer, diag.hint, "%s", diag.message);
    }
    *path = hn_library_scene_path(m->library, scene);
    if (*path) {
        return HN_OK;
    }
    char hint[HN_DIAG_HINT];
    hn_suggest(hint, scene, hn_library_scene_ids(m->library), hn_library_n_scenes(m->library),
               NULL);
    return hn_diags_add(diags, HN_ERR_INPUT, "/scene", hint, "no shipped scene is called '%.80s'",
                        scene);
}

static holonom_mechanism *create_empty(void) {
    holonom_mechanism *m = calloc(1, sizeof *m);
    if (m && !(m->arena = hn_arena_create(0))) {
        free(m);
        m = NULL;
    }
    return m;
}

/// Hands out the mechanism, or frees it and reports why.
static holonom_status finish(holonom_mechanism *m, hn_status status, const hn_diags *diags,
                             holonom_mechanism **out, holonom_fault *fault) {
    if (status != HN_OK) {
        holonom_free(m);
        return fail_first(fault, status, diags);
    }
    *out = m;
    return HOLONOM_OK;
}

holonom_status holonom_load(const char *scene, holonom_mechanism **out, holonom_fault *fault) {
    HN_ASSERT(scene && out);
    hn_diags diags = {0};
    const char *path = NULL;
    hn_scene *read = NULL;
    holonom_mechanism *m = create_empty();
    hn_status status = m ? find_scene(m, scene, &path, &diags) : HN_ERR_MEMORY;
    HN_THEN(status, hn_scene_load_file(path, NULL, 0, &read, &diags));
    HN_THEN(status, adopt_scene(m, read, &diags));
    return finish(m, status, &diags, out, fault);
}

holonom_status holonom_load_text(const char *json, size_t n, holonom_mechanism **out,
                                 holonom_fault *fault) {
    HN_ASSERT(json && out);
    hn_diags diags = {0};
    hn_scene *read = NULL;
    holonom_mechanism *m = create_empty();
    hn_status status =
        m ? hn_scene_load_json(json, n, NULL, NULL, 0, &read, &diags) : HN_ERR_MEMORY;
    HN_THEN(status, adopt_scene(m, read, &diags));
    return finish(m, status, &diags, out, fault);
}

/// Forgets what belonged to the model that was there before.
static void drop_scratch(holonom_mechanism *m) {
    hn_accel_free(m->accel);
    hn_arena_free(m->scratch);
    m->accel = NULL;
    m->scratch = NULL;
}

holonom_status holonom_set(holonom_mechanism *m, const char *parameter, double value,
                           holonom_fault *fault) {
    HN_ASSERT(m && parameter);
    hn_diags diags = {0};
    int k = 0;
    while (k < m->n_settings && strcmp(m->settings[k].name, parameter) != 0) {
        k++;
    }
    const int n = k < m->n_settings ? m->n_settings : m->n_settings + 1;

    // a new list, which the mechanism takes over only if the scene accepts it
    hn_setting *settings = hn_arena_get(m->arena, (size_t)n * sizeof *settings);
    const char *name = hn_arena_strdup(m->arena, parameter);
    if (!settings || !name) {
        return fail(fault, HN_ERR_MEMORY, NULL);
    }
    if (m->n_settings > 0) {
        memcpy(settings, m->settings, (size_t)m->n_settings * sizeof *settings);
    }
    settings[k] = (hn_setting){.name = name, .value = value};

    shared_model *fresh = NULL;
    const hn_status status = load_model(m, settings, n, &fresh, &diags);
    if (status != HN_OK) {
        return fail_first(fault, status, &diags);
    }
    drop_scratch(m);
    release(m->shared);
    m->shared = fresh;
    m->settings = settings;
    m->n_settings = n;
    return HOLONOM_OK;
}

void holonom_free(holonom_mechanism *m) {
    if (m) {
        drop_scratch(m);
        release(m->shared);
        hn_library_free(m->library);
        hn_arena_free(m->arena);
        free(m->text);
        free(m);
    }
}

// ---- what a mechanism has ----

static const hn_system *system_of(const holonom_mechanism *m) {
    return hn_model_system(m->shared->model);
}

holonom_sizes holonom_get_sizes(const holonom_mechanism *m) {
    const hn_system_info info = hn_system_get_info(system_of(m));
    const hn_assembly *assembly = hn_model_assembly(m->shared->model);
    return (holonom_sizes){.coordinates = info.n_user,
                           .constraints = info.nc,
                           .dof = info.nv - assembly->rank,
                           .redundant = info.nc - assembly->rank,
                           .points = info.n_points};
}

static const hn_coordinate *coordinate(const holonom_mechanism *m, int i) {
    const hn_system *sys = system_of(m);
    const bool there = i >= 0 && i < hn_system_get_info(sys).n_user;
    return there ? &hn_system_scene(sys)->coordinates[hn_system_user_coordinate(sys, i)] : NULL;
}

const char *holonom_coordinate_name(const holonom_mechanism *m, int i) {
    const hn_coordinate *c = coordinate(m, i);
    return c ? c->name : NULL;
}

const char *holonom_rate_name(const holonom_mechanism *m, int i) {
    const hn_coordinate *c = coordinate(m, i);
    return c ? c->rate : NULL;
}

void holonom_start(const holonom_mechanism *m, double *q, double *v) {
    hn_system_to_user(system_of(m), hn_model_q(m->shared->model), q);
    hn_system_rates_to_user(system_of(m), hn_model_v(m->shared->model), v);
}

/// Makes the evaluator and its vectors, once for each model.
static hn_status prepare(holonom_mechanism *m) {
    if (m->accel) {
        return HN_OK;
    }
    const hn_system_info info = hn_system_get_info(system_of(m));
    m->scratch = m->scratch ? m->scratch : hn_arena_create(0);
    if (!m->scratch) {
        return HN_ERR_MEMORY;
    }
    m->q = hn_arena_doubles(m->scratch, (size_t)info.nq + 1);
    m->v = hn_arena_doubles(m->scratch, (size_t)info.nv + 1);
    m->a = hn_arena_doubles(m->scratch, (size_t)info.nv + 1);
    m->lambda = hn_arena_doubles(m->scratch, (size_t)info.nc + 1);
    HN_TRY(hn_arena_failed(m->scratch) ? HN_ERR_MEMORY : HN_OK);
    return hn_accel_create(system_of(m), &(hn_accel_opts){.want_lambda = 1}, m->scratch, &m->accel);
}

holonom_status holonom_accelerations(holonom_mechanism *m, double t, const double *q,
                                     const double *v, double *a, double *lambda,
                                     holonom_fault *fault) {
    HN_ASSERT(m && q && v && a);
    hn_status status = prepare(m);
    if (status != HN_OK) {
        return fail(fault, status, NULL);
    }

    // in the system's own coordinates, and back
    const hn_system *sys = system_of(m);
    hn_accel_info info;
    hn_system_from_user(sys, q, m->q);
    hn_system_rates_from_user(sys, v, m->v);
    status = hn_accel_eval(m->accel, t, m->q, m->v, 0, 0, m->a, m->lambda, &info);
    if (status != HN_OK) {
        return fail(fault, status, NULL);
    }
    hn_system_rates_to_user(sys, m->a, a);
    if (lambda) {
        memcpy(lambda, m->lambda, (size_t)hn_system_get_info(sys).nc * sizeof *lambda);
    }
    return HOLONOM_OK;
}

// ---- runs ----

holonom_status holonom_run_create(const holonom_mechanism *m, const char *method, holonom_run **out,
                                  holonom_fault *fault) {
    HN_ASSERT(m && method && out);

    // read the method's spelling
    hn_diag diag = {0};
    hn_method_spec spec;
    const hn_model *model = m->shared->model;
    hn_status status = hn_method_parse(method, &spec, &diag);

    // start the run
    hn_run *run = NULL;
    if (status == HN_OK) {
        const hn_run_opts opts = hn_run_opts_default();
        status = hn_run_create(hn_model_system(model), &spec, hn_model_q(model), hn_model_v(model),
                               &opts, &run, &diag);
    }

    // wrap it; the run shares the model with the mechanism
    holonom_run *r = status == HN_OK ? calloc(1, sizeof *r) : NULL;
    if (!r) {
        hn_run_free(run);
        return fail(fault, status == HN_OK ? HN_ERR_MEMORY : status, &diag);
    }

    r->run = run;
    r->shared = hold(m->shared);
    *out = r;
    return HOLONOM_OK;
}

void holonom_run_free(holonom_run *run) {
    if (run) {
        hn_run_free(run->run);
        release(run->shared);
        free(run);
    }
}

/// Fills the sample for a caller from the run's own.
static void put_sample(const hn_sample *s, holonom_sample *out) {
    *out = (holonom_sample){.t = s->t,
                            .q = s->q,
                            .v = s->v,
                            .a = s->a,
                            .lambda = s->lambda,
                            .points = s->points,
                            .gap = s->gap,
                            .velocity_gap = s->velocity_gap,
                            .energy_change = s->energy_change,
                            .work = s->work};
}

holonom_status holonom_run_to(holonom_run *run, double t, holonom_sample *out,
                              holonom_fault *fault) {
    HN_ASSERT(run);

    // advance; a run that ends early gives its own reason
    hn_diag diag = {0};
    hn_status status = hn_run_advance(run->run, t);
    if (status != HN_OK) {
        const hn_run_summary summary = hn_run_get_summary(run->run);
        snprintf(diag.message, sizeof diag.message, "%s", summary.reason);
        (void)fail(fault, status, &diag);
        return HOLONOM_ENDED;
    }

    // sample there
    if (out) {
        status = hn_run_sample(run->run, t, &run->sample);
        if (status != HN_OK) {
            const char *why = hn_run_sample_why(run->run, status);
            snprintf(diag.message, sizeof diag.message, "%s", why ? why : "");
            (void)fail(fault, status, &diag);
            return HOLONOM_ENDED;
        }
        put_sample(&run->sample, out);
    }
    return HOLONOM_OK;
}

holonom_result holonom_run_result(const holonom_run *run) {
    const hn_run_summary s = hn_run_get_summary(run->run);
    holonom_result r = {.status = s.status == HN_OK ? HOLONOM_OK : HOLONOM_ENDED,
                        .t = s.t,
                        .gap = s.worst_gap,
                        .velocity_gap = s.worst_velocity_gap,
                        .energy_change = s.worst_energy_change,
                        .steps = s.steps,
                        .evaluations = s.cost.evals,
                        .operations = hn_cost_known_ops(&s.cost),
                        .seconds = s.cpu_seconds};
    snprintf(r.reason, sizeof r.reason, "%s", s.reason);
    return r;
}

holonom_status holonom_compare(const holonom_mechanism *m, const char *const *methods, int n,
                               double time, holonom_result *results, holonom_fault *fault) {
    HN_ASSERT(m && (methods || n == 0) && (results || n == 0));
    for (int i = 0; i < n; i++) {
        holonom_run *run = NULL;
        const holonom_status status = holonom_run_create(m, methods[i], &run, fault);
        if (status != HOLONOM_OK) {
            if (fault) {
                snprintf(fault->where, sizeof fault->where, "/methods/%d", i);
            }
            return status;
        }

        // the end of a run, early or not, is in its result
        (void)holonom_run_to(run, time, NULL, NULL);
        results[i] = holonom_run_result(run);
        holonom_run_free(run);
    }
    return HOLONOM_OK;
}

// ---- many runs ----

/// Starts and ends of many runs, in the system's own coordinates.
typedef struct many {
    hn_arena *arena;
    hn_ensemble *ensemble;
    double *q, *v, *q_end, *v_end; ///< n rows each
    hn_ensemble_start *starts;
    hn_ensemble_end *ends;
} many;

static hn_status make_many(const hn_system *sys, const char *method, int n, many *all,
                           hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    const hn_ensemble_opts opts = hn_ensemble_opts_default();
    const size_t rows = (size_t)n;
    hn_method_spec spec;
    HN_TRY(hn_method_parse(method, &spec, diag));
    HN_TRY(hn_ensemble_create(sys, &spec, &opts, &all->ensemble, diag));
    all->arena = hn_arena_create(0);
    if (!all->arena) {
        return HN_ERR_MEMORY;
    }
    all->q = hn_arena_doubles(all->arena, rows * (size_t)info.nq);
    all->v = hn_arena_doubles(all->arena, rows * (size_t)info.nv);
    all->q_end = hn_arena_doubles(all->arena, rows * (size_t)info.nq);
    all->v_end = hn_arena_doubles(all->arena, rows * (size_t)info.nv);
    all->starts = hn_arena_get(all->arena, (rows + 1) * sizeof *all->starts);
    all->ends = hn_arena_get(all->arena, (rows + 1) * sizeof *all->ends);
    return hn_arena_failed(all->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// Runs from rows of the caller's coordinates and writes the ends over them.
static void run_rows(const hn_system *sys, many *all, int n, double time, double *q, double *v,
                     holonom_ending *endings) {
    const hn_system_info info = hn_system_get_info(sys);
    const size_t user = (size_t)info.n_user, nq = (size_t)info.nq, nv = (size_t)info.nv;
    for (size_t k = 0; k < (size_t)n; k++) {
        hn_system_from_user(sys, q + k * user, all->q + k * nq);
        hn_system_rates_from_user(sys, v + k * user, all->v + k * nv);
        all->starts[k] = hn_ensemble_start_of(all->ensemble, all->q + k * nq, all->v + k * nv);
    }
    hn_ensemble_run(all->ensemble, n, all->starts, time, all->q_end, all->v_end, all->ends);
    for (size_t k = 0; k < (size_t)n; k++) {
        const hn_ensemble_end *end = &all->ends[k];
        hn_system_to_user(sys, all->q_end + k * nq, q + k * user);
        hn_system_rates_to_user(sys, all->v_end + k * nv, v + k * user);
        endings[k] =
            (holonom_ending){.status = status_of(end->status), .t = end->t, .steps = end->steps};
    }
}

holonom_status holonom_run_many(const holonom_mechanism *m, const char *method, int n, double time,
                                double *q, double *v, holonom_ending *endings,
                                holonom_fault *fault) {
    HN_ASSERT(m && method && n >= 0 && (n == 0 || (q && v && endings)));
    const hn_system *sys = system_of(m);
    many all = {0};
    hn_diag diag = {0};
    hn_status status = isfinite(time) ? make_many(sys, method, n, &all, &diag)
                                      : hn_diag_set(&diag, HN_ERR_INPUT, NULL, NULL,
                                                    "the end of the runs is not a finite time");
    if (status == HN_OK) {
        run_rows(sys, &all, n, time, q, v, endings);
    }
    hn_ensemble_free(all.ensemble);
    hn_arena_free(all.arena);
    return status == HN_OK ? HOLONOM_OK : fail(fault, status, &diag);
}
