// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures.h"
#include "support/near.h"

static void keep_failures(void *user, const hn_figure_result *r) {
    int *out = user;
    if (!r->good) {
        (*out)++;
        print_message("%s (%s): printed %s, found %s: %s\n", r->what, r->how, r->printed, r->found,
                      r->verdict);
    }
}

static void every_figure_of_the_topic_is_met(void **state) {
    int out = 0;
    hn_figure_topic_run(*state, keep_failures, &out);
    assert_int_equal(out, 0);
}

int hn_figures_test(hn_figure_cost cost) {
    enum { MAX_TOPICS = 64 };
    struct CMUnitTest tests[MAX_TOPICS];
    size_t n = 0;
    for (int i = 0; i < hn_figure_topic_count(); i++) {
        const hn_figure_topic *topic = hn_figure_topic_at(i);
        if (topic->cost == cost) {
            assert_true(n < MAX_TOPICS);
            tests[n++] = (struct CMUnitTest){.name = topic->name,
                                             .test_func = every_figure_of_the_topic_is_met,
                                             .initial_state = (void *)topic};
        }
    }
    return _cmocka_run_group_tests("figures", tests, n, NULL, NULL);
}
