// SPDX-License-Identifier: GPL-3.0-or-later
// The figures that take little time, each topic a test: tests/support/figures.h says what a figure
// is.
#include "support/figures.h"

int main(void) {
    return hn_figures_test(HN_FIGURE_QUICK);
}
