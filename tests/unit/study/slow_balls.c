// SPDX-License-Identifier: GPL-3.0-or-later
// Long runs of mechanisms with balls: RATTLE on the group of turns beside rk4 on the projected
// system.
#include "support/model.h"
#include "support/near.h"

#include "integrators/method/method_spec.h"
#include "study/run/run.h"

#include <math.h>
#include <stdio.h>

typedef struct watched {
    hn_run *run;
    double h;
    long long steps;
} watched;

static void open_run(watched *w, const hn_model *m, const char *formulation, double h) {
    hn_method_spec spec;
    char method[64];
    snprintf(method, sizeof method, "%s:h=%.17g", formulation, h);
    assert_int_equal(hn_method_parse(method, &spec, NULL), HN_OK);
    *w = (watched){.h = h};
    assert_int_equal(hn_run_create(m->sys, &spec, m->q, m->v, NULL, &w->run, NULL), HN_OK);
}

/// Largest change of energy since the start over `looks` looks, `block` steps apart.
static double largest_change(watched *w, int looks, int block) {
    double worst = 0;
    for (int k = 0; k < looks; k++) {
        hn_sample sample;
        w->steps += block;
        assert_int_equal(hn_run_advance(w->run, (double)w->steps * w->h), HN_OK);
        assert_int_equal(hn_run_sample(w->run, hn_run_time(w->run), &sample), HN_OK);
        worst = fmax(worst, fabs(sample.energy_change));
    }
    return worst;
}

static void with_balls_the_energy_error_of_rattle_stays_and_that_of_rk4_grows(void **state) {
    (void)state;
    static const struct {
        const char *scene;
        double h; // long steps, so that both errors stand far above rounding
    } table[] = {{"heavy-top", 2e-3}, {"rssr", 5e-3}, {"spinning-block", 0.05}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        hn_model m;
        watched rattle, rk4;
        hn_model_open_closed(&m, table[i].scene, NULL);
        open_run(&rattle, &m, "index3@rattle", table[i].h);
        open_run(&rk4, &m, "projection@rk4", table[i].h);
        const double early = largest_change(&rattle, 500, 10);
        const double middle = largest_change(&rattle, 9, 10000);
        const double late = largest_change(&rattle, 500, 10);
        const double rk4_early = largest_change(&rk4, 500, 10);
        const double rk4_late = largest_change(&rk4, 9, 10000);
        // a symmetric, symplectic map: what the first 5,000 steps show is all there is
        assert_rel(late, early, 0.02);
        assert_true(middle < 1.02 * early);
        // rk4's drift adds up step by step: 18 times as many steps, about 18 times the change
        assert_true(rk4_late > 10 * rk4_early);
        assert_true(hn_run_get_summary(rattle.run).worst_gap < 1e-11);
        hn_run_free(rattle.run);
        hn_run_free(rk4.run);
        hn_model_close(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(with_balls_the_energy_error_of_rattle_stays_and_that_of_rk4_grows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
