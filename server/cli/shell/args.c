// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/args.h"

#include "base/suggest.h"
#include "cli/shell/cli_option.h"
#include "session/kinds/job.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

int hn_number_parse(const char *text, double *out) {
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !isfinite(value) || strpbrk(text, "xX")) {
        return 0;
    }
    *out = value;
    return 1;
}

static hn_status bad_number(const hn_cli_option *o, const char *text, hn_diag *diag) {
    return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s takes %s, not '%.60s'", o->name,
                       o->kind == HN_CLI_COUNT     ? "a whole number from 0"
                       : o->kind == HN_CLI_NUMBERS ? "finite decimal numbers separated by commas"
                                                   : "a finite decimal number",
                       text);
}

// ---- options that are fields of a job (session/kinds/job.h) ----

enum { OPTION_NAME = 32, MOST_FIELDS = 24 };

/// "--time-limit" of the field "time_limit".
static void name_option(const hn_field *f, char out[OPTION_NAME]) {
    snprintf(out, OPTION_NAME, "--%s", f->name);
    for (char *p = out; *p; p++) {
        *p = *p == '_' ? '-' : *p;
    }
}

/// Fields that are options of this command, each name once. Returns how many.
static int list_fields(const hn_command *command, const hn_field *list[MOST_FIELDS]) {
    const hn_job_kind *kind;
    int n = 0;
    for (int i = 0; (kind = hn_job_kind_at(i)) != NULL; i++) {
        if (strcmp(kind->command, command->name) != 0) {
            continue;
        }
        for (const hn_field *f = kind->fields; f->name; f++) {
            int known = !f->argument;
            for (int k = 0; k < n && !known; k++) {
                known = strcmp(list[k]->name, f->name) == 0;
            }
            if (!known && n < MOST_FIELDS) {
                list[n++] = f;
            }
        }
    }
    return n;
}

static const hn_field *find_field(const hn_command *command, const char *name, size_t n) {
    const hn_field *list[MOST_FIELDS];
    const int n_fields = list_fields(command, list);
    for (int i = 0; i < n_fields; i++) {
        char known[OPTION_NAME];
        name_option(list[i], known);
        if (strlen(known) == n && memcmp(known, name, n) == 0) {
            return list[i];
        }
    }
    return NULL;
}

/// The option of a field as a row of the table (cli_option.h); its value is kept in args->fields.
static hn_cli_option option_of(const hn_field *f, char name[OPTION_NAME]) {
    name_option(f, name);
    return (hn_cli_option){.name = name,
                           .argument = f->argument,
                           .kind = f->type == HN_FIELD_BOOL      ? HN_CLI_FLAG
                                   : f->type == HN_FIELD_INTEGER ? HN_CLI_COUNT
                                   : f->type == HN_FIELD_NUMBER  ? HN_CLI_NUMBER
                                                                 : HN_CLI_TEXT,
                           .about = f->about};
}

static hn_status keep_field(hn_args *args, const hn_field *f, const hn_cli_option *o,
                            const char *text, hn_diag *diag) {
    double number = 0;
    if (!args->fields) {
        args->fields = cJSON_CreateObject();
    }
    if (o->kind != HN_CLI_FLAG && o->kind != HN_CLI_TEXT && !hn_number_parse(text, &number)) {
        return bad_number(o, text, diag);
    }
    cJSON *value = o->kind == HN_CLI_FLAG   ? cJSON_CreateTrue()
                   : o->kind == HN_CLI_TEXT ? cJSON_CreateString(text)
                                            : cJSON_CreateNumber(number);
    cJSON_DeleteItemFromObjectCaseSensitive(args->fields, f->name);
    return cJSON_AddItemToObject(args->fields, f->name, value) ? HN_OK : HN_ERR_MEMORY;
}

static hn_status report_unknown(const hn_command *command, const char *name, hn_diag *diag) {
    const char *names[HN_CLI_MAX_OPTIONS + MOST_FIELDS];
    const hn_field *fields[MOST_FIELDS];
    char hint[HN_DIAG_HINT], field_names[MOST_FIELDS][OPTION_NAME];
    int n = 0;
    bool is_slip = true; // an option of another command is none
    const hn_cli_option *o;
    for (int i = 0; (o = hn_cli_option_at(i)) != NULL; i++) {
        is_slip = is_slip && strcmp(o->name, name) != 0;
        if (hn_cli_option_is_offered(command, o)) {
            names[n++] = o->name;
        }
    }
    const int n_fields = list_fields(command, fields);
    for (int i = 0; i < n_fields; i++) {
        name_option(fields[i], field_names[i]);
        names[n++] = field_names[i];
    }
    char help[80];
    snprintf(help, sizeof help, "'holonom help %.40s' lists its options", command->name);
    hn_suggest(hint, name, names, is_slip ? n : 0, help);
    return hn_diag_set(diag, HN_ERR_INPUT, NULL, hint, "'%s' has no option '%.60s'", command->name,
                       name);
}

static hn_status add_word(hn_words *words, const char *word, hn_diag *diag) {
    if (words->n == HN_CLI_MAX_WORDS) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "more than %d words were given",
                           HN_CLI_MAX_WORDS);
    }
    words->word[words->n++] = word;
    return HN_OK;
}

static hn_status read_numbers(hn_numbers *numbers, const hn_cli_option *o, const char *text,
                              hn_diag *diag) {
    free(numbers->value);
    numbers->value = calloc(strlen(text) / 2 + 1, sizeof(double));
    numbers->n = 0;
    if (!numbers->value) {
        return HN_ERR_MEMORY;
    }
    for (const char *p = text;; p++) {
        char *end;
        double value = strtod(p, &end);
        if (end == p || (*end && *end != ',') || !isfinite(value) || strpbrk(text, "xX")) {
            return bad_number(o, text, diag);
        }
        numbers->value[numbers->n++] = value;
        p = end;
        if (!*p) {
            return HN_OK;
        }
    }
}

/// Returns whether an option that takes one value has it already.
static bool is_given(const hn_args *args, const hn_cli_option *o, const hn_field *field) {
    const void *place = (const char *)args + o->place;
    if (field) {
        return o->kind != HN_CLI_FLAG &&
               cJSON_GetObjectItemCaseSensitive(args->fields, field->name) != NULL;
    }
    switch (o->kind) {
    case HN_CLI_TEXT:
        return *(const char *const *)place != NULL;
    case HN_CLI_NUMBER:
    case HN_CLI_COUNT:
        return !isnan(*(const double *)place);
    case HN_CLI_NUMBERS:
        return ((const hn_numbers *)place)->value != NULL;
    case HN_CLI_FLAG:
    case HN_CLI_WORD:
    case HN_CLI_WORDS:
        break;
    }
    return false;
}

static hn_status read_value(hn_args *args, const hn_cli_option *o, const char *text,
                            hn_diag *diag) {
    void *place = (char *)args + o->place;
    double value;

    // the place has the type of the kind
    switch (o->kind) {
    case HN_CLI_TEXT:
        *(const char **)place = text;
        return HN_OK;
    case HN_CLI_NUMBERS:
        return read_numbers(place, o, text, diag);
    case HN_CLI_WORD:
    case HN_CLI_WORDS:
        return add_word(place, text, diag);
    case HN_CLI_NUMBER:
    case HN_CLI_COUNT:
        if (!hn_number_parse(text, &value) ||
            (o->kind == HN_CLI_COUNT && (value < 0 || value != floor(value) || value > 1e15))) {
            return bad_number(o, text, diag);
        }
        *(double *)place = value;
        return HN_OK;
    case HN_CLI_FLAG:
        break;
    }
    *(int *)place = 1;
    return HN_OK;
}

/// A word that begins with '-' and is no number ends a list of words; "-" alone is standard input.
static bool looks_like_option(const char *word) {
    double number;
    return word[0] == '-' && word[1] && !hn_number_parse(word, &number);
}

/// Puts one value where the option keeps it.
static hn_status put_value(hn_args *args, const hn_cli_option *o, const hn_field *field,
                           const char *text, hn_diag *diag) {
    return field ? keep_field(args, field, o, text, diag) : read_value(args, o, text, diag);
}

/// Reads the value or values of an option; *i is left at the last word.
static hn_status take_values(hn_args *args, const hn_cli_option *o, const hn_field *field, int argc,
                             char **argv, int *i, hn_diag *diag) {
    if (*i + 1 >= argc || (o->kind != HN_CLI_TEXT && looks_like_option(argv[*i + 1]))) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s needs %s", o->name, o->argument);
    }
    HN_TRY(put_value(args, o, field, argv[++*i], diag));
    while (o->kind == HN_CLI_WORDS && *i + 1 < argc && !looks_like_option(argv[*i + 1])) {
        HN_TRY(put_value(args, o, field, argv[++*i], diag));
    }
    return HN_OK;
}

/// One option with what belongs to it; *i is left at its last word.
static hn_status take_option(hn_args *args, const hn_command *command, int argc, char **argv,
                             int *i, hn_diag *diag) {
    const char *word = argv[*i], *inline_value = strchr(word, '=');
    const size_t n = inline_value && word[1] == '-' ? (size_t)(inline_value - word) : strlen(word);
    char name[OPTION_NAME];
    hn_cli_option of_field;

    // an option of the table, or a field of the command's jobs
    const hn_cli_option *o = hn_cli_option_find(command, word, n);
    const bool is_twin = !o && hn_cli_option_find_twin(command, word, n);
    o = is_twin ? hn_cli_option_find_twin(command, word, n) : o;
    const hn_field *field = o ? NULL : find_field(command, word, n);
    if (field) {
        of_field = option_of(field, name);
        o = &of_field;
    }
    if (!o) {
        return report_unknown(command, word, diag);
    }
    if (is_given(args, o, field)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s is given twice; it takes one value",
                           o->name);
    }

    // of a field the table of the jobs holds the name
    HN_TRY(add_word(&args->given, field ? field->name : o->name + strspn(o->name, "-"), diag));

    // its value: none, behind '=', or the words that follow
    if (o->kind == HN_CLI_FLAG) {
        return word[n] ? hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s takes no value", o->name)
                       : put_value(args, o, field, "", diag);
    }
    HN_TRY(word[n] ? put_value(args, o, field, inline_value + 1, diag)
                   : take_values(args, o, field, argc, argv, i, diag));

    // --methods of a command that takes one of them
    if (is_twin && o->kind == HN_CLI_TEXT && *i + 1 < argc && !looks_like_option(argv[*i + 1])) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, "'holonom compare' takes several",
                           "'%s' takes one method, and '%.60s' follows '%.60s'", command->name,
                           argv[*i + 1], argv[*i]);
    }
    return HN_OK;
}

static void set_defaults(hn_args *args) {
    *args = (hn_args){0};
    const hn_cli_option *o;
    for (int i = 0; (o = hn_cli_option_at(i)) != NULL; i++) {
        if (o->kind == HN_CLI_NUMBER || o->kind == HN_CLI_COUNT) {
            *(double *)((char *)args + o->place) = (double)NAN;
        }
    }
}

hn_status hn_args_parse(hn_args *args, const hn_command *command, int argc, char **argv,
                        hn_diag *diag) {
    set_defaults(args);
    args->command = command;
    int only_words = 0;
    for (int i = 0; i < argc; i++) {
        hn_status status;
        if (!only_words && strcmp(argv[i], "--") == 0) {
            only_words = 1;
            continue;
        }
        if (!only_words && argv[i][0] == '-' && argv[i][1]) {
            status = take_option(args, command, argc, argv, &i, diag);
        } else {
            status = add_word(&args->words, argv[i], diag);
        }
        if (status != HN_OK) {
            return status;
        }
    }

    // help needs no words
    if (args->help) {
        return HN_OK;
    }
    if (args->words.n < command->min_words || args->words.n > command->max_words) {
        char usage[HN_DIAG_HINT];
        snprintf(usage, sizeof usage, "holonom %s %s", command->name, command->words);
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, usage,
                           args->words.n < command->min_words ? "'%s' needs %s"
                                                              : "too many words for '%s' %s",
                           command->name, command->words);
    }
    return HN_OK;
}

void hn_args_reset(hn_args *args) {
    free(args->at.value);
    args->at = (hn_numbers){0};
    cJSON_Delete(args->fields);
    args->fields = NULL;
}

/// The choices of a table's option: those that the command lists behind its name, or those that its
/// argument lists.
static void take_choices(hn_option_row *row, const hn_command *command, const hn_cli_option *o) {
    const char *listed = hn_cli_option_listed(command->options, o->name);
    if (listed && listed[0] == '=') {
        snprintf(row->choices, sizeof row->choices, "%.*s", (int)strcspn(listed + 1, " "),
                 listed + 1);
    } else if (o->argument && strchr(o->argument, '|')) {
        snprintf(row->choices, sizeof row->choices, "%s", o->argument);
    }
}

/// The same of a field of a job.
static void take_field_choices(hn_option_row *row, const hn_field *f) {
    size_t n = 0;
    for (int i = 0; f->choices && f->choices[i] && n < sizeof row->choices; i++) {
        n += (size_t)snprintf(row->choices + n, sizeof row->choices - n, "%s%s", i ? "|" : "",
                              f->choices[i]);
    }
}

bool hn_args_option(const hn_command *command, int i, hn_option_row *out) {
    const hn_field *fields[MOST_FIELDS];
    const hn_cli_option *o;
    for (int k = 0; (o = hn_cli_option_at(k)) != NULL; k++) {
        if (hn_cli_option_is_shown(command, o) && i-- == 0) {
            *out = (hn_option_row){.argument = o->argument, .about = o->about};
            snprintf(out->name, sizeof out->name, "%s", o->name);
            take_choices(out, command, o);
            return true;
        }
    }

    // behind the table the fields of the command's jobs
    const int n = list_fields(command, fields);
    if (i < n) {
        *out = (hn_option_row){.argument = fields[i]->argument, .about = fields[i]->about};
        name_option(fields[i], out->name);
        take_field_choices(out, fields[i]);
        if (fields[i]->type == HN_FIELD_BOOL) {
            out->argument = NULL;
        }
    }
    return i < n;
}
