// SPDX-License-Identifier: GPL-3.0-or-later
// Index 3 with speeds projected at the end of each step: what collocation loses of them comes back.
#include "formulations/list/formulation_list.h"
#include "integrators/list/stepper_list.h"
#include "integrators/method/method_spec.h"
#include "support/dae.h"
#include "support/near.h"
#include "support/odes.h"

#include <math.h>
#include <string.h>

#define T_END 1.0
enum { RUNS = 4, BASE_STEPS = 20 };

typedef struct slopes {
    double q, v, lambda, gap, speed_gap;
} slopes;

static double distance(int n, const double *x, const double *y) {
    double most = 0;
    for (int i = 0; i < n; i++) {
        most = fmax(most, fabs(x[i] - y[i]));
    }
    return most;
}

static slopes measure(const hn_model *m, const hn_test_state *exact, const char *options) {
    double h[RUNS], q[RUNS], v[RUNS], lambda[RUNS];
    slopes out = {0};
    for (int i = 0; i < RUNS; i++) {
        hn_test_dae d;
        const int steps = BASE_STEPS << i;
        h[i] = T_END / steps;
        hn_test_dae_open_as(&d, m, hn_stepper_find("radau5"), hn_formulation_find("index3"),
                            options, "h=1");
        assert_int_equal(hn_test_dae_steps(&d, h[i], steps), HN_OK);
        hn_test_dae_measure(&d);
        q[i] = distance(m->info.nq, d.y, exact->q);
        v[i] = distance(m->info.nv, d.y + m->info.nq, exact->v);
        lambda[i] = distance(m->info.nc, d.lambda, exact->lambda);
        out.gap = fmax(out.gap, d.gap);
        out.speed_gap = fmax(out.speed_gap, d.speed_gap);
        hn_test_dae_close(&d);
    }
    out.q = hn_test_slope(RUNS, h, q);
    out.v = hn_test_slope(RUNS, h, v);
    out.lambda = hn_test_slope(RUNS, h, lambda);
    return out;
}

// Hairer, Lubich & Roche 1989 for the first; the steps are not yet so small that the slopes are
// whole numbers
static void
radau5_has_order_five_throughout_when_speeds_are_projected_and_three_else(void **state) {
    (void)state;
    const double near = 0.3;
    hn_model m;
    hn_test_state exact;
    hn_model_open_closed(&m, "fb0", NULL);
    hn_test_reference(&m, T_END, &exact);
    const slopes plain = measure(&m, &exact, "project=no");
    const slopes projected = measure(&m, &exact, "project=yes");
    assert_near(plain.q, 5, near);
    assert_near(plain.v, 3, near);
    assert_near(plain.lambda, 3, near);
    assert_near(projected.q, 5, near);
    assert_near(projected.v, 5, near);
    assert_near(projected.lambda, 5, near);
    assert_true(projected.gap < 1e-14);
    assert_true(projected.speed_gap < 1e-13);
    assert_true(plain.speed_gap > 1e-7);
    hn_model_close(&m);
}

static void integrators_that_do_not_project_refuse_to_be_asked(void **state) {
    (void)state;
    static const char *const others[] = {"genalpha", "hht", "rattle", "trapezoidal", "ida"};
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        const hn_stepper *stepper = hn_stepper_find(others[k]);
        const double form_options[HN_MAX_OPTIONS] = {1};
        double options[HN_MAX_OPTIONS] = {0};
        hn_diag diag = {0};
        void *self = NULL;
        for (int i = 0; i < stepper->n_options; i++) {
            options[i] = isnan(stepper->options[i].initial) ? 1 : stepper->options[i].initial;
        }
        assert_int_equal(stepper->dae->create(m.sys, HN_FORM_INDEX3, options, form_options, m.arena,
                                              &self, &diag),
                         HN_ERR_UNSUPPORTED);
        assert_non_null(strstr(diag.message, others[k]));
        assert_non_null(strstr(diag.hint, "radau5"));
        if (self) {
            stepper->dae->destroy(self);
        }
    }
    hn_model_close(&m);
}

static void gauss_on_index_2_is_refused_with_its_orders(void **state) {
    (void)state;
    hn_method_spec spec;
    hn_diag diag = {0};
    assert_int_equal(hn_method_parse("index2@gauss2:h=0.01", &spec, &diag), HN_ERR_INPUT);
    assert_non_null(strstr(diag.message, "multipliers that do not converge"));
    assert_non_null(strstr(diag.message, "midpoint"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radau5_has_order_five_throughout_when_speeds_are_projected_and_three_else),
        cmocka_unit_test(integrators_that_do_not_project_refuse_to_be_asked),
        cmocka_unit_test(gauss_on_index_2_is_refused_with_its_orders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
