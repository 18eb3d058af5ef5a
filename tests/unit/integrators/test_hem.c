#include "support/dae.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>

#define ORDER_TOL 0.2

static void p(const char *name, const hn_test_orders *o) {
    printf("%s q %.2f v %.2f lam %.2f raw %.2f | err %.2e %.2e %.2e raw %.2e gap %.1e %.1e\n", name, o->q, o->v,
           o->lambda, o->raw, o->err_q[2], o->err_v[2], o->err_lambda[2], o->err_raw[2], o->worst_gap, o->worst_speed_gap);
}
static void probe(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    hn_test_state exact;
    hn_test_reference(&m, 1, &exact);
    static const char *const names[] = {"hem3", "hem4", "half-explicit-rk4"};
    for (int i = 0; i < 3; i++) {
        hn_test_orders o = hn_test_dae_orders(&m, hn_stepper_find(names[i]), HN_FORM_INDEX2, NULL, 1, 100, 4, &exact);
        p(names[i], &o);
    }
    hn_test_orders o = hn_test_dae_orders(&m, hn_stepper_find("rattle"), HN_FORM_INDEX3, NULL, 1, 100, 4, &exact);
    p("rattle", &o);
    hn_model_close(&m);
    static const char bob[] = "{\"holonom\": 1, \"name\": \"bob\", \"lagrangian\": {\"coordinates\": [{\"name\": \"x\", \"rate\": \"vx\", \"unit\": \"m\"}, {\"name\": \"y\", \"rate\": \"vy\", \"unit\": \"m\"}], \"kinetic\": \"(vx^2+vy^2)/2\", \"potential\": \"9.81*y\", \"constraints\": [{\"name\": \"rod\", \"formula\": \"x^2+y^2-1\"}]}, \"start\": {\"positions\": {\"x\": 1, \"y\": {\"guess\": 0}}, \"rates\": {\"vy\": 0}}}";
    hn_model_open_text(&m, bob, NULL);
    hn_test_reference(&m, 1, &exact);
    o = hn_test_dae_orders(&m, hn_stepper_find("rattle"), HN_FORM_INDEX3, NULL, 1, 100, 4, &exact);
    p("rattle bob", &o);
    hn_test_dae d;
    hn_test_dae_open(&d, &m, hn_stepper_find("rattle"), HN_FORM_INDEX3, NULL);
    double worst = 0;
    for (int i = 0; i < 1000000; i++) {
        assert_int_equal(hn_test_dae_steps(&d, 1e-2, 1), HN_OK);
        if (i < 1000 || i % 997 == 0) {
            hn_test_dae_measure(&d);
            worst = fmax(worst, fabs(d.energy));
        }
        if (i == 1000 || i == 999999) printf("%d worst %g gap %g %g newton\n", i, worst, d.gap, d.speed_gap);
    }
    hn_cost c = {0};
    d.table->add_cost(d.self, &c);
    printf("newton %lld fact %lld\n", c.newton, c.factorisations);
    hn_test_dae_close(&d);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
