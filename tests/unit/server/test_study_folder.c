// SPDX-License-Identifier: GPL-3.0-or-later
// Unfinished studies of the server: the newest files are kept, and a link is not followed.
#include "http/studies/study_folder.h"

#include "support/near.h"

#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static void touch(const char *folder, int i, time_t when) {
    char path[128];
    snprintf(path, sizeof path, "%s/%03d", folder, i);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fclose(file), 0);
    const struct timespec times[2] = {{.tv_sec = when}, {.tv_sec = when}};
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static bool is_there(const char *folder, int i) {
    char path[128];
    snprintf(path, sizeof path, "%s/%03d", folder, i);
    return access(path, F_OK) == 0;
}

static void the_oldest_files_go(void **state) {
    (void)state;
    char runs[] = "/tmp/holonom-XXXXXX", folder[64];
    assert_non_null(mkdtemp(runs));
    assert_true(hn_study_folder_ready(runs, folder, sizeof folder));
    for (int i = 0; i < HN_STUDY_FILES + 6; i++) {
        touch(folder, i, 1000 + i);
    }

    // the six that were changed first
    assert_true(hn_study_folder_ready(runs, folder, sizeof folder));
    for (int i = 0; i < HN_STUDY_FILES + 6; i++) {
        char path[128];
        assert_int_equal(is_there(folder, i), i >= 6);
        snprintf(path, sizeof path, "%s/%03d", folder, i);
        (void)unlink(path);
    }
    assert_int_equal(rmdir(folder), 0);
    assert_int_equal(rmdir(runs), 0);
}

static void without_a_folder_nothing_is_kept(void **state) {
    (void)state;
    char runs[] = "/tmp/holonom-XXXXXX", folder[64], small[4];
    assert_non_null(mkdtemp(runs));
    assert_false(hn_study_folder_ready(NULL, folder, sizeof folder));
    assert_false(hn_study_folder_ready(runs, small, sizeof small));

    // a link in its place is not followed
    snprintf(folder, sizeof folder, "%s/studies", runs);
    assert_int_equal(symlink("/tmp", folder), 0);
    assert_false(hn_study_folder_ready(runs, folder, sizeof folder));
    snprintf(folder, sizeof folder, "%s/studies", runs);
    assert_int_equal(unlink(folder), 0);
    assert_int_equal(rmdir(runs), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_oldest_files_go),
        cmocka_unit_test(without_a_folder_nothing_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
