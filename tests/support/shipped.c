// SPDX-License-Identifier: GPL-3.0-or-later
// Facts that hold for any mechanism, see shipped.h.
#include "support/shipped.h"

#include "base/arena.h"
#include "dynamics/assembly/project.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/reactions/reactions.h"
#include "linalg/saddle.h"
#include "study/run/run.h"
#include "support/balance.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const unsigned TERMS =
    HN_TERM_M | HN_TERM_F | HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J | HN_TERM_GAMMA;

typedef struct probe {
    const char *id;
    hn_model *model;
    const hn_system *sys;
    hn_system_info info;
    hn_arena *arena;
    hn_eval *eval;
    double *q, *v, t; ///< an admissible state
    unsigned seed;
} probe;

static double noise(probe *p) {
    p->seed = p->seed * 1664525u + 1013904223u;
    return 2 * (double)(p->seed >> 8) / 16777216.0 - 1;
}

static double *copy(probe *p, const double *x, int n) {
    double *out = hn_arena_doubles(p->arena, (size_t)n + 1);
    assert_non_null(out);
    if (x) {
        memcpy(out, x, (size_t)n * sizeof *x);
    }
    return out;
}

static const double *term(probe *p, hn_term which, double t, const double *q, const double *v) {
    hn_eval_run(p->eval, t, q, v);
    return hn_eval_get(p->eval, which);
}

static void open_probe(probe *p, hn_library *lib, int scene) {
    hn_diags diags = {0};
    *p = (probe){.id = hn_library_scene_id(lib, scene), .seed = 99u + (unsigned)scene};
    const hn_model_source source = {.name = p->id};
    if (hn_model_load(lib, &source, &p->model, &diags) != HN_OK) {
        fail_msg("%s: %s", p->id, diags.item[0].message);
    }
    p->sys = hn_model_system(p->model);
    p->info = hn_system_get_info(p->sys);
    p->arena = hn_arena_create(0);
    assert_int_equal(hn_eval_create(p->sys, TERMS, p->arena, &p->eval), HN_OK);
    p->q = copy(p, NULL, p->info.nq);
    p->v = copy(p, NULL, p->info.nv);
}

static void close_probe(probe *p) {
    hn_eval_free(p->eval);
    hn_arena_free(p->arena);
    hn_model_free(p->model);
}

/// The start disturbed by up to 0.05 in positions and 1 in speeds, then closed again.
static void next_state(probe *p) {
    hn_projector *projector = NULL;
    assert_int_equal(hn_projector_create(p->sys, HN_WEIGHT_MASS, p->arena, &projector), HN_OK);
    for (int i = 0; i < p->info.nv; i++) {
        p->v[i] = 0.05 * noise(p);
    }
    memcpy(p->q, hn_model_q(p->model), (size_t)p->info.nq * sizeof *p->q);
    hn_system_move(p->sys, p->q, p->v);
    for (int i = 0; i < p->info.nv; i++) {
        p->v[i] = hn_model_v(p->model)[i] + noise(p);
    }
    p->t = 0.1 + 0.1 * noise(p);
    hn_status status = hn_project_position(projector, p->t, p->q, 0, NULL);
    status = status == HN_OK ? hn_project_velocity(projector, p->t, p->q, p->v, NULL) : status;
    if (status != HN_OK) {
        fail_msg("%s: a state near the start cannot be closed", p->id);
    }
    hn_projector_free(projector);
}

static double largest(const double *x, size_t n) {
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(x[i]));
    }
    return most;
}

static void check_near(const probe *p, const char *what, double got, double expected, double tol) {
    if (!(fabs(got - expected) <= tol)) {
        fail_msg("%s: %s is %.17g, expected %.17g within %.1g", p->id, what, got, expected, tol);
    }
}

static void move(const probe *p, double *q, double h, const double *dq) {
    for (int i = 0; i < p->info.nq; i++) {
        q[i] = p->q[i] + h * dq[i];
    }
}

/// J against central differences of phi, gamma against those of J v + phi_t along the motion at
/// constant v.
static void derivatives_agree(probe *p) {
    const int nv = p->info.nv, nc = p->info.nc;
    const double h = 1e-5;
    const double *J = copy(p, term(p, HN_TERM_J, p->t, p->q, p->v), nc * nv);
    const double *gamma = copy(p, hn_eval_get(p->eval, HN_TERM_GAMMA), nc);
    double *q = copy(p, p->q, p->info.nq), *dq = copy(p, NULL, p->info.nq);
    double *up = copy(p, NULL, nc), *down = copy(p, NULL, nc), *unit = copy(p, NULL, nv);
    // an error of h^2 times the third derivative, and of rounding / h
    const double scale = 1 + largest(J, (size_t)nc * (size_t)nv);
    for (int j = 0; j < nv; j++) {
        memset(unit, 0, (size_t)nv * sizeof *unit);
        unit[j] = 1;
        hn_system_kinematics(p->sys, p->q, unit, dq);
        move(p, q, h, dq);
        memcpy(up, term(p, HN_TERM_PHI, p->t, q, p->v), (size_t)nc * sizeof *up);
        move(p, q, -h, dq);
        memcpy(down, term(p, HN_TERM_PHI, p->t, q, p->v), (size_t)nc * sizeof *down);
        for (int i = 0; i < nc; i++) {
            check_near(p, "an entry of J", J[i * nv + j], (up[i] - down[i]) / (2 * h),
                       1e-8 * scale);
        }
    }
    const double speed = 1 + largest(p->v, (size_t)nv), k = h / speed;
    hn_system_kinematics(p->sys, p->q, p->v, dq);
    for (int side = -1; side <= 1; side += 2) {
        double *rate = side > 0 ? up : down;
        move(p, q, side * k, dq);
        const double *there = term(p, HN_TERM_J, p->t + side * k, q, p->v);
        for (int i = 0; i < nc; i++) {
            rate[i] = hn_eval_get(p->eval, HN_TERM_PHI_T)[i];
            for (int j = 0; j < nv; j++) {
                rate[i] += there[i * nv + j] * p->v[j];
            }
        }
    }
    for (int i = 0; i < nc; i++) {
        check_near(p, "gamma", gamma[i], (up[i] - down[i]) / (2 * k), 1e-7 * scale * speed * speed);
    }
}

/// M is symmetric, and x' M x > 0 for random x whose J x is 0.
static void mass_is_positive_on_what_the_loops_allow(probe *p) {
    const int nv = p->info.nv;
    const double *M = copy(p, term(p, HN_TERM_M, p->t, p->q, p->v), nv * nv);
    hn_projector *projector = NULL;
    assert_int_equal(hn_projector_create(p->sys, HN_WEIGHT_EUCLIDEAN, p->arena, &projector), HN_OK);
    double *x = copy(p, NULL, nv);
    double seen = 0;
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < nv; i++) {
            x[i] = noise(p);
            for (int j = 0; j < nv; j++) {
                check_near(p, "M", M[i * nv + j], M[j * nv + i], 0);
            }
        }
        assert_int_equal(hn_project_velocity(projector, p->t, p->q, x, NULL), HN_OK);
        double energy = 0, size = 0;
        for (int i = 0; i < nv; i++) {
            size += x[i] * x[i];
            for (int j = 0; j < nv; j++) {
                energy += x[i] * M[i * nv + j] * x[j];
            }
        }
        seen = fmax(seen, size);
        assert_true(energy > 1e-9 * size * largest(M, (size_t)nv * (size_t)nv));
    }
    assert_true(seen > 1e-3); // something could move
    hn_projector_free(projector);
}

/// v' (M a - f) = 0: closed loops do no work where they do not move in time themselves.
static void loops_do_no_work(probe *p, const double *a) {
    const int nv = p->info.nv;
    const double *M = term(p, HN_TERM_M, p->t, p->q, p->v);
    const double *f = hn_eval_get(p->eval, HN_TERM_F);
    double power = 0, size = 0;
    if (largest(hn_eval_get(p->eval, HN_TERM_PHI_T), (size_t)p->info.nc) > 0) {
        return;
    }
    for (int i = 0; i < nv; i++) {
        double sum = -f[i], parts = fabs(f[i]);
        for (int j = 0; j < nv; j++) {
            sum += M[i * nv + j] * a[j];
            parts += fabs(M[i * nv + j] * a[j]);
        }
        power += p->v[i] * sum;
        size += fabs(p->v[i]) * parts;
    }
    check_near(p, "the power of the loops' forces", power / (1 + size), 0, 1e-11);
}

/// Speeds after one step of RK4 from the state, a twentieth of what the scene suggests and no more
/// than 50 us.
static void speeds_after_a_step(probe *p, const char *formulation, double *user_v) {
    char method[64];
    snprintf(method, sizeof method, "%s@rk4:h=%.3g", formulation,
             fmin(5e-5, hn_model_scene(p->model)->step / 20));
    hn_method_spec spec = {0};
    hn_diag diag = {0};
    hn_run *run = NULL;
    hn_sample s;
    const hn_run_opts opts = {.t0 = p->t};
    assert_int_equal(hn_method_parse(method, &spec, &diag), HN_OK);
    if (hn_run_create(p->sys, &spec, p->q, p->v, &opts, &run, &diag) != HN_OK ||
        hn_run_step(run) != HN_OK || hn_run_sample(run, hn_run_time(run), &s) != HN_OK) {
        fail_msg("%s by %s: %s", p->id, method,
                 run ? hn_run_get_summary(run).reason : diag.message);
    }
    memcpy(user_v, s.v, (size_t)p->info.n_user * sizeof *user_v);
    hn_run_free(run);
}

/// One step each, by the saddle-point system and by independent coordinates: the same but for the
/// local error of RK4.
static void two_formulations_step_alike(probe *p) {
    const int n = p->info.n_user;
    double *one = copy(p, NULL, n), *two = copy(p, NULL, n);
    speeds_after_a_step(p, "projection", one);
    speeds_after_a_step(p, "nullspace", two);
    const double size = 1 + largest(one, (size_t)n);
    for (int i = 0; i < n; i++) {
        check_near(p, "a speed after one step", one[i] / size, two[i] / size, 1e-11);
    }
}

/// The sparse factor of the whole system (or what stands in for it) and the dense null space of the
/// rows. Newton and Euler for each body, from differences of poses, with what its joints and
/// constraints carry.
static void every_body_is_in_balance(probe *p, const double *a, const double *lambda) {
    const hn_scene *scene = hn_model_scene(p->model);
    hn_reactions *r = NULL;
    if (scene->is_lagrangian) {
        return;
    }
    assert_int_equal(hn_reactions_create(p->sys, p->arena, &r, NULL), HN_OK);
    hn_wrench *joints = hn_arena_get(p->arena, ((size_t)scene->n_joints + 1) * sizeof *joints);
    hn_wrench *more = hn_arena_get(p->arena, ((size_t)scene->n_constraints + 1) * sizeof *more);
    assert_int_equal(hn_reactions_eval(r, p->t, p->q, p->v, a, lambda, joints, more), HN_OK);
    const balance b = balance_of(p->sys, p->t, p->q, p->v, a, joints, more);
    // differences leave some roundings of places over step^2, and (speed step)^4 / 90
    const double arm = fmax(1, hn_system_length(p->sys));
    double mass = 0;
    for (int k = 0; k < scene->n_bodies; k++) {
        mass += scene->bodies[k].mass.value;
    }
    const double tol = 1e-14 / (b.step * b.step) * mass * arm + 1e-6 * b.largest_force;
    check_near(p, "a force that is missing", b.force, 0, tol);
    check_near(p, "a moment that is missing", b.moment, 0, tol * arm + 1e-6 * b.largest_moment);
    check_near(p, "the work along freedoms", hn_reactions_defect(r), 0, 1e-9);
    hn_reactions_free(r);
}

static void accelerations_from_tape_and_from_the_null_space_agree(probe *p, double *a) {
    const int nv = p->info.nv, nc = p->info.nc;
    const hn_accel_opts opts = {.want_lambda = 1};
    hn_accel *accel = NULL;
    assert_int_equal(hn_accel_create(p->sys, &opts, p->arena, &accel), HN_OK);
    double *lambda = copy(p, NULL, nc), *dense = copy(p, NULL, nv);
    assert_int_equal(hn_accel_eval(accel, p->t, p->q, p->v, 0, 0, a, lambda, NULL), HN_OK);
    every_body_is_in_balance(p, a, lambda);
    hn_saddle_ws *ws = hn_saddle_ws_create(p->arena, nv, nc);
    hn_saddle_info info;
    term(p, HN_TERM_M, p->t, p->q, p->v);
    assert_int_equal(
        hn_saddle_solve(nv, nc, hn_eval_get(p->eval, HN_TERM_M), hn_eval_get(p->eval, HN_TERM_J),
                        hn_eval_get(p->eval, HN_TERM_F), hn_eval_get(p->eval, HN_TERM_GAMMA), dense,
                        lambda, &info, NULL, ws),
        HN_OK);
    const double size = largest(dense, (size_t)nv);
    for (int i = 0; i < nv; i++) {
        check_near(p, "an acceleration", a[i], dense[i], 1e-11 * size);
    }
    hn_accel_free(accel);
}

void shipped_obeys_mechanics(hn_library *lib, int scene, int states) {
    probe p;
    open_probe(&p, lib, scene);
    double *a = copy(&p, NULL, p.info.nv);
    for (int k = 0; k < states; k++) {
        next_state(&p);
        derivatives_agree(&p);
        mass_is_positive_on_what_the_loops_allow(&p);
        accelerations_from_tape_and_from_the_null_space_agree(&p, a);
        loops_do_no_work(&p, a);
        two_formulations_step_alike(&p);
    }
    close_probe(&p);
}
