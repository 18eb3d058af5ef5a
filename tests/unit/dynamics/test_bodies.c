// SPDX-License-Identifier: GPL-3.0-or-later
// Terms of random spatial mechanisms against plain body-by-body mechanics, and against
// differentiation.
#include "support/near.h"
#include "support/random_system.h"

#include "dynamics/compile/compile.h"

#include <math.h>

enum { SEEDS = 40 };

static void spatial_trees_have_the_mass_bias_and_energy_of_plain_mechanics(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {
            .seed = seed, .n_bodies = 1 + (int)seed % 7, .parallel = 0.5, .prismatic = 0.3};
        hn_random_check_tree(&o);
    }
}

static void groups_on_moving_bases_have_it_too(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 1000 + seed, .n_bodies = 8, .parallel = 0.75, .prismatic = 0.2};
        hn_random_check_tree(&o);
    }
}

static void planar_trees_have_it_too(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 2000 + seed, .n_bodies = 6, .prismatic = 0.3, .planar = 1};
        hn_random_check_tree(&o);
    }
}

// ---- closures ----

static void jacobian_and_gamma_are_the_derivatives_of_the_closure(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 3000 + seed,
                            .n_bodies = 2 + (int)seed % 5,
                            .n_cuts = 2,
                            .parallel = 0.5,
                            .prismatic = 0.4,
                            .planar = seed % 3 == 0};
        hn_random_system s;
        hn_random_begin(&s, &o);
        assert_true(s.m > 0);
        hn_random_state(&s, seed, false);
        hn_random_check_closure(&s);
        hn_random_end(&s);
    }
}

static double norm(const double *x, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] * x[i];
    }
    return sqrt(sum);
}

static void world_axis(const body_motion *bodies, const hn_joint *j, double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = 0;
        for (int k = 0; k < 3; k++) {
            out[i] += bodies[j->parent].R[i][k] * j->parent_axis[k];
        }
    }
}

/// Velocity of the child's half of the joint as seen from axes that turn with w about the parent's
/// half; across the axis if the joint slides along it.
static double relative_speed(const hn_joint *j, const body_motion *bodies, const double w[3]) {
    double x[2][3], v[2][3], a[2][3], axis[3], relative[3], slide = 0;
    mechanism_point(bodies, j->parent, j->parent_at, x[0], v[0], a[0]);
    mechanism_point(bodies, j->child, j->child_at, x[1], v[1], a[1]);
    world_axis(bodies, j, axis);
    for (int i = 0; i < 3; i++) {
        int b = (i + 1) % 3, c = (i + 2) % 3;
        relative[i] = v[1][i] - v[0][i] - w[b] * (x[1][c] - x[0][c]) + w[c] * (x[1][b] - x[0][b]);
        slide += relative[i] * axis[i];
    }
    for (int i = 0; i < 3 && j->type == HN_JOINT_PRISMATIC; i++) {
        relative[i] -= slide * axis[i];
    }
    return norm(relative, 3);
}

/// In a closed pose the rates of the length rows of a loop are the relative velocity of the two
/// halves, in other axes. Of a sliding joint: in the axes of the body that carries the rows'
/// directions, which may be either.
static void check_loop_rates(hn_random_system *s, const body_motion *bodies, int loop) {
    const hn_joint *j = &s->scene->joints[hn_system_loop_joint(s->sys, loop)];
    static const double none[3] = {0, 0, 0};
    double rates[HN_RANDOM_M], by_parent = relative_speed(j, bodies, bodies[j->parent].w);
    double by_child = relative_speed(j, bodies, j->child == HN_GROUND ? none : bodies[j->child].w);
    int n = 0;
    for (int row = 0; row < s->m; row++) {
        if (hn_system_row_loop(s->sys, row) == loop && hn_system_row_is_length(s->sys, row)) {
            rates[n] = 0;
            for (int k = 0; k < s->n; k++) {
                rates[n] += hn_eval_get(s->eval, HN_TERM_J)[row * s->n + k] * s->v[k];
            }
            n++;
        }
    }
    double speed = norm(rates, n),
           off = fabs(speed - by_parent) < fabs(speed - by_child) ? by_parent : by_child;
    assert_near(speed, off, 1e-11);
}

static void a_closed_pose_has_no_gap_and_the_relative_velocity_of_the_halves(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 4000 + seed,
                            .n_bodies = 3 + (int)seed % 4,
                            .n_cuts = 2,
                            .parallel = 0.5,
                            .prismatic = 0.4};
        hn_random_system s;
        hn_random_begin(&s, &o);
        hn_random_state(&s, seed, true);
        for (int i = 0; i < s.m; i++) {
            assert_near(hn_eval_get(s.eval, HN_TERM_PHI)[i], 0, 1e-12);
        }
        body_motion bodies[HN_RANDOM_N];
        mechanism_move(s.scene, s.user_q, s.user_v, bodies);
        for (int loop = 0; loop < 2; loop++) {
            check_loop_rates(&s, bodies, loop);
        }
        hn_random_end(&s);
    }
}

static void half_joints_are_drawn_where_they_are(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 10; seed++) {
        mechanism_opts o = {
            .seed = 5000 + seed, .n_bodies = 4, .n_cuts = 1, .parallel = 0.5, .prismatic = 0.3};
        hn_random_check_halves(&o, seed);
    }
}

static void planar_loops_keep_the_rows_of_the_plane(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 20; seed++) {
        mechanism_opts o = {.seed = 6000 + seed, .n_bodies = 3, .n_cuts = 1, .planar = 1};
        hn_random_system s;
        hn_random_begin(&s, &o);
        assert_int_equal(s.m, 2);
        assert_int_equal(hn_system_get_info(s.sys).rows_dropped, 3);
        hn_random_end(&s);
    }
}

static void user_coordinates_there_and_back(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 10; seed++) {
        mechanism_opts o = {.seed = 7000 + seed, .n_bodies = 7, .parallel = 0.8, .prismatic = 0.2};
        hn_random_check_user(&o, seed);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spatial_trees_have_the_mass_bias_and_energy_of_plain_mechanics),
        cmocka_unit_test(groups_on_moving_bases_have_it_too),
        cmocka_unit_test(planar_trees_have_it_too),
        cmocka_unit_test(jacobian_and_gamma_are_the_derivatives_of_the_closure),
        cmocka_unit_test(a_closed_pose_has_no_gap_and_the_relative_velocity_of_the_halves),
        cmocka_unit_test(half_joints_are_drawn_where_they_are),
        cmocka_unit_test(planar_loops_keep_the_rows_of_the_plane),
        cmocka_unit_test(user_coordinates_there_and_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
