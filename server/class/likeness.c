// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/likeness.h"

#include "base/hash.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

enum { MOST_NAMES = 512 };

/// Names in the order in which they appeared, as hashes.
typedef struct names {
    int n;
    uint64_t name[MOST_NAMES];
} names;

typedef struct reader {
    uint64_t hash;
    names *names; ///< NULL: names stay as they are
    bool is_program;
} reader;

/// The number of a name; one beyond the last that is kept counts as itself.
static uint64_t number_of(names *list, uint64_t name) {
    for (int i = 0; i < list->n; i++) {
        if (list->name[i] == name) {
            return (uint64_t)i;
        }
    }
    if (list->n == MOST_NAMES) {
        return name;
    }
    list->name[list->n] = name;
    return (uint64_t)list->n++;
}

static bool begins_name(char c) {
    return isalpha((unsigned char)c) || c == '_';
}

static bool continues_name(char c) {
    return isalnum((unsigned char)c) || c == '_';
}

/// Reads a name; the name of a function stands before a bracket and stays.
static const char *read_name(reader *r, const char *at) {
    uint64_t name = HN_HASH_START;
    for (; continues_name(*at); at++) {
        const char c = (char)tolower((unsigned char)*at);
        name = hn_hash_bytes(name, &c, 1);
    }
    const char *behind = at + strspn(at, " \t");
    const uint64_t kept = r->names && *behind != '(' ? number_of(r->names, name) : name;
    r->hash = hn_hash_bytes(r->hash, &kept, sizeof kept);
    return at;
}

/// Where a comment that begins here ends; NULL: none begins here.
static const char *skip_comment(const char *at) {
    if (*at == '#' || *at == '%' || (at[0] == '/' && at[1] == '/')) {
        // in C '%' is an operator and '#' a directive: what is behind them counts for nobody
        return at + strcspn(at, "\n");
    }
    if (at[0] == '/' && at[1] == '*') {
        const char *end = strstr(at + 2, "*/");
        return end ? end + 2 : at + strlen(at);
    }
    return NULL;
}

static void read_text(reader *r, const char *at) {
    while (*at) {
        const char *end = r->is_program ? skip_comment(at) : NULL;
        if (end) {
            at = end;
        } else if (begins_name(*at)) {
            at = read_name(r, at);
        } else {
            const char c = *at++;
            if (!isspace((unsigned char)c)) {
                r->hash = hn_hash_bytes(r->hash, &c, 1);
            }
        }
    }
}

/// All texts and numbers of a submission, in their order.
static void read_item(reader *r, const cJSON *item) {
    if (cJSON_IsString(item)) {
        read_text(r, item->valuestring);
        r->hash = hn_hash_text(r->hash, "|");
    } else if (cJSON_IsNumber(item)) {
        r->hash = hn_hash_double(r->hash, item->valuedouble);
    }
    const cJSON *part;
    cJSON_ArrayForEach(part, item) {
        read_item(r, part);
    }
}

/// The answers of a submission: its members but those that say whose it is or how it was made.
static void read_answers(reader *r, const cJSON *submission) {
    static const char *const OTHERS[] = {"problem", "exercise", "student",
                                         "seed",    "comment",  "hints"};
    const cJSON *m;
    cJSON_ArrayForEach(m, submission) {
        bool answer = true;
        for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++) {
            answer = answer && !(m->string && strcmp(m->string, OTHERS[i]) == 0);
        }
        if (answer) {
            read_item(r, m);
        }
    }
}

uint64_t hn_likeness_texts(const cJSON *submission) {
    reader r = {.hash = HN_HASH_START};
    read_answers(&r, submission);
    return hn_hash_mix(r.hash);
}

uint64_t hn_likeness_shape(const cJSON *submission) {
    names list = {0};
    reader r = {.hash = HN_HASH_START, .names = &list};
    read_answers(&r, submission);
    return hn_hash_mix(r.hash);
}

uint64_t hn_likeness_program_texts(const char *text) {
    reader r = {.hash = HN_HASH_START, .is_program = true};
    read_text(&r, text);
    return hn_hash_mix(r.hash);
}

// ---- the shape of a program ----

/// A reading of a program, statement by statement.
typedef struct statements {
    uint64_t all, one; ///< hash of the statements in any order; of the one that is read
    names names;       ///< of the one that is read
    int depth;         ///< of brackets that are open
    bool by_lines;     ///< the end of a line ends a statement
} statements;

/// Functions that nobody renames.
static bool is_function(const char *at, size_t n) {
    static const char *const known[] = {"sin",  "cos",  "tan", "asin", "acos", "atan", "atan2",
                                        "sqrt", "pow",  "exp", "log",  "abs",  "fabs", "sinh",
                                        "cosh", "tanh", "dot", "min",  "max"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strlen(known[i]) == n && strncmp(at, known[i], n) == 0) {
            return true;
        }
    }
    return false;
}

/// A statement counts by its hash, in which names are numbers in the order of their appearance in
/// it: a name that the program has elsewhere for something else makes no difference.
static void end_statement(statements *s) {
    if (s->one != HN_HASH_START) {
        s->all += hn_hash_mix(s->one);
    }
    s->one = HN_HASH_START;
    s->names.n = 0;
}

static const char *read_statement_name(statements *s, const char *at) {
    size_t n = 0;
    while (continues_name(at[n])) {
        n++;
    }
    const uint64_t name = hn_hash_bytes(HN_HASH_START, at, n);
    const uint64_t kept = is_function(at, n) ? name : number_of(&s->names, name);
    s->one = hn_hash_bytes(s->one, &kept, sizeof kept);
    return at + n;
}

/// Where a text in quotes ends, NULL: none begins here. A single quote behind a name or a bracket
/// transposes in Octave.
static const char *skip_text(const char *begin, const char *at) {
    const char before = at > begin ? at[-1] : ' ';
    if (strncmp(at, "\"\"\"", 3) == 0 || strncmp(at, "'''", 3) == 0) {
        const char mark[4] = {*at, *at, *at, 0};
        const char *end = strstr(at + 3, mark);
        return end ? end + 3 : at + strlen(at);
    }
    if (*at != '"' && (*at != '\'' || continues_name(before) || strchr(")]}'.", before))) {
        return NULL;
    }
    const char *end = at + 1;
    while (*end && *end != *at && *end != '\n') {
        end += end[0] == '\\' && end[1] ? 2 : 1;
    }
    return *end == *at ? end + 1 : end;
}

static void read_sign(statements *s, char c) {
    s->depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
    const bool ends = c == ';' || c == '{' || c == '}' || (c == '\n' && s->by_lines);
    if (ends && (s->depth <= 0 || c != '\n')) {
        s->depth = s->depth < 0 ? 0 : s->depth;
        end_statement(s);
    } else if (!isspace((unsigned char)c) && c != '\\') {
        s->one = hn_hash_bytes(s->one, &c, 1);
    }
}

uint64_t hn_likeness_program_shape(const char *text, bool by_lines) {
    statements s = {.all = HN_HASH_START, .one = HN_HASH_START, .by_lines = by_lines};
    for (const char *at = text; *at;) {
        const char *end = skip_comment(at);
        const char *behind = end ? end : skip_text(text, at);
        if (behind) {
            at = behind;
        } else if (begins_name(*at)) {
            at = read_statement_name(&s, at);
        } else if (*at == '\\' && at[1] == '\n') {
            at += 2; // the statement goes on
        } else {
            read_sign(&s, *at++);
        }
    }
    end_statement(&s);
    return hn_hash_mix(s.all);
}
