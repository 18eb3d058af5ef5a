// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "render/canvas.h"
#include "render/png_file.h"
#include "render/raster.h"
#include "support/alloc.h"

#include <math.h>
#include <png.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double PI = 3.14159265358979324;

typedef struct picture {
    int width, height;
    unsigned char *rgb;
} picture;

static picture paint(const hn_canvas *c) {
    picture p = {hn_canvas_width(c), hn_canvas_height(c), NULL};
    p.rgb = malloc((size_t)3 * (size_t)p.width * (size_t)p.height);
    assert_non_null(p.rgb);
    hn_diag diag = {0};
    assert_int_equal(hn_canvas_paint(c, p.rgb, &diag), HN_OK);
    return p;
}

static uint32_t pixel(const picture *p, int x, int y) {
    const unsigned char *s = p->rgb + 3 * (y * p->width + x);
    return (uint32_t)s[0] << 16 | (uint32_t)s[1] << 8 | s[2];
}

static hn_canvas *create(int width, int height) {
    hn_canvas *c = NULL;
    hn_diag diag = {0};
    assert_int_equal(hn_canvas_create(width, height, HN_THEME_LIGHT, &c, &diag), HN_OK);
    return c;
}

/// Returns how many pixels' worth of black lies on the paper, by the red channel.
static double ink(const picture *p) {
    const double paper = hn_surface_get(HN_THEME_LIGHT)->paper >> 16;
    double sum = 0;
    for (int i = 0; i < p->width * p->height; i++) {
        sum += (paper - p->rgb[3 * i]) / paper;
    }
    return sum;
}

static const hn_paint BLACK = {0x000000, 1};

static void the_built_in_renderer_paints_what_osmesa_paints(void **state) {
    (void)state;
    hn_canvas *c = create(300, 270);
    const double star[] = {20.3, 40.1, 280, 60, 40, 250.7, 150, 10, 240.2, 240};
    const hn_stroke dashed = {.paint = {0x1144aa, 0.7}, .width = 5.5};
    hn_canvas_polygon(c, star, 5, (hn_paint){0x33aa55, 0.5});
    hn_canvas_begin_layer(c, 0.6);
    hn_canvas_line(c, star, 5, &dashed);
    hn_canvas_disc(c, 150, 130, 60.4, (hn_paint){0xcc2200, 1});
    hn_canvas_end_layer(c);
    hn_canvas_clip(c, 100, 100, 80, 90);
    hn_canvas_text(c, 150, 150, 40, HN_ALIGN_CENTRE, BLACK, "gap");
    hn_canvas_unclip(c);

    picture a = paint(c), b = {a.width, a.height, malloc((size_t)3 * 300 * 270)};
    assert_non_null(b.rgb);
    assert_int_equal(hn_raster_paint(c, b.rgb, NULL), HN_OK);
    double sum = 0;
    int worst = 0;
    for (int i = 0; i < 3 * 300 * 270; i++) {
        const int difference = abs(a.rgb[i] - b.rgb[i]);
        worst = difference > worst ? difference : worst;
        sum += difference;
    }
    // samples on the very edges may fall to either side: two of sixteen, of 255 levels
    assert_true(worst <= 2 * 255 / 16 + 1);
    assert_true(sum / (3 * 300 * 270) < 0.05);
    free(a.rgb);
    free(b.rgb);
    hn_canvas_free(c);
}

static void an_empty_sheet_is_paper_to_its_last_pixel(void **state) {
    (void)state;
    for (int theme = 0; theme < HN_THEME_COUNT; theme++) {
        hn_canvas *c = NULL;
        assert_int_equal(hn_canvas_create(300, 270, (hn_theme)theme, &c, NULL), HN_OK);
        picture p = paint(c);
        for (int y = 0; y < 270; y++) {
            for (int x = 0; x < 300; x++) {
                assert_int_equal(pixel(&p, x, y), hn_surface_get((hn_theme)theme)->paper);
            }
        }
        free(p.rgb);
        hn_canvas_free(c);
    }
}

// tiles are 256 pixels: corners, both sides of a border, and the rest of the last tile
static void a_pixel_sized_square_lands_on_its_pixel_in_every_tile(void **state) {
    (void)state;
    const int at[][2] = {{0, 0},   {255, 255}, {256, 256}, {299, 0},
                         {0, 269}, {299, 269}, {255, 100}, {256, 100}};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        hn_canvas *c = create(300, 270);
        const double x = at[i][0], y = at[i][1];
        hn_canvas_polygon(c, (const double[]){x, y, x + 1, y, x + 1, y + 1, x, y + 1}, 4, BLACK);
        picture p = paint(c);
        assert_int_equal(pixel(&p, at[i][0], at[i][1]), 0);
        assert_near(ink(&p), 1, 1e-12);
        free(p.rgb);
        hn_canvas_free(c);
    }
}

static void shapes_have_the_area_of_geometry(void **state) {
    (void)state;
    const double star[20] = {150, 30,  170, 70,  210, 75,  180, 100, 190, 140,
                             150, 120, 110, 140, 120, 100, 90,  75,  130, 70};
    double twice = 0;
    for (int i = 0, j = 9; i < 10; j = i++) {
        twice += star[2 * j] * star[2 * i + 1] - star[2 * i] * star[2 * j + 1];
    }
    double capsule[2 * HN_CAPSULE_POINTS];
    const int n = hn_canvas_capsule(40, 200, 240, 230, 20, capsule);
    const double length = hypot(200, 30);
    const double areas[4] = {PI * 40 * 40, fabs(twice) / 2, length * 20 + PI * 10 * 10,
                             length * 6 + PI * 3 * 3};
    for (int k = 0; k < 4; k++) {
        hn_canvas *c = create(300, 270);
        const hn_stroke line = {.paint = BLACK, .width = 6};
        if (k == 0) {
            hn_canvas_disc(c, 150.3, 120.7, 40, BLACK);
        } else if (k == 1) {
            hn_canvas_polygon(c, star, 10, BLACK);
        } else if (k == 2) {
            hn_canvas_polygon(c, capsule, n, BLACK);
        } else {
            hn_canvas_segment(c, 40, 200, 240, 230, &line);
        }
        picture p = paint(c);
        assert_rel(ink(&p), areas[k], 0.01);
        free(p.rgb);
        hn_canvas_free(c);
    }
}

static void edges_are_smooth(void **state) {
    (void)state;
    hn_canvas *c = create(64, 64);
    hn_canvas_disc(c, 32, 32, 20, BLACK);
    picture p = paint(c);
    int seen[256] = {0}, levels = 0;
    for (int i = 0; i < 64 * 64; i++) {
        seen[p.rgb[3 * i]] = 1;
    }
    for (int i = 0; i < 256; i++) {
        levels += seen[i];
    }
    assert_true(levels >= 10 && levels <= HN_CANVAS_SAMPLES * HN_CANVAS_SAMPLES + 1);
    free(p.rgb);
    hn_canvas_free(c);
}

static void a_translucent_line_that_crosses_itself_has_one_shade(void **state) {
    (void)state;
    hn_canvas *c = create(120, 120);
    const double xy[] = {20, 20, 100, 100, 20, 100, 100, 20};
    const hn_stroke s = {.paint = {0x000000, 0.5}, .width = 16};
    hn_canvas_line(c, xy, 4, &s);
    picture p = paint(c);
    const uint32_t alone = pixel(&p, 35, 35);
    assert_int_equal(alone >> 16, 0xFC / 2);
    assert_int_equal(pixel(&p, 60, 60), alone); // the crossing
    assert_int_equal(pixel(&p, 22, 98), alone); // a joint
    free(p.rgb);
    hn_canvas_free(c);
}

static void two_shapes_without_a_layer_do_add_up(void **state) {
    (void)state;
    hn_canvas *c = create(64, 64);
    hn_canvas_disc(c, 32, 32, 20, (hn_paint){0x000000, 0.5});
    hn_canvas_disc(c, 32, 32, 20, (hn_paint){0x000000, 0.5});
    picture p = paint(c);
    assert_near(pixel(&p, 32, 32) >> 16, 0xFC / 4.0, 1);
    free(p.rgb);
    hn_canvas_free(c);
}

static void a_layer_is_mixed_with_the_paper_once_its_last_shape_on_top(void **state) {
    (void)state;
    hn_canvas *c = create(64, 64);
    hn_canvas_begin_layer(c, 0.6);
    hn_canvas_disc(c, 32, 32, 25, (hn_paint){0xFF0000, 1});
    hn_canvas_disc(c, 32, 32, 10, (hn_paint){0x0000FF, 1});
    hn_canvas_end_layer(c);
    picture p = paint(c);
    const uint32_t inner = pixel(&p, 32, 32), outer = pixel(&p, 50, 32);
    assert_near(inner >> 16, 0.4 * 0xFC, 1);
    assert_near(inner & 0xff, 0.6 * 255 + 0.4 * 0xFA, 1);
    assert_near(outer >> 16, 0.6 * 255 + 0.4 * 0xFC, 1);
    assert_near(outer & 0xff, 0.4 * 0xFA, 1);
    free(p.rgb);
    hn_canvas_free(c);
}

// the stencil has 8 bits: more layers than that must not see each other
static void three_hundred_layers_stay_apart(void **state) {
    (void)state;
    hn_canvas *c = create(32, 32);
    for (int i = 0; i < 300; i++) {
        hn_canvas_disc(c, 16, 16, 12, hn_paint_solid((uint32_t)i));
    }
    picture p = paint(c);
    assert_int_equal(pixel(&p, 16, 16), 299);
    free(p.rgb);
    hn_canvas_free(c);
}

static void a_clip_cuts_shapes_at_its_rectangle(void **state) {
    (void)state;
    hn_canvas *c = create(300, 300);
    hn_canvas_clip(c, 200, 210, 80, 70);
    hn_canvas_polygon(c, (const double[]){0, 0, 300, 0, 300, 300, 0, 300}, 4, BLACK);
    hn_canvas_unclip(c);
    picture p = paint(c);
    assert_near(ink(&p), 80 * 70, 1e-9);
    assert_int_equal(pixel(&p, 200, 210), 0);
    assert_int_equal(pixel(&p, 279, 279), 0);
    assert_int_not_equal(pixel(&p, 199, 210), 0);
    assert_int_not_equal(pixel(&p, 280, 279), 0);
    free(p.rgb);
    hn_canvas_free(c);
}

static void dashes_cover_their_share_of_the_line_and_go_round_corners(void **state) {
    (void)state;
    const double dash[] = {12, 8};
    const hn_stroke dashed = {.paint = BLACK, .width = 2, .n_dash = 2, .dash = dash};
    const hn_stroke full = {.paint = BLACK, .width = 2};
    double covered[2];
    for (int k = 0; k < 2; k++) {
        hn_canvas *c = create(440, 60);
        hn_canvas_line(c, (const double[]){20, 30, 163, 30, 420, 30}, 3, k ? &dashed : &full);
        picture p = paint(c);
        covered[k] = ink(&p);
        free(p.rgb);
        hn_canvas_free(c);
    }
    assert_near(covered[1] / covered[0], 12.0 / 20.0, 0.03);
}

static void a_line_with_a_hole_in_its_data_is_two_lines(void **state) {
    (void)state;
    hn_canvas *c = create(120, 40);
    const double nan = (double)NAN;
    const double xy[] = {10, 20, 40, 20, nan, nan, 80, 20, 110, 20};
    const hn_stroke s = {.paint = BLACK, .width = 4};
    hn_canvas_line(c, xy, 5, &s);
    picture p = paint(c);
    assert_int_equal(pixel(&p, 25, 20), 0);
    assert_int_equal(pixel(&p, 95, 20), 0);
    assert_int_equal(pixel(&p, 60, 20), hn_surface_get(HN_THEME_LIGHT)->paper);
    free(p.rgb);
    hn_canvas_free(c);
}

static void every_marker_leaves_ink_of_its_own(void **state) {
    (void)state;
    picture seen[HN_MARKER_COUNT];
    for (int m = 0; m < HN_MARKER_COUNT; m++) {
        hn_canvas *c = create(32, 32);
        hn_canvas_marker(c, (hn_marker)m, 16, 16, 20, BLACK);
        seen[m] = paint(c);
        assert_true(ink(&seen[m]) > 10);
        for (int k = 0; k < m; k++) {
            assert_memory_not_equal(seen[m].rgb, seen[k].rgb, 3 * 32 * 32);
        }
        hn_canvas_free(c);
    }
    for (int m = 0; m < HN_MARKER_COUNT; m++) {
        free(seen[m].rgb);
    }
}

static void sizes_out_of_bounds_are_refused_by_name(void **state) {
    (void)state;
    const struct {
        int width, height;
        const char *pointer;
    } cases[] = {
        {15, 100, "/width"}, {4097, 100, "/width"}, {100, 0, "/height"}, {100, 1 << 30, "/height"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hn_canvas *c = (hn_canvas *)&c;
        hn_diag diag = {0};
        assert_int_equal(
            hn_canvas_create(cases[i].width, cases[i].height, HN_THEME_LIGHT, &c, &diag),
            HN_ERR_LIMIT);
        assert_string_equal(diag.pointer, cases[i].pointer);
        assert_ptr_equal(c, &c);
    }
}

static void draw_a_little_of_everything(hn_canvas *c) {
    const hn_stroke s = {
        .paint = {0x0A49D5, 1}, .width = 3, .n_dash = 2, .dash = (const double[]){9, 6}};
    hn_canvas_begin_layer(c, 0.6);
    hn_canvas_segment(c, 10, 10, 200, 90, &s);
    hn_canvas_ring(c, 100, 60, 30, &s);
    hn_canvas_end_layer(c);
    hn_canvas_arrow(c, 20, 80, 90, 20, 12, &s);
    hn_canvas_hatch(c, 150, 80, 40, 0, &s);
    hn_canvas_polygon(c, (const double[]){5, 5, 50, 8, 30, 40}, 3, BLACK);
    hn_canvas_text(c, 120, 50, 20, HN_ALIGN_CENTRE, BLACK, "gap 4.2 \xc2\xb5m");
}

static void the_png_reads_back_to_the_same_pixels_and_twice_the_same_bytes(void **state) {
    (void)state;
    hn_canvas *c = create(220, 100);
    draw_a_little_of_everything(c);
    picture p = paint(c);
    hn_strbuf png, again;
    hn_strbuf_init(&png);
    hn_strbuf_init(&again);
    assert_int_equal(hn_canvas_png(c, &png, NULL), HN_OK);
    assert_int_equal(hn_canvas_png(c, &again, NULL), HN_OK);
    assert_int_equal(png.n, again.n);
    assert_memory_equal(png.text, again.text, png.n);

    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_memory(&image, png.text, png.n));
    assert_int_equal(image.width, 220);
    assert_int_equal(image.height, 100);
    image.format = PNG_FORMAT_RGB;
    unsigned char *read = malloc(PNG_IMAGE_SIZE(image));
    assert_true(png_image_finish_read(&image, NULL, read, 0, NULL));
    assert_memory_equal(read, p.rgb, 3 * 220 * 100);

    free(read);
    free(p.rgb);
    hn_strbuf_reset(&png);
    hn_strbuf_reset(&again);
    hn_canvas_free(c);
}

static void *paint_in_thread(void *rgb) {
    for (int i = 0; i < 5; i++) {
        hn_canvas *c = NULL;
        if (hn_canvas_create(220, 100, HN_THEME_LIGHT, &c, NULL) == HN_OK) {
            draw_a_little_of_everything(c);
            if (hn_canvas_paint(c, rgb, NULL) != HN_OK) {
                memset(rgb, 0, 3 * 220 * 100);
            }
            hn_canvas_free(c);
        }
    }
    return NULL;
}

static void threads_that_paint_at_once_get_the_same_pixels(void **state) {
    (void)state;
    static unsigned char rgb[4][3 * 220 * 100];
    hn_canvas *c = create(220, 100);
    draw_a_little_of_everything(c);
    picture alone = paint(c);
    pthread_t threads[4];
    for (int i = 0; i < 4; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, paint_in_thread, rgb[i]), 0);
    }
    for (int i = 0; i < 4; i++) {
        pthread_join(threads[i], NULL);
        assert_memory_equal(rgb[i], alone.rgb, sizeof rgb[i]);
    }
    free(alone.rgb);
    hn_canvas_free(c);
}

/// A sheet that takes longer to paint than a thread has its turn.
static hn_canvas *create_large(void) {
    enum { SIDE = 1400 };
    hn_canvas *c = create(SIDE, SIDE);
    for (int i = 0; i < 40; i++) {
        hn_canvas_disc(c, SIDE / 2, SIDE / 2, SIDE / 2 - 15 * i, (hn_paint){0x050607 * i, 0.7});
    }
    draw_a_little_of_everything(c);
    return c;
}

static void *paint_large_in_thread(void *rgb) {
    hn_canvas *c = create_large();
    assert_int_equal(hn_canvas_paint(c, rgb, NULL), HN_OK);
    hn_canvas_free(c);
    return NULL;
}

static void threads_that_take_turns_within_a_picture_get_the_same_pixels(void **state) {
    (void)state;
    hn_canvas *c = create_large();
    picture alone = paint(c);
    const size_t size = (size_t)3 * (size_t)alone.width * (size_t)alone.height;
    unsigned char *rgb[3];
    pthread_t threads[3];
    for (int i = 0; i < 3; i++) {
        rgb[i] = malloc(size);
        assert_non_null(rgb[i]);
        assert_int_equal(pthread_create(&threads[i], NULL, paint_large_in_thread, rgb[i]), 0);
    }
    for (int i = 0; i < 3; i++) {
        pthread_join(threads[i], NULL);
        assert_memory_equal(rgb[i], alone.rgb, size);
        free(rgb[i]);
    }
    free(alone.rgb);
    hn_canvas_free(c);
}

static bool ends_after(void *left) {
    return (*(int *)left)-- <= 0;
}

static void an_interrupt_ends_painting_and_writing(void **state) {
    (void)state;
    hn_canvas *c = create_large();
    picture whole = paint(c);
    int left = 0;
    const hn_interrupt interrupt = {ends_after, &left};
    hn_canvas_interrupt(c, &interrupt);
    assert_int_equal(hn_canvas_paint(c, whole.rgb, NULL), HN_ERR_STOPPED);
    left = 3;
    assert_int_equal(hn_raster_paint(c, whole.rgb, NULL), HN_ERR_STOPPED);

    // a file that was not written to its end is not there
    hn_strbuf png;
    hn_strbuf_init(&png);
    hn_strbuf_add(&png, "before");
    left = 3;
    assert_int_equal(hn_png_encode(&png, whole.width, whole.height, whole.rgb, &interrupt, NULL),
                     HN_ERR_STOPPED);
    assert_string_equal(png.text, "before");
    left = 0;
    assert_int_equal(hn_canvas_png(c, &png, NULL), HN_ERR_STOPPED);
    assert_string_equal(png.text, "before");

    // whoever was stopped holds nobody up
    hn_canvas_interrupt(c, NULL);
    assert_int_equal(hn_canvas_paint(c, whole.rgb, NULL), HN_OK);
    hn_strbuf_reset(&png);
    free(whole.rgb);
    hn_canvas_free(c);
}

static hn_status draw_and_encode(hn_strbuf *png) {
    hn_canvas *c = NULL;
    hn_status status = hn_canvas_create(220, 100, HN_THEME_LIGHT, &c, NULL);
    if (status == HN_OK) {
        draw_a_little_of_everything(c);
        status = hn_canvas_png(c, png, NULL);
        hn_canvas_free(c);
    }
    return status;
}

static void every_failing_allocation_is_told_and_nothing_leaks(void **state) {
    (void)state;
    const long live = hn_alloc_live();
    long n = 1;
    for (;; n++) {
        hn_strbuf png;
        hn_strbuf_init(&png);
        hn_alloc_fail_at(n);
        const hn_status status = draw_and_encode(&png);
        const int failed = hn_alloc_has_failed();
        hn_alloc_fail_at(0);
        hn_strbuf_reset(&png);
        assert_int_equal(status, failed ? HN_ERR_MEMORY : HN_OK);
        assert_int_equal(hn_alloc_live(), live);
        if (!failed) {
            break;
        }
    }
    assert_true(n > 8);
    hn_canvas_free(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_sheet_is_paper_to_its_last_pixel),
        cmocka_unit_test(the_built_in_renderer_paints_what_osmesa_paints),
        cmocka_unit_test(a_pixel_sized_square_lands_on_its_pixel_in_every_tile),
        cmocka_unit_test(shapes_have_the_area_of_geometry),
        cmocka_unit_test(edges_are_smooth),
        cmocka_unit_test(a_translucent_line_that_crosses_itself_has_one_shade),
        cmocka_unit_test(two_shapes_without_a_layer_do_add_up),
        cmocka_unit_test(a_layer_is_mixed_with_the_paper_once_its_last_shape_on_top),
        cmocka_unit_test(three_hundred_layers_stay_apart),
        cmocka_unit_test(a_clip_cuts_shapes_at_its_rectangle),
        cmocka_unit_test(dashes_cover_their_share_of_the_line_and_go_round_corners),
        cmocka_unit_test(a_line_with_a_hole_in_its_data_is_two_lines),
        cmocka_unit_test(every_marker_leaves_ink_of_its_own),
        cmocka_unit_test(sizes_out_of_bounds_are_refused_by_name),
        cmocka_unit_test(the_png_reads_back_to_the_same_pixels_and_twice_the_same_bytes),
        cmocka_unit_test(threads_that_paint_at_once_get_the_same_pixels),
        cmocka_unit_test(threads_that_take_turns_within_a_picture_get_the_same_pixels),
        cmocka_unit_test(an_interrupt_ends_painting_and_writing),
        cmocka_unit_test(every_failing_allocation_is_told_and_nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
