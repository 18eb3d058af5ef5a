// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.h"

#include "terminal/sixel_image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 64, HEIGHT = 50, N = WIDTH * HEIGHT };

/// Reads a picture back: 3 N bytes; 0 where nothing is painted.
static void decode(const char *text, unsigned char *rgb) {
    unsigned char colours[256][3] = {{0}};
    int number = 0, x = 0, top = 0, width, height, used;
    memset(rgb, 0, 3 * N);
    assert_int_equal(sscanf(text, "\033P0;1q\"1;1;%d;%d%n", &width, &height, &used), 2);
    assert_int_equal(width, WIDTH);
    assert_int_equal(height, HEIGHT);
    for (const char *at = text + used; *at != '\033'; at += used) {
        int shade[3], n = 1;
        if (sscanf(at, "#%d;2;%d;%d;%d%n", &number, &shade[0], &shade[1], &shade[2], &used) == 4) {
            for (int k = 0; k < 3; k++) {
                colours[number][k] = (unsigned char)((255 * shade[k] + 50) / 100);
            }
        } else if (sscanf(at, "#%d%n", &number, &used) == 1) {
            assert_in_range(number, 0, HN_SIXEL_COLOURS - 1);
        } else if (*at == '$' || *at == '-') {
            top += *at == '-' ? HN_SIXEL_BAND : 0;
            x = 0;
            used = 1;
        } else {
            char sixel = *at;
            used = 1;
            assert_true(*at != '!' || sscanf(at, "!%d%c%n", &n, &sixel, &used) == 2);
            for (int i = 0; i < n * HN_SIXEL_BAND; i++) {
                const int to = (top + i % HN_SIXEL_BAND) * WIDTH + x + i / HN_SIXEL_BAND;
                if ((sixel - 63) >> i % HN_SIXEL_BAND & 1) {
                    memcpy(rgb + 3 * (size_t)to, colours[number], 3);
                }
            }
            x += n;
        }
    }
}

/// The largest difference of a shade between a picture and what was read back.
static int worst(const unsigned char *rgb) {
    unsigned char back[3 * N];
    hn_strbuf b;
    hn_strbuf_init(&b);
    assert_true(hn_sixel_show(&b, rgb, WIDTH, HEIGHT));
    decode(hn_strbuf_text(&b), back);
    hn_strbuf_reset(&b);
    int most = 0;
    for (int i = 0; i < 3 * N; i++) {
        most = abs(rgb[i] - back[i]) > most ? abs(rgb[i] - back[i]) : most;
    }
    return most;
}

// a shade in per cent is off by 255 / 200 at most, and rounded twice
static void a_picture_of_few_colours_is_shown_as_it_is(void **state) {
    (void)state;
    unsigned char rgb[3 * N];
    for (int i = 0; i < N; i++) {
        const unsigned k = (unsigned)(i * i / 7) % HN_SIXEL_COLOURS;
        rgb[3 * i] = (unsigned char)k;
        rgb[3 * i + 1] = (unsigned char)(7 * k);
        rgb[3 * i + 2] = (unsigned char)(255 - k);
    }
    assert_in_range(worst(rgb), 0, 2);
}

// 3200 colours: 8 levels of each shade are 512, too many; of 4 levels, 64 wide, each is off by 32
static void a_picture_of_too_many_colours_loses_lower_bits_alone(void **state) {
    (void)state;
    unsigned char rgb[3 * N];
    for (int i = 0; i < N; i++) {
        const unsigned k = (unsigned)i * 2654435761u;
        rgb[3 * i] = (unsigned char)(k >> 24);
        rgb[3 * i + 1] = (unsigned char)(k >> 16);
        rgb[3 * i + 2] = (unsigned char)(k >> 8);
    }
    assert_in_range(worst(rgb), 3, 32 + 2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_of_few_colours_is_shown_as_it_is),
        cmocka_unit_test(a_picture_of_too_many_colours_loses_lower_bits_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
