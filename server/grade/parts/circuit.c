// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/circuit.h"

#include "grade/parts/part_model.h"
#include "grade/parts/pose_solver.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_STEPS = 20000, N = HN_CIRCUIT_COORDINATES };
static const double PI = 3.14159265358979324;
static const double SHORTEST = 1e-3; // of the stride: a shorter step means a singular configuration
static const double BENT = 0.2;      // [rad] between the tangents of one step

typedef struct walk {
    hn_pose_solver *solver;
    hn_circuit *out;
    hn_graph *graph; ///< of the system: it knows when the work must end
    hn_circuit_visit *visit;
    void *user;
    double stride, step;
    bool turning[N];           ///< angles, equal modulo a full turn
    double start[N], first[N]; ///< coordinates and tangent of the start
    double x[N], tangent[N];   ///< now
} walk;

static double dot(int n, const double *a, const double *b) {
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void arrive(walk *w) {
    const double *x = hn_pose_solver_coordinates(w->solver);
    memcpy(w->x, x, (size_t)w->out->n * sizeof *x);
    for (int i = 0; i < w->out->n; i++) {
        w->out->least[i] = fmin(w->out->least[i], x[i]);
        w->out->most[i] = fmax(w->out->most[i], x[i]);
    }
    if (w->visit) {
        w->visit(w->user, x, hn_pose_solver_points(w->solver));
    }
}

/// Tries one step along the tangent. False: too bent, or not closed; the pose is then as before.
static bool try_step(walk *w, double *tangent) {
    double ahead[N], moved[N];
    const int n = w->out->n;
    for (int i = 0; i < n; i++) {
        ahead[i] = w->x[i] + w->step * w->tangent[i] * hn_pose_solver_reach(w->solver, i);
    }
    hn_pose_solver_place(w->solver, ahead);
    bool good = hn_pose_solver_close(w->solver, NULL) == HN_OK &&
                hn_pose_solver_direction(w->solver, tangent) == 1;
    for (int i = 0; i < n && good; i++) {
        moved[i] = (hn_pose_solver_coordinates(w->solver)[i] - w->x[i]) /
                   hn_pose_solver_reach(w->solver, i);
    }

    // the tangent has a direction, and must not turn far; the step must have been made along it
    const double along = good ? dot(n, tangent, w->tangent) : 0;
    for (int i = 0; i < n && along < 0; i++) {
        tangent[i] = -tangent[i];
    }
    good = good && fabs(along) > cos(BENT) && dot(n, moved, w->tangent) > 0.5 * w->step &&
           dot(n, moved, moved) < 2.25 * w->step * w->step;
    if (!good) {
        hn_pose_solver_place(w->solver, w->x);
    }
    return good;
}

/// Signed distance to the start along its tangent; *far receives how far away the pose is, both in
/// units of reach.
static double distance_ahead(const walk *w, double *far) {
    double apart[N], largest = 0;
    for (int i = 0; i < w->out->n; i++) {
        const double by = w->x[i] - w->start[i];
        apart[i] =
            (w->turning[i] ? remainder(by, 2 * PI) : by) / hn_pose_solver_reach(w->solver, i);
        largest = fmax(largest, fabs(apart[i]));
    }
    *far = largest;
    return dot(w->out->n, apart, w->first);
}

static void close_circuit(walk *w) {
    w->out->closed = true;
    for (int i = 0; i < w->out->n; i++) {
        w->out->turns[i] = w->turning[i] ? (int)lround((w->x[i] - w->start[i]) / (2 * PI)) : 0;
    }
}

/// One step, as long as the curve allows; false at a singular configuration.
static bool advance(walk *w) {
    double tangent[N];
    while (!try_step(w, tangent)) {
        w->step /= 2;
        if (w->step < SHORTEST * w->stride) {
            return false;
        }
    }
    memcpy(w->tangent, tangent, (size_t)w->out->n * sizeof *tangent);
    w->step = fmin(w->stride, 1.5 * w->step);
    arrive(w);
    return true;
}

static hn_status follow(walk *w) {
    hn_circuit *out = w->out;
    double far, before = 0;
    for (out->steps = 1; out->steps <= MAX_STEPS; out->steps++) {
        if (hn_graph_is_interrupted(w->graph)) {
            return HN_ERR_STOPPED;
        }
        if (!advance(w)) {
            snprintf(out->why, sizeof out->why,
                     "the motion comes to a singular configuration, where it is not determined");
            return HN_OK;
        }

        // the plane through the start is crossed from behind, near the start
        const double ahead = distance_ahead(w, &far);
        if (out->steps > 2 && before < 0 && ahead >= 0 && far < 2 * w->stride &&
            dot(out->n, w->tangent, w->first) > 0.5) {
            close_circuit(w);
            return HN_OK;
        }
        before = ahead;
    }
    snprintf(out->why, sizeof out->why, "the motion does not come back to its start in %d steps",
             MAX_STEPS);
    return HN_OK;
}

static void begin(walk *w, const hn_model *model) {
    hn_circuit *out = w->out;
    for (int i = 0; i < out->n; i++) {
        const hn_coordinate *c = hn_part_coordinate(model, i);
        w->turning[i] = c->kind == HN_ANGLE && c->turn < 0;
        w->start[i] = hn_pose_solver_coordinates(w->solver)[i];
        out->least[i] = HUGE_VAL;
        out->most[i] = -HUGE_VAL;
    }
    memcpy(w->first, w->tangent, sizeof w->first);
    arrive(w);
}

hn_status hn_circuit_walk(const hn_model *model, double stride, hn_circuit_visit *visit, void *user,
                          hn_circuit *out) {
    walk w = {.out = out,
              .visit = visit,
              .user = user,
              .stride = stride,
              .step = stride,
              .graph = hn_system_graph(hn_model_system(model))};
    *out = (hn_circuit){.n = hn_system_get_info(hn_model_system(model)).n_user};
    if (out->n > N) {
        snprintf(out->why, sizeof out->why,
                 "the mechanism has %d coordinates; at most %d are "
                 "followed",
                 out->n, N);
        return HN_OK;
    }
    for (int i = 0; i < out->n; i++) {
        if (hn_part_coordinate(model, i)->turn >= 0) {
            snprintf(out->why, sizeof out->why,
                     "joints with orientations of their own are not "
                     "followed round");
            return HN_OK;
        }
    }
    HN_TRY(hn_pose_solver_create(model, &w.solver));

    // exactly one degree of freedom has a tangent
    hn_status status = HN_OK;
    const int freedoms = hn_pose_solver_direction(w.solver, w.tangent);
    if (freedoms == 1) {
        begin(&w, model);
        status = follow(&w);
    } else {
        snprintf(out->why, sizeof out->why,
                 "the mechanism has %d degrees of freedom at its start; one is needed", freedoms);
    }
    hn_pose_solver_free(w.solver);
    return status;
}
