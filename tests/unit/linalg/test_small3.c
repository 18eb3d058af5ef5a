// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "linalg/small3.h"

#include <math.h>

static void products_may_be_written_over_their_factors(void **state) {
    (void)state;
    double a[3][3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 10}},
           b[3][3] = {{2, 0, 1}, {1, 3, 0}, {0, 1, 4}};
    double x[3] = {1, -1, 2};
    hn_num3_apply(a, x, x); // (5, 11, 19)
    assert_near(x[0], 5, 0);
    assert_near(x[1], 11, 0);
    assert_near(x[2], 19, 0);
    hn_num3_mul(a, b, a); // row 0: 2+2, 6+3, 1+12
    assert_near(a[0][0], 4, 0);
    assert_near(a[0][1], 9, 0);
    assert_near(a[0][2], 13, 0);
    hn_num3_transpose(a, a);
    assert_near(a[2][0], 13, 0);
    assert_near(a[0][2], 7 * 2 + 8, 0);
}

static void a_cross_product_is_perpendicular_to_its_factors(void **state) {
    (void)state;
    double a[3] = {1, 2, 3};
    const double b[3] = {-2, 1, 5};
    double c[3];
    hn_num3_cross(a, b, c);
    assert_near(hn_num3_dot(a, c), 0, 0);
    assert_near(hn_num3_dot(b, c), 0, 0);
    // |a x b|^2 = |a|^2 |b|^2 - (a.b)^2 = 14 * 30 - 15^2
    assert_near(hn_num3_norm(c), sqrt(14.0 * 30 - 225), 1e-14);
    hn_num3_cross(a, b, a);
    assert_near(a[0], c[0], 0);
}

static void rotations_composed_to_a_quarter_turn_are_whole_numbers(void **state) {
    (void)state;
    const double t = acos(-1.0) / 4, c = cos(t), s = sin(t);
    double eighth[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, out[3][3];
    hn_num3_compose(eighth, eighth, out);
    assert_true(out[0][0] == 0 && !signbit(out[0][0]));
    assert_true(out[0][1] == -1 && out[1][0] == 1 && out[1][1] == 0);
    double near[3][3] = {{1 + 1e-13, 0, -1e-15}, {0, 1, 0}, {0, 0, 1}};
    hn_num3_snap(near, HN_NUM3_SNAP);
    assert_true(near[0][0] != 1); // further off than rounding
    assert_true(near[0][2] == 0 && !signbit(near[0][2]));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(products_may_be_written_over_their_factors),
        cmocka_unit_test(a_cross_product_is_perpendicular_to_its_factors),
        cmocka_unit_test(rotations_composed_to_a_quarter_turn_are_whole_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
