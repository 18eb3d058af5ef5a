// SPDX-License-Identifier: GPL-3.0-or-later
// A journal holds whole lines of whoever has it, and nothing of what was cut or does not fit.
#include "support/near.h"

#include "session/store/journal.h"
#include "session/store/stored_json.h"

#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { KEY = 0x2a, MOST = 8 };

typedef struct work {
    char folder[64], path[128];
    int n, taken[MOST];
    hn_journal journal;
} work;

/// Numbers from 0 to 9; others do not fit.
static int take(void *user, const cJSON *line) {
    work *w = user;
    int i;
    if (!hn_stored_int(line, "i", 10, &i) || w->n == MOST) {
        return 0;
    }
    w->taken[w->n++] = i;
    return 1;
}

static void begin(work *w) {
    memset(w, 0, sizeof *w);
    strcpy(w->folder, "/tmp/hn-journal-XXXXXX");
    assert_non_null(mkdtemp(w->folder));
}

static void end(work *w) {
    hn_journal_end(&w->journal, 0);
    remove(w->path);
    assert_int_equal(rmdir(w->folder), 0);
}

static void open_again(work *w) {
    hn_diags diags = {0};
    w->n = 0;
    assert_int_equal(hn_journal_open(&w->journal, w->folder, "kind", KEY, take, w, &diags), HN_OK);
    assert_int_equal(strncmp(w->journal.path, w->folder, strlen(w->folder)), 0);
    snprintf(w->path, sizeof w->path, "%.127s", w->journal.path);
}

static void put(work *w, int i) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_int(&b, "i", i);
    hn_journal_write(&w->journal, &b);
}

static void write_file(const work *w, const char *text) {
    FILE *f = fopen(w->path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, strlen(text), f), strlen(text));
    fclose(f);
}

static void lines_come_back_in_order_and_new_ones_stand_behind_them(void **state) {
    (void)state;
    work w;
    begin(&w);
    open_again(&w);
    assert_int_equal(w.n, 0);
    put(&w, 3);
    put(&w, 1);
    hn_journal_end(&w.journal, 0);
    hn_journal_end(&w.journal, 0); // may be called again
    open_again(&w);
    assert_int_equal(w.n, 2);
    put(&w, 4);
    hn_journal_end(&w.journal, 0);
    open_again(&w);
    assert_int_equal(w.n, 3);
    assert_int_equal(w.taken[0], 3);
    assert_int_equal(w.taken[1], 1);
    assert_int_equal(w.taken[2], 4);
    end(&w);
}

static void what_is_torn_or_does_not_fit_is_cut_off_with_all_behind_it(void **state) {
    (void)state;
    static const struct {
        const char *text;
        int whole; ///< lines
    } cases[] = {
        {"{\"i\":1}\n{\"i\":2}\n{\"i\":", 2},
        {"{\"i\":1}\n{\"i\":2}", 1},
        {"{\"i\":1}\n{\"i\":99}\n{\"i\":2}\n", 1},
        {"{\"i\":1.5}\n", 0},
        {"{\"i\":-1}\n", 0},
        {"{\"i\":null}\n", 0},
        {"[1]\n", 0},
        {"\n{\"i\":1}\n", 0},
        {"nonsense\n{\"i\":1}\n", 0},
        {"", 0},
    };
    work w;
    begin(&w);
    open_again(&w);
    hn_journal_end(&w.journal, 0);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        write_file(&w, cases[k].text);
        open_again(&w);
        assert_int_equal(w.n, cases[k].whole);
        put(&w, 7);
        hn_journal_end(&w.journal, 0);
        open_again(&w);
        assert_int_equal(w.n, cases[k].whole + 1);
        assert_int_equal(w.taken[cases[k].whole], 7);
        hn_journal_end(&w.journal, 0);
    }
    end(&w);
}

static void one_program_at_a_time_has_it(void **state) {
    (void)state;
    work w;
    hn_journal second = {0};
    hn_diags diags = {0};
    begin(&w);
    open_again(&w);
    put(&w, 5);
    assert_int_equal(hn_journal_open(&second, w.folder, "kind", KEY, take, &w, &diags), HN_ERR_IO);
    assert_non_null(strstr(diags.item[0].message, "another program"));
    hn_journal_end(&second, 1); // not its own: left alone
    assert_int_equal(access(w.path, F_OK), 0);
    hn_journal_end(&w.journal, 0);
    open_again(&w);
    assert_int_equal(w.n, 1);
    end(&w);
}

static void a_program_that_it_started_does_not_keep_it(void **state) {
    (void)state;
    extern char **environ;
    char *const argv[] = {"sleep", "60", NULL};
    pid_t child;
    work w;
    begin(&w);
    open_again(&w);
    put(&w, 5);

    // the child of a program that was killed, such as a compiler, lives on for a while
    assert_int_equal(posix_spawnp(&child, argv[0], NULL, NULL, argv, environ), 0);
    hn_journal_end(&w.journal, 0);
    open_again(&w);
    assert_int_equal(w.n, 1);

    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    end(&w);
}

static void of_whole_work_nothing_is_left_and_without_a_place_nothing_is_kept(void **state) {
    (void)state;
    char far[600];
    work w;
    hn_journal none = {0};
    hn_diags diags = {0};
    begin(&w);
    open_again(&w);
    put(&w, 1);
    hn_journal_end(&w.journal, 0);
    hn_journal_end(&w.journal, 1); // closed before: as a report does when all of it is there
    assert_int_not_equal(access(w.path, F_OK), 0);
    memset(far, 'a', sizeof far - 1);
    far[sizeof far - 1] = 0;
    assert_int_equal(hn_journal_open(&none, far, "kind", KEY, take, &w, &diags), HN_OK);
    assert_null(none.file);
    assert_int_equal(hn_journal_open(&none, "/nowhere/at/all", "kind", KEY, take, &w, &diags),
                     HN_ERR_IO);
    assert_non_null(strstr(diags.item[0].message, "/nowhere/at/all"));
    end(&w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_come_back_in_order_and_new_ones_stand_behind_them),
        cmocka_unit_test(what_is_torn_or_does_not_fit_is_cut_off_with_all_behind_it),
        cmocka_unit_test(one_program_at_a_time_has_it),
        cmocka_unit_test(a_program_that_it_started_does_not_keep_it),
        cmocka_unit_test(of_whole_work_nothing_is_left_and_without_a_place_nothing_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
