// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_STEPPER_H
#define HN_INTEGRATORS_STEPPER_H
// An integrator advances a state from t to t + h. Each is a table of functions (hn_stepper): one
// file, and one line in integrators/list. Explicit Runge-Kutta methods are tableaux (tableau.h).

#include "base/arena.h"
#include "formulations/ground/formulation.h"

typedef struct hn_dae_stepper hn_dae_stepper;

typedef struct hn_stepper {
    const char *name, *title; ///< "rk4", "Runge-Kutta 4"
    const char *about, *source;
    int order;         ///< of the solution that is kept; 0: not known, of a program's own steps
    int control_order; ///< order of the embedded solution + 1, used to choose the step; 0: `order`
    int stages;        ///< right-hand sides per step
    /// chooses its own step from rtol and atol; an option h > 0, where there is one, fixes the step
    bool adaptive;
    /// uses earlier steps: a state changed after a step makes it restart at order 1
    bool multistep;
    bool partitioned; ///< treats positions and velocities differently (symplectic Euler)
    /// Largest stable |h s| on the negative real and on the imaginary axis; HUGE_VAL: no limit.
    double real_limit, imag_limit;
    /// The tableau of an explicit Runge-Kutta method whose steps share nothing with each other, so
    /// that many runs can step side by side; NULL: not so.
    const struct hn_tableau *tableau;
    int n_options;
    hn_option options[HN_MAX_OPTIONS];

    /// Forms that it serves, bit (1 << form) each; 0: ordinary differential equations only.
    unsigned forms;
    /// The message for a form that users expect and it does not serve: why not. NULL: none.
    const char *unserved;
    /// Functions for differential-algebraic forms, see integrators/step/dae.h; NULL when `forms`
    /// has none.
    const hn_dae_stepper *dae;

    /// The members below serve ordinary differential equations; create NULL: it does not.
    void *(*create)(int n_pos, int n_vel, hn_arena *arena);
    void (*destroy)(void *self); ///< frees what is not from the arena; NULL: nothing
    /// Takes the options in table order, once after create. NULL: it has none to take.
    void (*configure)(void *self, const double *options);
    /// Reserves the memory that steps on this equation need, so that steps allocate nothing;
    /// otherwise the first step does so. NULL: none needed.
    hn_status (*prepare)(void *self, const hn_ode *ode);
    /// Makes one trial step of size h from (t, y) to y_new; err (n) receives the embedded error
    /// estimate when adaptive. Does not change y. Fails with the right-hand side's status.
    hn_status (*step)(void *self, const hn_ode *ode, double t, double h, const double *y,
                      double *y_new, double *err);
    /// Evaluates the right-hand sides that only dense output needs, for the step just tried; called
    /// once its error is accepted and before the state is corrected. Fails with the right-hand
    /// side's status. NULL: dense output needs none.
    hn_status (*finish)(void *self, const hn_ode *ode);
    /// Called after each accepted step. changed = 0: y_new was kept as it is (FSAL slopes stay
    /// valid); 1: it was changed.
    void (*on_accepted)(void *self, int changed);
    /// Dense output of the step just accepted: y at t + theta h, theta in [0, 1]. NULL: none.
    void (*dense)(void *self, double theta, double *y);
    int dense_order;
    /// Returns |h lambda| of the step before the last one, lambda the fastest rate that its
    /// right-hand sides met; 0: not known. NULL: not measured. Source: Hairer & Wanner 1996, IV.2.
    double (*stiffness)(const void *self);
    /// Makes one step whose size the integrator chooses itself, from (t, y) to (*t_new, y_new), not
    /// beyond t_stop (HUGE_VAL: no bound); then `step` is not called and may be NULL. NULL: the run
    /// chooses the size.
    hn_status (*advance)(void *self, const hn_ode *ode, double t, double t_stop, const double *y,
                         double *t_new, double *y_new);
    /// work besides right-hand sides; NULL: none
    void (*add_cost)(const void *self, hn_cost *cost);
    const char *(*why)(const void *self); ///< reason of its own last failure, or NULL
} hn_stepper;

/// Returns whether the integrator serves formulations of this form.
bool hn_stepper_serves(const hn_stepper *stepper, hn_dae_form form);

#endif
