// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_FORMULATION_H
#define HN_FORMULATIONS_FORMULATION_H
// A formulation states how the constraints enter the equations of motion. Most formulations turn a
// system into an ordinary differential equation (ode.h), which every integrator can solve, and may
// correct the state after a step. The others pass the differential-algebraic system on, to the
// integrators that solve one. A formulation is one file in formulations/rows and one line in
// formulations/list.

#include "base/arena.h"
#include "base/diag.h"
#include "dynamics/compile/system.h"
#include "formulations/ground/cost.h"
#include "formulations/ground/ode.h"
#include "formulations/ground/option.h"

/// The equations that a formulation passes to the integrator: an ordinary differential equation
/// (hn_ode), or a differential-algebraic system of one of these forms (integrators/step/dae.h).
/// With a differential-algebraic form `ode` and all members below it are NULL, and `create`, which
/// may be NULL too, only says whether the scene can be served.
typedef enum hn_dae_form {
    HN_FORM_ODE,
    HN_FORM_INDEX3,
    HN_FORM_INDEX2,
    HN_FORM_GGL,
    HN_FORM_INDEX1,
    HN_FORM_STABILISED, ///< INDEX1 with Baumgarte's terms
    HN_FORM_AUGMENTED,  ///< INDEX3 by an augmented Lagrangian
    HN_FORM_COUNT
} hn_dae_form;

/// Options of the formulations of these forms, in table order, as integrators receive them.
enum { HN_INDEX2_CLOSE, HN_INDEX2_OPTIONS };
enum { HN_INDEX3_PROJECT, HN_INDEX3_OPTIONS };
enum {
    HN_STABILISED_ALPHA,
    HN_STABILISED_BETA,
    HN_STABILISED_RULE,
    HN_STABILISED_SOLVER,
    HN_STABILISED_OPTIONS
};
enum { HN_AUGMENTED_WEIGHT, HN_AUGMENTED_PROJECTIONS, HN_AUGMENTED_OPTIONS };
/// Values of HN_STABILISED_RULE and HN_AUGMENTED_PROJECTIONS.
enum { HN_BAUMGARTE_GIVEN, HN_BAUMGARTE_AUTO };
enum { HN_PROJECTIONS_ON, HN_PROJECTIONS_OFF };

/// Traits of a formulation, its effects and its needs: bits of hn_formulation.traits. Remedies and
/// studies choose by them, never by a name.
typedef enum hn_trait {
    HN_TRAIT_CLOSES_POSITION = 1 << 0,    ///< phi = 0 after each step, to rounding
    HN_TRAIT_CLOSES_VELOCITY = 1 << 1,    ///< J v + phi_t = 0 after each step, to rounding
    HN_TRAIT_PULLS_GAP = 1 << 2,          ///< feedback makes the gap decay at a rate that is set
    HN_TRAIT_NEEDS_MASS_INVERSE = 1 << 3, ///< whichever solver is chosen: fails where M is singular
    HN_TRAIT_ADDS_VIBRATIONS = 1 << 4,    ///< springs on the constraints: omega, xi
    HN_TRAIT_HAS_CHART = 1 << 5,          ///< integrates independent coordinates of a chart
    HN_TRAIT_FIXED_CHART = 1 << 6,        ///< the user chose the chart; none takes its place
    HN_TRAIT_HAS_BASIS = 1 << 7,          ///< velocities from a basis of the null space of J
    HN_TRAIT_COUNTER_EXAMPLE = 1 << 8     ///< wrong on purpose
} hn_trait;

struct hn_accel_opts;

typedef struct hn_formulation {
    const char *name;       ///< as spelled: "baumgarte"
    const char *title;      ///< "Baumgarte stabilisation"
    const char *short_name; ///< at most 14 characters, for tables and legends
    const char *rule;       ///< the idea in at most 35 words
    const char *drift;      ///< what happens to the gap, in words
    const char *when, *when_not, *source;
    const char *needs; ///< terms of the system that it evaluates: "M f J gamma"
    /// orders of q, v and lambda where they differ from the integrator's, or NULL
    const char *order_note;
    const char *limits; ///< mechanisms that it refuses, or NULL
    hn_dae_form form;
    /// The form for integrators that do not serve `form` (index1: as ODE, or with lambda);
    /// HN_FORM_ODE: none.
    hn_dae_form alternative_form;
    int index;        ///< differential index of the equations passed on; 0: no multipliers in them
    bool model_error; ///< converges to a different solution, on purpose
    unsigned traits;  ///< hn_trait bits: what others choose formulations by
    int n_options;
    hn_option options[HN_MAX_OPTIONS];

    /// Makes an instance from `arena`; destroy frees what is not from the arena. `options` in table
    /// order. Fails: HN_ERR_UNSUPPORTED with the reason in diag for a scene that it cannot serve;
    /// HN_ERR_MEMORY; HN_ERR_LIMIT.
    hn_status (*create)(const hn_system *sys, const double *options, hn_arena *arena, void **self,
                        hn_diag *diag);
    void (*destroy)(void *self);
    /// Returns sizes and functions; known once set_state has succeeded, because they may depend on
    /// the rank of J.
    void (*ode)(void *self, hn_ode *out);
    /// Converts (q, v) to y and back; q (nq), v (nv) in system coordinates, y with room for nq +
    /// nv. set_state may choose a chart and forgets the past; get_state changes nothing that a
    /// later right-hand side could see.
    hn_status (*set_state)(void *self, double t, const double *q, const double *v, double *y);
    hn_status (*get_state)(void *self, double t, const double *y, double *q, double *v);
    /// Makes a step out of several steps of the integrator (symmetric projection). NULL: the
    /// integrator's step is the step.
    hn_status (*around_step)(void *self, const hn_step_call *base, double t, double h,
                             const double *y, double *y_new, double *err);
    /// Corrects y in place at the end of an accepted step. *changed = 1 if y moved or its meaning
    /// changed: FSAL slopes, history and dense output are then stale. NULL: nothing to do.
    hn_status (*after_step)(void *self, double t, double *y, int *changed);
    /// Goes on in another chart from the accepted state y, after a step from it failed with
    /// HN_ERR_CHART; the step is then tried again. Fails: HN_ERR_CHART where the present chart is
    /// the best one. NULL: there is no other chart.
    hn_status (*change_chart)(void *self, double t, double *y);
    /// Whether y has a new meaning after each step, so that the dense output of the last step
    /// cannot be read. NULL: no.
    int (*state_is_local)(const void *self);
    /// Changes an option while running (sliders). NULL: not possible.
    hn_status (*set)(void *self, int option, double value);
    /// If y = (q, v), v' are the accelerations of the system and nothing is kept from one step
    /// to the next, so that many runs can step side by side: the options of the solver, and alpha
    /// and beta [1/s]. NULL, or false: not so.
    bool (*lanes)(const double *options, struct hn_accel_opts *accel, double *alpha, double *beta);
    void (*add_cost)(const void *self, hn_cost *cost); ///< adds its counters
    /// Returns the counter of fallbacks alone, for whoever asks after every step; only of a
    /// formulation without charts. NULL: add_cost tells.
    long long (*fallbacks)(const void *self);
    const char *(*why)(const void *self); ///< reason of the last failure in words, or NULL
    /// Whether the integrator of this name can be used with it: HN_ERR_INPUT with the reason in
    /// `diag` where not. NULL: every one of its form.
    hn_status (*check)(const void *self, const char *integrator, hn_diag *diag);
} hn_formulation;

/// Returns the name of a form as the API spells it: "ode", "index3", "index2", "ggl", "index1",
/// "stabilised", "augmented".
const char *hn_form_name(hn_dae_form form);

#endif
