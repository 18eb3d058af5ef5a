// SPDX-License-Identifier: GPL-3.0-or-later
// Joints of every type, in the tree and closing loops, against plain body-by-body mechanics and
// against differentiation.
#include "support/near.h"
#include "support/random_system.h"

#include "dynamics/compile/coordinates.h"

#include <string.h>

enum { SEEDS = 60 };

static void trees_of_all_joints_have_the_mass_bias_and_energy_of_plain_mechanics(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = seed,
                            .n_bodies = 1 + (int)seed % 5,
                            .parallel = 0.5,
                            .prismatic = 0.2,
                            .mixed = seed % 2 ? 1 : 0.6};
        hn_random_check_tree(&o);
    }
}

static const int ROWS[HN_JOINT_TYPE_COUNT] = {5, 5, 4, 4, 3, 3, 6, 0};

static void jacobian_and_gamma_are_the_derivatives_of_any_closure(void **state) {
    (void)state;
    int seen[HN_JOINT_TYPE_COUNT] = {0}, rows = 0;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 3000 + seed,
                            .n_bodies = 2 + (int)seed % 3,
                            .n_cuts = 1 + (int)seed % 2,
                            .parallel = 0.4,
                            .prismatic = 0.2,
                            .mixed = 1};
        hn_random_system s;
        hn_random_begin(&s, &o);
        hn_random_state(&s, seed, false);
        hn_random_check_closure(&s);
        hn_random_state(&s, seed, true);
        rows += s.m; // none where both bodies hang on fixed joints
        double zero[HN_RANDOM_M] = {0};
        assert_all_near(hn_eval_get(s.eval, HN_TERM_PHI), zero, (size_t)s.m, 1e-12);
        for (int loop = 0; loop < o.n_cuts; loop++) {
            seen[s.scene->joints[hn_system_loop_joint(s.sys, loop)].type]++;
        }
        hn_random_end(&s);
    }
    assert_true(rows > 4 * SEEDS);
    for (int type = 0; type < HN_JOINT_FREE; type++) {
        assert_true(seen[type] > 0);
    }
}

static void every_type_closes_with_the_rows_it_takes_away(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 5000 + seed, .n_bodies = 3, .n_cuts = 1, .mixed = 1};
        hn_random_system s;
        hn_random_begin(&s, &o);
        const hn_joint *joint = &s.scene->joints[hn_system_loop_joint(s.sys, 0)];
        assert_int_equal(hn_system_get_info(s.sys).rows_before, ROWS[joint->type]);
        hn_random_end(&s);
    }
}

/// The place of the loop's half-joint on the body, as drawn, is where plain mechanics has it.
static void half_joints_are_drawn_where_they_are(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 20; seed++) {
        mechanism_opts o = {.seed = 6000 + seed, .n_bodies = 4, .n_cuts = 1, .mixed = 1};
        hn_random_check_halves(&o, seed);
    }
}

// ---- positions and speeds ----

static void user_coordinates_there_and_back_and_power_is_the_same(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 20; seed++) {
        mechanism_opts o = {.seed = 7000 + seed, .n_bodies = 6, .parallel = 0.6, .mixed = 0.7};
        hn_random_check_user(&o, seed);
    }
}

static void a_difference_is_what_moves_one_pose_to_the_other(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 20; seed++) {
        mechanism_opts o = {.seed = 8000 + seed, .n_bodies = 5, .mixed = 1};
        hn_random_system s;
        hn_random_begin(&s, &o);
        hn_random_state(&s, seed, false);
        double to[HN_RANDOM_Q], delta[HN_RANDOM_N], back[HN_RANDOM_N], rate[HN_RANDOM_Q],
            ahead[HN_RANDOM_Q], behind[HN_RANDOM_Q];
        for (int i = 0; i < s.n; i++) {
            delta[i] = 1.2 * random_signed(&seed); // a turn below pi
        }
        memcpy(to, s.q, sizeof to);
        hn_system_move(s.sys, to, delta);
        hn_system_difference(s.sys, s.q, to, back);
        assert_all_near(back, delta, (size_t)s.n, 4e-15);
        // and kinematics is its slope: central difference, error of eps^2 and of rounding over eps
        const double eps = 1e-5;
        for (int i = 0; i < s.n; i++) {
            delta[i] = eps * s.v[i];
            back[i] = -delta[i];
        }
        memcpy(ahead, s.q, sizeof ahead);
        memcpy(behind, s.q, sizeof behind);
        hn_system_move(s.sys, ahead, delta);
        hn_system_move(s.sys, behind, back);
        hn_system_kinematics(s.sys, s.q, s.v, rate);
        for (int i = 0; i < s.nq; i++) {
            assert_near((ahead[i] - behind[i]) / (2 * eps), rate[i], 1e-9);
        }
        assert_int_equal(hn_system_normalise(s.sys, s.q), 0);
        hn_random_end(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_of_all_joints_have_the_mass_bias_and_energy_of_plain_mechanics),
        cmocka_unit_test(jacobian_and_gamma_are_the_derivatives_of_any_closure),
        cmocka_unit_test(every_type_closes_with_the_rows_it_takes_away),
        cmocka_unit_test(half_joints_are_drawn_where_they_are),
        cmocka_unit_test(user_coordinates_there_and_back_and_power_is_the_same),
        cmocka_unit_test(a_difference_is_what_moves_one_pose_to_the_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
