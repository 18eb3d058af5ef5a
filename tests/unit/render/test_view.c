// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "render/view.h"

#include <math.h>
#include <string.h>

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void every_look_is_a_right_handed_frame_of_unit_vectors(void **state) {
    (void)state;
    for (int i = 0; i < 50; i++) {
        const hn_view v = hn_view_look(0.7 * i, sin(1.3 * i) * 1.5);
        assert_near(dot(v.right, v.right), 1, 4e-16);
        assert_near(dot(v.up, v.up), 1, 4e-16);
        assert_near(dot(v.right, v.up), 0, 4e-16);
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            assert_near(v.right[a] * v.up[b] - v.right[b] * v.up[a], v.toward[k], 4e-16);
        }
        assert_near(v.right[1], 0, 0); // the vertical stays upright
    }
}

static void the_front_keeps_x_and_y_to_the_last_bit(void **state) {
    (void)state;
    const hn_view front = hn_view_front();
    const double p[3] = {0.1, -7.3, 1e6};
    double seen[2];
    hn_view_project(&front, p, seen);
    assert_near(seen[0], p[0], 0);
    assert_near(seen[1], p[1], 0);
}

static void from_the_side_z_is_to_the_left_and_from_above_it_is_down(void **state) {
    (void)state;
    hn_view side, top;
    double seen[2];
    const double z[3] = {0, 0, 1};
    assert_int_equal(hn_view_parse("side", &side, NULL), HN_OK);
    assert_int_equal(hn_view_parse("top", &top, NULL), HN_OK);
    hn_view_project(&side, z, seen);
    assert_near(seen[0], -1, 1e-15);
    hn_view_project(&top, z, seen);
    assert_near(seen[1], -1, 1e-15);
}

static void with_z_upwards_the_front_shows_x_to_the_right_and_z_up(void **state) {
    (void)state;
    const hn_view v = hn_view_z_up(hn_view_front());
    const double p[3] = {2, 3, 5};
    double seen[2];
    hn_view_project(&v, p, seen);
    assert_near(seen[0], 2, 0);
    assert_near(seen[1], 5, 0);
    assert_near(v.toward[1], -1, 0);
}

static void
angles_in_degrees_are_read_and_anything_else_is_refused_with_what_is_allowed(void **state) {
    (void)state;
    hn_view a, b = hn_view_space();
    assert_int_equal(hn_view_parse("35,22", &a, NULL), HN_OK);
    assert_memory_equal(&a, &b, sizeof a);
    static const char *const bad[] = {"", "tob", "35", "35,", "35,22,1", "35,91", "nan,0", "400,0"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        hn_diag diag = {0};
        assert_int_equal(hn_view_parse(bad[i], &a, &diag), HN_ERR_INPUT);
        assert_non_null(strstr(diag.hint, "degrees"));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_look_is_a_right_handed_frame_of_unit_vectors),
        cmocka_unit_test(the_front_keeps_x_and_y_to_the_last_bit),
        cmocka_unit_test(from_the_side_z_is_to_the_left_and_from_above_it_is_down),
        cmocka_unit_test(with_z_upwards_the_front_shows_x_to_the_right_and_z_up),
        cmocka_unit_test(
            angles_in_degrees_are_read_and_anything_else_is_refused_with_what_is_allowed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
