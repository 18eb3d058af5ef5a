// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/args.h"

#include "base/suggest.h"
#include "session/kinds/job.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

typedef enum option_kind {
    OPTION_FLAG,
    OPTION_TEXT,
    OPTION_NUMBER,
    OPTION_COUNT,   ///< a whole number from 0
    OPTION_NUMBERS, ///< separated by commas
    OPTION_WORD,    ///< may be repeated
    OPTION_WORDS    ///< all words up to the next option
} option_kind;

typedef struct option {
    const char *name, *argument;
    option_kind kind;
    size_t place; ///< in hn_args
    const char *about;
} option;

#define AT(field) offsetof(hn_args, field)

static const option OPTIONS[] = {
    {"--json", NULL, OPTION_FLAG, AT(json), "one JSON object on standard output"},
    {"--help", NULL, OPTION_FLAG, AT(help), "this help"},
    {"--wide", NULL, OPTION_FLAG, AT(wide),
     "do not fold or shorten tables and lines to the terminal's width"},
    {"--allow-programs", NULL, OPTION_FLAG, AT(allow_programs),
     "methods may be programs of your own, program:FILE[@INTEGRATOR], run in a sandbox"},
    {"--trust-programs", NULL, OPTION_FLAG, AT(trust_programs),
     "like --allow-programs, without a sandbox: only for programs that you trust"},
    {"--answer-time", "S", OPTION_NUMBER, AT(answer_time),
     "longest time for one answer of a program [s]; 5 when left out; the first answer may take six "
     "times as long, and at least 20 s"},
    {"--programs", "DIR", OPTION_TEXT, AT(programs),
     "methods may be programs of this folder, program:NAME, run in a sandbox"},
    {"--no-native", NULL, OPTION_FLAG, AT(no_native),
     "do not compile equations to machine code in the background; HOLONOM_NATIVE=0 does the same"},
    {"--set", "NAME=VALUE", OPTION_WORD, AT(set),
     "change a parameter of the scene, or with start.NAME the start value of a coordinate or rate; "
     "may be repeated"},
    {"--method", "METHOD", OPTION_TEXT, AT(method),
     "FORMULATION[:key=value,...] @INTEGRATOR[:key=value,...], without the blank"},
    {"--methods", "METHOD...", OPTION_WORDS, AT(methods),
     "methods, separated by blanks; the scene's own when left out"},
    {"--time", "T", OPTION_NUMBER, AT(time), "end of the run [s]; the scene's when left out"},
    {"--at", "T1,T2,...", OPTION_NUMBERS, AT(at), "output times, ascending [s]"},
    {"--every", "DT", OPTION_NUMBER, AT(every),
     "output interval [s]; 200 samples when neither --at nor --every is given"},
    {"--reactions", NULL, OPTION_FLAG, AT(reactions),
     "add the reactions of every joint and constraint: forces [N] and moments [N m] in world axes, "
     "and efforts along coordinates. The reaction of a joint acts from the parent on the child and "
     "includes the drives and loads along its coordinates; that of a distance acts on the body of "
     "'to', that of a line, plane or wheel on the guided body"},
    {"--raw-lambda", NULL, OPTION_FLAG, AT(raw_lambda),
     "add a column raw_lambda: the multipliers that the method itself computes, if it does"},
    {"--format", "FORMAT", OPTION_TEXT, AT(format), "form of the output"},
    {"--t", "T", OPTION_NUMBER, AT(t),
     "tui: time of the frame [s]. terms: the time t in formulas [s]; the mechanism stays at its "
     "start. snapshot: the same as --time"},
    {"--q", "NAME=VALUE...", OPTION_WORDS, AT(state_q),
     "coordinates that differ from the assembled start"},
    {"--v", "NAME=VALUE...", OPTION_WORDS, AT(state_v),
     "rates that differ from the assembled start"},
    {"--language", "NAME", OPTION_TEXT, AT(language), "language of the program"},
    {"--out", "FILE", OPTION_TEXT, AT(out),
     "file to write; an old FILE with other contents is kept as FILE.1"},
    {"-o", "FILE", OPTION_TEXT, AT(out), "the same as --out"},
    {"--force", NULL, OPTION_FLAG, AT(force), "replace an existing file"},
    {"--loops", "FILE", OPTION_TEXT, AT(loops),
     "second file, in JSON, for the parts that a URDF cannot hold: joints that close loops, "
     "gravity, the start"},
    {"--key", "NAME", OPTION_TEXT, AT(key),
     "MJCF: the keyframe to start from; the first when left out, qpos0 for none"},
    {"--frame", "DT", OPTION_NUMBER, AT(frame_dt),
     "time between two comparisons of the states [s]; chosen when left out"},
    {"--grid", "NxM", OPTION_TEXT, AT(grid),
     "columns and rows of a map, as 24x16; when left out, 24x24, or 16x16 without --preset"},
    {"--plots", "DIR", OPTION_TEXT, AT(plots),
     "a folder for every plot of the report, as SVG and PNG"},
    {"--csv", NULL, OPTION_FLAG, AT(csv), "write CSV to standard output, one row for each point"},
    {"--width", "PIXELS", OPTION_COUNT, AT(width), "width of the picture"},
    {"--height", "PIXELS", OPTION_COUNT, AT(height), "height of the picture"},
    {"--plot", NULL, OPTION_FLAG, AT(plot), "draw plots in characters instead of printing numbers"},
    {"--size", "COLUMNSxROWS", OPTION_TEXT, AT(size),
     "size of the frame as text; 80x24 when left out"},
    {"--keys", "KEYS", OPTION_TEXT, AT(keys),
     "keys pressed before the frame of --once: characters, and names such as <Enter> or <Down>"},
    {"--once", NULL, OPTION_FLAG, AT(once), "print one frame as text, at the time --t"},
    {"--frames", "N", OPTION_COUNT, AT(frames), "end after N pictures (text in a pipe)"},
    {"--ascii", NULL, OPTION_FLAG, AT(ascii), "ASCII characters only"},
    {"--pictures", "auto|kitty|sixel|off", OPTION_TEXT, AT(pictures),
     "how the mechanism is drawn: as a picture by kitty graphics or sixels, or in characters; auto "
     "asks the terminal"},
    {"--blocks", NULL, OPTION_FLAG, AT(blocks), "draw with quadrant blocks instead of braille"},
    {"--ghosts", NULL, OPTION_FLAG, AT(ghosts),
     "draw all times of --at in one picture, the earlier ones pale"},
    {"--animate", "MS", OPTION_NUMBER, AT(animate),
     "animated PNG of the times of --at; each is shown for MS milliseconds"},
    {"--trace", "POINT", OPTION_WORD, AT(traces),
     "draw the path of a point by its name; may be repeated"},
    {"--dimensions", NULL, OPTION_FLAG, AT(dimensions),
     "draw the lengths of bars and ground, and the angles of joints"},
    {"--forces", NULL, OPTION_FLAG, AT(forces), "draw the forces in the joints [N]"},
    {"--describe", NULL, OPTION_FLAG, AT(describe),
     "print the contents of the picture as JSON: in words, and as a list of everything drawn"},
    {"--theme", "light|dark", OPTION_TEXT, AT(theme),
     "light or dark background; the workbench asks the terminal when left out"},
    {"--renderer", "auto|osmesa|built-in", OPTION_TEXT, AT(renderer),
     "program part that paints a PNG; auto takes OSMesa where it is installed. Vector graphics "
     "need "
     "none"},
    {"--view", "front|side|top|space|A,E", OPTION_TEXT, AT(view),
     "direction of view; A,E: azimuth and elevation in degrees, as in 35,22"},
    {"--jobs", "N", OPTION_COUNT, AT(jobs),
     "number of processes that grade at once; one for each processor when left out"},
    {"--shard", "I/N", OPTION_TEXT, AT(shard),
     "grade only every N-th submission, beginning with the I-th"},
    {"--merge", NULL, OPTION_FLAG, AT(merge), "put together the parts that --shard wrote"},
    {"--style", "full|skeleton", OPTION_TEXT, AT(style),
     "skeleton: only the functions, without the self-check; full when left out"},
    {"--solver", "scipy|petsc|own|eigen|ejml|ode45|ode15s", OPTION_TEXT, AT(solver),
     "scipy or petsc (python), own or eigen (cpp), own or ejml (java), ode45 or ode15s (octave)"},
    {"--blanks", NULL, OPTION_FLAG, AT(blanks),
     "leave the functions mass, force, jacobian and bias empty for students to fill in; 'grade' "
     "takes the file"},
    {"--seed", "N", OPTION_COUNT, AT(seed),
     "variant of the exercise: it sets the numbers and the states at which answers are compared"},
    {"--student", "NAME", OPTION_TEXT, AT(student),
     "name of the student, from which the seed of the variant is made"},
    {"--seeds", "A..B", OPTION_TEXT, AT(seeds),
     "the variants that --check tries; 1..20 when left out"},
    {"--check", NULL, OPTION_FLAG, AT(check),
     "test the exercise: compute references in two ways, grade right answers and known mistakes"},
    {"--rubric", "FILE", OPTION_TEXT, AT(rubric),
     "file with a teacher's points, tolerances, shares and costs of hints: see 'rubric write'"},
    {"--show-expected", NULL, OPTION_FLAG, AT(show_expected),
     "put the right answers into the verdicts: for teachers, not for students"},
    {"--no-pictures", NULL, OPTION_FLAG, AT(no_pictures), "draw no pictures"},
    {"--hint", "N", OPTION_COUNT, AT(hint), "print the first N hints"},
    {"--host", "ADDRESS", OPTION_TEXT, AT(host),
     "address on which the server listens; 127.0.0.1 when left out"},
    {"--port", "N", OPTION_COUNT, AT(port), "8080 when left out; 0: any free port"},
    {"--allow-host", "NAME", OPTION_WORD, AT(allow_hosts),
     "another host name that the server accepts; may be repeated"},
    {"--proxy", "ADDRESS", OPTION_WORD, AT(proxies),
     "address of a proxy that names its clients in X-Forwarded-For, or a network such as "
     "10.0.0.0/8; one on this machine is believed without it; may be repeated"},
    {"--open", NULL, OPTION_FLAG, AT(open), "open the page in a browser"},
    {"--history", "N", OPTION_COUNT, AT(history),
     "number of events that are kept for each comparison"},
    {"--max-comparisons", "N", OPTION_COUNT, AT(max_comparisons),
     "largest number of comparisons at once"},
    {"--max-streams", "N", OPTION_COUNT, AT(max_streams), "largest number of open event streams"},
    {"--max-connections", "N", OPTION_COUNT, AT(max_connections), "largest number of connections"},
    {"--token", "TEXT", OPTION_TEXT, AT(token),
     "token that clients must send; made and printed where --host is not this machine; none: no "
     "token"},
    {"--guests", NULL, OPTION_FLAG, AT(guests), "allow reading without the token"},
    {"--runs", "DIR", OPTION_TEXT, AT(runs),
     "a folder in which finished runs and unfinished studies are kept"},
    {"--run-cpu", "S", OPTION_NUMBER, AT(run_cpu),
     "largest computing time of one long request [s]"},
    {"--idle-pause", "S", OPTION_NUMBER, AT(idle_pause),
     "a comparison without a reader pauses after this long [s]"},
    {"--expiry", "S", OPTION_NUMBER, AT(expiry),
     "a comparison nobody touched is deleted after this long [s]"},
    {"--keep-alive", "S", OPTION_NUMBER, AT(keep_alive),
     "time between comment lines on a stream without events [s]"},
};
enum { N_OPTIONS = sizeof OPTIONS / sizeof *OPTIONS };

/// Returns what follows `name` in a list of options: "=csv|json ...", or " ..."; NULL: it is not in
/// it.
static const char *find_listed(const char *list, const char *name) {
    const size_t n = strlen(name);
    for (const char *p = list; *p;) {
        if (strcspn(p, " =") == n && memcmp(p, name, n) == 0) {
            return p + n;
        }
        p += strcspn(p, " ");
        p += strspn(p, " ");
    }
    return NULL;
}

static bool is_offered(const hn_command *command, const option *o) {
    return strcmp(o->name, "--json") == 0 || strcmp(o->name, "--help") == 0 ||
           strcmp(o->name, "--no-native") == 0 || find_listed(command->options, o->name);
}

/// Returns whether help, the manual and completion name an option: all that are offered, but --json
/// where a command draws and refuses it with a hint.
static bool is_listed(const hn_command *command, const option *o) {
    const bool drawn = strcmp(command->name, "tui") == 0 && strcmp(o->name, "--json") == 0;
    return is_offered(command, o) && !drawn;
}

/// Another spelling of an option: the results of a class are one JSON object a line.
static const char ONE_A_LINE[] = "--ndjson";

static const option *find_option(const hn_command *command, const char *name, size_t n) {
    if (strcmp(command->name, "grade") == 0 && n == strlen(ONE_A_LINE) &&
        memcmp(name, ONE_A_LINE, n) == 0) {
        return find_option(command, "--json", strlen("--json"));
    }
    for (int i = 0; i < N_OPTIONS; i++) {
        if (strlen(OPTIONS[i].name) == n && memcmp(OPTIONS[i].name, name, n) == 0 &&
            is_offered(command, &OPTIONS[i])) {
            return &OPTIONS[i];
        }
    }
    return NULL;
}

/// The options for one method and for several: each stands for the other where a command has one of
/// them alone.
static const char *const METHOD_OPTIONS[] = {"--method", "--methods"};

static const option *find_twin(const hn_command *command, const char *name, size_t n) {
    for (int i = 0; i < 2; i++) {
        const char *other = METHOD_OPTIONS[1 - i];
        if (strlen(METHOD_OPTIONS[i]) == n && memcmp(METHOD_OPTIONS[i], name, n) == 0) {
            return find_option(command, other, strlen(other));
        }
    }
    return NULL;
}

int hn_number_parse(const char *text, double *out) {
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !isfinite(value) || strpbrk(text, "xX")) {
        return 0;
    }
    *out = value;
    return 1;
}

static hn_status bad_number(const option *o, const char *text, hn_diag *diag) {
    return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s takes %s, not '%.60s'", o->name,
                       o->kind == OPTION_COUNT     ? "a whole number from 0"
                       : o->kind == OPTION_NUMBERS ? "finite decimal numbers separated by commas"
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

/// The option of a field as a row of the table above; its value is kept in args->fields.
static option option_of(const hn_field *f, char name[OPTION_NAME]) {
    name_option(f, name);
    return (option){.name = name,
                    .argument = f->argument,
                    .kind = f->type == HN_FIELD_BOOL      ? OPTION_FLAG
                            : f->type == HN_FIELD_INTEGER ? OPTION_COUNT
                            : f->type == HN_FIELD_NUMBER  ? OPTION_NUMBER
                                                          : OPTION_TEXT,
                    .about = f->about};
}

static hn_status keep_field(hn_args *args, const hn_field *f, const option *o, const char *text,
                            hn_diag *diag) {
    double number = 0;
    if (!args->fields) {
        args->fields = cJSON_CreateObject();
    }
    if (o->kind != OPTION_FLAG && o->kind != OPTION_TEXT && !hn_number_parse(text, &number)) {
        return bad_number(o, text, diag);
    }
    cJSON *value = o->kind == OPTION_FLAG   ? cJSON_CreateTrue()
                   : o->kind == OPTION_TEXT ? cJSON_CreateString(text)
                                            : cJSON_CreateNumber(number);
    cJSON_DeleteItemFromObjectCaseSensitive(args->fields, f->name);
    return cJSON_AddItemToObject(args->fields, f->name, value) ? HN_OK : HN_ERR_MEMORY;
}

static hn_status report_unknown(const hn_command *command, const char *name, hn_diag *diag) {
    const char *names[N_OPTIONS + MOST_FIELDS];
    const hn_field *fields[MOST_FIELDS];
    char hint[HN_DIAG_HINT], field_names[MOST_FIELDS][OPTION_NAME];
    int n = 0;
    bool is_slip = true; // an option of another command is none
    for (int i = 0; i < N_OPTIONS; i++) {
        is_slip = is_slip && strcmp(OPTIONS[i].name, name) != 0;
        if (is_offered(command, &OPTIONS[i])) {
            names[n++] = OPTIONS[i].name;
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

static hn_status read_numbers(hn_numbers *numbers, const option *o, const char *text,
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
static bool is_given(const hn_args *args, const option *o, const hn_field *field) {
    const void *place = (const char *)args + o->place;
    if (field) {
        return o->kind != OPTION_FLAG &&
               cJSON_GetObjectItemCaseSensitive(args->fields, field->name) != NULL;
    }
    switch (o->kind) {
    case OPTION_TEXT:
        return *(const char *const *)place != NULL;
    case OPTION_NUMBER:
    case OPTION_COUNT:
        return !isnan(*(const double *)place);
    case OPTION_NUMBERS:
        return ((const hn_numbers *)place)->value != NULL;
    case OPTION_FLAG:
    case OPTION_WORD:
    case OPTION_WORDS:
        break;
    }
    return false;
}

static hn_status read_value(hn_args *args, const option *o, const char *text, hn_diag *diag) {
    void *place = (char *)args + o->place;
    double value;

    // the place has the type of the kind
    switch (o->kind) {
    case OPTION_TEXT:
        *(const char **)place = text;
        return HN_OK;
    case OPTION_NUMBERS:
        return read_numbers(place, o, text, diag);
    case OPTION_WORD:
    case OPTION_WORDS:
        return add_word(place, text, diag);
    case OPTION_NUMBER:
    case OPTION_COUNT:
        if (!hn_number_parse(text, &value) ||
            (o->kind == OPTION_COUNT && (value < 0 || value != floor(value) || value > 1e15))) {
            return bad_number(o, text, diag);
        }
        *(double *)place = value;
        return HN_OK;
    case OPTION_FLAG:
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
static hn_status put_value(hn_args *args, const option *o, const hn_field *field, const char *text,
                           hn_diag *diag) {
    return field ? keep_field(args, field, o, text, diag) : read_value(args, o, text, diag);
}

/// Reads the value or values of an option; *i is left at the last word.
static hn_status take_values(hn_args *args, const option *o, const hn_field *field, int argc,
                             char **argv, int *i, hn_diag *diag) {
    if (*i + 1 >= argc || (o->kind != OPTION_TEXT && looks_like_option(argv[*i + 1]))) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s needs %s", o->name, o->argument);
    }
    HN_TRY(put_value(args, o, field, argv[++*i], diag));
    while (o->kind == OPTION_WORDS && *i + 1 < argc && !looks_like_option(argv[*i + 1])) {
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
    option of_field;

    // an option of the table, or a field of the command's jobs
    const option *o = find_option(command, word, n);
    const bool is_twin = !o && find_twin(command, word, n);
    o = is_twin ? find_twin(command, word, n) : o;
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
    if (o->kind == OPTION_FLAG) {
        return word[n] ? hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s takes no value", o->name)
                       : put_value(args, o, field, "", diag);
    }
    HN_TRY(word[n] ? put_value(args, o, field, inline_value + 1, diag)
                   : take_values(args, o, field, argc, argv, i, diag));

    // --methods of a command that takes one of them
    if (is_twin && o->kind == OPTION_TEXT && *i + 1 < argc && !looks_like_option(argv[*i + 1])) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, "'holonom compare' takes several",
                           "'%s' takes one method, and '%.60s' follows '%.60s'", command->name,
                           argv[*i + 1], argv[*i]);
    }
    return HN_OK;
}

static void set_defaults(hn_args *args) {
    *args = (hn_args){0};
    for (int i = 0; i < N_OPTIONS; i++) {
        if (OPTIONS[i].kind == OPTION_NUMBER || OPTIONS[i].kind == OPTION_COUNT) {
            *(double *)((char *)args + OPTIONS[i].place) = (double)NAN;
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
static void take_choices(hn_option_row *row, const hn_command *command, const option *o) {
    const char *listed = find_listed(command->options, o->name);
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
    for (int k = 0; k < N_OPTIONS; k++) {
        const option *o = &OPTIONS[k];
        if (is_listed(command, o) && i-- == 0) {
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
