// SPDX-License-Identifier: GPL-3.0-or-later
// Dragging a closed mechanism: the pose nearest to a target, beside triangles solved by hand.

#include "dynamics/assembly/drag.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/drawing.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { MAX_NV = 64 };
static const double ENOUGH = 10; // [s] of computing: none of these takes a thousandth

static double user[MAX_NV];

/// Drags from the assembled start; the pose is left in `user`.
static hn_drag_info drag(hn_model *m, const hn_drag_goal *goal) {
    double q[MAX_NV];
    hn_drag_info info;
    memcpy(q, m->q, (size_t)m->info.nq * sizeof *q);
    assert_int_equal(hn_drag(m->sys, 0, goal, ENOUGH, q, &info), HN_OK);
    assert_true(info.gap < 1e-12);
    hn_system_to_user(m->sys, q, user);
    return info;
}

/// The point of this label.
static int point_of(const hn_model *m, const char *label) {
    const hn_drawing d = hn_system_drawing(m->sys);
    for (int i = 0; i < d.n_points; i++) {
        if (d.labels[i] && strcmp(d.labels[i], label) == 0) {
            return i;
        }
    }
    fail_msg("no point is labelled %s", label);
    return -1;
}

static void a_crank_turns_towards_its_target(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    const hn_drag_goal goal = {.point = point_of(&m, "A"), .n = 2, .target = {-0.3, 0.9}};
    const hn_drag_info info = drag(&m, &goal);

    // the tip is on the line to the target, the length of the crank from its pivot
    assert_int_equal(info.end, HN_DRAG_NEAREST);
    // the search ends where a step gains a billionth; a hundred times that may be left
    assert_near(info.distance, hypot(0.3, 0.9) - 0.5, 1e-7);
    assert_near(user[hn_model_user(&m, "th1")], atan2(0.9, -0.3), 1e-3);
    hn_model_close(&m);
}

static void a_coordinate_takes_the_value_asked_for(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    const int th1 = hn_model_user(&m, "th1");
    const hn_drag_goal goal = {.point = -1, .coordinate = th1, .n = 1, .target = {3.5}};
    const hn_drag_info info = drag(&m, &goal);
    assert_int_equal(info.end, HN_DRAG_REACHED);
    assert_near(user[th1], 3.5, 1e-9);
    hn_model_close(&m);
}

/// The rocker stops where crank and coupler are in line: a triangle of the lengths 1.7, 0.8, 1.
static void a_rocker_goes_as_far_as_it_can(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    const int th3 = hn_model_user(&m, "th3");
    const hn_drag_goal goal = {.point = -1, .coordinate = th3, .n = 1, .target = {0.1}};
    const hn_drag_info info = drag(&m, &goal);
    const double far = M_PI - acos((0.8 * 0.8 + 1 - 1.7 * 1.7) / (2 * 0.8)),
                 least = M_PI - acos((0.8 * 0.8 + 1 - 0.7 * 0.7) / (2 * 0.8));
    assert_true(info.end == HN_DRAG_NEAREST || info.end == HN_DRAG_STUCK);
    assert_near(user[th3], fmin(far, least), 1e-3);
    assert_true(info.distance < info.distance_before);
    hn_model_close(&m);
}

static void a_ring_with_freedoms_to_spare_meets_its_target(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "ring", NULL);
    const hn_drawing d = hn_system_drawing(m.sys);
    const hn_drag_goal goal = {.point = d.n_points / 2, .n = 2, .target = {0.3, -0.5}};
    assert_int_equal(drag(&m, &goal).end, HN_DRAG_REACHED);
    hn_model_close(&m);
}

static void no_computing_time_leaves_the_pose_as_it_is(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    const hn_drag_goal goal = {.point = -1, .coordinate = 0, .n = 1, .target = {2}};
    double q[MAX_NV];
    hn_drag_info info;
    memcpy(q, m.q, (size_t)m.info.nq * sizeof *q);
    assert_int_equal(hn_drag(m.sys, 0, &goal, -1, q, &info), HN_OK);
    assert_int_equal(info.end, HN_DRAG_TIME);
    assert_near(info.distance, info.distance_before, 0);
    for (int i = 0; i < m.info.nq; i++) {
        assert_near(q[i], m.q[i], 1e-12);
    }
    hn_model_close(&m);
}

static void an_open_mechanism_that_cannot_close_is_refused(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "four-bar", NULL);
    const hn_drag_goal goal = {.point = -1, .coordinate = 0, .n = 1, .target = {2}};
    double q[MAX_NV], before[MAX_NV];
    hn_drag_info info;
    for (int i = 0; i < m.info.nq; i++) {
        before[i] = q[i] = (double)NAN;
    }
    assert_int_equal(hn_drag(m.sys, 0, &goal, ENOUGH, q, &info), HN_ERR_DIVERGED);
    assert_memory_equal(q, before, (size_t)m.info.nq * sizeof *q);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_crank_turns_towards_its_target),
        cmocka_unit_test(a_coordinate_takes_the_value_asked_for),
        cmocka_unit_test(a_rocker_goes_as_far_as_it_can),
        cmocka_unit_test(a_ring_with_freedoms_to_spare_meets_its_target),
        cmocka_unit_test(no_computing_time_leaves_the_pose_as_it_is),
        cmocka_unit_test(an_open_mechanism_that_cannot_close_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
