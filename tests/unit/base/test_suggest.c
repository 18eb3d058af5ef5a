// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/suggest.h"

#include <string.h>

static const char *const NAMES[] = {"revolute", "prismatic", "planar"};

static void the_nearest_name_is_asked_for(void **state) {
    (void)state;
    char hint[HN_DIAG_HINT];
    const char *meant = "did you mean 'revolute'?";
    assert_string_equal(hn_suggest(hint, "revolut", NAMES, 3, "other words"), meant);
    assert_string_equal(hn_suggest_or_list(hint, "revolut", NAMES, 3, "types: "), meant);
}

static void without_a_near_name_other_words_or_the_list_are_given(void **state) {
    (void)state;
    char hint[HN_DIAG_HINT];
    assert_string_equal(hn_suggest(hint, "xyz", NAMES, 3, "other words"), "other words");
    assert_string_equal(hn_suggest(hint, "xyz", NAMES, 3, NULL), "");
    assert_string_equal(hn_suggest_or_list(hint, "xyz", NAMES, 3, "types: "),
                        "types: revolute, prismatic, planar");
    assert_string_equal(hn_suggest_or_list(hint, "xyz", NAMES, 0, "none"), "none");
}

static void a_long_list_is_cut_at_the_room(void **state) {
    (void)state;
    const char *names[60];
    char hint[HN_DIAG_HINT + 1] = {0};
    for (int i = 0; i < 60; i++) {
        names[i] = "prismatic";
    }
    hint[HN_DIAG_HINT] = 'x'; // behind the room
    hn_suggest_or_list(hint, "xyz", names, 60, "");
    assert_int_equal(strlen(hint), HN_DIAG_HINT - 1);
    assert_int_equal(hint[HN_DIAG_HINT], 'x');
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_name_is_asked_for),
        cmocka_unit_test(without_a_near_name_other_words_or_the_list_are_given),
        cmocka_unit_test(a_long_list_is_cut_at_the_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
