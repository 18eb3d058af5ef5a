// SPDX-License-Identifier: GPL-3.0-or-later
// The extreme matrix but for its longest cases: no prediction fails, and it is the same each time.

#include "session/extreme/extreme.h"
#include "session/extreme/extreme_doc.h"
#include "session/extreme/extreme_files.h"
#include "support/near.h"

#include <string.h>

static const char *const CASES[] = {"x1",  "x2",  "x3",  "x5",  "x6",  "x7",  "x8",
                                    "x9",  "x12", "x13", "x14", "x15", "x17", "x18",
                                    "x19", "x21", "x22", "x24", "x25"};
enum { N_CASES = sizeof CASES / sizeof *CASES };

static void run_all(const hn_library *lib, hn_strbuf *text) {
    hn_extreme *x = NULL;
    hn_diags diags = {0};
    const hn_job_limits limits = {0};
    assert_int_equal(hn_extreme_load(lib, CASES, N_CASES, &x, &diags), HN_OK);
    assert_int_equal(x->n_cases, N_CASES);
    hn_extreme_run(x, &limits, false);
    for (int i = 0; i < x->n_cases; i++) {
        for (int k = 0; k < x->cases[i].n_trials; k++) {
            const hn_extreme_trial *t = &x->cases[i].trials[k];
            if (t->verdict == HN_EXTREME_FAIL || t->verdict == HN_EXTREME_NOT_RUN) {
                fail_msg("%s, %s: predicted %s, observed %s", x->cases[i].id, t->what,
                         t->expect.text, t->observed);
            }
        }
    }
    hn_extreme_json(text, x);
    hn_extreme_free(x);
}

static void no_prediction_fails_and_it_is_twice_the_same(void **state) {
    (void)state;
    hn_library *lib = NULL;
    hn_diag diag;
    hn_strbuf first, second;
    hn_strbuf_init(&first);
    hn_strbuf_init(&second);
    assert_int_equal(hn_library_open(".", &lib, &diag), HN_OK);
    run_all(lib, &first);
    run_all(lib, &second);
    assert_string_equal(hn_strbuf_text(&first), hn_strbuf_text(&second));
    hn_strbuf_reset(&first);
    hn_strbuf_reset(&second);
    hn_library_free(lib);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_prediction_fails_and_it_is_twice_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
