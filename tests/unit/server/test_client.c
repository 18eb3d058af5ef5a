// SPDX-License-Identifier: GPL-3.0-or-later
// Addresses that count as one client.
#include "http/request/client.h"

#include "support/near.h"

#include <arpa/inet.h>
#include <netinet/in.h>

/// The client of a connection from here, to a server that was told of the proxies in 10.9.0.0/16.
static hn_client client_of(const char *text) {
    hn_proxies told = {.n = 1};
    assert_true(hn_network_read("10.9.0.0/16", &told.network[0]));
    struct sockaddr_in four = {.sin_family = AF_INET};
    struct sockaddr_in6 six = {.sin6_family = AF_INET6};
    if (inet_pton(AF_INET6, text, &six.sin6_addr) == 1) {
        return hn_client_of_connection(&told, (const struct sockaddr *)&six);
    }
    assert_int_equal(inet_pton(AF_INET, text, &four.sin_addr), 1);
    return hn_client_of_connection(&told, (const struct sockaddr *)&four);
}

static void this_machine_is_itself_by_either_family(void **state) {
    (void)state;
    assert_true(hn_client_of_connection(&(hn_proxies){0}, NULL) == 0);
    assert_true(client_of("127.0.0.1") == 0);
    assert_true(client_of("::1") == 0);
    assert_true(client_of("::ffff:127.0.0.1") == 0);
    assert_true(client_of("::ffff:127.0.0.2") != 0);
}

static void an_address_is_one_client_by_either_family(void **state) {
    (void)state;
    assert_true(client_of("10.0.0.1") == client_of("::ffff:10.0.0.1"));
    assert_true(client_of("10.0.0.1") != client_of("10.0.0.2"));
    assert_true(client_of("::ffff:10.0.0.1") != client_of("::ffff:10.0.0.2"));
}

static void the_addresses_of_one_household_are_one_client(void **state) {
    (void)state;
    assert_true(client_of("2001:db8:1:2::1") == client_of("2001:db8:1:2:a:b:c:d"));
    assert_true(client_of("2001:db8:1:2::1") != client_of("2001:db8:1:3::1"));
}

static void a_proxy_may_have_every_place(void **state) {
    (void)state;
    assert_true(client_of("10.9.0.1") == 0);
    assert_true(client_of("::ffff:10.9.255.254") == 0);
    assert_true(client_of("10.10.0.1") != 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(this_machine_is_itself_by_either_family),
        cmocka_unit_test(an_address_is_one_client_by_either_family),
        cmocka_unit_test(the_addresses_of_one_household_are_one_client),
        cmocka_unit_test(a_proxy_may_have_every_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
