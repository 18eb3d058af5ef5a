#include "study/flow.h"

#include "integrators/control.h"
#include "integrators/registry.h"
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

enum { MOST_TRIALS = 10000 };
#define SMALLEST 1e-9 // of the time asked for
#define LANDED 1e-12  // of the time asked for
// A shorter trial whose error has hardly shrunk, where order 8 would have made it 2^-8 at half the size, shows rounding
// of the right-hand side: no step is better.
#define NO_BETTER 0.25

struct hn_flow {
    int n;
    void *stepper;
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

hn_status hn_flow_run(hn_flow *f, const hn_ode *ode, double tol, double t, double h,
                      const double *y, double *y_end) {
    const hn_stepper *dop853 = &hn_stepper_dop853;
    hn_step_control control = {.last = 1};
    double done = 0, part = h, refused = 0; // error of the trial before, where that was turned down
    memcpy(f->y, y, (size_t)f->n * sizeof *y);
    dop853->accepted(f->stepper, 1); // slopes kept from another flow belong to another y
    for (int trial = 0; h - done > LANDED * h; trial++) {
        if (trial == MOST_TRIALS) {
            return HN_ERR_NO_CONVERGENCE;
        }
        part = fmin(part, h - done);
        const hn_status status =
            dop853->step(f->stepper, ode, t + done, part, f->y, f->y_new, f->err);
        const double err =
            status == HN_OK ? hn_error_norm(f->n, f->err, f->y, f->y_new, tol, tol) : HUGE_VAL;
        double next = part * hn_step_factor(&control, err, dop853->order);
        const int is_noise = isfinite(err) && err > NO_BETTER * refused && refused > 0;
        refused = err > 1 && !is_noise && isfinite(err) ? err : 0;
        if (is_noise) {
            next = part * HN_STEP_GROW;
        }
        if (err <= 1 || is_noise) {
            done += part;
            memcpy(f->y, f->y_new, (size_t)f->n * sizeof *y);
            dop853->accepted(f->stepper, 0);
        } else if (next < SMALLEST * h) {
            return status != HN_OK ? status : HN_ERR_STEP_UNDERFLOW;
        }
        part = next;
    }
    memcpy(y_end, f->y, (size_t)f->n * sizeof *y);
    return hn_all_finite(f->n, y_end) ? HN_OK : HN_ERR_DIVERGED;
}
