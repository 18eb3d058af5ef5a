// SPDX-License-Identifier: GPL-3.0-or-later
// Large mechanisms use lists in place of dense matrices: M and J by their entries, rates by a tree.

#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/rate_tree.h"
#include "dynamics/evaluate/eval.h"
#include "support/model.h"
#include "support/near.h"

static const struct {
    const char *scene, *setting;
} SCENES[] = {{"fb0", NULL},    {"fb0-lagrangian", NULL}, {"n-four-bar", "N=7"},
              {"ring", "n=9"},  {"stewart-6-6", NULL},    {"seven-body-squeezer", NULL},
              {"bennett", NULL}};
enum { N_SCENES = sizeof SCENES / sizeof *SCENES };

static void lists_spread_to_the_bits_of_the_dense_matrices(void **state) {
    (void)state;
    for (int k = 0; k < N_SCENES; k++) {
        hn_model m;
        hn_eval *dense, *listed;
        hn_model_open_closed(&m, SCENES[k].scene, SCENES[k].setting);
        const unsigned terms = HN_TERM_M | HN_TERM_J | HN_TERM_F;
        assert_int_equal(hn_eval_create(m.sys, terms, m.arena, &dense), HN_OK);
        assert_int_equal(hn_eval_create_listed(m.sys, terms, m.arena, &listed), HN_OK);
        hn_eval_run(dense, 0, m.q, m.v);
        hn_eval_run(listed, 0, m.q, m.v);

        const hn_term matrices[] = {HN_TERM_M, HN_TERM_J};
        const size_t nv = (size_t)m.info.nv, rows[] = {nv, (size_t)m.info.nc};
        for (int i = 0; i < 2; i++) {
            double *spread = hn_arena_doubles(m.arena, rows[i] * nv);
            hn_eval_spread(listed, matrices[i], spread);
            assert_memory_equal(spread, hn_eval_get(dense, matrices[i]),
                                rows[i] * nv * sizeof *spread);
        }
        assert_memory_equal(hn_eval_get(listed, HN_TERM_F), hn_eval_get(dense, HN_TERM_F),
                            nv * sizeof(double));
        hn_eval_free(dense);
        hn_eval_free(listed);
        hn_model_close(&m);
    }
}

static void the_tree_of_rates_is_the_map_from_the_users(void **state) {
    (void)state;
    for (int k = 0; k < N_SCENES; k++) {
        hn_model m;
        hn_rate_tree tree;
        hn_model_open_closed(&m, SCENES[k].scene, SCENES[k].setting);
        assert_int_equal(hn_rate_tree_init(&tree, m.sys, m.arena), HN_OK);
        const int n = m.info.nv;
        double *user = hn_arena_doubles(m.arena, (size_t)n);
        double *rates = hn_arena_doubles(m.arena, (size_t)n);
        for (int j = 0; j < n; j++) {
            user[j] = 1;
            hn_system_rates_from_user(m.sys, user, rates);
            user[j] = 0;
            for (int i = 0; i < n; i++) {
                assert_true(hn_rate_tree_share(&tree, i, j) == rates[i]);
            }
        }
        hn_model_close(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_spread_to_the_bits_of_the_dense_matrices),
        cmocka_unit_test(the_tree_of_rates_is_the_map_from_the_users),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
