#ifndef HN_FORMULATIONS_FORMULATION_H
#define HN_FORMULATIONS_FORMULATION_H
// A formulation: how the constraints enter. It turns a system into an ordinary differential equation y' = F(t, y) that
// any integrator can step, and may mend the state after a step. One file each, one row in the registry.
//
// y = (positions, speeds): n_pos entries, then n_vel. Which positions and speeds these are is the formulation's affair.

#include "base/arena.h"
#include "base/diag.h"
#include "dynamics/compile/system.h"

enum { HN_MAX_SETTINGS = 8 };

/// One setting of a formulation or an integrator, as in "alpha=20".
typedef struct hn_setting_info {
    const char *key;
    double initial, min, max; ///< NaN initial: required
    const char *unit, *about;
    const char *const *choices; ///< named values (0, 1, ...) or NULL; spelled by name
    int n_choices;
    int warn_below_zero; ///< allowed but told ("pushes the loop apart")
} hn_setting_info;

/// What a formulation did and met, summed over a run; plain counters, reset by the run.
typedef struct hn_cost {
    long long evals; ///< right-hand sides
    long long factorisations, solves, newton;
    double ops;            ///< arithmetic operations, tape plus linear algebra
    long long fallbacks;   ///< dense solves in place of the tape's
    long long refinements; ///< answers of the tape corrected because pivots were small
    long long projections;
    double energy_removed; ///< by projection [J]
    long long chart_changes;
    long long rejected; ///< trials that an integrator with a step control of its own turned down
} hn_cost;

/// Newton's systems of an implicit integrator by the structure of the equations, which dF/dy, a full matrix, does not show.
/// `self` is that of the hn_ode.
typedef struct hn_ode_newton {
    /// Takes derivatives at (t, y); fails as rhs does.
    hn_status (*at)(void *self, double t, const double *y);
    /// Factors s - dF/dy with s = (re, im); which = 0: real, 1: complex. Fails: HN_ERR_SINGULAR, HN_ERR_DIVERGED.
    hn_status (*factor)(void *self, int which, double re, double im);
    /// x (n_pos + n_vel, in 1 or 2 parts: real and imaginary) <- (s - dF/dy)^-1 x with that factor
    void (*solve)(void *self, int parts, double *const *x);
} hn_ode_newton;

typedef struct hn_ode {
    int n_pos, n_vel;
    void *self;
    /// y' at (t, y), (n_pos + n_vel). Fails as the formulation's card says; ydot is then undefined.
    hn_status (*rhs)(void *self, double t, const double *y, double *ydot);
    /// only the position part of y' (partitioned integrators call it with new speeds)
    hn_status (*kinematics)(void *self, double t, const double *y, double *pos_dot);
    /// dF/dy at (t, y), (n_pos + n_vel) square, row-major, for implicit integrators; fails as rhs does. NULL: by differences.
    /// Of a quaternion, whose length no motion changes, along turns.
    hn_status (*jacobian)(void *self, double t, const double *y, double *jac);
    const hn_ode_newton *newton; ///< NULL: not offered
    /// Takes the memory that these two need from the formulation's arena; done by their first call where it has not been. NULL: none.
    hn_status (*prepare)(void *self);
} hn_ode;

/// How a formulation hands the constraints over: as an ordinary differential equation (hn_ode), or to integrators that take the
/// differential-algebraic system in this form (integrators/step/dae.h); then `ode` and everything below it are NULL, and `create`,
/// which may be NULL too, only says whether the scene can be served.
typedef enum hn_dae_form {
    HN_FORM_ODE,
    HN_FORM_INDEX3,
    HN_FORM_INDEX2,
    HN_FORM_GGL,
    HN_FORM_INDEX1,
    HN_FORM_STABILISED, ///< INDEX1 with Baumgarte's terms; the formulation's settings are alpha, beta and the rule (0: as given)
    HN_FORM_AUGMENTED ///< INDEX3 by an augmented Lagrangian; the formulation's settings are weight (0: chosen) and projections (0: on, 1: off)
} hn_dae_form;

/// One step of the integrator, for a formulation that makes its step out of several of them.
typedef struct hn_step_call {
    void *stepper;
    const hn_ode *ode;
    hn_status (*step)(void *stepper, const hn_ode *ode, double t, double h, const double *y,
                      double *y_new, double *err);
    void (*accepted)(void *stepper, int changed);
} hn_step_call;
/// The step from (t, y), which need not be where the last one began.
static inline hn_status hn_step_call_make(const hn_step_call *call, double t, double h,
                                          const double *y, double *y_new, double *err) {
    call->accepted(call->stepper, 1); // slopes kept for a repeated trial belong to another y
    return call->step(call->stepper, call->ode, t, h, y, y_new, err);
}

/// What a formulation does and needs: bits of hn_formulation.traits. Remedies and studies choose by them, never by a name.
typedef enum hn_trait {
    HN_TRAIT_CLOSES_POSITION = 1 << 0,    ///< phi = 0 after each step, to rounding
    HN_TRAIT_CLOSES_VELOCITY = 1 << 1,    ///< J v + phi_t = 0 after each step, to rounding
    HN_TRAIT_PULLS_GAP = 1 << 2,          ///< feedback makes the gap decay at a rate that is set
    HN_TRAIT_NEEDS_MASS_INVERSE = 1 << 3, ///< whichever solver is chosen: fails where M is singular
    HN_TRAIT_ADDS_VIBRATIONS = 1 << 4,    ///< springs on the constraints: omega, xi are their rates
    HN_TRAIT_HAS_CHART = 1 << 5,          ///< integrates independent coordinates of a chart
    HN_TRAIT_FIXED_CHART = 1 << 6,        ///< the user chose the chart; none takes its place
    HN_TRAIT_HAS_BASIS = 1 << 7,          ///< velocities from a basis of the null space of J
    HN_TRAIT_COUNTER_EXAMPLE = 1 << 8     ///< wrong on purpose
} hn_trait;

typedef struct hn_formulation {
    const char *name;       ///< as spelled: "baumgarte"
    const char *title;      ///< "Baumgarte stabilisation"
    const char *short_name; ///< at most 14 characters, for tables and legends
    const char *rule;       ///< the one idea in at most 35 words
    const char *drift;      ///< what happens to the gap, in words
    const char *when, *when_not, *source;
    const char *needs; ///< "M f J gamma"
    const char
        *order_note;    ///< orders of q, v and lambda where they are not the integrator's, or NULL
    const char *limits; ///< what it cannot serve, or NULL
    hn_dae_form form;
    hn_dae_form
        also; ///< the form for integrators that do not serve `form` (index1: as ODE, or with lambda); HN_FORM_ODE: none
    int index; ///< differential index of the equations that are handed over; 0: no multipliers in them
    int model_error; ///< 1: converges to something else, on purpose
    unsigned traits; ///< hn_trait bits: what others choose formulations by
    int n_settings;
    hn_setting_info settings[HN_MAX_SETTINGS];

    /// Makes an instance (from `arena`; what is not from the arena is freed by destroy). `settings` in table order.
    /// Refuses a scene it cannot serve with a reason in diag (HN_ERR_UNSUPPORTED).
    hn_status (*create)(const hn_system *sys, const double *settings, hn_arena *arena, void **self,
                        hn_diag *diag);
    void (*destroy)(void *self);
    /// Sizes and functions; known once set_state has succeeded, because they may depend on the rank of J.
    void (*ode)(void *self, hn_ode *out);
    /// (q, v) -> y, and back; q (nq), v (nv) in system coordinates, y with room for nq + nv. set_state may choose a chart and
    /// forgets everything met before; get_state changes nothing that a later right-hand side could see.
    hn_status (*set_state)(void *self, double t, const double *q, const double *v, double *y);
    hn_status (*get_state)(void *self, double t, const double *y, double *q, double *v);
    /// Makes a step by means of the integrator's own (symmetric projection). NULL: the integrator's step is the step.
    hn_status (*around_step)(void *self, const hn_step_call *base, double t, double h,
                             const double *y, double *y_new, double *err);
    /// Mends y in place at the end of an accepted step. *changed = 1 if y moved or its meaning changed (FSAL, history and
    /// dense output are then stale). NULL: nothing to do.
    hn_status (*after_step)(void *self, double t, double *y, int *changed);
    /// 1: y means something else after each step, so that the dense output of the last one cannot be read. NULL: 0.
    int (*state_is_local)(const void *self);
    /// Changes a setting while running (sliders); NULL: not possible.
    hn_status (*set)(void *self, int setting, double value);
    void (*add_cost)(const void *self, hn_cost *cost); ///< adds its counters
    const char *(*why)(const void *self); ///< the reason of the last failure in words, or NULL
} hn_formulation;

/// "ode", "index3", "index2", "ggl", "index1", "stabilised".
const char *hn_form_name(hn_dae_form form);
enum { HN_FORM_COUNT = HN_FORM_AUGMENTED + 1 };

int hn_formulation_count(void);
const hn_formulation *hn_formulation_at(int i);
const hn_formulation *hn_formulation_find(const char *name); ///< NULL when unknown
/// Returns the first formulation of the registry that has all traits in `have` and none in `lack`; NULL: there is none.
const hn_formulation *hn_formulation_with(unsigned have, unsigned lack);

#endif
