// SPDX-License-Identifier: GPL-3.0-or-later
// Spellings of one student's name.
#include "grade/student_name.h"

#include "base/hash.h"
#include "support/near.h"

#include <string.h>

static void check(const char *name, const char *expected) {
    char out[80];
    hn_student_name_normalise(name, out, sizeof out);
    if (strcmp(out, expected) != 0) {
        fail_msg("'%s': '%s', expected '%s'", name, out, expected);
    }

    // the hash is that of the one spelling, as it always was
    assert_true(hn_student_name_hash(7, name) == hn_hash_text(7, expected));
}

static void plain_names_stay_as_they_are(void **state) {
    static const char *const names[] = {"",
                                        "s1001",
                                        "Ada Lovelace",
                                        "ada@example.org",
                                        "José",
                                        "Nguyễn Ánh",
                                        "Łukasz",
                                        "李雷",
                                        "\xff\xfe broken \xc3",
                                        "e",
                                        "Zoë-Ann O'Neil"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        check(names[i], names[i]);
    }
    (void)state;
}

static void marks_are_joined_to_their_letters(void **state) {
    check("Jose\xcc\x81", "José");
    check("Bjo\xcc\x88rn A\xcc\x8a"
          "s",
          "Björn Ås");
    check("Nguye\xcc\x82\xcc\x83n", "Nguyễn");           // circumflex, then tilde
    check("Vie\xcc\xa3\xcc\x82t", "Việt");               // dot below, then circumflex
    check("\xd0\xb8\xcc\x86", "й");                      // Cyrillic
    check("\xce\xb1\xcc\x81", "ά");                      // Greek
    check("\xe3\x81\x8b\xe3\x82\x99", "が");             // kana
    check("\xe1\x84\x92\xe1\x85\xa1\xe1\x86\xab", "한"); // Hangul: three letters, one syllable
    check("q\xcc\x81", "q\xcc\x81");                     // no such letter: left as it is
    (void)state;
}

static void blanks_around_a_name_do_not_count(void **state) {
    check("  Ada \t Lovelace\n", "Ada Lovelace");
    check("Ada\xc2\xa0Lovelace", "Ada Lovelace");
    check(" \t ", "");
    (void)state;
}

static void capital_letters_count(void **state) {
    assert_false(hn_student_name_hash(7, "ada") == hn_student_name_hash(7, "Ada"));
    (void)state;
}

static void a_name_is_cut_behind_a_character_and_may_be_its_own_buffer(void **state) {
    char small[4], own[] = " e\xcc\x81  x ";
    hn_student_name_normalise("aé한", small, sizeof small);
    assert_string_equal(small, "aé");
    hn_student_name_normalise(own, own, sizeof own);
    assert_string_equal(own, "é x");
    (void)state;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_names_stay_as_they_are),
        cmocka_unit_test(marks_are_joined_to_their_letters),
        cmocka_unit_test(blanks_around_a_name_do_not_count),
        cmocka_unit_test(capital_letters_count),
        cmocka_unit_test(a_name_is_cut_behind_a_character_and_may_be_its_own_buffer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
