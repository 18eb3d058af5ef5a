// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of stability: the same cells whatever happens on the way, boundaries that agree, requests
// that are refused.
#include "session/stability/stability.h"
#include "session/stability/stability_column.h"
#include "session/stability/stability_doc.h"
#include "session/stability/stability_html.h"
#include "session/stability/stability_picture.h"

#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char PATH[] = "lessons/09-space-and-drives/scenes/stiff-four-bar.json";

static hn_status load(void *user, const hn_setting *settings, int n, hn_model **out,
                      hn_diags *diags) {
    const hn_model_source source = {.path = PATH, .settings = settings, .n_settings = n};
    (void)user;
    return hn_model_load(NULL, &source, out, diags);
}

static hn_job_request request_for(const hn_model *model, const char *over,
                                  const char *const *methods, int n) {
    hn_job_request r = hn_job_request_default(model);
    hn_diags diags = {0};
    assert_int_equal(hn_job_request_set_methods(&r, methods, n, &diags), HN_OK);
    hn_job_request_set_text(&r, "over", over);
    hn_job_request_set(&r, "columns", 6);
    hn_job_request_set(&r, "rows", 6);
    r.time = 0.2;
    r.limits.time_limit = 0;
    r.load = load;
    return r;
}

static hn_model *open_model(void) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    assert_int_equal(load(NULL, NULL, 0, &model, &diags), HN_OK);
    return model;
}

static hn_map *open_map(const hn_job_request *r) {
    hn_map *map = NULL;
    hn_diags diags = {0};
    if (hn_map_open(r, &map, &diags) != HN_OK) {
        fail_msg("%s", diags.item[0].message);
    }
    return map;
}

static const char *const METHODS[] = {"projection@rk4", "projection@dop853"};
static const char OVER[] = "h=1e-4..2e-1,k=1e4..1e8";

static void
the_observed_boundary_is_the_predicted_one_over_four_decades_of_stiffness(void **state) {
    (void)state;
    hn_model *model = open_model();
    const hn_job_request r = request_for(model, OVER, METHODS, 2);
    hn_map *map = open_map(&r);
    assert_int_equal(hn_map_run(map), 1);
    assert_string_equal(hn_map_y(map)->name, "h");
    assert_string_equal(hn_map_x(map)->name, "k");
    for (int m = 0; m < 2; m++) {
        const hn_map_agreement a = hn_map_agrees(map, m);
        assert_true(a.by_columns);
        assert_int_equal(a.compared, 6);
        assert_int_equal(a.agree, 6);
        for (int i = 0; i < 6; i++) {
            const hn_map_column *c = hn_map_get_column(map, m, i);
            assert_int_equal(c->n_predicted, 1);
            assert_true(c->unstable / c->stable <= HN_MAP_REFINED);
            // w^2 is in proportion to k: so is the limit to its root
            const double scale = sqrt(hn_map_x(map)->value[i] / hn_map_x(map)->value[0]);
            assert_rel(c->predicted[0] * scale, hn_map_get_column(map, m, 0)->predicted[0], 0.02);
        }
    }
    hn_map_free(map);
    hn_model_free(model);
}

static void text_of(const hn_map *map, hn_strbuf *b) {
    hn_strbuf_init(b);
    hn_map_csv(b, map);
}

static int stop_later(void *user) {
    int *left = user;
    return (*left)-- <= 0;
}

/// Stops a map after so many questions, and more each time, until it is finished.
static void interrupt(const char *over, const char *const *methods, int threads, int questions,
                      int more) {
    char folder[] = "/tmp/holonom-map-XXXXXX";
    assert_non_null(mkdtemp(folder));
    hn_model *model = open_model();
    hn_job_request r = request_for(model, over, methods, 1);
    hn_strbuf whole, pieces;
    hn_map *map = open_map(&r);
    assert_int_equal(hn_map_run(map), 1);
    text_of(map, &whole);
    hn_map_free(map);

    int left = 0, finished = 0, rounds = 0, resumed = 0;
    r.limits.threads = threads;
    r.limits.folder = folder;
    r.limits.stop = stop_later;
    r.limits.user = &left;
    while (!finished) {
        assert_true(++rounds < 200);
        left = questions + more * rounds;
        map = open_map(&r);
        resumed += hn_map_resumed(map) > 0;
        finished = hn_map_run(map);
        if (!finished) {
            assert_true(hn_map_stopped(map));
            hn_map_free(map);
        }
    }
    assert_true(resumed >= 2);
    text_of(map, &pieces);
    assert_string_equal(hn_strbuf_text(&whole), hn_strbuf_text(&pieces));
    hn_map_free(map);
    assert_int_equal(rmdir(folder), 0); // nothing is left of a finished map
    hn_strbuf_reset(&whole);
    hn_strbuf_reset(&pieces);
    hn_model_free(model);
}

static const char *const FEEDBACK[] = {"baumgarte@rk4:h=2e-3"};
static const char OVER_FEEDBACK[] = "alpha=1..1e3,beta=1..1e3";

static void a_map_interrupted_again_and_again_ends_as_an_undisturbed_one(void **state) {
    (void)state;
    interrupt(OVER, METHODS, 1, 150, 50);
    interrupt(OVER_FEEDBACK, FEEDBACK, 3, 0, 1);
}

/// The same map by several threads: every cell and column the same bytes, whoever tried it.
/// Of a map whose motion was cut short: what is left, by one thread or by several.
static void cut_short(const char *over, int threads) {
    hn_model *model = open_model();
    hn_job_request r = request_for(model, over, METHODS, 1);
    r.time = 19;                // tens of thousands of steps: no machine takes them
    r.limits.time_limit = 0.05; // in a part of this
    r.limits.threads = threads;
    hn_map *map = open_map(&r);
    assert_int_equal(hn_map_run(map), 0);
    assert_true(hn_map_out_of_time(map));
    for (int column = 0; column < hn_map_x(map)->n; column++) {
        for (int row = 0; row < hn_map_y(map)->n; row++) {
            const hn_map_cell *cell = hn_map_get(map, 0, column, row);
            assert_int_equal(cell->trial.kind, HN_STABILITY_PENDING);
        }
    }
    hn_map_free(map);
    hn_model_free(model);
}

static void cells_without_a_motion_in_time_wait_for_it(void **state) {
    (void)state;
    cut_short("h=1e-4..2e-1", 1);
    cut_short("h=1e-4..2e-1", 2);
    cut_short("h=1e-4..2e-1,k=1e7..1e8", 1);
}

static void what_the_time_limit_left_out_follows_with_a_longer_one(void **state) {
    (void)state;
    hn_model *model = open_model();
    hn_job_request r = request_for(model, OVER, METHODS, 1);
    hn_strbuf whole, pieces;
    hn_map *map = open_map(&r);
    assert_int_equal(hn_map_run(map), 1);
    text_of(map, &whole);
    hn_map_free(map);

    r.limits.time_limit = 1e-3;
    map = open_map(&r);
    assert_int_equal(hn_map_run(map), 0);
    assert_true(hn_map_out_of_time(map));
    hn_map_set_time_limit(map, 1e3);
    assert_int_equal(hn_map_run(map), 1);
    text_of(map, &pieces);
    assert_string_equal(hn_strbuf_text(&whole), hn_strbuf_text(&pieces));
    hn_map_free(map);
    hn_strbuf_reset(&whole);
    hn_strbuf_reset(&pieces);
    hn_model_free(model);
}

static void a_team_finds_what_one_thread_finds(void **state) {
    (void)state;
    static const char *const heun[] = {"index1@heun"};
    hn_model *model = open_model();
    hn_job_request r = request_for(model, OVER_FEEDBACK, FEEDBACK, 1);
    hn_job_request steps = request_for(model, "h=1e-4..2e-1", heun, 1);
    const hn_job_request *requests[] = {&r, &steps};
    for (int i = 0; i < 2; i++) {
        hn_strbuf alone, together;
        hn_job_request request = *requests[i];
        hn_map *one = open_map(&request);
        request.limits.threads = 3;
        hn_map *team = open_map(&request);
        assert_int_equal(hn_map_run(one), 1);
        assert_int_equal(hn_map_run(team), 1);
        text_of(one, &alone);
        text_of(team, &together);
        assert_string_equal(hn_strbuf_text(&alone), hn_strbuf_text(&together));
        hn_strbuf_reset(&alone);
        hn_strbuf_reset(&together);
        hn_map_free(one);
        hn_map_free(team);
    }
    hn_model_free(model);
}

static void documents_hold_every_cell_and_no_number_that_is_none(void **state) {
    (void)state;
    hn_model *model = open_model();
    const hn_job_request r = request_for(model, "alpha=10..1e4,beta=10..1e4",
                                         (const char *const[]){"baumgarte@rk4:h=1e-3"}, 1);
    hn_map *map = open_map(&r);
    hn_strbuf b;
    hn_diag diag = {0};
    assert_int_equal(hn_map_run(map), 1);
    hn_strbuf_init(&b);
    hn_map_html(&b, map);
    int titles = 0;
    for (const char *p = hn_strbuf_text(&b); (p = strstr(p, "<title>alpha")) != NULL; p++) {
        titles++;
    }
    assert_int_equal(titles, 36);
    assert_null(strstr(hn_strbuf_text(&b), "nan"));
    assert_null(strstr(hn_strbuf_text(&b), "<script"));
    hn_strbuf_clear(&b);
    hn_map_json(&b, map);
    assert_null(strstr(hn_strbuf_text(&b), "nan"));
    assert_non_null(strstr(hn_strbuf_text(&b), "\"by\":\"cells\""));
    hn_strbuf_clear(&b);
    assert_int_equal(hn_map_png(&b, map, &diag), HN_OK);
    assert_memory_equal(hn_strbuf_text(&b), "\x89PNG", 4);
    const hn_map_agreement a = hn_map_agrees(map, 0);
    assert_true(a.compared >= 30);
    assert_int_equal(a.agree, a.compared);
    hn_strbuf_reset(&b);
    hn_map_free(map);
    hn_model_free(model);
}

static void requests_at_fault_are_told_by_field(void **state) {
    (void)state;
    static const char *const overs[] = {
        "h=1e-4..1e-1,h=1..2",   "k=5..1",  "k",           "h=0..1", "zeta=1..2",
        "k=1..2,m2=1..2,g=0..1", "k=-5..5", "h=1e-9..1e-8"};
    hn_model *model = open_model();
    for (size_t i = 0; i < sizeof overs / sizeof *overs; i++) {
        const hn_job_request r = request_for(model, overs[i], METHODS, 1);
        hn_map *map = NULL;
        hn_diags diags = {0};
        const hn_status status = hn_map_open(&r, &map, &diags);
        if (status != HN_ERR_INPUT && status != HN_ERR_LIMIT) {
            fail_msg("%s gave status %d", overs[i], (int)status);
        }
        assert_null(map);
        assert_true(diags.n > 0);
    }
    hn_model_free(model);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_observed_boundary_is_the_predicted_one_over_four_decades_of_stiffness),
        cmocka_unit_test(a_map_interrupted_again_and_again_ends_as_an_undisturbed_one),
        cmocka_unit_test(cells_without_a_motion_in_time_wait_for_it),
        cmocka_unit_test(what_the_time_limit_left_out_follows_with_a_longer_one),
        cmocka_unit_test(a_team_finds_what_one_thread_finds),
        cmocka_unit_test(documents_hold_every_cell_and_no_number_that_is_none),
        cmocka_unit_test(requests_at_fault_are_told_by_field),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
