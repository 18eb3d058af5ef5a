// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/budget/flow.h"

#include "integrators/explicit/tableau.h"
#include "integrators/list/stepper_list.h"
#include "integrators/step/control.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

enum { MOST_TRIALS = 10000 };
#define SMALLEST \
    1e-5 // of the time asked for: shorter ones are for a pose where the motion breaks off
#define LANDED 1e-12 // of the time asked for
// A shorter trial whose error has hardly shrunk, where order 8 would have made it 2^-8 at half the
// size, shows rounding of the right-hand side: no step is better. A step that is hardly shorter
// gives the error may have been left as large as the square of that.
#define NO_BETTER 0.25

struct hn_flow {
    int n;
    void *stepper;
    double size; // of a step, as the last flow would have gone on; 0: none was
    double *y, *y_new, *err;
};

hn_status hn_flow_create(int n_pos, int n_vel, hn_arena *arena, hn_flow **out) {
    const size_t n = (size_t)(n_pos + n_vel);
    hn_flow *f = hn_arena_get(arena, sizeof *f);
    if (!f) {
        return HN_ERR_MEMORY;
    }
    *f = (hn_flow){.n = n_pos + n_vel,
                   .stepper = hn_stepper_dop853.create(n_pos, n_vel, arena),
                   .y = hn_arena_doubles(arena, n),
                   .y_new = hn_arena_doubles(arena, n),
                   .err = hn_arena_doubles(arena, n)};
    if (!f->stepper || hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    *out = f;
    return HN_OK;
}

/// The steps that a flow takes: of each the time since its start, the size, y there.
typedef struct path {
    hn_arena *arena;
    size_t n, room, width;
    double *steps; // room x width
} path;

static hn_status keep_step(path *p, double done, double part, const double *y) {
    if (p->n == p->room) {
        const size_t room = 2 * p->room + 4;
        double *more = hn_arena_doubles(p->arena, room * p->width);
        if (!more) {
            return HN_ERR_MEMORY;
        }
        if (p->n > 0) {
            memcpy(more, p->steps, p->n * p->width * sizeof *more);
        }
        p->steps = more;
        p->room = room;
    }
    double *step = p->steps + p->n++ * p->width;
    step[0] = done;
    step[1] = part;
    memcpy(step + 2, y, (p->width - 2) * sizeof *step);
    return HN_OK;
}

/// Returns the factor to the step size that just meets the tolerance. A flow has only a few steps,
/// so the size is not approached slowly.
static double factor_of(double err, int order) {
    const double least = 1e-10; // of an error that may be 0
    return isfinite(err)
               ? fmin(HN_STEP_GROW,
                      fmax(HN_STEP_SHRINK, HN_STEP_SAFETY * pow(fmax(err, least), -1.0 / order)))
               : HN_STEP_SHRINK;
}

/// Divides the rest of a flow into equal steps of at most `size`: a short last step would cost as
/// much as a full one.
static double even_part(double rest, double size) {
    return size < rest ? rest / ceil(rest / size) : rest;
}

/// Leaves y at t + h in f->y; `along` may be NULL.
static hn_status go(hn_flow *f, const hn_ode *ode, double tol, double t, double h, const double *y,
                    path *along) {
    const hn_stepper *dop853 = &hn_stepper_dop853;
    const hn_tolerance allowed = {tol, tol, NULL, ode->is_angle, ode->n_pos};
    double done = 0, next = f->size > 0 ? f->size : h;
    // error and size of the trial before, where it was rejected
    double refused = 0, refused_part = h;

    memcpy(f->y, y, (size_t)f->n * sizeof *y);
    dop853->on_accepted(f->stepper, 1); // slopes kept from another flow belong to another y

    for (int trial = 0; h - done > LANDED * h; trial++) {
        if (trial == MOST_TRIALS) {
            return HN_ERR_NO_CONVERGENCE;
        }

        // one trial step and its error
        const double part = even_part(h - done, next);
        const hn_status status =
            dop853->step(f->stepper, ode, t + done, part, f->y, f->y_new, f->err);
        const double err =
            status == HN_OK ? hn_error_norm(f->n, f->err, f->y, f->y_new, &allowed) : HUGE_VAL;
        next = part * factor_of(err, dop853->order);

        // an error that does not fall with the step is rounding, and is accepted
        const double shorter = part / refused_part;
        const int is_noise =
            isfinite(err) && refused > 0 && err > refused * fmax(NO_BETTER, shorter * shorter);
        refused = err > 1 && !is_noise && isfinite(err) ? err : 0;
        refused_part = part;
        if (is_noise) {
            next = part * HN_STEP_GROW;
        }

        // accept the step, or give up where steps become too small
        if (err <= 1 || is_noise) {
            const hn_status kept = along ? keep_step(along, done, part, f->y) : HN_OK;
            if (kept != HN_OK) {
                return kept;
            }
            done += part;
            memcpy(f->y, f->y_new, (size_t)f->n * sizeof *y);
            dop853->on_accepted(f->stepper, 0);
        } else if (next < SMALLEST * h) {
            return status != HN_OK ? status : HN_ERR_STEP_UNDERFLOW;
        }
    }
    f->size = next;
    return hn_all_finite(f->n, f->y) ? HN_OK : HN_ERR_DIVERGED;
}

hn_status hn_flow_run(hn_flow *f, const hn_ode *ode, double tol, double t, double h,
                      const double *y, double *y_end) {
    HN_TRY(go(f, ode, tol, t, h, y, NULL));
    memcpy(y_end, f->y, (size_t)f->n * sizeof *y);
    return HN_OK;
}

// ---- derivatives, carried back ----

struct hn_flow_carrier {
    hn_flow *flow;
    int n, n_carried;
    path path;
    double *stages, *rates; // stages x n: Y_i and F there
    double *carried;        // stages x n_carried: g_i of (2)
    double *w;
};

hn_status hn_flow_carrier_create(int n_pos, int n_vel, int n, hn_arena *arena,
                                 hn_flow_carrier **out) {
    const size_t stages = (size_t)hn_tableau_dop853.stages, size = (size_t)(n_pos + n_vel);
    hn_flow_carrier *c = hn_arena_get(arena, sizeof *c);
    if (!c) {
        return HN_ERR_MEMORY;
    }
    *c = (hn_flow_carrier){.n = n_pos + n_vel,
                           .n_carried = n,
                           .path = {.arena = arena, .width = 2 + size},
                           .stages = hn_arena_doubles(arena, stages * size),
                           .rates = hn_arena_doubles(arena, stages * size),
                           .carried = hn_arena_doubles(arena, stages * (size_t)n),
                           .w = hn_arena_doubles(arena, (size_t)n)};
    const hn_status status = hn_flow_create(n_pos, n_vel, arena, &c->flow);
    *out = c;
    return status == HN_OK && hn_arena_failed(arena) ? HN_ERR_MEMORY : status;
}

/// Entry (i, j) of the coefficients; row `stages` is that of the new state.
static double weight_of(int i, int j) {
    const hn_tableau *tab = &hn_tableau_dop853;
    return i < tab->stages ? tab->A[i * (tab->stages + tab->extra) + j] : tab->b[j];
}

/// Computes the stages Y_i of one recorded step again.
static hn_status find_stages(hn_flow_carrier *c, const hn_ode *ode, double t, double h,
                             const double *y) {
    const hn_tableau *tab = &hn_tableau_dop853;
    hn_status status = HN_OK;
    for (int i = 0; status == HN_OK && i < tab->stages; i++) {
        double *stage = c->stages + i * c->n;
        memcpy(stage, y, (size_t)c->n * sizeof *y);
        for (int j = 0; j < i; j++) {
            hn_axpy(c->n, h * weight_of(i, j), c->rates + j * c->n, stage);
        }
        status = ode->rhs(ode->self, t + tab->c[i] * h, stage, c->rates + i * c->n);
    }
    return status;
}

// With u' = A u carried along by the same step, u_new = u + h sum b_i A_i U_i, U_i = u + h sum_j
// a_ij A_j U_j, so that
//
//     w <- w + sum g_i,     g_i = A_i' (h b_i w + h sum_{j > i} a_ji g_j),                   (2)
//
// from the last i to the first
static hn_status carry_step(hn_flow_carrier *c, const hn_flow_slopes *slopes, double t, double h,
                            double *w) {
    const hn_tableau *tab = &hn_tableau_dop853;
    const int n = c->n_carried;
    hn_status status = HN_OK;
    for (int i = tab->stages - 1; status == HN_OK && i >= 0; i--) {
        for (int k = 0; k < n; k++) {
            c->w[k] = h * weight_of(tab->stages, i) * w[k];
        }
        for (int j = i + 1; j < tab->stages; j++) {
            hn_axpy(n, h * weight_of(j, i), c->carried + j * n, c->w);
        }
        status = slopes->back(slopes->self, t + tab->c[i] * h, c->stages + i * c->n, c->w,
                              c->carried + i * n);
    }
    for (int i = 0; status == HN_OK && i < tab->stages; i++) {
        hn_axpy(n, 1, c->carried + i * n, w);
    }
    return status;
}

hn_status hn_flow_carry_back(hn_flow_carrier *c, const hn_ode *ode, const hn_flow_slopes *slopes,
                             double tol, double t, double h, const double *y, double *w) {
    HN_ASSERT(slopes->n == c->n_carried);
    c->path.n = 0;
    hn_status status = go(c->flow, ode, tol, t, h, y, &c->path);
    for (size_t k = c->path.n; status == HN_OK && k-- > 0;) {
        const double *step = c->path.steps + k * c->path.width;
        status = find_stages(c, ode, t + step[0], step[1], step + 2);
        HN_THEN(status, carry_step(c, slopes, t + step[0], step[1], w));
    }
    return status == HN_OK && !hn_all_finite(c->n_carried, w) ? HN_ERR_DIVERGED : status;
}
