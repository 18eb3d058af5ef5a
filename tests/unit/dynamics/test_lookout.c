// SPDX-License-Identifier: GPL-3.0-or-later
// Looking ahead of a motion: a pilot run that found nothing is gone on from while the motion
// follows it, and what is announced is what a run from the present state finds.
#include "dynamics/analyse/lookout.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { MOST = 8 };

/// sigma_min as a straight line in the crank's angle, with a zero at `zero`; counts its calls.
typedef struct fall {
    double zero;
    int calls;
} fall;

static double probe(void *user, double t, const double *q) {
    fall *f = user;
    (void)t;
    f->calls++;
    return fmin(1, fabs(q[0] - f->zero));
}

/// A scene in motion, its real motion by a pilot of its own.
typedef struct scene {
    hn_model m;
    hn_pilot *motion;
    hn_lookout *lookout;
    double q[MOST], horizon;
} scene;

static void open_scene(scene *s) {
    hn_model_open_closed(&s->m, "four-bar", NULL);
    assert_true(s->m.info.nq <= MOST && s->m.info.nq == s->m.info.nv);
    assert_int_equal(hn_pilot_create(s->m.sys, s->m.arena, &s->motion), HN_OK);
    assert_int_equal(hn_lookout_create(s->m.sys, s->m.arena, &s->lookout), HN_OK);
    hn_pilot_start(s->motion, 0, s->m.q, s->m.v);
    s->horizon = 0.4;
}

static void close_scene(scene *s) {
    hn_lookout_free(s->lookout);
    hn_pilot_free(s->motion);
    hn_model_close(&s->m);
}

/// Lets the motion go on for `time` in steps far finer than the pilot's.
static void move(scene *s, double time) {
    for (int k = 0; k < 200; k++) {
        assert_int_equal(hn_pilot_step(s->motion, time / 200), HN_OK);
    }
}

/// Seconds to the zero from the present state, off by `off` in the crank's angle.
static double search(scene *s, hn_lookout *l, fall *f, double off, double *lowest) {
    const double *v = hn_pilot_v(s->motion);
    memcpy(s->q, hn_pilot_q(s->motion), (size_t)s->m.info.nq * sizeof *s->q);
    s->q[0] += off;
    f->calls = 0;
    const hn_lookout_aim aim = {probe, f, 0.01};
    return hn_lookout_search(l, hn_pilot_time(s->motion), s->q, v, s->horizon, 1, &aim, lowest);
}

static void a_motion_that_is_followed_is_looked_at_once(void **state) {
    (void)state;
    scene s;
    fall f = {.zero = 100};
    double lowest = 0;
    open_scene(&s);
    assert_true(search(&s, s.lookout, &f, 0, &lowest) == HUGE_VAL);
    const int whole = f.calls;
    assert_in_range(whole, 24, 48);
    for (int k = 0; k < 6; k++) { // a quarter of the horizon has been added each time
        move(&s, s.horizon / 4);
        assert_true(search(&s, s.lookout, &f, 0, &lowest) == HUGE_VAL);
        assert_in_range(f.calls, 1, whole / 2);
    }

    // beside the way, and after all has been forgotten, the look begins anew
    move(&s, s.horizon / 4);
    assert_true(search(&s, s.lookout, &f, 0.01, &lowest) == HUGE_VAL);
    assert_true(f.calls >= 24);
    hn_lookout_reset(s.lookout);
    move(&s, s.horizon / 4);
    assert_true(search(&s, s.lookout, &f, 0, &lowest) == HUGE_VAL);
    assert_true(f.calls >= 24);
    close_scene(&s);
}

static void what_is_announced_is_found_from_the_present_state(void **state) {
    (void)state;
    scene s;
    hn_lookout *fresh = NULL;
    double lowest = 0, lowest_fresh = 0;
    open_scene(&s);
    assert_int_equal(hn_lookout_create(s.m.sys, s.m.arena, &fresh), HN_OK);

    // where the crank will be in 1.1 horizons: too far at first, within reach a little later
    fall f = {.zero = 100};
    hn_pilot_start(s.motion, 0, s.m.q, s.m.v);
    move(&s, 1.1 * s.horizon);
    f.zero = hn_pilot_q(s.motion)[0];
    hn_pilot_start(s.motion, 0, s.m.q, s.m.v);
    assert_true(search(&s, s.lookout, &f, 0, &lowest) == HUGE_VAL);

    move(&s, 0.25 * s.horizon);
    const double ahead = search(&s, s.lookout, &f, 0, &lowest);
    assert_near(ahead, 0.85 * s.horizon, 1e-4 * s.horizon); // RK4 in steps of a degree or two
    assert_true(ahead == search(&s, fresh, &f, 0, &lowest_fresh));
    assert_true(lowest == lowest_fresh && lowest < 0.01);
    hn_lookout_free(fresh);
    close_scene(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_motion_that_is_followed_is_looked_at_once),
        cmocka_unit_test(what_is_announced_is_found_from_the_present_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
