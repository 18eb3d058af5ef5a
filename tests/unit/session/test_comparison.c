// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"
#include "support/shipped_library.h"

#include "session/compare/comparison_doc.h"
#include "session/compare/run_doc.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static hn_model *load(const char *name) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    const hn_model_source source = {.name = name};
    if (hn_model_load(hn_test_library, &source, &model, &diags) != HN_OK) {
        fail_msg("%s: %s %s", name, diags.item[0].pointer, diags.item[0].message);
    }
    return model;
}

static hn_comparison *compare(const hn_model *model, const char *const *methods, int n,
                              const hn_comparison_opts *opts) {
    hn_comparison *c = NULL;
    hn_diags diags = {0};
    if (hn_comparison_create(model, methods, n, opts, &c, &diags) != HN_OK) {
        fail_msg("%s: %s", diags.item[0].pointer, diags.item[0].message);
    }
    return c;
}

/// The text of one frame; free() it.
static char *frame_text(hn_comparison *c) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_comparison_frame_json(&b, c);
    char *text = hn_strbuf_take(&b);
    assert_non_null(text);
    return text;
}

static double number(const cJSON *object, const char *key) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

static const char *const FIVE[] = {"index1@rk4:h=0.01", "baumgarte:alpha=5,beta=5@rk4:h=0.01",
                                   "projection@rk4:h=0.01", "nullspace@rk4:h=0.01",
                                   "reduced@rk4:h=0.01"};

static void the_cost_of_a_step_is_a_median_over_warm_frames(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    hn_comparison *c = compare(model, FIVE, 5, NULL);
    for (int frame = 0; frame < 40; frame++) {
        // too few frames, and the first ones, say nothing
        if (frame < HN_STEP_COST_FRAMES) {
            assert_true(isnan(hn_comparison_step_cost(c, 0).median));
        }
        hn_comparison_next(c);
    }
    for (int i = 0; i < 5; i++) {
        const hn_step_cost cost = hn_comparison_step_cost(c, i);
        assert_int_equal(cost.frames, 37); // three cold ones are left out
        assert_true(cost.low > 0 && cost.low <= cost.median && cost.median <= cost.high);
    }
    hn_comparison_reset(c);
    assert_true(isnan(hn_comparison_step_cost(c, 0).median));
    hn_comparison_free(c);
    hn_model_free(model);
}

static void a_scene_without_methods_gets_some(void **state) {
    (void)state;
    hn_model *model = load("four-bar"), *plain = NULL;
    hn_diags diags = {0};
    cJSON *scene = cJSON_Parse(hn_model_scene(model)->text);
    cJSON_DeleteItemFromObjectCaseSensitive(scene, "methods");
    char *text = cJSON_PrintUnformatted(scene);
    const hn_model_source source = {.text = text, .n_text = strlen(text)};
    assert_int_equal(hn_model_load(hn_test_library, &source, &plain, &diags), HN_OK);
    int n = 0;
    const char *const *methods = hn_model_methods(plain, &n);
    assert_int_equal(n, 3);
    // the first alone drifts, so a run without a method takes the second
    assert_string_equal(hn_model_method(plain), methods[1]);
    hn_comparison *c = compare(plain, methods, n, NULL);
    hn_comparison_next(c);
    hn_comparison_free(c);
    cJSON_free(text);
    cJSON_Delete(scene);
    hn_model_free(plain);
    hn_model_free(model);
}

static void all_methods_share_one_clock_and_one_start(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    hn_comparison *c = compare(model, FIVE, 5, NULL);
    assert_near(hn_comparison_frame_dt(c), 0.02, 1e-15); // two steps of 0.01 s are above 1/60 s
    hn_sample first = {0}, other = {0};
    const int n = hn_system_get_info(hn_model_system(model)).n_user;
    assert_true(hn_comparison_sample(c, 0, &first));
    for (int i = 1; i < 5; i++) {
        assert_true(hn_comparison_sample(c, i, &other));
        assert_all_near(other.q, first.q, (size_t)n, 1e-14);
    }
    for (int k = 0; k < 10; k++) {
        hn_comparison_next(c);
    }
    assert_int_equal(hn_comparison_frame(c), 10);
    for (int i = 0; i < 5; i++) {
        assert_true(hn_comparison_sample(c, i, &other));
        assert_near(other.t, 0.2, 1e-14);
        assert_int_equal(hn_run_get_summary(hn_comparison_run(c, i)).steps, 20);
    }
    hn_comparison_free(c);
    hn_model_free(model);
}

// 0.03 s in frames of 1/60 s would be over before anything could be seen
static void a_short_run_has_hundreds_of_frames(void **state) {
    (void)state;
    hn_model *model = load("seven-body-squeezer");
    hn_comparison *c = compare(model, (const char *const[]){"projection@rk4:h=2e-5"}, 1, NULL);
    // whole steps, at least 0.03 s / 240, and whole frames up to the end
    assert_near(hn_comparison_frame_dt(c), 2e-4, 1e-15);
    hn_comparison_free(c);
    c = compare(model, (const char *const[]){"projection@dopri5:rtol=1e-6"}, 1, NULL);
    assert_near(hn_comparison_frame_dt(c), 0.03 / 240, 1e-15);
    hn_comparison_free(c);
    hn_model_free(model);
}

// 17 steps of 1 ms are the least above 1/60 s; frames of 17 ms would pass 5 s by 15 ms
static void the_last_frame_is_at_the_end(void **state) {
    (void)state;
    hn_model *model = load("slider-crank");
    hn_comparison *c = compare(model, (const char *const[]){"projection@rk4:h=1e-3"}, 1, NULL);
    assert_near(hn_comparison_frame_dt(c), 0.02, 1e-15);
    const double frames = hn_comparison_duration(c) / hn_comparison_frame_dt(c);
    assert_near(frames, round(frames), 1e-9);
    hn_comparison_free(c);

    // a prime number of steps has no such frames
    hn_comparison_opts opts = hn_comparison_opts_default();
    opts.duration = 4.999;
    c = compare(model, (const char *const[]){"projection@rk4:h=1e-3"}, 1, &opts);
    assert_near(hn_comparison_frame_dt(c), 0.017, 1e-15);
    hn_comparison_free(c);
    hn_model_free(model);
}

static void a_second_comparison_and_a_reset_give_the_same_bits(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    hn_comparison *c[2] = {compare(model, FIVE, 5, NULL), compare(model, FIVE, 5, NULL)};
    hn_comparison_next(c[0]);
    hn_comparison_reset(c[0]);
    const int n = hn_system_get_info(hn_model_system(model)).n_user;
    for (int k = 0; k < 50; k++) {
        hn_comparison_next(c[0]);
        hn_comparison_next(c[1]);
    }
    for (int i = 0; i < 5; i++) {
        hn_sample a = {0}, b = {0};
        assert_true(hn_comparison_sample(c[0], i, &a));
        assert_true(hn_comparison_sample(c[1], i, &b));
        assert_memory_equal(a.q, b.q, (size_t)n * sizeof(double));
        assert_memory_equal(a.v, b.v, (size_t)n * sizeof(double));
    }
    hn_comparison_free(c[0]);
    hn_comparison_free(c[1]);
    hn_model_free(model);
}

// alpha h = 20 is far above the 2.785 at which RK4 still damps the gap: the state blows up
static void a_failed_method_stays_with_its_last_state_and_its_reason(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    const char *const methods[] = {"baumgarte:alpha=200,beta=200@rk4:h=0.1",
                                   "projection@rk4:h=0.01"};
    hn_comparison *c = compare(model, methods, 2, &(hn_comparison_opts){.duration = 4});
    while (!hn_comparison_finished(c)) {
        hn_comparison_next(c);
    }
    assert_near((double)hn_comparison_frame(c) * hn_comparison_frame_dt(c), 4, 1e-9);
    const hn_run_summary s = hn_run_get_summary(hn_comparison_run(c, 0));
    assert_int_equal(s.state, HN_RUN_FAILED);
    assert_true(strlen(s.reason) > 10);
    assert_int_equal(hn_run_get_summary(hn_comparison_run(c, 1)).status, HN_OK);
    char *text = frame_text(c), *again = frame_text(c);
    assert_string_equal(text, again); // writing a frame changes nothing
    free(again);
    cJSON *frame = cJSON_Parse(text);
    assert_non_null(frame);
    const cJSON *failed = cJSON_GetArrayItem(cJSON_GetObjectItem(frame, "methods"), 0);
    assert_string_equal(cJSON_GetObjectItem(failed, "state")->valuestring, "failed");
    assert_true(number(failed, "t") < 4);
    const cJSON *points = cJSON_GetObjectItem(failed, "points");
    assert_true(cJSON_GetArraySize(points) > 0);
    const cJSON *p;
    cJSON_ArrayForEach(p, points) {
        assert_true(cJSON_IsNumber(p)); // null would be a coordinate that is not finite
    }
    cJSON_Delete(frame);
    free(text);
    hn_comparison_free(c);
    hn_model_free(model);
}

static void bad_methods_are_named_by_their_place(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    hn_comparison *c = NULL;
    hn_diags diags = {0};
    const char *const methods[] = {"index1@rk4:h=0.01", "baumgart@rk4:h=0.01"};
    assert_int_equal(hn_comparison_create(model, methods, 2, NULL, &c, &diags), HN_ERR_INPUT);
    assert_string_equal(diags.item[0].pointer, "/methods/1");
    assert_non_null(strstr(diags.item[0].hint, "baumgarte"));
    diags = (hn_diags){0};
    assert_int_equal(hn_comparison_create(model, methods, 0, NULL, &c, &diags), HN_ERR_INPUT);
    assert_string_equal(diags.item[0].pointer, "/methods");
    hn_model_free(model);
}

// negative damping opens the loop on purpose: allowed, and said
static void a_spelling_that_deserves_a_word_gets_one(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    const char *const methods[] = {"baumgarte:alpha=-5@rk4:h=0.01", "baumgarte@rk4:h=0.01"};
    hn_comparison *c = compare(model, methods, 2, NULL);
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_comparison_summary_json(&b, c);
    cJSON *doc = cJSON_Parse(hn_strbuf_text(&b));
    const cJSON *list = cJSON_GetObjectItem(doc, "methods");
    const cJSON *warning = cJSON_GetObjectItem(cJSON_GetArrayItem(list, 0), "warning");
    assert_true(cJSON_IsString(warning));
    assert_non_null(strstr(warning->valuestring, "alpha"));
    assert_null(cJSON_GetObjectItem(cJSON_GetArrayItem(list, 1), "warning"));
    cJSON_Delete(doc);
    hn_strbuf_reset(&b);
    hn_comparison_free(c);
    hn_model_free(model);
}

static void two_methods_of_one_formulation_get_two_colours(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    const char *const methods[] = {"index1@rk4:h=0.01", "index1@rk4:h=0.02",
                                   "baumgarte@rk4:h=0.01"};
    hn_comparison *c = compare(model, methods, 3, NULL);
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_comparison_json(&b, c);
    cJSON *doc = cJSON_Parse(hn_strbuf_text(&b));
    assert_non_null(doc);
    const cJSON *list = cJSON_GetObjectItem(doc, "methods");
    const double first = number(cJSON_GetArrayItem(list, 0), "slot");
    const double second = number(cJSON_GetArrayItem(list, 1), "slot");
    const double third = number(cJSON_GetArrayItem(list, 2), "slot");
    assert_true(first != second && second != third && first != third);
    cJSON_Delete(doc);
    hn_strbuf_reset(&b);
    hn_comparison_free(c);
    hn_model_free(model);
}

static void eight_methods_get_eight_looks(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    const char *const methods[HN_COMPARISON_MAX_METHODS] = {
        "index1@rk4:h=0.01",       "index1@rk4:h=0.02",     "baumgarte@rk4:h=0.01",
        "projection@rk4:h=0.01",   "reduced@rk4:h=0.01",    "projection@rk4:h=0.02",
        "baumgarte@dopri5:h=0.01", "projection@rk4:h=0.03",
    };
    hn_comparison *c = compare(model, methods, HN_COMPARISON_MAX_METHODS, NULL);
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_comparison_json(&b, c);
    cJSON *doc = cJSON_Parse(hn_strbuf_text(&b));
    const cJSON *list = cJSON_GetObjectItem(doc, "methods");
    unsigned seen = 0;
    for (int i = 0; i < HN_COMPARISON_MAX_METHODS; i++) {
        seen |= 1U << (int)number(cJSON_GetArrayItem(list, i), "slot");
    }
    assert_int_equal(seen, (1U << HN_COMPARISON_MAX_METHODS) - 1);
    cJSON_Delete(doc);
    hn_strbuf_reset(&b);
    hn_comparison_free(c);
    hn_model_free(model);
}

static cJSON *run_document(const hn_model *model, const hn_run_request *request, hn_status *ended) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_diags diags = {0};
    if (hn_model_run_json(&b, model, request, ended, &diags) != HN_OK) {
        fail_msg("%s: %s", diags.item[0].pointer, diags.item[0].message);
    }
    cJSON *doc = cJSON_Parse(hn_strbuf_text(&b));
    assert_non_null(doc);
    hn_strbuf_reset(&b);
    return doc;
}

static void the_columns_of_a_run_have_one_length(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    hn_status ended = HN_ERR_INTERNAL;
    const hn_run_request request = {
        .method = "projection@dopri5:rtol=1e-8", .time = 1, .every = 0.3};
    cJSON *doc = run_document(model, &request, &ended);
    assert_int_equal(ended, HN_OK);
    const cJSON *samples = cJSON_GetObjectItem(doc, "samples");
    const cJSON *column;
    cJSON_ArrayForEach(column, samples) {
        assert_int_equal(cJSON_GetArraySize(column), 5); // 0, 0.3, 0.6, 0.9 and the end
    }
    const cJSON *t = cJSON_GetObjectItem(samples, "t");
    assert_near(cJSON_GetArrayItem(t, 3)->valuedouble, 0.9, 1e-12);
    assert_near(cJSON_GetArrayItem(t, 4)->valuedouble, 1, 0);
    cJSON_Delete(doc);
    hn_model_free(model);
}

// 0.0137 is no multiple of the step: the sample comes from a side step, and the run goes on as if
// nobody had looked
static void looking_between_steps_does_not_change_a_run(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    hn_status ended = HN_ERR_INTERNAL;
    const double at[] = {0.0137, 0.5}, end[] = {0.5};
    const hn_run_request often = {.method = "index1@rk4:h=0.01", .time = 0.5, .at = at, .n_at = 2};
    const hn_run_request once = {.method = "index1@rk4:h=0.01", .time = 0.5, .at = end, .n_at = 1};
    cJSON *a = run_document(model, &often, &ended), *b = run_document(model, &once, &ended);
    const cJSON *qa =
        cJSON_GetArrayItem(cJSON_GetObjectItem(cJSON_GetObjectItem(a, "samples"), "q"), 1);
    const cJSON *qb =
        cJSON_GetArrayItem(cJSON_GetObjectItem(cJSON_GetObjectItem(b, "samples"), "q"), 0);

    // to the last bit: cJSON_Compare() would pass a difference in it
    const int n = cJSON_GetArraySize(qa);
    assert_true(n > 0 && n == cJSON_GetArraySize(qb));
    for (int i = 0; i < n; i++) {
        const double p = cJSON_GetArrayItem(qa, i)->valuedouble;
        assert_true(p == cJSON_GetArrayItem(qb, i)->valuedouble);
    }
    cJSON_Delete(a);
    cJSON_Delete(b);
    hn_model_free(model);
}

static int stop_at_once(void *user, double share) {
    (void)share;
    return (*(int *)user)++ < 1;
}

static void a_run_stops_when_it_is_told_to(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    hn_status ended = HN_OK;
    int asked = 0;
    const hn_run_request request = {.method = "index1@rk4:h=1e-6",
                                    .time = 1000,
                                    .every = 1000,
                                    .progress = stop_at_once,
                                    .user = &asked};
    cJSON *doc = run_document(model, &request, &ended);
    assert_int_equal(ended, HN_ERR_STOPPED);
    assert_true(number(doc, "t_reached") < 1);
    cJSON_Delete(doc);
    hn_model_free(model);
}

static void bad_requests_name_their_field(void **state) {
    (void)state;
    hn_model *model = load("four-bar");
    const double back[] = {1, 0.5}, late[] = {2};
    const struct {
        hn_run_request request;
        const char *pointer;
        hn_status status;
    } cases[] = {
        {{.method = "index1@rk4:h=0.01", .time = 0}, "/time", HN_ERR_INPUT},
        {{.method = "index1@rk4:h=0.01", .time = (double)NAN}, "/time", HN_ERR_INPUT},
        {{.method = "index1@rk4:h=0.01", .time = 1, .every = -1}, "/every", HN_ERR_INPUT},
        {{.method = "index1@rk4:h=0.01", .time = 1, .every = 1e-12}, "/every", HN_ERR_LIMIT},
        {{.method = "index1@rk4:h=0.01", .time = 1, .at = back, .n_at = 2}, "/at", HN_ERR_INPUT},
        {{.method = "index1@rk4:h=0.01", .time = 1, .at = late, .n_at = 1}, "/at", HN_ERR_INPUT},
        {{.method = "index1@rk4:h=0", .time = 1}, "/method", HN_ERR_INPUT},
        {{.method = "", .time = 1}, "/method", HN_ERR_INPUT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_diags diags = {0};
        hn_status ended = HN_OK;
        const hn_status status = hn_model_run_json(&b, model, &cases[i].request, &ended, &diags);
        assert_int_equal(status, cases[i].status);
        assert_string_equal(diags.item[0].pointer, cases[i].pointer);
        assert_int_equal(b.n, 0);
        hn_strbuf_reset(&b);
    }
    hn_model_free(model);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_cost_of_a_step_is_a_median_over_warm_frames),
        cmocka_unit_test(a_scene_without_methods_gets_some),
        cmocka_unit_test(all_methods_share_one_clock_and_one_start),
        cmocka_unit_test(a_short_run_has_hundreds_of_frames),
        cmocka_unit_test(the_last_frame_is_at_the_end),
        cmocka_unit_test(a_second_comparison_and_a_reset_give_the_same_bits),
        cmocka_unit_test(a_failed_method_stays_with_its_last_state_and_its_reason),
        cmocka_unit_test(bad_methods_are_named_by_their_place),
        cmocka_unit_test(a_spelling_that_deserves_a_word_gets_one),
        cmocka_unit_test(two_methods_of_one_formulation_get_two_colours),
        cmocka_unit_test(eight_methods_get_eight_looks),
        cmocka_unit_test(the_columns_of_a_run_have_one_length),
        cmocka_unit_test(looking_between_steps_does_not_change_a_run),
        cmocka_unit_test(a_run_stops_when_it_is_told_to),
        cmocka_unit_test(bad_requests_name_their_field),
    };
    return cmocka_run_group_tests(tests, hn_test_library_open, hn_test_library_close);
}
