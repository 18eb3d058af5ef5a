// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_table.h"

#include "cli/shell/args.h"
#include "cli/shell/option_help.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const hn_command *find(const char *name) {
    const hn_command *command = hn_command_find(name);
    assert_non_null(command);
    return command;
}

/// Parses words separated by spaces.
static hn_status parse(hn_args *args, const char *command, const char *line, hn_diag *diag) {
    static char copy[512]; // arguments borrow from it
    char *words[32], *rest = copy;
    int n = 0;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *w = strsep(&rest, " "); w; w = strsep(&rest, " ")) {
        if (*w) {
            words[n++] = w;
        }
    }
    memset(diag, 0, sizeof *diag);
    return hn_args_parse(args, find(command), n, words, diag);
}

static void options_and_words_may_be_mixed(void **state) {
    hn_args args;
    hn_diag diag;
    (void)state;
    assert_int_equal(parse(&args, "run", "--time 2 four-bar --set=l1=1.2 --set l2=3 --json", &diag),
                     HN_OK);
    assert_int_equal(args.words.n, 1);
    assert_string_equal(args.words.word[0], "four-bar");
    assert_true(args.time == 2);
    assert_int_equal(args.set.n, 2);
    assert_string_equal(args.set.word[0], "l1=1.2");
    assert_int_equal(args.json, 1);
    assert_true(isnan(args.every)); // not given
    hn_args_reset(&args);
}

static void a_list_of_methods_ends_at_the_next_option(void **state) {
    hn_args args;
    hn_diag diag;
    (void)state;
    assert_int_equal(parse(&args, "compare", "s --methods a@b c@d --time 1", &diag), HN_OK);
    assert_int_equal(args.methods.n, 2);
    assert_string_equal(args.methods.word[1], "c@d");
    assert_true(args.time == 1);
    hn_args_reset(&args);
}

static void negative_numbers_are_values_and_a_dash_is_a_word(void **state) {
    hn_args args;
    hn_diag diag;
    (void)state;
    assert_int_equal(parse(&args, "terms", "- --t -1.5 --q th1=-2", &diag), HN_OK);
    assert_string_equal(args.words.word[0], "-");
    assert_true(args.t == -1.5);
    hn_args_reset(&args);
}

static void times_are_separated_by_commas(void **state) {
    hn_args args;
    hn_diag diag;
    (void)state;
    assert_int_equal(parse(&args, "run", "s --at 0,1e-1,2", &diag), HN_OK);
    assert_int_equal(args.at.n, 3);
    assert_true(args.at.value[1] == 0.1);
    hn_args_reset(&args);
}

static void faults_are_told_with_a_near_miss(void **state) {
    static const struct {
        const char *command, *line, *word;
    } rows[] = {
        {"run", "s --tiem 1", "--time"},
        {"run", "s --time", "--time needs"},
        {"run", "s --time --json", "needs"},
        {"run", "s --time one", "finite decimal number"},
        {"run", "s --time nan", "finite"},
        {"run", "s --time inf", "finite"},
        {"run", "s --time 1x", "finite"},
        {"run", "s --at 1,,2", "commas"},
        {"run", "s --at 1,2,", "commas"},
        {"run", "s --json=1", "no value"},
        {"run", "", "needs SCENE"},
        {"run", "a b", "too many"},
        {"run", "s --port 80", "no option"},
        {"serve", "--port 1.5", "whole number"},
        {"serve", "--port -1", "whole"},
        {"serve", "--prot 1", "--port"},
        {"list", "scenes --at 1", "no option"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        hn_args args;
        hn_diag diag;
        assert_int_equal(parse(&args, rows[i].command, rows[i].line, &diag), HN_ERR_INPUT);
        if (!strstr(diag.message, rows[i].word) && !strstr(diag.hint, rows[i].word)) {
            fail_msg("%s %s: %s / %s", rows[i].command, rows[i].line, diag.message, diag.hint);
        }
        hn_args_reset(&args);
    }
}

static void choices_of_an_option_are_those_of_its_command(void **state) {
    (void)state;
    static const struct {
        const char *command, *option, *choices, *about;
    } rows[] = {
        {"run", "--format", "csv|ndjson|json", "csv, ndjson or json: form of the output"},
        {"equations", "--format", "text|latex|json", "text, latex or json: form of the output"},
        {"snapshot", "--theme", "light|dark",
         "light or dark background; the workbench asks the terminal when left out"},
        {"study", "--preset", "stiffness|mass-ratio|baumgarte|limits", NULL},
        {"run", "--time", "", "end of the run [s]; the scene's when left out"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const hn_command *command = hn_command_find(rows[i].command);
        hn_option_row o;
        int k = 0;
        while (hn_args_option(command, k, &o) && strcmp(o.name, rows[i].option) != 0) {
            k++;
        }
        assert_string_equal(o.name, rows[i].option);
        assert_string_equal(o.choices, rows[i].choices);
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_args_about(&b, &o);
        if (rows[i].about) {
            assert_string_equal(hn_strbuf_text(&b), rows[i].about);
        }
        hn_strbuf_reset(&b);
    }
}

static void every_option_of_the_table_is_described(void **state) {
    (void)state;
    for (int i = 0; i < hn_command_count(); i++) {
        const hn_command *command = hn_command_at(i);
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_args_describe(&b, command);
        for (const char *p = command->options; *p; p += strspn(p, " ")) {
            char name[64];
            size_t n = strcspn(p, " ");
            snprintf(name, sizeof name, "  %.*s ", (int)strcspn(p, " ="), p);
            if (!strstr(hn_strbuf_text(&b), name)) {
                fail_msg("%s has no such option: '%s'", command->name, name);
            }
            p += n;
        }
        hn_strbuf_reset(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_and_words_may_be_mixed),
        cmocka_unit_test(a_list_of_methods_ends_at_the_next_option),
        cmocka_unit_test(negative_numbers_are_values_and_a_dash_is_a_word),
        cmocka_unit_test(times_are_separated_by_commas),
        cmocka_unit_test(faults_are_told_with_a_near_miss),
        cmocka_unit_test(choices_of_an_option_are_those_of_its_command),
        cmocka_unit_test(every_option_of_the_table_is_described),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
