// SPDX-License-Identifier: GPL-3.0-or-later
// Going round: the way of a crank-rocker closes after one turn of its crank, that of a mechanism
// that swings never does, and one that leaves its curve is found out. The monitor asks for no
// acceleration on a way that has closed.
#include "dynamics/analyse/pilot.h"
#include "dynamics/analyse/round_trip.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { MOST = 8 };

typedef struct scene {
    hn_model m;
    hn_pilot *motion;
    hn_round_trip *round;
} scene;

static void open_scene(scene *s, const char *name) {
    hn_model_open_closed(&s->m, name, NULL);
    assert_true(s->m.info.nq <= MOST && s->m.info.nq == s->m.info.nv);
    assert_int_equal(hn_pilot_create(s->m.sys, s->m.arena, &s->motion), HN_OK);
    assert_int_equal(hn_round_trip_create(s->m.sys, s->m.arena, &s->round), HN_OK);
    hn_pilot_start(s->motion, 0, s->m.q, s->m.v);
}

static void close_scene(scene *s) {
    hn_pilot_free(s->motion);
    hn_model_close(&s->m);
}

/// A look at the present state, its coordinates moved by `off` each; sigma_min is given.
static const double *look(scene *s, double off, double sigma, double *start) {
    double q[MOST];
    for (int i = 0; i < s->m.info.nv; i++) {
        q[i] = hn_pilot_q(s->motion)[i] + off;
    }
    return hn_round_trip_look(s->round, hn_pilot_time(s->motion), q, hn_pilot_v(s->motion), sigma,
                              start);
}

/// Moves on with a look every 4 ms until the crank has turned by `angle` more; counts the closings
/// and keeps the last one's configuration.
static int turn(scene *s, double angle, double off, double sigma, double *there) {
    const double from = hn_pilot_q(s->motion)[0];
    int closings = 0;
    while (fabs(hn_pilot_q(s->motion)[0] - from) < angle) {
        double start = 0;
        const double *back = look(s, off, sigma, &start);
        if (back) {
            closings++;
            memcpy(there, back, (size_t)s->m.info.nv * sizeof *there);
            assert_true(start == 0.5);
        }
        for (int k = 0; k < 4; k++) {
            assert_int_equal(hn_pilot_step(s->motion, 1e-3), HN_OK);
        }
    }
    return closings;
}

static void the_way_of_a_crank_rocker_closes_with_each_turn(void **state) {
    (void)state;
    scene s;
    double there[MOST];
    open_scene(&s, "four-bar");
    assert_int_equal(turn(&s, 6.2, 0, 0.5, there), 0);
    assert_true(hn_round_trip_lowest(s.round) == 0);
    assert_int_equal(turn(&s, 0.2, 0, 0.5, there), 1);
    assert_true(hn_round_trip_lowest(s.round) == 0.5);

    // back where it began: the crank by a full turn, the others by Hermite's cubic, off by less
    // than the fourth power of the way between two looks, (0.03)^4
    assert_near(fabs(there[0] - s.m.q[0]), 2 * M_PI, 1e-9);
    for (int i = 1; i < s.m.info.nv; i++) {
        const double apart = there[i] - s.m.q[i];
        assert_near(apart - 2 * M_PI * round(apart / (2 * M_PI)), 0, 1e-6);
    }
    assert_int_equal(turn(&s, 4 * M_PI, 0, 0.5, there), 2);

    hn_round_trip_reject(s.round);
    assert_true(hn_round_trip_lowest(s.round) == 0);
    close_scene(&s);
}

static void a_way_that_leaves_its_curve_begins_anew(void **state) {
    (void)state;
    scene s;
    double there[MOST];
    open_scene(&s, "four-bar");
    assert_int_equal(turn(&s, 6.4, 0, 0.5, there), 1);

    // a turn later all coordinates are off by 0.01 rad: another mechanism by then
    assert_int_equal(turn(&s, 2 * M_PI, 0.01, 0.5, there), 0);
    assert_true(hn_round_trip_lowest(s.round) == 0);

    // sigma_min lower than it has been anywhere on the curve
    hn_round_trip_reset(s.round);
    assert_int_equal(turn(&s, 6.4, 0, 0.5, there), 1);
    double start = 0;
    assert_null(look(&s, 0, 0.4, &start));
    assert_true(hn_round_trip_lowest(s.round) == 0);
    close_scene(&s);
}

static void a_motion_to_and_fro_is_no_way_round(void **state) {
    (void)state;
    scene s;
    open_scene(&s, "triple-rocker"); // no link of which turns right round
    for (int k = 0; k < 2000; k++) {
        double start = 0;
        assert_null(look(&s, 0, 0.5, &start));
        assert_int_equal(hn_pilot_step(s.motion, 5e-3), HN_OK);
    }
    assert_true(hn_round_trip_lowest(s.round) == 0);
    close_scene(&s);
}

static void closures_that_move_with_time_are_not_followed(void **state) {
    (void)state;
    scene s;
    double there[MOST];
    open_scene(&s, "driven-crank");
    assert_int_equal(turn(&s, 13, 0, 0.5, there), 0);
    assert_true(hn_round_trip_lowest(s.round) == 0);
    close_scene(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_way_of_a_crank_rocker_closes_with_each_turn),
        cmocka_unit_test(a_way_that_leaves_its_curve_begins_anew),
        cmocka_unit_test(a_motion_to_and_fro_is_no_way_round),
        cmocka_unit_test(closures_that_move_with_time_are_not_followed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
