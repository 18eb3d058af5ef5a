// SPDX-License-Identifier: GPL-3.0-or-later
// Time limits of a program of one's own.
#include "program/limits.h"
#include "support/near.h"

static void first_answer_may_take_longer_than_the_others(void **state) {
    (void)state;
    const hn_program_limits usual = hn_program_limits_default();
    assert_true(usual.start == 6 * usual.answer);

    // a slow program has time to start too
    hn_program_limits slow = usual;
    hn_program_limits_set_answer(&slow, 60);
    assert_true(slow.answer == 60 && slow.start == 360);

    // an interpreter starts in its own time, however short the answers
    hn_program_limits quick = usual;
    hn_program_limits_set_answer(&quick, 0.5);
    assert_true(quick.answer == 0.5 && quick.start == 20);
    assert_true(quick.cpu == usual.cpu && quick.memory == usual.memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_answer_may_take_longer_than_the_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
