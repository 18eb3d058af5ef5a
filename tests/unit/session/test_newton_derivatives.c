// SPDX-License-Identifier: GPL-3.0-or-later
// The derivatives that formulations give to implicit integrators, on every scene of the library
// against differences of their own right-hand sides, and the systems solved by structure against
// the full matrix.

#include "dynamics/assembly/project.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "formulations/ground/formulation.h"
#include "formulations/list/formulation_list.h"
#include "integrators/list/stepper_list.h"
#include "integrators/step/stepper.h"
#include "linalg/dense.h"
#include "session/model/model.h"
#include "support/near.h"
#include "support/shipped_library.h"

#include <math.h>
#include <string.h>

enum { STATES = 2 };
static const double STEP = 2e-5;
// Differences over 2 STEP leave STEP^2 times a third derivative and rounding over STEP, below 1e-4
// of the largest slope at these states; derivatives that miss a term are off by its whole size.
static const double TOL = 1e-4;
static const double MILD =
    1e3; // penalty: the strong ones drown digits of the masses, which differences then lack

typedef struct bench {
    const char *id;
    hn_model *model;
    const hn_system *sys;
    hn_system_info info;
    hn_arena *arena;
    hn_projector *projector;
    const hn_formulation *f;
    void *self;
    hn_ode ode;
    int n;
    double *q, *v, *dq, *dv, t;
    double *y, *other, *slope, *back, *jac;
    unsigned seed;
} bench;

static double noise(bench *b) {
    b->seed = b->seed * 1664525u + 1013904223u;
    return 2 * (double)(b->seed >> 8) / 16777216.0 - 1;
}

static void open_bench(bench *b, int scene) {
    hn_diags diags = {0};
    *b = (bench){
        .id = hn_library_scene_id(hn_test_library, scene), .seed = 7u + (unsigned)scene, .t = 0.1};
    const hn_model_source source = {.name = b->id};
    assert_int_equal(hn_model_load(hn_test_library, &source, &b->model, &diags), HN_OK);
    b->sys = hn_model_system(b->model);
    b->info = hn_system_get_info(b->sys);
    b->arena = hn_arena_create(0);
    const size_t n = (size_t)(b->info.nq + b->info.nv);
    double **const arrays[] = {&b->q,     &b->v,     &b->dq,   &b->dv, &b->y,
                               &b->other, &b->slope, &b->back, NULL};
    for (int i = 0; arrays[i]; i++) {
        *arrays[i] = hn_arena_doubles(b->arena, n);
    }
    b->jac = hn_arena_doubles(b->arena, n * n);
    assert_int_equal(hn_projector_create(b->sys, HN_WEIGHT_MASS, b->arena, &b->projector), HN_OK);
}

static void close_bench(bench *b) {
    hn_projector_free(b->projector);
    hn_arena_free(b->arena);
    hn_model_free(b->model);
}

static void close_loops(bench *b, double *q, double *v) {
    if (hn_project_position(b->projector, b->t, q, 0, NULL) != HN_OK ||
        hn_project_velocity(b->projector, b->t, q, v, NULL) != HN_OK) {
        fail_msg("%s: a state near the start cannot be closed", b->id);
    }
}

static void next_state(bench *b) {
    for (int i = 0; i < b->info.nv; i++) {
        b->dq[i] = 0.05 * noise(b);
        b->v[i] = hn_model_v(b->model)[i] + noise(b);
    }
    memcpy(b->q, hn_model_q(b->model), (size_t)b->info.nq * sizeof *b->q);
    hn_system_move(b->sys, b->q, b->dq);
    close_loops(b, b->q, b->v);
    for (int i = 0; i < b->info.nv; i++) {
        b->dq[i] = noise(b);
        b->dv[i] = noise(b);
    }
}

// 0: the scene is refused, or no derivatives are given
static int open_formulation(bench *b, const hn_formulation *f) {
    double settings[HN_MAX_OPTIONS] = {0};
    hn_diag diag = {0};
    for (int i = 0; i < f->n_options; i++) {
        settings[i] = f->options[i].initial;
    }
    if (strcmp(f->name, "penalty") == 0) {
        settings[0] = MILD;
    }
    b->f = f;
    b->self = NULL;
    b->ode = (hn_ode){0};
    if (f->create(b->sys, settings, b->arena, &b->self, &diag) == HN_OK &&
        f->set_state(b->self, b->t, b->q, b->v, b->y) == HN_OK) {
        f->ode(b->self, &b->ode);
        b->n = b->ode.n_pos + b->ode.n_vel;
    }
    return b->ode.jacobian != NULL;
}

static void rhs(bench *b, const double *y, double *slope) {
    if (b->ode.rhs(b->ode.self, b->t, y, slope) != HN_OK) {
        fail_msg("%s by %s: %s", b->id, b->f->name, b->f->why(b->self));
    }
}

// the state a step away along a motion that keeps the loops closed, as the formulation writes it
static void step_aside(bench *b, double step, double *y) {
    double *q = b->other, *v = b->other + b->info.nq;
    memcpy(q, b->q, (size_t)b->info.nq * sizeof *q);
    memcpy(v, b->v, (size_t)b->info.nv * sizeof *v);
    for (int i = 0; i < b->info.nv; i++) {
        b->slope[i] = step * b->dq[i];
        v[i] += step * b->dv[i];
    }
    hn_system_move(b->sys, q, b->slope);
    close_loops(b, q, v);
    assert_int_equal(b->f->set_state(b->self, b->t, q, v, y), HN_OK);
}

static double check_secant(bench *b, double *y, double *y_back) {
    double worst = 0, size = 1;
    rhs(b, y, b->slope);
    rhs(b, y_back, b->back);
    for (int i = 0; i < b->n; i++) {
        double along = 0;
        for (int k = 0; k < b->n; k++) {
            along += b->jac[i * b->n + k] * (y[k] - y_back[k]) / (2 * STEP);
        }
        const double seen = (b->slope[i] - b->back[i]) / (2 * STEP);
        worst = fmax(worst, fabs(seen - along));
        size = fmax(size, fabs(seen));
    }
    return worst / size;
}

static void slopes_agree_along_closed_motions(bench *b) {
    double y[256], y_back[256];
    assert_true(b->n <= 256);
    assert_int_equal(b->ode.jacobian(b->ode.self, b->t, b->y, b->jac), HN_OK);
    step_aside(b, STEP, y);
    step_aside(b, -STEP, y_back);
    const double error = check_secant(b, y, y_back);
    if (!(error < TOL)) {
        fail_msg("%s by %s: derivatives are off by %.2g", b->id, b->f->name, error);
    }
}

// where rows depend on each other the right-hand side has no derivative in directions that open the
// loops: there they part
static void slopes_agree_in_every_direction(bench *b) {
    double y[256], y_back[256];
    for (int k = 0; k < b->n; k++) {
        memcpy(y, b->y, (size_t)b->n * sizeof *y);
        memcpy(y_back, b->y, (size_t)b->n * sizeof *y);
        y[k] += STEP;
        y_back[k] -= STEP;
        const double error = check_secant(b, y, y_back);
        if (!(error < TOL)) {
            fail_msg("%s by %s: column %d is off by %.2g", b->id, b->f->name, k, error);
        }
    }
}

// (s - dF/dy) x = r with the full matrix, for a real and a complex s
static void systems_are_solved(bench *b) {
    double x[2][256], r[2][256], *const at[2] = {x[0], x[1]};
    assert_int_equal(b->ode.newton->at(b->ode.self, b->t, b->y), HN_OK);
    for (int parts = 1; parts <= 2; parts++) {
        const double re = 37, im = parts == 2 ? -21 : 0;
        assert_int_equal(b->ode.newton->factor(b->ode.self, parts - 1, re, im), HN_OK);
        for (int i = 0; i < b->n; i++) {
            x[0][i] = r[0][i] = noise(b);
            x[1][i] = r[1][i] = parts == 2 ? noise(b) : 0;
        }
        b->ode.newton->solve(b->ode.self, parts, at);
        double size = 1, worst = 0;
        for (int i = 0; i < b->n; i++) {
            double left[2] = {re * x[0][i] - im * x[1][i], im * x[0][i] + re * x[1][i]};
            for (int k = 0; k < b->n; k++) {
                const double e = b->jac[i * b->n + k];
                left[0] -= e * x[0][k];
                left[1] -= e * x[1][k];
                size = fmax(size, fabs(e) * (fabs(x[0][k]) + fabs(x[1][k])));
            }
            worst = fmax(worst, fmax(fabs(left[0] - r[0][i]), fabs(left[1] - r[1][i])));
        }
        if (!(worst < 1e-9 * size)) { // rounding times the condition of the saddle system
            fail_msg("%s by %s: a residual of %.2g is left", b->id, b->f->name, worst / size);
        }
    }
}

// 1: the rows of the loops stand on their own
static int is_regular(bench *b) {
    const hn_accel_opts opts = {.want_lambda = 1};
    hn_accel_info info;
    hn_accel *accel = NULL;
    double a[128], lambda[128];
    assert_int_equal(hn_accel_create(b->sys, &opts, b->arena, &accel), HN_OK);
    assert_int_equal(hn_accel_eval(accel, b->t, b->q, b->v, 0, 0, a, lambda, &info), HN_OK);
    hn_accel_free(accel);
    return info.rank == b->info.nc;
}

static const char *const formulations[] = {"index1",
                                           "baumgarte",
                                           "projection",
                                           "symmetric-projection",
                                           "nullspace-solver",
                                           "penalty",
                                           "augmented-lagrangian",
                                           "udwadia-kalaba",
                                           "partitioning",
                                           "reduced",
                                           "nullspace"};
enum { N_FORMULATIONS = sizeof formulations / sizeof *formulations };

static void check(bench *b, const char *name, int seen[2]) {
    if (!open_formulation(b, hn_formulation_find(name))) {
        if (b->self) {
            b->f->destroy(b->self);
        }
        return;
    }
    seen[0]++;
    slopes_agree_along_closed_motions(b);
    // the states moved to left chart formulations at another base: begin again
    assert_int_equal(b->f->set_state(b->self, b->t, b->q, b->v, b->y), HN_OK);
    if (is_regular(b) && b->info.nq == b->info.nv) {
        slopes_agree_in_every_direction(b);
        seen[1]++;
    }
    if (b->ode.newton) {
        systems_are_solved(b);
    }
    b->f->destroy(b->self);
}

static void derivatives_of_every_formulation_are_exact_on_every_scene(void **state) {
    (void)state;
    int seen[2] = {0, 0};
    for (int scene = 0; scene < hn_library_n_scenes(hn_test_library); scene++) {
        bench b;
        open_bench(&b, scene);
        for (int k = 0; k < STATES; k++) {
            next_state(&b);
            for (int f = 0; f < N_FORMULATIONS; f++) {
                check(&b, formulations[f], seen);
            }
        }
        close_bench(&b);
    }
    assert_true(seen[0] > STATES * hn_library_n_scenes(hn_test_library) * N_FORMULATIONS * 9 / 10);
    assert_true(seen[1] > STATES * hn_library_n_scenes(hn_test_library) * N_FORMULATIONS / 2);
}

static int scene_number(const char *id) {
    int i = 0;
    while (strcmp(hn_library_scene_id(hn_test_library, i), id) != 0) {
        i++;
        assert_true(i < hn_library_n_scenes(hn_test_library));
    }
    return i;
}

// iterations and right-hand sides of 50 steps of gauss2, whose iteration goes on to rounding
static hn_cost cost_of_steps(bench *b, const char *formulation, int exact) {
    const hn_stepper *stepper = hn_stepper_find("gauss2");
    hn_cost cost = {0};
    hn_arena *arena = hn_arena_create(0);
    assert_true(open_formulation(b, hn_formulation_find(formulation)));
    if (!exact) {
        b->ode.jacobian = NULL;
        b->ode.newton = NULL;
    }
    void *s = stepper->create(b->ode.n_pos, b->ode.n_vel, arena);
    for (int i = 0; i < 50; i++) {
        int changed = 0;
        const double t = b->t + 2e-3 * i;
        assert_int_equal(stepper->step(s, &b->ode, t, 2e-3, b->y, b->other, NULL), HN_OK);
        memcpy(b->y, b->other, (size_t)b->n * sizeof *b->y);
        assert_int_equal(b->f->after_step(b->self, t + 2e-3, b->y, &changed), HN_OK);
        stepper->on_accepted(s, changed);
    }
    b->f->add_cost(b->self, &cost);
    cost.newton = 0; // of the stepper alone
    stepper->add_cost(s, &cost);
    b->f->destroy(b->self);
    hn_arena_free(arena);
    return cost;
}

static void exact_derivatives_need_no_more_iterations_and_fewer_evaluations(void **state) {
    (void)state;
    static const char *const methods[] = {"index1", "baumgarte", "penalty", "nullspace"};
    static const char *const scenes[] = {"fb0", "five-bar", "bennett", "driven-crank", "heavy-top"};
    for (size_t k = 0; k < 20; k++) {
        bench b;
        open_bench(&b, scene_number(scenes[k % 5]));
        memcpy(b.q, hn_model_q(b.model), (size_t)b.info.nq * sizeof *b.q);
        memcpy(b.v, hn_model_v(b.model), (size_t)b.info.nv * sizeof *b.v);
        const char *method = methods[k / 5];
        if (b.info.nq == b.info.nv || k / 5 < 3) {
            const hn_cost exact = cost_of_steps(&b, method, 1);
            const hn_cost differences = cost_of_steps(&b, method, 0);
            // where the last corrections are rounding, one iteration in twenty may fall either way
            assert_true(exact.newton <= differences.newton + differences.newton / 20);
            assert_true(exact.evals < differences.evals);
        }
        close_bench(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_derivatives_need_no_more_iterations_and_fewer_evaluations),
        cmocka_unit_test(derivatives_of_every_formulation_are_exact_on_every_scene),
    };
    return cmocka_run_group_tests(tests, hn_test_library_open, hn_test_library_close);
}
