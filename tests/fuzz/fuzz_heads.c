// SPDX-License-Identifier: GPL-3.0-or-later
// Heads of requests: addresses with their queries, Host, Origin, X-Forwarded-For, Accept,
// If-None-Match, cookies and tokens, Last-Event-ID. The first byte chooses who asks and how the
// server was started; the rest is a head, in which $R stands for the id of a run that has ended and
// $C for that of a comparison. Work is done where it is a page or a stream of something that is
// there. A first byte of 255: the rest is the network of a proxy, as --proxy takes it.
#include "fuzz/fuzz.h"
#include "fuzz/stand_in.h"

#include "http/ground/jobs.h"
#include "http/live/comparisons.h"
#include "http/request/request.h"
#include "http/routes/routes.h"
#include "http/routes/static_files.h"
#include "http/runs/run_list.h"
#include "http/runs/runs.h"
#include "http/studies/studies.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { A_NETWORK = 255, ID = 64, LONGEST = 64 };

static hn_context context;
static hn_dispatch dispatch;
static char run_id[ID], comparison_id[ID];

/// One thread each; nothing ends while the harness runs.
static void choose_options(hn_http_opts *opts) {
    static const char *const names[] = {"mechanisms.example"};
    *opts = hn_http_opts_default();
    opts->pool = opts->quick_pool = 1;
    opts->idle_pause = opts->expiry = opts->orphan_expiry = 1e9;
    opts->max_run_cpu = 0.2;
    opts->allow_hosts = names;
    opts->n_allow_hosts = 1;
    if (!hn_network_read("10.0.0.0/8", &opts->proxies.network[0]) ||
        !hn_network_read("2001:db8::/33", &opts->proxies.network[1])) {
        hn_fuzz_fail("no networks");
    }
    opts->proxies.n = 2;
    context.hosts = (hn_hosts){.n = 1, .names = names};
}

static void ask(const char *head, size_t n, const char *body, const struct sockaddr *from,
                bool (*is_wanted)(const hn_request *r), hn_stand_in_answer *answer) {
    const hn_stand_in_request request = {.head = (const uint8_t *)head,
                                         .n_head = n,
                                         .body = body,
                                         .from = from,
                                         .is_wanted = is_wanted};
    hn_stand_in_ask(&dispatch, &request, answer);
}

static const struct sockaddr *loopback(void) {
    static struct sockaddr_in address = {.sin_family = AF_INET};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return (const struct sockaddr *)&address;
}

/// Makes a run or a comparison; `id` receives the last part of its address.
static void make(const char *path, const char *body, char id[ID]) {
    char head[256];
    const int n = snprintf(head, sizeof head,
                           "POST %s HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
                           "application/json\r\nContent-Length: %zu\r\n\r\n",
                           path, strlen(body));
    hn_stand_in_answer answer;
    ask(head, (size_t)n, body, loopback(), NULL, &answer);
    const char *last = strrchr(hn_strbuf_text(&answer.location), '/');
    if (answer.status != MHD_HTTP_CREATED || !last) {
        hn_fuzz_fail("%s: %u %s", path, answer.status, hn_strbuf_text(&answer.text));
    }
    snprintf(id, ID, "%s", last + 1);
    hn_stand_in_answer_reset(&answer);
}

static void prepare(void) {
    hn_diag diag = {0};
    hn_context *c = &context;
    c->lib = hn_fuzz_library();
    c->routes = hn_routes();
    choose_options(&c->opts);
    hn_stand_in_start();
    pthread_mutex_init(&c->scenes.lock, NULL);
    pthread_mutex_init(&c->openapi.lock, NULL);
    if (hn_static_files_create(hn_library_web(c->lib), &c->files, &diag) != HN_OK) {
        hn_fuzz_fail("%s", diag.message);
    }
    const hn_jobs_opts pool = hn_http_opts_pool(&c->opts);
    c->quick = c->heavy = hn_jobs_create(&pool, hn_dispatch_job);
    c->streams = hn_shares_create(c->opts.max_streams, c->opts.max_streams);
    c->comparisons = hn_comparisons_create(&c->opts, c->lib);
    c->studies = hn_studies_create(&c->opts, c->lib);
    c->runs = hn_runs_create(&c->opts, c->lib, hn_run_reply);
    c->run_list = hn_run_list_create(NULL);
    dispatch = (hn_dispatch){.context = c,
                             .quick = c->quick,
                             .heavy = c->heavy,
                             .connections = hn_connections_create(&c->opts)};
    if (!dispatch.connections || !c->quick || !c->streams || !c->comparisons || !c->studies ||
        !c->runs || !c->run_list) {
        hn_fuzz_fail("no memory");
    }
    make("/api/v1/runs",
         "{\"scene\":\"pendulum\",\"methods\":[\"index1@rk4:h=1e-2\",\"projection@rk4:h=1e-2\"],"
         "\"time\":0.2}",
         run_id);
    make("/api/v1/comparisons",
         "{\"scene\":\"pendulum\",\"methods\":[\"index1@rk4:h=1e-2\"],\"duration\":1}",
         comparison_id);
}

/// Returns whether the work is a page of something that is there: no body, no computing, no change.
static bool is_wanted(const hn_request *r) {
    const hn_route *route = r->route;
    return route && strcmp(route->method, "GET") == 0 &&
           (route->work == HN_WORK_LIGHT || route->work == HN_WORK_QUICK ||
            route->work == HN_WORK_QUICK_OWN || strcmp(route->path, "/api/v1/runs") == 0);
}

static void check(const hn_stand_in_answer *answer) {
    if (answer->status == MHD_HTTP_INTERNAL_SERVER_ERROR) {
        hn_fuzz_fail("500: %s", hn_strbuf_text(&answer->text));
    }
    if (answer->is_json && answer->text.n > 0) {
        hn_strbuf copy;
        hn_strbuf_init(&copy);
        hn_strbuf_add_n(&copy, hn_strbuf_text(&answer->text), answer->text.n);
        hn_fuzz_take_json(&copy);
    }
}

/// This machine, a proxy or a stranger; with a token or not, with guests or not.
static const struct sockaddr *choose_client(unsigned char choice) {
    static const char *const addresses[] = {"127.0.0.1", "10.1.2.3", "192.0.2.7", "2001:db8:1::2"};
    static struct sockaddr_in four;
    static struct sockaddr_in6 six;
    const char *text = addresses[choice % 4];
    context.opts.token = choice & 4 ? "SECRET-TOKEN" : NULL;
    context.opts.guests = choice & 8;
    context.hosts.any_address = choice & 16;
    four = (struct sockaddr_in){.sin_family = AF_INET};
    six = (struct sockaddr_in6){.sin6_family = AF_INET6};
    return inet_pton(AF_INET, text, &four.sin_addr) == 1    ? (const struct sockaddr *)&four
           : inet_pton(AF_INET6, text, &six.sin6_addr) == 1 ? (const struct sockaddr *)&six
                                                            : loopback();
}

/// The text with ids in place of $R and $C.
static void put_ids(hn_strbuf *b, const uint8_t *text, size_t n) {
    size_t from = 0;
    for (size_t i = 0; i + 1 < n; i++) {
        const char *id = text[i] != '$'       ? NULL
                         : text[i + 1] == 'R' ? run_id
                         : text[i + 1] == 'C' ? comparison_id
                                              : NULL;
        if (id) {
            hn_strbuf_add_n(b, (const char *)text + from, i - from);
            hn_strbuf_add(b, id);
            from = i + 2;
        }
    }
    hn_strbuf_add_n(b, (const char *)text + from, n - from);
}

/// A network holds its own address, and an address that is read is the one that the system reads.
static void read_network(const uint8_t *data, size_t size) {
    char *text = hn_fuzz_text(data, size), word[LONGEST];
    hn_network network = {0};
    hn_address address = {0}, again;
    if (hn_network_read(text, &network)) {
        const hn_proxies proxies = {.network = {network}, .n = 1};
        if (network.bits < 0 || network.bits > 8 * HN_ADDRESS_BYTES ||
            !hn_proxies_have(&proxies, &network.address)) {
            hn_fuzz_fail("the network '%s' has %d bits, or not its own address", text,
                         network.bits);
        }
    }
    if (hn_address_read(text, strlen(text), &address)) {
        if (!inet_ntop(AF_INET6, address.byte, word, sizeof word) ||
            !hn_address_read(word, strlen(word), &again) ||
            memcmp(&again, &address, sizeof again) != 0) {
            hn_fuzz_fail("the address '%s' is not read back", text);
        }
    }
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2) {
        return 0;
    }
    if (!context.lib) {
        prepare();
    }
    if (data[0] == A_NETWORK) {
        read_network(data + 1, size - 1);
        return 0;
    }
    hn_stand_in_answer answer;
    hn_strbuf head;
    hn_strbuf_init(&head);
    put_ids(&head, data + 1, size - 1);
    ask(hn_strbuf_text(&head), head.n, NULL, choose_client(data[0]), is_wanted, &answer);
    check(&answer);
    hn_stand_in_answer_reset(&answer);
    hn_strbuf_reset(&head);
    return 0;
}
