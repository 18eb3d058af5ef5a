// SPDX-License-Identifier: GPL-3.0-or-later
// A request that stops coming in is told so before its connection is closed, and nobody else is.
#include "http/ground/connections.h"

#include "support/near.h"

#include <netinet/in.h>
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

/// Reads what the client has been sent when its connection ends.
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
    assert_non_null(strstr(text, "\r\nHolonom-Build: "));
    assert_non_null(strstr(text, "\r\n\r\n{\"type\":\"/api/v1/errors/timeout\""));

    // the rest of its body may lie in the socket: it is too late to carry it out
    assert_false(hn_connection_is_served(all, slow.watch));

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
    assert_true(hn_connection_is_served(all, kept.watch));
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
    opts.unread_pause = 0; // [s]
    char text[1000];
    hn_connections *all = hn_connections_create(&opts);
    assert_non_null(all);

    // who asks, who is served and who has read its answer are no slow readers
    client asks = open_client(all), served = open_client(all), first = open_client(all),
           second = open_client(all);
    hn_connection_asks(all, asks.watch);
    assert_true(hn_connection_is_served(all, served.watch));
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

/// A connection over the loopback, whose bytes the system counts.
static client open_tcp_client(hn_connections *all) {
    struct sockaddr_in at = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t n = sizeof at;
    const int listener = socket(AF_INET, SOCK_STREAM, 0), theirs = socket(AF_INET, SOCK_STREAM, 0);
    assert_int_equal(bind(listener, (struct sockaddr *)&at, n), 0);
    assert_int_equal(listen(listener, 1), 0);
    assert_int_equal(getsockname(listener, (struct sockaddr *)&at, &n), 0);
    assert_int_equal(connect(theirs, (struct sockaddr *)&at, n), 0);
    const int ours = accept(listener, NULL, NULL);
    assert_true(ours >= 0);
    close(listener);
    return (client){theirs, ours, hn_connections_add(all, ours, 0)};
}

static void who_reads_is_not_closed_before_who_does_not(void **state) {
    (void)state;
    enum { MANY = 20000 };
    static const char bytes[MANY];
    char text[1000];
    hn_http_opts opts = hn_http_opts_default();
    opts.unread_pause = PATIENCE_MS; // [s] for ever, here
    hn_connections *all = hn_connections_create(&opts);
    assert_non_null(all);

    // the first one has waited for longer, and has read all that it was sent
    client reads = open_tcp_client(all), stands = open_tcp_client(all);
    hn_connection_sends(all, reads.watch);
    hn_connection_sends(all, stands.watch);
    assert_int_equal(send(reads.ours, bytes, MANY, 0), MANY);
    for (size_t got = 0; got < MANY;) {
        const ssize_t n = recv(reads.theirs, text, sizeof text, 0);
        assert_true(n > 0);
        got += (size_t)n;
    }
    assert_true(hn_connections_end_slowest(all, 0));
    read_to_end(&stands, text);

    // each refused request asks for room: it is one reader, and not all of them, that is closed
    assert_false(hn_connections_end_slowest(all, 0));
    close_client(all, &reads);
    close_client(all, &stands);
    hn_connections_free(all);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_that_stands_still_is_told_so),
        cmocka_unit_test(who_does_not_read_is_closed_when_patience_is_over),
        cmocka_unit_test(who_reads_is_not_closed_before_who_does_not),
        cmocka_unit_test(a_connection_without_an_open_request_is_closed_without_a_word),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
