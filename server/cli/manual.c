// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/manual.h"

#include "build.h"
#include "cli/command_table.h"
#include "cli/examples.h"
#include "cli/shell/option_help.h"
#include "cli/shell/print.h"
#include "terminal/keys.h"

#include <string.h>

/// Text of a table in roff: backslashes, hyphens and a leading dot or quote are no commands.
static void put_text(hn_strbuf *b, const char *text) {
    if (*text == '.' || *text == '\'') {
        hn_strbuf_add(b, "\\&");
    }
    for (; *text; text++) {
        if (*text == '\\') {
            hn_strbuf_add(b, "\\e");
        } else if (*text == '-') {
            hn_strbuf_add(b, "\\-");
        } else {
            hn_strbuf_add_n(b, text, 1);
        }
    }
}

/// The name of a key; arrows in words, because ASCII has no signs for all of them.
static void put_key(hn_strbuf *b, const char *key) {
    static const char *const arrows[][2] = {
        {"←", "Left"}, {"→", "Right"}, {"↑", "Up"}, {"↓", "Down"}};
    for (; *key; key++) {
        bool found = false;
        for (size_t i = 0; i < sizeof arrows / sizeof *arrows && !found; i++) {
            const size_t n = strlen(arrows[i][0]);
            found = strncmp(key, arrows[i][0], n) == 0;
            if (found) {
                hn_strbuf_add(b, arrows[i][1]);
                key += n - 1;
            }
        }
        if (!found) {
            put_text(b, (char[]){*key, '\0'});
        }
    }
}

static void put_keys(hn_strbuf *b) {
    const hn_tui_key *keys;
    const int n = hn_tui_keys(&keys);
    hn_strbuf_add(b, ".SH KEYS OF THE WORKBENCH\nThe keys of holonom tui; the page has the same "
                     "ones where it has the same actions. 1 to 8 select a method, and the mouse "
                     "drags a joint, selects a time or a method.\n");
    for (int i = 0; i < n; i++) {
        hn_strbuf_add(b, ".TP\n.B ");
        put_key(b, keys[i].shown);
        hn_strbuf_add(b, "\n");
        put_text(b, keys[i].means);
        hn_strbuf_add(b, "\n");
    }
}

static void put_command(hn_strbuf *b, const hn_command *command) {
    hn_strbuf_add(b, ".SS \"holonom ");
    put_text(b, command->name);
    hn_strbuf_add(b, command->words[0] ? " " : "");
    put_text(b, command->words);
    hn_strbuf_add(b, "\"\n");
    put_text(b, command->about);
    hn_strbuf_add(b, "\n");
    hn_option_row o;
    for (int i = 0; hn_args_option(command, i, &o); i++) {
        hn_strbuf_add(b, ".TP\n.B ");
        put_text(b, o.name);
        if (o.argument) {
            hn_strbuf_add(b, " \\fI");
            put_text(b, o.argument);
            hn_strbuf_add(b, "\\fR");
        }
        hn_strbuf_add(b, "\n");
        hn_strbuf about;
        hn_strbuf_init(&about);
        hn_args_about(&about, &o);
        put_text(b, hn_strbuf_text(&about));
        b->failed |= about.failed;
        hn_strbuf_reset(&about);
        hn_strbuf_add(b, "\n");
    }

    // its examples, line by line
    const char *const *examples = hn_examples_of(command->name);
    hn_strbuf_add(b, ".PP\nExamples:\n.nf\n.in 2n\n"); // the longest have room in 80 columns
    for (int i = 0; examples && i < HN_CLI_EXAMPLES; i++) {
        hn_strbuf_add(b, "holonom ");
        put_text(b, examples[i]);
        hn_strbuf_add(b, "\n");
    }
    hn_strbuf_add(b, ".in\n.fi\n");
}

static void put_sections(hn_strbuf *b) {
    hn_strbuf_add(
        b, ".SH WORDS\n.TP\n.B SCENE\nthe name of a shipped scene, a file, or \\- for standard "
           "input\n.TP\n.B METHOD\nFORMULATION[:key=value,...]@INTEGRATOR[:key=value,...], as "
           "projection@rk4:h=1e\\-3\n.SH FILES\n\\-\\-out never destroys a file: an old FILE with "
           "other contents is kept as FILE.1, FILE.2, and so on, and a line on standard error says "
           "so. A picture or plot that holonom drew is replaced, because it can be drawn again. "
           "The commands program, rubric write and export \\-\\-blanks replace an existing file "
           "only with \\-\\-force. FILE.part is a file of holonom, from which an interrupted "
           "grading of a class continues.\n.SH EXIT STATUS\n.TP\n.B 0\ndone, whatever the verdict: "
           "a run that reaches its end has status 0 even if its motion is WRONG, and so has a "
           "submission whose answers are wrong\n.TP\n.B 2\nthe input is at fault\n.TP\n.B 3\nthe "
           "program is at fault\n.TP\n.B 4\na run ended early with its reason, or a prediction of "
           "extreme failed\n.TP\n.B 130\nCtrl\\-C ended the workbench in the terminal (tui)\n.SH "
           "EXAMPLES\n.nf\n.in 2n\nholonom serve\nholonom tui four\\-bar\nholonom compare "
           "four\\-bar \\-\\-methods index1@rk4:h=1e\\-2 projection@rk4:h=1e\\-2\nholonom run "
           "four\\-bar \\-\\-method reduced@dop853:rtol=1e\\-10 \\-\\-time 2 \\-\\-json\nholonom "
           "grade p3 answer.json\n.in\n.fi\n.SH ENVIRONMENT\n.TP\n.B HOLONOM_HOME\nfolder with "
           "lessons/ and web/\n.TP\n.B HOLONOM_CACHE\nfolder for computed references and "
           "unfinished studies\n.TP\n.B XDG_STATE_HOME\nfolder in which the workbench in the "
           "terminal keeps the best scores of exercises, as holonom/lessons.json; ~/.local/state "
           "when not set\n.TP\n.B NO_COLOR\nif it is set, nothing is printed in colour\n");
}

hn_exit hn_command_manual(const hn_library *lib, const hn_args *args) {
    (void)lib;
    (void)args;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_strbuf_add(&b, ".TH HOLONOM 1 \"\" \"holonom " HN_VERSION
                      "\"\n.SH NAME\nholonom \\- simulates mechanisms with closed loops by several "
                      "methods at once\n.SH SYNOPSIS\n.B holonom\n\\fICOMMAND\\fR "
                      "[\\fIWORD\\fR...] [\\fIOPTION\\fR...]\n.SH DESCRIPTION\n"
                      "holonom runs one mechanism by several methods at once, and says which of "
                      "them can be believed, what they cost, and why the others fail. Its page "
                      "(holonom serve), its workbench in the terminal (holonom tui) and its "
                      "commands show the same scenes, methods and verdicts.\n.SH COMMANDS\n");
    for (int i = 0; i < hn_command_count(); i++) {
        put_command(&b, hn_command_at(i));
    }
    put_keys(&b);
    put_sections(&b);
    return hn_cli_print(&b);
}
