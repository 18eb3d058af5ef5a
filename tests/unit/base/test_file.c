// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "base/file.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/// A folder of its own for each test; paths in it by name.
typedef struct place {
    char folder[64], path[128], other[128];
} place;

static place *make(void **state) {
    static place p;
    *state = &p;
    snprintf(p.folder, sizeof p.folder, "/tmp/holonom-file-XXXXXX");
    assert_non_null(mkdtemp(p.folder));
    snprintf(p.path, sizeof p.path, "%s/a.json", p.folder);
    snprintf(p.other, sizeof p.other, "%s/b.json", p.folder);
    return &p;
}

static int count_files(const place *p) {
    DIR *d = opendir(p->folder);
    int n = -2; // . and ..
    while (readdir(d)) {
        n++;
    }
    closedir(d);
    return n;
}

static int clear(void **state) {
    place *p = *state;
    char path[400];
    DIR *d = opendir(p->folder);
    for (struct dirent *e; (e = readdir(d)) != NULL;) {
        snprintf(path, sizeof path, "%s/%s", p->folder, e->d_name);
        unlink(path);
    }
    closedir(d);
    assert_int_equal(rmdir(p->folder), 0);
    return 0;
}

static void assert_holds(const char *path, const char *text) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    assert_int_equal(hn_file_read(path, 1000, &b, NULL), HN_OK);
    assert_string_equal(hn_strbuf_text(&b), text);
    hn_strbuf_reset(&b);
}

static void what_was_written_is_read_back_and_nothing_stays_beside_it(void **state) {
    const place *p = make(state);
    hn_diag diag;
    assert_int_equal(hn_file_write(p->path, "first", 5, &diag), HN_OK);
    assert_holds(p->path, "first");
    assert_int_equal(hn_file_write(p->path, "second, longer", 14, &diag), HN_OK);
    assert_holds(p->path, "second, longer");
    assert_int_equal(count_files(p), 1);
}

static void a_file_keeps_its_permissions(void **state) {
    const place *p = make(state);
    struct stat info;
    assert_int_equal(hn_file_write(p->path, "x", 1, NULL), HN_OK);
    assert_int_equal(chmod(p->path, 0640), 0);
    assert_int_equal(hn_file_write(p->path, "y", 1, NULL), HN_OK);
    assert_int_equal(stat(p->path, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
}

static void a_link_is_followed_and_stays_a_link(void **state) {
    const place *p = make(state);
    struct stat info;
    assert_int_equal(hn_file_write(p->path, "x", 1, NULL), HN_OK);
    assert_int_equal(symlink(p->path, p->other), 0);
    assert_int_equal(hn_file_write(p->other, "y", 1, NULL), HN_OK);
    assert_int_equal(lstat(p->other, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_holds(p->path, "y");
}

static void a_link_that_leads_nowhere_is_refused(void **state) {
    const place *p = make(state);
    hn_diag diag;
    assert_int_equal(symlink(p->path, p->other), 0);
    assert_int_equal(hn_file_write(p->other, "y", 1, &diag), HN_ERR_IO);
    assert_non_null(strstr(diag.message, "No such file"));
    assert_int_equal(count_files(p), 1);
}

static void a_file_of_another_writer_under_the_first_name_is_left_alone(void **state) {
    const place *p = make(state);
    char taken[200];
    snprintf(taken, sizeof taken, "%s.%ld-0", p->path, (long)getpid());
    assert_int_equal(symlink("/nowhere/at/all", taken), 0);
    assert_int_equal(hn_file_write(p->path, "x", 1, NULL), HN_OK);
    assert_holds(p->path, "x");
    assert_int_equal(count_files(p), 2);
}

static void a_full_device_is_reported(void **state) {
    make(state);
    hn_diag diag;
    assert_int_equal(hn_file_write("/dev/full", "x", 1, &diag), HN_ERR_IO);
    assert_string_equal(diag.message, "cannot write '/dev/full': No space left on device");
    assert_int_equal(hn_file_write("/dev/null", "x", 1, &diag), HN_OK);
}

static void a_write_that_fails_leaves_the_old_file_and_nothing_beside_it(void **state) {
    const place *p = make(state);
    hn_diag diag;
    assert_int_equal(hn_file_write(p->path, "old", 3, NULL), HN_OK);
    // as on a full disk: some bytes are written, then no more
    struct rlimit before, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 10;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const hn_status status = hn_file_write(p->path, "twenty characters...", 20, &diag);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(status, HN_ERR_IO);
    assert_non_null(strstr(diag.message, "File too large"));
    assert_holds(p->path, "old");
    assert_int_equal(count_files(p), 1);

    assert_int_equal(mkdir(p->other, 0777), 0);
    assert_int_equal(hn_file_write(p->other, "x", 1, &diag), HN_ERR_IO);
    assert_non_null(strstr(diag.message, "Is a directory"));
    assert_int_equal(rmdir(p->other), 0);
    assert_holds(p->path, "old");
    assert_int_equal(count_files(p), 1);
    assert_int_equal(hn_file_write("/no/such/folder/x", "x", 1, &diag), HN_ERR_IO);
}

static void a_pipe_without_a_partner_is_refused_at_once(void **state) {
    const place *p = make(state);
    hn_diag diag;
    hn_strbuf b;
    hn_strbuf_init(&b);
    assert_int_equal(mkfifo(p->path, 0666), 0);
    assert_int_equal(hn_file_read(p->path, 1000, &b, &diag), HN_ERR_IO);
    assert_non_null(strstr(diag.message, "it is a pipe"));
    assert_int_equal(hn_file_write(p->path, "x", 1, &diag), HN_ERR_IO);
    hn_strbuf_reset(&b);
}

static void folders_devices_and_missing_files_are_not_read(void **state) {
    const place *p = make(state);
    const char *const paths[] = {p->folder, "/dev/zero", p->path};
    const char *const why[] = {"it is a folder", "not a regular file", "No such file"};
    for (int i = 0; i < 3; i++) {
        hn_diags diags = {0};
        hn_strbuf b;
        hn_strbuf_init(&b);
        assert_int_equal(hn_file_load(paths[i], 1000, &b, &diags), HN_ERR_IO);
        assert_non_null(strstr(diags.item[0].message, why[i]));
        hn_strbuf_reset(&b);
    }
}

static void a_limit_is_exact_and_counts_this_file_only(void **state) {
    const place *p = make(state);
    hn_diag diag;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_strbuf_add(&b, "before ");
    assert_int_equal(hn_file_write(p->path, "12345", 5, NULL), HN_OK);
    assert_int_equal(hn_file_read(p->path, 5, &b, &diag), HN_OK);
    assert_string_equal(hn_strbuf_text(&b), "before 12345");
    assert_int_equal(hn_file_read(p->path, 4, &b, &diag), HN_ERR_LIMIT);
    assert_non_null(strstr(diag.message, "more than 4 bytes"));
    hn_strbuf_reset(&b);
}

#define ROW(name) cmocka_unit_test_teardown(name, clear)

int main(void) {
    const struct CMUnitTest tests[] = {
        ROW(what_was_written_is_read_back_and_nothing_stays_beside_it),
        ROW(a_file_keeps_its_permissions),
        ROW(a_link_is_followed_and_stays_a_link),
        ROW(a_link_that_leads_nowhere_is_refused),
        ROW(a_file_of_another_writer_under_the_first_name_is_left_alone),
        ROW(a_full_device_is_reported),
        ROW(a_write_that_fails_leaves_the_old_file_and_nothing_beside_it),
        ROW(a_pipe_without_a_partner_is_refused_at_once),
        ROW(folders_devices_and_missing_files_are_not_read),
        ROW(a_limit_is_exact_and_counts_this_file_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
