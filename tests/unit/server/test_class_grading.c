// SPDX-License-Identifier: GPL-3.0-or-later
// Every submission of a class gets its line, whatever becomes of the processes that grade.
#define _GNU_SOURCE // mkdtemp
#include "class/class_grading.h"

#include "p3.h"

#include <dirent.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { STUDENTS = 7 };

/// The parent of a process; 0: there is none such.
static long parent_of(const char *pid) {
    char path[300], state;
    long parent = 0;
    snprintf(path, sizeof path, "/proc/%s/stat", pid);
    FILE *f = fopen(path, "re");
    if (f) {
        if (fscanf(f, "%*d (%*[^)]) %c %ld", &state, &parent) != 2) {
            parent = 0;
        }
        fclose(f);
    }
    return parent;
}

/// Ends every worker, and waits until it has ended: it then takes no more work.
static void end_workers(void *user, const char *line) {
    (void)user, (void)line;
    DIR *all = opendir("/proc");
    assert_non_null(all);
    for (struct dirent *d; (d = readdir(all));) {
        const long pid = strtol(d->d_name, NULL, 10);
        if (pid > 0 && parent_of(d->d_name) == getpid()) {
            siginfo_t info;
            kill((pid_t)pid, SIGKILL);
            assert_int_equal(waitid(P_PID, (id_t)pid, &info, WEXITED | WNOWAIT), 0);
        }
    }
    closedir(all);
}

/// Grades seven submissions, ending all workers after each line.
static void grade_class(const hn_exercise *p, int jobs) {
    hn_roster roster;
    hn_class_result result;
    hn_diag diag = {0};
    char folder[] = "/tmp/holonom-class-XXXXXX", path[sizeof folder + 16];
    assert_non_null(mkdtemp(folder));
    for (int i = 0; i < STUDENTS; i++) {
        snprintf(path, sizeof path, "%s/s%d.json", folder, i);
        FILE *f = fopen(path, "we");
        assert_non_null(f);
        fputs("{\"J\": [[1, 2, 3, 4], [5, 6, 7, 8]]}", f);
        fclose(f);
    }

    const hn_class_opts opts = {.jobs = jobs, .time_limit = 60, .tell = end_workers};
    assert_int_equal(hn_roster_read(&roster, folder, &diag), HN_OK);
    assert_int_equal(roster.n, STUDENTS);
    assert_int_equal(hn_class_grade(&roster, p, &opts, &result, &diag), HN_OK);
    for (int i = 0; i < STUDENTS; i++) {
        assert_non_null(result.line[i]);
    }
    if (jobs == 1) { // idle when it ended: nothing was lost with it
        for (int i = 0; i < STUDENTS; i++) {
            assert_non_null(strstr(result.line[i], "\"graded\""));
        }
    }

    hn_class_result_reset(&result);
    hn_roster_reset(&roster);
    for (int i = 0; i < STUDENTS; i++) {
        snprintf(path, sizeof path, "%s/s%d.json", folder, i);
        unlink(path);
    }
    rmdir(folder);
}

static void a_worker_that_ended_costs_no_line(void **state) {
    signal(SIGPIPE, SIG_IGN);
    alarm(100); // a class that waits for a line that never comes
    grade_class(*state, 1);
    grade_class(*state, 3);
    alarm(0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_worker_that_ended_costs_no_line)};
    return cmocka_run_group_tests(tests, setup, teardown);
}
