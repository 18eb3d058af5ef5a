// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/completion.h"

#include "cli/command_table.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/print.h"
#include "dynamics/compile/coordinates.h"
#include "grade/exercise_shelf.h"
#include "integrators/method/catalogue.h"
#include "session/extreme/extreme_files.h"
#include "session/model/lists.h"
#include "session/model/model.h"
#include "session/model/model_json.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/// Describes what is being completed: candidates are written behind `head`, where they begin with
/// `typed`.
typedef struct completing {
    hn_strbuf *b;
    const char *head, *typed;
    int n_head; ///< bytes of head
} completing;

static void offer(const completing *c, const char *candidate, const char *ending,
                  const char *about) {
    if (strncmp(candidate, c->typed, strlen(c->typed)) == 0) {
        hn_strbuf_printf(c->b, "%.*s%s%s%s%s\n", c->n_head, c->head, candidate, ending,
                         about ? "\t" : "", about ? about : "");
    }
}

// ---- methods ----

static const cJSON *row_named(const cJSON *rows, const char *key, const char *name, size_t n) {
    const cJSON *row;
    cJSON_ArrayForEach(row, rows) {
        const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(row, key));
        if (text && strlen(text) == n && strncmp(text, name, n) == 0) {
            return row;
        }
    }
    return NULL;
}

/// The keys of one formulation or integrator, behind the last ':' or ','.
static void offer_keys(completing c, const cJSON *rows, const char *part) {
    const char *last = strrchr(part, ',') ? strrchr(part, ',') : strchr(part, ':');
    const cJSON *row = row_named(rows, "name", part, strcspn(part, ":"));
    const cJSON *key;
    c.n_head = (int)(last + 1 - c.head);
    c.typed = last + 1;
    cJSON_ArrayForEach(key, cJSON_GetObjectItem(row, "options")) {
        offer(&c, cJSON_GetStringValue(cJSON_GetObjectItem(key, "key")), "=",
              cJSON_GetStringValue(cJSON_GetObjectItem(key, "about")));
    }
}

static void offer_methods(completing c) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_methods_json(&text);
    cJSON *document = cJSON_Parse(hn_strbuf_text(&text));
    const char *at = strchr(c.head, '@');
    const cJSON *rows = cJSON_GetObjectItem(document, at ? "integrators" : "formulations"), *row;
    const char *part = at ? at + 1 : c.head;
    if (strchr(part, ':')) {
        offer_keys(c, rows, part);
    } else {
        c.n_head = (int)(part - c.head);
        c.typed = part;
        cJSON_ArrayForEach(row, rows) {
            offer(&c, cJSON_GetStringValue(cJSON_GetObjectItem(row, "name")), at ? "" : "@",
                  cJSON_GetStringValue(cJSON_GetObjectItem(row, "title")));
        }
    }
    cJSON_Delete(document);
    hn_strbuf_reset(&text);
}

// ---- scenes and their parameters ----

/// The ids of a list of the library, each with its title.
static void offer_documents(const completing *c, const hn_library *lib, const char *key,
                            void (*write)(hn_strbuf *b, const hn_library *lib)) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    write(&text, lib);
    cJSON *document = cJSON_Parse(hn_strbuf_text(&text));
    const cJSON *row;
    cJSON_ArrayForEach(row, cJSON_GetObjectItem(document, key)) {
        offer(c, cJSON_GetStringValue(cJSON_GetObjectItem(row, "id")), "",
              cJSON_GetStringValue(cJSON_GetObjectItem(row, "title")));
    }
    cJSON_Delete(document);
    hn_strbuf_reset(&text);
}

static void offer_extreme_cases(const completing *c, const hn_library *lib) {
    hn_extreme *x = NULL;
    hn_diags diags = {0};
    if (hn_extreme_load(lib, NULL, 0, &x, &diags) == HN_OK) {
        for (int i = 0; i < x->n_cases; i++) {
            offer(c, x->cases[i].id, "", x->cases[i].title);
        }
    }
    hn_extreme_free(x);
}

/// Offers where coordinates and rates start, those of joints that close a loop left out:
/// "start.th1=".
static void offer_starts(const completing *c, const hn_model *model) {
    const hn_system *sys = hn_model_system(model);
    for (int i = 0; i < hn_system_get_info(sys).n_user; i++) {
        const hn_coordinate *q =
            &hn_model_scene(model)->coordinates[hn_system_user_coordinate(sys, i)];
        char name[96];
        snprintf(name, sizeof name, "start.%.80s", q->name);
        offer(c, name, "=", "its value at the start");
        snprintf(name, sizeof name, "start.%.80s", q->rate);
        offer(c, name, "=", "its rate at the start");
    }
}

/// Offers values behind "l1=": the present one and the ends of the range.
static void offer_values(const completing *c, const hn_param *p) {
    const struct {
        double value;
        const char *about;
    } values[] = {{p->value, "its value now"}, {p->min, "the smallest"}, {p->max, "the largest"}};
    for (int i = 0; i < 3; i++) {
        char name[128], about[96];
        snprintf(name, sizeof name, "%.80s=%.9g", p->name, values[i].value);
        snprintf(about, sizeof about, "%s%s%.32s", values[i].about,
                 p->unit && p->unit[0] ? ", in " : "", p->unit ? p->unit : "");
        if (isfinite(values[i].value)) {
            offer(c, name, "", about);
        }
    }
}

static void offer_parameters(const completing *c, const hn_library *lib, const char *scene) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    const hn_model_source source = {.name = scene, .allow_open = 1};
    if (!hn_library_scene_path(lib, scene) ||
        hn_model_load(lib, &source, &model, &diags) != HN_OK) {
        return;
    }
    const hn_scene *s = hn_model_scene(model);
    for (int i = 0; i < s->n_params; i++) {
        char about[256];
        snprintf(about, sizeof about, "%g to %g %s, now %g: %s", s->params[i].min, s->params[i].max,
                 s->params[i].unit ? s->params[i].unit : "", s->params[i].value,
                 s->params[i].about ? s->params[i].about : "");
        if (strchr(c->typed, '=')) {
            offer_values(c, &s->params[i]);
        } else {
            offer(c, s->params[i].name, "=", about);
        }
    }
    offer_starts(c, model);
    hn_model_free(model);
}

// ---- words and options ----

/// The words that a usage line lists: "scenes|methods|lessons".
static void offer_listed(const completing *c, const char *words) {
    while (*words) {
        char word[64];
        const size_t n = strcspn(words, "| []");
        snprintf(word, sizeof word, "%.*s", (int)n, words);
        if (n > 0 && word[0] >= 'a' && word[0] <= 'z') {
            offer(c, word, "", NULL);
        }
        words += n + (words[n] != '\0');
    }
}

/// The values of an option that has a list of them: "light|dark".
static void offer_choices(const completing *c, const hn_command *command, const char *option) {
    hn_option_row o;
    for (int i = 0; hn_args_option(command, i, &o); i++) {
        if (strcmp(o.name, option) == 0) {
            offer_listed(c, o.choices);
        }
    }
}

/// A word that is no option's value; `first`: the one behind the command.
static void offer_word(const completing *c, const hn_library *lib, const hn_command *command,
                       bool first) {
    const bool many = strstr(command->words, "...]") != NULL; // "[SCENE...]"
    if ((first || many) && strstr(command->words, "SCENE")) {
        offer_documents(c, lib, "scenes", hn_scenes_json);
    }
    if (strcmp(command->name, "help") == 0) {
        for (int i = 0; i < hn_command_count(); i++) {
            offer(c, hn_command_at(i)->name, "", hn_command_at(i)->about);
        }
    }
    if (strcmp(command->name, "extreme") == 0) {
        offer_extreme_cases(c, lib);
    } else if (first && strstr(command->words, "ID")) {
        if (strcmp(command->name, "lesson") == 0) {
            offer_documents(c, lib, "lessons", hn_lessons_json);
        } else {
            offer_documents(c, lib, "problems", hn_shelf_exercises_json);
        }
    }
    if (!first || !strstr(command->words, "SCENE")) {
        offer_listed(c, command->words);
    }
}

static void offer_options(const completing *c, const hn_command *command) {
    hn_option_row o;
    for (int i = 0; hn_args_option(command, i, &o); i++) {
        offer(c, o.name, "", o.about);
    }
}

/// The option whose value the last word is; "" where it is a word of the command.
static const char *option_before(const hn_command *command, const char *const *words, int n) {
    hn_option_row o;
    for (int i = n - 2; i >= 1; i--) {
        const bool many = strcmp(words[i], "--methods") == 0 || strcmp(words[i], "--q") == 0 ||
                          strcmp(words[i], "--v") == 0;
        for (int k = 0; words[i][0] == '-' && hn_args_option(command, k, &o); k++) {
            if (strcmp(o.name, words[i]) == 0) {
                return o.argument && (many || i == n - 2) ? words[i] : "";
            }
        }
    }
    return "";
}

/// Returns whether a name of words or of an argument is that of a file: "FILE", "PART...", "SCENE".
static bool names_file(const char *text) {
    static const char *const files[] = {"FILE", "DIR",        "FOLDER", "SCENE",
                                        "PART", "SUBMISSION", "VERDICT"};
    for (size_t i = 0; text && i < sizeof files / sizeof *files; i++) {
        if (strstr(text, files[i])) {
            return true;
        }
    }
    return false;
}

/// Returns whether the value of an option, or without one a word of the command, may be a file.
static bool takes_file(const hn_command *command, const char *option) {
    hn_option_row o;
    for (int i = 0; option[0] && hn_args_option(command, i, &o); i++) {
        if (strcmp(o.name, option) == 0) {
            return names_file(o.argument);
        }
    }
    return names_file(command->words);
}

bool hn_completion_candidates(hn_strbuf *b, const hn_library *lib, const char *const *words,
                              int n) {
    const char *last = n > 0 ? words[n - 1] : "";
    const completing c = {b, last, last, 0};
    if (n <= 1) {
        for (int i = 0; i < hn_command_count(); i++) {
            offer(&c, hn_command_at(i)->name, "", hn_command_at(i)->about);
        }
        return false;
    }
    const hn_command *command = hn_command_find(words[0]);
    if (!command) {
        return false;
    }

    // what the last word is decides what may stand there
    const char *option = option_before(command, words, n);
    if (last[0] == '-') {
        offer_options(&c, command);
    } else if (strcmp(option, "--method") == 0 || strcmp(option, "--methods") == 0) {
        offer_methods(c);
    } else if (strcmp(option, "--set") == 0) {
        offer_parameters(&c, lib, words[1]);
    } else if (option[0] != '\0') {
        offer_choices(&c, command, option);
    } else {
        offer_word(&c, lib, command, n == 2);
    }
    return last[0] != '-' && takes_file(command, option);
}

// ---- what a shell needs ----

// bash takes : = and @ for ends of words where it may complete: the line is split at blanks here,
// and what stands up to the last of them is not typed again; @ itself is. If bash lists several
// candidates (COMP_TYPE: the code of ? ! or @), what each is about stands beside it
static const char BASH[] =
    "_holonom() {\n"
    "    local IFS=$'\\n' line=${COMP_LINE:0:COMP_POINT} cur breaks kept= found one i\n"
    "    local -a words rows\n"
    "    IFS=$' \\t' read -ra words <<<\"$line\"\n"
    "    [[ $line == *[$' \\t'] ]] && words+=('')\n"
    "    cur=${words[${#words[@]} - 1]}\n"
    "    found=$(holonom complete -- \"${words[@]:1}\" 2>/dev/null) || compopt +o default "
    "2>/dev/null\n"
    "    while IFS= read -r one; do\n"
    "        [[ $one ]] && rows+=(\"$one\")\n"
    "    done <<<\"$found\"\n"
    "    COMPREPLY=(\"${rows[@]%%$'\\t'*}\")\n"
    "    [[ ${COMPREPLY[0]} == *[=@] ]] && compopt -o nospace 2>/dev/null\n"
    "    breaks=${COMP_WORDBREAKS//[^:=@]/}\n"
    "    [[ $breaks ]] && kept=${cur%\"${cur##*[$breaks]}\"} kept=${kept%@}\n"
    "    COMPREPLY=(\"${COMPREPLY[@]#\"$kept\"}\")\n"
    "    [[ ${#rows[@]} -gt 1 && $COMP_TYPE == @(33|63|64) ]] || return 0\n"
    "    for i in \"${!rows[@]}\"; do\n"
    "        [[ ${rows[i]} == *$'\\t'* ]] || continue\n"
    "        printf -v one '%-20s  %s' \"${COMPREPLY[i]}\" \"${rows[i]#*$'\\t'}\"\n"
    "        COMPREPLY[i]=${one:0:${COLUMNS:-80} - 1}\n"
    "    done\n"
    "}\ncomplete -o default -F _holonom holonom\n";
// what each candidate is about stands beside it; a blank follows what is complete; works from a
// folder of functions and when it is sourced
static const char ZSH[] =
    "#compdef holonom\n_holonom() {\n"
    "    local -a found open whole says_open says_whole rows\n"
    "    local one name says lines files=1\n"
    "    lines=\"$(holonom complete -- \"${(@)words[2,CURRENT]}\" 2>/dev/null)\" || files=0\n"
    "    found=(${(f)lines})\n"
    "    for one in $found; do\n"
    "        name=${one%%$'\\t'*} says=$name\n"
    "        if [[ $one == *$'\\t'* ]]; then\n"
    "            rows=(-l)\n"
    "            (( $#name < 20 )) && says=${(r:20:)name}\n"
    "            says+=\"  ${one#*$'\\t'}\"\n"
    "        fi\n"
    "        says=${says[1,COLUMNS - 1]}\n"
    "        if [[ $name == *[=@] ]]; then open+=($name) says_open+=($says)\n"
    "        else whole+=($name) says_whole+=($says); fi\n"
    "    done\n"
    "    (( $#open )) && compadd $rows -d says_open -S '' -Q -- $open\n"
    "    (( $#whole )) && compadd $rows -d says_whole -Q -- $whole\n"
    "    (( $#found || ! files )) || _files\n"
    "}\n"
    "if [[ $funcstack[1] == _holonom ]]; then _holonom \"$@\"; else compdef _holonom holonom; fi\n";
static const char FISH[] =
    "complete -c holonom -f -a '(holonom complete -- (commandline -opc)[2..-1] (commandline -ct) "
    "2>/dev/null)'\n"
    "complete -c holonom -n 'set -l found (holonom complete -- (commandline -opc)[2..-1] "
    "(commandline -ct) 2>/dev/null); and test (count $found) -eq 0' -F\n";

hn_exit hn_command_completion(const hn_library *lib, const hn_args *args) {
    static const struct {
        const char *shell, *text;
    } texts[] = {{"bash", BASH}, {"zsh", ZSH}, {"fish", FISH}};
    (void)lib;
    hn_diag diag;
    hn_strbuf b;
    hn_strbuf_init(&b);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        if (strcmp(texts[i].shell, args->words.word[0]) == 0) {
            hn_strbuf_add(&b, texts[i].text);
            return hn_cli_print(&b);
        }
    }
    hn_diag_set(&diag, HN_ERR_INPUT, NULL, "bash, zsh and fish have one",
                "there is no completion for the shell '%.40s'", args->words.word[0]);
    return hn_report_diag(args, &diag);
}
