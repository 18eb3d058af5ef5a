// SPDX-License-Identifier: GPL-3.0-or-later
// Requests that wait for a place, and clients that go meanwhile.
#define HN_MICROHTTPD_OWN_NAMES // their places in the table are filled below
#include "http/request/place_queue.h"

#include "http/request/context.h"
#include "support/near.h"

#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { HERE, THERE };

static int pair[2]; ///< the server's end of a connection, and its client's
static int n_resumed, n_given;

// ---- in place of the HTTP library ----

static const union MHD_ConnectionInfo *get_info(struct MHD_Connection *connection,
                                                enum MHD_ConnectionInfoType type, ...) {
    static union MHD_ConnectionInfo info;
    (void)connection;
    (void)type;
    info.connect_fd = pair[HERE];
    return &info;
}

static void resume(struct MHD_Connection *connection) {
    (void)connection;
    n_resumed++;
}

static int open_pair(void **state) {
    (void)state;
    hn_microhttpd_functions.MHD_get_connection_info = get_info;
    hn_microhttpd_functions.MHD_resume_connection = resume;
    n_resumed = n_given = 0;
    return socketpair(AF_UNIX, SOCK_STREAM, 0, pair);
}

static int close_pair(void **state) {
    (void)state;
    close(pair[HERE]);
    if (pair[THERE] >= 0) {
        close(pair[THERE]);
    }
    return 0;
}

// ---- places that are free ----

static bool take(void *user, hn_client client) {
    (void)user;
    (void)client;
    return true;
}

static void give(void *user, hn_client client) {
    (void)user;
    (void)client;
    n_given++;
}

static void refuse(void *user, hn_request *r, int n_before) {
    (void)user;
    (void)n_before;
    hn_reply_problem(r, HN_PROBLEM_STUDIES_BUSY, NULL, "all places for studies are taken");
}

static void do_nothing(void *job, hn_job_turn *turn) {
    (void)job;
    (void)turn;
}

static void who_has_its_place_and_no_turn_is_not_told_that_places_are_taken(void **state) {
    (void)state;
    hn_jobs *full = hn_jobs_create(&(hn_jobs_opts){.at_once = 1}, do_nothing); // nobody may wait
    assert_non_null(full);
    hn_context context = {.opts = {.queue = 8}};
    hn_request r = {.context = &context, .path = "/api/v1/studies"};
    hn_strbuf_init(&r.text);
    hn_place_queue queue = {0};
    assert_true(hn_place_queue_add(&queue, &r, 60, 8));
    const hn_place_rules rules = {.take = take, .give = give, .refuse = refuse, .jobs = full};
    hn_place_queue_serve(&queue, &rules, false);
    assert_int_equal(queue.n, 0);
    assert_int_equal(n_given, 1);
    assert_int_equal(n_resumed, 1);
    assert_int_equal(r.status, hn_http_problem_get_info(HN_PROBLEM_BUSY)->status);
    assert_null(strstr(hn_strbuf_text(&r.text), "taken"));
    assert_string_equal(r.headers[0].name, "Retry-After");
    hn_strbuf_reset(&r.text);
    hn_jobs_free(full);
}

static void work_that_ends_for_nobody_says_so(void **state) {
    (void)state;
    hn_context context = {.opts = {.max_run_cpu = 20}};
    hn_request r = {.context = &context, .path = "/api/v1/studies", .takes_interim = true};
    hn_strbuf_init(&r.text);
    assert_false(hn_request_has_been_left(&r));
    close(pair[THERE]);
    pair[THERE] = -1;
    assert_true(hn_request_has_been_left(&r));
    hn_reply_diags(&r, HN_ERR_STOPPED, &(hn_diags){0});
    assert_non_null(strstr(hn_strbuf_text(&r.text), "closed its connection"));
    hn_strbuf_reset(&r.text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(
            who_has_its_place_and_no_turn_is_not_told_that_places_are_taken, open_pair, close_pair),
        cmocka_unit_test_setup_teardown(work_that_ends_for_nobody_says_so, open_pair, close_pair),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
