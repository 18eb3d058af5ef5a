// SPDX-License-Identifier: GPL-3.0-or-later
// Regular motions are told from chaotic ones, and by how much these part.

#include "study/truth/chaos.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

static hn_chaos chaos_of(const char *scene, const char *settings, double T) {
    hn_model m;
    hn_chaos c;
    hn_diag diag = {0};
    hn_model_open_closed(&m, scene, settings);
    const hn_status status = hn_chaos_estimate(m.sys, m.q, m.v, T, NULL, &c, &diag);
    if (status != HN_OK) {
        fail_msg("%s: %s", scene, diag.message);
    }
    hn_model_close(&m);
    return c;
}

static void one_freedom_without_a_clock_leaves_no_room(void **state) {
    (void)state;
    const hn_chaos c = chaos_of("fb0", NULL, 10);
    assert_false(c.possible || c.chaotic);
    assert_non_null(strstr(c.why, "one degree of freedom"));
    assert_true(isinf(hn_chaos_horizon(&c, 1e-13, 1)));
}

static void four_free_angles_part_by_about_e_a_second(void **state) {
    (void)state;
    // twin motions of a program written for this one mechanism part by exp(1.05 t)
    const hn_chaos c = chaos_of("four-angles-as-printed", NULL, 30);
    assert_true(c.chaotic);
    assert_near(c.exponent, 1.05, 0.35); // of one motion over 15 s: the rate varies along it
    // from rounding to a whole turn: about 28 s
    assert_near(hn_chaos_horizon(&c, 1e-13, 1), 28, 10);
}

static void a_top_that_precesses_is_regular(void **state) {
    (void)state;
    const hn_chaos c = chaos_of("heavy-top", NULL, 10);
    assert_true(c.possible);
    assert_false(c.chaotic);
    // integrable: neighbours part like t, by a factor 2 in the second half, give or take how they
    // swing
    assert_near(c.growth, log(2), 0.7);
}

static void the_time_has_to_be_one(void **state) {
    (void)state;
    hn_model m;
    hn_chaos c;
    hn_diag diag = {0};
    hn_model_open_closed(&m, "double-pendulum", NULL);
    assert_int_equal(hn_chaos_estimate(m.sys, m.q, m.v, 0, NULL, &c, &diag), HN_ERR_INPUT);
    assert_int_equal(hn_chaos_estimate(m.sys, m.q, m.v, (double)NAN, NULL, &c, &diag),
                     HN_ERR_INPUT);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_freedom_without_a_clock_leaves_no_room),
        cmocka_unit_test(four_free_angles_part_by_about_e_a_second),
        cmocka_unit_test(a_top_that_precesses_is_regular),
        cmocka_unit_test(the_time_has_to_be_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
