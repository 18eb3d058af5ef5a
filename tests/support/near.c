// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include <math.h>
#include <string.h>

static const uint64_t POISON_BITS = 0x7ff8dead0badf00dull;

// written as !(x <= tol) so that a NaN on either side fails
static void check(double actual, double expected, double bound, const char *kind, double tol,
                  const char *what, const char *file, int line) {
    if (!(fabs(actual - expected) <= bound) && !(isinf(actual) && actual == expected)) {
        print_error("%s is %.17g, expected %.17g: off by %.3g, %s %.3g\n", what, actual, expected,
                    actual - expected, kind, tol);
        _fail(file, line);
    }
}

void hn_assert_near(double actual, double expected, double abs_tol, const char *what,
                    const char *file, int line) {
    check(actual, expected, abs_tol, "allowed", abs_tol, what, file, line);
}

void hn_assert_rel(double actual, double expected, double rel_tol, const char *what,
                   const char *file, int line) {
    check(actual, expected, rel_tol * fabs(expected), "allowed relative", rel_tol, what, file,
          line);
}

void hn_assert_all_near(const double *actual, const double *expected, size_t n, double abs_tol,
                        const char *what, const char *file, int line) {
    size_t worst = 0;
    double most = -1;
    for (size_t i = 0; i < n; i++) {
        const double off = fabs(actual[i] - expected[i]);
        if (isnan(off)) {
            worst = i;
            break;
        }
        if (off > most) {
            most = off;
            worst = i;
        }
    }
    if (n > 0 && !(fabs(actual[worst] - expected[worst]) <= abs_tol)) {
        print_error("entry %zu of %zu:\n", worst, n);
        check(actual[worst], expected[worst], abs_tol, "allowed", abs_tol, what, file, line);
    }
}

double hn_poison(void) {
    double value;
    memcpy(&value, &POISON_BITS, sizeof value);
    return value;
}

void hn_poison_fill(double *values, size_t n) {
    for (size_t i = 0; i < n; i++) {
        memcpy(&values[i], &POISON_BITS, sizeof POISON_BITS);
    }
}

int hn_poison_intact(const double *values, size_t n) {
    for (size_t i = 0; i < n; i++) {
        if (memcmp(&values[i], &POISON_BITS, sizeof POISON_BITS) != 0) {
            return 0;
        }
    }
    return 1;
}
