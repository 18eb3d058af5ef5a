// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of products of sines and cosines become sums and differences of angles; values stay.
#include "expr/angles.h"

#include "expr/construct.h"
#include "expr/diff.h"
#include "support/near.h"

#include <math.h>

typedef struct fixture {
    hn_graph *g;
    hn_ex a, b, c, m;
    hn_ex sa, ca, sb, cb, sc, cc;
} fixture;

static void begin(fixture *f) {
    f->g = hn_graph_create();
    assert_non_null(f->g);
    f->a = hn_symbol(f->g, "a", NULL);
    f->b = hn_symbol(f->g, "b", NULL);
    f->c = hn_symbol(f->g, "c", NULL);
    f->m = hn_symbol(f->g, "m", NULL);
    f->sa = hn_sin(f->g, f->a);
    f->ca = hn_cos(f->g, f->a);
    f->sb = hn_sin(f->g, f->b);
    f->cb = hn_cos(f->g, f->b);
    f->sc = hn_sin(f->g, f->c);
    f->cc = hn_cos(f->g, f->c);
}

/// Joins e, checks that its value has not changed, and compares it with what is wanted.
static void joins_to(fixture *f, hn_ex e, hn_ex wanted) {
    const double x[] = {0.7, -1.9, 2.3, 1.7};
    hn_ex joined = e;
    assert_int_equal(hn_angles_join(f->g, &joined, 1), HN_OK);
    const double before = hn_graph_eval(f->g, e, x), after = hn_graph_eval(f->g, joined, x);
    // a few roundings of numbers around 1
    assert_true(fabs(before - after) < 1e-14);
    assert_true(hn_ex_same(joined, wanted));
}

static hn_ex product(fixture *f, hn_ex x, hn_ex y) {
    return hn_mul(f->g, x, y);
}

static void the_four_theorems(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    hn_graph *g = f.g;
    const hn_ex cc = product(&f, f.ca, f.cb), ss = product(&f, f.sa, f.sb);
    const hn_ex sc = product(&f, f.sa, f.cb), cs = product(&f, f.ca, f.sb);
    const hn_ex sum = hn_add(g, f.a, f.b), difference = hn_sub(g, f.a, f.b);
    joins_to(&f, hn_add(g, cc, ss), hn_cos(g, difference));
    joins_to(&f, hn_sub(g, cc, ss), hn_cos(g, sum));
    joins_to(&f, hn_sub(g, ss, cc), hn_neg(hn_cos(g, sum)));
    joins_to(&f, hn_add(g, sc, cs), hn_sin(g, sum));
    joins_to(&f, hn_sub(g, sc, cs), hn_sin(g, difference));
    joins_to(&f, hn_sub(g, cs, sc), hn_neg(hn_sin(g, difference)));
    hn_graph_free(g);
}

static void factors_and_nested_sums(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    hn_graph *g = f.g;

    // m (sin a sin b + cos a cos b), and multiplied out
    const hn_ex pair = hn_add(g, product(&f, f.ca, f.cb), product(&f, f.sa, f.sb));
    const hn_ex cosine = hn_cos(g, hn_sub(g, f.a, f.b));
    joins_to(&f, hn_mul(g, f.m, pair), hn_mul(g, f.m, cosine));

    // cos b (m - sin a) + cos a sin b hides its pair in a product
    const hn_ex hidden = hn_add(g, hn_mul(g, f.cb, hn_sub(g, f.m, f.sa)), product(&f, f.ca, f.sb));
    const hn_ex sine = hn_sin(g, hn_sub(g, f.b, f.a));
    joins_to(&f, hidden, hn_add(g, hn_mul(g, f.m, f.cb), sine));

    // three angles
    const hn_ex first = hn_add(g, product(&f, f.sa, f.cb), product(&f, f.ca, f.sb));
    const hn_ex second = hn_sub(g, product(&f, f.ca, f.cb), product(&f, f.sa, f.sb));
    const hn_ex both = hn_add(g, product(&f, first, f.cc), product(&f, second, f.sc));
    joins_to(&f, both, hn_sin(g, hn_add(g, hn_add(g, f.a, f.b), f.c)));
    hn_graph_free(g);
}

static void what_is_no_pair_stays(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    hn_graph *g = f.g;
    const hn_ex cc = product(&f, f.ca, f.cb), ss = product(&f, f.sa, f.sb);
    const hn_ex cases[] = {
        hn_add(g, cc, hn_scale(2, ss)),         // other numbers
        hn_add(g, cc, hn_mul(g, f.m, ss)),      // other factors
        hn_add(g, cc, product(&f, f.sa, f.sc)), // other angles
        hn_add(g, product(&f, f.sa, f.ca), product(&f, f.sb, f.cb)),
        hn_mul(g, f.m, hn_add(g, f.a, hn_mul(g, f.m, f.b))), // shorter as it is
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        joins_to(&f, cases[i], cases[i]);
    }
    hn_graph_free(g);
}

/// A sum of very many terms is left alone, and costs no time.
static void long_sums_are_left(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    hn_ex e = hn_add(f.g, f.a, f.b);
    for (int i = 0; i < 40; i++) {
        e = hn_mul(f.g, hn_add(f.g, e, f.c), hn_add(f.g, e, f.m)); // 2^40 products
        e = hn_add(f.g, e, f.m);
    }
    hn_ex joined = e;
    assert_int_equal(hn_angles_join(f.g, &joined, 1), HN_OK);
    assert_true(hn_ex_same(joined, e));
    hn_graph_free(f.g);
}

static void a_product_of_sums_has_terms(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    hn_graph *g = f.g;
    hn_ex term[4];
    const hn_ex pair = hn_add(g, product(&f, f.ca, f.cb), product(&f, f.sa, f.sb));
    const hn_ex e = hn_mul(g, f.m, hn_sub(g, pair, f.c));
    assert_int_equal(hn_angles_terms(g, e, term, 4), 2);
    assert_int_equal(hn_angles_terms(g, e, term, 1), 0);
    assert_int_equal(hn_angles_terms(g, e, term, 4), 2);
    const double x[] = {0.7, -1.9, 2.3, 1.7};
    const double sum = hn_graph_eval(g, term[0], x) + hn_graph_eval(g, term[1], x);
    assert_true(fabs(sum - hn_graph_eval(g, e, x)) < 1e-14);
    hn_graph_free(g);
}

/// The square of the distance of two arms has three terms: the mixed one comes up twice.
static void like_terms_are_one(void **state) {
    (void)state;
    fixture f;
    begin(&f);
    hn_graph *g = f.g;
    hn_ex term[8];
    const hn_ex x = hn_add(g, product(&f, f.m, f.ca), product(&f, f.c, f.cb));
    const hn_ex y = hn_add(g, product(&f, f.m, f.sa), product(&f, f.c, f.sb));
    const hn_ex square = hn_add(g, product(&f, x, x), product(&f, y, y));
    assert_int_equal(hn_angles_terms(g, square, term, 8), 3);
    const double at[] = {0.7, -1.9, 2.3, 1.7};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        sum += hn_graph_eval(g, term[i], at);
    }
    assert_true(fabs(sum - hn_graph_eval(g, square, at)) < 1e-14 * 16); // of numbers around 16

    // what cancels when it is multiplied out is no term
    const hn_ex apart = hn_sub(g, product(&f, hn_add(g, f.m, f.ca), hn_sub(g, f.m, f.ca)), f.c);
    assert_int_equal(hn_angles_terms(g, apart, term, 8), 3);
    hn_graph_free(g);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_four_theorems),           cmocka_unit_test(factors_and_nested_sums),
        cmocka_unit_test(what_is_no_pair_stays),       cmocka_unit_test(long_sums_are_left),
        cmocka_unit_test(a_product_of_sums_has_terms), cmocka_unit_test(like_terms_are_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
