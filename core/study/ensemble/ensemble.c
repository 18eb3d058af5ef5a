// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/ensemble/ensemble.h"

#include "base/processors.h"
#include "integrators/explicit/rk_lanes.h"
#include "integrators/step/compensated.h"
#include "study/stepping/stepping.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { NOBODY = -1, MOST_THREADS = 256 };

/// The members of one call, shared by the threads.
typedef struct work_list {
    int n;
    atomic_int next; ///< the first member that no thread has taken
    const hn_ensemble_start *starts;
    double t_end;
    double *q, *v;
    hn_ensemble_end *ends;
} work_list;

/// The data of one thread.
typedef struct worker {
    const hn_ensemble *ensemble;
    hn_arena *arena;
    hn_rk_lanes rk;
    hn_stepping single; ///< makes the steps that lanes leave out
    work_list *work;
    int member[HN_LANES];     ///< in each lane, or NOBODY
    double grid[HN_LANES];    ///< steps made
    long long left[HN_LANES]; ///< steps to the end
    pthread_t thread;
    bool is_started;
} worker;

struct hn_ensemble {
    const hn_system *sys;
    hn_method_spec spec;
    hn_system_info info;
    hn_ensemble_opts opts;
    hn_arena *arena;
    hn_accel *accel; ///< for the tape that all lanes share
    double alpha, beta;
    int n_workers;
    worker *workers;
};

hn_ensemble_opts hn_ensemble_opts_default(void) {
    return (hn_ensemble_opts){.set = hn_lanes_set_best(), .max_steps = 50000000};
}

// ---- what can be served ----

/// The options of the solver; false: the formulation keeps something from step to step.
static bool ask_formulation(const hn_method_spec *spec, hn_accel_opts *accel, double *alpha,
                            double *beta) {
    const hn_formulation *f = spec->formulation;
    return f->lanes && f->lanes(spec->formulation_set, accel, alpha, beta);
}

hn_status hn_ensemble_check(const hn_system *sys, const hn_method_spec *spec, hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    hn_accel_opts accel;
    double alpha, beta;
    const char *why = NULL;

    // the method
    if (!ask_formulation(spec, &accel, &alpha, &beta)) {
        why = "the formulation keeps values from one step to the next";
    } else if (!spec->stepper->tableau || spec->stepper_set[HN_FIXED_STEP_SUM] != 0) {
        why = "the integrator is not an explicit one with a fixed step and a plain sum";
    } else if (accel.solver != HN_SOLVER_AUTO && accel.solver != HN_SOLVER_LDL) {
        why = "the solver is not compiled to instructions";
    }

    // the scene
    if (!why && info.nq != info.nv) {
        why = "orientations are quaternions";
    } else if (!why && isfinite(hn_system_next_corner(sys, 0))) {
        why = "a load has corners";
    }
    return why ? hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL,
                             "take index1 or baumgarte with euler, heun or rk4",
                             "these runs cannot step side by side: %s", why)
               : HN_OK;
}

// ---- life ----

static hn_status create_worker(const hn_ensemble *e, worker *w, hn_diag *diag) {
    *w = (worker){.ensemble = e, .arena = hn_arena_create(0)};
    double *zero = w->arena ? hn_arena_doubles(w->arena, (size_t)e->info.nq) : NULL;
    if (!zero) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(hn_rk_lanes_create(e->spec.stepper->tableau, e->accel, e->opts.set, w->arena, &w->rk));
    return hn_stepping_create(e->sys, &e->spec, 0, e->opts.max_steps, zero, zero, w->arena,
                              &w->single, diag);
}

static hn_status create_parts(hn_ensemble *e, hn_diag *diag) {
    hn_accel_opts opts;
    if (!ask_formulation(&e->spec, &opts, &e->alpha, &e->beta)) {
        return HN_ERR_UNSUPPORTED;
    }
    HN_TRY(hn_accel_create(e->sys, &opts, e->arena, &e->accel));
    if (!hn_accel_has_lanes(e->accel)) {
        return hn_diag_set(
            diag, HN_ERR_UNSUPPORTED, NULL, NULL,
            "these runs cannot step side by side: the solver is not compiled to instructions here");
    }

    // one by one, for each compiles tapes in the graph of the system
    hn_status status = HN_OK;
    for (int i = 0; i < e->opts.threads && status == HN_OK; i++) {
        e->n_workers++;
        status = create_worker(e, &e->workers[i], diag);
    }
    return status;
}

hn_status hn_ensemble_create(const hn_system *sys, const hn_method_spec *spec,
                             const hn_ensemble_opts *opts, hn_ensemble **out, hn_diag *diag) {
    *out = NULL;
    HN_TRY(hn_ensemble_check(sys, spec, diag));
    hn_arena *arena = hn_arena_create(0);
    hn_ensemble *e = arena ? hn_arena_get(arena, sizeof *e) : NULL;
    if (!e) {
        hn_arena_free(arena);
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }

    // as many threads as asked for, or as there are processors
    *e = (hn_ensemble){
        .sys = sys, .spec = *spec, .info = hn_system_get_info(sys), .opts = *opts, .arena = arena};
    const int threads = opts->threads > 0 ? opts->threads : hn_processors();
    e->opts.threads = threads > MOST_THREADS ? MOST_THREADS : threads;
    e->workers = hn_arena_get(arena, (size_t)e->opts.threads * sizeof *e->workers);

    hn_diag why = {0};
    const hn_status status = e->workers ? create_parts(e, &why) : HN_ERR_MEMORY;
    if (status != HN_OK) {
        hn_ensemble_free(e);
        return hn_diag_set(diag, status, NULL, NULL, "%s",
                           why.message[0] ? why.message : hn_status_text(status));
    }
    *out = e;
    return HN_OK;
}

void hn_ensemble_free(hn_ensemble *e) {
    if (!e) {
        return;
    }
    for (int i = 0; i < e->n_workers; i++) {
        hn_rk_lanes_free(&e->workers[i].rk);
        hn_stepping_free(&e->workers[i].single);
        hn_arena_free(e->workers[i].arena);
    }
    hn_accel_free(e->accel);
    hn_arena_free(e->arena);
}

hn_ensemble_start hn_ensemble_start_of(const hn_ensemble *e, const double *q, const double *v) {
    return (hn_ensemble_start){.q = q,
                               .v = v,
                               .h = e->spec.stepper_set[HN_FIXED_STEP_H],
                               .alpha = e->alpha,
                               .beta = e->beta};
}

// ---- lanes and members ----

/// Steps until the grid point at or beyond t_end, as hn_run_advance() counts them.
static long long count_steps(double h, double t_end) {
    const double end = t_end - HN_STEPPING_LANDING * h;
    double n = fmax(0, ceil(end / h));
    while (n > 0 && (n - 1) * h >= end) {
        n--;
    }
    while (n * h < end) {
        n++;
    }
    return (long long)n;
}

static void end_member(worker *w, int lane, hn_status status) {
    const hn_ensemble *e = w->ensemble;
    const size_t member = (size_t)w->member[lane], nq = (size_t)e->info.nq, nv = (size_t)e->info.nv;
    hn_ensemble_end *end = &w->work->ends[member];
    for (size_t i = 0; i < nq; i++) {
        w->work->q[member * nq + i] = w->rk.y[HN_LANES * i + (size_t)lane];
    }
    for (size_t i = 0; i < nv; i++) {
        w->work->v[member * nv + i] = w->rk.y[HN_LANES * (nq + i) + (size_t)lane];
    }
    end->status = status;
    end->steps = (long long)w->grid[lane];
    end->t = w->grid[lane] * w->rk.h[lane];
    w->member[lane] = NOBODY;
    w->left[lane] = 0;
}

static void begin_member(worker *w, int lane, int member) {
    const hn_ensemble *e = w->ensemble;
    const hn_ensemble_start *s = &w->work->starts[member];
    for (int i = 0; i < e->info.nq; i++) {
        w->rk.y[HN_LANES * i + lane] = s->q[i];
    }
    for (int i = 0; i < e->info.nv; i++) {
        w->rk.y[HN_LANES * (e->info.nq + i) + lane] = s->v[i];
    }
    w->work->ends[member] = (hn_ensemble_end){0};
    w->rk.h[lane] = s->h;
    w->rk.accel.alpha[lane] = s->alpha;
    w->rk.accel.beta[lane] = s->beta;
    w->member[lane] = member;
    w->grid[lane] = 0;
    w->left[lane] = 0;

    // what can be said before the first step
    if (!hn_stepping_is_sane(e->info.nq, s->q) || !hn_stepping_is_sane(e->info.nv, s->v) ||
        !(s->h > 0) || !isfinite(s->h)) {
        end_member(w, lane, HN_ERR_INPUT);
    } else if (w->work->t_end / s->h > (double)e->opts.max_steps + 1) {
        end_member(w, lane, HN_ERR_STOPPED);
    } else {
        w->left[lane] = count_steps(s->h, w->work->t_end);
    }
}

/// Ends members that are there and gives free lanes the next ones. Returns the lanes that have one.
static hn_lane_bits fill_lanes(worker *w) {
    hn_lane_bits busy = 0;
    for (int k = 0; k < HN_LANES; k++) {
        while (w->left[k] == 0) {
            if (w->member[k] != NOBODY) {
                end_member(w, k, HN_OK);
            }
            const int member = atomic_fetch_add(&w->work->next, 1);
            if (member >= w->work->n) {
                atomic_store(&w->work->next, w->work->n); // it must not run over
                break;
            }
            begin_member(w, k, member);
        }
        busy |= (hn_lane_bits)(w->member[k] != NOBODY) << k;
    }
    return busy;
}

// ---- steps ----

/// Makes the step of one lane by the ordinary stepping, from y to y_new.
static hn_status step_single(worker *w, int lane) {
    hn_stepping *s = &w->single;
    const hn_formulation *f = w->ensemble->spec.formulation;
    const int nq = w->ensemble->info.nq, nv = w->ensemble->info.nv;
    const double h = w->rk.h[lane];

    // at the lane's state and grid point
    for (int i = 0; i < nq; i++) {
        s->start.q[i] = w->rk.y[HN_LANES * i + lane];
    }
    for (int i = 0; i < nv; i++) {
        s->start.v[i] = w->rk.y[HN_LANES * (nq + i) + lane];
    }
    hn_stepping_clear(s);
    HN_TRY(hn_stepping_start_engine(s, &s->engine));
    if (f->set && (f->traits & HN_TRAIT_PULLS_GAP)) {
        HN_TRY(f->set(s->engine.formulation, HN_STABILISED_ALPHA, w->rk.accel.alpha[lane]));
        HN_TRY(f->set(s->engine.formulation, HN_STABILISED_BETA, w->rk.accel.beta[lane]));
    }
    s->grid = (long long)w->grid[lane];
    s->h_next = h;
    s->now.t = w->grid[lane] * h;

    // one step
    HN_TRY(hn_stepping_step(s));
    for (int i = 0; i < nq; i++) {
        w->rk.y_new[HN_LANES * i + lane] = s->now.q[i];
    }
    for (int i = 0; i < nv; i++) {
        w->rk.y_new[HN_LANES * (nq + i) + lane] = s->now.v[i];
    }
    return HN_OK;
}

/// Makes the steps of the lanes that are in doubt. Returns those whose step failed: they have
/// ended.
static hn_lane_bits step_doubtful(worker *w, hn_lane_bits doubtful) {
    hn_lane_bits failed = 0;
    for (int k = 0; k < HN_LANES; k++) {
        if (!(doubtful >> k & 1)) {
            continue;
        }
        const hn_status status = step_single(w, k);
        w->work->ends[w->member[k]].in_doubt++;
        if (status != HN_OK) {
            end_member(w, k, status);
            failed |= (hn_lane_bits)1 << k;
        }
    }
    return failed;
}

/// Steps all lanes until the first member is at its end.
static void step_lanes(worker *w, hn_lane_bits busy) {
    long long steps = 0;
    for (int k = 0; k < HN_LANES; k++) {
        if (busy >> k & 1) {
            steps = steps == 0 || w->left[k] < steps ? w->left[k] : steps;
        }
    }

    // a lane that fails is free, and goes on unheeded
    long long made = 0;
    for (; made < steps && busy; made++) {
        for (int k = 0; k < HN_LANES; k++) {
            w->rk.t[k] = w->grid[k] * w->rk.h[k];
        }
        const hn_lane_bits doubtful = busy & ~hn_rk_lanes_step(&w->rk, HN_STEPPING_BOUND);
        if (doubtful) {
            busy &= ~step_doubtful(w, doubtful);
        }
        hn_rk_lanes_accept(&w->rk);
        for (int k = 0; k < HN_LANES; k++) {
            w->grid[k]++;
        }
    }
    for (int k = 0; k < HN_LANES; k++) {
        w->left[k] -= busy >> k & 1 ? made : 0;
    }
}

static void *run_worker(void *user) {
    worker *w = user;
    for (int k = 0; k < HN_LANES; k++) {
        w->member[k] = NOBODY;
        w->left[k] = 0;
    }
    for (hn_lane_bits busy; (busy = fill_lanes(w)) != 0;) {
        step_lanes(w, busy);
    }
    return NULL;
}

void hn_ensemble_run(hn_ensemble *e, int n, const hn_ensemble_start *starts, double t_end,
                     double *q, double *v, hn_ensemble_end *ends) {
    work_list work = {.n = n, .starts = starts, .t_end = t_end, .q = q, .v = v, .ends = ends};
    atomic_init(&work.next, 0);

    // a thread for each full set of lanes, the first being this one; one that does not start leaves
    // its work to the others
    const int useful = (n + HN_LANES - 1) / HN_LANES;
    for (int i = 0; i < e->n_workers; i++) {
        worker *w = &e->workers[i];
        w->work = &work;
        w->is_started = i > 0 && i < useful && pthread_create(&w->thread, NULL, run_worker, w) == 0;
    }
    run_worker(&e->workers[0]);
    for (int i = 1; i < e->n_workers; i++) {
        if (e->workers[i].is_started) {
            pthread_join(e->workers[i].thread, NULL);
        }
    }
}
