// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/filled_origin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Relative: a parameter is written with all its digits.
static const double ROUNDING = 1e-12;

/// The line behind the words of a declaration.
static const char *skip_declaration(const char *line) {
    static const char *const words[] = {"const ", "static ", "final ", "double "};
    line += strspn(line, " \t");
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strncmp(line, words[i], strlen(words[i])) == 0) {
            line += strlen(words[i]);
            i = (size_t)-1; // in any order
        }
    }
    return line;
}

/// Reads "name = number" at the begin of a line, with a remark or nothing behind it.
static bool read_definition(const char *line, const char *name, double *value) {
    const size_t n = strlen(name);
    line = skip_declaration(line);
    if (strncmp(line, name, n) != 0) {
        return false;
    }
    line += n;
    line += strspn(line, " \t");
    if (line[0] != '=' || line[1] == '=') {
        return false;
    }
    char *end;
    *value = strtod(line + 1, &end);
    const char *rest = end + strspn(end, " \t\r");
    return end != line + 1 && (strchr(";#%\n", *rest) || strncmp(rest, "//", 2) == 0);
}

/// The first definition of a parameter before the parts to fill in: functions behind them have
/// variables of their own.
static bool find_definition(const char *text, const char *name, double *value) {
    const char *end = strstr(text, "YOUR PART");
    for (const char *line = text; line && (!end || line < end); line = strchr(line, '\n')) {
        line += *line == '\n';
        if (read_definition(line, name, value)) {
            return true;
        }
    }
    return false;
}

/// Returns where the first lines name the scene, behind the command that wrote the program; NULL:
/// nowhere.
static const char *find_scene_name(const char *text) {
    static const char command[] = "holonom export ";
    const char *at = strstr(text, command);
    return at ? at + strlen(command) : NULL;
}

bool hn_filled_origin_is_known(const char *text) {
    return find_scene_name(text) != NULL;
}

hn_status hn_filled_origin_check(const hn_scene *scene, const char *text, hn_diag *diag) {
    // the scene that the first lines name
    const char *at = find_scene_name(text);
    if (at) {
        char id[128];
        snprintf(id, sizeof id, "%.*s", (int)strcspn(at, " `\n"), at);
        if (strcmp(id, scene->id) != 0) {
            return hn_diag_set(diag, HN_ERR_INPUT, NULL,
                               "grade it with that scene, or hand in the program of this one",
                               "this is the program of the scene '%.60s'; it is graded as one of "
                               "'%.60s'",
                               id, scene->id);
        }
    }

    // its parameters
    for (int i = 0; i < scene->n_params; i++) {
        const char *name = scene->params[i].name;
        const double known = scene->params[i].value;
        double value;
        if (find_definition(text, name, &value) &&
            !(fabs(value - known) <= ROUNDING * fabs(known))) {
            char hint[HN_DIAG_HINT];
            snprintf(hint, sizeof hint,
                     "write %.40s = %.15g into the program, or grade it with --set %.40s=%.15g",
                     name, known, name, value);
            return hn_diag_set(diag, HN_ERR_INPUT, NULL, hint,
                               "this program has %.40s = %.15g; it is graded with %.40s = %.15g",
                               name, value, name, known);
        }
    }
    return HN_OK;
}
