// SPDX-License-Identifier: GPL-3.0-or-later
// The public interface against facts from outside: the pendulum, and what it promises on failure.
#include "session/face/holonom.h"

#include "support/near.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// a pendulum of length l at rest at 0.5 rad: th'' = -(g / l) sin th
static const char PENDULUM[] =
    "{\"holonom\": 1, \"name\": \"pendulum\", \"parameters\": {\"l\": {\"value\": 2, \"unit\": "
    "\"m\", \"min\": 0.1}}, \"gravity\": [0, -9.81, 0], \"bodies\": [{\"name\": \"bob\", \"mass\": "
    "3, \"com\": [0, \"-l\", 0]}], \"joints\": [{\"name\": \"O\", \"type\": \"revolute\", "
    "\"parent\": {\"body\": \"ground\"}, \"child\": {\"body\": \"bob\"}, \"coordinate\": \"th\", "
    "\"rate\": \"w\"}], \"start\": {\"positions\": {\"th\": 0.5}, \"rates\": {\"w\": 0}}}";

static holonom_mechanism *pendulum(void) {
    holonom_mechanism *m = NULL;
    holonom_fault fault;
    assert_int_equal(holonom_load_text(PENDULUM, strlen(PENDULUM), &m, &fault), HOLONOM_OK);
    return m;
}

static double acceleration(holonom_mechanism *m, double th) {
    double a = hn_poison(), v = 0;
    assert_int_equal(holonom_accelerations(m, 0, &th, &v, &a, NULL, NULL), HOLONOM_OK);
    return a;
}

static void a_pendulum_has_one_coordinate_and_its_names(void **state) {
    (void)state;
    holonom_mechanism *m = pendulum();
    const holonom_sizes s = holonom_get_sizes(m);
    double q = hn_poison(), v = hn_poison();
    assert_int_equal(s.coordinates, 1);
    assert_int_equal(s.constraints, 0);
    assert_int_equal(s.dof, 1);
    assert_string_equal(holonom_coordinate_name(m, 0), "th");
    assert_string_equal(holonom_rate_name(m, 0), "w");
    assert_null(holonom_coordinate_name(m, 1));
    holonom_start(m, &q, &v);
    assert_near(q, 0.5, 0);
    assert_near(v, 0, 0);
    holonom_free(m);
}

static void a_parameter_changes_the_equations_and_a_bad_one_changes_nothing(void **state) {
    (void)state;
    holonom_mechanism *m = pendulum();
    holonom_fault fault;
    assert_rel(acceleration(m, 1.2), -9.81 / 2 * sin(1.2), 1e-14);
    assert_int_equal(holonom_set(m, "l", 0.5, &fault), HOLONOM_OK);
    assert_rel(acceleration(m, 1.2), -9.81 / 0.5 * sin(1.2), 1e-14);

    // beyond its range, where it has another sign, and a name that is nearly right
    assert_int_equal(holonom_set(m, "l", 0.001, &fault), HOLONOM_OK);
    assert_rel(acceleration(m, 1.2), -9.81 / 0.001 * sin(1.2), 1e-14);
    assert_int_equal(holonom_set(m, "l", 0.5, &fault), HOLONOM_OK);
    assert_int_equal(holonom_set(m, "l", -1, &fault), HOLONOM_INPUT);
    assert_non_null(strstr(fault.message, "l = -1 m must be above 0"));
    assert_int_equal(holonom_set(m, "ll", 1, &fault), HOLONOM_INPUT);
    assert_rel(acceleration(m, 1.2), -9.81 / 0.5 * sin(1.2), 1e-14);

    // set again: the last value counts
    assert_int_equal(holonom_set(m, "l", 4, &fault), HOLONOM_OK);
    assert_rel(acceleration(m, 1.2), -9.81 / 4 * sin(1.2), 1e-14);
    holonom_free(m);
}

static void a_run_keeps_its_mechanism(void **state) {
    (void)state;
    holonom_mechanism *m = pendulum();
    holonom_run *run = NULL;
    holonom_sample s, again;
    assert_int_equal(holonom_run_create(m, "index1@dop853:rtol=1e-12", &run, NULL), HOLONOM_OK);
    assert_int_equal(holonom_run_to(run, 0.5, &s, NULL), HOLONOM_OK);
    assert_int_equal(holonom_set(m, "l", 0.5, NULL), HOLONOM_OK);
    holonom_free(m);

    // a quarter of the period 4 sqrt(l / g) K(sin 0.25) of the long pendulum: it hangs straight
    const double quarter = sqrt(2 / 9.81) * 1.5956974244; // K(k) = pi / (2 agm(1, cos 0.25))
    assert_int_equal(holonom_run_to(run, quarter, &again, NULL), HOLONOM_OK);
    assert_near(again.q[0], 0, 1e-8); // K to 10 digits, rtol of the run
    assert_near(again.energy_change, 0, 1e-9);
    const holonom_result r = holonom_run_result(run);
    assert_int_equal(r.status, HOLONOM_OK);
    assert_true(r.steps > 0 && r.evaluations > r.steps && r.operations > 0);
    holonom_run_free(run);
}

static void many_runs_end_as_runs_alone_and_keep_their_energy(void **state) {
    (void)state;
    enum { N = 100 };
    holonom_mechanism *m = pendulum();
    holonom_run *run = NULL;
    holonom_sample s;
    holonom_ending end[N];
    double q[N], v[N];
    for (int k = 0; k < N; k++) {
        q[k] = 0.5 + 0.01 * k;
        v[k] = 0.02 * k;
    }
    v[8] = (double)NAN;
    assert_int_equal(holonom_run_many(m, "index1@rk4:h=1e-3", N, 1, q, v, end, NULL), HOLONOM_OK);

    // the first starts where a run does
    assert_int_equal(holonom_run_create(m, "index1@rk4:h=1e-3", &run, NULL), HOLONOM_OK);
    assert_int_equal(holonom_run_to(run, 1, &s, NULL), HOLONOM_OK);
    assert_memory_equal(&s.q[0], &q[0], sizeof q[0]);
    assert_memory_equal(&s.v[0], &v[0], sizeof v[0]);
    holonom_run_free(run);

    // w^2 / 2 - (g / l) cos th stays; the step's error is of the order of h^4
    for (int k = 0; k < N; k++) {
        if (k == 8) {
            assert_int_equal(end[k].status, HOLONOM_INPUT);
            continue;
        }
        const double th = 0.5 + 0.01 * k, w = 0.02 * k, rate = 9.81 / 2;
        assert_int_equal(end[k].status, HOLONOM_OK);
        assert_int_equal(end[k].steps, 1000);
        assert_near(v[k] * v[k] / 2 - rate * cos(q[k]), w * w / 2 - rate * cos(th), 1e-11);
    }
    holonom_free(m);
}

static void many_runs_of_a_method_that_remembers_are_refused(void **state) {
    (void)state;
    holonom_mechanism *m = pendulum();
    holonom_fault fault;
    holonom_ending end;
    double q = 0.5, v = 0;
    assert_int_equal(holonom_run_many(m, "projection@rk4:h=1e-3", 1, 1, &q, &v, &end, &fault),
                     HOLONOM_INPUT);
    assert_non_null(strstr(fault.message, "cannot step side by side"));
    assert_int_equal(holonom_run_many(m, "index1@rk4:h=1e-3", 1, HUGE_VAL, &q, &v, &end, &fault),
                     HOLONOM_INPUT);
    assert_near(q, 0.5, 0);
    holonom_free(m);
}

static void faults_say_where_and_what(void **state) {
    (void)state;
    holonom_mechanism *m = NULL;
    holonom_fault fault;
    static const char bad[] = "{\"holonom\": 1, \"name\": \"x\", \"bodies\": [], \"joints\": 3}";
    assert_int_equal(holonom_load_text(bad, strlen(bad), &m, &fault), HOLONOM_INPUT);
    assert_string_equal(fault.where, "/joints");
    assert_null(m);
    assert_int_equal(holonom_load("no/such/file.json", &m, &fault), HOLONOM_INPUT);
    assert_non_null(strstr(fault.message, "no/such/file.json"));

    m = pendulum();
    const char *const methods[] = {"index1@rk4:h=1e-2", "index1@rk5:h=1e-2"};
    holonom_result results[2];
    assert_int_equal(holonom_compare(m, methods, 2, 1, results, &fault), HOLONOM_INPUT);
    assert_string_equal(fault.where, "/methods/1");
    assert_int_equal(results[0].steps, 100);
    holonom_free(m);
}

static void nothing_may_be_freed(void **state) {
    (void)state;
    holonom_free(NULL);
    holonom_run_free(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pendulum_has_one_coordinate_and_its_names),
        cmocka_unit_test(a_parameter_changes_the_equations_and_a_bad_one_changes_nothing),
        cmocka_unit_test(a_run_keeps_its_mechanism),
        cmocka_unit_test(many_runs_end_as_runs_alone_and_keep_their_energy),
        cmocka_unit_test(many_runs_of_a_method_that_remembers_are_refused),
        cmocka_unit_test(faults_say_where_and_what),
        cmocka_unit_test(nothing_may_be_freed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
