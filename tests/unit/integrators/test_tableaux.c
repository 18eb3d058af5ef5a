// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "integrators/explicit/tableau.h"

#include <math.h>

// The order conditions of Butcher, one per rooted tree: Hairer, Norsett & Wanner 1993, table
// II.2.1.

enum { MAX_STAGES = 12, N_CONDITIONS = 17 };
#define ROUNDING 2e-14 // sums of seven terms of size up to 12

static const hn_tableau *const tableaux[] = {&hn_tableau_euler, &hn_tableau_heun, &hn_tableau_rk4,
                                             &hn_tableau_dopri5, &hn_tableau_dop853};
enum { N_TABLEAUX = sizeof tableaux / sizeof tableaux[0] };

static void times_A(const hn_tableau *t, const double *x, double *out) {
    for (int i = 0; i < t->stages; i++) {
        out[i] = 0;
        for (int j = 0; j < t->stages; j++) {
            out[i] += t->A[i * (t->stages + t->extra) + j] * x[j];
        }
    }
}

static void product(int n, const double *x, const double *y, double *out) {
    for (int i = 0; i < n; i++) {
        out[i] = x[i] * y[i];
    }
}

// one condition: b . x = value for a tree of that order
typedef struct condition {
    int order;
    double value;
    double x[MAX_STAGES];
} condition;

static void conditions(const hn_tableau *t, condition out[N_CONDITIONS]) {
    const int n = t->stages;
    double one[MAX_STAGES] = {0}, c[MAX_STAGES] = {0}, c2[MAX_STAGES] = {0}, c3[MAX_STAGES] = {0},
           Ac[MAX_STAGES] = {0};
    double Ac2[MAX_STAGES], AAc[MAX_STAGES], cAc[MAX_STAGES];
    for (int i = 0; i < n; i++) {
        one[i] = 1;
        c[i] = t->c[i];
    }
    product(n, c, c, c2);
    product(n, c2, c, c3);
    times_A(t, c, Ac);
    times_A(t, c2, Ac2);
    times_A(t, Ac, AAc);
    product(n, c, Ac, cAc);
    static const struct {
        int order;
        double value;
    } head[N_CONDITIONS] = {
        {1, 1},        {2, 1.0 / 2},  {3, 1.0 / 3},  {3, 1.0 / 6},  {4, 1.0 / 4},  {4, 1.0 / 8},
        {4, 1.0 / 12}, {4, 1.0 / 24}, {5, 1.0 / 5},  {5, 1.0 / 10}, {5, 1.0 / 20}, {5, 1.0 / 15},
        {5, 1.0 / 20}, {5, 1.0 / 30}, {5, 1.0 / 40}, {5, 1.0 / 60}, {5, 1.0 / 120}};
    for (int k = 0; k < N_CONDITIONS; k++) {
        out[k].order = head[k].order;
        out[k].value = head[k].value;
    }
    product(n, one, one, out[0].x);
    product(n, c, one, out[1].x);
    product(n, c2, one, out[2].x);
    product(n, Ac, one, out[3].x);
    product(n, c3, one, out[4].x);
    product(n, cAc, one, out[5].x);
    product(n, Ac2, one, out[6].x);
    product(n, AAc, one, out[7].x);
    product(n, c2, c2, out[8].x);
    product(n, c2, Ac, out[9].x);
    product(n, Ac, Ac, out[10].x);
    product(n, c, Ac2, out[11].x);
    times_A(t, c3, out[12].x);
    product(n, c, AAc, out[13].x);
    times_A(t, cAc, out[14].x);
    times_A(t, Ac2, out[15].x);
    times_A(t, AAc, out[16].x);
}

static double defect(const hn_tableau *t, const double *b, const condition *k) {
    double sum = 0;
    for (int i = 0; i < t->stages; i++) {
        sum += b[i] * k->x[i];
    }
    return fabs(sum - k->value);
}

static double worst_defect(const hn_tableau *t, const double *b, int order) {
    condition all[N_CONDITIONS];
    double worst = 0;
    conditions(t, all);
    for (int k = 0; k < N_CONDITIONS; k++) {
        if (all[k].order == order) {
            worst = fmax(worst, defect(t, b, &all[k]));
        }
    }
    return worst;
}

static void rows_of_A_sum_to_c_and_A_is_strictly_lower(void **state) {
    (void)state;
    for (int k = 0; k < N_TABLEAUX; k++) {
        const hn_tableau *t = tableaux[k];
        const int all = t->stages + t->extra;
        for (int i = 0; i < all; i++) {
            double sum = 0;
            for (int j = 0; j < all; j++) {
                sum += t->A[i * all + j];
                assert_true(j < i || t->A[i * all + j] == 0);
            }
            assert_near(sum, t->c[i], ROUNDING);
        }
    }
}

static void each_tableau_has_the_stated_order_and_not_one_more(void **state) {
    (void)state;
    for (int k = 0; k < N_TABLEAUX; k++) {
        const hn_tableau *t = tableaux[k];
        for (int order = 1; order <= t->order; order++) {
            assert_near(worst_defect(t, t->b, order), 0, ROUNDING);
        }
        if (t->order < 5) {
            assert_true(worst_defect(t, t->b, t->order + 1) > 1e-3);
        }
    }
}

static void embedded_solution_must_have_order(const hn_tableau *t, const double *e, int stated) {
    double b_hat[MAX_STAGES];
    for (int i = 0; i < t->stages; i++) {
        b_hat[i] = t->b[i] - e[i];
    }
    for (int order = 1; order <= stated; order++) {
        assert_near(worst_defect(t, b_hat, order), 0, ROUNDING);
    }
    if (stated < 5) {
        assert_true(worst_defect(t, b_hat, stated + 1) > 1e-5);
    }
}

static void embedded_solutions_have_the_stated_order_and_not_one_more(void **state) {
    (void)state;
    int found = 0;
    for (int k = 0; k < N_TABLEAUX; k++) {
        const hn_tableau *t = tableaux[k];
        if (t->e) {
            embedded_solution_must_have_order(t, t->e, t->embedded_order);
            found++;
        }
        if (t->e2) {
            embedded_solution_must_have_order(t, t->e2, t->embedded_order2);
            found++;
        }
    }
    assert_int_equal(found, 3);
}

// A rooted tree as the levels of its nodes in depth-first order, root at level 0. Its elementary
// weights are those of its branches, each taken through A, multiplied; its density is its size
// times the densities of its branches.
enum { MAX_ORDER = 9 };
typedef struct weighed {
    double x[MAX_STAGES], density;
} weighed;

static weighed weigh(const hn_tableau *t, int size, const int *level) {
    weighed out = {.density = size};
    for (int i = 0; i < t->stages; i++) {
        out.x[i] = 1;
    }
    for (int start = 1, end; start < size; start = end) {
        for (end = start + 1; end < size && level[end] > level[start];) {
            end++;
        }
        const weighed branch = weigh(t, end - start, level + start);
        double through[MAX_STAGES];
        times_A(t, branch.x, through);
        product(t->stages, out.x, through, out.x);
        out.density *= branch.density;
    }
    return out;
}

// the next tree of this size; 0 after the last. Source: Beyer & Hedetniemi 1980, Constant time
// generation of rooted trees
static int next_tree(int size, int *level) {
    int p = size - 1;
    while (p > 0 && level[p] == 1) {
        p--;
    }
    if (p <= 0) {
        return 0;
    }
    int q = p - 1;
    while (level[q] != level[p] - 1) {
        q--;
    }
    for (int i = p; i < size; i++) {
        level[i] = level[i - (p - q)];
    }
    return 1;
}

// largest |density b . x - 1| over all trees of this size, and how many there are
static double worst_tree(const hn_tableau *t, int size, int *n_trees) {
    int level[MAX_ORDER];
    double worst = 0;
    for (int i = 0; i < size; i++) {
        level[i] = i;
    }
    *n_trees = 0;
    do {
        const weighed tree = weigh(t, size, level);
        double sum = 0;
        for (int i = 0; i < t->stages; i++) {
            sum += t->b[i] * tree.x[i];
        }
        worst = fmax(worst, fabs(tree.density * sum - 1));
        ++*n_trees;
    } while (next_tree(size, level));
    return worst;
}

static void every_rooted_tree_up_to_the_order_is_met_and_some_beyond_is_not(void **state) {
    (void)state;
    // Hairer, Norsett & Wanner 1993, table II.2.2
    static const int known[MAX_ORDER] = {1, 1, 2, 4, 9, 20, 48, 115, 286};
    for (int k = 0; k < N_TABLEAUX; k++) {
        const hn_tableau *t = tableaux[k];
        for (int order = 1; order <= t->order + 1; order++) {
            int n = 0;
            const double worst = worst_tree(t, order, &n);
            assert_int_equal(n, known[order - 1]);
            if (order <= t->order) {
                assert_near(worst, 0, 5e-11); // densities go up to 8!
            } else {
                assert_true(worst > 1e-2);
            }
        }
    }
}

static void last_stage_of_a_fsal_tableau_is_the_new_point(void **state) {
    (void)state;
    const hn_tableau *t = &hn_tableau_dopri5;
    assert_true(t->fsal);
    for (int j = 0; j < t->stages; j++) {
        assert_true(t->A[(t->stages - 1) * t->stages + j] == t->b[j]);
    }
    assert_true(t->c[t->stages - 1] == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_of_A_sum_to_c_and_A_is_strictly_lower),
        cmocka_unit_test(each_tableau_has_the_stated_order_and_not_one_more),
        cmocka_unit_test(embedded_solutions_have_the_stated_order_and_not_one_more),
        cmocka_unit_test(every_rooted_tree_up_to_the_order_is_met_and_some_beyond_is_not),
        cmocka_unit_test(last_stage_of_a_fsal_tableau_is_the_new_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
