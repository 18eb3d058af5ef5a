// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/truth/refined.h"

#include "base/clock.h"
#include "dynamics/compile/coordinates.h"

#include <math.h>
#include <string.h>

enum { MOST_NUMBERS = 4000000, MOST_STEPS = 20000 }; // of the whole; of one interval

// The second passes singular configurations. There an adaptive method with so small a tolerance
// gets stuck.
static const char *const METHODS[] = {"projection@dop853:rtol=1e-13", "projection@rk4:h=2e-4"};
enum { N_METHODS = sizeof METHODS / sizeof *METHODS };

typedef struct refining {
    const hn_system *sys;
    hn_refined *out;
    hn_errors *errors;
    const hn_walk_limits *limits;
    double started;       ///< [s] of this thread
    double ops, most_ops; ///< of all runs before; for all
    hn_walk_end end;      ///< what the limits said last
    double *q, *v;        ///< system coordinates of a stored state
} refining;

hn_state_seen hn_refined_at(const hn_refined *r, int k) {
    const hn_ref *ref = r->ref;
    if (k % r->parts == 0) {
        return hn_ref_at(ref, k / r->parts);
    }
    const size_t row = (size_t)k, nu = (size_t)ref->n_user;
    return (hn_state_seen){.t = ref->T * k / (ref->n * r->parts),
                           .q = r->q + row * nu,
                           .v = r->v + row * nu,
                           .lambda = r->lambda + row * (size_t)ref->nc,
                           .energy = r->energy[row]};
}

const double *hn_refined_error(const hn_refined *r, int k) {
    return k % r->parts == 0 ? NULL : r->error + (size_t)(k / r->parts) * HN_ERROR_COUNT;
}

static void keep(hn_refined *r, int k, const hn_sample *s) {
    const size_t row = (size_t)k, nu = (size_t)r->ref->n_user, nc = (size_t)r->ref->nc;
    memcpy(r->q + row * nu, s->q, nu * sizeof(double));
    memcpy(r->v + row * nu, s->v, nu * sizeof(double));
    if (nc > 0) {
        memcpy(r->lambda + row * nc, s->lambda, nc * sizeof(double));
    }
    r->energy[row] = s->energy;
}

/// Returns whether the limits let the whole go on; keeps what they said.
static bool may_go_on(refining *g) {
    g->end = hn_walk_ask(g->limits, g->started);
    return g->end == HN_WALK_DONE;
}

/// Returns whether operations are left, a run counted that is under way (NULL: none). A count that
/// is not known uses them up.
static bool has_ops(refining *g, const hn_run *run) {
    const double ops = g->ops + (run ? hn_run_get_summary(run).cost.ops : 0);
    const bool enough = ops < g->most_ops;
    g->out->too_long |= !enough;
    return enough;
}

/// Integrates interval number i with a run that stands at its start. HN_ERR_LIMIT: the limits or
/// the operations do not let it go on.
static hn_status follow(refining *g, hn_run *run, int i) {
    hn_refined *r = g->out;
    double *error = r->error + (size_t)i * HN_ERROR_COUNT;
    for (int part = 1; part <= r->parts; part++) {
        const int k = i * r->parts + part;
        const double t = hn_refined_at(r, k).t;
        hn_sample s;
        HN_TRY(hn_run_advance(run, t));
        HN_TRY(hn_run_sample(run, t, &s));
        if (part < r->parts) {
            keep(r, k, &s);
        } else {
            const hn_state_seen end = {s.t, s.q, s.v, s.lambda, s.energy, 0, 0};
            const hn_state_seen stored = hn_ref_at(r->ref, i + 1);
            hn_errors_calc(g->errors, &end, &stored, &r->ref->scales, error);
        }
        if (!may_go_on(g) || (part < r->parts && !has_ops(g, run))) {
            return HN_ERR_LIMIT;
        }
    }
    return isfinite(error[HN_ERROR_Q]) && isfinite(error[HN_ERROR_V]) ? HN_OK : HN_ERR_DIVERGED;
}

static hn_status refine_by(refining *g, const char *method, int i) {
    const hn_ref *ref = g->out->ref;
    const hn_state_seen from = hn_ref_at(ref, i);
    hn_run_opts opts = hn_run_opts_default();
    hn_method_spec spec;
    hn_diag diag = {0};
    hn_run *run = NULL;
    opts.t0 = from.t;
    opts.max_steps = MOST_STEPS;
    hn_system_from_user(g->sys, from.q, g->q);
    hn_system_rates_from_user(g->sys, from.v, g->v);
    hn_status status = hn_method_parse(method, &spec, &diag);
    HN_THEN(status, hn_run_create(g->sys, &spec, g->q, g->v, &opts, &run, &diag));
    if (status == HN_OK) {
        hn_run_watch(run, 0);
        status = follow(g, run, i);
        g->ops += hn_run_get_summary(run).cost.ops;
    }
    hn_run_free(run);
    return status;
}

/// Refines interval number i by the first method that comes to its end. Fails as the whole does.
static hn_status refine(refining *g, int i) {
    double *error = g->out->error + (size_t)i * HN_ERROR_COUNT;
    for (int m = 0; m < N_METHODS && has_ops(g, NULL); m++) {
        const hn_status status = may_go_on(g) ? refine_by(g, METHODS[m], i) : HN_ERR_LIMIT;
        if (g->end != HN_WALK_DONE) {
            return g->end == HN_WALK_STOPPED ? HN_ERR_STOPPED : HN_ERR_LIMIT;
        }
        if (status == HN_OK) {
            g->out->found++;
            return HN_OK;
        }
        for (int kind = 0; kind < HN_ERROR_COUNT; kind++) {
            error[kind] = (double)NAN;
        }
        if (status == HN_ERR_MEMORY || status == HN_ERR_STOPPED) {
            return status; // stopped: the run's equations were not made to the end
        }
    }
    return HN_OK;
}

hn_status hn_refined_create(const hn_system *sys, const hn_ref *ref, hn_errors *errors,
                            double most_ops, const hn_walk_limits *limits, hn_arena *arena,
                            hn_refined **out) {
    const hn_system_info info = hn_system_get_info(sys);
    const size_t n = (size_t)ref->n, nu = (size_t)ref->n_user, nc = (size_t)ref->nc;
    int parts = HN_REFINED_PARTS;
    while (parts > 1 && (double)n * parts * (double)(2 * nu + nc + 1) > MOST_NUMBERS) {
        parts /= 2;
    }

    // memory
    const size_t rows = n * (size_t)parts;
    hn_refined *r = hn_arena_get(arena, sizeof *r);
    if (!r) {
        return HN_ERR_MEMORY;
    }
    *r = (hn_refined){.ref = ref, .parts = parts};
    r->q = hn_arena_doubles(arena, rows * nu);
    r->v = hn_arena_doubles(arena, rows * nu);
    r->lambda = hn_arena_doubles(arena, rows * nc);
    r->energy = hn_arena_doubles(arena, rows);
    r->error = hn_arena_doubles(arena, n * HN_ERROR_COUNT);
    refining g = {.sys = sys,
                  .out = r,
                  .errors = errors,
                  .limits = limits,
                  .started = hn_clock_thread(),
                  .most_ops = most_ops,
                  .end = HN_WALK_DONE,
                  .q = hn_arena_doubles(arena, (size_t)info.nq),
                  .v = hn_arena_doubles(arena, (size_t)info.nv)};
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // each interval by itself; none is known before
    for (size_t i = 0; i < n * HN_ERROR_COUNT; i++) {
        r->error[i] = (double)NAN;
    }
    for (int i = 0; i < ref->n && parts > 1; i++) {
        HN_TRY(refine(&g, i));
    }
    *out = r;
    return HN_OK;
}
