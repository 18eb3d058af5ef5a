// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_ENGINE_H
#define HN_STUDY_ENGINE_H
// An engine: a formulation and an integrator put together. There are two kinds of pair, an ordinary
// differential equation with a stepper of it, and a differential-algebraic system with an
// integrator that takes it as it is (integrators/step/dae.h). The difference between the two is a
// table of functions in engine.c; all other code knows engines only.

#include "dynamics/evaluate/accel.h"
#include "integrators/method/method_spec.h"

#include <stdbool.h>

/// A state in system coordinates.
typedef struct hn_state_at {
    double t;
    double *q, *v; ///< nq, nv
} hn_state_at;

typedef struct hn_engine_kind hn_engine_kind;

typedef struct hn_engine {
    const hn_engine_kind *kind;
    const hn_system *sys;
    const hn_method_spec *spec;
    hn_system_info info;
    hn_arena *arena;
    void *formulation, *stepper; ///< stepper: of an hn_stepper or an hn_dae_stepper
    hn_ode ode;              ///< of a differential-algebraic pair: y' for a first step size only
    double *y, *y_new, *err; ///< nq + nv each
    hn_accel *accel;         ///< borrowed; for that first step size
    double *lambda;          ///< nc, scratch beside it
    double *unit;            ///< nq + nv, see hn_ode.unit
    /// Receives the state at the end of a step before it is corrected; NULL: nobody asks.
    hn_state_at *uncorrected;
} hn_engine;

/// Makes an engine; memory from `arena`. `sys`, `spec`, `accel` are borrowed.
/// Fails: HN_ERR_UNSUPPORTED with the reason in diag, HN_ERR_MEMORY. hn_engine_destroy is legal
/// after a failure.
HN_MUST_CHECK hn_status hn_engine_create(const hn_system *sys, const hn_method_spec *spec,
                                         hn_accel *accel, hn_arena *arena, hn_engine *e,
                                         hn_diag *diag);
void hn_engine_destroy(hn_engine *e);
/// Begins at a state and forgets everything before. The first call makes the stepper of an ordinary
/// differential equation, whose size may depend on the state.
HN_MUST_CHECK hn_status hn_engine_start(hn_engine *e, double t, const double *q, const double *v);
/// A trial from e->y to e->y_new, its error in e->err.
HN_MUST_CHECK hn_status hn_engine_step(hn_engine *e, double t, double h);
/// Says whether the integrator chooses the size of its steps itself: then `advance` takes the place
/// of `step`.
bool hn_engine_paces_itself(const hn_method_spec *spec);
HN_MUST_CHECK hn_status hn_engine_advance(hn_engine *e, double t, double t_stop, double *t_new);
/// Goes on in another chart from the accepted state, see hn_formulation.change_chart. Fails:
/// HN_ERR_CHART where there is none.
HN_MUST_CHECK hn_status hn_engine_change_chart(hn_engine *e, double t);
/// Evaluates what only dense output needs.
HN_MUST_CHECK hn_status hn_engine_finish(hn_engine *e);
/// Applies the formulation's correction (a projection, unit quaternions) to y at the end of a step;
/// *changed is set to 1 when y moved.
HN_MUST_CHECK hn_status hn_engine_correct(hn_engine *e, double t, double *y, int *changed);
/// The trial became the state; `changed` 1: y_new was changed since.
void hn_engine_accepted(hn_engine *e, int changed);
/// y -> (q, v).
HN_MUST_CHECK hn_status hn_engine_read(hn_engine *e, double t, const double *y, double *q,
                                       double *v);
/// Says whether its state is one of a chart or a basis, which may change on the way: then reading a
/// state may cost something, too.
bool hn_engine_has_chart(const hn_engine *e);
bool hn_engine_has_dense(const hn_engine *e);
/// y at the share theta of the step accepted last.
void hn_engine_dense(hn_engine *e, double theta, double *y);
bool hn_engine_has_raw_lambda(const hn_engine *e);
/// The scheme's own multipliers at the end of its last accepted step; NULL: none.
const double *hn_engine_raw_lambda(const hn_engine *e);
hn_cost hn_engine_cost(const hn_engine *e);
/// Why the last call failed, in words; NULL: nothing beyond the status.
/// The counter of fallbacks alone, cheap to ask after every step; -1 where only hn_engine_cost()
/// tells, or charts may change as well.
long long hn_engine_fallbacks(const hn_engine *e);
const char *hn_engine_why(const hn_engine *e);
/// Says whether the integrator, not the formulation, gives the reason of the last failure.
bool hn_engine_stepper_says_why(const hn_engine *e);

#endif
