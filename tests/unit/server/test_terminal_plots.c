// SPDX-License-Identifier: GPL-3.0-or-later
// Plots in character cells: points, maps and bars stand where their numbers say.
#include "support/near.h"

#include "terminal/bars.h"
#include "terminal/decades.h"
#include "terminal/line_break.h"
#include "terminal/map_plot.h"
#include "terminal/scatter.h"

#include <math.h>
#include <string.h>

static const char *glyph(const hn_cells *c, int x, int y) {
    return c->at[y * c->columns + x].glyph;
}

static void points_stand_in_their_decades_and_failures_on_the_upper_edge(void **state) {
    (void)state;
    hn_cells c = {0};
    assert_true(hn_cells_resize(&c, 40, 9));
    const hn_scatter s = {.x_unit = "s",
                          .y_high = 1,
                          .n = 1,
                          .series = {{.n = 3,
                                      .colour = 2,
                                      .glyph = "*",
                                      .point = {{.x = 1e-3, .y = 1e-1},
                                                {.x = 1e-1, .y = 1e-7},
                                                {.x = 1e-2, .on_edge = true}}}}};
    assert_true(hn_scatter_draw(&c, (hn_area){0, 0, 40, 9}, &s, HN_DOTS_ASCII));

    // 8 columns of labels, then 32 columns and 8 rows: a decade a row from 1 to 1e-7
    assert_string_equal(glyph(&c, 9, 1), "*");
    assert_string_equal(glyph(&c, 38, 7), "*");
    assert_string_equal(glyph(&c, 24, 0), "╳");
    assert_int_equal(c.at[1 * 40 + 9].colour, 2);
    assert_int_equal(c.at[0 * 40 + 24].colour, HN_CELL_ALARM);
    hn_cells_free(&c);
}

static void one_point_spans_no_range_and_draws_nothing(void **state) {
    (void)state;
    hn_cells c = {0};
    assert_true(hn_cells_resize(&c, 40, 9));
    hn_scatter s = {.x_unit = "s", .y_high = 1};
    assert_false(hn_scatter_draw(&c, (hn_area){0, 0, 40, 9}, &s, HN_DOTS_BRAILLE));
    assert_false(hn_scatter_draw(&c, (hn_area){0, 0, 10, 3}, &s, HN_DOTS_BRAILLE));
    for (int i = 0; i < 40 * 9; i++) {
        assert_string_equal(c.at[i].glyph, "");
    }
    hn_cells_free(&c);
}

/// Three columns by two rows: a gap of 1 um to 1 mm where it ran, one cell that grew.
static void fill_map(hn_map_plot *p) {
    *p = (hn_map_plot){.heat = true};
    p->x =
        (hn_map_axis){.name = "alpha", .unit = "1/s", .is_log = 1, .n = 3, .value = {1, 10, 100}};
    p->y = (hn_map_axis){.name = "beta", .unit = "1/s", .is_log = 1, .n = 2, .value = {1, 100}};
    for (int i = 0; i < 6; i++) {
        p->cell[i] = (hn_map_plot_cell){
            .kind = HN_STABILITY_FINE, .gap = 1e-6, .error = 0.1, .energy = 0.1, .margin = 0.5};
    }
    p->cell[1].gap = 1e-3;
    p->cell[2].error = 1e-3;
    p->cell[3].gap = 9e-7;
    p->cell[3].energy = 2e-3;
    p->cell[5] = (hn_map_plot_cell){.kind = HN_STABILITY_GREW, .margin = 2};
    p->cell[4].limit = true;
}

static void a_map_shades_what_ran_by_its_gap_and_marks_what_grew(void **state) {
    (void)state;
    static hn_map_plot p;
    hn_cells c = {0};
    const hn_map_place none = {-1, -1};
    fill_map(&p);
    assert_true(hn_cells_resize(&c, 60, 12));
    hn_map_plot_draw(&c, (hn_area){0, 0, 60, 12}, &p, none, none);
    assert_string_equal(glyph(&c, 12, 1), "░"); // 1 um, the lowest row is at the bottom
    assert_string_equal(glyph(&c, 14, 1), "█"); // 1 mm
    assert_string_equal(glyph(&c, 16, 0), "!");
    assert_string_equal(glyph(&c, 15, 0), "━"); // the predicted limit passes there
    hn_cells_free(&c);
}

static void a_map_marks_the_best_cell_for_gap_velocity_and_energy(void **state) {
    (void)state;
    static hn_map_plot p;
    hn_cells c = {0};
    hn_strbuf b;
    const hn_map_place none = {-1, -1};
    fill_map(&p);
    assert_true(hn_cells_resize(&c, 60, 12));
    hn_map_plot_draw(&c, (hn_area){0, 0, 60, 12}, &p, none, none);
    assert_string_equal(glyph(&c, 12, 0), "g"); // two of them share a cell
    assert_string_equal(glyph(&c, 13, 0), "e");
    assert_string_equal(glyph(&c, 16, 1), "v");
    assert_string_equal(glyph(&c, 17, 1), "░");
    hn_cells_free(&c);

    // a small gap beside a wrong motion is no merit
    hn_strbuf_init(&b);
    hn_map_plot_best_words(&b, &p);
    assert_non_null(strstr(hn_strbuf_text(&b),
                           "g smallest worst loop gap: 900 nm at alpha = 1 1/s, beta = 100 1/s, "
                           "where the velocity is 10 % off\n"
                           "v smallest error of velocity: 0.1 % at alpha = 100 1/s, beta = 1 1/s\n"
                           "e smallest energy gained: 0.2 % at "));
    hn_strbuf_reset(&b);
}

static void marks_of_a_map_leave_the_outcome_of_their_cell(void **state) {
    (void)state;
    static hn_map_plot p;
    hn_cells c = {0};
    const hn_map_place present = {1, 0}, cursor = {2, 1};
    fill_map(&p);
    assert_true(hn_cells_resize(&c, 60, 12));
    hn_map_plot_draw(&c, (hn_area){0, 0, 60, 12}, &p, present, cursor);
    assert_string_equal(glyph(&c, 14, 1), "█");
    assert_string_equal(glyph(&c, 15, 1), "★");
    assert_string_equal(glyph(&c, 16, 0), "!");
    assert_string_equal(glyph(&c, 17, 0), "⊕");
    hn_cells_free(&c);
}

static void a_map_names_columns_below_a_tick_at_their_edge(void **state) {
    (void)state;
    static hn_map_plot p;
    hn_cells c = {0};
    const hn_map_place none = {-1, -1};
    fill_map(&p);
    assert_true(hn_cells_resize(&c, 60, 12));
    hn_map_plot_draw(&c, (hn_area){0, 0, 60, 12}, &p, none, none);
    assert_string_equal(glyph(&c, 12, 2), "┬");
    assert_string_equal(glyph(&c, 12, 3), "1");
    assert_string_equal(glyph(&c, 14, 2), "┬");
    assert_string_equal(glyph(&c, 14, 3), "1");
    assert_string_equal(glyph(&c, 15, 3), "0");
    // 100 would touch 10
    assert_string_equal(glyph(&c, 16, 2), "─");
    assert_string_equal(glyph(&c, 16, 3), "");
    hn_cells_free(&c);
}

static void a_line_is_not_broken_beside_a_unit_or_an_equals_sign(void **state) {
    (void)state;
    const char *const whole[] = {"gap 27 mm", "after 4 s.", "right to 1 %", "4 rad/s",
                                 "3 1/s",     "12 µm",      "l1 = 0.5"};
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++) {
        const char *blank = strrchr(whole[i], ' ');
        assert_false(hn_line_may_break(whole[i], (size_t)(blank - whole[i])));
    }
    assert_false(hn_line_may_break("l1 = 0.5", 2));
    const char *const broken[] = {"of 27 methods", "a m", "5 scenes", "in 2 sixth"};
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        const char *blank = strrchr(broken[i], ' ');
        assert_true(hn_line_may_break(broken[i], (size_t)(blank - broken[i])));
    }

    // one that fills the line alone is broken all the same, as nothing else can be
    assert_int_equal(hn_text_rows("worst gap 27 mm", 13), 2);
    assert_int_equal(hn_text_rows("27 mm", 3), 2);
    assert_int_equal(hn_text_rows("with l1 = 0.5", 8), 2);
}

static void a_map_finds_the_nearest_cell_and_says_what_is_in_it(void **state) {
    (void)state;
    static hn_map_plot p;
    hn_strbuf b;
    fill_map(&p);
    const hn_map_place at = hn_map_plot_place(&p, 8, 3); // on logarithmic axes
    assert_int_equal(at.column, 1);
    assert_int_equal(at.row, 0);
    hn_strbuf_init(&b);
    hn_map_plot_words(&b, &p, at);
    assert_string_equal(hn_strbuf_text(&b),
                        "alpha = 10 1/s, beta = 1 1/s: stable, velocities right to 1 %; "
                        "worst gap 1.0 mm; the step is 0.5 of the predicted limit");
    hn_strbuf_reset(&b);
    // beyond the map: at its edge
    assert_int_equal(hn_map_plot_place(&p, -1, 3).column, 0);
    assert_int_equal(hn_map_plot_place(&p, 1e9, 3).column, p.x.n - 1);
    assert_true(hn_map_plot_is_beyond(&p, 8, 0) && hn_map_plot_is_beyond(&p, 1e9, 3));
    assert_false(hn_map_plot_is_beyond(&p, 8, 3));
    assert_int_equal(hn_map_plot_place(&p, (double)NAN, 3).column, -1);
}

static void bars_have_lengths_in_proportion_and_a_negative_one_is_lighter(void **state) {
    (void)state;
    const hn_bar bars[] = {{.label = "a", .value = "1 of 1", .share = 1},
                           {.label = "bb", .value = "1 of 2", .share = 0.5},
                           {.label = "c", .value = "-1", .share = -0.5},
                           {.label = "d", .value = "not known", .share = (double)NAN}};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_bars_text(&b, bars, 4, 27, false);
    assert_string_equal(hn_strbuf_text(&b), "  a   ██████████  1 of 1\n"
                                            "  bb  █████░░░░░  1 of 2\n"
                                            "  c   ▒▒▒▒▒░░░░░  -1\n"
                                            "  d               not known\n");
    hn_strbuf_reset(&b);
}

static void labels_of_decades_stand_evenly_apart_and_the_axis_holds_all(void **state) {
    (void)state;
    for (int rows = 3; rows <= 60; rows++) {
        for (int span = 1; span <= 40; span++) {
            const double high = 2;
            double low = high - span;
            const double step = hn_decades_spread(high, &low, rows);
            const double apart = step / (high - low) * (rows - 1); // rows between two labels
            assert_true(low <= high - span + 1e-9);
            assert_true(fabs(apart - round(apart)) < 1e-9);
            // three labels wherever there is room for them
            assert_true(rows < 10 || high - 2 * step >= low - 1e-9);
            const double lead = step / pow(10, floor(log10(step)));
            assert_true(lead == 1 || lead == 2 || lead == 3 || lead == 5);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_stand_in_their_decades_and_failures_on_the_upper_edge),
        cmocka_unit_test(one_point_spans_no_range_and_draws_nothing),
        cmocka_unit_test(a_map_shades_what_ran_by_its_gap_and_marks_what_grew),
        cmocka_unit_test(a_map_marks_the_best_cell_for_gap_velocity_and_energy),
        cmocka_unit_test(marks_of_a_map_leave_the_outcome_of_their_cell),
        cmocka_unit_test(a_map_names_columns_below_a_tick_at_their_edge),
        cmocka_unit_test(a_line_is_not_broken_beside_a_unit_or_an_equals_sign),
        cmocka_unit_test(a_map_finds_the_nearest_cell_and_says_what_is_in_it),
        cmocka_unit_test(labels_of_decades_stand_evenly_apart_and_the_axis_holds_all),
        cmocka_unit_test(bars_have_lengths_in_proportion_and_a_negative_one_is_lighter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
