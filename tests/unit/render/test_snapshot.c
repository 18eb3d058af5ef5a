// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "render/snapshot.h"
#include "render/snapshot_labels.h"
#include "render/snapshot_lengths.h"
#include "support/alloc.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 1000, HEIGHT = 720 };

// a four-bar by hand: O A B D, and B again as the rocker sees it
static const char *const labels[5] = {"O", "A", "B", "D", NULL};
static const int tears[1][2] = {{2, 4}};
static const char *const tear_names[1] = {"tear at B"};
static const hn_shape shapes[] = {
    {HN_SHAPE_GROUND, 0, 0, 0, 0, HN_GROUND, HN_JOINT_REVOLUTE},
    {HN_SHAPE_GROUND, 3, 3, 0, 0, HN_GROUND, HN_JOINT_REVOLUTE},
    {HN_SHAPE_BAR, 0, 1, 0, 0, 0, HN_JOINT_REVOLUTE},
    {HN_SHAPE_BAR, 1, 2, 0, 0, 1, HN_JOINT_REVOLUTE},
    {HN_SHAPE_BAR, 3, 4, 0, 0, 2, HN_JOINT_REVOLUTE},
    {HN_SHAPE_PIVOT, 0, 0, 0, 0, 0, HN_JOINT_REVOLUTE},
    {HN_SHAPE_PIVOT, 1, 1, 0, 0, 1, HN_JOINT_REVOLUTE},
};
static const hn_drawing four_bar = {5,     labels,    sizeof shapes / sizeof *shapes, shapes, 1,
                                    tears, tear_names};

static void set_points(double points[15], double gap) {
    const double at[15] = {
        0, 0, 0, 0.4, 0.9, 0, 2.2, 1.7, 0, 2.2, 0, 0, 2.2 + 0.6 * gap, 1.7 + 0.8 * gap, 0};
    memcpy(points, at, sizeof at);
}

static hn_canvas *create(void) {
    hn_canvas *c = NULL;
    assert_int_equal(hn_canvas_create(WIDTH, HEIGHT, HN_THEME_LIGHT, &c, NULL), HN_OK);
    return c;
}

static unsigned char *draw(const hn_drawing *d, const hn_snapshot_pose *poses, int n,
                           const hn_snapshot_opts *opts) {
    hn_canvas *c = create();
    unsigned char *rgb = malloc(3 * WIDTH * HEIGHT);
    assert_non_null(rgb);
    assert_int_equal(hn_snapshot_draw(c, d, poses, n, opts, NULL), HN_OK);
    assert_int_equal(hn_canvas_paint(c, rgb, NULL), HN_OK);
    hn_canvas_free(c);
    return rgb;
}

static int differing_pixels(const unsigned char *a, const unsigned char *b) {
    int n = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        n += memcmp(a + 3 * i, b + 3 * i, 3) != 0;
    }
    return n;
}

/// The number that follows "key": in the description.
static double described(const hn_snapshot_pose *poses, int n, const hn_snapshot_opts *opts,
                        const char *key) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    assert_int_equal(hn_snapshot_describe(&b, WIDTH, HEIGHT, &four_bar, poses, n, opts, NULL),
                     HN_OK);
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *inset = strstr(hn_strbuf_text(&b), "\"inset\"");
    const char *found = strstr(strstr(inset, quoted) != NULL ? inset : hn_strbuf_text(&b), quoted);
    assert_non_null(found);
    const double value = strtod(found + strlen(quoted), NULL);
    hn_strbuf_reset(&b);
    return value;
}

static void a_tear_of_any_size_fills_a_good_part_of_the_inset(void **state) {
    (void)state;
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    for (double gap = 1e-9; gap < 0.02; gap *= 3) {
        double points[15];
        set_points(points, gap);
        const hn_snapshot_pose pose = {.points = points, .name = "raw"};
        assert_rel(described(&pose, 1, &opts, "gap"), gap, 1e-6);
        const double times = described(&pose, 1, &opts, "magnification");
        const double shown = gap * times / described(&pose, 1, &opts, "metres_per_pixel");
        assert_true(shown > 40 && shown < 130); // of 280 pixels
        const double lead = times / pow(10, floor(log10(times) + 1e-9));
        assert_true(fabs(lead - 1) < 1e-9 || fabs(lead - 2) < 1e-9 || fabs(lead - 5) < 1e-9);
    }
}

static void a_closed_joint_is_not_magnified_into_its_rounding(void **state) {
    (void)state;
    double points[15];
    set_points(points, 0);
    const hn_snapshot_pose pose = {.points = points, .name = "reduced"};
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    assert_near(described(&pose, 1, &opts, "magnification"), 1, 0);
    assert_near(described(&pose, 1, &opts, "gap"), 0, 0);
}

// the legend gives its number; that of the drawn points is another rounding of the same zero
static void a_closed_joint_has_no_number_of_its_own_in_the_inset(void **state) {
    (void)state;
    double closed[15], rounding[15];
    set_points(closed, 0);
    set_points(rounding, 0);
    rounding[13] += 4e-16; // two units in the last place of 1.7
    const hn_snapshot_pose exact = {.points = closed}, near = {.points = rounding};
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    assert_true(described(&near, 1, &opts, "gap") > 0);
    unsigned char *one = draw(&four_bar, &exact, 1, &opts);
    unsigned char *two = draw(&four_bar, &near, 1, &opts);
    assert_int_equal(differing_pixels(one, two), 0);
    free(one);
    free(two);
}

static void the_widest_tear_of_all_poses_is_the_one_shown(void **state) {
    (void)state;
    double a[15], b[15], d[15];
    set_points(a, 1e-9);
    set_points(b, 3e-3);
    set_points(d, 1e-6);
    const hn_snapshot_pose poses[3] = {
        {.points = a, .selected = 1}, {.points = b, .slot = 1}, {.points = d, .slot = 2}};
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    assert_near(described(poses, 3, &opts, "pose"), 1, 0);
    assert_rel(described(poses, 3, &opts, "gap"), 3e-3, 1e-9);
}

static void with_a_fixed_view_the_scale_does_not_depend_on_the_pose(void **state) {
    (void)state;
    double near_points[15], far_points[15];
    set_points(near_points, 0);
    set_points(far_points, 0.5);
    const hn_snapshot_pose one = {.points = near_points}, other = {.points = far_points};
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    assert_true(described(&one, 1, &opts, "metres_per_pixel") <
                described(&other, 1, &opts, "metres_per_pixel"));
    const double view[4] = {-1, 3, -1, 2};
    memcpy(opts.view, view, sizeof view);
    assert_near(described(&one, 1, &opts, "metres_per_pixel"),
                described(&other, 1, &opts, "metres_per_pixel"), 0);
}

/// A pin before a bar is seen, and one behind it is not. What is farther is paler too: the bar has
/// all of its colour where it is the nearest.
static void in_space_what_is_nearer_covers_what_is_farther(void **state) {
    (void)state;
    static const char *const none[4] = {NULL, NULL, NULL, NULL};
    static const hn_shape cross[] = {{HN_SHAPE_BAR, 0, 1, 0, 0.3, 0, HN_JOINT_REVOLUTE},
                                     {HN_SHAPE_PIVOT, 2, 2, 0, 0.3, 1, HN_JOINT_REVOLUTE}};
    const hn_drawing both = {3, none, 2, cross, 0, NULL, NULL};
    const hn_drawing bar = {3, none, 1, cross, 0, NULL, NULL};
    int shown[2];
    for (int behind = 0; behind < 2; behind++) {
        const double points[9] = {-1, 0, 0, 1, 0, 0, 0, 0, behind ? -1 : 1};
        const hn_snapshot_pose pose = {.points = points, .selected = 1};
        hn_snapshot_opts opts = hn_snapshot_opts_default();
        const double view[4] = {-1, 1, -1, 1};
        memcpy(opts.view, view, sizeof view);
        opts.look = hn_view_look(1e-3, 0);
        unsigned char *with = draw(&both, &pose, 1, &opts), *without = draw(&bar, &pose, 1, &opts);
        shown[behind] = differing_pixels(with, without);
        free(with);
        free(without);
    }
    assert_true(shown[0] > 500); // the pin's ring, and the paler bar
    assert_int_equal(shown[1], 0);
}

static void a_pose_that_is_not_finite_is_listed_but_not_drawn(void **state) {
    (void)state;
    double good[15], bad[15];
    set_points(good, 1e-3);
    set_points(bad, 1e-3);
    bad[7] = (double)NAN;
    const hn_snapshot_pose poses[3] = {{.points = bad, .name = "euler", .slot = 1, .selected = 1},
                                       {.points = NULL, .name = "gone", .slot = 2},
                                       {.points = good, .name = "raw"}};
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    hn_strbuf b;
    hn_strbuf_init(&b);
    assert_int_equal(hn_snapshot_describe(&b, WIDTH, HEIGHT, &four_bar, poses, 3, &opts, NULL),
                     HN_OK);
    assert_non_null(
        strstr(b.text, "{\"name\":\"euler\",\"slot\":1,\"drawn\":false,\"selected\":false"));
    assert_non_null(
        strstr(b.text, "{\"name\":\"gone\",\"slot\":2,\"drawn\":false,\"selected\":false"));
    assert_non_null(
        strstr(b.text, "{\"name\":\"raw\",\"slot\":0,\"drawn\":true,\"selected\":true"));
    hn_strbuf_reset(&b);

    hn_canvas *c = create();
    hn_diag diag = {0};
    assert_int_equal(hn_snapshot_draw(c, &four_bar, poses, 2, &opts, &diag), HN_ERR_INPUT);
    assert_true(strlen(diag.message) > 0);
    hn_canvas_free(c);
}

/// Pixels within 2 of the colour in each channel: GL may round the other way.
static int count_colour(const unsigned char *rgb, uint32_t colour) {
    int n = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int near = 1;
        for (int k = 0; k < 3; k++) {
            near &= abs(rgb[3 * i + k] - (int)(colour >> (16 - 8 * k) & 0xff)) <= 2;
        }
        n += near;
    }
    return n;
}

static void the_selected_method_is_filled_and_a_ghost_is_an_outline_at_sixty_percent(void **state) {
    (void)state;
    double a[15], b[15];
    set_points(a, 0);
    set_points(b, 0);
    for (int i = 0; i < 5; i++) {
        b[3 * i + 1] += 0.3;
    }
    hn_drawing bare = four_bar;
    bare.n_tears = 0;
    hn_snapshot_pose poses[2] = {{.points = a, .slot = 0, .selected = 1}, {.points = b, .slot = 1}};
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    // a filled bar mixes its colour into the paper at 30 % (so do some edge pixels), a ghost's
    // outline at 60 %
    const hn_surface *s = hn_surface_get(HN_THEME_LIGHT);
    uint32_t tint[2] = {0, 0}, ghost[2] = {0, 0};
    for (int slot = 0; slot < 2; slot++) {
        for (int shift = 16; shift >= 0; shift -= 8) {
            const double paper = s->paper >> shift & 0xff,
                         ink = hn_look_get(slot)->colour[0] >> shift & 0xff;
            tint[slot] |= (uint32_t)lround(paper + 0.3 * (ink - paper)) << shift;
            ghost[slot] |= (uint32_t)lround(paper + 0.6 * (ink - paper)) << shift;
        }
    }
    unsigned char *first = draw(&bare, poses, 2, &opts);
    poses[0].selected = 0;
    poses[1].selected = 1;
    unsigned char *second = draw(&bare, poses, 2, &opts);
    assert_true(count_colour(first, tint[0]) > 5000 && count_colour(first, tint[1]) < 1000);
    assert_true(count_colour(second, tint[1]) > 5000 && count_colour(second, tint[0]) < 1000);
    assert_true(count_colour(first, ghost[1]) > 200);
    assert_true(count_colour(second, ghost[0]) > 200);
    free(first);
    free(second);
}

static void a_long_note_is_told_in_lines_and_not_cut_to_one(void **state) {
    (void)state;
    double points[15];
    set_points(points, 0);
    hn_snapshot_pose pose = {.points = points, .name = "raw"};
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    unsigned char *rgb[3];
    const char *const notes[3] = {"", "a note of one line",
                                  ("a note of one line and then a second "
                                   "one, and what is left in a third")};
    for (int i = 0; i < 3; i++) {
        pose.note = notes[i];
        rgb[i] = draw(&four_bar, &pose, 1, &opts);
    }
    // the letters are alike, so that ink counts them: 17 against 65, of which an ellipsis in one
    // line would leave some 30
    assert_true(differing_pixels(rgb[0], rgb[2]) > 3 * differing_pixels(rgb[0], rgb[1]));
    for (int i = 0; i < 3; i++) {
        free(rgb[i]);
    }
}

static void many_poses_with_long_notes_all_fit(void **state) {
    (void)state;
    enum { POSES = 7 };
    double points[15];
    set_points(points, 0);
    hn_snapshot_pose poses[POSES];
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    for (int i = 0; i < POSES; i++) {
        poses[i] = (hn_snapshot_pose){.points = points,
                                      .slot = i,
                                      .name = "a method",
                                      .note = "stopped at 340 ms: the chosen coordinates stopped "
                                              "being valid here, and nothing else was left to do"};
    }
    unsigned char *with = draw(&four_bar, poses, POSES, &opts);
    poses[POSES - 1].note = "";
    unsigned char *without = draw(&four_bar, poses, POSES, &opts);
    assert_true(differing_pixels(with, without) > 200); // the last one's stands in the picture
    free(with);
    free(without);
}

static void every_kind_of_shape_but_arrow_and_trace_leaves_ink(void **state) {
    (void)state;
    const double points[12] = {0, 0, 0, 1, 0.5, 0, 2, 0, 0, 1, -1, 0};
    const char *const no_labels[4] = {NULL, NULL, NULL, NULL};
    const hn_snapshot_pose pose = {.points = points};
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    const hn_drawing nothing = {4, no_labels, 0, NULL, 0, NULL, NULL};
    unsigned char *blank = draw(&nothing, &pose, 1, &opts);
    for (int kind = HN_SHAPE_BAR; kind <= HN_SHAPE_POLYGON; kind++) {
        const hn_shape shape = {(hn_shape_kind)kind, 0, 1, 4, 0, 0, HN_JOINT_REVOLUTE};
        const hn_drawing one = {4, no_labels, 1, &shape, 0, NULL, NULL};
        unsigned char *rgb = draw(&one, &pose, 1, &opts);
        assert_int_equal(differing_pixels(blank, rgb) > 50, kind != HN_SHAPE_ARROW);
        free(rgb);
    }
    free(blank);
}

static void
names_of_points_at_one_place_are_joined_and_no_name_is_written_over_another(void **state) {
    (void)state;
    const char *const both[5] = {"O", "A", "B", "D", "E"}, *const joined[5] = {"O", "A", "B E",
                                                                               "D"};
    const char *const first[5] = {"O", "A", "B", "D"}, *const none[5] = {NULL};
    double points[15];
    const hn_snapshot_pose pose = {.points = points};
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    hn_drawing d = four_bar;
    unsigned char *picture[4];
    set_points(points, 0);
    const char *const *const labelled[4] = {both, joined, first, none};
    for (int i = 0; i < 4; i++) {
        d.labels = labelled[i];
        picture[i] = draw(&d, &pose, 1, &opts);
    }
    assert_int_equal(differing_pixels(picture[0], picture[1]), 0);
    assert_true(differing_pixels(picture[1], picture[2]) > 20);
    for (int i = 0; i < 4; i++) {
        free(picture[i]);
    }
    // a few pixels apart: each name has ink of its own, none is shared
    set_points(points, 0.03);
    const char *const second[5] = {"O", "A", NULL, "D", "E"}, *const others[5] = {"O", "A", NULL,
                                                                                  "D"};
    const char *const *const apart[4] = {both, first, second, others};
    for (int i = 0; i < 4; i++) {
        d.labels = apart[i];
        picture[i] = draw(&d, &pose, 1, &opts);
    }
    assert_int_equal(differing_pixels(picture[0], picture[1]),
                     differing_pixels(picture[2], picture[3]));
    for (int i = 0; i < 4; i++) {
        free(picture[i]);
    }
}

static void a_trace_and_a_load_are_drawn(void **state) {
    (void)state;
    double points[15];
    set_points(points, 0);
    const double nan = (double)NAN;
    const double trace[] = {0.4, 0.9, 0, 0.9, 1.0, 0, nan, nan, nan, 1.5, 0.5, 0, 1.9, 0.5, 0};
    hn_snapshot_pose pose = {.points = points};
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    unsigned char *plain = draw(&four_bar, &pose, 1, &opts);
    pose.trace = trace;
    pose.n_trace = 5;
    unsigned char *traced = draw(&four_bar, &pose, 1, &opts);
    assert_true(differing_pixels(plain, traced) > 100);
    pose.n_trace = 0;
    const hn_snapshot_load load = {.point = 1, .force = {0, -9.81, 0}, .unit = "N"};
    opts.n_loads = 1;
    opts.loads = &load;
    unsigned char *loaded = draw(&four_bar, &pose, 1, &opts);
    assert_true(differing_pixels(plain, loaded) > 200);
    free(plain);
    free(traced);
    free(loaded);
}

// forces that point inwards at the edge of the view, and two at one point: no value is cut, and
// none lies on another
static void values_of_forces_stay_on_the_sheet_and_apart(void **state) {
    (void)state;
    double points[15];
    set_points(points, 0);
    const hn_snapshot_pose pose = {.points = points};
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    opts.labels = 0;
    opts.bare = true;
    hn_drawing d = four_bar;
    d.n_tears = 0;
    const hn_snapshot_load loads[] = {{.point = 0, .force = {1234, 0, 0}, .unit = "N"},
                                      {.point = 3, .force = {-1234, 3, 0}, .unit = "N"},
                                      {.point = 2, .force = {0, -1234, 0}, .unit = "N"},
                                      {.point = 2, .force = {1, -1234, 0}, .unit = "N"}};
    unsigned char *plain = draw(&d, &pose, 1, &opts);
    opts.loads = loads;
    opts.n_loads = 4;
    unsigned char *loaded = draw(&d, &pose, 1, &opts);
    int edge = 0;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const bool at_edge = x < 2 || y < 2 || x >= WIDTH - 2 || y >= HEIGHT - 2;
            edge += at_edge && memcmp(plain + 3 * (y * WIDTH + x), loaded + 3 * (y * WIDTH + x), 3);
        }
    }
    assert_int_equal(edge, 0);

    // two equal values drawn apart have about twice the ink of one
    opts.loads = loads + 2;
    opts.n_loads = 1;
    unsigned char *one = draw(&d, &pose, 1, &opts);
    opts.n_loads = 2;
    unsigned char *two = draw(&d, &pose, 1, &opts);
    assert_true(differing_pixels(one, two) > 150);
    free(plain);
    free(loaded);
    free(one);
    free(two);
}

/// From the box of a value to an arrow [px]; 0 inside.
static double away_from(const hn_load_mark *value, const hn_load_mark *arrow, double font) {
    double least = HUGE_VAL;
    for (int k = 0; k <= 100; k++) {
        const double t = k / 100.0;
        const double x = arrow->tail[0] + t * (arrow->tip[0] - arrow->tail[0]);
        const double y = arrow->tail[1] + t * (arrow->tip[1] - arrow->tail[1]);
        const double across = fmax(0, fabs(x - value->text[0]) - value->half);
        const double down = fmax(0, fabs(y - value->text[1]) - 0.55 * font);
        least = fmin(least, hypot(across, down));
    }
    return least;
}

// forces in the middle of a bar and in its joint, in all directions: the nearest arrow to a value
// is its own
static void a_value_stands_nearest_to_its_own_arrow(void **state) {
    (void)state;
    enum { TURNS = 12 };
    double points[15];
    set_points(points, 0);
    const hn_snapshot_pose pose = {.points = points, .selected = 1};
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    hn_snapshot_load loads[2] = {{.point = -1, .place = {0.2, 0.45, 0}, .unit = "N"},
                                 {.point = 1, .unit = "N"}};
    opts.loads = loads;
    opts.n_loads = 2;
    int taken = 0;
    for (int k = 0; k < TURNS * TURNS; k++) {
        const double a = 2 * M_PI * (k / TURNS) / TURNS, b = 2 * M_PI * (k % TURNS) / TURNS;
        loads[0].force[0] = 44.1 * cos(a);
        loads[0].force[1] = 44.1 * sin(a);
        loads[1].force[0] = 26.0 * cos(b);
        loads[1].force[1] = 26.0 * sin(b);
        hn_sheet sheet;
        hn_label_places placed = {0};
        hn_load_mark marks[HN_LABEL_ARROWS];
        assert_int_equal(hn_sheet_make(&sheet, WIDTH, HEIGHT, &four_bar, &pose, 1, &opts, NULL),
                         HN_OK);
        assert_int_equal(hn_load_marks_place(&sheet, &four_bar, &pose, &opts, &placed, marks), 2);
        for (int i = 0; i < 2; i++) {
            taken += away_from(&marks[i], &marks[1 - i], sheet.font) <=
                     away_from(&marks[i], &marks[i], sheet.font);
        }
    }
    assert_int_equal(taken, 0);
}

// a force that crosses the middle of a dimension line: the length moves along the line
static void a_length_keeps_off_the_arrow_of_a_force(void **state) {
    (void)state;
    double points[15];
    set_points(points, 0);
    const hn_snapshot_pose pose = {.points = points, .selected = 1};
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    hn_sheet sheet;
    assert_int_equal(hn_sheet_make(&sheet, WIDTH, HEIGHT, &four_bar, &pose, 1, &opts, NULL), HN_OK);
    hn_canvas *c = create();
    hn_label_places free_places = {0}, crossed = {0};
    hn_snapshot_lengths(c, &sheet, &four_bar, &pose, &free_places);
    assert_int_equal(free_places.n, 4); // three bars and the ground
    // names keep off these lines and their extension lines
    assert_int_equal(free_places.n_lines, 3 * 4);
    crossed.n_lines = 1; // straight through the first length
    crossed.line[0][0][0] = crossed.line[0][1][0] = free_places.at[0][0];
    crossed.line[0][0][1] = free_places.at[0][1] - 40;
    crossed.line[0][1][1] = free_places.at[0][1] + 40;
    assert_true(hn_label_room(&sheet, &crossed, free_places.at[0], free_places.half[0]) < 0);
    hn_snapshot_lengths(c, &sheet, &four_bar, &pose, &crossed);
    hn_canvas_free(c);
    crossed.n = 0; // the arrow alone counts
    crossed.n_lines = 1;
    assert_true(hn_label_room(&sheet, &crossed, crossed.at[0], crossed.half[0]) >= 0);
}

static void the_reference_lies_beneath_and_is_thin(void **state) {
    (void)state;
    double points[15];
    set_points(points, 0);
    hn_drawing bare = four_bar;
    bare.n_tears = 0;
    const uint32_t grey = hn_look_get(HN_LOOK_REFERENCE)->colour[0];
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    double aside[15];
    set_points(aside, 0);
    for (int i = 0; i < 5; i++) {
        aside[3 * i + 1] -= 0.5;
    }
    // listed last, drawn first: under a selected method in the same pose only its legend shows
    const hn_snapshot_pose same[2] = {{.points = points, .selected = 1},
                                      {.points = points, .slot = HN_LOOK_REFERENCE}};
    const hn_snapshot_pose apart[2] = {{.points = points, .selected = 1},
                                       {.points = aside, .slot = HN_LOOK_REFERENCE}};
    unsigned char *hidden = draw(&bare, same, 2, &opts), *seen = draw(&bare, apart, 2, &opts);
    assert_true(count_colour(hidden, grey) < 600);
    assert_true(count_colour(seen, grey) > count_colour(hidden, grey) + 200);
    assert_true(count_colour(seen, grey) < 3500);
    free(hidden);
    free(seen);
}

static void every_failing_allocation_is_told_and_nothing_leaks(void **state) {
    (void)state;
    double points[15];
    set_points(points, 1e-3);
    const hn_snapshot_pose pose = {.points = points, .name = "raw", .note = "gap 1 mm"};
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    opts.title = "Four-bar";
    opts.caption = "a caption that is long enough to be cut off somewhere on a sheet that is only "
                   "so wide, so very wide, "
                   "and then some more of it, to be sure of that";
    opts.time = 0.5;
    const long live = hn_alloc_live();
    for (long n = 1;; n++) {
        hn_alloc_fail_at(n);
        hn_canvas *c = NULL;
        hn_strbuf png;
        hn_strbuf_init(&png);
        hn_status status = hn_canvas_create(WIDTH, HEIGHT, HN_THEME_DARK, &c, NULL);
        status = status != HN_OK ? status : hn_snapshot_draw(c, &four_bar, &pose, 1, &opts, NULL);
        status = status != HN_OK ? status : hn_canvas_png(c, &png, NULL);
        const int failed = hn_alloc_has_failed();
        hn_alloc_fail_at(0);
        hn_canvas_free(c);
        hn_strbuf_reset(&png);
        assert_int_equal(status, failed ? HN_ERR_MEMORY : HN_OK);
        assert_int_equal(hn_alloc_live(), live);
        if (!failed) {
            break;
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tear_of_any_size_fills_a_good_part_of_the_inset),
        cmocka_unit_test(a_long_note_is_told_in_lines_and_not_cut_to_one),
        cmocka_unit_test(many_poses_with_long_notes_all_fit),
        cmocka_unit_test(a_closed_joint_is_not_magnified_into_its_rounding),
        cmocka_unit_test(a_closed_joint_has_no_number_of_its_own_in_the_inset),
        cmocka_unit_test(the_widest_tear_of_all_poses_is_the_one_shown),
        cmocka_unit_test(with_a_fixed_view_the_scale_does_not_depend_on_the_pose),
        cmocka_unit_test(in_space_what_is_nearer_covers_what_is_farther),
        cmocka_unit_test(a_pose_that_is_not_finite_is_listed_but_not_drawn),
        cmocka_unit_test(the_selected_method_is_filled_and_a_ghost_is_an_outline_at_sixty_percent),
        cmocka_unit_test(every_kind_of_shape_but_arrow_and_trace_leaves_ink),
        cmocka_unit_test(
            names_of_points_at_one_place_are_joined_and_no_name_is_written_over_another),
        cmocka_unit_test(a_trace_and_a_load_are_drawn),
        cmocka_unit_test(values_of_forces_stay_on_the_sheet_and_apart),
        cmocka_unit_test(a_value_stands_nearest_to_its_own_arrow),
        cmocka_unit_test(a_length_keeps_off_the_arrow_of_a_force),
        cmocka_unit_test(the_reference_lies_beneath_and_is_thin),
        cmocka_unit_test(every_failing_allocation_is_told_and_nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
