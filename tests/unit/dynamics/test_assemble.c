// SPDX-License-Identifier: GPL-3.0-or-later
// Assembly: start values that close, pins that hold, modes that are kept, and closures that cannot
// be reached and say why.

#include "dynamics/assembly/mode.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "support/alloc.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A planar four-bar; %s are the start positions and rates.
static const char FOUR_BAR[] =
    "{\"holonom\": 1, \"name\": \"bar\", \"title\": \"bar\","
    " \"parameters\": {\"l1\": {\"value\": 1, \"unit\": \"m\", \"min\": 0.1, \"max\": 50},"
    "  \"l2\": {\"value\": 2, \"unit\": \"m\", \"min\": 0.1, \"max\": 50},"
    "  \"l3\": {\"value\": 1.8, \"unit\": \"m\", \"min\": 0.1, \"max\": 50},"
    "  \"d\": {\"value\": 2.2, \"unit\": \"m\", \"min\": 0.1, \"max\": 50}},"
    " \"gravity\": [0, -9.81, 0],"
    " \"bodies\": ["
    "  {\"name\": \"crank\", \"mass\": 1, \"com\": [\"l1/2\", 0, 0], \"inertia\": {\"zz\": 0.1}},"
    "  {\"name\": \"coupler\", \"mass\": 2, \"com\": [\"l2/2\", 0, 0], \"inertia\": {\"zz\": 0.6}},"
    "  {\"name\": \"rocker\", \"mass\": 1.8, \"com\": [\"l3/2\", 0, 0], \"inertia\": {\"zz\": "
    "0.5}}],"
    " \"joints\": ["
    "  {\"name\": \"O1\", \"type\": \"revolute\", \"parent\": {\"body\": \"ground\"}, \"child\": "
    "{\"body\": \"crank\"},"
    "   \"coordinate\": \"th1\", \"rate\": \"w1\"},"
    "  {\"name\": \"A\", \"type\": \"revolute\", \"parent\": {\"body\": \"crank\", \"at\": "
    "[\"l1\", 0, 0]},"
    "   \"child\": {\"body\": \"coupler\"}, \"coordinate\": \"a2\", \"rate\": \"wa2\"},"
    "  {\"name\": \"O3\", \"type\": \"revolute\", \"parent\": {\"body\": \"ground\", \"at\": "
    "[\"d\", 0, 0]},"
    "   \"child\": {\"body\": \"rocker\"}, \"coordinate\": \"th3\", \"rate\": \"w3\"},"
    "  {\"name\": \"B\", \"type\": \"revolute\", \"parent\": {\"body\": \"coupler\", \"at\": "
    "[\"l2\", 0, 0]},"
    "   \"child\": {\"body\": \"rocker\", \"at\": [\"l3\", 0, 0]}, \"coordinate\": \"b3\", "
    "\"rate\": \"wb3\","
    "   \"cut\": true}],"
    " \"start\": {\"positions\": {%s}, \"rates\": {%s}}}";

static void open_bar(hn_model *m, const char *positions, const char *rates, const char *settings) {
    char json[4096];
    (void)snprintf(json, sizeof json, FOUR_BAR, positions, rates);
    hn_model_open_text(m, json, settings);
}

static double user_value(const hn_model *m, const char *name) {
    return m->user_q[hn_model_user(m, name)];
}

static void reference_four_bar_starts_where_two_independent_solutions_start(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "fb0", NULL);
    double th1 = user_value(&m, "th1");
    assert_near(th1, 1, 0);
    assert_near(th1 + user_value(&m, "a2"), 0.498324904142577, 2e-15);
    assert_near(user_value(&m, "th3"), 1.516841745037813, 2e-15);
    assert_near(m.lambda[0], 0.921838074449043, 1e-13);
    assert_near(m.lambda[1], 6.630912100630129, 1e-13);
    assert_near(m.assembly.energy, 49.34675722838445, 1e-13);
    assert_int_equal(m.assembly.freedoms, 1);
    assert_int_equal(m.assembly.redundant, 0);
    assert_string_equal(m.assembly.mode_name, "open");
    assert_true(m.assembly.gap < 1e-14 && m.assembly.velocity_gap < 1e-14);
    assert_true(m.assembly.sigma_min > 0.01 && m.assembly.sigma_max >= m.assembly.sigma_min);
    hn_model_close(&m);
}

static void both_kinds_of_scene_assemble_to_the_same_state(void **state) {
    (void)state;
    hn_model joints, formulas;
    hn_model_open_closed(&joints, "fb0", NULL);
    hn_model_open_closed(&formulas, "fb0-lagrangian", NULL);
    assert_near(user_value(&joints, "th3"), user_value(&formulas, "th3"), 1e-15);
    assert_near(joints.user_v[hn_model_user(&joints, "th3")],
                formulas.user_v[hn_model_user(&formulas, "th3")], 1e-14);
    assert_all_near(joints.lambda, formulas.lambda, 2, 1e-13);
    assert_near(joints.assembly.energy, formulas.assembly.energy, 1e-13);
    assert_near(joints.assembly.sigma_min, formulas.assembly.sigma_min, 1e-12);
    assert_string_equal(formulas.assembly.mode_name, "open");
    hn_model_close(&joints);
    hn_model_close(&formulas);
}

/// Closed form: e = O3 - A, th2 = arg e +- acos((l2^2 + L^2 - l3^2) / (2 l2 L)).
static double coupler_angle(double th1, double sign) {
    double ex = 2.2 - cos(th1), ey = -sin(th1), L = hypot(ex, ey);
    return atan2(ey, ex) + sign * acos((4 + L * L - 1.8 * 1.8) / (2 * 2 * L));
}

static void every_crank_angle_assembles_in_the_mode_of_its_guess(void **state) {
    (void)state;
    for (int k = 0; k < 24; k++) {
        for (int side = -1; side <= 1; side += 2) {
            double th1 = -3.1 + 0.26 * k, th2 = coupler_angle(th1, side);
            double th3 = atan2(sin(th1) + 2 * sin(th2), cos(th1) + 2 * cos(th2) - 2.2);
            char positions[160];
            (void)snprintf(
                positions, sizeof positions,
                "\"th1\": %.17g, \"a2\": {\"guess\": %.17g}, \"th3\": {\"guess\": %.17g}", th1,
                th2 - th1 + 0.1, th3 - 0.1);
            hn_model m;
            open_bar(&m, positions, "\"th1\": 1", NULL);
            assert_int_equal(m.status, HN_OK);
            assert_near(user_value(&m, "a2") + th1, th2, 1e-12);
            assert_near(user_value(&m, "th3"), th3, 1e-12);
            assert_int_equal(m.assembly.mode, side);
            assert_string_equal(m.assembly.mode_name, side > 0 ? "open" : "crossed");
            hn_model_close(&m);
        }
    }
}

static void far_guesses_still_close(void **state) {
    (void)state;
    const double guesses[][2] = {{0, 0}, {3, -3}, {-2, 2}, {1.5, 1.5}, {6, -4}};
    for (size_t k = 0; k < sizeof guesses / sizeof *guesses; k++) {
        char positions[160];
        (void)snprintf(positions, sizeof positions,
                       "\"th1\": 1, \"a2\": {\"guess\": %g}, \"th3\": {\"guess\": %g}",
                       guesses[k][0], guesses[k][1]);
        hn_model m;
        open_bar(&m, positions, "\"th1\": 1", NULL);
        assert_int_equal(m.status, HN_OK);
        assert_true(m.assembly.gap < 1e-13);
        assert_near(user_value(&m, "th1"), 1, 0);
        assert_true(m.assembly.iterations > 0 && m.assembly.moved > 0);
        assert_string_not_equal(m.assembly.route, "already closed");
        hn_model_close(&m);
    }
}

static void a_pinned_rocker_is_held_and_the_crank_follows(void **state) {
    (void)state;
    hn_model m;
    open_bar(&m, "\"th1\": {\"guess\": 0.9}, \"a2\": {\"guess\": -0.4}, \"th3\": 1.516841745037813",
             "\"th3\": -1", NULL);
    assert_int_equal(m.status, HN_OK);
    assert_near(user_value(&m, "th3"), 1.516841745037813, 0);
    assert_near(user_value(&m, "th1"), 1, 1e-13);
    assert_near(m.user_v[hn_model_user(&m, "th3")], -1, 1e-15);
    assert_true(m.assembly.velocity_gap < 1e-14);
    hn_model_close(&m);
}

static void diag_must_hold(const hn_model *m, const char *part) {
    for (int i = 0; i < m->diags.n; i++) {
        if (strstr(m->diags.item[i].message, part) || strstr(m->diags.item[i].hint, part)) {
            return;
        }
    }
    fail_msg("'%s' is not in: %s [%s]", part, m->diags.n ? m->diags.item[0].message : "(nothing)",
             m->diags.n ? m->diags.item[0].hint : "");
}

static void a_dyad_out_of_reach_says_what_is_missing(void **state) {
    (void)state;
    // the crank tip at (-1, 0) is 3.2 m from O3, but coupler and rocker reach 1.2 + 1.8 = 3 m
    hn_model m;
    open_bar(&m, "\"th1\": 3.141592653589793, \"a2\": {\"guess\": -2}, \"th3\": {\"guess\": 2}",
             "\"th1\": 1", "l2=1.2");
    assert_int_equal(m.status, HN_ERR_UNREACHABLE);
    assert_false(m.assembly.ok);
    assert_int_equal(m.assembly.worst_loop, 0);
    assert_near(m.assembly.gap, 0.2, 1e-6);
    assert_near(user_value(&m, "th1"), 3.141592653589793, 0);
    diag_must_hold(&m, "0.2 m");
    diag_must_hold(&m, "th1 = 3.14159");
    diag_must_hold(&m, "0.2 m are missing");
    diag_must_hold(&m, "coupler longer than 1.4 m");
    diag_must_hold(&m, "rocker longer than 2 m");
    diag_must_hold(&m, "change what is held at the start (");
    hn_model_close(&m);
}

static void a_dyad_too_near_for_its_long_side_says_so(void **state) {
    (void)state;
    // the crank tip at (1, 0) is 1.2 m from O3, but the rods differ by 5 - 1.8 = 3.2 m
    hn_model m;
    open_bar(&m, "\"th1\": 0, \"a2\": {\"guess\": 1}, \"th3\": {\"guess\": 2}", "\"th1\": 1",
             "l2=5");
    assert_int_equal(m.status, HN_ERR_UNREACHABLE);
    assert_near(m.assembly.gap, 2, 1e-6);
    diag_must_hold(&m, "the side coupler is 5 m long");
    diag_must_hold(&m, "2 m are missing");
    diag_must_hold(&m, "coupler shorter than 3 m");
    diag_must_hold(&m, "rocker longer than 3.8 m");
    hn_model_close(&m);
}

static void a_ring_that_never_closes_says_so_without_pins(void **state) {
    (void)state;
    hn_model m;
    open_bar(&m, "\"th1\": {\"guess\": 1}, \"a2\": {\"guess\": -0.5}, \"th3\": {\"guess\": 2}",
             "\"th1\": 0", "d=5");
    assert_int_equal(m.status, HN_ERR_UNREACHABLE);
    assert_near(m.assembly.gap, 0.2, 1e-6);
    diag_must_hold(&m, "the side ground is 5 m long");
    diag_must_hold(&m, "ground shorter than 4.8 m");
    hn_model_close(&m);
}

static void formulas_that_cannot_be_met_are_named(void **state) {
    (void)state;
    hn_model m;
    hn_model_begin(&m, "fb0-lagrangian", "d=4.9 l3=1.7");
    assert_int_equal(m.status, HN_ERR_UNREACHABLE);
    assert_near(m.assembly.gap, hypot(4.9 - cos(1), sin(1)) - 3.7, 1e-6);
    diag_must_hold(&m, "'loop x' is off by 0.72");
    diag_must_hold(&m, "th1 = 1");
    hn_model_close(&m);
}

static void a_dyad_that_just_reaches_assembles_at_its_dead_point(void **state) {
    (void)state;
    // the crank tip is 3.8 m from O3 and coupler and rocker together are 3.8 m long: stretched, J_d
    // singular
    char settings[64];
    (void)snprintf(settings, sizeof settings, "d=%.17g",
                   cos(1) + sqrt(3.8 * 3.8 - sin(1) * sin(1)));
    hn_model m;
    open_bar(&m, "\"th1\": 1, \"a2\": {\"guess\": -1}, \"th3\": {\"guess\": 2.5}", "\"th1\": 0",
             settings);
    assert_int_equal(m.status, HN_OK);
    assert_true(m.assembly.gap < 1e-11);
    double th2 = 1 + user_value(&m, "a2"), th3 = user_value(&m, "th3");
    assert_near(sin(th3 - th2), 0,
                1e-5); // tangent: the angle is only as good as the root of the gap
    hn_model_close(&m);
}

static void two_pins_on_one_freedom_are_told(void **state) {
    (void)state;
    hn_model m;
    open_bar(&m, "\"th1\": 1, \"a2\": {\"guess\": -0.5}, \"th3\": 1.6", "\"th1\": 1", NULL);
    assert_int_equal(m.status, HN_ERR_UNREACHABLE);
    diag_must_hold(&m, "th1 = 1, th3 = 1.6");
    hn_model_close(&m);
}

static void contradictory_rates_are_told(void **state) {
    (void)state;
    hn_model m;
    open_bar(&m, "\"th1\": 1, \"a2\": {\"guess\": -0.5}, \"th3\": {\"guess\": 1.5}",
             "\"th1\": 2, \"th3\": 5", NULL);
    assert_int_equal(m.status, HN_ERR_INCONSISTENT);
    diag_must_hold(&m, "w1 = 2, w3 = 5");
    assert_true(m.assembly.velocity_gap > 0.1);
    hn_model_close(&m);
}

static void a_pin_on_the_joint_that_closes_the_loop_is_refused(void **state) {
    (void)state;
    hn_model m;
    open_bar(&m, "\"th1\": 1, \"a2\": {\"guess\": -0.5}, \"th3\": {\"guess\": 1.5}, \"b3\": 0.5",
             "\"th1\": 2", NULL);
    assert_int_equal(m.status, HN_ERR_UNSUPPORTED);
    diag_must_hold(&m, "b3 cannot have");
    assert_string_equal(m.diags.item[0].pointer, "/start/positions/b3");
    hn_model_close(&m);
    open_bar(&m, "\"th1\": 1, \"a2\": {\"guess\": -0.5}, \"b3\": {\"guess\": 0.5}", "\"th1\": 2",
             NULL);
    assert_int_equal(m.status, HN_ERR_UNSUPPORTED);
    diag_must_hold(&m, "b3 cannot have");
    hn_model_close(&m);
}

static void free_rates_change_least_by_mass(void **state) {
    (void)state;
    hn_model m;
    open_bar(&m, "\"th1\": 1, \"a2\": {\"guess\": -0.5}, \"th3\": {\"guess\": 1.5}",
             "\"th1\": {\"guess\": 2}, \"a2\": {\"guess\": 1}, \"th3\": {\"guess\": -1}", NULL);
    assert_int_equal(m.status, HN_OK);

    // least change: M (v - guess) has no part along the motions that the loop allows, which are
    // multiples of v
    double guess_user[3] = {0}, guess[3], change[3], Mc[3];
    guess_user[hn_model_user(&m, "th1")] = 2;
    guess_user[hn_model_user(&m, "a2")] = 1;
    guess_user[hn_model_user(&m, "th3")] = -1;
    hn_system_rates_from_user(m.sys, guess_user, guess);
    hn_eval *e;
    assert_int_equal(hn_eval_create(m.sys, HN_TERM_M, m.arena, &e), HN_OK);
    hn_eval_run(e, 0, m.q, m.v);
    for (int i = 0; i < 3; i++) {
        change[i] = m.v[i] - guess[i];
    }
    hn_mat_vec(3, 3, hn_eval_get(e, HN_TERM_M), change, Mc);
    assert_near(hn_dot(3, m.v, Mc), 0, 1e-13);
    assert_true(hn_norm2(3, change) > 0.1);
    hn_eval_free(e);
    hn_model_close(&m);
}

static void redundant_loop_rows_are_counted_and_harmless(void **state) {
    (void)state;
    hn_model m, plain;
    hn_model_open_closed(&m, "fb0-redundant", NULL);
    hn_model_open_closed(&plain, "fb0", NULL);
    assert_int_equal(m.assembly.rank, 2);
    assert_int_equal(m.assembly.redundant, 2);
    assert_int_equal(m.assembly.freedoms, 1);
    assert_all_near(m.user_q, plain.user_q, 3, 1e-14);
    assert_all_near(m.user_v, plain.user_v, 3, 1e-13);
    assert_all_near(m.a, plain.a, 3, 1e-12);
    hn_model_close(&m);
    hn_model_close(&plain);
}

static void a_scene_without_loops_needs_no_closing(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "double-pendulum", NULL);
    assert_int_equal(m.info.nc, 0);
    assert_string_equal(m.assembly.route, "already closed");
    assert_int_equal(m.assembly.iterations, 0);
    assert_int_equal(m.assembly.freedoms, m.info.nv);
    assert_int_equal(m.assembly.mode, 0);
    hn_model_close(&m);
}

static void every_shipped_scene_assembles(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int freedoms;
    } scenes[] = {{"four-bar", 1},
                  {"slider-crank", 1},
                  {"five-bar", 2},
                  {"four-angles-as-printed", 2},
                  {"n-four-bar", 1}};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        hn_model m;
        hn_model_open_closed(&m, scenes[i].name, NULL);
        assert_int_equal(m.assembly.freedoms, scenes[i].freedoms);
        assert_true(m.assembly.gap < 1e-13 && m.assembly.velocity_gap < 1e-13);
        hn_model_close(&m);
    }
}

static void the_mode_watch_sees_a_dead_point_pass(void **state) {
    (void)state;
    // rocker-driven: th3 pinned, so th1 and a2 depend on it; the crank stretched over the coupler
    // is its dead point
    hn_model m;
    open_bar(&m, "\"th1\": {\"guess\": 1}, \"a2\": {\"guess\": -0.5}, \"th3\": 1.516841745037813",
             "\"th3\": 0", NULL);
    assert_int_equal(m.status, HN_OK);
    hn_arena *arena = hn_arena_create(0);
    hn_mode_watch *watch;
    assert_int_equal(hn_mode_watch_create(m.sys, arena, &watch), HN_OK);
    double before = hn_mode_watch_value(watch, 0, m.q);

    // the columns are l1 and l2 turned by a right angle: the value is the sine between them, up to
    // its sign
    double a2 = user_value(&m, "a2");
    double x = cos(1) + 2 * cos(1 + a2), y = sin(1) + 2 * sin(1 + a2);
    double sine = (x * 2 * sin(1 + a2) - y * 2 * cos(1 + a2)) / (hypot(x, y) * 2);
    assert_near(fabs(before), fabs(sine), 1e-12);
    double stretched[3], q[3];
    stretched[hn_model_user(&m, "th1")] = 0.4;
    stretched[hn_model_user(&m, "a2")] = 0;
    stretched[hn_model_user(&m, "th3")] = 1.5;
    hn_system_from_user(m.sys, stretched, q);
    assert_near(hn_mode_watch_value(watch, 0, q), 0, 1e-15);
    hn_mode_watch_free(watch);
    hn_arena_free(arena);
    hn_model_close(&m);
}

static void a_tilted_mechanism_out_of_reach_is_explained_in_its_own_plane(void **state) {
    (void)state;
    hn_model m;
    hn_model_begin(&m, "fb0-tilted", "d=4.9 l3=1.7");
    assert_int_equal(m.status, HN_ERR_UNREACHABLE);
    double span = hypot(4.9 - cos(1), sin(1));
    char expected[64];
    (void)snprintf(expected, sizeof expected, " is %.6g m long", span);
    diag_must_hold(&m, expected);
    (void)snprintf(expected, sizeof expected, "rocker longer than %.6g m", span - 2);
    diag_must_hold(&m, expected);
    assert_near(m.assembly.gap, span - 3.7, 1e-6);
    hn_model_close(&m);
}

static void a_moving_constraint_sets_the_speed_and_the_acceleration(void **state) {
    (void)state;
    // x = 0.1 + sin(2 t) - 0.3 y drives a point mass: phi_t and phi_tt must both enter
    static const char driven[] =
        "{\"holonom\": 1, \"name\": \"driven\", \"title\": \"driven\", \"lagrangian\": "
        "{\"coordinates\": ["
        "{\"name\": \"x\", \"rate\": \"u\", \"unit\": \"m\"}, {\"name\": \"y\", \"rate\": \"w\", "
        "\"unit\": \"m\"}],"
        "\"kinetic\": \"u^2/2 + w^2/2\", \"potential\": \"0\","
        "\"constraints\": [{\"name\": \"drive\", \"formula\": \"x - 0.1 - sin(2*t) + 0.3*y\"}]},"
        "\"start\": {\"positions\": {\"y\": 1}, \"rates\": {\"y\": 2}}}";
    hn_model m;
    hn_model_open_text(&m, driven, NULL);
    assert_int_equal(m.status, HN_OK);
    assert_near(m.q[0], 0.1 - 0.3, 1e-15);
    assert_near(m.v[0], 2 - 0.3 * 2, 1e-15);
    const double t = 0.7;
    double q[2], v[2], a[2], lambda[1];
    assert_int_equal(hn_assemble(m.sys, t, q, v, a, lambda, NULL, NULL), HN_OK);
    assert_near(q[0], 0.1 + sin(2 * t) - 0.3, 1e-14);
    assert_near(v[0], 2 * cos(2 * t) - 0.6, 1e-14);
    // a = J' lambda with J = (1, 0.3), and J a = -4 sin(2 t)
    assert_near(lambda[0], -4 * sin(2 * t) / 1.09, 1e-13);
    assert_near(a[0], lambda[0], 1e-13);
    assert_near(a[1], 0.3 * lambda[0], 1e-13);
    hn_model_close(&m);
}

/// Assembles with the n-th allocation failing. 0 when there was no n-th one any more.
static int assemble_with_failure(long n) {
    hn_model m;
    open_bar(&m, "\"th1\": 1, \"a2\": {\"guess\": 2}, \"th3\": {\"guess\": 1}", "\"th1\": 1", NULL);
    assert_int_equal(m.status, HN_OK);
    double q[3], v[3], a[3], lambda[2];
    hn_alloc_fail_at(n);
    hn_status status = hn_assemble(m.sys, 0, q, v, a, lambda, NULL, NULL);
    int failed = hn_alloc_has_failed();
    hn_alloc_fail_at(0);
    assert_int_equal(status, failed ? HN_ERR_MEMORY : HN_OK);
    hn_model_close(&m);
    return failed;
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    long live = hn_alloc_live(), n = 1;
    while (assemble_with_failure(n)) {
        assert_int_equal(hn_alloc_live(), live);
        n++;
    }
    assert_true(n > 4);
}

static void a_ladder_of_two_hundred_loops_assembles(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "n-four-bar", "N=200");
    assert_int_equal(m.info.nv, 401);
    assert_int_equal(m.assembly.freedoms, 1);
    assert_true(m.assembly.gap < 1e-13);
    assert_string_equal(m.assembly.mode_name, "open"); // th1 - th of the coupler is pi / 2
    for (int i = 0; i < m.info.nv; i++) {
        // all verticals turn alike, all couplers keep level: b = -th
        assert_near(fabs(m.user_v[i]), 1, 1e-10);
    }
    hn_model_close(&m);
}

// |phi| is least where the two copies share the offset: 1e-3 / sqrt(2) in all, half of it in each
static void two_closures_a_millimetre_apart_are_unreachable_with_half_of_it_in_each(void **state) {
    (void)state;
    static const char json[] =
        "{\"holonom\": 1, \"name\": \"two\", \"bodies\": [{\"name\": \"crank\", \"mass\": 1}, "
        "{\"name\": \"coupler\", \"mass\": 1}, {\"name\": \"rocker\", \"mass\": 1}], \"joints\": ["
        "{\"name\": \"O1\", \"type\": \"revolute\", \"child\": {\"body\": \"crank\"}, "
        "\"parent\": {\"body\": \"ground\"}, \"coordinate\": \"th1\"},"
        "{\"name\": \"A\", \"type\": \"revolute\", \"parent\": {\"body\": \"crank\", \"at\": [1, "
        "0, 0]}, "
        "\"child\": {\"body\": \"coupler\"}, \"coordinate\": \"a2\"},"
        "{\"name\": \"O3\", \"type\": \"revolute\", \"parent\": {\"body\": \"ground\", \"at\": "
        "[2.2, 0, 0]}, "
        "\"child\": {\"body\": \"rocker\"}, \"coordinate\": \"th3\"},"
        "{\"name\": \"B\", \"type\": \"revolute\", \"cut\": true, \"parent\": {\"body\": "
        "\"coupler\", "
        "\"at\": [2, 0, 0]}, \"child\": {\"body\": \"rocker\", \"at\": [1.8, 0, 0]}},"
        "{\"name\": \"C\", \"type\": \"revolute\", \"cut\": true, \"parent\": {\"body\": "
        "\"coupler\", "
        "\"at\": [2, 0, 0]}, \"child\": {\"body\": \"rocker\", \"at\": [1.801, 0, 0]}}],"
        "\"start\": {\"positions\": {\"th1\": 1, \"a2\": {\"guess\": -0.5}, \"th3\": {\"guess\": "
        "1.5}}}}";
    hn_model m;
    hn_model_open_text(&m, json, NULL);
    assert_int_equal(m.status, HN_ERR_UNREACHABLE);
    assert_near(m.assembly.gap, 1e-3 / sqrt(2),
                1e-9); // the offset turns with the rocker: second order
    assert_non_null(strstr(m.diags.item[0].message, "cannot be closed: a gap of 0.0005 m is left"));
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference_four_bar_starts_where_two_independent_solutions_start),
        cmocka_unit_test(both_kinds_of_scene_assemble_to_the_same_state),
        cmocka_unit_test(every_crank_angle_assembles_in_the_mode_of_its_guess),
        cmocka_unit_test(far_guesses_still_close),
        cmocka_unit_test(a_pinned_rocker_is_held_and_the_crank_follows),
        cmocka_unit_test(a_dyad_out_of_reach_says_what_is_missing),
        cmocka_unit_test(a_dyad_too_near_for_its_long_side_says_so),
        cmocka_unit_test(a_ring_that_never_closes_says_so_without_pins),
        cmocka_unit_test(formulas_that_cannot_be_met_are_named),
        cmocka_unit_test(a_dyad_that_just_reaches_assembles_at_its_dead_point),
        cmocka_unit_test(two_pins_on_one_freedom_are_told),
        cmocka_unit_test(contradictory_rates_are_told),
        cmocka_unit_test(two_closures_a_millimetre_apart_are_unreachable_with_half_of_it_in_each),
        cmocka_unit_test(a_pin_on_the_joint_that_closes_the_loop_is_refused),
        cmocka_unit_test(free_rates_change_least_by_mass),
        cmocka_unit_test(redundant_loop_rows_are_counted_and_harmless),
        cmocka_unit_test(a_scene_without_loops_needs_no_closing),
        cmocka_unit_test(every_shipped_scene_assembles),
        cmocka_unit_test(the_mode_watch_sees_a_dead_point_pass),
        cmocka_unit_test(a_tilted_mechanism_out_of_reach_is_explained_in_its_own_plane),
        cmocka_unit_test(a_moving_constraint_sets_the_speed_and_the_acceleration),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(a_ladder_of_two_hundred_loops_assembles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
