// SPDX-License-Identifier: GPL-3.0-or-later
// The shipped files: scenes and problems are read when they are first asked for, by any thread.
#include "session/model/library.h"
#include "support/near.h"

#include <pthread.h>
#include <string.h>

enum { THREADS = 4 };

typedef struct seen {
    const hn_library *lib;
    int scenes, problems;
    const char *scene, *problem;
} seen;

static void *ask(void *self) {
    seen *s = self;
    s->scene = hn_library_scene_path(s->lib, "four-bar");
    s->problem = hn_library_problem_path(s->lib, "p3");
    s->scenes = hn_library_n_scenes(s->lib);
    s->problems = hn_library_n_problems(s->lib);
    return NULL;
}

static void threads_that_ask_at_once_get_the_same_answers(void **state) {
    (void)state;
    pthread_t threads[THREADS];
    seen s[THREADS];
    hn_library *lib = NULL;
    hn_diag diag = {0};
    assert_int_equal(hn_library_open(".", &lib, &diag), HN_OK);
    for (int i = 0; i < THREADS; i++) {
        s[i] = (seen){.lib = lib};
        assert_int_equal(pthread_create(&threads[i], NULL, ask, &s[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    }
    assert_string_equal(s[0].scene, "./lessons/01-closed-loops/scenes/four-bar.json");
    assert_true(s[0].scenes > 20 && s[0].problems > 20);
    for (int i = 1; i < THREADS; i++) {
        assert_ptr_equal(s[i].scene, s[0].scene);
        assert_ptr_equal(s[i].problem, s[0].problem);
        assert_int_equal(s[i].scenes, s[0].scenes);
        assert_int_equal(s[i].problems, s[0].problems);
    }
    hn_library_free(lib);
}

static void a_folder_without_lessons_is_refused_with_its_name(void **state) {
    (void)state;
    hn_library *lib = NULL;
    hn_diag diag = {0};
    assert_int_equal(hn_library_open("core", &lib, &diag), HN_ERR_IO);
    assert_non_null(strstr(diag.message, "tried: core"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_that_ask_at_once_get_the_same_answers),
        cmocka_unit_test(a_folder_without_lessons_is_refused_with_its_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
