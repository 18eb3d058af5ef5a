// SPDX-License-Identifier: GPL-3.0-or-later
// An order of the stages of a time step, which is executed: a bead of unit mass on an ellipse,
// (x/A)^2 + (y/B)^2 = 1, is simulated with the stages in the order of the answer, and what comes
// out is judged. (On a circle the projection of q would not turn J, and a wrong order would go
// unseen.) The stages are those of the exercise's Problem: assemble, solve, integrate,
// project-position, project-velocity.
#include "grade/parts/part_list.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { STEPS = 100, MAX_STAGES = 8 };
static const double STEP = 0.01, A = 1.5, B = 0.8, GRAVITY = 9.81; // [s], [m], [m], [m/s^2]
static const double CLOSED =
    1e-12; // what projections reach: phi has no unit and is 1 at the size of the ellipse

/// The state, and what the stages hand to each other.
typedef struct bead {
    double q[2], v[2], a[2];
    double J[2], gamma;
    int has_matrices, has_accelerations;
    double matrices_at[2]; ///< the configuration that the matrices were formed at
    const char *failed;    ///< the id of what went wrong first, NULL: nothing
    double worst_gap, worst_rate;
} bead;

static double gap(const bead *s) {
    return (s->q[0] * s->q[0] / (A * A) + s->q[1] * s->q[1] / (B * B) - 1) / 2;
}

static void jacobian(const bead *s, double J[2]) {
    J[0] = s->q[0] / (A * A);
    J[1] = s->q[1] / (B * B);
}

static double rate(const bead *s) {
    double J[2];
    jacobian(s, J);
    return J[0] * s->v[0] + J[1] * s->v[1];
}

static void fail(bead *s, const char *id) {
    s->failed = s->failed ? s->failed : id;
}

static void assemble(bead *s) {
    jacobian(s, s->J);
    memcpy(s->matrices_at, s->q, sizeof s->q);
    s->gamma = s->v[0] * s->v[0] / (A * A) + s->v[1] * s->v[1] / (B * B);
    s->has_matrices = 1;
}

/// [M J'; J 0] [a; -lambda] = [f; -gamma] with M the unit matrix and f = (0, -g)
static void solve(bead *s) {
    const int stale =
        s->has_matrices && (s->matrices_at[0] != s->q[0] || s->matrices_at[1] != s->q[1]);
    if (!s->has_matrices || stale) {
        fail(s, "solve-stale");
    }
    const double f[2] = {0, -GRAVITY}, square = s->J[0] * s->J[0] + s->J[1] * s->J[1];
    const double lambda = square > 0 ? -(s->gamma + s->J[0] * f[0] + s->J[1] * f[1]) / square : 0;
    for (int i = 0; i < 2; i++) {
        s->a[i] = f[i] + s->J[i] * lambda;
    }
    s->has_accelerations = 1;
}

static void integrate(bead *s) {
    if (!s->has_accelerations) {
        fail(s, "integrate-early");
    }
    for (int i = 0; i < 2; i++) {
        s->q[i] += STEP * s->v[i] + STEP * STEP / 2 * s->a[i];
        s->v[i] += STEP * s->a[i];
    }
    s->has_accelerations = 0;
}

/// Newton's method along J', to rounding.
static void project_position(bead *s) {
    for (int k = 0; k < 20 && fabs(gap(s)) > 1e-15; k++) {
        double J[2];
        jacobian(s, J);
        const double along = gap(s) / (J[0] * J[0] + J[1] * J[1]);
        s->q[0] -= along * J[0];
        s->q[1] -= along * J[1];
    }
}

static void project_velocity(bead *s) {
    double J[2];
    jacobian(s, J);
    const double along = rate(s) / (J[0] * J[0] + J[1] * J[1]);
    s->v[0] -= along * J[0];
    s->v[1] -= along * J[1];
}

static const struct {
    const char *name, *about;
    void (*run)(bead *s);
} STAGES[] = {
    {"assemble", "form M, h, J and gamma at the present q, v", assemble},
    {"solve", "solve the saddle-point system for a and lambda", solve},
    {"integrate", "take q and v to the next time with a", integrate},
    {"project-position", "move q back to phi(q) = 0", project_position},
    {"project-velocity", "make J v = 0 at the present q", project_velocity},
};
enum { N_STAGES = sizeof STAGES / sizeof *STAGES };

static const struct {
    const char *id, *says;
} OUTCOMES[] = {
    {"solve-stale",
     "executed: the system is solved with matrices of another configuration than the present one"},
    {"integrate-early", "executed: a step is taken without accelerations of this step"},
    {"open", "executed: the state that the step hands on is not on phi(q) = 0"},
    {"slipping",
     "executed: the step hands on a velocity that is not tangent; J v = 0 must be made at the "
     "position that stays"},
};

/// Executes the order; returns the index of the outcome, -1 when all is well.
static int execute(const int *order, int n, double *worst_gap, double *worst_rate) {
    bead s = {.q = {A * sin(1), -B * cos(1)}, .v = {2 * A * cos(1), 2 * B * sin(1)}};
    for (int k = 0; k < STEPS; k++) {
        for (int i = 0; i < n; i++) {
            STAGES[order[i]].run(&s);
        }
        s.worst_gap = fmax(s.worst_gap, fabs(gap(&s)));
        s.worst_rate = fmax(s.worst_rate, fabs(rate(&s)));
    }
    *worst_gap = s.worst_gap;
    *worst_rate = s.worst_rate;
    if (s.failed) {
        return strcmp(s.failed, "solve-stale") == 0 ? 0 : 1;
    }
    return !(s.worst_gap <= CLOSED) ? 2 : !(s.worst_rate <= CLOSED * 10) ? 3 : -1;
}

/// Reads the words of an answer; 0 after the result has said what is wrong with them.
static int read_order(const cJSON *given, int *order, int *n, hn_part_result *r) {
    const cJSON *m;
    int seen = 0;
    *n = 0;

    // each word is a stage, and stands there once
    cJSON_ArrayForEach(m, given) {
        const char *word = cJSON_GetStringValue(m);
        int i = 0;
        while (i < N_STAGES && (!word || strcmp(STAGES[i].name, word) != 0)) {
            i++;
        }
        if (i == N_STAGES) {
            hn_part_unreadable(r, "there is no stage '%.40s'", word ? word : "");
            return 0;
        }
        if (*n == N_STAGES || (seen & 1 << i)) {
            hn_part_wrong(r, "twice", 0, "the stage '%s' is there twice", STAGES[i].name);
            return 0;
        }
        seen |= 1 << i;
        order[(*n)++] = i;
    }

    // the first three stages make a step; the others may be left out
    for (int i = 0; i < 3; i++) {
        if (!(seen & 1 << i)) {
            hn_part_wrong(r, "missing-stage", 0, "without '%s' there is no step", STAGES[i].name);
            return 0;
        }
    }
    return 1;
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *r, int *n,
                       hn_diag *diag) {
    int order[MAX_STAGES], count;
    double worst_gap, worst_rate;

    // a part of this kind draws nothing and cannot fail
    (void)p;
    (void)diag;

    // nothing, or nothing that can be run
    if (!hn_part_begin(r, n, given, "an order that keeps phi and J v at zero")) {
        return HN_OK;
    }
    if (!cJSON_IsArray(given)) {
        hn_part_unreadable(r, "expected a list of stages in quotes");
        return HN_OK;
    }
    if (!read_order(given, order, &count, r)) {
        return HN_OK;
    }

    // the steps are run in this order, and the drift tells what it is worth
    const int outcome = execute(order, count, &worst_gap, &worst_rate);
    if (outcome < 0) {
        hn_part_right(r);
    } else {
        hn_part_wrong(r, OUTCOMES[outcome].id, outcome == 3 ? 0.5 : 0,
                      "%s (after %d steps: |phi| up to %.1e, |J v| up to %.1e 1/s)",
                      OUTCOMES[outcome].says, STEPS, worst_gap, worst_rate);
    }
    return HN_OK;
}

/// The stages in an order that depends on the seed and is not the answer.
static void ask(hn_strbuf *b, const hn_part *p) {
    int order[N_STAGES];
    for (int i = 0; i < N_STAGES; i++) {
        order[i] = (N_STAGES - 1 - i + (int)(p->seed % (N_STAGES - 1))) % N_STAGES;
    }
    hn_strbuf_add(b, "a list of stages in quotes: [\"...\", ...]; the order is executed");
    for (int i = 0; i < N_STAGES; i++) {
        char name[24];
        snprintf(name, sizeof name, "%s:", STAGES[order[i]].name);
        hn_strbuf_printf(b, "\n    %-17s %s", name, STAGES[order[i]].about);
    }
}

static cJSON *blank(const hn_part *p) {
    (void)p;
    return cJSON_CreateArray();
}

const hn_part_kind hn_part_order = {
    .name = "order",
    .fields = "answer faults",
    .is_open = true,
    .ask = ask,
    .grade = grade,
    .blank = blank,
    .right = hn_part_right_answer,
    .fault = hn_part_fault_answer,
    .prove = NULL, // the order is executed
};
