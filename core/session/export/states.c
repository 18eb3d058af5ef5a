// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/states.h"

#include "base/clock.h"
#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "integrators/method/method_spec.h"
#include "study/run/run.h"

#include <math.h>
#include <string.h>

static const double LATER = 0.5;             // [s] of the later state, or the scene's duration
static const long long MOST_STEPS = 2000000; // on the way to it

/// Methods for the way to the later state, tried in this order: explicit, then for stiff scenes.
static const char *const PRECISE[] = {"projection@dop853:rtol=1e-12", "ggl@radau5:rtol=1e-10"};

/// Room for a state.
static hn_status make_state(hn_exporter *e, hn_export_state *s) {
    s->q = hn_arena_doubles(e->arena, (size_t)e->info.nq + 1);
    s->v = hn_arena_doubles(e->arena, (size_t)e->info.nv + 1);
    s->a = hn_arena_doubles(e->arena, (size_t)e->info.nv + 1);
    return hn_arena_failed(e->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// Fills a state from the coordinates of the scene, which both systems share.
static void set_state(const hn_exporter *e, const double *user_q, const double *user_v,
                      hn_export_state *s) {
    hn_system_from_user(e->sys, user_q, s->q);
    hn_system_rates_from_user(e->sys, user_v, s->v);
}

/// Steps to a time within the limits.
static hn_status advance(const hn_exporter *e, double t, hn_run *run) {
    hn_walk_limits left = e->limits;
    if (left.seconds > 0) {
        left.seconds = fmax(left.seconds - (hn_clock_thread() - e->started), 1e-9);
    }
    switch (hn_walk(run, t, 1, &left, NULL, NULL)) {
    case HN_WALK_DONE:
        return HN_OK;
    case HN_WALK_FAILED:
        return hn_run_get_summary(run).status;
    case HN_WALK_OVER:
    case HN_WALK_STOPPED:
        return HN_ERR_STOPPED;
    }
    return HN_ERR_INTERNAL;
}

/// Runs to the time of a state by one method; HN_OK with the state, or why not.
static hn_status run_to(hn_exporter *e, const char *method, hn_export_state *to, hn_diag *why) {
    hn_method_spec spec;
    hn_run_opts opts = hn_run_opts_default();
    hn_run *run = NULL;
    hn_sample sample;
    opts.max_steps = MOST_STEPS;

    // a run of its own, to one sample
    HN_TRY(hn_method_parse(method, &spec, why));
    HN_TRY(hn_run_create(hn_model_system(e->model), &spec, hn_model_q(e->model),
                         hn_model_v(e->model), &opts, &run, why));
    hn_status status = advance(e, to->t, run);
    HN_THEN(status, hn_run_sample(run, to->t, &sample));

    // behind a singular configuration solvers may part
    double singular;
    if (status == HN_OK && hn_run_passed_singular(run, &singular) && singular > 0) {
        status = hn_diag_set(why, HN_ERR_SINGULAR, NULL, NULL,
                             "the motion passes a singular configuration at t = %.4g s", singular);
    }
    if (status == HN_OK) {
        set_state(e, sample.q, sample.v, to);
        hn_system_rates_from_user(e->sys, sample.a, to->a);
    } else if (status != HN_ERR_SINGULAR) {
        const char *reason = hn_run_get_summary(run).reason;
        (void)hn_diag_set(why, status, "/method", NULL, "%s: %s", method,
                          *reason ? reason : hn_status_text(status));
    }
    hn_run_free(run);
    return status;
}

/// The later state: before the first singular configuration, where solvers may part.
static hn_status find_later(hn_exporter *e, hn_diags *diags) {
    hn_diag why = {0};
    e->later.t = fmin(hn_model_scene(e->model)->duration, LATER);
    for (int half = 0; half < 5; half++, e->later.t /= 2) {
        for (size_t i = 0; i < sizeof PRECISE / sizeof *PRECISE; i++) {
            if (run_to(e, PRECISE[i], &e->later, &why) == HN_OK) {
                return HN_OK;
            }
            if (hn_walk_ask(&e->limits, e->started) != HN_WALK_DONE) {
                return hn_diags_add(
                    diags, HN_ERR_STOPPED, NULL, NULL,
                    "computing the later state of the self-check took longer than allowed");
            }
        }
    }
    return hn_diags_add(diags, why.status, why.pointer, why.hint, "%s", why.message);
}

/// The start in the coordinates of the scene, with its accelerations.
static hn_status read_start(const hn_exporter *e, double *q, double *v, double *a) {
    const hn_system *sys = hn_model_system(e->model);
    double *own = hn_arena_doubles(e->arena, (size_t)e->info.nv + 1);
    hn_accel *accel = NULL;
    hn_accel_info info;
    if (!own) {
        return HN_ERR_MEMORY;
    }
    hn_system_to_user(sys, hn_model_q(e->model), q);
    hn_system_rates_to_user(sys, hn_model_v(e->model), v);
    HN_TRY(hn_accel_create(sys, &(hn_accel_opts){.want_lambda = 0}, e->arena, &accel));
    const hn_status status =
        hn_accel_eval(accel, 0, hn_model_q(e->model), hn_model_v(e->model), 0, 0, own, NULL, &info);
    hn_accel_free(accel);
    hn_system_rates_to_user(sys, own, a);
    return status;
}

/// Compiles the system, with parameters as symbols where that can be done.
static hn_status compile(hn_exporter *e, hn_diags *diags) {
    hn_system_opts opts = hn_system_opts_default();
    opts.symbolic_params = 1;
    hn_diags ignored = {0};
    if (hn_system_compile(hn_model_scene(e->model), &opts, &e->sys, &ignored) != HN_OK) {
        // rows that vanish only for these numbers: parameters are folded in
        HN_TRY(hn_system_compile(hn_model_scene(e->model), NULL, &e->sys, diags));
    }
    e->info = hn_system_get_info(e->sys);
    e->x = hn_system_get_exprs(e->sys);
    e->M = hn_system_dense_mass(e->sys, e->arena);
    e->J = hn_system_dense_jacobian(e->sys, e->arena);
    return e->M && e->J ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_export_states_find(hn_exporter *e, hn_diags *diags) {
    HN_TRY(compile(e, diags));
    hn_export_state user = {0};
    HN_TRY(make_state(e, &user));
    HN_TRY(make_state(e, &e->start));
    HN_TRY(make_state(e, &e->later));
    HN_TRY(read_start(e, user.q, user.v, user.a));
    set_state(e, user.q, user.v, &e->start);
    hn_system_rates_from_user(e->sys, user.a, e->start.a);
    e->energy = hn_model_assembly(e->model)->energy;
    return find_later(e, diags);
}

hn_status hn_export_state_at(hn_exporter *e, double t, hn_export_state *out, hn_diags *diags) {
    hn_diag why = {0};
    HN_TRY(make_state(e, out));
    out->t = t;
    for (size_t i = 0; i < sizeof PRECISE / sizeof *PRECISE; i++) {
        if (run_to(e, PRECISE[i], out, &why) == HN_OK) {
            return HN_OK;
        }
    }
    return hn_diags_add(diags, why.status, why.pointer, why.hint, "%s", why.message);
}
