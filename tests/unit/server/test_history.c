// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/live/history.h"

#include "support/near.h"

#include <stdio.h>
#include <string.h>

static void add(hn_history *h, hn_event_kind kind, const char *text) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_strbuf_add(&b, text);
    hn_history_add(h, kind, &b);
    assert_null(b.text); // taken
}

static void ids_start_at_one_and_only_grow(void **state) {
    hn_history h;
    (void)state;
    assert_int_equal(hn_history_init(&h, 3, 1000), HN_OK);
    assert_int_equal(hn_history_first_id(&h), 1);
    for (int i = 1; i <= 10; i++) {
        char text[16];
        snprintf(text, sizeof text, "e%d", i);
        add(&h, HN_EVENT_FRAME, text);
        assert_int_equal(h.last_id, i);
        assert_string_equal(hn_history_find(&h, (uint64_t)i)->data, text);
    }
    hn_history_reset(&h);
}

static void the_oldest_goes_when_there_are_too_many(void **state) {
    hn_history h;
    (void)state;
    assert_int_equal(hn_history_init(&h, 3, 1000), HN_OK);
    for (int i = 0; i < 5; i++) {
        add(&h, HN_EVENT_STATE, "x");
    }
    assert_int_equal(hn_history_first_id(&h), 3);
    assert_null(hn_history_find(&h, 2));
    assert_int_equal(hn_history_find(&h, 3)->id, 3);
    assert_int_equal(hn_history_find(&h, 5)->id, 5);
    assert_null(hn_history_find(&h, 6));
    hn_history_reset(&h);
}

static void the_oldest_go_when_they_hold_too_many_bytes(void **state) {
    hn_history h;
    (void)state;
    assert_int_equal(hn_history_init(&h, 100, 10), HN_OK);
    add(&h, HN_EVENT_FRAME, "1234");
    add(&h, HN_EVENT_FRAME, "1234");
    add(&h, HN_EVENT_INCIDENT, "1234");
    assert_int_equal(hn_history_first_id(&h), 2);
    assert_int_equal(h.bytes, 8);
    assert_int_equal(h.last_frame_id, 2);
    hn_history_reset(&h);
}

static void the_newest_is_kept_however_large(void **state) {
    hn_history h;
    (void)state;
    assert_int_equal(hn_history_init(&h, 100, 10), HN_OK);
    add(&h, HN_EVENT_FRAME, "12");
    add(&h, HN_EVENT_RESET, "this is far more than ten bytes");
    assert_int_equal(hn_history_first_id(&h), 2);
    assert_non_null(hn_history_find(&h, 2));
    hn_history_reset(&h);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ids_start_at_one_and_only_grow),
        cmocka_unit_test(the_oldest_goes_when_there_are_too_many),
        cmocka_unit_test(the_oldest_go_when_they_hold_too_many_bytes),
        cmocka_unit_test(the_newest_is_kept_however_large),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
