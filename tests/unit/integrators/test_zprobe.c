#include "support/dae.h"
#include "support/near.h"
#include <math.h>
#include <stdio.h>
static void p(const char *name, const hn_test_orders *o) {
    printf("%-40s q %.2f v %.2f lam %.2f raw %.2f | err %.2e %.2e %.2e raw %.2e gap %.1e %.1e\n", name, o->q, o->v,
           o->lambda, o->raw, o->err_q[2], o->err_v[2], o->err_lambda[2], o->err_raw[2], o->worst_gap, o->worst_speed_gap);
}
static void probe(void **state) {
    (void)state;
    static const char *scenes[] = {"fb0", "circle-particle", "fb0-redundant"};
    for (int k = 0; k < 3; k++) {
    hn_model m;
    hn_model_open_closed(&m, scenes[k], NULL);
    hn_test_state exact;
    hn_test_reference(&m, 1, &exact);
    static const struct { const char *name; int form; const char *set; } t[] = {
      {"genalpha", HN_FORM_INDEX3, "rho=0.8"}, {"genalpha", HN_FORM_INDEX3, "rho=0"},{"genalpha", HN_FORM_INDEX3, "rho=0.99"},
      {"genalpha", HN_FORM_INDEX3, "rho=1"},{"genalpha", HN_FORM_INDEX3, "a0=consistent"},{"genalpha", HN_FORM_INDEX3, "a0=zero"},
      {"genalpha", HN_FORM_GGL, "rho=0.8"},{"genalpha", HN_FORM_GGL, "a0=zero"},{"hht", HN_FORM_INDEX3, NULL},{"hht", HN_FORM_INDEX3, "damping=0.3"}};
    for (int i = 0; i < 10; i++) {
        char text[80]; snprintf(text, 80, "%s %s %d %s", scenes[k], t[i].name, t[i].form, t[i].set ? t[i].set : "");
        hn_test_orders o = hn_test_dae_orders(&m, hn_stepper_find(t[i].name), (hn_dae_form)t[i].form, t[i].set, 1, 100, 4, &exact);
        p(text, &o);
    }
    hn_model_close(&m);
    }
}
int main(void) {
    const struct CMUnitTest tests[] = { cmocka_unit_test(probe), };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
