// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/crash_words.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MESSAGE = 160 };

/// The line that begins at `at`, without spaces around it.
static void copy_line(const char *at, char out[MESSAGE]) {
    at += strspn(at, " \t?");
    size_t n = strcspn(at, "\n");
    while (n > 0 && isspace((unsigned char)at[n - 1])) {
        n--;
    }
    snprintf(out, MESSAGE, "%.*s", (int)n, at);
}

static const char *next_line(const char *at) {
    at += strcspn(at, "\n");
    return *at ? at + 1 : NULL;
}

/// The last line that is not empty.
static const char *last_line(const char *errors) {
    const char *found = errors;
    for (const char *at = errors; at; at = next_line(at)) {
        found = at[strspn(at, " \n")] ? at : found;
    }
    return found;
}

/// For Python: the first line behind the calls, which begins in the first column; of the last
/// exception where one followed from another.
static const char *end_of_traceback(const char *errors) {
    static const char begin[] = "Traceback (most recent call last)";
    const char *found = NULL;
    for (const char *at = strstr(errors, begin); at; at = strstr(at, begin)) {
        const char *line = next_line(at);
        while (line && (!*line || isspace((unsigned char)*line))) {
            line = next_line(line);
        }
        found = line ? line : found;
        at += sizeof begin - 1;
    }
    return found;
}

/// The line that begins with, or the first that holds, one of the words by which languages begin a
/// message.
static const char *find_message(const char *errors) {
    static const char *const marks[] = {" error: ", "error: ", "Error: ", "Exception in thread",
                                        "ERROR: "};
    const char *python = end_of_traceback(errors);
    if (python) {
        return python;
    }
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        const char *at = strstr(errors, marks[i]);
        while (at && at > errors && at[-1] != '\n') {
            at--;
        }
        if (at) {
            return at;
        }
    }
    return last_line(errors);
}

/// The line number behind the name at `at`: `mine.py", line 12`, `mine.js:12`; 0: none.
static long number_behind(const char *at) {
    static const char python[] = "\", line ";
    at += strncmp(at, python, sizeof python - 1) == 0 ? sizeof python - 1 : *at == ':' ? 1 : 0;
    return isdigit((unsigned char)*at) ? strtol(at, NULL, 10) : 0;
}

/// The line of the program's own file: the last call before Python's message, else the first place
/// that is named. 0: none is.
static long find_place(const char *errors, const char *name, const char *message) {
    const bool is_python = end_of_traceback(errors) != NULL;
    long found = 0;
    for (const char *at = strstr(errors, name); at; at = strstr(at + 1, name)) {
        const long line = number_behind(at + strlen(name));
        if (is_python ? at < message && line > 0 : found == 0) {
            found = line;
        }
    }
    return found;
}

/// Writes the limit of the resource that ran out; "" where none did.
static void name_limit(const char *message, const hn_program_limits *limits, char out[80]) {
    static const struct {
        const char *word;
        char kind;
    } WORDS[] = {{"MemoryError", 'm'},
                 {"bad_alloc", 'm'},
                 {"OutOfMemory", 'm'},
                 {"out of memory", 'm'},
                 {"Cannot allocate memory", 'm'},
                 {"No space left on device", 'f'},
                 {"File too large", 'f'},
                 {"Resource temporarily unavailable", 'p'},
                 {"start new thread", 'p'}};
    out[0] = '\0';
    for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS && !out[0]; i++) {
        if (!strstr(message, WORDS[i].word)) {
            continue;
        }
        if (WORDS[i].kind == 'm') {
            snprintf(out, 80, "; %lld MB of memory are allowed", limits->memory >> 20);
        } else if (WORDS[i].kind == 'f') {
            snprintf(out, 80, "; %lld MB of files are allowed", limits->files >> 20);
        } else {
            snprintf(out, 80, "; %d processes and threads are allowed", limits->processes);
        }
    }
}

/// Writes why the sandbox lacks a part that the program asks for; "" where it asks for none.
static void name_sandbox(const char *message, char out[80]) {
    static const char *const WORDS[] = {"No module named", "Cannot find module",
                                        " No such file or directory"};
    out[0] = '\0';
    for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS && !out[0]; i++) {
        if (strstr(message, WORDS[i])) {
            snprintf(out, 80, "; the sandbox holds this file and the packages of the system alone");
        }
    }
}

void hn_crash_words(const char *errors, const char *file, bool confined,
                    const hn_program_limits *limits, char out[320]) {
    char message[MESSAGE], place[80] = "", limit[80];
    const char *slash = file ? strrchr(file, '/') : NULL, *name = slash ? slash + 1 : file;
    const char *at = find_message(errors);
    copy_line(at, message);
    name_limit(message, limits, limit);
    if (confined && !limit[0]) {
        name_sandbox(message, limit);
    }

    // the line, where the message does not name one
    const long line = name && *name ? find_place(errors, name, at) : 0;
    if (line > 0 && !strstr(message, name) && !strstr(message, " line ")) {
        snprintf(place, sizeof place, " (%.36s, line %ld)", name, line);
    }
    snprintf(out, 320, "%s%s%s", message, message[0] ? place : "", limit);
}
