// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/cli.h"

#include "base/suggest.h"
#include "build.h"
#include "cli/command_table.h"
#include "cli/completion.h"
#include "cli/examples.h"
#include "cli/manual.h"
#include "cli/shell/cache_folder.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/fold.h"
#include "cli/shell/glossary.h"
#include "cli/shell/option_help.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "expr/native.h"
#include "formulations/list/formulation_list.h"
#include "integrators/list/stepper_list.h"
#include "program/program_method.h"
#include "terminal/cells.h"
#include "terminal/keys.h"
#include "terminal/width.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { HELP_INDENT = 10 };

/// Words in lines of the help's width; the cursor is at column `indent`, and so is the beginning of
/// every further line.
static void add_folded(hn_strbuf *b, int indent, const char *words) {
    for (bool first = true; *words; first = false) {
        const size_t n = hn_fold_line(words, hn_help_width() - indent);
        hn_strbuf_printf(b, "%*s%.*s\n", first ? 0 : indent, "", (int)n, words);
        words += n;
        words += strspn(words, " \n");
    }
}

static void describe_all(hn_strbuf *b) {
    static const char *const notes[] = {
        "SCENE is a shipped scene's name, a file, or - for standard input.",
        "METHOD is spelled FORMULATION[:key=value,...]@INTEGRATOR[:key=value,...], as "
        "projection@rk4:h=1e-3.",
        "--out never destroys a file: an old FILE with other contents is kept as FILE.1, FILE.2, "
        "... The commands program, rubric write and export --blanks write over a file only with "
        "--force.",
        "Exit status: 0 done, 2 the input is at fault, 3 the program is at fault, 4 a run ended "
        "early with its reason, a prediction of 'extreme' failed, or 'regrade' found another "
        "score, 130 Ctrl-C ended the "
        "workbench in the terminal. A run that reaches its end has status 0 even if its motion is "
        "WRONG: read the verdict, or use --json.",
        "'holonom lessons' is short for 'holonom list lessons'; the same holds for problems, "
        "scenes and methods."};
    hn_strbuf_add(b, "holonom simulates mechanisms with closed loops by several methods at "
                     "once.\nBegin with: holonom compare four-bar\n\n");
    for (int i = 0; i < hn_command_count(); i++) {
        const hn_command *c = hn_command_at(i);
        hn_strbuf_printf(b, "  holonom %s%s%s\n%*s", c->name, c->words[0] ? " " : "", c->words,
                         HELP_INDENT, "");
        add_folded(b, HELP_INDENT, c->about);
    }
    hn_strbuf_add(b, "\n");
    for (size_t i = 0; i < sizeof notes / sizeof *notes; i++) {
        add_folded(b, 0, notes[i]);
    }
}

/// The keys of the workbench, in the order of its menu.
static void describe_keys(hn_strbuf *b) {
    enum { KEY_COLUMNS = 11 };
    const hn_tui_key *keys;
    const int n = hn_tui_keys(&keys);
    hn_strbuf_add(b, "\nkeys\n");
    for (int i = 0; i < n; i++) {
        const int blanks = KEY_COLUMNS - hn_text_columns(keys[i].shown);
        hn_strbuf_printf(b, "  %s%*s%s\n", keys[i].shown, blanks, "", keys[i].means);
    }
}

static void describe_one(hn_strbuf *b, const hn_command *command) {
    const char *const *examples = hn_examples_of(command->name);
    hn_strbuf_printf(b, "holonom %s %s\n%*s", command->name, command->words, 2, "");
    add_folded(b, 2, command->about);
    hn_strbuf_add(b, "\n");
    hn_args_describe(b, command);
    hn_strbuf_add(b, examples ? "\nexamples\n" : "");
    for (int i = 0; examples && i < HN_CLI_EXAMPLES; i++) {
        hn_strbuf_printf(b, "  holonom %s\n", examples[i]);
    }
    if (strcmp(command->name, "tui") == 0) {
        describe_keys(b);
    }
}

/// The terms that answer best to a word; "": all. Returns whether there is one.
static bool describe_words(hn_strbuf *b, const char *word) {
    int n;
    const hn_glossary_term *terms = hn_glossary(&n);
    hn_term_match best = HN_TERM_OTHER;
    for (int i = 0; i < n; i++) {
        const hn_term_match match = hn_term_matches(&terms[i], word);
        best = match > best ? match : best;
    }
    for (int i = 0; i < n; i++) {
        const bool meant = best > HN_TERM_OTHER && hn_term_matches(&terms[i], word) == best;
        if (!word[0] || meant) {
            hn_strbuf_printf(b, "%s\n%*s", terms[i].word, HELP_INDENT, "");
            add_folded(b, HELP_INDENT, terms[i].means);
        }
    }
    return !word[0] || best > HN_TERM_OTHER;
}

/// Writes what `holonom` alone says: the first things to do, each beginning with `program`, the
/// name by which it was called.
static void add_first_steps(hn_strbuf *b, const char *program) {
    static const char *const steps[][2] = {{"serve", "the workbench as a page in a browser"},
                                           {"tui four-bar", "the same workbench in this terminal"},
                                           {"compare four-bar", "several methods: which are right"},
                                           {"run four-bar --plot", "one method, drawn over time"},
                                           {"list scenes", "all shipped mechanisms"}};
    enum { N_STEPS = sizeof steps / sizeof *steps, MOST_PROGRAM = 20, STEP_COLUMNS = 23 };
    const bool installed = !strchr(program, '/');
    const char *name = strlen(program) <= MOST_PROGRAM ? program : "holonom";
    hn_strbuf_add(b, "holonom simulates mechanisms with closed loops by several methods at "
                     "once.\n\nStart with one of these:\n");
    for (int i = 0; i < N_STEPS; i++) {
        hn_strbuf_printf(b, "  %s %-*s%s\n", name, STEP_COLUMNS, steps[i][0], steps[i][1]);
    }
    hn_strbuf_printf(b, "\n'%s help' lists all commands,\n'%s help COMMAND' explains one,\n", name,
                     name);
    hn_strbuf_printf(b, "'%s help words' the terms of messages and tables.\n", name);
    if (!installed) {
        hn_strbuf_printf(b,
                         "\nHelp and examples say holonom: 'make install' puts it on the path;\n"
                         "until then write %s.\n",
                         program);
    }
}

static hn_diag unknown_command(const char *name) {
    enum { MOST = 64 };
    const char *names[MOST];
    const int n = hn_command_count();
    HN_ASSERT(n <= MOST);
    for (int i = 0; i < n; i++) {
        names[i] = hn_command_at(i)->name;
    }
    char hint[HN_DIAG_HINT];
    hn_suggest(hint, name, names, n,
               "'holonom help' lists the commands, 'holonom help words' the terms");
    hn_diag diag;
    hn_diag_set(&diag, HN_ERR_INPUT, NULL, hint, "there is no command '%.60s'", name);
    return diag;
}

/// The words of the command line from `first` on as one, with blanks between.
static void join_words(hn_strbuf *b, const hn_words *words, int first) {
    for (int i = first; i < words->n; i++) {
        hn_strbuf_printf(b, "%s%s", i > first ? " " : "", words->word[i]);
    }
}

/// The name of a formulation or of an integrator.
static bool is_method_half(const char *name) {
    return hn_formulation_find(name) || hn_stepper_find(name);
}

/// A term where there is no command of this name, or behind 'words'; all terms for 'words' alone.
/// The name of half a method shows its card.
static hn_exit print_terms(const hn_library *lib, const hn_args *args) {
    hn_strbuf b, word;
    hn_strbuf_init(&b);
    hn_strbuf_init(&word);
    const bool of_words = strcmp(args->words.word[0], "words") == 0;
    join_words(&word, &args->words, of_words);
    const bool found = describe_words(&b, hn_strbuf_text(&word));
    hn_exit result = HN_EXIT_DONE;
    if (found) {
        result = hn_cli_print_prose(&b);
    } else if (of_words) {
        hn_diag diag;
        hn_diag_set(&diag, HN_ERR_INPUT, NULL, "'holonom help words' lists the terms",
                    "'%.60s' is not among the terms", hn_strbuf_text(&word));
        result = hn_report_diag(args, &diag);
    } else if (is_method_half(hn_strbuf_text(&word))) {
        hn_args card = *args;
        card.words = (hn_words){2, {"methods", args->words.word[0]}};
        result = hn_command_find("list")->run(lib, &card);
    } else {
        hn_diag diag = unknown_command(hn_strbuf_text(&word));
        snprintf(diag.message, sizeof diag.message, "'%.60s' is neither a command nor a term",
                 hn_strbuf_text(&word));
        result = hn_report_diag(args, &diag);
    }
    hn_strbuf_reset(&word);
    return result;
}

/// "scenes", "methods", "lessons" and "problems" are short for "list scenes" ...
static bool is_list(const char *word) {
    static const char *const kinds[] = {"scenes", "methods", "lessons", "problems"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (strcmp(word, kinds[i]) == 0) {
            return true;
        }
    }
    return false;
}

static hn_exit print_help(const hn_library *lib, const hn_args *args) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (args->words.n == 0) {
        describe_all(&b);
        return hn_cli_print_prose(&b);
    }
    const char *word = args->words.word[0];
    const hn_command *command =
        args->words.n > 1 ? NULL : hn_command_find(is_list(word) ? "list" : word);
    if (!command) {
        return print_terms(lib, args);
    }
    describe_one(&b, command);
    return hn_cli_print_prose(&b);
}

static hn_exit print_version(const hn_library *lib, const hn_args *args) {
    (void)lib;
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (args->json) {
        hn_json_object(&b);
        hn_json_put_string(&b, "name", "holonom");
        hn_json_put_string(&b, "version", HN_VERSION);
        hn_json_put_string(&b, "build", hn_build_name());
        hn_json_end_object(&b);
    } else {
        hn_strbuf_printf(&b, "holonom %s\n", hn_build_name());
    }
    return hn_cli_print(&b);
}

/// The function behind a command.
typedef struct behind {
    const char *name;
    hn_exit (*run)(const hn_library *lib, const hn_args *args);
    bool needs_library; ///< of scenes
} behind;

static behind function_of(const hn_command *command) {
    static const behind own[] = {
        {"manual", hn_command_manual, true},
        {"completion", hn_command_completion, true},
        {"help", print_help, false},
        {"version", print_version, false},
    };
    for (size_t i = 0; !command->run && i < sizeof own / sizeof *own; i++) {
        if (strcmp(own[i].name, command->name) == 0) {
            return own[i];
        }
    }
    HN_ASSERT(command->run);
    return (behind){command->name, command->run, true};
}

/// Native tapes for everything that follows, unless --no-native or HOLONOM_NATIVE=0 says otherwise.
static void start_native(const hn_args *args) {
    const char *wanted = getenv("HOLONOM_NATIVE");
    char cache[400], folder[HN_NATIVE_PATH];
    if (args->no_native || (wanted && strcmp(wanted, "0") == 0)) {
        return;
    }
    if (!hn_cache_folder_find(cache)) {
        hn_native_stay_off("there is no folder for machine code; HOLONOM_CACHE can name one");
        return;
    }
    snprintf(folder, sizeof folder, "%s/native", cache);
    const hn_native_opts opts = hn_native_opts_default(folder);
    hn_native_start(&opts);
}

/// Students' programs, where the command line says so: a scene or a link cannot.
static void allow_programs(const hn_args *args) {
    if (args->allow_programs || args->trust_programs || args->programs) {
        hn_programs_allow(&(hn_program_opts){.trusted = args->trust_programs,
                                             .answer = args->answer_time,
                                             .folder = args->programs});
    }
}

static hn_exit run_command(const hn_command *command, const hn_args *args) {
    const behind function = function_of(command);
    hn_library *lib = NULL;
    hn_diag diag = {0};
    if (args->help) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        describe_one(&b, command);
        return hn_cli_print_prose(&b);
    }
    if (function.needs_library && hn_library_open(NULL, &lib, &diag) != HN_OK) {
        hn_report_diag(args, &diag);
        return HN_EXIT_PROGRAM;
    }

    if (args->wide) {
        hn_terminal_be_wide();
    }

    // no command writes over what it reads, or computes what cannot be written
    hn_diags diags = {0};
    hn_status status = hn_cli_protect_inputs(args, &diags);
    if (args->out && strcmp(args->out, "-") != 0 && strcmp(command->name, "grade") != 0) {
        HN_THEN(status, hn_cli_check_file(args->out, &diags)); // grade makes its folders
    }
    start_native(args);
    allow_programs(args);
    const hn_exit result =
        status == HN_OK ? function.run(lib, args) : hn_report_diags(args, status, &diags);
    hn_programs_report();
    hn_native_stop();
    hn_library_free(lib);
    return result;
}

/// "--help" and "--version" are the commands of these names.
static const char *command_word(const char *word) {
    return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 ? "help"
           : strcmp(word, "--version") == 0                       ? "version"
                                                                  : word;
}

/// `holonom complete -- WORD...`: what shells ask; the last word may be unfinished. Exits with 1
/// where no file may stand. No command of its own in the help.
static int complete(int n, char **words) {
    hn_library *lib = NULL;
    hn_diag diag = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (hn_library_open(NULL, &lib, &diag) != HN_OK) {
        return HN_EXIT_PROGRAM;
    }
    const int skip = n > 0 && strcmp(words[0], "--") == 0;
    const bool files =
        hn_completion_candidates(&b, lib, (const char *const *)words + skip, n - skip);
    hn_library_free(lib);
    fputs(hn_strbuf_text(&b), stdout);
    hn_strbuf_reset(&b);
    return files ? HN_EXIT_DONE : 1;
}

int hn_cli_main(int argc, char **argv) {
    hn_args args = {0};
    hn_diag diag = {0};
    if (argc < 2) {
        hn_strbuf steps, folded;
        hn_strbuf_init(&steps);
        hn_strbuf_init(&folded);
        add_first_steps(&steps, argc > 0 ? argv[0] : "holonom");
        hn_fold_prose(&folded, hn_strbuf_text(&steps), hn_terminal_error_limit());
        fputs(hn_strbuf_text(&folded), stderr);
        hn_strbuf_reset(&folded);
        hn_strbuf_reset(&steps);
        return HN_EXIT_INPUT;
    }
    if (strcmp(argv[1], "complete") == 0) {
        return complete(argc - 2, argv + 2);
    }

    // a command, by its name or by one of the names of lists
    const bool list = is_list(argv[1]);
    const char *name = list ? "list" : command_word(argv[1]);
    const hn_command *command = hn_command_find(name);
    if (!command) {
        diag = unknown_command(name);
        return hn_report_diag(NULL, &diag);
    }
    hn_status status = hn_args_parse(&args, command, argc - 2 + list, argv + 2 - list, &diag);
    hn_exit result = status == HN_OK ? run_command(command, &args) : hn_report_diag(&args, &diag);
    hn_args_reset(&args);
    return result;
}
