// SPDX-License-Identifier: GPL-3.0-or-later
// An engine: a formulation and an integrator put together, for either kind of pair: an ordinary differential equation and a
// stepper of it, or a differential-algebraic system and an integrator that takes it as it is (integrators/step/dae.h). What is
// different between the two is here; the rest of a run knows engines only.
#include "dynamics/compile/coordinates.h"
#include "study/run/run_internal.h"

#include "integrators/step/dae.h"

#include <string.h>

static const hn_dae_stepper *dae_of(const hn_run *run) {
    const hn_method_spec *spec = &run->spec;
    return hn_method_form(spec->formulation, spec->stepper) == HN_FORM_ODE ? NULL
                                                                           : spec->stepper->dae;
}

// y' of the state (q, v) from the saddle system: for a first step size only
static hn_status slope(void *self, double t, const double *y, double *ydot) {
    hn_run *run = self;
    const double *q = y, *v = y + run->info.nq;
    hn_system_kinematics(run->sys, q, v, ydot);
    return hn_run_accelerations(run, t, q, v, ydot + run->info.nq, run->at_lambda, NULL);
}

static hn_status create_dae(hn_run *run, hn_run_engine *e, hn_diag *diag) {
    e->ode = (hn_ode){.n_pos = run->info.nq, .n_vel = run->info.nv, .self = run, .rhs = slope};
    const hn_dae_form form = hn_method_form(run->spec.formulation, run->spec.stepper);
    return dae_of(run)->create(run->sys, form, run->spec.stepper_set, run->spec.formulation_set,
                               run->arena, &e->stepper, diag);
}

hn_status hn_engine_create(hn_run *run, hn_run_engine *e, hn_diag *diag) {
    const hn_formulation *f = run->spec.formulation;
    const size_t room = (size_t)(run->info.nq + run->info.nv);
    e->y = hn_arena_doubles(run->arena, room);
    e->y_new = hn_arena_doubles(run->arena, room);
    e->err = hn_arena_doubles(run->arena, room);
    if (hn_arena_failed(run->arena)) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    if (!hn_method_fits(f, run->spec.stepper)) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, NULL, "%s does not serve %s",
                           run->spec.stepper->name, f->name);
    }
    if (f->around_step && run->spec.stepper->advance) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "take midpoint or rk4",
                           "%s makes its step out of several of the integrator's, and %s chooses "
                           "its steps itself",
                           f->name, run->spec.stepper->name);
    }
    hn_status status = HN_OK;
    if (f->create && hn_method_form(f, run->spec.stepper) == f->form) {
        status = f->create(run->sys, run->spec.formulation_set, run->arena, &e->formulation, diag);
    }
    return status == HN_OK && dae_of(run) ? create_dae(run, e, diag) : status;
}

void hn_engine_destroy(hn_run *run, hn_run_engine *e) {
    const hn_dae_stepper *dae = dae_of(run);
    void (*destroy)(void *) = dae ? dae->destroy : run->spec.stepper->destroy;
    if (e->stepper && destroy) {
        destroy(e->stepper);
    }
    if (e->formulation && run->spec.formulation->destroy) {
        run->spec.formulation->destroy(e->formulation);
    }
}

static hn_status start_ode(hn_run *run, hn_run_engine *e, double t, const double *q,
                           const double *v) {
    const hn_formulation *f = run->spec.formulation;
    const hn_stepper *stepper = run->spec.stepper;
    const hn_status status = f->set_state(e->formulation, t, q, v, e->y);
    if (status != HN_OK) {
        return status;
    }
    f->ode(e->formulation, &e->ode);
    if (e->stepper) {
        stepper->on_accepted(e->stepper, 1);
        return HN_OK;
    }
    e->stepper = stepper->create(e->ode.n_pos, e->ode.n_vel, run->arena);
    if (e->stepper && stepper->configure) {
        stepper->configure(e->stepper, run->spec.stepper_set);
    }
    if (!e->stepper) {
        return HN_ERR_MEMORY;
    }
    return stepper->prepare ? stepper->prepare(e->stepper, &e->ode) : HN_OK;
}

hn_status hn_engine_start(hn_run *run, hn_run_engine *e, double t, const double *q,
                          const double *v) {
    const hn_dae_stepper *dae = dae_of(run);
    if (!dae) {
        return start_ode(run, e, t, q, v);
    }
    memcpy(e->y, q, (size_t)run->info.nq * sizeof *q);
    memcpy(e->y + run->info.nq, v, (size_t)run->info.nv * sizeof *v);
    return dae->start(e->stepper, t, e->y);
}

hn_status hn_engine_step(hn_run *run, hn_run_engine *e, double t, double h) {
    const hn_dae_stepper *dae = dae_of(run);
    const hn_stepper *stepper = run->spec.stepper;
    if (!dae && run->spec.formulation->around_step) {
        const hn_step_call call = {e->stepper, &e->ode, stepper->step, stepper->on_accepted};
        return run->spec.formulation->around_step(e->formulation, &call, t, h, e->y, e->y_new,
                                                  e->err);
    }
    return dae ? dae->step(e->stepper, t, h, e->y, e->y_new, e->err)
               : stepper->step(e->stepper, &e->ode, t, h, e->y, e->y_new, e->err);
}

int hn_engine_paces_itself(const hn_run *run) {
    const hn_dae_stepper *dae = dae_of(run);
    return dae ? dae->advance != NULL : run->spec.stepper->advance != NULL;
}

hn_status hn_engine_advance(hn_run *run, hn_run_engine *e, double t, double t_stop, double *t_new) {
    const hn_dae_stepper *dae = dae_of(run);
    return dae ? dae->advance(e->stepper, t, t_stop, e->y, t_new, e->y_new)
               : run->spec.stepper->advance(e->stepper, &e->ode, t, t_stop, e->y, t_new, e->y_new);
}

hn_status hn_engine_change_chart(hn_run *run, hn_run_engine *e, double t) {
    const hn_formulation *f = run->spec.formulation;
    if (dae_of(run) || !f->change_chart) {
        return HN_ERR_CHART;
    }
    const hn_status status = f->change_chart(e->formulation, t, e->y);
    if (status == HN_OK) {
        hn_engine_accepted(run, e, 1);
    }
    return status;
}

hn_status hn_engine_finish(hn_run *run, hn_run_engine *e) {
    const hn_stepper *stepper = run->spec.stepper;
    return dae_of(run) || !stepper->finish ? HN_OK : stepper->finish(e->stepper, &e->ode);
}

hn_status hn_engine_mend(hn_run *run, hn_run_engine *e, double t, double *y, int *changed) {
    const hn_formulation *f = run->spec.formulation;
    if (e->unmended) {
        e->unmended->t = t;
        const hn_status status = hn_engine_read(run, e, t, y, e->unmended->q, e->unmended->v);
        if (status != HN_OK) {
            return status;
        }
    }
    if (dae_of(run)) {
        *changed |= hn_system_normalise(run->sys, y);
        return HN_OK;
    }
    return f->after_step ? f->after_step(e->formulation, t, y, changed) : HN_OK;
}

void hn_engine_accepted(hn_run *run, hn_run_engine *e, int changed) {
    const hn_dae_stepper *dae = dae_of(run);
    if (dae) {
        dae->on_accepted(e->stepper, changed);
    } else {
        run->spec.stepper->on_accepted(e->stepper, changed);
    }
}

hn_status hn_engine_read(hn_run *run, hn_run_engine *e, double t, const double *y, double *q,
                         double *v) {
    if (!dae_of(run)) {
        return run->spec.formulation->get_state(e->formulation, t, y, q, v);
    }
    memcpy(q, y, (size_t)run->info.nq * sizeof *q);
    memcpy(v, y + run->info.nq, (size_t)run->info.nv * sizeof *v);
    return HN_OK;
}

int hn_engine_has_dense(const hn_run *run) {
    const hn_dae_stepper *dae = dae_of(run);
    const hn_formulation *f = run->spec.formulation;
    if (!dae && f->state_is_local && f->state_is_local(run->main.formulation)) {
        return 0;
    }
    return dae ? dae->dense != NULL : run->spec.stepper->dense != NULL;
}

void hn_engine_dense(hn_run *run, hn_run_engine *e, double theta, double *y) {
    const hn_dae_stepper *dae = dae_of(run);
    if (dae) {
        dae->dense(e->stepper, theta, y);
    } else {
        run->spec.stepper->dense(e->stepper, theta, y);
    }
}

int hn_engine_has_raw_lambda(const hn_run *run) {
    return dae_of(run) && dae_of(run)->raw_lambda;
}

const double *hn_engine_raw_lambda(const hn_run *run, const hn_run_engine *e) {
    return hn_engine_has_raw_lambda(run) ? dae_of(run)->raw_lambda(e->stepper) : NULL;
}

hn_cost hn_engine_cost(const hn_run *run, const hn_run_engine *e) {
    const hn_dae_stepper *dae = dae_of(run);
    hn_cost cost = {0};
    if (dae) {
        dae->add_cost(e->stepper, &cost);
        return cost;
    }
    run->spec.formulation->add_cost(e->formulation, &cost);
    if (e->stepper && run->spec.stepper->add_cost) {
        run->spec.stepper->add_cost(e->stepper, &cost);
    }
    return cost;
}

const char *hn_engine_why(const hn_run *run, const hn_run_engine *e) {
    const hn_dae_stepper *dae = dae_of(run);
    if (dae) {
        return e->stepper ? dae->why(e->stepper) : NULL;
    }
    const char *why = NULL;
    if (e->stepper && run->spec.stepper->why) {
        why = run->spec.stepper->why(e->stepper);
    }
    return why || !e->formulation ? why : run->spec.formulation->why(e->formulation);
}
