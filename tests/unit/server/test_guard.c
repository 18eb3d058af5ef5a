// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/guard.h"

#include "support/near.h"

#include <string.h>

static void loopback_names_are_ours_and_names_that_look_alike_are_not(void **state) {
    static const char *const ours[] = {"localhost", "localhost:8080", "127.0.0.1", "127.0.0.1:1",
                                       "[::1]",     "[::1]:8080",     "LocalHost"};
    static const char *const foreign[] = {
        "",          ":80",        "localhost.example", "127.0.0.1.example",
        "127.0.0.2", "localhost:", "localhost:80:80",   "localhost:8x",
        "[::1",      "::1",        "10.0.0.1"};
    const hn_hosts none = {0};
    (void)state;
    for (size_t i = 0; i < sizeof ours / sizeof *ours; i++) {
        assert_true(hn_host_is_ours(&none, ours[i]));
    }
    for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++) {
        int is_ours = hn_host_is_ours(&none, foreign[i]);
        // an empty port is what RFC 3986 allows
        assert_int_equal(is_ours, strcmp(foreign[i], "localhost:") == 0);
    }
}

static void bound_to_every_interface_addresses_are_ours_and_names_are_not(void **state) {
    const char *names[] = {"bench"};
    const hn_hosts hosts = {.n = 1, .names = names, .any_address = 1};
    (void)state;
    assert_true(hn_host_is_ours(&hosts, "10.1.2.3:8080"));
    assert_true(hn_host_is_ours(&hosts, "[fe80::1]:8080"));
    assert_true(hn_host_is_ours(&hosts, "bench:8080"));
    assert_false(hn_host_is_ours(&hosts, "other:8080"));
    assert_false(hn_host_is_ours(&hosts, "10.1.2.3.example"));
}

static void accept_headers_are_read_as_http_has_them(void **state) {
    static const struct {
        const char *accept;
        int json;
    } rows[] = {
        {NULL, 1},
        {"*/*", 1},
        {"application/json", 1},
        {"APPLICATION/JSON", 1},
        {"application/*", 1},
        {"text/html", 0},
        {"", 0},
        {"application/jsonx", 0},
        {"application/json;q=0", 0},
        {"application/json;q=0.000", 0},
        {"application/json;q=0.001", 1},
        {"*/*, application/json;q=0", 0},
        {"text/html, */*;q=0.1", 1},
        {" text/html ,application/json ; q=0.5 ", 1},
        {"application/json;level=1;q=0", 0},
        {"application/json;Q=0.000", 0},
        {"application/json;q=maybe", 1},
        {"application/*;q=0, */*", 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(hn_accepts(rows[i].accept, "application/json"), rows[i].json);
    }
}

static void the_weight_of_a_type_is_that_of_the_closest_range(void **state) {
    static const struct {
        const char *accept;
        int weight;
    } rows[] = {
        {"application/json", 1000},
        {"application/json;q=1.000", 1000},
        {"application/json;q=0.25", 250},
        {"application/json;q=0.9999", 999},
        {"application/json ; charset=utf-8 ; q=0.001", 1},
        {"*/*;q=0.9, application/*;q=0.5, application/json;q=0.1", 100},
        {"application/json;q=0.1, */*;q=0.9", 100},
        {"*/*;q=0.3, application/*;q=0.5", 500},
        {"text/csv;q=0.7", 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(hn_accept_weight(rows[i].accept, "application/json"), rows[i].weight);
    }
    assert_int_equal(hn_accept_weight(NULL, "text/csv"), hn_accept_weight(NULL, "image/png"));
}

static void json_types_may_have_parameters(void **state) {
    (void)state;
    assert_true(hn_is_json_type("application/json"));
    assert_true(hn_is_json_type("Application/JSON; charset=utf-8"));
    assert_true(hn_is_json_type("application/json;a=b; charset=\"UTF-8\""));
    assert_false(hn_is_json_type("application/json; charset=utf-16"));
    assert_false(hn_is_json_type("application/json;charset=\"iso-8859-1\""));
    assert_false(hn_is_json_type("application/json; charset="));
    assert_false(hn_is_json_type("application/jsonp"));
    assert_false(hn_is_json_type("text/json"));
    assert_false(hn_is_json_type(NULL));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loopback_names_are_ours_and_names_that_look_alike_are_not),
        cmocka_unit_test(bound_to_every_interface_addresses_are_ours_and_names_are_not),
        cmocka_unit_test(accept_headers_are_read_as_http_has_them),
        cmocka_unit_test(the_weight_of_a_type_is_that_of_the_closest_range),
        cmocka_unit_test(json_types_may_have_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
