// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_walk.h"

#include "session/extreme/extreme_internal.h"
#include "session/extreme/extreme_model.h"

#include "linalg/dense.h"
#include "study/run/pace.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void fail_look(hn_extreme_check *look, hn_status status, const char *reason) {
    look->status = status;
    snprintf(look->reason, sizeof look->reason, "%.199s", reason);
}

static const char *first_message(const hn_diags *diags, hn_status status) {
    return diags->n > 0 ? diags->item[0].message : hn_status_text(status);
}

static void refuse(hn_extreme_check *look, hn_status status) {
    char text[sizeof look->reason];
    const hn_diags *d = &look->bench->diags;
    const char *pointer = d->n > 0 ? d->item[0].pointer : "";
    snprintf(text, sizeof text, "%.40s%s%.150s", pointer, pointer[0] ? ": " : "",
             first_message(d, status));
    fail_look(look, status, text);
}

static hn_status make_run(hn_extreme_check *look, const char *method, unsigned needs,
                          hn_run **out) {
    const hn_extreme_trial *t = look->point->trial;
    hn_run_opts opts = hn_run_opts_default();
    hn_method_spec spec;
    hn_diag diag = {0};
    opts.max_steps = (long long)t->max_steps;
    opts.raw_lambda = (needs & HN_EXTREME_RAW) != 0;
    hn_status status = hn_method_parse(method, &spec, &diag);
    HN_THEN(status, hn_run_create(hn_model_system(look->model), &spec, look->q, look->v, &opts, out,
                                  &diag));
    if (status != HN_OK) {
        fail_look(look, status, diag.message[0] ? diag.message : hn_status_text(status));
    }
    return status;
}

/// Largest |v| of the system's speeds now; NaN when it cannot be sampled.
static double largest_speed(const hn_extreme_check *look) {
    hn_sample s;
    const int n = hn_system_get_info(hn_model_system(look->model)).n_user;
    return hn_run_sample(look->run, hn_run_time(look->run), &s) == HN_OK ? hn_norm_max(n, s.v)
                                                                         : (double)NAN;
}

/// Steps to the end of the trial and records the smallest step and the largest velocities.
static hn_walk_end walk_steps(hn_extreme_check *look, const hn_walk_limits *limits) {
    const double T = look->time;
    double before = 0;
    look->least_step = HUGE_VAL;
    hn_pace pace = hn_pace_begin();

    // one step at a time, to the end of the trial
    while (hn_run_time(look->run) < T * (1 - 1e-12)) {
        if (hn_run_step_towards(look->run, T) != HN_OK) {
            return HN_WALK_FAILED;
        }

        // the smallest step; the last one may be cut short
        const double t = hn_run_time(look->run), h = t - before;
        if (t < T || before == 0) {
            look->least_step = fmin(look->least_step, h);
        }

        before = t;

        // the largest velocity in the first and in the last tenth
        if (t <= T / 10 || t >= 0.9 * T) {
            double *window = t <= T / 10 ? &look->first : &look->last;
            *window = fmax(*window, largest_speed(look));
        }

        // stop on request
        if (hn_pace_is_due(&pace) && limits->stop(limits->user)) {
            return HN_WALK_STOPPED;
        }
    }
    return HN_WALK_DONE;
}

static void walk(hn_extreme_check *look, unsigned needs) {
    const hn_walk_limits limits = {.stop = hn_extreme_is_stopped, .user = look->bench};
    const int each = (needs & HN_EXTREME_EACH_STEP) != 0;
    const hn_walk_end end =
        each ? walk_steps(look, &limits) : hn_walk(look->run, look->time, 1, &limits, NULL, NULL);
    look->summary = hn_run_get_summary(look->run);
    if (end == HN_WALK_STOPPED || end == HN_WALK_OVER) {
        fail_look(look, HN_ERR_STOPPED, "stopped");
    } else if (end == HN_WALK_FAILED) {
        fail_look(look, look->summary.status, look->summary.reason);
    } else {
        look->status = hn_run_sample(look->run, look->time, &look->end);
        if (look->status != HN_OK) {
            fail_look(look, look->status, hn_status_text(look->status));
        }
    }
}

/// Computes the end state of the truth method, once for each model and time.
static hn_status find_truth(hn_extreme_check *look) {
    hn_extreme_bench *bench = look->bench;
    const hn_extreme_trial *t = look->point->trial;
    const hn_system_info info = hn_system_get_info(hn_model_system(look->model));
    const size_t n = (size_t)info.n_user, nc = (size_t)info.nc;

    // the exact end of the last point serves while trial and time are the same
    if (bench->truth_trial == t && bench->truth_time == look->time) {
        return HN_OK;
    }

    // make room for the exact end; it outlives this run
    hn_arena_free(bench->truth_arena);
    bench->truth_trial = NULL;
    bench->truth_arena = hn_arena_create(1 << 12);
    if (!bench->truth_arena) {
        return HN_ERR_MEMORY;
    }
    bench->truth_q = hn_arena_doubles(bench->truth_arena, n);
    bench->truth_v = hn_arena_doubles(bench->truth_arena, n);
    bench->truth_lambda = hn_arena_doubles(bench->truth_arena, nc);
    if (hn_arena_failed(bench->truth_arena)) {
        return HN_ERR_MEMORY;
    }

    // run the truth method on the same model
    hn_extreme_check exact = *look;
    hn_status status = make_run(&exact, t->truth_method, 0, &exact.run);
    if (status == HN_OK) {
        hn_run_watch(exact.run, 0);
        walk(&exact, 0);
        status = exact.status;
    }

    // keep its end, or report why it has none
    if (status == HN_OK) {
        memcpy(bench->truth_q, exact.end.q, n * sizeof(double));
        memcpy(bench->truth_v, exact.end.v, n * sizeof(double));
        memcpy(bench->truth_lambda, exact.end.lambda, nc * sizeof(double));
        bench->truth_trial = t;
        bench->truth_time = look->time;
    } else {
        char text[sizeof look->reason];
        snprintf(text, sizeof text, "the truth: %.180s", exact.reason);
        fail_look(look, status, text);
    }

    hn_run_free(exact.run);
    return status;
}

static hn_status use_truth(hn_extreme_check *look) {
    if (look->point->trial->truth_method) {
        const hn_status status = find_truth(look);
        look->truth = look->bench->truth_q;
        look->truth_v = look->bench->truth_v;
        look->truth_lambda = look->bench->truth_lambda;
        return status;
    }
    return HN_OK; // the trial gives exact values by name; the quantity reads them
}

void hn_extreme_check_begin(hn_extreme_bench *bench, const hn_extreme_point *point, unsigned needs,
                            hn_extreme_check *look) {
    const hn_extreme_trial *t = point->trial;

    // the model of this point
    memset(look, 0, sizeof *look);
    look->bench = bench;
    look->point = point;
    look->model = hn_extreme_model(bench, point);
    if (!look->model) {
        refuse(look, bench->load_status);
        return;
    }

    // quantities of the model alone need no run
    if (needs & HN_EXTREME_MODEL || !point->method[0]) {
        return;
    }

    // the end time, the method's spelling and the start
    char method[256];
    double *q = NULL, *v = NULL;
    look->arena = hn_arena_create(1 << 12);
    hn_status status =
        look->arena ? hn_extreme_value(&t->time, t->sweep, point->value, &look->time, &bench->diags)
                    : HN_ERR_MEMORY;
    HN_THEN(status, hn_extreme_spell(point, method, &bench->diags));
    HN_THEN(status, hn_extreme_start(bench, look->model, t, look->arena, &q, &v));
    if (status != HN_OK) {
        refuse(look, status);
        return;
    }

    look->q = q;
    look->v = v;

    // the exact end, if needed, and the run
    if (((needs & HN_EXTREME_TRUTH) && use_truth(look) != HN_OK) ||
        make_run(look, method, needs, &look->run) != HN_OK) {
        return;
    }

    // sample the start, then run to the end
    hn_sample start;
    look->status = hn_run_sample(look->run, 0, &start);
    look->start_energy = look->status == HN_OK ? start.energy : (double)NAN;
    if (!(needs & HN_EXTREME_WATCHED)) {
        hn_run_watch(look->run, 0);
    }
    walk(look, needs);
}

void hn_extreme_check_end(hn_extreme_check *look) {
    hn_run_free(look->run);
    hn_arena_free(look->arena);
}
