// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/option_help.h"

#include "cli/shell/fold.h"
#include "terminal/width.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { HELP_HEAD = 26, HELP_WIDTH = 80 }; // [columns] of an option and its argument; of a line

void hn_args_about(hn_strbuf *b, const hn_option_row *o) {
    const bool listed = o->argument && strchr(o->argument, '|');
    for (const char *at = listed ? "" : o->choices; *at;) {
        const size_t n = strcspn(at, "|");
        const char *next = at + n + (at[n] == '|');
        const char *joint = !*next ? ": " : strchr(next, '|') ? ", " : " or ";
        hn_strbuf_printf(b, "%.*s%s", (int)n, at, joint);
        at = next;
    }
    hn_strbuf_add(b, o->about);
}

int hn_help_width(void) {
    const int columns = hn_terminal_columns();
    return columns < HELP_WIDTH ? columns : HELP_WIDTH;
}

/// The right column of the help, from the first line's place on.
static void put_about(hn_strbuf *b, const char *about) {
    for (const char *rest = about; *rest;) {
        const size_t n = hn_fold_line(rest, hn_help_width() - HELP_HEAD - 3);
        hn_strbuf_printf(b, "%*s%.*s\n", rest == about ? 0 : HELP_HEAD + 3, "", (int)n, rest);
        rest += n;
        rest += strspn(rest, " \n");
    }
}

void hn_args_describe(hn_strbuf *b, const hn_command *command) {
    hn_option_row o;
    for (int i = 0; hn_args_option(command, i, &o); i++) {
        char head[64];
        snprintf(head, sizeof head, "%s %s", o.name, o.argument ? o.argument : "");
        // what is said of it stands in a column of its own, below a head that reaches into it
        const bool wide = strlen(head) > HELP_HEAD;
        if (wide) {
            hn_strbuf_printf(b, "  %s\n%*s", head, HELP_HEAD + 3, "");
        } else {
            hn_strbuf_printf(b, "  %-*s ", HELP_HEAD, head);
        }
        hn_strbuf about;
        hn_strbuf_init(&about);
        hn_args_about(&about, &o);
        put_about(b, hn_strbuf_text(&about));
        b->failed |= about.failed;
        hn_strbuf_reset(&about);
    }
}
