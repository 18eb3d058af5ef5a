#include "support/near.h"

#include "integrators/tableau.h"

#include <math.h>

// The order conditions of Butcher, one per rooted tree: Hairer, Norsett & Wanner 1993, table II.2.1.

enum { MAX_STAGES = 8, N_CONDITIONS = 17 };
#define ROUNDING 2e-14 // sums of seven terms of size up to 12

static const hn_tableau *const tableaux[] = {&hn_tableau_euler, &hn_tableau_heun, &hn_tableau_rk4,
                                             &hn_tableau_dopri5};
enum { N_TABLEAUX = sizeof tableaux / sizeof tableaux[0] };

static void times_A(const hn_tableau *t, const double *x, double *out) {
    for (int i = 0; i < t->stages; i++) {
        out[i] = 0;
        for (int j = 0; j < t->stages; j++) {
            out[i] += t->A[i * t->stages + j] * x[j];
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
        for (int i = 0; i < t->stages; i++) {
            double sum = 0;
            for (int j = 0; j < t->stages; j++) {
                sum += t->A[i * t->stages + j];
                assert_true(j < i || t->A[i * t->stages + j] == 0);
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

static void embedded_solution_has_the_stated_order_and_not_one_more(void **state) {
    (void)state;
    const hn_tableau *t = &hn_tableau_dopri5;
    double b_hat[MAX_STAGES];
    for (int i = 0; i < t->stages; i++) {
        b_hat[i] = t->b[i] - t->e[i];
    }
    for (int order = 1; order <= t->embedded_order; order++) {
        assert_near(worst_defect(t, b_hat, order), 0, ROUNDING);
    }
    assert_true(worst_defect(t, b_hat, t->embedded_order + 1) > 1e-5);
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
        cmocka_unit_test(embedded_solution_has_the_stated_order_and_not_one_more),
        cmocka_unit_test(last_stage_of_a_fsal_tableau_is_the_new_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
