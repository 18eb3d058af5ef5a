// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/references/reference_doc.h"

#include "session/references/reference_store.h"
#include "session/references/references.h"
#include "session/store/columns_json.h"

#include "base/hash.h"
#include "study/run/pace.h"

#include <float.h>
#include <math.h>
#include <string.h>

// The second method, with its fixed step, passes singular configurations. There an adaptive method
// with so small a tolerance gets stuck.
static const char *const MOTION_METHODS[] = {"projection@dop853:rtol=1e-13",
                                             "projection@rk4:h=2e-4"};
enum { N_MOTION_METHODS = sizeof MOTION_METHODS / sizeof *MOTION_METHODS };
static const double SAME_TIME = 1e-12; // relative

// what is stored ----

static void put_errors(hn_strbuf *b, const char *key, const double e[HN_ERROR_COUNT]) {
    hn_json_key(b, key);
    hn_json_object(b);
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        if (i != HN_ERROR_GAP && i != HN_ERROR_VELOCITY_GAP) { // measured, never compared
            hn_json_put_number(b, hn_error_name((hn_error_kind)i), e[i]);
        }
    }
    hn_json_end_object(b);
}

static void put_head(hn_strbuf *b, const hn_model *model, const hn_ref *ref, hn_ref_source source) {
    char hex[17];
    hn_hash_hex(ref->scene, hex);

    // identity of the scene and of the reference
    hn_json_put_string(b, "scene", hn_model_scene(model)->id);
    hn_json_put_string(b, "scene_hash", hex);
    hn_json_put_string(b, "source", hn_ref_source_name(source));
    hn_json_put_number(b, "time", ref->T);
    hn_json_put_number(b, "duration", hn_model_scene(model)->duration);

    // methods of the two computations, and how far they agree
    hn_json_key(b, "means");
    hn_json_array(b);
    for (int i = 0; i < HN_REF_MEANS; i++) {
        hn_json_string(b, ref->means[i]);
    }
    hn_json_end_array(b);
    hn_json_put_string(b, "refused", ref->refused);
    hn_json_put_number(b, "digits", hn_ref_digits(ref));
    put_errors(b, "error", ref->error);

    // scales by which errors are divided
    hn_json_key(b, "scales");
    hn_json_object(b);
    hn_json_put_number(b, "length", ref->scales.length);
    hn_json_put_number(b, "rate", ref->scales.rate);
    hn_json_put_number(b, "reaction", ref->scales.reaction);
    hn_json_put_number(b, "energy", ref->scales.energy);
    hn_json_end_object(b);
}

static void put_times(hn_strbuf *b, const hn_ref *ref) {
    hn_json_key(b, "t");
    hn_json_array(b);
    for (int k = 0; k <= ref->n; k++) {
        hn_json_number(b, hn_ref_at(ref, k).t);
    }
    hn_json_end_array(b);
}

/// Writes the object without its closing brace.
static void put_stored(hn_strbuf *b, const hn_model *model, const hn_ref *ref,
                       hn_ref_source source) {
    hn_json_object(b);
    put_head(b, model, ref, source);
    hn_columns_put_coordinates(b, hn_model_system(model));
    hn_columns_put_rows(b, hn_model_system(model));
    put_times(b, ref);
    hn_columns_put_table(b, "q", ref->q, ref->n + 1, ref->n_user);
    hn_columns_put_table(b, "v", ref->v, ref->n + 1, ref->n_user);
    hn_columns_put_table(b, "lambda", ref->lambda, ref->n + 1, ref->nc);
    hn_json_put_numbers(b, "energy", ref->energy, (size_t)ref->n + 1);
    hn_json_key(b, "digits_at");
    hn_json_array(b);
    for (int k = 0; k <= ref->n; k++) {
        const double e = ref->between[(size_t)k * HN_ERROR_COUNT + HN_ERROR_Q];
        hn_json_number(b, fmin(16, -log10(fmax(e, DBL_MIN))));
    }
    hn_json_end_array(b);
}

void hn_reference_json(hn_strbuf *b, const hn_model *model, const hn_ref *ref,
                       hn_ref_source source) {
    put_stored(b, model, ref, source);
    hn_json_end_object(b);
}

// the motion between ----

typedef struct motion {
    const hn_ref *ref;
    hn_errors *errors;
    hn_run *run;
    const char *method;
    int n, n_user, n_points; ///< n + 1 samples
    double every, between;
    double *q, *points, *energy;
    double started;
    hn_pace pace;
    const hn_walk_limits *limits;
} motion;

static hn_status check_size(const motion *m, hn_diags *diags) {
    const double samples = floor(m->ref->T / m->every) + 1;
    const double numbers = samples * (m->n_user + 3.0 * m->n_points + 1);
    if (!(m->every > 0) || !isfinite(m->every)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/every", NULL,
                            "the time between samples is %g s; it must be above 0", m->every);
    }
    if (!(samples <= HN_REF_MOTION_SAMPLES + 1) || !(numbers <= HN_REF_MOTION_NUMBERS)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/every", "take a longer time between samples",
                            "%.0f samples of %.0f numbers were asked for; one answer holds at most "
                            "%d samples and %d numbers",
                            samples, numbers / samples, HN_REF_MOTION_SAMPLES,
                            HN_REF_MOTION_NUMBERS);
    }
    return HN_OK;
}

static hn_status step_to(motion *m, double t) {
    while (hn_run_time(m->run) < t * (1 - SAME_TIME)) {
        const hn_status status = hn_run_step_towards(m->run, t);
        if (status != HN_OK) {
            return status;
        }
        if (hn_pace_is_due(&m->pace) && hn_walk_ask(m->limits, m->started) != HN_WALK_DONE) {
            return HN_ERR_STOPPED;
        }
    }
    return HN_OK;
}

static void keep(motion *m, int k, const hn_sample *s) {
    const size_t nu = (size_t)m->n_user, np = 3 * (size_t)m->n_points;
    memcpy(m->q + (size_t)k * nu, s->q, nu * sizeof(double));
    memcpy(m->points + (size_t)k * np, s->points, np * sizeof(double));
    m->energy[k] = s->energy;
}

/// Goes through the stored and the requested times in ascending order.
static hn_status follow(motion *m) {
    int k = 0, node = 0;
    while (k <= m->n || node <= m->ref->n) {
        const double asked = k <= m->n ? k * m->every : HUGE_VAL,
                     stored = node <= m->ref->n ? hn_ref_at(m->ref, node).t : HUGE_VAL;
        const double t = fmin(fmin(asked, stored), m->ref->T);

        // go to the earlier of the two times
        hn_sample s;
        hn_status status = step_to(m, t);
        HN_THEN(status, hn_run_sample(m->run, t, &s));
        if (status != HN_OK) {
            return status;
        }

        // keep what was asked for; compare with what is stored
        if (asked <= stored) {
            keep(m, k++, &s);
        }
        if (stored <= asked) {
            const double e = hn_errors_between(m->errors, s.q, hn_ref_at(m->ref, node++).q);
            m->between = isnan(e) ? e : fmax(m->between, e);
        }
    }
    return isfinite(m->between) ? HN_OK : HN_ERR_DIVERGED;
}

static hn_status prepare(motion *m, const hn_model *model, hn_arena *arena) {
    m->n = (int)floor(m->ref->T / m->every * (1 + SAME_TIME));
    const size_t rows = (size_t)m->n + 1;
    m->q = hn_arena_doubles(arena, rows * (size_t)m->n_user);
    m->points = hn_arena_doubles(arena, rows * 3 * (size_t)m->n_points);
    m->energy = hn_arena_doubles(arena, rows);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY
                                  : hn_errors_create(hn_model_system(model), arena, &m->errors);
}

static hn_status start(motion *m, const hn_model *model, const char *method, hn_diags *diags) {
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run_free(m->run);
    m->run = NULL;
    m->method = method;
    m->between = 0;
    hn_status status = hn_method_parse(method, &spec, &diag);
    HN_THEN(status, hn_run_create(hn_model_system(model), &spec, hn_model_q(model),
                                  hn_model_v(model), NULL, &m->run, &diag));
    if (status != HN_OK) {
        return hn_diags_add(diags, status, diag.pointer, diag.hint, "%s",
                            diag.message[0] ? diag.message : hn_status_text(status));
    }
    hn_run_watch(m->run, 0);
    return HN_OK;
}

static hn_status add_failure(const motion *m, hn_status status, hn_diags *diags) {
    const hn_run_summary s = hn_run_get_summary(m->run);
    return hn_diags_add(diags, status, NULL, NULL,
                        "between the stored times, by %s at t = %.6g s: %s", m->method, s.t,
                        s.reason[0] ? s.reason : hn_status_text(status));
}

/// Integrates by the first method that reaches the end; reports the failure of the last one.
static hn_status move(motion *m, const hn_model *model, hn_diags *diags) {
    hn_status status = HN_ERR_INPUT;
    m->pace = hn_pace_begin();
    m->started = m->pace.last;
    for (int k = 0; k < N_MOTION_METHODS; k++) {
        const hn_status ready = start(m, model, MOTION_METHODS[k], diags);
        if (ready != HN_OK) {
            return ready;
        }
        status = follow(m);
        if (status == HN_OK || status == HN_ERR_STOPPED) {
            break;
        }
    }
    return status == HN_OK ? HN_OK : add_failure(m, status, diags);
}

static void put_motion(hn_strbuf *b, const motion *m) {
    hn_json_key(b, "motion");
    hn_json_object(b);
    hn_json_put_number(b, "every", m->every);
    hn_json_put_string(b, "method", m->method);
    hn_json_put_number(b, "between", fmax(m->between, m->ref->error[HN_ERROR_Q]));
    hn_columns_put_table(b, "q", m->q, m->n + 1, m->n_user);
    hn_columns_put_table(b, "points", m->points, m->n + 1, 3 * m->n_points);
    hn_json_put_numbers(b, "energy", m->energy, (size_t)m->n + 1);
    hn_json_end_object(b);
}

hn_status hn_reference_motion_json(hn_strbuf *b, const hn_model *model, const hn_ref *ref,
                                   hn_ref_source source, double every, const hn_walk_limits *limits,
                                   hn_diags *diags) {
    static const hn_walk_limits none;
    const hn_system_info info = hn_system_get_info(hn_model_system(model));
    motion m = {.ref = ref,
                .n_user = info.n_user,
                .n_points = info.n_points,
                .every = every,
                .limits = limits ? limits : &none};
    hn_status status = check_size(&m, diags);
    hn_arena *arena = status == HN_OK ? hn_arena_create(0) : NULL;
    if (status == HN_OK) {
        status = arena ? prepare(&m, model, arena) : HN_ERR_MEMORY;
        if (status != HN_OK) {
            hn_diags_add(diags, status, NULL, NULL, "%s", hn_status_text(status));
        }
    }
    HN_THEN(status, move(&m, model, diags));
    if (status == HN_OK) {
        put_stored(b, model, ref, source);
        put_motion(b, &m);
        hn_json_end_object(b);
    }
    hn_run_free(m.run);
    hn_errors_free(m.errors);
    hn_arena_free(arena);
    return status;
}
