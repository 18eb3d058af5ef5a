// SPDX-License-Identifier: GPL-3.0-or-later
// holonom list scenes|methods [NAME]|lessons|problems
#include "base/suggest.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/document.h"
#include "cli/shell/print.h"
#include "grade/exercise_shelf.h"
#include "integrators/method/catalogue.h"
#include "integrators/method/method_spec.h"
#include "session/model/lists.h"
#include "session/model/model.h"
#include "session/model/model_json.h"

#include <stdio.h>
#include <string.h>

static void methods_json(hn_strbuf *b, const hn_library *lib) {
    (void)lib;
    hn_methods_json(b);
}

enum { MAX_TABLES = 2, MAX_COLUMNS = 7, MAX_NAMES = 96 };

/// Lines of a card below its title: the word in front, and the member it is read from.
static const struct {
    const char *head, *key;
} CARD[] = {
    {"idea", "rule"},   {"about", "about"},       {"index", "index"},   {"needs", "needs"},
    {"order", "order"}, {"order", "order_note"},  {"the gap", "drift"}, {"limits", "limits"},
    {"when", "when"},   {"when not", "when_not"}, {"source", "source"},
};
enum { N_CARD = sizeof CARD / sizeof *CARD };

/// One thing that can be listed: its document, and the tables a person sees of it.
static const struct {
    const char *name, *one; ///< `one`: what shows a single one; NULL: its card, by this command
    void (*write)(hn_strbuf *b, const hn_library *lib);
    struct {
        const char *member;
        int n;
        hn_list_column columns[MAX_COLUMNS];
        const char *note;     ///< below the table: what its letters mean; NULL: none
        const char *long_key; ///< shown in the last column under --wide; NULL: as otherwise
    } tables[MAX_TABLES];
} LISTS[] = {
    {"scenes",
     "'holonom inspect NAME' describes a scene",
     hn_scenes_json,
     {{"scenes",
       4,
       {{"scene", "id", NULL},
        {"title", "title", NULL},
        {"kind", "kind", NULL},
        {"description", "caption", NULL}},
       NULL,
       NULL}}},
    {"methods",
     NULL,
     methods_json,
     {{"formulations",
       5,
       {{"formulation", "name", NULL},
        {"title", "title", NULL},
        {"index", "index", ""},
        {"the gap", "drift", NULL},
        {"needs", "needs", NULL}},
       "h: step, p: order of the integrator, t: time. needs: terms that the method evaluates (M "
       "mass matrix, f forces, phi constraints, J their Jacobian, gamma in J a + gamma = 0)",
       NULL},
      {"integrators",
       4,
       {{"integrator", "name", NULL},
        {"title", "title", NULL},
        {"order", "order", ""},
        {"adaptive", "adaptive", NULL}},
       NULL,
       NULL}}},
    {"lessons",
     "'holonom lesson NUMBER' prints a lesson",
     hn_lessons_json,
     {{"lessons", 2, {{"lesson", "id", NULL}, {"title", "title", NULL}}, NULL, NULL}}},
    {"problems",
     "'holonom problem ID' prints an exercise",
     hn_shelf_exercises_json,
     {{"problems",
       7,
       {{"problem", "id", NULL},
        {"title", "title", NULL},
        {"lesson", "place", NULL},
        {"points", "points", ""},
        {"minutes", "minutes", ""},
        {"limit [s]", "time_limit", ""},
        {"drawn from the seed", "drawn", NULL}},
       "minutes: for a student who has read the lesson, estimated from the kinds of answers; "
       "limit: for grading one submission of a class. A run that a part asks for ends after "
       "200,000 steps. Ranges of the numbers: 'holonom problems --wide' or --json",
       "drawn_from"}}},
};
enum { N_LISTS = sizeof LISTS / sizeof *LISTS };

/// One option of a method: "h: step [s], 1e-09 to 1e+06, no default".
static void put_option(hn_strbuf *b, const cJSON *option) {
    const cJSON *choices = hn_document_get(option, "choices"), *choice;
    const cJSON *initial = hn_document_get(option, "default");
    const char *unit = hn_document_text(option, "unit");
    hn_strbuf_printf(b, "    %s: %s", hn_document_text(option, "key"),
                     hn_document_text(option, "about"));
    if (unit[0] && strcmp(unit, "-") != 0) {
        hn_strbuf_printf(b, " [%s]", unit);
    }

    // what is allowed
    if (choices) {
        cJSON_ArrayForEach(choice, choices) {
            hn_strbuf_printf(b, "%s%s", choice == choices->child ? ", one of " : " ",
                             choice->valuestring);
        }
    } else {
        hn_strbuf_printf(b, ", %g to %g", hn_document_number(option, "min"),
                         hn_document_number(option, "max"));
    }

    // what it is if nothing is said
    if (cJSON_IsString(initial)) {
        hn_strbuf_printf(b, "; default %s\n", initial->valuestring);
    } else if (cJSON_IsNumber(initial)) {
        hn_strbuf_printf(b, "; default %g\n", initial->valuedouble);
    } else {
        hn_strbuf_add(b, "; no default\n");
    }
}

static void put_options(hn_strbuf *b, const cJSON *item) {
    const cJSON *options = hn_document_get(item, "options"), *option;
    hn_strbuf_add(b, options && options->child ? "  options\n" : "");
    cJSON_ArrayForEach(option, options) {
        put_option(b, option);
    }
}

static void put_card(hn_strbuf *b, const cJSON *item) {
    hn_strbuf_printf(b, "%s: %s\n", hn_document_text(item, "name"),
                     hn_document_text(item, "title"));
    for (int i = 0; i < N_CARD; i++) {
        const cJSON *said = hn_document_get(item, CARD[i].key);
        if (cJSON_IsNumber(said)) {
            hn_strbuf_printf(b, "  %-9s ", CARD[i].head);
            hn_document_put_number(b, said);
            hn_strbuf_add(b, "\n");
        } else if (*hn_document_text(item, CARD[i].key)) {
            hn_strbuf_printf(b, "  %-9s %s\n", CARD[i].head, hn_document_text(item, CARD[i].key));
        }
    }
    put_options(b, item);
}

/// A card for each thing that has one, below the tables.
static void put_cards(hn_strbuf *b, const cJSON *array) {
    const cJSON *item;
    cJSON_ArrayForEach(item, array) {
        if (hn_document_get(item, "source")) {
            hn_strbuf_add(b, "\n");
            put_card(b, item);
        }
    }
}

static hn_exit tell_unknown(const hn_args *args, const char *name) {
    const char *names[N_LISTS];
    for (int i = 0; i < N_LISTS; i++) {
        names[i] = LISTS[i].name;
    }
    char hint[HN_DIAG_HINT];
    hn_suggest(hint, name, names, N_LISTS, "scenes, methods, lessons, problems");
    hn_diag diag;
    hn_diag_set(&diag, HN_ERR_INPUT, NULL, hint, "there is no list of '%.60s'", name);
    return hn_report_diag(args, &diag);
}

/// A thing that could not be read stands in the list with its faults; they are told below it.
static void put_faults(hn_strbuf *b, const cJSON *array) {
    const cJSON *item, *fault;
    cJSON_ArrayForEach(item, array) {
        cJSON_ArrayForEach(fault, hn_document_get(item, "errors")) {
            hn_strbuf_printf(b, "  %s: %s (at %s)\n", hn_document_text(item, "id"),
                             hn_document_text(fault, "detail"), hn_document_text(fault, "pointer"));
        }
    }
}

/// The row called `name` in the tables of a list; NULL: none. The names met are kept in `names`.
static const cJSON *find_named(const cJSON *document, int which, const char *name,
                               const char *names[], int *n) {
    const cJSON *item;
    for (int i = 0; i < MAX_TABLES && LISTS[which].tables[i].member; i++) {
        const char *key = LISTS[which].tables[i].columns[0].key;
        cJSON_ArrayForEach(item, hn_document_get(document, LISTS[which].tables[i].member)) {
            const char *own = hn_document_text(item, key);
            if (strcmp(own, name) == 0) {
                return item;
            }
            if (*n < MAX_NAMES) {
                names[(*n)++] = own;
            }
        }
    }
    return NULL;
}

/// `list methods NAME`: one card, with its options.
static hn_exit print_one(const hn_args *args, int which, hn_strbuf *text) {
    const char *name = args->words.word[1], *names[MAX_NAMES];
    cJSON *document = hn_document_parse(text);
    int n = 0;
    const cJSON *item = find_named(document, which, name, names, &n);
    hn_exit done = HN_EXIT_INPUT;
    if (item && args->json) {
        char *raw = cJSON_PrintUnformatted(item);
        hn_strbuf_printf(text, "%s\n", raw ? raw : "");
        text->failed |= raw == NULL;
        cJSON_free(raw);
        done = hn_cli_print(text);
    } else if (item) {
        put_card(text, item);
        done = hn_cli_print_text(text);
    } else {
        char hint[HN_DIAG_HINT];
        hn_diag diag;
        hn_suggest(hint, name, names, n, "'holonom list methods' lists them");
        hn_diag_set(&diag, HN_ERR_INPUT, NULL, hint,
                    "no formulation and no integrator is called '%.60s'", name);
        done = hn_report_diag(args, &diag);
        hn_strbuf_reset(text);
    }
    cJSON_Delete(document);
    return done;
}

/// Only methods have cards; the other lists name the command that shows one of theirs.
static hn_exit tell_no_cards(const hn_args *args, int which) {
    hn_diag diag;
    hn_diag_set(&diag, HN_ERR_INPUT, NULL, LISTS[which].one, "'list %s' takes no name",
                LISTS[which].name);
    return hn_report_diag(args, &diag);
}

static void put_rows(hn_strbuf *b, int which, int table, const cJSON *array, bool wide) {
    hn_list_column columns[MAX_COLUMNS];
    const int n = LISTS[which].tables[table].n;
    memcpy(columns, LISTS[which].tables[table].columns, sizeof columns);
    if (wide && LISTS[which].tables[table].long_key) {
        columns[n - 1].key = LISTS[which].tables[table].long_key;
    }
    hn_document_list(b, array, columns, n);
}

hn_exit hn_command_list(const hn_library *lib, const hn_args *args) {
    int which = 0;
    while (which < N_LISTS && strcmp(LISTS[which].name, args->words.word[0]) != 0) {
        which++;
    }
    if (which == N_LISTS) {
        return tell_unknown(args, args->words.word[0]);
    }
    const bool one = args->words.n > 1;
    if (one && LISTS[which].one) {
        return tell_no_cards(args, which);
    }
    hn_strbuf text;
    hn_strbuf_init(&text);
    LISTS[which].write(&text, lib);
    if (one) {
        return print_one(args, which, &text);
    }
    if (args->json) {
        return hn_cli_print(&text);
    }

    // tables, then what is said of each row
    cJSON *document = hn_document_parse(&text);
    for (int i = 0; i < MAX_TABLES && LISTS[which].tables[i].member; i++) {
        const cJSON *array = hn_document_get(document, LISTS[which].tables[i].member);
        hn_strbuf_add(&text, i ? "\n" : "");
        put_rows(&text, which, i, array, args->wide);
        if (LISTS[which].tables[i].note) {
            hn_strbuf_printf(&text, "  %s\n", LISTS[which].tables[i].note);
        }
        put_faults(&text, array);
    }
    for (int i = 0; i < MAX_TABLES && LISTS[which].tables[i].member; i++) {
        put_cards(&text, hn_document_get(document, LISTS[which].tables[i].member));
    }
    text.failed |= document == NULL;
    cJSON_Delete(document);
    return hn_cli_print_text(&text);
}
