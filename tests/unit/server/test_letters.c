// SPDX-License-Identifier: GPL-3.0-or-later
// The letters of options: of every shipped part with options, over seeds 1 to 40, the right letter
// is uniform, and the right letter of one part says nothing of another's with the same seed.
#include "grade/variant.h"

#include "support/near.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SEEDS = 40, MAX_LISTS = 400, MAX_LETTERS = 10 };

// Counts are binomial. Of 85 lists of four options a letter is right in 21 on average, deviation 4;
// beyond 5 deviations are 42 and more, by chance once in 10^6 times. Of the 656 tails that are
// compared here (40 seeds and all of them together, two kinds of lists, four letters, too many and
// too few) one goes beyond by chance less than once in 1000 times.
static const double BOUND = 5;

/// The right letter of one list, options or reasons, for every seed.
typedef struct right_letters {
    char name[80];
    int n_letters; ///< that the list has
    bool reasons;
    int letter[SEEDS]; ///< 0: "a"
} right_letters;

static right_letters list[MAX_LISTS];
static int n_lists;

static void keep_list(const hn_exercise *e, const hn_part *p, const char *key, const char *member,
                      int seed, int at) {
    right_letters *l = &list[at];
    hn_diag diag = {0};
    cJSON *right = p->kind->right(p, &diag);
    const char *letter = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(right, member));
    assert_non_null(letter);
    snprintf(l->name, sizeof l->name, "%s %s %s", e->id, p->id, member);
    l->n_letters = cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(p->node, key));
    l->reasons = strcmp(key, "reasons") == 0;
    l->letter[seed - 1] = letter[0] - 'a';
    cJSON_Delete(right);
}

/// Adds the lists of an exercise with this seed, from index `first`. Returns how many there are.
static int keep_seed(const hn_exercise *e, int seed, int first) {
    hn_variant x;
    hn_diag diag = {0};
    int n = 0;
    assert_int_equal(hn_variant_init(&x, e, (uint64_t)seed, &diag), HN_OK);
    for (int i = 0; i < x.n_parts; i++) {
        if (strcmp(x.part[i].kind->name, "choice") == 0) {
            assert_true(first + n + 2 <= MAX_LISTS);
            keep_list(e, &x.part[i], "options", "choice", seed, first + n++);
            keep_list(e, &x.part[i], "reasons", "reason", seed, first + n++);
        }
    }
    hn_variant_reset(&x);
    return n;
}

static int load_all(void **state) {
    glob_t found;
    (void)state;
    assert_int_equal(glob("lessons/*/problems/*.json", 0, NULL, &found), 0);
    for (size_t k = 0; k < found.gl_pathc; k++) {
        hn_exercise *e = NULL;
        hn_diags diags = {0};
        int n = 0;
        assert_int_equal(hn_exercise_load_file(found.gl_pathv[k], &e, &diags), HN_OK);
        for (int seed = 1; seed <= SEEDS && e->n_parts > 0; seed++) {
            n = keep_seed(e, seed, n_lists);
        }
        n_lists += n;
        hn_exercise_free(e);
    }
    globfree(&found);
    return 0;
}

/// Fails when a count is further from its mean than independent uniform letters would bring it.
static void expect_count(const char *what, int seed, int letter, double count, double mean,
                         double variance) {
    if (!(fabs(count - mean) <= BOUND * sqrt(variance))) {
        fail_msg("%s, seed %d, letter %c: %g, where %g is the mean and %.3g the deviation", what,
                 seed, 'a' + letter, count, mean, sqrt(variance));
    }
}

/// Counts lists whose right letter is `letter`, with one seed or, for seed 0, with all.
static void count_letter(bool reasons, int seed, int letter) {
    double count = 0, mean = 0, variance = 0;
    for (int i = 0; i < n_lists; i++) {
        for (int s = 0; s < SEEDS; s++) {
            if (list[i].reasons == reasons && letter < list[i].n_letters &&
                (seed == 0 || seed == s + 1)) {
                const double share = 1.0 / list[i].n_letters;
                count += list[i].letter[s] == letter;
                mean += share;
                variance += share * (1 - share);
            }
        }
    }
    expect_count(reasons ? "reasons" : "options", seed, letter, count, mean, variance);
}

static void no_letter_is_right_more_often_than_another(void **state) {
    (void)state;
    assert_true(n_lists >= 2 * 80);
    for (int reasons = 0; reasons < 2; reasons++) {
        for (int seed = 0; seed <= SEEDS; seed++) {
            for (int letter = 0; letter < MAX_LETTERS; letter++) {
                count_letter(reasons, seed, letter);
            }
        }
    }
}

static void the_right_letter_of_one_part_says_nothing_of_another(void **state) {
    double count = 0, mean = 0, variance = 0;
    (void)state;
    for (int i = 0; i < n_lists; i++) {
        for (int j = 0; j < i; j++) {
            // with as many letters each the events of any two pairs are independent, so that their
            // variances add
            const double share = 1.0 / list[i].n_letters;
            int same = 0;
            for (int s = 0; s < SEEDS; s++) {
                same += list[i].letter[s] == list[j].letter[s];
            }
            if (list[i].n_letters != list[j].n_letters) {
                continue;
            }
            count += same;
            mean += SEEDS * share;
            variance += SEEDS * share * (1 - share);

            // of 40 seeds 10 agree on average; 29 and more do by chance once in 10^9 times, in one
            // of the 13,862 pairs once in 10^5 times
            if (same > 28) {
                fail_msg("%s and %s: the same letter with %d of %d seeds", list[i].name,
                         list[j].name, same, SEEDS);
            }
        }
    }
    expect_count("pairs of lists", 0, 0, count, mean, variance);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_letter_is_right_more_often_than_another),
        cmocka_unit_test(the_right_letter_of_one_part_says_nothing_of_another),
    };
    return cmocka_run_group_tests(tests, load_all, NULL);
}
