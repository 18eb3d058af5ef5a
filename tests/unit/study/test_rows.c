// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of J without their zeros: what they give is what the whole rows give, to the last bit.
#include "linalg/dense.h"
#include "study/incidents/rows.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>

enum { MOST = 64 };

/// Velocities of mixed sizes and signs.
static void fill(int n, double *v) {
    for (int i = 0; i < n; i++) {
        v[i] = (i % 2 ? -1 : 1) * (0.3 + 1.7 * i) * pow(10, i % 5 - 2);
    }
}

static void compare_scene(const char *name, const char *setting) {
    hn_model m;
    hn_eval *eval = NULL;
    hn_closure_rows rows;
    double v[MOST], product;
    hn_model_open_closed(&m, name, setting);
    const int nv = m.info.nv, nc = m.info.nc;
    assert_true(nv <= MOST && nc <= MOST && nc > 0);
    assert_int_equal(hn_eval_create_listed(m.sys, HN_TERM_J, m.arena, &eval), HN_OK);
    assert_int_equal(hn_closure_rows_create(eval, nc, m.arena, &rows), HN_OK);

    fill(nv, v);
    hn_eval_run(eval, 0, m.q, v);
    double *J = hn_arena_doubles(m.arena, (size_t)nc * (size_t)nv);
    hn_eval_spread(eval, HN_TERM_J, J);
    for (int i = 0; i < nc; i++) {
        const double *row = J + (size_t)i * (size_t)nv;
        assert_true(hn_closure_rows_length(&rows, i) == hn_norm2(nv, row));

        double most = 0;
        for (int j = 0; j < nv; j++) {
            product = fabs(row[j] * v[j]);
            most = fmax(most, product);
        }
        assert_true(hn_closure_rows_largest(&rows, i, v) == most);
    }
    hn_eval_free(eval);
    hn_model_close(&m);
}

static void rows_without_zeros_give_the_bits_of_whole_rows(void **state) {
    (void)state;
    static const struct {
        const char *scene, *setting;
    } scenes[] = {{"fb0", NULL},
                  {"n-four-bar", "N=20"},
                  {"seven-body-squeezer", NULL},
                  {"bennett", NULL},
                  {"stephenson-six-bar", NULL}};
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        compare_scene(scenes[k].scene, scenes[k].setting);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_without_zeros_give_the_bits_of_whole_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
