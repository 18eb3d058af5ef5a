// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stepping/engine.h"

#include "dynamics/compile/coordinates.h"
#include "integrators/step/control.h"
#include "integrators/step/dae.h"

#include <string.h>

/// The differences between the two kinds of pair. A NULL in `dense` or `raw_lambda` of the
/// integrator is asked for by the has_ functions, so the entries here are never called without it.
struct hn_engine_kind {
    hn_status (*create)(hn_engine *e, hn_diag *diag);
    void (*destroy)(hn_engine *e);
    hn_status (*start)(hn_engine *e, double t, const double *q, const double *v);
    hn_status (*step)(hn_engine *e, double t, double h);
    hn_status (*advance)(hn_engine *e, double t, double t_stop, double *t_new);
    hn_status (*change_chart)(hn_engine *e, double t);
    hn_status (*finish)(hn_engine *e);
    hn_status (*correct)(hn_engine *e, double t, double *y, int *changed);
    void (*accepted)(hn_engine *e, int changed);
    hn_status (*read)(hn_engine *e, double t, const double *y, double *q, double *v);
    bool (*has_dense)(const hn_engine *e);
    void (*dense)(hn_engine *e, double theta, double *y);
    void (*add_cost)(const hn_engine *e, hn_cost *cost);
    const char *(*why)(const hn_engine *e);
};

// ---- ordinary differential equation and a stepper of it ----

static hn_status ode_create(hn_engine *e, hn_diag *diag) {
    const hn_formulation *f = e->spec->formulation;
    HN_TRY(f->create(e->sys, e->spec->formulation_set, e->arena, &e->formulation, diag));
    return f->check ? f->check(e->formulation, e->spec->stepper->name, diag) : HN_OK;
}

static void ode_destroy(hn_engine *e) {
    if (e->stepper && e->spec->stepper->destroy) {
        e->spec->stepper->destroy(e->stepper);
    }
    if (e->formulation && e->spec->formulation->destroy) {
        e->spec->formulation->destroy(e->formulation);
    }
}

/// Gives the equation the units of a tolerance that the user did not choose. A chart or a basis has
/// coordinates of its own, which keep plain numbers.
static void use_units(hn_engine *e, const double *v) {
    const unsigned local = HN_TRAIT_HAS_CHART | HN_TRAIT_HAS_BASIS;
    const bool whole = e->ode.n_pos == e->info.nq && e->ode.n_vel == e->info.nv &&
                       !(e->spec->formulation->traits & local);
    const bool chosen = hn_method_option(e->spec, "atol", 0) > 0;
    e->ode.unit = NULL;
    if (whole && !chosen) {
        hn_tolerance_units(e->sys, false, v, e->unit);
        e->ode.unit = e->unit;
    }
}

static hn_status ode_start(hn_engine *e, double t, const double *q, const double *v) {
    const hn_formulation *f = e->spec->formulation;
    const hn_stepper *stepper = e->spec->stepper;
    HN_TRY(f->set_state(e->formulation, t, q, v, e->y));
    f->ode(e->formulation, &e->ode);
    use_units(e, v);
    if (e->stepper) {
        stepper->on_accepted(e->stepper, 1);
        return HN_OK;
    }

    // first start: the size of the stepper depends on the state
    e->stepper = stepper->create(e->ode.n_pos, e->ode.n_vel, e->arena);
    if (!e->stepper) {
        return HN_ERR_MEMORY;
    }
    if (stepper->configure) {
        stepper->configure(e->stepper, e->spec->stepper_set);
    }
    return stepper->prepare ? stepper->prepare(e->stepper, &e->ode) : HN_OK;
}

static hn_status ode_step(hn_engine *e, double t, double h) {
    const hn_stepper *stepper = e->spec->stepper;
    const hn_formulation *f = e->spec->formulation;
    if (f->around_step) {
        const hn_step_call call = {e->stepper, &e->ode, stepper->step, stepper->on_accepted};
        return f->around_step(e->formulation, &call, t, h, e->y, e->y_new, e->err);
    }
    return stepper->step(e->stepper, &e->ode, t, h, e->y, e->y_new, e->err);
}

static hn_status ode_advance(hn_engine *e, double t, double t_stop, double *t_new) {
    return e->spec->stepper->advance(e->stepper, &e->ode, t, t_stop, e->y, t_new, e->y_new);
}

static hn_status ode_change_chart(hn_engine *e, double t) {
    const hn_formulation *f = e->spec->formulation;
    if (!f->change_chart) {
        return HN_ERR_CHART;
    }
    HN_TRY(f->change_chart(e->formulation, t, e->y));
    e->spec->stepper->on_accepted(e->stepper, 1);
    return HN_OK;
}

static hn_status ode_finish(hn_engine *e) {
    const hn_stepper *stepper = e->spec->stepper;
    return stepper->finish ? stepper->finish(e->stepper, &e->ode) : HN_OK;
}

static hn_status ode_correct(hn_engine *e, double t, double *y, int *changed) {
    const hn_formulation *f = e->spec->formulation;
    return f->after_step ? f->after_step(e->formulation, t, y, changed) : HN_OK;
}

static void ode_accepted(hn_engine *e, int changed) {
    e->spec->stepper->on_accepted(e->stepper, changed);
}

static hn_status ode_read(hn_engine *e, double t, const double *y, double *q, double *v) {
    return e->spec->formulation->get_state(e->formulation, t, y, q, v);
}

static bool ode_has_dense(const hn_engine *e) {
    const hn_formulation *f = e->spec->formulation;
    const bool local = f->state_is_local && f->state_is_local(e->formulation);
    return !local && e->spec->stepper->dense;
}

static void ode_dense(hn_engine *e, double theta, double *y) {
    e->spec->stepper->dense(e->stepper, theta, y);
}

static void ode_add_cost(const hn_engine *e, hn_cost *cost) {
    e->spec->formulation->add_cost(e->formulation, cost);
    if (e->stepper && e->spec->stepper->add_cost) {
        e->spec->stepper->add_cost(e->stepper, cost);
    }
}

static const char *ode_why(const hn_engine *e) {
    if (hn_engine_stepper_says_why(e)) {
        return e->spec->stepper->why(e->stepper);
    }
    return e->formulation ? e->spec->formulation->why(e->formulation) : NULL;
}

static const hn_engine_kind ODE = {
    .create = ode_create,
    .destroy = ode_destroy,
    .start = ode_start,
    .step = ode_step,
    .advance = ode_advance,
    .change_chart = ode_change_chart,
    .finish = ode_finish,
    .correct = ode_correct,
    .accepted = ode_accepted,
    .read = ode_read,
    .has_dense = ode_has_dense,
    .dense = ode_dense,
    .add_cost = ode_add_cost,
    .why = ode_why,
};

// ---- differential-algebraic system and an integrator that takes it ----

static const hn_dae_stepper *dae_of(const hn_engine *e) {
    return e->spec->stepper->dae;
}

/// y' of the state (q, v) from the saddle system: for a first step size only.
static hn_status slope(void *self, double t, const double *y, double *ydot) {
    hn_engine *e = self;
    const double *q = y, *v = y + e->info.nq;
    hn_system_kinematics(e->sys, q, v, ydot);
    return hn_accel_eval(e->accel, t, q, v, 0, 0, ydot + e->info.nq, e->lambda, NULL);
}

static hn_status dae_create(hn_engine *e, hn_diag *diag) {
    const hn_formulation *f = e->spec->formulation;
    const hn_dae_form form = hn_method_form(f, e->spec->stepper);
    // a formulation of this form may refuse the scene, and makes nothing else
    if (f->create && form == f->form) {
        HN_TRY(f->create(e->sys, e->spec->formulation_set, e->arena, &e->formulation, diag));
    }
    e->ode = (hn_ode){.n_pos = e->info.nq,
                      .n_vel = e->info.nv,
                      .self = e,
                      .rhs = slope,
                      .is_angle = hn_system_angles(e->sys)};
    return dae_of(e)->create(e->sys, form, e->spec->stepper_set, e->spec->formulation_set, e->arena,
                             &e->stepper, diag);
}

static void dae_destroy(hn_engine *e) {
    if (e->stepper && dae_of(e)->destroy) {
        dae_of(e)->destroy(e->stepper);
    }
    if (e->formulation && e->spec->formulation->destroy) {
        e->spec->formulation->destroy(e->formulation);
    }
}

static hn_status dae_start(hn_engine *e, double t, const double *q, const double *v) {
    memcpy(e->y, q, (size_t)e->info.nq * sizeof *q);
    memcpy(e->y + e->info.nq, v, (size_t)e->info.nv * sizeof *v);
    use_units(e, v);
    return dae_of(e)->start(e->stepper, t, e->y);
}

static hn_status dae_step(hn_engine *e, double t, double h) {
    return dae_of(e)->step(e->stepper, t, h, e->y, e->y_new, e->err);
}

static hn_status dae_advance(hn_engine *e, double t, double t_stop, double *t_new) {
    return dae_of(e)->advance(e->stepper, t, t_stop, e->y, t_new, e->y_new);
}

static hn_status dae_change_chart(hn_engine *e, double t) {
    (void)e;
    (void)t;
    return HN_ERR_CHART;
}

static hn_status dae_finish(hn_engine *e) {
    (void)e;
    return HN_OK;
}

static hn_status dae_correct(hn_engine *e, double t, double *y, int *changed) {
    (void)t;
    *changed |= hn_system_normalise(e->sys, y);
    return HN_OK;
}

static void dae_accepted(hn_engine *e, int changed) {
    dae_of(e)->on_accepted(e->stepper, changed);
}

static hn_status dae_read(hn_engine *e, double t, const double *y, double *q, double *v) {
    (void)t;
    memcpy(q, y, (size_t)e->info.nq * sizeof *q);
    memcpy(v, y + e->info.nq, (size_t)e->info.nv * sizeof *v);
    return HN_OK;
}

static bool dae_has_dense(const hn_engine *e) {
    return dae_of(e)->dense;
}

static void dae_dense(hn_engine *e, double theta, double *y) {
    dae_of(e)->dense(e->stepper, theta, y);
}

static void dae_add_cost(const hn_engine *e, hn_cost *cost) {
    dae_of(e)->add_cost(e->stepper, cost);
}

static const char *dae_why(const hn_engine *e) {
    return e->stepper ? dae_of(e)->why(e->stepper) : NULL;
}

static const hn_engine_kind DAE = {
    .create = dae_create,
    .destroy = dae_destroy,
    .start = dae_start,
    .step = dae_step,
    .advance = dae_advance,
    .change_chart = dae_change_chart,
    .finish = dae_finish,
    .correct = dae_correct,
    .accepted = dae_accepted,
    .read = dae_read,
    .has_dense = dae_has_dense,
    .dense = dae_dense,
    .add_cost = dae_add_cost,
    .why = dae_why,
};

// ---- either ----

static bool is_ode(const hn_method_spec *spec) {
    return hn_method_form(spec->formulation, spec->stepper) == HN_FORM_ODE;
}

hn_status hn_engine_create(const hn_system *sys, const hn_method_spec *spec, hn_accel *accel,
                           hn_arena *arena, hn_engine *e, hn_diag *diag) {
    const hn_formulation *f = spec->formulation;
    const hn_system_info info = hn_system_get_info(sys);
    const size_t room = (size_t)(info.nq + info.nv);
    *e = (hn_engine){.sys = sys, .spec = spec, .info = info, .arena = arena, .accel = accel};
    e->kind = is_ode(spec) ? &ODE : &DAE;
    e->y = hn_arena_doubles(arena, room);
    e->y_new = hn_arena_doubles(arena, room);
    e->err = hn_arena_doubles(arena, room);
    e->lambda = hn_arena_doubles(arena, (size_t)info.nc);
    e->unit = hn_arena_doubles(arena, room);
    if (hn_arena_failed(arena)) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }

    // formulation and integrator of different kinds
    if (!hn_method_fits(f, spec->stepper)) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, NULL, "%s cannot be used with %s",
                           spec->stepper->name, f->name);
    }
    if (f->around_step && spec->stepper->advance) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "take midpoint or rk4",
                           "%s builds each step from several steps of the integrator, but %s "
                           "chooses its own steps",
                           f->name, spec->stepper->name);
    }
    return e->kind->create(e, diag);
}

void hn_engine_destroy(hn_engine *e) {
    if (e->kind) {
        e->kind->destroy(e);
    }
}

hn_status hn_engine_start(hn_engine *e, double t, const double *q, const double *v) {
    return e->kind->start(e, t, q, v);
}

hn_status hn_engine_step(hn_engine *e, double t, double h) {
    return e->kind->step(e, t, h);
}

bool hn_engine_paces_itself(const hn_method_spec *spec) {
    const hn_dae_stepper *dae = is_ode(spec) ? NULL : spec->stepper->dae;
    return dae ? dae->advance != NULL : spec->stepper->advance != NULL;
}

hn_status hn_engine_advance(hn_engine *e, double t, double t_stop, double *t_new) {
    return e->kind->advance(e, t, t_stop, t_new);
}

hn_status hn_engine_change_chart(hn_engine *e, double t) {
    return e->kind->change_chart(e, t);
}

hn_status hn_engine_finish(hn_engine *e) {
    return e->kind->finish(e);
}

hn_status hn_engine_correct(hn_engine *e, double t, double *y, int *changed) {
    if (e->uncorrected) {
        e->uncorrected->t = t;
        HN_TRY(hn_engine_read(e, t, y, e->uncorrected->q, e->uncorrected->v));
    }
    return e->kind->correct(e, t, y, changed);
}

void hn_engine_accepted(hn_engine *e, int changed) {
    e->kind->accepted(e, changed);
}

hn_status hn_engine_read(hn_engine *e, double t, const double *y, double *q, double *v) {
    return e->kind->read(e, t, y, q, v);
}

bool hn_engine_has_chart(const hn_engine *e) {
    return (e->spec->formulation->traits & (HN_TRAIT_HAS_CHART | HN_TRAIT_HAS_BASIS)) != 0;
}

bool hn_engine_has_dense(const hn_engine *e) {
    return e->kind->has_dense(e);
}

void hn_engine_dense(hn_engine *e, double theta, double *y) {
    e->kind->dense(e, theta, y);
}

bool hn_engine_has_raw_lambda(const hn_engine *e) {
    return e->kind == &DAE && dae_of(e)->raw_lambda;
}

const double *hn_engine_raw_lambda(const hn_engine *e) {
    return hn_engine_has_raw_lambda(e) ? dae_of(e)->raw_lambda(e->stepper) : NULL;
}

hn_cost hn_engine_cost(const hn_engine *e) {
    hn_cost cost = {0};
    e->kind->add_cost(e, &cost);
    return cost;
}

long long hn_engine_fallbacks(const hn_engine *e) {
    const hn_formulation *f = e->spec->formulation;
    return e->kind == &ODE && f->fallbacks ? f->fallbacks(e->formulation) : -1;
}

const char *hn_engine_why(const hn_engine *e) {
    return e->kind->why(e);
}

bool hn_engine_stepper_says_why(const hn_engine *e) {
    const hn_stepper *stepper = e->spec->stepper;
    return e->kind == &ODE && e->stepper && stepper->why && stepper->why(e->stepper);
}
