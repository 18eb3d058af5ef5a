// SPDX-License-Identifier: GPL-3.0-or-later
// Accelerations in lanes beside those of one state at a time: the same bits, or left to the latter.
#include "dynamics/evaluate/accel_lanes.h"
#include "support/alloc.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { BLOCKS = 8, MAX_N = 64 };

static double next(uint64_t *x) {
    *x = *x * 6364136223846793005ull + 1442695040888963407ull;
    return (double)(*x >> 11) * 0x1p-52 - 1;
}

typedef struct states {
    double q[HN_LANES][MAX_N], v[HN_LANES][MAX_N];
} states;

/// States around the start, some of them as far off as a run that goes wrong gets; the loops stand
/// open there, which accelerations do not mind.
static void fill(const hn_model *m, uint64_t *x, states *s, hn_accel_lanes *l) {
    for (int k = 0; k < HN_LANES; k++) {
        const double reach = k % 8 == 7 ? 1e6 : 0.3;
        for (int i = 0; i < m->info.nq; i++) {
            s->q[k][i] = m->q[i] + reach * next(x);
            l->q[HN_LANES * i + k] = s->q[k][i];
        }
        for (int i = 0; i < m->info.nv; i++) {
            s->v[k][i] = k % 16 == 3 ? (double)NAN : m->v[i] + reach * next(x);
            l->v[HN_LANES * i + k] = s->v[k][i];
        }
        l->t[k] = 0.1 * k;
        l->alpha[k] = 5 + k;
        l->beta[k] = 7 - k;
    }
}

/// Compares the lanes that are sure; returns how many these are.
static int compare(const hn_model *m, hn_accel *accel, const hn_accel_lanes *l, hn_lane_bits sure,
                   const states *s) {
    int n = 0;
    for (int k = 0; k < HN_LANES; k++) {
        double a[MAX_N];
        if (!(sure >> k & 1)) {
            continue;
        }
        n++;
        assert_int_equal(
            hn_accel_eval(accel, 0.1 * k, s->q[k], s->v[k], 5 + k, 7 - k, a, NULL, NULL), HN_OK);
        for (int i = 0; i < m->info.nv; i++) {
            assert_memory_equal(&a[i], &hn_accel_lanes_a(l, i)[k], sizeof a[i]);
        }
    }
    return n;
}

static void check_scene(const char *name, hn_lanes_set set, bool baumgarte) {
    hn_model m;
    hn_accel *accel;
    hn_accel_lanes lanes;
    states s;
    uint64_t x = 3;
    int sure = 0;
    hn_model_open_closed(&m, name, NULL);
    assert_true(m.info.nq <= MAX_N && m.info.nv <= MAX_N);
    assert_int_equal(
        hn_accel_create(m.sys, &(hn_accel_opts){.baumgarte = baumgarte}, m.arena, &accel), HN_OK);
    assert_true(hn_accel_has_lanes(accel));
    assert_int_equal(hn_accel_lanes_create(accel, set, m.arena, &lanes), HN_OK);

    for (int block = 0; block < BLOCKS; block++) {
        fill(&m, &x, &s, &lanes);
        const long before = hn_alloc_count();
        const hn_lane_bits bits = hn_accel_lanes_eval(&lanes);
        assert_int_equal(hn_alloc_count(), before);
        sure += compare(&m, accel, &lanes, bits, &s);
        for (int k = 3; k < HN_LANES; k += 16) { // speeds that are not numbers
            assert_false(bits >> k & 1);
        }
    }
    assert_true(2 * sure > BLOCKS * HN_LANES); // most states are ordinary ones
    hn_accel_lanes_free(&lanes);
    hn_accel_free(accel);
    hn_model_close(&m);
}

static void lanes_have_the_bits_of_single_states(void **state) {
    (void)state;
    static const char *const scenes[] = {
        "fb0",          "four-bar", "five-bar",           "slider-crank",
        "watt-six-bar", "rssr",     "seven-body-squeezer"};
    for (int set = 0; set <= (int)hn_lanes_set_best(); set++) {
        for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
            check_scene(scenes[i], (hn_lanes_set)set, i % 2);
        }
    }
}

/// Redundant rows, a pivot that is lost: no lane may claim the tape's answer.
static void lanes_in_doubt_are_left_out(void **state) {
    (void)state;
    hn_model m;
    hn_accel *accel;
    hn_accel_lanes lanes;
    hn_model_open_closed(&m, "parallelogram", NULL);
    assert_int_equal(hn_accel_create(m.sys, &(hn_accel_opts){0}, m.arena, &accel), HN_OK);
    assert_int_equal(hn_accel_lanes_create(accel, hn_lanes_set_best(), m.arena, &lanes), HN_OK);

    // flat: all links on one line, where two rows of J depend on each other
    double q[MAX_N], v[MAX_N] = {0}, a[MAX_N];
    hn_accel_info info;
    for (int i = 0; i < m.info.nq; i++) {
        q[i] = 0;
        for (int k = 0; k < HN_LANES; k++) {
            lanes.q[HN_LANES * i + k] = k % 2 ? m.q[i] : 0;
        }
    }
    assert_int_equal(hn_accel_eval(accel, 0, q, v, 0, 0, a, NULL, &info), HN_OK);
    assert_true(info.fallback || info.refinements > 0);
    assert_int_equal(hn_accel_lanes_eval(&lanes), 0xaaaaaaaau);
    hn_accel_lanes_free(&lanes);
    hn_accel_free(accel);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lanes_have_the_bits_of_single_states),
        cmocka_unit_test(lanes_in_doubt_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
