// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "integrators/step/dae_base.h"
#include "integrators/step/options.h"
#include "linalg/dense.h"
#include "linalg/newton_matrix.h"
#include "linalg/square.h"

#include "dynamics/evaluate/linearise.h"

#include <math.h>
#include <string.h>

// The trapezoidal rule on q'' with the loop closed at its end, the multipliers by an augmented
// Lagrangian. With weight w
//
//  v1 = (2/h) D - v0,    a1 = (4/h^2) D - (4/h) v0 - a0,    q1 = q0 + D                    (1)
// T delta = -h^2/4 (M a1 - f + J' (lambda* + w phi(q1))), D += delta, THEN lambda* += w phi(q1) (2)
//  T = M + h/2 C + h^2/4 (w J' J + K)
//
// The force of the loop is -J' lambda*. The update of lambda* belongs after that of q1: with the
// phi of the old q1 the Newton correction counts twice and the iteration ends in a cycle. Each turn
// shrinks phi by about 1 / (1 + w h^2 s / 4), s the smallest eigenvalue of J M^-1 J', so w has to
// grow as h falls. Then the speeds and accelerations are projected with the same T:
//
//     T v = (M + h/2 C + h^2/4 K) v* - h^2/4 w J' phi_t,
//     T a = (M + h/2 C + h^2/4 K) a* - h^2/4 w J' gamma  (3)
//
// which leaves J v = O(1 / w); two turns leave the square of that, and so on. Without (3) the
// undamped rule on index 3 is unstable: kept as an exhibit. Rows may depend on each other: T is
// positive definite all the same. Sources: Bayo & Ledesma 1996; Cuadrado, Cardenal & Bayo 1997;
// Cardona & Geradin 1989 (instability).

enum {
    SPARSE_FROM = 16
}; // size of T; it holds no zeros on its diagonal and is half as large as other Newton matrices
static const double LAST_TURN = 1e-11; // the first turns shrink faster than w lets the later ones
static const double AUTO_CONTRACTION = 1e3; // w h^2 s / 4 aimed at where no weight is given

typedef struct carried {
    double *a, *lambda; // nv; nc: lambda*
} carried;

typedef struct trapezoidal {
    hn_dae_base base; // first
    int project;
    double given_weight;
    hn_linear *matrices;      // R, M, K, C, J, phi
    hn_eval *rate;            // gamma
    hn_square square;         // T, small
    hn_newton_matrix *sparse; // T, large; else NULL
    const int *J_row,
        *J_col; // the entries of J that are not identically zero, those of a row next to each other
    int n_J;
    carried now, next;
    double *D, *v1, *a1, *x, *part; // nv
    double *push, *raw;             // nc: -lambda* of the iteration, of the accepted step
} trapezoidal;

static void carried_init(carried *c, hn_arena *arena, size_t nv, size_t nc) {
    c->a = hn_arena_doubles(arena, nv);
    c->lambda = hn_arena_doubles(arena, nc);
}

// the last entry of J that stands in the row of entry e, and one more
static int row_end(const trapezoidal *s, int e) {
    int end = e;
    while (end < s->n_J && s->J_row[end] == s->J_row[e]) {
        end++;
    }
    return end;
}

static int create_tangent(trapezoidal *s, hn_arena *arena) {
    const int nv = s->base.nv;
    const int square = hn_linear_entries(s->matrices, HN_LINEAR_M) +
                       hn_linear_entries(s->matrices, HN_LINEAR_C) +
                       hn_linear_entries(s->matrices, HN_LINEAR_K);
    long long pairs = 0;
    s->n_J = hn_linear_pattern(s->matrices, HN_LINEAR_J, &s->J_row, &s->J_col);
    for (int e = 0, end; e < s->n_J; e = end) {
        end = row_end(s, e);
        pairs += (long long)(end - e) * (end - e);
    }
    // most of the pairs stand where M has entries too
    if (nv < SPARSE_FROM ||
        4 * (hn_linear_entries(s->matrices, HN_LINEAR_M) + pairs) > 3LL * nv * nv) {
        return hn_square_init(&s->square, arena, nv);
    }
    s->sparse = hn_newton_matrix_create(arena, HN_REAL, 1, nv, square + (int)pairs);
    return s->sparse != NULL;
}

static hn_status allocate(trapezoidal *s, hn_arena *arena) {
    const size_t nv = (size_t)s->base.nv, nc = (size_t)s->base.nc;
    double **of_nv[] = {&s->D, &s->v1, &s->a1, &s->x, &s->part};
    for (size_t i = 0; i < sizeof of_nv / sizeof *of_nv; i++) {
        *of_nv[i] = hn_arena_doubles(arena, nv);
    }
    s->push = hn_arena_doubles(arena, nc);
    s->raw = hn_arena_doubles(arena, nc);
    carried_init(&s->now, arena, nv, nc);
    carried_init(&s->next, arena, nv, nc);
    return create_tangent(s, arena) && !hn_arena_failed(arena) ? HN_OK : HN_ERR_MEMORY;
}

static hn_status create(const hn_system *sys, hn_dae_form form, const double *options,
                        const double *form_options, hn_arena *arena, void **self, hn_diag *diag) {
    (void)options;
    const unsigned terms =
        HN_LINEAR_RESIDUAL | HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_J | HN_LINEAR_PHI;
    HN_TRY(
        hn_dae_instance(form, form_options, "trapezoidal", sizeof(trapezoidal), arena, self, diag));
    trapezoidal *s = *self;
    HN_TRY(hn_dae_base_init(&s->base, sys, arena, diag));
    // on index3 it is the bare rule
    const int augmented = form == HN_FORM_AUGMENTED;
    s->given_weight = augmented ? form_options[HN_AUGMENTED_WEIGHT] : 0;
    s->project = augmented && (int)form_options[HN_AUGMENTED_PROJECTIONS] == HN_PROJECTIONS_ON;

    hn_status status = hn_linear_create(sys, terms, arena, &s->matrices);
    HN_THEN(status, hn_eval_create(sys, HN_TERM_GAMMA, arena, &s->rate));
    HN_THEN(status, allocate(s, arena));
    return status == HN_OK ? HN_OK
                           : hn_diag_set(diag, status, NULL, NULL,
                                         "the linearised equations cannot be set up: %s",
                                         hn_status_text(status));
}

static void destroy(void *self) {
    trapezoidal *s = self;
    hn_linear_free(s->matrices);
    hn_eval_free(s->rate);
    hn_newton_matrix_free(s->sparse);
    s->sparse = NULL;
    s->matrices = NULL;
    s->rate = NULL;
    hn_dae_base_destroy(&s->base);
}

static hn_status start(void *self, double t, const double *y) {
    trapezoidal *s = self;
    hn_dae_base *b = &s->base;
    const hn_status status = hn_dae_accelerate(b, t, y, y + b->nq, s->now.a, s->now.lambda);
    for (int i = 0; i < b->nc; i++) {
        s->now.lambda[i] = -s->now.lambda[i];
    }
    return status;
}

// AUTO_CONTRACTION / (h^2 s / 4) with s the least of J_i diag(M)^-1 J_i'
static double choose_weight(const trapezoidal *s, double h) {
    const hn_dae_base *b = &s->base;
    double least = HUGE_VAL;
    if (s->given_weight > 0) {
        return s->given_weight;
    }
    for (int e = 0, end; e < s->n_J; e = end) {
        const double *row = b->J + (size_t)s->J_row[e] * (size_t)b->nv;
        double sum = 0;
        end = row_end(s, e);
        for (int i = e; i < end; i++) {
            const int j = s->J_col[i];
            const double m = b->M[(size_t)j * (size_t)b->nv + (size_t)j];
            sum += m > 0 ? row[j] * row[j] / m : 0;
        }
        least = sum > 0 ? fmin(least, sum) : least;
    }
    return isfinite(least) ? 4 * AUTO_CONTRACTION / (h * h * least) : 0;
}

// (1): q1, v1 and a1 of D
static void move_state(trapezoidal *s, double h, const double *y, double *q1) {
    const hn_dae_base *b = &s->base;
    const double *v0 = y + b->nq;
    for (int i = 0; i < b->nv; i++) {
        s->v1[i] = 2 / h * s->D[i] - v0[i];
        s->a1[i] = 4 / (h * h) * s->D[i] - 4 / h * v0[i] - s->now.a[i];
    }
    memcpy(q1, y, (size_t)b->nq * sizeof *q1);
    hn_system_move(b->sys, q1, s->D);
}

// x <- x + scale J' y with J of the matrices last evaluated
static void add_rows(const trapezoidal *s, double scale, const double *y, double *x) {
    const double *J = hn_linear_get(s->matrices, HN_LINEAR_J);
    for (int e = 0; e < s->n_J; e++) {
        const int row = s->J_row[e], col = s->J_col[e];
        x[col] += scale * J[(size_t)row * (size_t)s->base.nv + (size_t)col] * y[row];
    }
}

static void put(trapezoidal *s, int row, int col, double e) {
    if (s->sparse) {
        hn_newton_matrix_put(s->sparse, row, col, e, 0);
    } else {
        s->square.lu[row * s->base.nv + col] += e;
    }
}

static void put_term(trapezoidal *s, hn_linear_term term, double scale) {
    const double *values = hn_linear_get(s->matrices, term);
    const int *rows, *cols, n = hn_linear_pattern(s->matrices, term, &rows, &cols);
    for (int e = 0; e < n; e++) {
        put(s, rows[e], cols[e],
            scale * values[(size_t)rows[e] * (size_t)s->base.nv + (size_t)cols[e]]);
    }
}

// scale J' J: every two entries of a row of J meet in one of the product
static void put_penalty(trapezoidal *s, double scale) {
    const double *J = hn_linear_get(s->matrices, HN_LINEAR_J);
    for (int e = 0, end; e < s->n_J; e = end) {
        const double *row = J + (size_t)s->J_row[e] * (size_t)s->base.nv;
        end = row_end(s, e);
        for (int i = e; i < end; i++) {
            for (int k = e; k < end; k++) {
                put(s, s->J_col[i], s->J_col[k], scale * row[s->J_col[i]] * row[s->J_col[k]]);
            }
        }
        s->base.cost.ops += 3.0 * (end - e) * (end - e);
    }
}

// T at the matrices last evaluated, factored
static hn_status factor_tangent(trapezoidal *s, double h, double weight) {
    hn_dae_base *b = &s->base;
    const int nv = b->nv;
    if (s->sparse) {
        hn_newton_matrix_begin(s->sparse, nv);
    } else {
        memset(s->square.lu, 0, (size_t)nv * (size_t)nv * sizeof *s->square.lu);
    }
    put_term(s, HN_LINEAR_M, 1);
    put_term(s, HN_LINEAR_C, h / 2);
    put_term(s, HN_LINEAR_K, h * h / 4);
    put_penalty(s, h * h / 4 * weight);
    b->cost.factorisations++;
    if (s->sparse) {
        return hn_newton_matrix_factor(s->sparse); // counts its own operations
    }
    b->cost.ops += 2.0 / 3 * nv * nv * nv;
    return hn_square_factor(&s->square, nv);
}

static void solve(trapezoidal *s, double *x) {
    s->base.cost.solves++;
    if (s->sparse) {
        hn_newton_matrix_solve(s->sparse, x);
        return;
    }
    hn_square_solve(&s->square, x);
    s->base.cost.ops += 2.0 * s->base.nv * s->base.nv;
}

// the linearised equations with the multipliers that (2) has reached
static void linearise(trapezoidal *s, double t1, const double *q1) {
    hn_dae_base *b = &s->base;
    for (int k = 0; k < b->nc; k++) {
        s->push[k] = -s->next.lambda[k];
    }
    hn_linear_run(s->matrices, t1, q1, s->v1, s->a1, s->push);
    b->cost.evals++;
}

// x = -h^2/4 (R + w J' phi), R = M a1 - f + J' lambda*
static void find_residual(trapezoidal *s, double h, double weight) {
    const hn_dae_base *b = &s->base;
    const double *R = hn_linear_get(s->matrices, HN_LINEAR_RESIDUAL);
    for (int i = 0; i < b->nv; i++) {
        s->x[i] = -h * h / 4 * R[i];
    }
    add_rows(s, -h * h / 4 * weight, hn_linear_get(s->matrices, HN_LINEAR_PHI), s->x);
}

static hn_status iterate(trapezoidal *s, double t1, double h, double weight, const double *y,
                         double *q1) {
    hn_dae_base *b = &s->base;
    hn_newton newton = {0};
    move_state(s, h, y, q1);
    for (;;) {
        // Newton's step with the penalty inside the tangent matrix
        linearise(s, t1, q1);
        find_residual(s, h, weight);
        const hn_status status = factor_tangent(s, h, weight);
        if (status != HN_OK) {
            return status;
        }
        solve(s, s->x);
        b->cost.newton++;
        hn_axpy(b->nv, 1, s->x, s->D);
        move_state(s, h, y, q1);
        hn_dae_loops(b, t1, q1);

        hn_axpy(b->nc, weight, b->phi, s->next.lambda); // after D has moved, see (2)

        // done when the step has converged, and the last update of lambda was small too
        const double size = hn_dae_newton_size(b, s->x, s->D, y);
        const hn_newton_verdict verdict = hn_newton_look(&newton, size);
        if (verdict == HN_NEWTON_DIVERGES) {
            return HN_ERR_NO_CONVERGENCE;
        }
        if (verdict == HN_NEWTON_DONE && size <= LAST_TURN) {
            return HN_OK;
        }
    }
}

// (3): z (nv) from z*, given (nc) phi_t or gamma
static void project(trapezoidal *s, double h, double weight, const double *given, double *z) {
    const int nv = s->base.nv;
    hn_linear_apply(s->matrices, HN_LINEAR_M, z, s->x);
    hn_linear_apply(s->matrices, HN_LINEAR_C, z, s->part);
    hn_axpy(nv, h / 2, s->part, s->x);
    hn_linear_apply(s->matrices, HN_LINEAR_K, z, s->part);
    hn_axpy(nv, h * h / 4, s->part, s->x);
    add_rows(s, -h * h / 4 * weight, given, s->x);
    solve(s, s->x);
    memcpy(z, s->x, (size_t)nv * sizeof *z);
}

static hn_status step(void *self, double t, double h, const double *y, double *y_new, double *err) {
    (void)err;
    trapezoidal *s = self;
    hn_dae_base *b = &s->base;
    const double *v0 = y + b->nq;
    hn_dae_dynamics(b, t, y, v0);
    hn_dae_loops(b, t, y);
    const double weight = choose_weight(s, h);

    // predictor: constant acceleration and multipliers
    memcpy(s->next.lambda, s->now.lambda, (size_t)b->nc * sizeof *s->next.lambda);
    for (int i = 0; i < b->nv; i++) {
        s->D[i] = h * v0[i] + h * h / 2 * s->now.a[i];
    }

    // corrector
    const hn_status status = iterate(s, t + h, h, weight, y, y_new);
    if (status != HN_OK) {
        return hn_dae_fail(b, status, t + h, "the step");
    }

    // project velocities and accelerations onto the constraints
    if (s->project) {
        project(s, h, weight, b->phi_t, s->v1);
        hn_eval_run(s->rate, t + h, y_new, s->v1);
        project(s, h, weight, hn_eval_get(s->rate, HN_TERM_GAMMA), s->a1);
        b->cost.projections++;
    }
    memcpy(y_new + b->nq, s->v1, (size_t)b->nv * sizeof *y_new);
    memcpy(s->next.a, s->a1, (size_t)b->nv * sizeof *s->a1);
    return HN_OK;
}

static void accepted(void *self, int changed) {
    trapezoidal *s = self;
    const carried spare = s->now;
    (void)
        // a small mending of the state leaves accelerations and multipliers as good as they were
        changed;
    s->now = s->next;
    s->next = spare;
    for (int k = 0; k < s->base.nc; k++) {
        s->raw[k] = -s->now.lambda[k];
    }
}

static const double *raw_lambda(const void *self) {
    const trapezoidal *s = self;
    return s->raw;
}

static void add_cost(const void *self, hn_cost *cost) {
    const trapezoidal *s = self;
    hn_dae_base_add_cost(&s->base, cost);
    cost->ops += (double)hn_linear_count(s->matrices) * hn_linear_ops(s->matrices) +
                 (double)hn_eval_count(s->rate) * hn_eval_info(s->rate).ops +
                 (s->sparse ? hn_newton_matrix_ops(s->sparse) : 0);
}

static const char *why(const void *self) {
    const trapezoidal *s = self;
    return hn_dae_base_why(&s->base);
}

static const hn_dae_stepper dae = {
    .create = create,
    .destroy = destroy,
    .start = start,
    .step = step,
    .on_accepted = accepted,
    .raw_lambda = raw_lambda,
    .add_cost = add_cost,
    .why = why,
};

const hn_stepper hn_stepper_trapezoidal = {
    .name = "trapezoidal",
    .title = "trapezoidal rule",
    .about = "Newmark's rule without damping, order 2. With the projections of ali3p after each "
             "step it is cheap and robust. On index 3 alone its velocities and multipliers grow "
             "slowly without bound (a counter-example).",
    .source = "Newmark 1959; Cuadrado, Cardenal & Bayo 1997; Cardona & Geradin 1989",
    .order = 2,
    .stages = 1,
    .real_limit = HUGE_VAL,
    .imag_limit = HUGE_VAL,
    .n_options = 1,
    .options = {HN_OPTION_STEP},
    .forms = 1u << HN_FORM_AUGMENTED | 1u << HN_FORM_INDEX3,
    .dae = &dae,
};
