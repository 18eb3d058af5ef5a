// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/list/stepper_list.h"
#include "support/dae.h"
#include "support/near.h"

#include <math.h>

// a bob of 1 kg on a rod of 1 m, level at the start; its energy is 0
static const char bob[] =
    "{\"holonom\": 1, \"name\": \"bob\", \"lagrangian\": {\"coordinates\": ["
    "{\"name\": \"x\", \"rate\": \"vx\", \"unit\": \"m\"}, {\"name\": \"y\", \"rate\": \"vy\", "
    "\"unit\": \"m\"}], \"kinetic\": \"(vx^2 + vy^2)/2\", \"potential\": \"9.81*y\","
    "\"constraints\": [{\"name\": \"rod\", \"formula\": \"x^2 + y^2 - 1\"}]},"
    "\"start\": {\"positions\": {\"x\": 1, \"y\": {\"guess\": 0}}, \"rates\": {\"vy\": 0}}}";

static void energy_error_after_millions_of_steps_is_what_it_was_in_the_first_swing(void **state) {
    (void)state;
    static const struct {
        double h, error; // known from an independent program
        int blocks;
    } table[] = {{1e-2, 3.6e-3, 1000}, {1e-3, 3.6e-5, 200}};
    const int block = 10000;
    for (int i = 0; i < 2; i++) {
        hn_model m;
        hn_test_dae d;
        double worst = 0;
        hn_model_open_text(&m, bob, NULL);
        hn_test_dae_open(&d, &m, hn_stepper_find("rattle"), HN_FORM_INDEX3, NULL);
        for (int k = 0; k < table[i].blocks; k++) {
            // one look in a block, at another phase of the swing each time
            assert_int_equal(hn_test_dae_steps(&d, table[i].h, block), HN_OK);
            hn_test_dae_measure(&d);
            worst = fmax(worst, fabs(d.energy));
        }
        assert_rel(worst, table[i].error, 0.02);
        assert_true(d.gap < 1e-15);
        hn_test_dae_close(&d);
        hn_model_close(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_error_after_millions_of_steps_is_what_it_was_in_the_first_swing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
