// SPDX-License-Identifier: GPL-3.0-or-later
// Assembly of mechanisms of a hundred velocities and more, which is sparse: ladders of
// parallelograms against their closed form, with rows that depend on each other, and pins that
// contradict each other.

#include "base/strbuf.h"
#include "dynamics/analyse/redundancy.h"
#include "dynamics/assembly/assemble_rows.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/svd.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LOOPS = 60, BRACED = 34, MOST = 400 };

/// N + 1 bars stand on the ground, couplers join their tips, and couplers of `braces` more loops
/// their middles; %s are the start positions and rates. Lengths and masses are 1.
static const char LADDER[] =
    "{\"holonom\": 1, \"name\": \"rungs\", \"title\": \"rungs\", \"parameters\": {"
    " \"N\": {\"value\": %d, \"unit\": \"1\", \"min\": 1, \"max\": 500, \"integer\": true}},"
    "\"gravity\": [0, -9.81, 0], \"bodies\": ["
    " {\"for\": {\"i\": [0, \"N\"]}, \"name\": \"bar {i}\", \"mass\": 1, \"com\": [0.5, 0, 0],"
    "  \"inertia\": {\"zz\": \"1/12\"}},"
    " {\"for\": {\"i\": [1, \"N\"]}, \"name\": \"coupler {i}\", \"mass\": 1, \"com\": [0.5, 0, 0],"
    "  \"inertia\": {\"zz\": \"1/12\"}}%s], \"joints\": ["
    " {\"for\": {\"i\": [0, \"N\"]}, \"name\": \"O{i}\", \"type\": \"revolute\", \"parent\":"
    "  {\"body\": \"ground\", \"at\": [\"i\", 0, 0]}, \"child\": {\"body\": \"bar {i}\"},"
    "  \"coordinate\": \"th{i}\", \"rate\": \"w{i}\"},"
    " {\"for\": {\"i\": [1, \"N\"]}, \"name\": \"A{i}\", \"type\": \"revolute\", \"parent\":"
    "  {\"body\": \"bar {i-1}\", \"at\": [1, 0, 0]}, \"child\": {\"body\": \"coupler {i}\"},"
    "  \"coordinate\": \"b{i}\", \"rate\": \"wb{i}\"},"
    " {\"for\": {\"i\": [1, \"N\"]}, \"name\": \"B{i}\", \"type\": \"revolute\", \"parent\":"
    "  {\"body\": \"coupler {i}\", \"at\": [1, 0, 0]}, \"child\": {\"body\": \"bar {i}\","
    "  \"at\": [1, 0, 0]}, \"coordinate\": \"c{i}\", \"rate\": \"wc{i}\", \"cut\": true}%s],"
    "\"start\": {\"positions\": {%s}, \"rates\": {%s}}}";
static const char BRACE_BODIES[] =
    ", {\"for\": {\"i\": [1, \"N\"]}, \"name\": \"brace {i}\", \"mass\": 1, \"com\": [0.5, 0, 0],"
    "  \"inertia\": {\"zz\": \"1/12\"}}";
static const char BRACE_JOINTS[] =
    ", {\"for\": {\"i\": [1, \"N\"]}, \"name\": \"D{i}\", \"type\": \"revolute\", \"parent\":"
    "  {\"body\": \"bar {i-1}\", \"at\": [0.5, 0, 0]}, \"child\": {\"body\": \"brace {i}\"},"
    "  \"coordinate\": \"d{i}\", \"rate\": \"wd{i}\"},"
    " {\"for\": {\"i\": [1, \"N\"]}, \"name\": \"E{i}\", \"type\": \"revolute\", \"parent\":"
    "  {\"body\": \"brace {i}\", \"at\": [1, 0, 0]}, \"child\": {\"body\": \"bar {i}\","
    "  \"at\": [0.5, 0, 0]}, \"coordinate\": \"e{i}\", \"rate\": \"we{i}\", \"cut\": true}";
static const char UPRIGHT[] = "\"th{i}\": {\"for\": {\"i\": [1, \"N\"]}, \"guess\": \"pi/2\"},"
                              "\"b{i}\": {\"for\": {\"i\": [1, \"N\"]}, \"guess\": \"-pi/2\"}";

static void open_ladder(hn_model *m, int n, bool braced, const char *th0, const char *rates) {
    static char json[8192];
    char positions[400];
    (void)snprintf(positions, sizeof positions, "\"th0\": \"%s\", %s%s", th0, UPRIGHT,
                   braced ? ", \"d{i}\": {\"for\": {\"i\": [1, \"N\"]}, \"guess\": \"-pi/2\"}"
                          : "");
    (void)snprintf(json, sizeof json, LADDER, n, braced ? BRACE_BODIES : "",
                   braced ? BRACE_JOINTS : "", positions, rates);
    hn_model_open_text(m, json, NULL);
    assert_true(m->info.nv >= HN_ASSEMBLE_LARGE);
}

static double value_of(const hn_model *m, const double *user, const char *name, int i) {
    char text[16];
    (void)snprintf(text, sizeof text, "%s%d", name, i);
    return user[hn_model_user(m, text)];
}

static void a_ladder_closes_from_a_guess_that_stands_apart_from_its_pin(void **state) {
    (void)state;
    hn_model m;
    open_ladder(&m, LOOPS, false, "pi/2 - 0.4", "\"th0\": -1");
    assert_int_equal(m.status, HN_OK);
    assert_true(m.assembly.gap < 1e-12);
    assert_true(m.assembly.gap_before > 0.1);
    for (int i = 0; i <= LOOPS; i++) {
        assert_near(value_of(&m, m.user_q, "th", i), M_PI / 2 - 0.4, 1e-10);
        assert_near(value_of(&m, m.user_v, "th", i), -1, 1e-10);
    }
    assert_int_equal(m.assembly.freedoms, 1);
    hn_model_close(&m);
}

static void rates_that_are_free_change_least_by_mass(void **state) {
    (void)state;
    hn_model m;
    open_ladder(&m, LOOPS, false, "pi/2", "\"th0\": {\"guess\": -1}");
    assert_int_equal(m.status, HN_OK);
    // with n the motion of the ladder, n' M (v - v0) = 0: bar 0 turned alone, with the first
    // coupler fast to it, (1/3 + 1) against (N + 1)/3 + N
    const double rate = -(4.0 / 3) / ((LOOPS + 1) / 3.0 + LOOPS);
    for (int i = 0; i <= LOOPS; i++) {
        assert_near(value_of(&m, m.user_v, "th", i), rate, 1e-13);
    }
    assert_true(m.assembly.velocity_gap < 1e-14);
    hn_model_close(&m);
}

static void singular_values_are_those_of_the_dense_rows(void **state) {
    (void)state;
    hn_model m;
    open_ladder(&m, LOOPS, false, "pi/2", "\"th0\": -1");
    hn_eval *eval;
    double sigma[MOST];
    assert_int_equal(hn_eval_create(m.sys, HN_TERM_M | HN_TERM_J, m.arena, &eval), HN_OK);
    hn_eval_run(eval, 0, m.q, NULL);
    const int nv = m.info.nv, nc = m.info.nc;
    const double *M = hn_eval_get(eval, HN_TERM_M), *J = hn_eval_get(eval, HN_TERM_J);
    double *scaled = hn_arena_doubles(m.arena, (size_t)nv * (size_t)nc);
    for (int i = 0; i < nc * nv; i++) {
        scaled[i] = J[i] / sqrt(M[(i % nv) * nv + i % nv]);
    }
    assert_int_equal(hn_singular_values(nc, nv, scaled, sigma, m.arena), HN_OK);
    assert_int_equal(m.assembly.rank, nc);
    assert_near(m.assembly.sigma_min / sigma[nc - 1], 1, 1e-6); // it stands apart from the next
    // sixty turns end within the cluster at the upper end
    assert_near(m.assembly.sigma_max / sigma[0], 1, 1e-2);
    hn_eval_free(eval);
    hn_model_close(&m);
}

static void rows_that_depend_on_each_other_are_counted_and_closed(void **state) {
    (void)state;
    hn_model m;
    open_ladder(&m, BRACED, true, "pi/2 - 0.3", "\"th0\": -1");
    assert_int_equal(m.status, HN_OK);
    assert_int_equal(m.assembly.redundant, BRACED); // one of the four rows of each two loops
    assert_int_equal(m.assembly.freedoms, 1);
    assert_true(m.assembly.gap < 1e-11);
    for (int i = 0; i <= BRACED; i++) {
        assert_near(value_of(&m, m.user_q, "th", i), M_PI / 2 - 0.3, 1e-9);
        assert_near(value_of(&m, m.user_v, "th", i), -1, 1e-9);
    }
    hn_model_close(&m);
}

static void pinned_rates_that_contradict_each_other_are_named(void **state) {
    (void)state;
    hn_model m;
    open_ladder(&m, LOOPS, false, "pi/2", "\"th0\": -1, \"th7\": -2");
    assert_int_equal(m.status, HN_ERR_INCONSISTENT);
    assert_non_null(strstr(m.diags.item[0].message, "w7 = -2"));
    hn_model_close(&m);
}

static int count_followers(const hn_model *m) {
    hn_strbuf text;
    int n = 0;
    hn_strbuf_init(&text);
    hn_json_object(&text);
    assert_int_equal(hn_system_redundancy_put(&text, m->sys, 0, m->q), HN_OK);
    for (const char *at = strstr(hn_strbuf_text(&text), "\"row\""); at;
         at = strstr(at + 1, "\"row\"")) {
        n++;
    }
    hn_strbuf_reset(&text);
    return n;
}

static void inspect_names_the_rows_that_follow_from_others(void **state) {
    (void)state;
    hn_model m;
    open_ladder(&m, BRACED, true, "pi/2 - 0.3", "\"th0\": -1");
    assert_int_equal(count_followers(&m), BRACED);
    hn_model_close(&m);
    open_ladder(&m, LOOPS, false, "pi/2 - 0.3", "\"th0\": -1");
    assert_int_equal(count_followers(&m), 0);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ladder_closes_from_a_guess_that_stands_apart_from_its_pin),
        cmocka_unit_test(rates_that_are_free_change_least_by_mass),
        cmocka_unit_test(singular_values_are_those_of_the_dense_rows),
        cmocka_unit_test(rows_that_depend_on_each_other_are_counted_and_closed),
        cmocka_unit_test(inspect_names_the_rows_that_follow_from_others),
        cmocka_unit_test(pinned_rates_that_contradict_each_other_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
