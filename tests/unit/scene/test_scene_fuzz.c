// SPDX-License-Identifier: GPL-3.0-or-later
// Text that was cut off or damaged, and memory that runs out: an error, never a crash, a leak or a
// hang.
#include "scene/scene.h"

#include "support/alloc.h"
#include "support/near.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const FILES[] = {
    "lessons/01-closed-loops/scenes/fb0.json",
    "lessons/01-closed-loops/scenes/fb0-lagrangian.json",
    "lessons/01-closed-loops/scenes/five-bar.json",
    "lessons/01-closed-loops/scenes/n-four-bar.json",
    "lessons/09-space-and-drives/scenes/delta-robot.json",
    "lessons/09-space-and-drives/scenes/planetary-gear.json",
    "lessons/09-space-and-drives/scenes/rolling-wheel.json",
};
enum { N_FILES = sizeof FILES / sizeof FILES[0] };

static char *slurp(const char *path, size_t *n) {
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    char *text = malloc(1 << 16);
    assert_non_null(text);
    *n = fread(text, 1, 1 << 16, f);
    assert_true(*n < 1 << 16); // the whole file
    fclose(f);
    return text;
}

/// A load that must end; a fault must be told, a success must give a scene.
static hn_status load(const char *text, size_t n) {
    hn_scene *scene = NULL;
    hn_diags diags = {0};
    char *exact = malloc(n + (n == 0)); // so that reading one byte too far is seen
    assert_non_null(exact);
    memcpy(exact, text, n);
    hn_status status = hn_scene_load_json(exact, n, NULL, NULL, 0, &scene, &diags);
    assert_true((status == HN_OK) == (scene != NULL));
    assert_true((status == HN_OK) == (diags.found == 0));
    hn_scene_free(scene);
    free(exact);
    return status;
}

static void every_prefix_of_a_scene_is_told(void **state) {
    (void)state;
    for (int k = 0; k < N_FILES; k++) {
        size_t n;
        char *text = slurp(FILES[k], &n);
        assert_int_equal(load(text, n), HN_OK);
        while (n > 0 && text[n - 1] != '}') {
            n--;
        }
        for (size_t cut = 0; cut < n; cut += 1 + cut % 3) {
            assert_int_equal(load(text, cut), HN_ERR_INPUT);
        }
        free(text);
    }
}

static void damaged_bytes_never_crash(void **state) {
    unsigned seed = 12345;
    int refused = 0, tries = 1500;
    (void)state;
    for (int k = 0; k < N_FILES; k++) {
        size_t n;
        char *text = slurp(FILES[k], &n), *copy = malloc(n);
        assert_non_null(copy);
        for (int i = 0; i < tries; i++) {
            memcpy(copy, text, n);
            for (int flips = 1 + i % 4; flips > 0; flips--) {
                seed = seed * 1664525u + 1013904223u;
                size_t at = (seed >> 8) % n;
                seed = seed * 1664525u + 1013904223u;
                copy[at] = i % 2 ? (char)(seed >> 24) : text[(seed >> 8) % n];
            }
            refused += load(copy, n) != HN_OK;
        }
        free(copy);
        free(text);
    }
    // letters of "about" may change freely
    assert_in_range(refused, N_FILES * tries / 10, N_FILES * tries);
}

static void swapped_pieces_never_crash(void **state) {
    unsigned seed = 99;
    (void)state;
    for (int k = 0; k < N_FILES; k++) {
        size_t n;
        char *text = slurp(FILES[k], &n), *copy = malloc(2 * n);
        assert_non_null(copy);
        for (int i = 0; i < 500; i++) {
            size_t cut[3];
            for (int c = 0; c < 3; c++) {
                seed = seed * 1664525u + 1013904223u;
                cut[c] = (seed >> 8) % n;
            }
            size_t from = cut[0] < cut[1] ? cut[0] : cut[1], to = cut[0] < cut[1] ? cut[1] : cut[0];
            memcpy(copy, text, cut[2]);
            memcpy(copy + cut[2], text + from, to - from);
            memcpy(copy + cut[2] + to - from, text + cut[2], n - cut[2]);
            load(copy, n + to - from);
        }
        free(copy);
        free(text);
    }
}

static void memory_that_runs_out_anywhere_is_told_and_nothing_leaks(void **state) {
    // cJSON allocates inside its own library: send that through the counting allocator too
    cJSON_Hooks hooks = {malloc, free};
    (void)state;
    cJSON_InitHooks(&hooks);
    for (int k = 0; k < N_FILES; k++) {
        size_t n;
        char *text = slurp(FILES[k], &n);
        long live = hn_alloc_live(), fault = 0;
        hn_status status;
        do {
            hn_scene *scene = NULL;
            hn_diags diags = {0};
            hn_alloc_fail_at(++fault);
            status = hn_scene_load_json(text, n, NULL, NULL, 0, &scene, &diags);
            int failed = hn_alloc_has_failed();
            hn_alloc_fail_at(0);
            if (failed && status == HN_OK) {
                hn_scene_free(scene); // served without that piece
                status = HN_ERR_MEMORY;
            } else if (failed) {
                assert_int_equal(status, HN_ERR_MEMORY);
                assert_null(scene);
            } else {
                assert_int_equal(status, HN_OK);
                hn_scene_free(scene);
            }
            assert_int_equal(hn_alloc_live(), live);
        } while (status != HN_OK);
        assert_true(fault > 50);
        free(text);
    }
    cJSON_InitHooks(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_prefix_of_a_scene_is_told),
        cmocka_unit_test(damaged_bytes_never_crash),
        cmocka_unit_test(swapped_pieces_never_crash),
        cmocka_unit_test(memory_that_runs_out_anywhere_is_told_and_nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
