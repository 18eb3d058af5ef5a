// SPDX-License-Identifier: GPL-3.0-or-later
// A job that was stopped and is run again goes on with what is left, and ends as one that nobody
// disturbed.
#include "session/kinds/job.h"

#include "support/near.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// A job may ask `patience` times before it is stopped.
typedef struct watch {
    long long asked, patience;
} watch;

static int stop_after(void *user) {
    watch *w = user;
    return ++w->asked > w->patience;
}

typedef struct trial {
    hn_library *lib;
    hn_model *model;
    watch watch;
    const hn_job_kind *kind;
    hn_job_request request;
    hn_job *job; ///< NULL until a run had time enough to open it
} trial;

/// The same question, asked while equations are made.
static bool end_making(void *user) {
    return stop_after(user);
}

static void open_trial(trial *t, const char *scene, const char *kind, long long patience) {
    static const char *const METHODS[] = {"projection@rk4:h=1e-2", "baumgarte@rk4:h=1e-2"};
    const hn_model_source source = {.name = scene, .interrupt = {end_making, &t->watch}};
    hn_diag diag = {0};
    hn_diags diags = {0};
    *t = (trial){.watch.patience = patience};
    assert_int_equal(hn_library_open(".", &t->lib, &diag), HN_OK);
    assert_int_equal(hn_model_load(t->lib, &source, &t->model, &diags), HN_OK);

    // each kind takes from the values what it knows
    hn_job_request r = hn_job_request_default(t->model);
    assert_int_equal(hn_job_request_set_methods(&r, METHODS, 2, &diags), HN_OK);
    r.time = 0.5;
    hn_job_request_set(&r, "levels", 3);
    hn_job_request_set(&r, "samples", 0);
    hn_job_request_set(&r, "columns", 5);
    hn_job_request_set(&r, "rows", 4);
    r.limits.time_limit = 0;
    r.limits.stop = stop_after;
    r.limits.user = &t->watch;
    t->request = r;
    t->kind = hn_job_kind_find(kind);
}

static void close_trial(trial *t) {
    hn_job_free(t->job);
    hn_model_free(t->model);
    hn_library_free(t->lib);
}

/// One run, which begins with the opening where there is no job yet; returns whether it was
/// stopped.
static bool run(trial *t, long long patience) {
    hn_job_end end = {0};
    hn_diags diags = {0};
    t->watch = (watch){.patience = patience};
    if (!t->job) {
        const hn_status opened = hn_job_open(t->kind, &t->request, &t->job, &diags);
        if (opened == HN_ERR_STOPPED) {
            return true;
        }
        assert_int_equal(opened, HN_OK);
    }
    assert_int_equal(hn_job_run(t->job, &end, &diags), HN_OK);
    return end.stopped;
}

/// The document without the wall time of a map, which is another each time. Owned.
static char *document_of(const trial *t) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    assert_true(hn_job_write(&b, t->job, ".json"));
    cJSON *root = cJSON_Parse(hn_strbuf_text(&b));
    assert_non_null(root);
    cJSON_DeleteItemFromObjectCaseSensitive(root, "elapsed");
    char *text = cJSON_PrintUnformatted(root);
    cJSON_Delete(root);
    hn_strbuf_reset(&b);
    return text;
}

/// `says`: what the document of an undisturbed job must contain.
static void check_kind(const char *kind, const char *scene, const char *says) {
    enum { MOST_RUNS = 200 };
    const long long never = (long long)1 << 60;
    trial whole, cut;

    // undisturbed, and how often it asks
    open_trial(&whole, scene, kind, never);
    assert_false(run(&whole, never));
    const long long asks = whole.watch.asked;
    char *expected = document_of(&whole);
    assert_non_null(strstr(expected, says));
    close_trial(&whole);

    // stopped again and again, each time after a little more
    open_trial(&cut, scene, kind, never);
    int runs = 1;
    for (long long patience = 0; run(&cut, patience); patience += asks / 80 + 1) {
        assert_true(++runs < MOST_RUNS);
        char *part = cut.job ? document_of(&cut) : NULL; // a document at every end
        assert_true(!part || !strstr(part, "memory"));
        free(part);
    }
    char *got = document_of(&cut);
    close_trial(&cut);
    print_message("%s: %lld questions, %d runs\n", kind, asks, runs);
    assert_true(runs > 3);
    assert_string_equal(got, expected);
    free(got);
    free(expected);
}

static void a_work_precision_study_goes_on(void **state) {
    (void)state;
    check_kind("work-precision", "pendulum", "\"state\":\"done\"");
    check_kind("work-precision", "four-bar", "\"state\":\"done\"");
}

static void a_map_goes_on_and_so_does_the_map_that_it_chooses(void **state) {
    (void)state;
    check_kind("stability", "four-bar", "\"preset\":\"baumgarte\"");
}

static void a_budget_goes_on(void **state) {
    (void)state;
    check_kind("budget", "four-bar", "\"state\":\"done\"");
}

/// A time limit that is over at once leaves all out; without a limit the next run does the rest.
static void a_later_run_has_the_time_limit_that_was_set(void **state) {
    static const char *const KINDS[] = {"work-precision", "stability", "budget"};
    (void)state;
    for (int i = 0; i < 3; i++) {
        const long long never = (long long)1 << 60;
        trial t;
        hn_job_end end = {0};
        hn_diags diags = {0};
        open_trial(&t, "four-bar", KINDS[i], never);
        assert_int_equal(hn_job_open(t.kind, &t.request, &t.job, &diags), HN_OK);
        hn_job_set_time_limit(t.job, 1e-9);
        assert_int_equal(hn_job_run(t.job, &end, &diags), HN_OK);
        assert_true(end.out_of_time);
        hn_job_set_time_limit(t.job, 0);
        assert_int_equal(hn_job_run(t.job, &end, &diags), HN_OK);
        assert_false(end.out_of_time || end.stopped);
        close_trial(&t);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_work_precision_study_goes_on),
        cmocka_unit_test(a_map_goes_on_and_so_does_the_map_that_it_chooses),
        cmocka_unit_test(a_budget_goes_on),
        cmocka_unit_test(a_later_run_has_the_time_limit_that_was_set),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
