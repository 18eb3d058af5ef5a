// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/status.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void every_status_has_its_own_name_and_sentence(void **state) {
    (void)state;
    assert_int_equal(HN_OK, 0);
    for (int i = 0; i < HN_STATUS_COUNT; i++) {
        const hn_status s = (hn_status)i;
        // words of its own for documents, not the name that the code has for it
        assert_int_equal(strspn(hn_status_name(s), "abcdefghijklmnopqrstuvwxyz-"),
                         strlen(hn_status_name(s)));
        assert_true(strlen(hn_status_text(s)) > 0);
        for (int k = 0; k < i; k++) {
            assert_string_not_equal(hn_status_name(s), hn_status_name((hn_status)k));
            assert_string_not_equal(hn_status_text(s), hn_status_text((hn_status)k));
        }
    }
    assert_string_equal(hn_status_name(HN_ERR_CHART), "chart-lost");
    assert_string_equal(hn_status_text(HN_ERR_MEMORY), "out of memory");
}

static void a_status_that_does_not_exist_is_said_to_be_unknown(void **state) {
    (void)state;
    assert_string_equal(hn_status_name((hn_status)HN_STATUS_COUNT), "unknown");
    assert_string_equal(hn_status_text((hn_status)1000), "an unknown status");
}

static void a_broken_contract_ends_the_program_in_every_build(void **state) {
    (void)state;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        // the message belongs to the child and would look like a failure of this test
        if (freopen("/dev/null", "w", stderr) == NULL) {
            _exit(1);
        }
        signal(SIGABRT, SIG_DFL);
        HN_ASSERT(child != 0);
        _exit(0);
    }
    int how = 0;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_true(WIFSIGNALED(how));
    assert_int_equal(WTERMSIG(how), SIGABRT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_status_has_its_own_name_and_sentence),
        cmocka_unit_test(a_status_that_does_not_exist_is_said_to_be_unknown),
        cmocka_unit_test(a_broken_contract_ends_the_program_in_every_build),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
