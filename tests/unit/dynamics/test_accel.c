// SPDX-License-Identifier: GPL-3.0-or-later
// The worth of the multipliers of a state, told from the rank and the condition of K.

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "support/alloc.h"
#include "support/mechanism.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { MAX_NV = 8, MAX_NC = 8 };

// A bead where two rails cross at the angle e: J J' has the eigenvalues 1 -+ cos e, so that the
// 1-norm condition of K is 6 / e^2 where e is small: 1e13 at 7.7e-7.
static const char RAILS[] =
    "{\"holonom\": 1, \"name\": \"rails\", \"title\": \"rails\","
    " \"parameters\": {\"e\": {\"value\": 1, \"unit\": \"rad\", \"min\": 0, \"max\": 2}},"
    " \"lagrangian\": {\"coordinates\": [{\"name\": \"x\", \"rate\": \"u\", \"unit\": \"m\"},"
    " {\"name\": \"y\", \"rate\": \"v\", \"unit\": \"m\"}],"
    " \"kinetic\": \"(u^2 + v^2)/2\", \"potential\": \"9.81*y\","
    " \"constraints\": [{\"name\": \"level\", \"formula\": \"y\"},"
    " {\"name\": \"inclined\", \"formula\": \"y*cos(e) - x*sin(e)\"}]},"
    " \"start\": {\"positions\": {\"x\": 0, \"y\": 0}, \"rates\": {\"u\": 0, \"v\": 0}},"
    " \"duration\": 1, \"step\": 0.01}";

/// The mark at a state of a model, and the condition there.
static hn_multiplier_mark mark_at(const hn_model *m, hn_accel *accel, const double *q,
                                  double *condition) {
    double a[MAX_NV], lambda[MAX_NC], v[MAX_NV] = {0};
    hn_accel_info info;
    assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, lambda, &info), HN_OK);
    assert_int_equal(hn_accel_condition(accel, 0, q, v, condition), HN_OK);
    const long before = hn_alloc_count();
    const hn_multiplier_mark mark = hn_accel_mark(accel, 0, q, v, &info);
    assert_int_equal(hn_alloc_count(), before);
    assert_true(m->info.nv <= MAX_NV && m->info.nc <= MAX_NC);
    return mark;
}

static hn_accel *create_accel(const hn_model *m) {
    hn_accel *accel = NULL;
    assert_int_equal(hn_accel_create(m->sys, &(hn_accel_opts){.want_lambda = 1}, m->arena, &accel),
                     HN_OK);
    return accel;
}

static void close_accel(hn_model *m, hn_accel *accel) {
    hn_accel_free(accel);
    hn_model_close(m);
}

static void rails_that_all_but_coincide_leave_no_digit(void **state) {
    (void)state;
    static const struct {
        const char *setting;
        double e;
        hn_multiplier_mark mark;
    } rails[] = {
        {"e=1", 1, HN_MULTIPLIERS_DETERMINED},       {"e=1e-3", 1e-3, HN_MULTIPLIERS_DETERMINED},
        {"e=1e-6", 1e-6, HN_MULTIPLIERS_DETERMINED}, {"e=6e-7", 6e-7, HN_MULTIPLIERS_LOST},
        {"e=1e-8", 1e-8, HN_MULTIPLIERS_LOST},       {"e=0", 0, HN_MULTIPLIERS_ONE_OF_MANY}};
    for (size_t k = 0; k < sizeof rails / sizeof *rails; k++) {
        hn_model m;
        double condition;
        hn_model_open_text(&m, RAILS, rails[k].setting);
        assert_int_equal(m.status, HN_OK);
        hn_accel *accel = create_accel(&m);
        assert_int_equal(mark_at(&m, accel, m.q, &condition), rails[k].mark);
        if (rails[k].e > 0 && rails[k].e < 1) { // of an estimate, though here it is exact
            assert_rel(condition * rails[k].e * rails[k].e, 6, 0.01);
        }
        close_accel(&m, accel);
    }
}

static void a_parallelogram_that_lies_flat_leaves_one_choice_of_many(void **state) {
    (void)state;
    static const struct {
        const char *setting;
        hn_multiplier_mark mark;
    } poses[] = {{"th_0=1e-3", HN_MULTIPLIERS_DETERMINED}, {"th_0=0", HN_MULTIPLIERS_ONE_OF_MANY}};
    for (int k = 0; k < 2; k++) {
        hn_model m;
        double condition;
        hn_model_open_closed(&m, "parallelogram", poses[k].setting);
        hn_accel *accel = create_accel(&m);
        assert_int_equal(mark_at(&m, accel, m.q, &condition), poses[k].mark);
        close_accel(&m, accel);
    }
}

static void rows_written_twice_leave_one_choice_of_many(void **state) {
    (void)state;
    static const struct {
        const char *scene;
        hn_multiplier_mark mark;
    } scenes[] = {{"fb0", HN_MULTIPLIERS_DETERMINED},
                  {"fb0-redundant", HN_MULTIPLIERS_ONE_OF_MANY}};
    for (int k = 0; k < 2; k++) {
        hn_model m;
        double condition;
        hn_model_open_closed(&m, scenes[k].scene, NULL);
        hn_accel *accel = create_accel(&m);
        assert_int_equal(mark_at(&m, accel, m.q, &condition), scenes[k].mark);
        assert_true(condition < 1e4);
        close_accel(&m, accel);
    }
}

/// A state of Bennett's linkage by its closed form, tan(th1/2) tan(th2/2) = k and th4 = th2, each
/// entry off by up to `off`.
static void bennett_state(const hn_model *m, double th1, double w1, double off, unsigned *seed,
                          double *q, double *v) {
    const double al = 0.6, be = 1.2, k = sin((be + al) / 2) / sin((be - al) / 2);
    const double th2 = 2 * atan(k / tan(th1 / 2)), w2 = -w1 * sin(th2) / sin(th1);
    double user_q[3], user_v[3];
    const char *const names[3] = {"th1", "th2", "th4"};
    const double angles[3] = {th1, th2, th2}, rates[3] = {w1, w2, w2};
    for (int i = 0; i < 3; i++) {
        const int at = hn_model_user(m, names[i]);
        user_q[at] = angles[i] + off * random_signed(seed);
        user_v[at] = rates[i] + off * w1 * random_signed(seed);
    }
    hn_system_from_user(m->sys, user_q, q);
    hn_system_rates_from_user(m->sys, user_v, v);
}

// Stages of an explicit step lie beside the closed set, where dependent rows disagree. At th1 = pi
// two of the five rows are short and all accelerations vanish; the configuration is regular all the
// same (sigma_max / sigma_min = 13 at the most).
static void dependent_rows_beside_the_closed_set_are_no_contradiction(void **state) {
    (void)state;
    static const double offs[] = {0, 1e-13, 1e-10, 1e-8, 1e-6, 1e-4};
    hn_model m;
    unsigned seed = 7;
    hn_model_open_closed(&m, "bennett", "g=0");
    hn_accel *accel = create_accel(&m);
    for (double th1 = 0.05; th1 < 6.2; th1 += 0.0137) {
        double q[3], v[3], a[3], closed[3], lambda[5];
        hn_accel_info info;
        for (size_t k = 0; k < sizeof offs / sizeof *offs; k++) {
            bennett_state(&m, th1, 4, offs[k], &seed, q, v);
            assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, lambda, &info), HN_OK);
            assert_int_equal(info.rank, 2);
            for (int i = 0; i < 3 && k > 0; i++) {
                // a moves by its derivatives times the error of the state: below 1e4 / s^2 here
                assert_near(a[i], closed[i], 1e-10 + 1e4 * offs[k]);
            }
            memcpy(closed, k == 0 ? a : closed, sizeof closed);
        }
    }
    close_accel(&m, accel);
}

/// Accelerations at a state, with a report and without: the same status, and the same bits.
static int same_without_report(hn_accel *accel, int n, int nc, const double *q, const double *v) {
    double a[MAX_NV], b[MAX_NV], lambda[MAX_NC], mu[MAX_NC];
    hn_accel_info info;
    const hn_status with = hn_accel_eval(accel, 0, q, v, 0, 0, a, lambda, &info);
    assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, b, mu, NULL), with);
    if (with == HN_OK) {
        assert_memory_equal(a, b, (size_t)n * sizeof *a);
        assert_memory_equal(lambda, mu, (size_t)nc * sizeof *mu);
    }
    return with == HN_OK && (info.fallback || info.pivot_ratio < HN_PIVOT_DOUBT);
}

// Without a report the answer of the tape is taken at once where it is sure. From the regular poses
// of a parallelogram to the flat one that must be all of the same: the tape, the tape refined, and
// the solve by least squares.
static void the_answer_does_not_depend_on_whether_a_report_is_asked_for(void **state) {
    (void)state;
    hn_model m;
    hn_model_open_closed(&m, "parallelogram", NULL);
    hn_accel *accel = create_accel(&m);
    int doubtful = 0, states = 0;
    for (double th = 1; th > 1e-12; th *= 0.5) {
        const double q[] = {th, 0, th}, v[] = {2, 0, 2};
        doubtful += same_without_report(accel, m.info.nv, m.info.nc, q, v);
        states++;
    }
    assert_true(doubtful > 0 && doubtful < states);

    // a state that is not finite has no answer either way
    const double q[] = {1, 0, (double)NAN}, v[] = {2, 0, 2};
    same_without_report(accel, m.info.nv, m.info.nc, q, v);
    close_accel(&m, accel);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rails_that_all_but_coincide_leave_no_digit),
        cmocka_unit_test(a_parallelogram_that_lies_flat_leaves_one_choice_of_many),
        cmocka_unit_test(rows_written_twice_leave_one_choice_of_many),
        cmocka_unit_test(dependent_rows_beside_the_closed_set_are_no_contradiction),
        cmocka_unit_test(the_answer_does_not_depend_on_whether_a_report_is_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
