// SPDX-License-Identifier: GPL-3.0-or-later
// Other branches and other frames: jumps between assembly modes with a ball in the loop, links that
// stay folded, rows that part where loops stand open, a platform carried through its singular pose;
// the same motion whatever the units and wherever it is.

#include "support/motion.h"
#include "support/near.h"

#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/svd.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

static const hn_incident *find(const hn_run *run, hn_incident_code code, const char *text) {
    const hn_incident *incidents = NULL;
    for (int i = 0, n = hn_run_incidents(run, &incidents); i < n; i++) {
        if (incidents[i].code == code && strstr(incidents[i].message, text)) {
            return &incidents[i];
        }
    }
    return NULL;
}

// ---- branches ----

static void a_jump_to_the_other_assembly_mode_is_told_with_a_ball_in_the_loop(void **state) {
    (void)state;
    static const char *const scenes[] = {"fb0", "fb0-ball"};
    for (int k = 0; k < 2; k++) {
        hn_model m;
        hn_model_open_closed(&m, scenes[k], NULL);
        assert_int_equal(m.info.nq - m.info.nv, k);
        // a step of a turn's tenth by Euler's method throws the coupler across
        hn_run *coarse = hn_motion_start(&m, "baumgarte:alpha=8,beta=8@euler:h=0.12");
        (void)hn_run_advance(coarse, 2.1);
        assert_non_null(find(coarse, HN_INCIDENT_BRANCH_FLIP, "assembly mode"));
        hn_run_free(coarse);
        hn_run *fine = hn_motion_start(&m, "projection@rk4:h=5e-3");
        (void)hn_motion_at(fine, 2.1);
        assert_null(find(fine, HN_INCIDENT_BRANCH_FLIP, ""));
        hn_run_free(fine);
        hn_model_close(&m);
    }
}

static void a_motion_that_turns_back_is_no_jump(void **state) {
    (void)state;
    // both swing; speeds of order 1 are not exactly along the loops, and near the turn that is all
    // there is of them
    static const char *const scenes[] = {"scott-russell", "peaucellier"};
    for (int k = 0; k < 2; k++) {
        hn_model m;
        hn_model_open_closed(&m, scenes[k], NULL);
        hn_run *run = hn_motion_start(&m, "baumgarte@euler:h=1e-3");
        (void)hn_motion_at(run, 3);
        assert_null(find(run, HN_INCIDENT_BRANCH_FLIP, ""));
        hn_run_free(run);
        hn_model_close(&m);
    }
}

static void links_that_stay_folded_onto_each_other_are_told(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=10");
    hn_run *run = hn_motion_start(&m, "index2@radau5:rtol=1e-3");
    (void)hn_run_advance(
        run, 4.8); // some fold at the flat pose at 4.64 s, and J never has its rank again
    assert_non_null(find(run, HN_INCIDENT_BRANCH_FLIP, "folded"));
    hn_run_free(run);
    run = hn_motion_start(&m, "projection@rk4:h=0.01");
    (void)hn_motion_at(run, 4.8); // the same poses, straight through
    assert_null(find(run, HN_INCIDENT_BRANCH_FLIP, ""));
    hn_run_free(run);
    hn_model_close(&m);
}

static void rows_that_part_with_the_gap_do_not_throw_a_run(void **state) {
    (void)state;
    // Bennett: three of five rows depend on the others, and part by what the loop stands open
    static const struct {
        const char *method;
        double tol;
    } runs[] = {
        {"udwadia-kalaba@rk4:h=1e-3", 1e-6}, // what the open loop leaves after 2 s is 1.2e-7
        {"symmetric-projection@rk4:h=1e-3", 1e-10},
    };
    hn_model m;
    double exact[8];
    hn_model_open_closed(&m, "bennett", NULL);
    hn_run *run = hn_motion_start(&m, "projection@dop853:rtol=1e-11");
    memcpy(exact, hn_motion_at(run, 2).q, (size_t)m.info.n_user * sizeof *exact);
    hn_run_free(run);
    for (size_t k = 0; k < sizeof runs / sizeof *runs; k++) {
        run = hn_motion_start(&m, runs[k].method);
        assert_all_near(hn_motion_at(run, 2).q, exact, m.info.n_user, runs[k].tol);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

// ---- a platform on six legs ----

static double rods_sigma(double degrees) {
    char setting[80];
    double sigma[6], v[8] = {0};
    hn_model m;
    hn_eval *eval;
    snprintf(setting, sizeof setting, "rp=0.6 yaw=%.17g", degrees * PI / 180);
    hn_model_begin(&m, "stewart-rods", setting);
    assert_int_equal(hn_eval_create(m.sys, HN_TERM_J, m.arena, &eval), HN_OK);
    hn_eval_run(eval, 0, m.q, v);
    assert_int_equal(hn_singular_values(6, 6, hn_eval_get(eval, HN_TERM_J), sigma, m.arena), HN_OK);
    hn_eval_free(eval);
    hn_model_close(&m);
    return sigma[5];
}

// half-angles of 15 and 45 degrees, radii 1 and 0.6, height 1, rows of unit direction
static void
six_legs_lose_their_hold_towards_a_yaw_of_ninety_degrees_as_computed_elsewhere(void **state) {
    (void)state;
    static const double figure[][2] = {{0, 0.64}, {60, 0.25}, {80, 0.077}, {89, 0.0074}};
    for (int k = 0; k < 4; k++) {
        assert_rel(rods_sigma(figure[k][0]), figure[k][1], 0.0065); // two digits are known
    }
    assert_true(rods_sigma(90) < 1e-14);
}

static void a_platform_carried_through_its_singular_yaw_is_warned_before(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "stewart-turning", NULL);
    assert_int_equal(m.assembly.freedoms, 0); // its legs say where it is
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=2e-3");
    (void)hn_motion_at(run, 1.5); // 1 rad/s: a right angle at pi/2
    const hn_incident *ahead = find(run, HN_INCIDENT_RANK_AHEAD, "(J loses rank) lies");
    assert_non_null(ahead);
    assert_true(ahead->value > 0.2);
    assert_near(ahead->t + ahead->value, PI / 2, 0.01); // a parabola through what came before
    const hn_incident *near = find(run, HN_INCIDENT_NEAR_SINGULAR, "; rows ");
    assert_non_null(near);
    assert_true(near->t > 1.3);
    assert_non_null(strstr(near->message, "length ")); // the legs are alike: rounding decides which
    assert_non_null(strstr(near->message, "1 degree of freedom there instead of 0"));
    hn_run_free(run);
    hn_model_close(&m);
}

static void a_platform_that_comes_back_from_its_singular_yaw_says_so(void **state) {
    (void)state;
    static const struct {
        const char *method;
        double height; // of the platform at 2 s
    } runs[] = {{"projection@rk4:h=2e-3", 1}, {"index1@dopri5:rtol=1e-8", 1.366}};
    hn_model m;
    hn_model_open_closed(&m, "stewart-turning", NULL);
    for (int k = 0; k < 2; k++) {
        hn_run *run = hn_motion_start(&m, runs[k].method);
        const hn_sample s = hn_motion_at(run, 2);
        assert_near(s.q[hn_model_user(&m, "Y")], runs[k].height, 1e-3);
        const hn_incident *flip = find(run, HN_INCIDENT_BRANCH_FLIP, "on another branch");
        assert_int_equal(flip != NULL, k == 1);
        hn_run_free(run);
    }
    hn_model_close(&m);
}

static void a_report_that_is_completed_later_has_a_higher_revision(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "stewart-turning", NULL);
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=2e-3");
    const hn_incident *near = NULL;
    while (!near) {
        assert_int_equal(hn_run_step(run), HN_OK);
        near = find(run, HN_INCIDENT_NEAR_SINGULAR, "; rows ");
    }
    const unsigned first = near->revision;
    assert_true(first > 0);
    // which way the run went on is known some steps later
    (void)hn_motion_at(run, 2);
    near = find(run, HN_INCIDENT_NEAR_SINGULAR, "; the run ");
    assert_non_null(near);
    const unsigned completed = near->revision;
    assert_true(completed > first);
    // after a reset the same report is new again
    assert_int_equal(hn_run_reset(run), HN_OK);
    (void)hn_motion_at(run, 2);
    near = find(run, HN_INCIDENT_NEAR_SINGULAR, "; the run ");
    assert_non_null(near);
    assert_true(near->revision > completed);
    hn_run_free(run);
    hn_model_close(&m);
}

static void speeds_that_turn_round_in_a_step_are_told(void **state) {
    (void)state;
    static const char *const sizes[] = {"N=2", "N=5"};
    for (int k = 0; k < 2; k++) {
        hn_model m;
        hn_model_open_closed(&m, "n-four-bar", sizes[k]);
        hn_run *run = hn_motion_start(&m, "nullspace-untracked@rk4:h=1e-3");
        (void)hn_run_advance(run, 1);
        const hn_incident *turned = find(run, HN_INCIDENT_BRANCH_FLIP, "turned round");
        assert_non_null(turned);
        assert_true(turned->value > 3 * turned->limit);
        hn_run *tracked = hn_motion_start(&m, turned->remedy[0]);
        (void)hn_motion_at(tracked, 0.6); // before the flat pose, where a chart ends
        assert_null(find(tracked, HN_INCIDENT_BRANCH_FLIP, ""));
        hn_run_free(tracked);
        hn_run_free(run);
        hn_model_close(&m);
    }
}

static void a_swing_that_turns_back_is_no_jump_of_its_speeds(void **state) {
    (void)state;
    // released at rest, one step ends just past each end of the swing, with speeds reversed and
    // small
    static const char *const methods[] = {"projection@rk4:h=1e-2", "projection@rk4:h=1e-3",
                                          "nullspace@rk4:h=5e-3", "projection@dop853:rtol=1e-6"};
    hn_model m;
    hn_model_open_closed(&m, "pendulum", NULL);
    for (int k = 0; k < 4; k++) {
        hn_run *run = hn_motion_start(&m, methods[k]);
        (void)hn_motion_at(run, 5);
        assert_null(find(run, HN_INCIDENT_BRANCH_FLIP, ""));
        hn_run_free(run);
    }
    hn_model_close(&m);
}

static void loops_that_stand_open_by_half_the_mechanism_end_a_run(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    hn_run *run = hn_motion_start(&m, "index1@rk4:h=0.3");
    assert_int_equal(hn_run_advance(run, 2), HN_ERR_DIVERGED);
    const hn_run_summary s = hn_run_get_summary(run);
    assert_non_null(strstr(s.reason, "no longer this mechanism's"));
    // a step of a quarter of a turn opens it to nearly the whole length at once
    assert_true(s.worst_gap > 0.5 * hn_system_length(m.sys) &&
                s.worst_gap < hn_system_length(m.sys));
    assert_non_null(find(run, HN_INCIDENT_DIVERGED, "the loops are open"));
    hn_run_free(run);
    hn_model_close(&m);
}

static void
an_iteration_that_fails_at_a_flat_pose_is_told_with_the_pose_and_a_way_through(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", NULL);
    hn_run *run = hn_motion_start(&m, "projection@gauss2:h=1e-3");
    assert_int_equal(hn_run_advance(run, 2), HN_ERR_NO_CONVERGENCE);
    const hn_incident *failed =
        find(run, HN_INCIDENT_NEWTON_FAILED, "constraints are almost dependent");
    assert_non_null(failed);
    hn_run *through = hn_motion_start(&m, failed->remedy[0]);
    assert_true(fabs(hn_motion_at(through, 2).energy_change) < 1e-3);
    hn_run_free(through);
    hn_run_free(run);
    hn_model_close(&m);
}

// where th1 passes pi, two of the five dependent rows of the linkage vanish, and it moves on as
// anywhere
static void rows_that_vanish_beside_others_that_do_not_stop_nobody(void **state) {
    (void)state;
    static const char *const methods[] = {"projection@gauss2:h=1e-3", "projection@gauss3:h=1e-3",
                                          "projection@gsl-bsimp:rtol=1e-6"};
    hn_model m;
    hn_model_open_closed(&m, "bennett", NULL);
    for (int k = 0; k < 3; k++) {
        hn_run *run = hn_motion_start(&m, methods[k]);
        const hn_sample s = hn_motion_at(run, 1);
        assert_true(fabs(s.energy_change) < 1e-6); // the tolerance of the last
        assert_null(find(run, HN_INCIDENT_NEAR_SINGULAR, ""));
        hn_run_free(run);
    }
    hn_model_close(&m);
}

static void energy_that_is_lost_little_by_little_is_told(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "bennett", NULL);
    hn_run *run = hn_motion_start(&m, "penalty@rk4:h=4e-3");
    const double lost = hn_motion_at(run, 2).energy_change;
    assert_true(lost < -0.1); // of the 1.4 J it started with
    assert_non_null(find(run, HN_INCIDENT_ENERGY_DRIFT, "since the start"));
    assert_null(find(run, HN_INCIDENT_ENERGY_JUMP, ""));
    hn_run_free(run);
    hn_model_close(&m);
}

// ---- other frames ----

/// th1 of the reference four-bar after 1 s, every length (and gravity) times `scale`.
static double crank_after_a_second(double scale) {
    char text[3000];
    hn_model m;
    snprintf(
        text, sizeof text,
        "{\"holonom\":1,\"name\":\"scaled\",\"parameters\":{\"L\":{\"value\":%.17g}},"
        "\"gravity\":[0,\"-9.81*L\",0],\"bodies\":["
        "{\"name\":\"crank\",\"mass\":1,\"com\":[\"L/2\",0,0],\"inertia\":{\"zz\":\"L^2/12\"}},"
        "{\"name\":\"coupler\",\"mass\":2,\"com\":[\"L\",0,0],\"inertia\":{\"zz\":\"8*L^2/12\"}},"
        "{\"name\":\"rocker\",\"mass\":1.8,\"com\":[\"0.9*L\",0,0],"
        "\"inertia\":{\"zz\":\"1.8*(1.8*L)^2/12\"}}],\"joints\":["
        "{\"name\":\"O1\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\"},"
        "\"child\":{\"body\":\"crank\"},\"coordinate\":\"th1\",\"rate\":\"w1\"},"
        "{\"name\":\"A\",\"type\":\"revolute\",\"parent\":{\"body\":\"crank\",\"at\":[\"L\",0,0]},"
        "\"child\":{\"body\":\"coupler\"},\"coordinate\":\"a2\"},"
        "{\"name\":\"O3\",\"type\":\"revolute\",\"parent\":{\"body\":\"ground\",\"at\":[\"2.2*L\","
        "0,0]},\"child\":{\"body\":\"rocker\"},\"coordinate\":\"th3\"},"
        "{\"name\":\"B\",\"type\":\"revolute\",\"parent\":{\"body\":\"coupler\",\"at\":[\"2*L\",0,"
        "0]},\"child\":{\"body\":\"rocker\",\"at\":[\"1.8*L\",0,0]},\"cut\":true}],"
        "\"start\":{\"positions\":{\"th1\":1,\"a2\":{\"guess\":-0.5},\"th3\":{\"guess\":1.5}},"
        "\"rates\":{\"th1\":2}}}",
        scale);
    hn_model_open_text(&m, text, NULL);
    assert_int_equal(m.status, HN_OK);
    hn_run *run = hn_motion_start(&m, "projection@rk4:h=2e-3");
    const double angle = hn_motion_at(run, 1).q[hn_model_user(&m, "th1")];
    assert_true(hn_run_get_summary(run).worst_gap < 1e-14 * scale);
    hn_run_free(run);
    hn_model_close(&m);
    return angle;
}

static void a_mechanism_of_micrometres_or_of_megametres_moves_as_one_of_metres(void **state) {
    (void)state;
    const double metres = crank_after_a_second(1);
    assert_near(metres, 2.72677524435375, 1e-10); // h^4
    // neither is a power of two: lengths are rounded anew, and 500 steps make some 50 roundings of
    // it
    assert_near(crank_after_a_second(1e-6), metres, 5e-14);
    assert_near(crank_after_a_second(1e6), metres, 5e-14);
}

static void rotate(double R[3][3], const double *x, double *out) {
    double y[3];
    for (int i = 0; i < 3; i++) {
        y[i] = R[i][0] * x[0] + R[i][1] * x[1] + R[i][2] * x[2];
    }
    memcpy(out, y, sizeof y);
}

static void rotate_quantity(double R[3][3], hn_quantity *x, const double *shift) {
    const double before[3] = {x[0].value, x[1].value, x[2].value};
    double after[3];
    rotate(R, before, after);
    for (int i = 0; i < 3; i++) {
        x[i].value = after[i] + (shift ? shift[i] : 0);
    }
}

/// Turns about (1, 2, -2)/3 by 1.1 rad and shifts whatever belongs to the ground, and gravity with
/// it.
static void put_elsewhere(hn_scene *scene) {
    const double k[3] = {1.0 / 3, 2.0 / 3, -2.0 / 3}, c = cos(1.1), s = sin(1.1);
    const double shift[3] = {0.7, -1.3, 0.4};
    const double K[3][3] = {{0, -k[2], k[1]}, {k[2], 0, -k[0]}, {-k[1], k[0], 0}};
    double R[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            R[i][j] = (i == j ? c : 0) + s * K[i][j] + (1 - c) * k[i] * k[j];
        }
    }
    rotate_quantity(R, scene->gravity, NULL);
    for (int j = 0; j < scene->n_joints; j++) {
        hn_joint *joint = &scene->joints[j];
        if (joint->parent == HN_GROUND) {
            rotate_quantity(R, joint->parent_at, shift);
            rotate(R, joint->parent_axis, joint->parent_axis);
            rotate(R, joint->parent_ref, joint->parent_ref);
        }
        assert_true(joint->child != HN_GROUND);
    }
}

static void a_scene_put_elsewhere_in_space_moves_as_it_did(void **state) {
    (void)state;
    static const char *const scenes[] = {"five-bar", "bennett", "rssr", "spatial-slider-crank"};
    for (int k = 0; k < 4; k++) {
        hn_model m;
        hn_system *moved = NULL;
        hn_diags diags = {0};
        double q[32], v[32], a[32], here[32], there[32];
        hn_model_open_closed(&m, scenes[k], NULL);
        hn_run *run = hn_motion_start(&m, "projection@rk4:h=1e-3");
        memcpy(here, hn_motion_at(run, 0.5).q, (size_t)m.info.n_user * sizeof *here);
        hn_run_free(run);

        put_elsewhere(m.scene);
        assert_int_equal(hn_system_compile(m.scene, NULL, &moved, &diags), HN_OK);
        assert_int_equal(hn_assemble(moved, 0, q, v, a, NULL, NULL, &diags), HN_OK);
        hn_system_rates_to_user(moved, a, there);
        double first[32];
        hn_system_rates_to_user(m.sys, m.a, first);
        double size = 1;
        for (int i = 0; i < m.info.n_user; i++) {
            size = fmax(size, fabs(first[i]));
        }
        assert_all_near(there, first, m.info.n_user, 1e-12 * size);
        hn_model other = m;
        other.sys = moved;
        run = hn_motion_start_at(&other, "projection@rk4:h=1e-3", q, v);
        memcpy(there, hn_motion_at(run, 0.5).q, (size_t)m.info.n_user * sizeof *there);
        assert_all_near(there, here, m.info.n_user, 1e-11); // rounding grown over 500 steps
        hn_run_free(run);
        hn_system_free(moved);
        hn_model_close(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_jump_to_the_other_assembly_mode_is_told_with_a_ball_in_the_loop),
        cmocka_unit_test(a_motion_that_turns_back_is_no_jump),
        cmocka_unit_test(links_that_stay_folded_onto_each_other_are_told),
        cmocka_unit_test(rows_that_part_with_the_gap_do_not_throw_a_run),
        cmocka_unit_test(
            six_legs_lose_their_hold_towards_a_yaw_of_ninety_degrees_as_computed_elsewhere),
        cmocka_unit_test(a_platform_carried_through_its_singular_yaw_is_warned_before),
        cmocka_unit_test(a_platform_that_comes_back_from_its_singular_yaw_says_so),
        cmocka_unit_test(a_report_that_is_completed_later_has_a_higher_revision),
        cmocka_unit_test(speeds_that_turn_round_in_a_step_are_told),
        cmocka_unit_test(a_swing_that_turns_back_is_no_jump_of_its_speeds),
        cmocka_unit_test(loops_that_stand_open_by_half_the_mechanism_end_a_run),
        cmocka_unit_test(
            an_iteration_that_fails_at_a_flat_pose_is_told_with_the_pose_and_a_way_through),
        cmocka_unit_test(rows_that_vanish_beside_others_that_do_not_stop_nobody),
        cmocka_unit_test(energy_that_is_lost_little_by_little_is_told),
        cmocka_unit_test(a_mechanism_of_micrometres_or_of_megametres_moves_as_one_of_metres),
        cmocka_unit_test(a_scene_put_elsewhere_in_space_moves_as_it_did),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
