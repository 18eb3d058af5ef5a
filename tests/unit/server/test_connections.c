// SPDX-License-Identifier: GPL-3.0-or-later
// A request that stops coming in is told so before its connection is closed, and nobody else is.
#include "http/ground/connections.h"

#include "support/near.h"

#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { PATIENCE_MS = 60000 }; // a machine at work may take long to look at deadlines

/// A connection in some state, seen from the client's side.
typedef struct client {
    int theirs, ours;
    hn_connection_watch *watch;
} client;

static client open_client(hn_connections *all) {
    int fd[2];
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, fd), 0);
    return (client){fd[0], fd[1], hn_connections_add(all, fd[1], 0)};
}

/// What the client has been sent when its connection ends.
static void read_to_end(const client *c, char text[1000]) {
    size_t used = 0;
    text[0] = '\0';
    for (;;) {
        struct pollfd look = {.fd = c->theirs, .events = POLLIN};
        assert_int_equal(poll(&look, 1, PATIENCE_MS), 1);
        const ssize_t n = recv(c->theirs, text + used, 999 - used, 0);
        if (n <= 0) {
            return;
        }
        used += (size_t)n;
        text[used] = '\0';
    }
}

static void close_client(hn_connections *all, client *c) {
    hn_connections_remove(all, c->watch);
    close(c->theirs);
    close(c->ours);
}

static void a_body_that_stands_still_is_told_so(void **state) {
    (void)state;
    hn_http_opts opts = hn_http_opts_default();
    opts.connection_timeout = 1; // [s]
    char text[1000];
    hn_connections *all = hn_connections_create(&opts);
    assert_non_null(all);

    // the head is there, and a piece of the body; the deadline of the whole is far away
    client slow = open_client(all);
    hn_connection_asks(all, slow.watch);
    hn_connection_reads_body(all, slow.watch);
    hn_connection_goes_on(all, slow.watch);
    read_to_end(&slow, text);
    assert_memory_equal(text, "HTTP/1.1 408 ", 13);
    assert_non_null(strstr(text, "\r\n\r\n{\"type\":\"/api/v1/errors/timeout\""));

    close_client(all, &slow);
    hn_connections_free(all);
}

static void a_connection_without_an_open_request_is_closed_without_a_word(void **state) {
    (void)state;
    hn_http_opts opts = hn_http_opts_default();
    opts.head_deadline = opts.request_deadline = 0.5; // [s]
    char text[1000];
    hn_connections *all = hn_connections_create(&opts);
    assert_non_null(all);

    // one that was opened ahead, one whose answer has gone out early, one that is kept alive
    client ahead = open_client(all), early = open_client(all), kept = open_client(all);
    hn_connection_asks(all, early.watch);
    hn_connection_reads_body(all, early.watch);
    hn_connection_is_answered(all, early.watch);
    hn_connection_asks(all, kept.watch);
    hn_connection_is_served(all, kept.watch);
    hn_connection_is_idle(all, kept.watch);
    client *const silent[] = {&ahead, &early, &kept};
    for (int i = 0; i < 3; i++) {
        read_to_end(silent[i], text);
        assert_string_equal(text, "");
        close_client(all, silent[i]);
    }
    hn_connections_free(all);
}

static void who_does_not_read_is_closed_when_patience_is_over(void **state) {
    (void)state;
    hn_http_opts opts = hn_http_opts_default();
    char text[1000];
    hn_connections *all = hn_connections_create(&opts);
    assert_non_null(all);

    // who asks, who is served and who has read its answer are no slow readers
    client asks = open_client(all), served = open_client(all), first = open_client(all),
           second = open_client(all);
    hn_connection_asks(all, asks.watch);
    hn_connection_is_served(all, served.watch);
    assert_false(hn_connections_end_slowest(all, 0));
    hn_connection_sends(all, first.watch);
    hn_connection_sends(all, second.watch);
    assert_false(hn_connections_end_slowest(all, PATIENCE_MS));

    client *const slow[] = {&first, &second};
    for (int i = 0; i < 2; i++) {
        assert_true(hn_connections_end_slowest(all, 0));
        read_to_end(slow[i], text);
        assert_string_equal(text, "");
    }
    assert_false(hn_connections_end_slowest(all, 0));

    client *const open[] = {&asks, &served, &first, &second};
    for (int i = 0; i < 4; i++) {
        close_client(all, open[i]);
    }
    hn_connections_free(all);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_that_stands_still_is_told_so),
        cmocka_unit_test(who_does_not_read_is_closed_when_patience_is_over),
        cmocka_unit_test(a_connection_without_an_open_request_is_closed_without_a_word),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
