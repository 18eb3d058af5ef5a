// SPDX-License-Identifier: GPL-3.0-or-later
// Kinds of answers about a motion: a plot that is read, a configuration that is predicted, and a
// scene with a property. Expected numbers come from closed forms: the triangle of a four-bar, the
// circle of a crank, Grashof's criterion.
#include "grade/exercise_check.h"
#include "grade/grade.h"
#include "grade/parts/circuit.h"
#include "grade/variant_text.h"

#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979324;
static hn_library *lib;

#define HEAD                                                                                  \
    "{\"exercise\":2,\"id\":\"t\",\"title\":\"t\",\"lesson\":\"l\",\"section\":\"s\","        \
    "\"statement\":[\"A mechanism.\"],\"draw\":{\"l1\":{\"range\":[0.42,0.5],\"digits\":2},"  \
    "\"t1\":{\"range\":[0.6,2.4],\"digits\":2},\"x\":{\"range\":[0.5,0.9],\"hidden\":true}}," \
    "\"parts\":["

// the crank of l1 against a coupler of 1.2 m, a rocker of 0.8 m and a ground of 1 m
static const char PREDICTED[] =
    HEAD "{\"id\":\"a\",\"ask\":\"where?\",\"kind\":\"configuration\",\"points\":2,"
         "\"scene\":\"four-bar\",\"set\":[\"l1\"],\"hold\":{\"th1\":\"t1\"},"
         "\"asked\":[\"a2\",\"th3\"]},"
         "{\"id\":\"b\",\"ask\":\"where?\",\"kind\":\"configuration\",\"points\":2,"
         "\"scene\":\"four-bar\",\"set\":{\"l1\":\"l1\"},\"time\":0.3,"
         "\"method\":\"projection@rk4:h=0.002\",\"second\":\"reduced@dop853:rtol=1e-10\","
         "\"asked\":[\"th1\",\"th3\"]}]}";

static const char READ[] =
    HEAD "{\"id\":\"a\",\"ask\":\"largest?\",\"kind\":\"reading\",\"points\":2,"
         "\"scene\":\"four-bar\",\"set\":[\"l1\"],\"method\":\"projection@rk4:h=0.01\","
         "\"second\":\"reduced@dop853:rtol=1e-9\",\"time\":3,\"curve\":\"th3\","
         "\"read\":\"largest\"},"
         "{\"id\":\"b\",\"ask\":\"when?\",\"kind\":\"reading\",\"points\":2,"
         "\"scene\":\"four-bar\",\"set\":[\"l1\"],\"method\":\"projection@rk4:h=0.01\","
         "\"second\":\"reduced@dop853:rtol=1e-9\",\"time\":3,\"curve\":\"w1\","
         "\"read\":\"at\",\"number\":\"0\",\"unit\":\"deg/s\"}]}";

static const char MADE[] =
    HEAD "{\"id\":\"a\",\"ask\":\"double crank\",\"kind\":\"scene\",\"points\":2,"
         "\"scene\":\"four-bar\",\"free\":[\"l1\",\"l2\",\"l3\",\"l4\"],"
         "\"limits\":{\"l1\":[0.1,2]},\"checks\":[{\"id\":\"type\",\"test\":\"grashof\","
         "\"type\":\"double-crank\",\"links\":[\"l4\",\"l1\",\"l2\",\"l3\"],"
         "\"neighbours\":[\"th1\",\"th3\"],\"says\":\"no double crank\",\"share\":0.25}],"
         "\"answer\":{\"l4\":\"x/2\",\"l1\":\"1.2*x\",\"l2\":\"1.1*x\",\"l3\":\"1.3*x\"},"
         "\"faults\":[{\"id\":\"type\",\"answer\":{\"l1\":0.5,\"l2\":1.2,\"l3\":0.8,\"l4\":1}}]},"
         "{\"id\":\"b\",\"ask\":\"curve\",\"kind\":\"scene\",\"points\":3,"
         "\"scene\":\"four-bar\",\"free\":[\"l1\"],\"checks\":[{\"id\":\"flat\","
         "\"test\":\"stays\",\"of\":\"abs(sin(th3-th1-a2))-0.2\",\"says\":\"too flat\"},"
         "{\"id\":\"misses\",\"test\":\"curve\",\"point\":\"A\","
         "\"through\":[[\"0\",\"0.45\"],[\"-0.45\",\"0\"],[\"0.27\",\"-0.36\"]],"
         "\"within\":0.005,\"says\":\"off\"}],\"answer\":{\"l1\":0.45},"
         "\"faults\":[{\"id\":\"flat\",\"answer\":{\"l1\":0.59}},"
         "{\"id\":\"misses\",\"answer\":{\"l1\":0.5}}]}]}";

// a scene that can be used, without the links that are compared
#define PENDULUM                                                                                  \
    "{\"holonom\":1,\"name\":\"rod\",\"bodies\":[{\"name\":\"rod\",\"mass\":1,\"com\":[0.5,0,0]," \
    "\"inertia\":{\"zz\":0.1}}],\"joints\":[{\"name\":\"O\",\"type\":\"revolute\","               \
    "\"parent\":{\"body\":\"ground\",\"at\":[0,0]},\"child\":{\"body\":\"rod\",\"at\":[0,0]},"    \
    "\"coordinate\":\"th\"}]}"

static hn_exercise *load(const char *text) {
    hn_exercise *e = NULL;
    hn_diags diags = {0};
    if (hn_exercise_load_json(text, strlen(text), &e, &diags) != HN_OK) {
        fail_msg("%s: %s", diags.item[0].pointer, diags.item[0].message);
    }
    e->lib = lib;
    return e;
}

/// Grades {PART: ANSWER} for seed 7 into `v`; returns the entry of this name.
static const hn_entry_verdict *grade(const char *text, const char *part, const char *answer,
                                     const char *entry, hn_verdict *v) {
    static hn_exercise *kept;
    char submission[30000];
    hn_exercise_free(kept);
    kept = load(text);
    snprintf(submission, sizeof submission, "{\"%s\": %s}", part, answer);
    assert_int_equal(hn_grade_json(kept, submission, strlen(submission), 7, v), HN_OK);
    for (int k = 0; k < v->n_entries; k++) {
        if (strcmp(v->entry[k].name, entry) == 0) {
            return &v->entry[k];
        }
    }
    fail_msg("no entry %s", entry);
    return NULL;
}

static double drawn(const char *text, const char *formula) {
    hn_exercise *e = load(text);
    hn_variant x;
    double value = (double)NAN;
    assert_int_equal(hn_variant_init(&x, e, 7, NULL), HN_OK);
    assert_int_equal(hn_draw_value(&x.draw, formula, &value, NULL), HN_OK);
    hn_variant_reset(&x);
    hn_exercise_free(e);
    return value;
}

static void every_part_is_sound_over_seeds(void **state) {
    static const char *const all[] = {PREDICTED, READ, MADE};
    (void)state;
    for (int i = 0; i < 3; i++) {
        hn_exercise *e = load(all[i]);
        hn_exercise_report report;
        assert_int_equal(hn_exercise_check(e, 1, 6, &report), HN_OK);
        if (report.bad) {
            fail_msg("%s", report.first);
        }
        assert_true(report.faults >= (i == 2 ? 6 : 60));
        hn_exercise_free(e);
    }
}

/// th3 and the angle from crank to coupler of the open four-bar, from its two triangles.
static void open_four_bar(double l1, double t1, double *a2, double *th3) {
    const double x = l1 * cos(t1), y = l1 * sin(t1), d = hypot(1 - x, y), to = atan2(-y, 1 - x);
    const double at_a = acos((1.44 + d * d - 0.64) / (2 * 1.2 * d));
    const double th2 = to + at_a;
    *a2 = th2 - t1;
    *th3 = atan2(y + 1.2 * sin(th2), x + 1.2 * cos(th2) - 1);
}

static void a_predicted_configuration_is_compared_with_the_triangles(void **state) {
    double a2, th3;
    char answer[120];
    hn_verdict *v = calloc(1, sizeof *v);
    (void)state;
    open_four_bar(drawn(PREDICTED, "l1"), drawn(PREDICTED, "t1"), &a2, &th3);

    // right: by name, in degrees, as a list, a full turn away
    snprintf(answer, sizeof answer, "{\"a2\": \"%.4f deg\", \"th3\": %.6f}", a2 * 180 / PI,
             th3 + 2 * PI);
    assert_true(grade(PREDICTED, "a", answer, "a.a2", v)->right);
    assert_true(v->entry[1].right);
    snprintf(answer, sizeof answer, "[%.6f, %.6f]", a2 + 0.02, th3 - 0.02);
    assert_true(grade(PREDICTED, "a", answer, "a.th3", v)->right);
    assert_true(v->entry[0].right);

    // named: degrees without a unit, half a turn, and the absolute angle
    snprintf(answer, sizeof answer, "[%.6f, %.6f]", a2, th3 * 180 / PI);
    assert_string_equal(grade(PREDICTED, "a", answer, "a.th3", v)->mistake, "degrees");
    snprintf(answer, sizeof answer, "[%.6f, %.6f]", a2 + drawn(PREDICTED, "t1"), th3);
    assert_string_equal(grade(PREDICTED, "a", answer, "a.a2", v)->mistake, "absolute");
    assert_true(v->entry[1].right);

    // the angle inside the quadrilateral, for the rocker alone: the coupler's is no absolute angle
    snprintf(answer, sizeof answer, "[%.6f, %.6f]", PI - a2, PI - th3);
    assert_string_equal(grade(PREDICTED, "a", answer, "a.th3", v)->mistake, "inner");
    assert_string_not_equal(v->entry[0].mistake, "inner");

    // a loop that stays open is told, and the picture has both configurations
    const hn_entry_verdict *e = grade(PREDICTED, "a", "[0.1, 0.2]", "a.th3", v);
    assert_string_equal(e->mistake, "other");
    assert_non_null(strstr(e->explanation, "open by"));
    assert_true(v->view.overlay);
    assert_string_equal(v->view.scene, "four-bar");
    assert_near(v->view.expected[2], th3, 1e-9);
    assert_near(v->view.given[2], 0.2, 0);
    free(v);
}

static void a_slip_is_certain_only_where_two_coordinates_show_it(void **state) {
    double a2, th3;
    char answer[80];
    hn_verdict *v = calloc(1, sizeof *v);
    (void)state;
    open_four_bar(drawn(PREDICTED, "l1"), drawn(PREDICTED, "t1"), &a2, &th3);
    snprintf(answer, sizeof answer, "[%.6f, %.6f]", a2 + drawn(PREDICTED, "t1"), th3);
    assert_string_equal(grade(PREDICTED, "a", answer, "a.a2", v)->mistake, "absolute");

    // a guess may come as near to one of the slips: only two coordinates, or a number that is no
    // angle in radians, make it certain
    static const char likely[] = "probably this mistake: ";
    assert_int_equal(strncmp(v->entry[0].explanation, likely, strlen(likely)), 0);
    snprintf(answer, sizeof answer, "[%.6f, %.6f]", a2, th3 * 180 / PI);
    assert_null(strstr(grade(PREDICTED, "a", answer, "a.th3", v)->explanation, likely));
    snprintf(answer, sizeof answer, "[%.6f, %.6f]", -a2, -th3);
    for (int k = 0; k < 2; k++) {
        const hn_entry_verdict *both = grade(PREDICTED, "a", answer, k ? "a.th3" : "a.a2", v);
        assert_string_equal(both->mistake, "sign");
        assert_null(strstr(both->explanation, likely));
    }
    free(v);
}

// mirrored at the line from A to O3
static void the_other_assembly_mode_is_named(void **state) {
    double a2, th3;
    char answer[120];
    hn_verdict *v = calloc(1, sizeof *v);
    (void)state;
    const double l1 = drawn(PREDICTED, "l1"), t1 = drawn(PREDICTED, "t1");
    open_four_bar(l1, t1, &a2, &th3);
    const double line = atan2(l1 * sin(t1), l1 * cos(t1) - 1); // from O3 to A
    snprintf(answer, sizeof answer, "[%.6f, %.6f]", 2 * (line - PI) - (a2 + t1) - t1,
             2 * line - th3);
    const hn_entry_verdict *e = grade(PREDICTED, "a", answer, "a.th3", v);
    assert_string_equal(e->mistake, "other-branch");
    assert_string_equal(v->entry[0].mistake, "other-branch");
    free(v);
}

// with the crank in one line with the coupler the rocker is at its end
static void the_largest_angle_of_a_plot_is_the_dead_point_of_the_rocker(void **state) {
    const double l1 = drawn(READ, "l1"), s = 1.2 - l1;
    const double most = PI - acos((1 + 0.64 - s * s) / (2 * 0.8));
    char answer[60];
    hn_verdict *v = calloc(1, sizeof *v);
    (void)state;
    snprintf(answer, sizeof answer, "%.4f", most);
    assert_true(grade(READ, "a", answer, "a", v)->right);
    snprintf(answer, sizeof answer, "\"%.2f deg\"", most * 180 / PI);
    assert_true(grade(READ, "a", answer, "a", v)->right);
    snprintf(answer, sizeof answer, "%.4f", 10 * most);
    assert_string_equal(grade(READ, "a", answer, "a", v)->mistake, "power-of-ten");

    // the crank starts with 4 rad/s, and the answer is asked for in deg/s
    assert_true(grade(READ, "b", "229.2", "b", v)->right);
    assert_string_equal(grade(READ, "b", "-229.2", "b", v)->mistake, "sign");
    assert_string_equal(grade(READ, "b", "\"fast\"", "b", v)->mistake, "unreadable");
    free(v);
}

static void a_plot_has_round_labels_and_its_curve(void **state) {
    hn_exercise *e = load(READ);
    hn_variant x;
    hn_strbuf b;
    (void)state;
    hn_strbuf_init(&b);
    assert_int_equal(hn_variant_init(&x, e, 7, NULL), HN_OK);
    hn_variant_text(&b, &x);
    assert_non_null(strstr(hn_strbuf_text(&b), "th3 [rad] over time"));
    assert_non_null(strstr(hn_strbuf_text(&b), "3 s"));
    hn_strbuf_clear(&b);
    hn_variant_json(&b, &x);
    cJSON *root = cJSON_Parse(hn_strbuf_text(&b));
    const cJSON *part = cJSON_GetArrayItem(cJSON_GetObjectItem(root, "parts"), 0);
    const cJSON *svg = cJSON_GetObjectItem(cJSON_GetObjectItem(part, "figure"), "svg");
    assert_non_null(strstr(svg->valuestring, "class=\"curve\" d=\"M"));
    assert_null(cJSON_GetObjectItem(cJSON_GetObjectItem(root, "numbers"), "x")); // hidden
    assert_non_null(cJSON_GetObjectItem(cJSON_GetObjectItem(root, "numbers"), "l1"));
    cJSON_Delete(root);
    hn_variant_reset(&x);
    hn_strbuf_reset(&b);
    hn_exercise_free(e);
}

static void grashof_and_the_motion_judge_a_four_bar(void **state) {
    static const struct {
        const char *answer, *mistake, *says;
    } rows[] = {
        {"{\"l4\":0.3,\"l1\":\"70 cm\",\"l2\":0.8,\"l3\":0.9}", "", ""},
        {"{\"l4\":1,\"l1\":0.5,\"l2\":1.2,\"l3\":0.8}", "type", "crank-rocker"},
        {"{\"l4\":1,\"l1\":0.8,\"l2\":1.2,\"l3\":0.5}", "type", "rocker-crank"},
        {"{\"l4\":1,\"l1\":0.8,\"l2\":0.5,\"l3\":1.2}", "type", "double-rocker"},
        {"{\"l4\":1,\"l1\":0.8,\"l2\":0.6,\"l3\":0.5}", "type", "double-rocker"},
        {"{\"l4\":3,\"l1\":0.9,\"l2\":0.7,\"l3\":0.5}", "not-assembled", "cannot be closed"},
        {"{\"l4\":1,\"l1\":1,\"l2\":1,\"l3\":1}", "change-point", "one line"},
        {"{\"l4\":1,\"l1\":2.5,\"l2\":1,\"l3\":1}", "out-of-range", "0.1 to 2"},
        {"{\"l4\":1,\"l1\":1}", "unreadable", "l2 is missing"},
        {"{\"holonom\":1}", "no-scene", "cannot be used"},
        {PENDULUM, "unreadable", "'l4'"},
        {"{\"l4\":1,\"l1\":\"long\",\"l2\":1,\"l3\":1}", "unreadable", "l1: 'long'"},
    };
    hn_verdict *v = calloc(1, sizeof *v);
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const hn_entry_verdict *e = grade(MADE, "a", rows[i].answer, "a", v);
        if (strcmp(e->mistake, rows[i].mistake) || !strstr(e->explanation, rows[i].says)) {
            fail_msg("%s: '%s' (%s)", rows[i].answer, e->mistake, e->explanation);
        }
    }
    free(v);
}

// the tip of a crank of 0.45 m passes all three points, one of 0.4 m none
static void a_curve_is_measured_at_the_points_asked_for(void **state) {
    hn_verdict *v = calloc(1, sizeof *v);
    (void)state;
    assert_true(grade(MADE, "b", "{\"l1\": 0.452}", "b", v)->right);
    const hn_entry_verdict *e = grade(MADE, "b", "{\"l1\": 0.4}", "b", v);
    assert_string_equal(e->mistake, "misses");
    assert_non_null(strstr(e->explanation, "distances 0.05, 0.05, 0.05 m"));

    // the picture has the circle of the tip, and a cross at each of the three points
    const double *at = v->view.trace;
    assert_true(v->view.n_trace > 400);
    assert_near(hypot(at[0], at[1]), 0.4, 1e-9);
    assert_near(hypot(at[600], at[601]), 0.4, 1e-9);
    const double *cross = at + 3 * (v->view.n_trace - 1);
    assert_near(cross[0], 0.27, 1e-12);
    assert_near(cross[1], -0.36 + 0.04 * 0.8, 1e-3);
    free(v);
}

static hn_circuit circuit_of(double l1, double l2, double l3, double l4) {
    const hn_setting settings[] = {{"l1", l1}, {"l2", l2}, {"l3", l3}, {"l4", l4}};
    const hn_model_source source = {.name = "four-bar", .settings = settings, .n_settings = 4};
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_circuit c;
    assert_int_equal(hn_model_load(lib, &source, &model, &diags), HN_OK);
    assert_int_equal(hn_circuit_walk(model, 0.02, NULL, NULL, &c), HN_OK);
    hn_model_free(model);
    return c;
}

static void a_circuit_passes_dead_points_and_comes_back(void **state) {
    (void)state;
    const hn_circuit crank = circuit_of(0.5, 1.2, 0.8, 1);
    assert_true(crank.closed);
    assert_int_equal(abs(crank.turns[0]), 1);
    assert_int_equal(crank.turns[2], 0);
    // ends of the rocker by the law of cosines; steps of 0.02 rad meet an end to 0.0002 rad
    assert_near(crank.most[2], PI - acos((1.64 - 0.7 * 0.7) / 1.6), 5e-4);
    assert_near(crank.least[2], PI - acos((1.64 - 1.7 * 1.7) / 1.6), 5e-4);

    const hn_circuit rockers = circuit_of(0.8, 0.6, 0.5, 1);
    assert_true(rockers.closed);
    assert_int_equal(rockers.turns[0], 0);
    assert_int_equal(rockers.turns[2], 0);
    const hn_circuit flat = circuit_of(1, 1, 1, 1);
    assert_false(flat.closed && abs(flat.turns[0]) == 1 && flat.turns[2] == 0);
}

// ---- ending early ----

/// True from the n-th question on.
typedef struct patience {
    long asked, most;
} patience;

static bool is_used_up(void *user) {
    patience *p = user;
    return ++p->asked > p->most;
}

/// The questions that a grading with so much patience asks, and its status.
static long grade_with(const char *text, const char *submission, long most, hn_status *status) {
    static hn_verdict v;
    patience p = {.most = most};
    hn_exercise *e = load(text);
    e->interrupt = (hn_interrupt){is_used_up, &p};
    *status = hn_grade_json(e, submission, strlen(submission), 7, &v);
    hn_exercise_free(e);
    return p.asked;
}

/// A motion of 8,000 steps, one of 150, curves, and scenes: once the answer is yes, each ends
/// within the few questions of the functions that it is in.
static void an_interrupt_ends_a_grading(void **state) {
    static const char STEPPED[] =
        HEAD "{\"id\":\"a\",\"ask\":\"which?\",\"kind\":\"method\",\"points\":2,"
             "\"scene\":\"four-bar\",\"set\":[\"l1\"],\"time\":2,\"error\":1e-6,"
             "\"evaluations\":1e4,\"reference\":\"reduced@dop853:rtol=1e-10\","
             "\"second\":\"projection@dop853:rtol=1e-10\","
             "\"answer\":\"projection@rk4:h=0.001\"}]}";
    static const struct {
        const char *exercise, *submission;
    } cases[] = {{STEPPED, "{\"a\": \"projection@rk4:h=0.00025\"}"},
                 {PREDICTED, "{\"b\": {\"th1\": 1, \"th3\": 1}}"},
                 {READ, "{\"a\": 1, \"b\": 2}"},
                 {MADE, "{\"b\": {\"l1\": 0.45}}"}};
    enum { FEW = 12 };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_status status;
        const long whole = grade_with(cases[i].exercise, cases[i].submission, 1000000000, &status);
        assert_int_equal(status, HN_OK);
        for (int part = 0; part < 8; part++) {
            const long most = part * whole / 8;
            const long asked = grade_with(cases[i].exercise, cases[i].submission, most, &status);
            if (status != HN_ERR_STOPPED || asked > most + FEW) {
                fail_msg("case %zu: %s after %ld of %ld questions, %ld were asked", i,
                         hn_status_name(status), most, whole, asked);
            }
        }
        assert_true(whole > (i == 0 ? 500 : FEW));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_interrupt_ends_a_grading),
        cmocka_unit_test(every_part_is_sound_over_seeds),
        cmocka_unit_test(a_predicted_configuration_is_compared_with_the_triangles),
        cmocka_unit_test(a_slip_is_certain_only_where_two_coordinates_show_it),
        cmocka_unit_test(the_other_assembly_mode_is_named),
        cmocka_unit_test(the_largest_angle_of_a_plot_is_the_dead_point_of_the_rocker),
        cmocka_unit_test(a_plot_has_round_labels_and_its_curve),
        cmocka_unit_test(grashof_and_the_motion_judge_a_four_bar),
        cmocka_unit_test(a_curve_is_measured_at_the_points_asked_for),
        cmocka_unit_test(a_circuit_passes_dead_points_and_comes_back),
    };
    if (hn_library_open(".", &lib, NULL) != HN_OK) {
        return 1;
    }
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    hn_library_free(lib);
    return failed;
}
