#ifndef HN_INTEGRATORS_STEPPER_H
#define HN_INTEGRATORS_STEPPER_H
// An integrator: how time advances. One file each (tableaux are data), one row in the registry.

#include "base/arena.h"
#include "formulations/ground/formulation.h"

typedef struct hn_dae_stepper hn_dae_stepper;

typedef struct hn_stepper {
    const char *name, *title; ///< "rk4", "Runge-Kutta 4"
    const char *about, *source;
    int order;         ///< of the solution that is kept
    int control_order; ///< order of the embedded solution + 1, which the step is chosen with; 0: `order`
    int stages;        ///< right-hand sides per step
    int adaptive; ///< chooses its own step from rtol, atol; where there is a setting h too, h > 0 fixes the step
    int multistep; ///< its order rests on the steps before: a state changed after a step makes it start again at order 1
    int partitioned; ///< treats positions and speeds differently (symplectic Euler)
    double real_limit,
        imag_limit; ///< |h s| limits of the stability region on the axes; HUGE_VAL: none
    int n_settings;
    hn_setting_info settings[HN_MAX_SETTINGS]; ///< h, or rtol, atol, h0, hmax

    unsigned
        forms; ///< bit (1 << form) per hn_dae_form it serves; 0: ordinary differential equations only
    const char *
        unserved; ///< why it has no form where one would be looked for, for a refusal; NULL: nothing to say
    const hn_dae_stepper
        *dae; ///< how, see integrators/step/dae.h; NULL when `forms` has no differential-algebraic form

    /// What follows serves ordinary differential equations; create NULL: it does not.
    void *(*create)(int n_pos, int n_vel, hn_arena *arena);
    void (*destroy)(void *self); ///< what is not from the arena; NULL: nothing
    /// Settings in table order, once after create. NULL: it needs none.
    void (*configure)(void *self, const double *settings);
    /// Takes the memory that steps on this equation will need, so that they allocate nothing; done by the first step where it has not
    /// been. NULL: none.
    hn_status (*prepare)(void *self, const hn_ode *ode);
    /// One trial step of size h from (t, y) to y_new; err (n) receives the embedded error estimate when adaptive. Does not
    /// change y. Fails with the right-hand side's status.
    hn_status (*step)(void *self, const hn_ode *ode, double t, double h, const double *y,
                      double *y_new, double *err);
    /// Right-hand sides that only dense output needs, at the step just tried; called once its error is accepted, before the
    /// state is mended. Fails with the right-hand side's status. NULL: dense output needs none.
    hn_status (*finish)(void *self, const hn_ode *ode);
    /// Called when y_new was accepted as it is (FSAL may be kept) or was changed afterwards (it may not).
    void (*accepted)(void *self, int changed);
    /// Dense output in the step just accepted: y at t + theta h, theta in [0, 1]. NULL: none.
    void (*dense)(void *self, double theta, double *y);
    int dense_order;
    /// |h lambda| of the step before the last one as the right-hand sides of that step showed it, lambda the fastest rate that they met;
    /// 0: not known. NULL: it does not look. Source: Hairer & Wanner 1996, IV.2.
    double (*stiffness)(const void *self);
    /// One step whose size the integrator chooses itself, from (t, y) to (*t_new, y_new), not beyond t_stop (HUGE_VAL: no
    /// bound); then `step` is not called and may be NULL. NULL: the run chooses the size.
    hn_status (*advance)(void *self, const hn_ode *ode, double t, double t_stop, const double *y,
                         double *t_new, double *y_new);
    void (*add_cost)(const void *self,
                     hn_cost *cost);      ///< beside the right-hand sides; NULL: nothing
    const char *(*why)(const void *self); ///< reason of its own last failure, or NULL
} hn_stepper;

/// 1 if it serves formulations of this form.
int hn_stepper_serves(const hn_stepper *stepper, hn_dae_form form);

int hn_stepper_count(void);
const hn_stepper *hn_stepper_at(int i);
const hn_stepper *hn_stepper_find(const char *name);

#endif
