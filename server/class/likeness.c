// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/likeness.h"

#include "base/hash.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

enum { MOST_NAMES = 512, MOST_GIVEN = 2048 };

/// Names in the order in which they appeared, as hashes.
typedef struct names {
    int n;
    uint64_t name[MOST_NAMES];
} names;

typedef struct reader {
    uint64_t hash;
    names *names; ///< NULL: names stay as they are
    bool is_program;
    hn_source_style style; ///< of a program
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

/// Reads a name; the name of a function stands before a bracket and stays.
static const char *read_name(reader *r, const char *at) {
    uint64_t name = HN_HASH_START;
    for (; hn_source_continues_name(*at); at++) {
        const char c = (char)tolower((unsigned char)*at);
        name = hn_hash_bytes(name, &c, 1);
    }
    const char *behind = at + strspn(at, " \t");
    const uint64_t kept = r->names && *behind != '(' ? number_of(r->names, name) : name;
    r->hash = hn_hash_bytes(r->hash, &kept, sizeof kept);
    return at;
}

static void read_text(reader *r, const char *at) {
    while (*at) {
        const char *end = r->is_program ? hn_source_skip_comment(r->style, at) : NULL;
        if (end) {
            at = end;
        } else if (hn_source_begins_name(*at)) {
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

uint64_t hn_likeness_program_texts(const char *text, hn_source_style style) {
    reader r = {.hash = HN_HASH_START, .is_program = true, .style = style};
    read_text(&r, text);
    return hn_hash_mix(r.hash);
}

// ---- the shape of a program ----

/// Definition of a name: `right` is the text behind its '='.
typedef struct definition {
    uint64_t name, right, value;
    int level; ///< of the block, outside of which it means nothing
} definition;

/// A reading of a program, statement by statement.
typedef struct statements {
    uint64_t all, one; ///< hash of the statements in any order; of the one that is read
    names unset;       ///< names that no statement has given a value, in order of first use
    int n;
    definition given[MOST_GIVEN]; ///< the last one of a name is what it stands for
    uint64_t name, right;         ///< the definition that is read, where `gives`
    bool gives, in_brackets;      ///< in_brackets: it opens a loop
    int loops;                    ///< definitions in brackets since the last closing brace
    int depth, level;             ///< of brackets that are open; of blocks, by_lines: 1 if indented
    bool by_lines;                ///< the end of a line ends a statement
} statements;

/// Adds to the statement, and to the value that it gives.
static void put(statements *s, const void *bytes, size_t n) {
    s->one = hn_hash_bytes(s->one, bytes, n);
    s->right = hn_hash_bytes(s->right, bytes, n);
}

/// Returns what a name stands for: the value it was given last, else its number among those without
/// one.
static uint64_t value_of(statements *s, uint64_t name) {
    for (int i = s->n - 1; i >= 0; i--) {
        if (s->given[i].name == name) {
            return s->given[i].value;
        }
    }
    return number_of(&s->unset, name);
}

/// The value that is given is what stands behind the '=', and for which of the names that got just
/// that: two parameters of one number are two. The variable of a loop counts by its nesting.
static void end_definition(statements *s) {
    int at = 0;
    uint64_t index = 0;
    if (!s->gives) {
        return;
    }
    s->gives = false;
    if (s->in_brackets) {
        index = (uint64_t)++s->loops << 32;
    }
    for (; at < s->n && !(s->given[at].right == s->right && s->given[at].name == s->name); at++) {
        index += !s->in_brackets && s->given[at].right == s->right;
    }
    if (at == MOST_GIVEN) {
        return; // the name stays what it was
    }
    const uint64_t value = hn_hash_bytes(s->right, &index, sizeof index);
    definition d = {s->name, s->right, value, s->level};
    if (at < s->n) {
        d.value = s->in_brackets ? value : s->given[at].value;
        d.level = s->given[at].level < s->level ? s->given[at].level : s->level;
        memmove(s->given + at, s->given + at + 1, (size_t)(s->n - at - 1) * sizeof d);
        s->n--;
    }
    s->given[s->n++] = d;
}

/// Forgets what was given in blocks that have ended.
static void end_blocks(statements *s, int level) {
    int n = 0;
    for (int i = 0; i < s->n; i++) {
        if (s->given[i].level <= level) {
            s->given[n++] = s->given[i];
        }
    }
    s->n = n;
    s->level = level;
}

/// A statement counts by its hash, in which names are what they stand for: which of them it uses
/// counts, what they are called does not.
static void end_statement(statements *s) {
    end_definition(s);
    if (s->one != HN_HASH_START) {
        s->all += hn_hash_mix(s->one);
    }
    s->one = HN_HASH_START;
}

static const char *read_statement_name(statements *s, const char *at) {
    size_t n = 0;
    while (hn_source_continues_name(at[n])) {
        n++;
    }
    const uint64_t name = hn_hash_bytes(HN_HASH_START, at, n);
    const char *behind = at + n + strspn(at + n, " \t");
    const bool adds = *behind && strchr("+-*/", *behind) && behind[1] == '=';
    if (adds || (behind[0] == '=' && behind[1] != '=')) {
        end_definition(s);
        s->right = HN_HASH_START;
    }
    if (adds || behind[0] != '=' || behind[1] == '=') {
        const uint64_t kept = hn_source_is_function(at, n) ? name : value_of(s, name);
        put(s, &kept, sizeof kept);
    }
    if (adds || (behind[0] == '=' && behind[1] != '=')) {
        s->gives = true;
        s->in_brackets = s->depth > 0;
        s->name = name;
    }
    return at + n;
}

/// A number with its exponent, whose letter is no name.
static const char *read_number(statements *s, const char *at) {
    const char *begin = at;
    while (isalnum((unsigned char)*at) || *at == '.' ||
           (strchr("+-", *at) && *at && strchr("eE", at[-1]))) {
        at++;
    }
    put(s, begin, (size_t)(at - begin));
    return at;
}

static void read_sign(statements *s, char c) {
    s->depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
    const bool ends = c == ';' || c == '{' || c == '}' || (c == '\n' && s->by_lines);
    if (ends && (s->depth <= 0 || c != '\n')) {
        s->depth = s->depth < 0 ? 0 : s->depth;
        end_statement(s);
        s->loops = c == '}' ? 0 : s->loops;
        if (!s->by_lines && c == '{') {
            s->level++;
        } else if (!s->by_lines && c == '}') {
            end_blocks(s, s->level - 1);
        }
    } else if (!isspace((unsigned char)c) && c != '\\') {
        put(s, &c, 1);
    }
}

uint64_t hn_likeness_program_shape(const char *text, hn_source_style style) {
    const bool by_lines = hn_source_is_by_lines(style);
    statements s = {.all = HN_HASH_START, .one = HN_HASH_START, .by_lines = by_lines};
    for (const char *at = text; *at;) {
        const char *end = hn_source_skip_comment(style, at);
        const char *behind = end ? end : hn_source_skip_quotes(text, at);
        if (by_lines && s.depth <= 0 && at > text && at[-1] == '\n' && *at != '\n' && !end) {
            end_blocks(&s, isspace((unsigned char)*at) ? s.level | 1 : 0);
        }
        if (behind) {
            at = behind;
        } else if (hn_source_begins_name(*at)) {
            at = read_statement_name(&s, at);
        } else if (isdigit((unsigned char)*at)) {
            at = read_number(&s, at);
        } else if (*at == '\\' && at[1] == '\n') {
            at += 2; // the statement goes on
        } else {
            read_sign(&s, *at++);
        }
    }
    end_statement(&s);
    return hn_hash_mix(s.all);
}
