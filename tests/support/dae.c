// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/dae.h"

#include "support/near.h"
#include "support/odes.h"

#include "dynamics/evaluate/accel.h"
#include "formulations/list/formulation_list.h"
#include "integrators/list/stepper_list.h"
#include "integrators/method/method_spec.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_TEXT = 256 };

static void read_options(const char *text, const hn_option *table, int n, double *set) {
    char words[MAX_TEXT];
    for (int i = 0; i < HN_MAX_OPTIONS; i++) {
        set[i] = i < n ? table[i].initial : 0;
    }
    snprintf(words, sizeof words, "%s", text ? text : "");
    for (char *save = NULL, *word = strtok_r(words, " ", &save); word;
         word = strtok_r(NULL, " ", &save)) {
        char *equals = strchr(word, '=');
        int i = 0;
        assert_non_null(equals);
        *equals = '\0';
        while (i < n && strcmp(table[i].key, word) != 0) {
            i++;
        }
        assert_true(i < n);
        assert_int_equal(hn_option_parse(&table[i], equals + 1, &set[i], NULL), HN_OK);
    }
}

static void open_with(hn_test_dae *d, const hn_model *m, const hn_stepper *stepper,
                      hn_dae_form form, const double *form_set, const char *options) {
    double set[HN_MAX_OPTIONS];
    hn_diag diag = {0};
    const hn_accel_opts opts = {.want_lambda = 1};
    const size_t n = (size_t)(m->info.nq + m->info.nv);
    *d = (hn_test_dae){.model = m, .table = stepper->dae, .arena = hn_arena_create(0)};
    assert_true(stepper->forms & 1u << form);
    read_options(options, stepper->options, stepper->n_options, set);
    d->y = hn_arena_doubles(d->arena, n);
    d->y_new = hn_arena_doubles(d->arena, n);
    d->err = hn_arena_doubles(d->arena, n);
    d->a = hn_arena_doubles(d->arena, (size_t)m->info.nv);
    d->lambda = hn_arena_doubles(d->arena, (size_t)m->info.nc);
    assert_int_equal(hn_accel_create(m->sys, &opts, d->arena, &d->accel), HN_OK);
    assert_int_equal(hn_eval_create(m->sys,
                                    HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J | HN_TERM_ENERGY,
                                    d->arena, &d->terms),
                     HN_OK);
    memcpy(d->y, m->q, (size_t)m->info.nq * sizeof *d->y);
    memcpy(d->y + m->info.nq, m->v, (size_t)m->info.nv * sizeof *d->y);
    if (d->table->create(m->sys, form, set, form_set, d->arena, &d->self, &diag) != HN_OK) {
        fail_msg("%s: %s", stepper->name, diag.message);
    }
    const hn_status status = d->table->start(d->self, 0, d->y);
    if (status != HN_OK) {
        fail_msg("%s does not start: %s", stepper->name, d->table->why(d->self));
    }
}

void hn_test_dae_open(hn_test_dae *d, const hn_model *m, const hn_stepper *stepper,
                      hn_dae_form form, const char *options) {
    const double none[HN_MAX_OPTIONS] = {0};
    open_with(d, m, stepper, form, none, options);
}

void hn_test_dae_open_as(hn_test_dae *d, const hn_model *m, const hn_stepper *stepper,
                         const hn_formulation *formulation, const char *formulation_options,
                         const char *options) {
    double form_set[HN_MAX_OPTIONS];
    read_options(formulation_options, formulation->options, formulation->n_options, form_set);
    open_with(d, m, stepper, formulation->form, form_set, options);
}

void hn_test_dae_close(hn_test_dae *d) {
    d->table->destroy(d->self);
    hn_accel_free(d->accel);
    hn_eval_free(d->terms);
    hn_arena_free(d->arena);
}

hn_status hn_test_dae_steps(hn_test_dae *d, double h, long long n) {
    for (long long i = 0; i < n; i++) {
        const hn_status status =
            d->table->step(d->self, (double)d->steps * h, h, d->y, d->y_new, d->err);
        if (status != HN_OK) {
            return status;
        }
        d->table->on_accepted(d->self, 0);
        double *const y = d->y;
        d->y = d->y_new;
        d->y_new = y;
        d->steps++;
        d->t = (double)d->steps * h;
    }
    return HN_OK;
}

void hn_test_dae_measure(hn_test_dae *d) {
    const hn_system_info info = d->model->info;
    const double *q = d->y, *v = d->y + info.nq;
    assert_int_equal(hn_accel_eval(d->accel, d->t, q, v, 0, 0, d->a, d->lambda, NULL), HN_OK);
    hn_eval_run(d->terms, d->t, q, v);
    d->gap = hn_norm2(info.nc, hn_eval_get(d->terms, HN_TERM_PHI));
    double sum = 0;
    for (int i = 0; i < info.nc; i++) {
        const double rate =
            hn_dot(info.nv, hn_eval_get(d->terms, HN_TERM_J) + (size_t)i * info.nv, v) +
            hn_eval_get(d->terms, HN_TERM_PHI_T)[i];
        sum += rate * rate;
    }
    d->speed_gap = sqrt(sum);
    d->energy = hn_eval_get(d->terms, HN_TERM_ENERGY)[0] + hn_eval_get(d->terms, HN_TERM_ENERGY)[1];
}

// dop853 in fixed steps on the projected index-1 system: at this step its error is at rounding
void hn_test_reference(const hn_model *m, double T, hn_test_state *out) {
    const hn_formulation *f = hn_formulation_find("projection");
    const hn_stepper *s = hn_stepper_find("dop853");
    const int steps = (int)ceil(T * 400), n = m->info.nq + m->info.nv;
    const double none[HN_MAX_OPTIONS] = {0};
    const hn_accel_opts opts = {.want_lambda = 1};
    double y[64], y_new[64], err[64], a[32];
    hn_arena *arena = hn_arena_create(0);
    hn_accel *accel = NULL;
    void *self = NULL;
    hn_ode ode;
    int changed = 0;
    assert_true(n <= 64 && m->info.nv <= 32 && m->info.nc <= 32);
    assert_int_equal(f->create(m->sys, none, arena, &self, NULL), HN_OK);
    assert_int_equal(f->set_state(self, 0, m->q, m->v, y), HN_OK);
    f->ode(self, &ode);
    void *stepper = s->create(ode.n_pos, ode.n_vel, arena);
    for (int i = 0; i < steps; i++) {
        const double h = T / steps;
        assert_int_equal(s->step(stepper, &ode, i * h, h, y, y_new, err), HN_OK);
        assert_int_equal(f->after_step(self, (i + 1) * h, y_new, &changed), HN_OK);
        s->on_accepted(stepper, 1);
        memcpy(y, y_new, sizeof y);
    }
    memcpy(out->q, y, (size_t)m->info.nq * sizeof *y);
    memcpy(out->v, y + m->info.nq, (size_t)m->info.nv * sizeof *y);
    assert_int_equal(hn_accel_create(m->sys, &opts, arena, &accel), HN_OK);
    assert_int_equal(hn_accel_eval(accel, T, out->q, out->v, 0, 0, a, out->lambda, NULL), HN_OK);
    hn_accel_free(accel);
    f->destroy(self);
    hn_arena_free(arena);
}

static double distance(int n, const double *x, const double *y) {
    double most = 0;
    for (int i = 0; i < n; i++) {
        most = fmax(most, fabs(x[i] - y[i]));
    }
    return most;
}

hn_test_orders hn_test_dae_orders(const hn_model *m, const hn_stepper *stepper, hn_dae_form form,
                                  const char *options, double T, int base_steps, int n,
                                  const hn_test_state *exact) {
    hn_test_orders o = {0};
    double h[8];
    assert_true(n <= 8);
    for (int i = 0; i < n; i++) {
        hn_test_dae d;
        const int steps = base_steps << i;
        h[i] = T / steps;
        hn_test_dae_open(&d, m, stepper, form, options);
        if (hn_test_dae_steps(&d, h[i], steps) != HN_OK) {
            fail_msg("%s with h = %g: %s", stepper->name, h[i], d.table->why(d.self));
        }
        hn_test_dae_measure(&d);
        o.err_q[i] = distance(m->info.nq, d.y, exact->q);
        o.err_v[i] = distance(m->info.nv, d.y + m->info.nq, exact->v);
        o.err_lambda[i] = distance(m->info.nc, d.lambda, exact->lambda);
        o.worst_gap = fmax(o.worst_gap, d.gap);
        o.worst_speed_gap = fmax(o.worst_speed_gap, d.speed_gap);
        const double *raw = d.table->raw_lambda ? d.table->raw_lambda(d.self) : NULL;
        o.err_raw[i] = raw ? distance(m->info.nc, raw, exact->lambda) : 1;
        hn_test_dae_close(&d);
    }
    o.q = hn_test_slope(n, h, o.err_q);
    o.v = hn_test_slope(n, h, o.err_v);
    o.lambda = hn_test_slope(n, h, o.err_lambda);
    o.raw = hn_test_slope(n, h, o.err_raw);
    return o;
}
