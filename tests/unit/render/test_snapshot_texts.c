// SPDX-License-Identifier: GPL-3.0-or-later
// Where the texts of a sheet stand: lengths, angles and names keep off the mechanism and each
// other.
#include "support/near.h"

#include "render/snapshot.h"
#include "render/snapshot_angles.h"
#include "render/snapshot_labels.h"
#include "render/snapshot_lengths.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 1000, HEIGHT = 720, N_POINTS = 6 };

// a pantograph: O B A on one line, A C P on another, and a parallelogram B A C D
static const char *const labels[N_POINTS] = {"O", "B", "A", "C", "P", "D"};
static const double points[3 * N_POINTS] = {0,   0,   0, 0.3, 0.4, 0, 0.6, 0.8, 0,
                                            0.9, 0.4, 0, 1.2, 0,   0, 0.6, 0,   0};
static const hn_shape shapes[] = {
    {.kind = HN_SHAPE_GROUND, .p = 0, .q = 0, .body = HN_GROUND},
    {.kind = HN_SHAPE_BAR, .p = 0, .q = 2, .body = 0},
    {.kind = HN_SHAPE_BAR, .p = 2, .q = 4, .body = 1},
    {.kind = HN_SHAPE_BAR, .p = 0, .q = 1, .body = 0},
    {.kind = HN_SHAPE_BAR, .p = 1, .q = 2, .body = 0},
    {.kind = HN_SHAPE_BAR, .p = 1, .q = 5, .body = 2},
    {.kind = HN_SHAPE_BAR, .p = 3, .q = 5, .body = 3},
    {.kind = HN_SHAPE_PIVOT, .p = 2, .q = 2, .body = 0},
};
static const hn_drawing pantograph = {
    .n_points = N_POINTS,
    .labels = labels,
    .n_shapes = sizeof shapes / sizeof *shapes,
    .shapes = shapes,
};
static const hn_snapshot_pose pose = {.points = points, .selected = 1};

static hn_sheet make_sheet(const hn_snapshot_opts *opts) {
    hn_sheet sheet;
    assert_int_equal(hn_sheet_make(&sheet, WIDTH, HEIGHT, &pantograph, &pose, 1, opts, NULL),
                     HN_OK);
    return sheet;
}

static hn_canvas *create(void) {
    hn_canvas *c = NULL;
    assert_int_equal(hn_canvas_create(WIDTH, HEIGHT, HN_THEME_LIGHT, &c, NULL), HN_OK);
    return c;
}

static void names_and_angles_stand_beside_the_bars(void **state) {
    (void)state;
    static const hn_snapshot_angle angles[] = {
        {.pivot = 0,
         .end = 2,
         .value = 0.93,
         .zero = {1, 0, 0},
         .quarter = {0, 1, 0},
         .name = "th1"},
        {.pivot = 2,
         .end = 4,
         .value = -1.85,
         .zero = {0.6, 0.8, 0},
         .quarter = {-0.8, 0.6, 0},
         .name = "a"},
    };
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    opts.dimensions = true;
    opts.angles = angles;
    opts.n_angles = 2;
    const hn_sheet sheet = make_sheet(&opts);
    hn_canvas *c = create();
    hn_label_places placed = {0};
    hn_snapshot_angles(c, &sheet, &pantograph, &pose, &opts, &placed);
    assert_int_equal(placed.n, 2);
    hn_snapshot_names(c, &sheet, &pantograph, &pose, &opts, &placed);
    hn_canvas_free(c);
    assert_int_equal(placed.n, 2 + N_POINTS);
    for (int i = 0; i < placed.n; i++) {
        const hn_label_places nothing = {0};
        assert_true(hn_label_room_of_all(&sheet, &pantograph, points, &nothing, placed.at[i],
                                         placed.half[i]) >= 0);
    }
}

// O B and B A lie on O A: three dimension lines that would be one
static void dimension_lines_of_bars_on_one_line_lie_apart(void **state) {
    (void)state;
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    const hn_sheet sheet = make_sheet(&opts);
    hn_canvas *c = create();
    hn_label_places placed = {0};
    hn_snapshot_lengths(c, &sheet, &pantograph, &pose, &placed);
    hn_canvas_free(c);
    assert_int_equal(placed.n, 6);
    double away[3]; // of the lines of O A, O B and B A from that line
    for (int i = 0; i < 3; i++) {
        double(*line)[2] = placed.line[3 * (i == 0 ? 0 : i + 1) + 2]; // after its extension lines
        double o[2], a[2];
        hn_sheet_pixel(&sheet, points, o);
        hn_sheet_pixel(&sheet, points + 6, a);
        const double length = hypot(a[0] - o[0], a[1] - o[1]);
        away[i] =
            ((a[0] - o[0]) * (line[0][1] - o[1]) - (a[1] - o[1]) * (line[0][0] - o[0])) / length;
    }
    for (int i = 1; i < 3; i++) {
        assert_true(fabs(away[i] - away[0]) > sheet.font);
    }
}

// a full turn is no arc, and neither is an angle that cannot be seen
static void an_angle_without_an_arc_has_no_text(void **state) {
    (void)state;
    hn_snapshot_angle angle = {
        .pivot = 0, .end = 2, .zero = {1, 0, 0}, .quarter = {0, 1, 0}, .name = "th1"};
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    opts.angles = &angle;
    opts.n_angles = 1;
    const hn_sheet sheet = make_sheet(&opts);
    hn_canvas *c = create();
    static const double values[] = {0, 1e-3, 2 * M_PI, 1, -7};
    static const int texts[] = {0, 0, 0, 1, 1};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        hn_label_places placed = {0};
        angle.value = values[i];
        hn_snapshot_angles(c, &sheet, &pantograph, &pose, &opts, &placed);
        assert_int_equal(placed.n, texts[i]);
    }
    hn_canvas_free(c);
}

// whatever the side looked from, the arc ends at the bar; seen edge on there is none
static void an_arc_ends_at_its_bar_in_every_view(void **state) {
    (void)state;
    static const char *const views[] = {"front", "180,0", "space", "215,-22", "top", "side"};
    static const int arcs[] = {1, 1, 1, 1, 0, 0};
    const hn_snapshot_angle angle = {.pivot = 0,
                                     .end = 2,
                                     .value = 0.927295218001612232,
                                     .zero = {1, 0, 0},
                                     .quarter = {0, 1, 0},
                                     .name = "th1"};
    hn_snapshot_opts opts = hn_snapshot_opts_default();
    opts.angles = &angle;
    opts.n_angles = 1;
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        assert_int_equal(hn_view_parse(views[i], &opts.look, NULL), HN_OK);
        const hn_sheet sheet = make_sheet(&opts);
        hn_canvas *c = create();
        hn_label_places placed = {0};
        hn_snapshot_angles(c, &sheet, &pantograph, &pose, &opts, &placed);
        hn_canvas_free(c);
        assert_int_equal(placed.n, arcs[i]);
        if (arcs[i]) { // the last chord of the arc ends on the line from O to A
            const double *tip = placed.line[placed.n_lines - 1][1];
            double o[2], a[2];
            hn_sheet_pixel(&sheet, points, o);
            hn_sheet_pixel(&sheet, points + 6, a);
            const double u[2] = {a[0] - o[0], a[1] - o[1]}, w[2] = {tip[0] - o[0], tip[1] - o[1]};
            assert_true(u[0] * w[0] + u[1] * w[1] > 0);
            assert_true(fabs(u[0] * w[1] - u[1] * w[0]) < 1e-6 * (u[0] * u[0] + u[1] * u[1]));
        }
    }
}

// both rails of a guide cross the drawing, far from the point that it is given by
static void a_name_keeps_off_the_rails_of_a_guide(void **state) {
    (void)state;
    static const hn_shape rails[] = {
        {.kind = HN_SHAPE_GUIDE, .p = 0, .q = 5, .body = HN_GROUND},
        {.kind = HN_SHAPE_SLIDER, .p = 4, .q = 0, .body = 0},
        {.kind = HN_SHAPE_BAR, .p = 2, .q = 4, .body = 1},
    };
    hn_drawing d = pantograph;
    d.shapes = rails;
    d.n_shapes = 3;
    const hn_snapshot_opts opts = hn_snapshot_opts_default();
    const hn_sheet sheet = make_sheet(&opts);
    hn_canvas *c = create();
    hn_label_places placed = {0};
    hn_snapshot_names(c, &sheet, &d, &pose, &opts, &placed);
    hn_canvas_free(c);
    double rail[2];
    hn_sheet_pixel(&sheet, points, rail);
    assert_int_equal(placed.n, N_POINTS);
    for (int i = 0; i < placed.n; i++) {
        const double away = fabs(placed.at[i][1] - rail[1]);
        assert_true(fabs(away - 1.02 * sheet.bar) > 0.4 * sheet.font);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_and_angles_stand_beside_the_bars),
        cmocka_unit_test(dimension_lines_of_bars_on_one_line_lie_apart),
        cmocka_unit_test(an_angle_without_an_arc_has_no_text),
        cmocka_unit_test(an_arc_ends_at_its_bar_in_every_view),
        cmocka_unit_test(a_name_keeps_off_the_rails_of_a_guide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
