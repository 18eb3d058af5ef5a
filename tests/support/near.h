// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_NEAR_H
#define HN_SUPPORT_NEAR_H
// Comparing doubles in cmocka tests so that a failure shows both values, and poisoning outputs so
// that a value that was never written is seen. A NaN is near nothing.

// cmocka.h needs these four before it
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/// |actual - expected| <= abs_tol
#define assert_near(actual, expected, abs_tol) \
    hn_assert_near((actual), (expected), (abs_tol), #actual, __FILE__, __LINE__)

/// |actual - expected| <= rel_tol * |expected|
#define assert_rel(actual, expected, rel_tol) \
    hn_assert_rel((actual), (expected), (rel_tol), #actual, __FILE__, __LINE__)

/// every one of n entries near; the worst is shown with its index
#define assert_all_near(actual, expected, n, abs_tol) \
    hn_assert_all_near((actual), (expected), (n), (abs_tol), #actual, __FILE__, __LINE__)

void hn_assert_near(double actual, double expected, double abs_tol, const char *what,
                    const char *file, int line);
void hn_assert_rel(double actual, double expected, double rel_tol, const char *what,
                   const char *file, int line);
void hn_assert_all_near(const double *actual, const double *expected, size_t n, double abs_tol,
                        const char *what, const char *file, int line);

/// A NaN with a payload of ours: what an output holds before the function under test is called.
double hn_poison(void);
void hn_poison_fill(double *values, size_t n);
/// 1 while every entry still has the very bits of hn_poison(): "outputs are untouched on failure".
int hn_poison_intact(const double *values, size_t n);
#endif
