// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/diagnostics.h"

#include "base/visible.h"
#include "cli/shell/args.h"
#include "cli/shell/notes.h"
#include "cli/shell/print.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// An output that cannot be written is not the fault of the input.
static bool is_output(const hn_diags *diags) {
    return diags->n > 0 && diags->item[0].status == HN_ERR_IO &&
           strcmp(diags->item[0].pointer, "/out") == 0;
}

static hn_exit exit_of(hn_status status, const hn_diags *diags) {
    const int ours = status == HN_ERR_MEMORY || status == HN_ERR_INTERNAL || is_output(diags);
    return ours ? HN_EXIT_PROGRAM : HN_EXIT_INPUT;
}

// ---- places ----

/// Returns whether a list of words as typed has NAME=VALUE.
static bool sets(const hn_words *typed, const char *name) {
    const size_t n = strlen(name);
    for (int i = 0; i < typed->n; i++) {
        if (strncmp(typed->word[i], name, n) == 0 && typed->word[i][n] == '=') {
            return true;
        }
    }
    return false;
}

/// Returns whether the option of this name, without the hyphens, was typed.
static bool was_typed(const hn_args *args, const char *name) {
    hn_option_row o;
    bool is_option = false, typed = false;
    for (int i = 0; hn_args_option(args->command, i, &o); i++) {
        is_option |= strcmp(o.name + strspn(o.name, "-"), name) == 0;
    }
    for (int i = 0; i < args->given.n; i++) {
        typed |= strcmp(args->given.word[i], name) == 0;
    }
    return is_option && typed;
}

/// Returns whether a message is of a file that was named: "wheel.json: ...".
static bool is_of_file(const hn_args *args, const char *message) {
    for (int i = 0; args && i < args->words.n; i++) {
        const size_t n = strlen(args->words.word[i]);
        if (strncmp(message, args->words.word[i], n) == 0 && strncmp(message + n, ": ", 2) == 0) {
            return true;
        }
    }
    return false;
}

/// The name behind one of these beginnings of a pointer; NULL: it has another one, or goes deeper.
static const char *name_behind(const char *pointer, const char *const *beginnings) {
    for (; *beginnings; beginnings++) {
        const size_t n = strlen(*beginnings);
        if (strncmp(pointer, *beginnings, n) == 0 && pointer[n] && !strchr(pointer + n, '/')) {
            return pointer + n;
        }
    }
    return NULL;
}

/// The place of a fault as it was typed: "in --method"; a JSON pointer for what a file holds.
static void put_place(hn_strbuf *b, const hn_args *args, const char *pointer) {
    static const char *const parameters[] = {"/parameters/", NULL},
                             *const starts[] = {"/start/positions/", "/start/rates/",
                                                "/start/moved/", NULL},
                             *const states[] = {"/state/", NULL};
    const char *parameter = name_behind(pointer, parameters), *start = name_behind(pointer, starts),
               *state = name_behind(pointer, states);
    const char *before = "at ", *place = pointer;
    const bool typed_methods = args && args->methods.n > 0 && strncmp(pointer, "/methods/", 9) == 0;
    if (args && args->command && was_typed(args, pointer + 1)) {
        before = "in --";
        place = pointer + 1;
    } else if (strcmp(pointer, "/scene") == 0) {
        before = "in ";
        place = "SCENE";
    } else if (typed_methods || (args && args->set.n > 0 && strcmp(pointer, "/parameters") == 0)) {
        before = "in ";
        place = typed_methods ? "--methods" : "--set";
    } else if (args && parameter && sets(&args->set, parameter)) {
        before = "in --set ";
        place = parameter;
    } else if (args && state && sets(&args->state_q, state)) {
        before = "in --q ";
        place = state;
    } else if (args && state && sets(&args->state_v, state)) {
        before = "in --v ";
        place = state;
    } else if (start) {
        before = "start value of ";
        place = start;
    }
    hn_strbuf_add(b, before);
    hn_visible_add(b, place, true);
}

// ---- sentences ----

static void tell(const hn_args *args, const hn_diag *d) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_strbuf_add(&b, "holonom: ");
    hn_visible_add(&b, d->message, true);
    if (d->pointer[0]) {
        hn_strbuf_add(&b, " (");
        put_place(&b, is_of_file(args, d->message) ? NULL : args, d->pointer);
        if (d->column > 0) {
            hn_strbuf_printf(&b, ", column %d", d->column);
        }
        hn_strbuf_add(&b, ")");
    }
    hn_strbuf_add(&b, "\n");
    if (d->hint[0]) {
        hn_strbuf_add(&b, "         ");
        hn_visible_add(&b, d->hint, true);
        hn_strbuf_add(&b, "\n");
    }
    hn_cli_note_lines(&b);
    hn_strbuf_reset(&b);
}

hn_exit hn_report_diags(const hn_args *args, hn_status status, const hn_diags *diags) {
    if (args && args->json) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_json_object(&b);
        hn_json_put_string(&b, "status", hn_status_name(status));
        hn_json_key(&b, "errors");
        hn_json_diags(&b, diags);
        hn_json_end_object(&b);
        hn_cli_print(&b);
        return exit_of(status, diags);
    }

    // sentences for people, the first fault first
    for (int i = 0; i < diags->n; i++) {
        tell(args, &diags->item[i]);
    }
    if (diags->n == 0) {
        hn_cli_note("holonom: %s\n", hn_status_text(status));
    }
    if (diags->found > diags->n) {
        hn_cli_note("holonom: and %d more\n", diags->found - diags->n);
    }
    return exit_of(status, diags);
}

hn_exit hn_report_diag(const hn_args *args, const hn_diag *diag) {
    hn_diags diags = {.n = 1, .found = 1, .item = {*diag}};
    return hn_report_diags(args, diag->status, &diags);
}
